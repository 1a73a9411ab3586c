#include "app/files/painted_mesh.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "app/files/errors.h"
#include "app/files/file_ending.h"
#include "app/files/polygon_file.h"

namespace app {

namespace {

using Eigen::Vector3d;

constexpr int kWidth = 256, kHeight = 128;
constexpr const char* kMend = "give a head or its scalp with painted vertices, as OBJ, PLY, glTF or FBX, y up";

// The middle of the sphere from which the points are off least, by squares: |p|^2 = 2 m.p + k.
Vector3d middleOf(const std::vector<Vector3d>& points, const std::string& file) {
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& p : points) mean += p / static_cast<double>(points.size());
  double spread = 0;
  Eigen::Matrix3d directions = Eigen::Matrix3d::Zero();
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  for (const Vector3d& p : points) {
    const Eigen::Vector4d row(2 * (p - mean).x(), 2 * (p - mean).y(), 2 * (p - mean).z(), 1);
    normal += row * row.transpose();
    right += (p - mean).squaredNorm() * row;
    directions += (p - mean) * (p - mean).transpose();
    spread = std::max(spread, (p - mean).norm());
  }
  const Eigen::Vector4d fit = normal.ldlt().solve(right);
  constexpr double kFlat = 1e-4;  // of the squared extents
  const Vector3d middle = fit.head<3>();
  const Eigen::Vector3d thickness = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(directions).eigenvalues();
  if (!(thickness[0] > kFlat * thickness[2]) || !middle.allFinite() || middle.norm() > 3 * spread)
    throw InputError(file, "", "is flat: it goes round no head", kMend);
  return mean + middle;
}

struct Texel {
  double distance = -1;  // from the middle, of what lies there; below 0: nothing
  Vector3d color = Vector3d::Zero();
};

struct Unrolled {
  std::vector<Texel> texels = std::vector<Texel>(static_cast<std::size_t>(kWidth) * kHeight);

  Texel& at(int row, int column) {
    const int x = (column % kWidth + kWidth) % kWidth, y = std::clamp(row, 0, kHeight - 1);
    return texels[static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)];
  }
  // `off`: from the head's middle.
  void put(const Vector3d& off, const Vector3d& color) {
    const double distance = off.norm();
    if (distance <= 0) return;
    const double polar = std::acos(std::clamp(off.y() / distance, -1.0, 1.0)), azimuth = std::atan2(off.x(), off.z());
    Texel& texel = at(static_cast<int>(polar / std::numbers::pi * kHeight),
                      static_cast<int>((azimuth / (2 * std::numbers::pi) + 0.5) * kWidth));
    if (distance > texel.distance) texel = {distance, color};
  }
  // Points of a triangle, denser than texels.
  void draw(const std::array<Vector3d, 3>& off, const std::array<Vector3d, 3>& color) {
    constexpr double kDense = 1.5 * kHeight / std::numbers::pi;  // points a radian
    const auto angle = [&](std::size_t a, std::size_t b) {
      return std::atan2(off[a].cross(off[b]).norm(), off[a].dot(off[b]));
    };
    const double widest = std::max({angle(0, 1), angle(1, 2), angle(2, 0)});
    const int parts = std::clamp(static_cast<int>(std::ceil(kDense * widest)), 1, 2 * kHeight);
    for (int i = 0; i <= parts; ++i) {
      for (int j = 0; j <= parts - i; ++j) {
        const double a = double(i) / parts, b = double(j) / parts, c = double(parts - i - j) / parts;
        put(a * off[0] + b * off[1] + c * off[2], a * color[0] + b * color[1] + c * color[2]);
      }
    }
  }
  // What nothing lies at takes the colour of its nearest neighbours, ring by ring.
  void fill() {
    bool open = true;
    while (open) {
      open = false;
      Unrolled before = *this;
      for (int row = 0; row < kHeight; ++row) {
        for (int column = 0; column < kWidth; ++column) {
          if (before.at(row, column).distance >= 0) continue;
          Vector3d sum = Vector3d::Zero();
          int count = 0;
          for (const Texel* beside : {&before.at(row - 1, column), &before.at(row + 1, column),
                                      &before.at(row, column - 1), &before.at(row, column + 1)}) {
            if (beside->distance >= 0) sum += beside->color, ++count;
          }
          if (count > 0)
            at(row, column) = {0, sum / count};
          else
            open = true;
        }
      }
    }
  }
};

// A field's value would else be cut off to 0 or 1 without a word.
void expectShares(std::span<const std::array<float, 3>> colors, const std::string& file) {
  for (std::size_t v = 0; v < colors.size(); ++v) {
    if (std::ranges::all_of(colors[v], [](float share) { return share >= 0 && share <= 1; })) continue;
    throw InputError(file, "vertex " + std::to_string(v), "has a colour that is not from 0 to 1",
                     "write colours as shares from 0 to 1, or in PLY as bytes");
  }
}

}  // namespace

bool hasPaintedEnding(const std::string& file) {
  constexpr std::array<std::string_view, 5> kEndings{".obj", ".ply", ".glb", ".gltf", ".fbx"};
  return std::ranges::find(kEndings, endingOf(file)) != kEndings.end();
}

Image readPaintedMesh(const std::string& file) {
  const PolygonMesh mesh = readPolygons(file);
  if (mesh.vertex_colors.empty()) throw InputError(file, "", "holds no colours of vertices", kMend);
  expectShares(mesh.vertex_colors, file);
  const Vector3d middle = middleOf(mesh.positions, file);
  Unrolled head;
  for (std::size_t f = 0; f < mesh.faceCount(); ++f) {
    const std::span<const int> face = mesh.face(f);
    const auto off = [&](int v) -> Vector3d { return mesh.positions[static_cast<std::size_t>(v)] - middle; };
    const auto color = [&](int v) {
      const std::array<float, 3>& one = mesh.vertex_colors[static_cast<std::size_t>(v)];
      return Vector3d(double(one[0]), double(one[1]), double(one[2]));
    };
    for (std::size_t k = 1; k + 1 < face.size(); ++k)
      head.draw({off(face[0]), off(face[k]), off(face[k + 1])}, {color(face[0]), color(face[k]), color(face[k + 1])});
  }
  if (std::ranges::none_of(head.texels, [](const Texel& one) { return one.distance >= 0; }))
    throw InputError(file, "", "has no face round a head", kMend);
  head.fill();
  Image image{kWidth, kHeight, {}};
  for (const Texel& texel : head.texels) {
    for (int c = 0; c < 3; ++c)
      image.rgba.push_back(static_cast<unsigned char>(std::lround(255 * std::clamp(texel.color[c], 0.0, 1.0))));
    image.rgba.push_back(255);
  }
  return image;
}

}  // namespace app

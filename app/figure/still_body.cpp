#include "app/figure/still_body.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

namespace app {

namespace {

using Vec3 = Eigen::Vector3d;
using Box = Eigen::AlignedBox2d;  // x and z

constexpr int kLevels = 192;
constexpr double kNarrow = 0.62;       // a neck's cross-section over the head's, at most
constexpr double kWide = 1.5;          // what lies below over the neck's, at least
constexpr double kOpenNeck = 0.15;     // an open neck's end over the head's cross-section, at least
constexpr double kLeastHead = 0.06;    // of the mesh's height
constexpr double kSlimHead = 0.3;      // a head's width and depth over its height with the neck, at least
constexpr double kBroadHead = 1.6;     // and at most
constexpr double kHeadsOfFigure = 4;   // a whole figure's height in heads with neck, at least
constexpr double kAhead = 0.05;        // of the head's height: the face before the neck, at least
constexpr double kUsualHeight = 1.70;  // m
constexpr double kUsualHead = 0.27;    // m, from the neck's narrowest level to the crown

// The mesh's outline level by level, from the top down.
struct Outline {
  double low = 0, high = 0;
  std::vector<Box> levels;

  double heightOf(int level) const { return high - (level + 0.5) / kLevels * (high - low); }
  double areaOf(int level) const {
    const Box& box = levels[static_cast<std::size_t>(level)];
    return box.isEmpty() ? 0 : box.sizes().x() * box.sizes().y();
  }
};

void extendLevels(const std::array<Vec3, 3>& corners, Outline& outline) {
  const double step = (outline.high - outline.low) / kLevels;
  const auto [low, high] = std::minmax({corners[0].y(), corners[1].y(), corners[2].y()});
  const int first = std::max(0, static_cast<int>(std::ceil((outline.high - high) / step - 0.5)));
  const int last = std::min(kLevels - 1, static_cast<int>(std::floor((outline.high - low) / step - 0.5)));
  for (int level = first; level <= last; ++level) {
    const double y = outline.heightOf(level);
    for (int k = 0; k < 3; ++k) {
      const Vec3 &a = corners[k], &b = corners[(k + 1) % 3];
      if ((a.y() - y) * (b.y() - y) > 0 || a.y() == b.y()) continue;
      const Vec3 p = a + (y - a.y()) / (b.y() - a.y()) * (b - a);
      outline.levels[static_cast<std::size_t>(level)].extend(Eigen::Vector2d(p.x(), p.z()));
    }
  }
}

Outline outlineOf(std::span<const Eigen::Vector3f> positions, std::span<const std::uint32_t> triangles,
                  const Eigen::Matrix3d& turn) {
  Outline outline;
  outline.low = INFINITY, outline.high = -INFINITY;
  for (const std::uint32_t v : triangles) {
    const double y = turn.row(1).dot(positions[v].cast<double>());
    outline.low = std::min(outline.low, y), outline.high = std::max(outline.high, y);
  }
  outline.levels.resize(kLevels);
  if (!(outline.high > outline.low)) return outline;
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    const auto corner = [&](std::size_t k) { return Vec3(turn * positions[triangles[t + k]].cast<double>()); };
    extendLevels({corner(0), corner(1), corner(2)}, outline);
  }
  return outline;
}

// Whether what lies above a level is as wide and deep as heads are.
bool isHead(const Outline& outline, int neck) {
  Box all;
  for (int level = 0; level < neck; ++level) all.extend(outline.levels[static_cast<std::size_t>(level)]);
  const double height = outline.high - outline.heightOf(neck);
  return !all.isEmpty() && all.sizes().minCoeff() > kSlimHead * height && all.sizes().maxCoeff() < kBroadHead * height;
}

// The narrowest level under a head, -1: there is none.
int neckOf(const Outline& outline) {
  double head = 0;
  int narrowest = -1;
  for (int level = 0; level < kLevels; ++level) {
    const double area = outline.areaOf(level);
    if (narrowest < 0 || area < outline.areaOf(narrowest)) {
      if (area > head && narrowest < 0) head = area;
      if (area < kNarrow * head && level > kLeastHead * kLevels) narrowest = level;
    } else if (area > kWide * outline.areaOf(narrowest)) {
      return isHead(outline, narrowest) ? narrowest : -1;
    }
  }
  return narrowest >= 0 && outline.areaOf(narrowest) > kOpenNeck * head && isHead(outline, narrowest) ? narrowest : -1;
}

Eigen::Vector2d middleOf(const Outline& outline, int from, int to) {
  Box all;
  for (int level = from; level < to; ++level) all.extend(outline.levels[static_cast<std::size_t>(level)]);
  return all.isEmpty() ? Eigen::Vector2d::Zero().eval() : all.center();
}

// The axis towards which the head's lower half lies before the neck, as a chin does; +z where it hardly does.
Vec3 facing(const Outline& outline, int neck, std::string& how) {
  const double head = outline.high - outline.heightOf(neck);
  const Eigen::Vector2d ahead = middleOf(outline, neck / 2, neck * 7 / 8) - middleOf(outline, neck, neck + 1);
  how = "the face, ahead of the neck";
  if (ahead.cwiseAbs().maxCoeff() < kAhead * head) {
    how = "nothing in the mesh: +z was taken";
    return Vec3::UnitZ();
  }
  return std::abs(ahead.x()) > std::abs(ahead.y()) ? Vec3(std::copysign(1, ahead.x()), 0, 0)
                                                   : Vec3(0, 0, std::copysign(1, ahead.y()));
}

// Metres in a unit of the file, and a note of it.
std::pair<double, std::string> unitOf(double height, double head, bool whole) {
  constexpr std::array<std::pair<double, const char*>, 4> kUnits{
      {{1.0, "metres"}, {0.01, "centimetres"}, {0.0254, "inches"}, {0.001, "millimetres"}}};
  const double size = whole ? height : head;
  const double least = whole ? 1.2 : 0.2, most = whole ? 2.2 : 0.4;
  char note[160];
  for (const auto& [unit, name] : kUnits) {
    if (size * unit < least || size * unit > most) continue;
    std::snprintf(note, sizeof note, "unit: %s (the %s is %.2f m tall)", name, whole ? "mesh" : "head with its neck",
                  size * unit);
    return {unit, note};
  }
  const double usual = whole ? kUsualHeight : kUsualHead;
  std::snprintf(note, sizeof note, "unit: unknown (the %s is %.4g units tall), scaled to %.2f m",
                whole ? "mesh" : "head with its neck", size, usual);
  return {usual / size, note};
}

}  // namespace

std::optional<StillBody> measureStillBody(std::span<const Eigen::Vector3f> positions,
                                          std::span<const std::uint32_t> triangles) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Outline outline = outlineOf(positions, triangles, turn);
  int neck = neckOf(outline);
  const bool z_up = neck < 0;
  if (z_up) {
    turn << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    outline = outlineOf(positions, triangles, turn);
    neck = neckOf(outline);
  }
  if (neck < 0) return std::nullopt;

  StillBody body;
  const double height = outline.high - outline.low, head = outline.high - outline.heightOf(neck);
  body.whole = height > kHeadsOfFigure * head;
  const auto [unit, unit_note] = unitOf(height, head, body.whole);
  std::string how;
  const Vec3 forward = facing(outline, neck, how);
  const Eigen::Matrix3d stand =
      Eigen::AngleAxisd(-std::atan2(forward.x(), forward.z()), Vec3::UnitY()).toRotationMatrix();
  const Eigen::Vector2d middle = middleOf(outline, neck, neck + 1);
  const Vec3 under(middle.x(), outline.low, middle.y());
  body.to_metres.topLeftCorner<3, 3>() = unit * stand * turn;
  body.to_metres.topRightCorner<3, 1>() = -unit * (stand * under);
  body.neck = Vec3(0, unit * (outline.heightOf(neck) - outline.low), 0);
  body.head_height = unit * head;
  body.notes = {z_up ? "up axis: z, turned to y" : "up axis: y", unit_note,
                "head: what lies above the narrowest level, " + std::to_string(std::lround(100 * body.neck.y())) +
                    " cm above the mesh's lowest; facing told by " + how};
  return body;
}

bool turnFacesOutwards(SkinnedMesh& mesh) {
  std::vector<std::uint32_t>& index = mesh.triangles;
  const auto place = [&](std::uint32_t v) { return mesh.positions[v].cast<double>(); };
  Vec3 middle = Vec3::Zero();
  for (const std::uint32_t v : index) middle += place(v) / static_cast<double>(index.size());
  double volume = 0, agreement = 0;
  for (std::size_t t = 0; t + 2 < index.size(); t += 3) {
    const Vec3 a = place(index[t]) - middle, b = place(index[t + 1]) - middle, c = place(index[t + 2]) - middle;
    volume += a.dot(b.cross(c));
    agreement += (b - a).cross(c - a).dot(mesh.normals[index[t]].cast<double>());
  }
  if (volume >= 0) return false;
  for (std::size_t t = 0; t + 2 < index.size(); t += 3) std::swap(index[t + 1], index[t + 2]);
  // Normals of the file may point outwards though its faces do not.
  if (agreement > 0)
    for (Eigen::Vector3f& normal : mesh.normals) normal = -normal;
  return true;
}

bool isWholeBody(const PolygonMesh& mesh) {
  std::vector<Eigen::Vector3f> positions;
  for (const Vec3& p : mesh.positions) positions.push_back(p.cast<float>());
  std::vector<std::uint32_t> triangles;
  for (std::size_t f = 0; f < mesh.faceCount(); ++f) {
    const std::span<const int> face = mesh.face(f);
    for (std::size_t k = 1; k + 1 < face.size(); ++k)
      for (const int corner : {face[0], face[k], face[k + 1]}) triangles.push_back(static_cast<std::uint32_t>(corner));
  }
  const std::optional<StillBody> body = measureStillBody(positions, triangles);
  return body && body->whole;
}

}  // namespace app

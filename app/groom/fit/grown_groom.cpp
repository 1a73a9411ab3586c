#include "app/groom/fit/grown_groom.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "render/strands/strand_growth.h"

namespace app {
namespace {

using Eigen::Vector3f;

constexpr int kSide = 512;                          // pixels of a silhouette
constexpr float kDistance = 0.6f;                   // m, of the eye from the middle
constexpr float kFocus = 0.9f * kSide / 2 / 0.75f;  // pixels; a half angle of 37 degrees

struct Silhouette {
  std::vector<char> full = std::vector<char>(kSide * kSide, 0);

  void disc(float x, float y, float radius) {
    const int reach = std::max(0, static_cast<int>(std::lround(radius)));
    const int px = static_cast<int>(x), py = static_cast<int>(y);
    for (int j = std::max(0, py - reach); j <= std::min(kSide - 1, py + reach); ++j)
      for (int i = std::max(0, px - reach); i <= std::min(kSide - 1, px + reach); ++i)
        full[static_cast<std::size_t>(j * kSide + i)] = 1;
  }
};

Silhouette drawFrom(const Groom& groom, const Vector3f& middle, float scale, int side, float width) {
  Silhouette picture;
  const int axis = side / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
  const float sign = side % 2 == 0 ? 1.0f : -1.0f;
  for (std::size_t s = 0; s < groom.strandCount(); ++s) {
    const auto strand = groom.strand(s);
    for (std::size_t k = 0; k + 1 < strand.size(); ++k) {
      const int steps = 1 + static_cast<int>(scale * (strand[k + 1] - strand[k]).norm() / 0.0015f);
      for (int step = 0; step <= steps; ++step) {
        const Vector3f p =
            scale *
            (strand[k] + (strand[k + 1] - strand[k]) * (static_cast<float>(step) / static_cast<float>(steps)) - middle);
        const float depth = std::max(kDistance - sign * p[axis], 0.05f), zoom = kFocus / depth;
        picture.disc(kSide / 2.0f + zoom * p[u], kSide / 2.0f + zoom * p[v], 0.5f * width * zoom);
      }
    }
  }
  return picture;
}

float faceArea(const sim::HairMeshShape& shape, const sim::RootFace& face) {
  const auto root = [&](int k) {
    return shape.positions[static_cast<std::size_t>(
        shape.column_first[static_cast<std::size_t>(face.columns[static_cast<std::size_t>(k)])])];
  };
  sim::Vec3 twice = (root(1) - root(0)).cross(root(2) - root(0));
  if (face.corner_count == 4) twice += (root(2) - root(0)).cross(root(3) - root(0));
  return static_cast<float>(0.5 * twice.norm());
}

}  // namespace

Groom growGroom(const sim::HairMeshShape& shape, const render::HairLook& look, int strands, int points,
                std::span<const ColumnShare> shares) {
  std::vector<render::HairFace> faces;
  for (const sim::RootFace& face : shape.root_faces) {
    render::HairFace& out = faces.emplace_back();
    out.layers = shape.bundleLayers(face);
    out.area = faceArea(shape, face);
    for (int k = 0; k < face.corner_count; ++k)
      out.first_vertex[static_cast<std::size_t>(k)] =
          shape.column_first[static_cast<std::size_t>(face.columns[static_cast<std::size_t>(k)])];
  }
  std::vector<float> positions;
  for (std::size_t v = 0; v < shape.positions.size(); ++v) {
    const sim::Vec3 grows_at =
        shape.positions[v] + (shape.groom_offsets.empty() ? sim::Vec3::Zero().eval() : shape.groom_offsets[v]);
    for (int k = 0; k < 3; ++k) positions.push_back(static_cast<float>(grows_at[k]));
  }
  std::vector<render::LookShare> roots(shares.empty() ? 0 : shape.positions.size());
  for (std::size_t c = 0; c < shares.size(); ++c) {
    render::LookShare& root = roots[static_cast<std::size_t>(shape.column_first[c])];
    root.clump = static_cast<float>(shares[c].clump);
    root.curl = static_cast<float>(shares[c].curl);
    root.frizz = static_cast<float>(shares[c].frizz);
    root.width = static_cast<float>(shares[c].width);
  }
  render::StrandGrowth growth(faces, positions, strands, 3, look, {roots, {}});
  growth.setPositions(positions);
  Groom groom;
  std::vector<render::CurvePoint> curve(static_cast<std::size_t>(points));
  for (int s = 0; s < growth.strandCount(); ++s) {
    growth.growEven(growth.strand(s), curve);
    for (const render::CurvePoint& point : curve) groom.points.push_back(point.position);
    groom.strand_first.push_back(static_cast<std::uint32_t>(groom.points.size()));
  }
  return groom;
}

Groom someStrands(const Groom& groom, std::size_t most) {
  const std::size_t step = std::max<std::size_t>(1, (groom.strandCount() + most - 1) / most);
  Groom some;
  for (std::size_t s = 0; s < groom.strandCount(); s += step) {
    const auto strand = groom.strand(s);
    some.points.insert(some.points.end(), strand.begin(), strand.end());
    some.strand_first.push_back(static_cast<std::uint32_t>(some.points.size()));
  }
  return some;
}

double silhouetteOverlap(const Groom& a, const Groom& b, double width) {
  Eigen::AlignedBox3f box;
  for (const Vector3f& p : a.points) box.extend(p);
  const float scale = 0.5f / std::max(box.diagonal().norm(), 1e-6f);
  double least = 1;
  for (int side = 0; side < 6; ++side) {
    const float wide = static_cast<float>(width) * scale;
    const Silhouette one = drawFrom(a, box.center(), scale, side, wide),
                     other = drawFrom(b, box.center(), scale, side, wide);
    double both = 0, either = 0;
    for (std::size_t k = 0; k < one.full.size(); ++k) {
      both += one.full[k] && other.full[k] ? 1 : 0;
      either += one.full[k] || other.full[k] ? 1 : 0;
    }
    least = std::min(least, either > 0 ? both / either : 1);
  }
  return least;
}

}  // namespace app

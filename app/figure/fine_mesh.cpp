#include "app/figure/fine_mesh.h"

#include <algorithm>
#include <cmath>

namespace app {

namespace {

using Corners = std::array<std::uint32_t, 3>;

Corners cornersOf(const SkinnedMesh& mesh, std::size_t triangle) {
  return {mesh.triangles[triangle], mesh.triangles[triangle + 1], mesh.triangles[triangle + 2]};
}

float longestEdge(const SkinnedMesh& mesh, const Corners& corners) {
  float longest = 0;
  for (std::size_t k = 0; k < 3; ++k)
    longest = std::max(longest, (mesh.positions[corners[k]] - mesh.positions[corners[(k + 1) % 3]]).norm());
  return longest;
}

// Parts that each edge of a triangle is divided into.
int partsOf(float edge, float longest) {
  return static_cast<int>(std::ceil(std::min(1000.0f, edge / longest)));
}

// The four joints that carry a blend most, in shares of their sum.
void blendSkinning(const Corners& corners, const std::array<float, 3>& share, SkinnedMesh& mesh) {
  std::vector<std::pair<float, std::uint16_t>> carried;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t j = 0; j < 4; ++j) {
      const std::uint16_t joint = mesh.joints[corners[k]][j];
      const float weight = share[k] * mesh.weights[corners[k]][j];
      const auto known = std::ranges::find(carried, joint, &std::pair<float, std::uint16_t>::second);
      if (known == carried.end())
        carried.emplace_back(weight, joint);
      else
        known->first += weight;
    }
  }
  std::ranges::sort(carried, std::greater());
  carried.resize(4);
  std::array<std::uint16_t, 4> joints{};
  std::array<float, 4> weights{};
  float sum = 0;
  for (const auto& [weight, joint] : carried) sum += weight;
  for (std::size_t j = 0; j < 4; ++j)
    joints[j] = carried[j].second, weights[j] = carried[j].first / std::max(sum, 1e-9f);
  mesh.joints.push_back(joints);
  mesh.weights.push_back(weights);
}

std::uint32_t addBlend(const Corners& corners, const std::array<float, 3>& share, SkinnedMesh& mesh) {
  Eigen::Vector3f place = Eigen::Vector3f::Zero(), normal = place;
  for (std::size_t k = 0; k < 3; ++k) {
    place += share[k] * mesh.positions[corners[k]];
    normal += share[k] * mesh.normals[corners[k]];
  }
  mesh.positions.push_back(place);
  mesh.normals.push_back(normal.normalized());
  blendSkinning(corners, share, mesh);
  return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

void divide(const Corners& corners, int parts, SkinnedMesh& mesh) {
  std::vector<std::uint32_t> row, before;
  for (int i = 0; i <= parts; ++i) {
    row.clear();
    for (int j = 0; j <= parts - i; ++j) {
      const std::array<float, 3> share{float(parts - i - j) / float(parts), float(j) / float(parts),
                                       float(i) / float(parts)};
      const auto corner = std::ranges::find(share, 1.0f);
      row.push_back(corner != share.end() ? corners[static_cast<std::size_t>(corner - share.begin())]
                                          : addBlend(corners, share, mesh));
    }
    for (std::size_t j = 0; i > 0 && j < row.size(); ++j) {
      mesh.triangles.insert(mesh.triangles.end(), {before[j], before[j + 1], row[j]});
      if (j + 1 < row.size()) mesh.triangles.insert(mesh.triangles.end(), {before[j + 1], row[j + 1], row[j]});
    }
    std::swap(row, before);
  }
}

// How many vertices dividing would add.
double addedBy(const SkinnedMesh& mesh, float longest) {
  double added = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const double parts = partsOf(longestEdge(mesh, cornersOf(mesh, t)), longest);
    added += 0.5 * (parts + 1) * (parts + 2) - 3;
  }
  return added;
}

}  // namespace

SkinnedMesh withoutLongEdges(const SkinnedMesh& mesh, float longest) {
  SkinnedMesh fine;
  fine.positions = mesh.positions, fine.normals = mesh.normals;
  fine.joints = mesh.joints, fine.weights = mesh.weights;
  while (addedBy(mesh, longest) > double(kMaxDivided)) longest *= 1.25f;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const Corners corners = cornersOf(mesh, t);
    divide(corners, std::max(1, partsOf(longestEdge(mesh, corners), longest)), fine);
  }
  return fine;
}

}  // namespace app

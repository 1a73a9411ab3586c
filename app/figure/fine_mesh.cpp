#include "app/figure/fine_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

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
  if (!mesh.cloth.empty()) {
    float cloth = 0;
    for (std::size_t k = 0; k < 3; ++k) cloth += share[k] * mesh.cloth[corners[k]];
    mesh.cloth.push_back(cloth);
  }
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

void halveEdges(const std::vector<bool>& inside, SkinnedMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> made;
  const auto middleOf = [&](std::uint32_t a, std::uint32_t b) {
    const auto [at, fresh] = made.try_emplace(std::minmax(a, b));
    if (fresh) at->second = addBlend({a, b, b}, {0.5f, 0.5f, 0}, mesh);
    return at->second;
  };
  std::vector<std::uint32_t> triangles;
  const auto add = [&](const Corners& corners) { triangles.insert(triangles.end(), corners.begin(), corners.end()); };
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    Corners v = cornersOf(mesh, t);
    std::array<bool, 3> halved;  // the edge from corner k on
    for (std::size_t k = 0; k < 3; ++k) halved[k] = inside[v[k]] && inside[v[(k + 1) % 3]];
    const auto count = std::ranges::count(halved, true);
    // Turned so that a single edge comes first, or the one left whole last.
    while ((count == 1 && !halved[0]) || (count == 2 && halved[2])) {
      std::ranges::rotate(v, v.begin() + 1);
      std::ranges::rotate(halved, halved.begin() + 1);
    }
    if (count == 0) {
      add(v);
      continue;
    }
    const std::uint32_t first = middleOf(v[0], v[1]);
    if (count == 1) {
      add({v[0], first, v[2]}), add({first, v[1], v[2]});
      continue;
    }
    const std::uint32_t second = middleOf(v[1], v[2]);
    add({first, v[1], second});
    if (count == 2) {
      add({v[0], first, second}), add({v[0], second, v[2]});
      continue;
    }
    const std::uint32_t third = middleOf(v[2], v[0]);
    add({v[0], first, third}), add({second, v[2], third}), add({first, second, third});
  }
  mesh.triangles = std::move(triangles);
}

}  // namespace app

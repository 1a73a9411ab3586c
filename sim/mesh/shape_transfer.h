// Transfers the shape of hair between hair meshes on one scalp: a style at two resolutions.
//
// A target vertex takes the source's root triangle nearest to its column's root, and on its three columns the same
// share of the length. Its displacement from rest, in the head's frame, is the weighted mean of those six vertices'.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <span>
#include <vector>

#include "sim/mesh/hair_mesh.h"

namespace sim {

struct ShapeTransfer {
  static constexpr int kSources = 6;
  struct Row {
    std::array<int, kSources> vertex{};
    std::array<float, kSources> weight{};  // sum to 1
  };
  std::vector<Row> rows;  // per target vertex
};

ShapeTransfer makeShapeTransfer(const HairMesh& from, const HairMesh& to);

// positions (m, world) of `to` from those of `from`, both hanging on a head that stands at head_to_world.
void transferPositions(const ShapeTransfer& transfer, const HairMesh& from, const HairMesh& to,
                       const Eigen::Isometry3d& head_to_world, std::span<const Vec3> source, std::span<Vec3> target);

// Vectors that need no rest shape: velocities (m/s).
void transferVectors(const ShapeTransfer& transfer, std::span<const Vec3> source, std::span<Vec3> target);

}  // namespace sim

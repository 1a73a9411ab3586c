// Points of the hair that can be followed in every mesh of one haircut, so that meshes of different resolution can be
// compared.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sim/mesh/hair_mesh.h"

namespace bench {

// A point held by the corners of one tetrahedron: x = sum weights x_v; `offset` (m, in the rest shape's frame) is what
// a point outside every tetrahedron stands off the nearest one.
struct MaterialPoint {
  std::array<int, 4> v{};
  std::array<double, 4> weights{};
  sim::Vec3 offset = sim::Vec3::Zero();

  sim::Vec3 at(std::span<const sim::Vec3> x) const;
};

// Where a point of the rest shape's frame lies in a mesh: in the corner tetrahedron that it is least outside of, its
// barycentric coordinates cut to that tetrahedron.
MaterialPoint materialPoint(const sim::HairMesh& mesh, const sim::Vec3& p);

// The rest positions (m) of the tips of a mesh's columns.
std::vector<sim::Vec3> tipsOf(const sim::HairMesh& mesh);

}  // namespace bench

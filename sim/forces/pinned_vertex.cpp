#include "sim/forces/pinned_vertex.h"

#include <algorithm>
#include <cassert>

#include "sim/mesh/vertex_constraint.h"

namespace sim {
namespace {

double lengthTo(const HairMesh& mesh, int vertex) {
  double length = 0;
  for (int v = mesh.shape.column_first[mesh.column_of[vertex]] + 1; v <= vertex; ++v)
    length += (mesh.shape.positions[v] - mesh.shape.positions[v - 1]).norm();
  return length;
}

}  // namespace

int holdingPins(const HairMesh& mesh, std::span<const PinnedVertex> pins, std::span<const Vec3> roots, double dt,
                const HairState& state, std::vector<PinnedVertex>& holding) {
  int out_of_reach = 0;
  holding.clear();
  for (PinnedVertex pin : pins) {
    assert(pin.vertex >= 0 && pin.vertex < mesh.vertexCount());
    if (mesh.isRoot(pin.vertex) || !(pin.stiffness > 0)) continue;
    const double distance = (pin.target - roots[mesh.column_of[pin.vertex]]).norm();
    if (!(distance <= kPinReach * lengthTo(mesh, pin.vertex)) || !pin.velocity.allFinite()) {
      ++out_of_reach;
      continue;
    }
    const Vec3 way = pin.target - state.positions[pin.vertex];
    const double most = dt * (kPinClosing + pin.velocity.norm());
    if (pin.firm()) {
      pin.velocity = way * (std::min(1.0, most / std::max(most, way.norm())) / dt);
      if (way.norm() > most) pin.target = state.positions[pin.vertex] + dt * pin.velocity;
    }
    const auto later = [&](const PinnedVertex& other) { return other.vertex > pin.vertex; };
    const auto same = [&](const PinnedVertex& other) { return other.firm() && other.vertex == pin.vertex; };
    if (pin.firm() && std::ranges::any_of(holding, same)) continue;
    holding.insert(std::ranges::find_if(holding, later), pin);
  }
  return out_of_reach;
}

void placePinned(std::span<const PinnedVertex> pins, HairState& state) {
  for (const PinnedVertex& pin : pins) {
    if (!pin.firm()) continue;
    state.positions[pin.vertex] = pin.target;
    state.velocities[pin.vertex] = pin.velocity;
  }
}

void constrainPinned(std::span<const PinnedVertex> pins, std::span<const Vec3> x_hat, double h,
                     std::vector<VertexConstraint>& constraints) {
  for (const PinnedVertex& pin : pins) {
    if (!pin.firm()) continue;
    VertexConstraint held{pin.vertex,
                          Eigen::Matrix3d::Zero(),
                          (pin.target - x_hat[pin.vertex]) / h,
                          3,
                          {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()}};
    const auto at = std::ranges::lower_bound(constraints, pin.vertex, {}, &VertexConstraint::vertex);
    if (at != constraints.end() && at->vertex == pin.vertex) {
      *at = held;
    } else {
      constraints.insert(at, held);
    }
  }
}

}  // namespace sim

// Pins: hair mesh vertices drawn to points of the step's input, by a spring or firmly.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "sim/mesh/hair_mesh.h"
#include "sim/mesh/hair_state.h"

namespace sim {

struct VertexConstraint;

struct PinnedVertex {
  int vertex = 0;
  Vec3 target = Vec3::Zero();    // m, world, at the step's end
  Vec3 velocity = Vec3::Zero();  // m/s, that brought it there
  // N/m; infinite: the solve prescribes the vertex's velocity, and it ends the step on the target.
  double stiffness = std::numeric_limits<double>::infinity();

  bool firm() const { return stiffness == std::numeric_limits<double>::infinity(); }
  bool operator==(const PinnedVertex&) const = default;
  HAIRMESH_FIELDS(vertex, target, velocity, stiffness)
};

// A pin is released where its target is farther from the root than so many times the column's length to the vertex.
inline constexpr double kPinReach = 2;
// m/s, above the target's own speed, at which a firmly pinned vertex approaches its target.
inline constexpr double kPinClosing = 2;

// The pins that hold in this step, sorted by vertex; the target of a firm one is where the vertex ends the step. Left
// out are those out of reach, without stiffness, on a root, and all but the first firm one of a vertex. `roots`: m, one
// a column. Returns the number out of reach.
int holdingPins(const HairMesh& mesh, std::span<const PinnedVertex> pins, std::span<const Vec3> roots, double dt,
                const HairState& state, std::vector<PinnedVertex>& holding);

// Puts firmly pinned vertices on their targets.
void placePinned(std::span<const PinnedVertex> pins, HairState& state);

// Adds the constraints of firm pins, x_hat + h v = target, in place of contacts' constraints of the same vertices.
void constrainPinned(std::span<const PinnedVertex> pins, std::span<const Vec3> x_hat, double h,
                     std::vector<VertexConstraint>& constraints);

}  // namespace sim

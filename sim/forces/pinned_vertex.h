// Pins: hair mesh vertices that are drawn to points of the step's input, by a spring or firmly.
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
};

// A pin lets go where its target is farther from the column's root than so many times the column is long to the vertex:
// hair does not stretch further.
inline constexpr double kPinReach = 2;
// m/s, beside its target's own speed, at which a vertex closes in on a target that it is firmly pinned to.
inline constexpr double kPinClosing = 2;

// The pins that hold in this step, firm ones with the place that the vertex is taken to as their target. Left out are
// those out of reach, without stiffness, on a root (which the scalp carries), and all but the first firm one of a
// vertex. Sorted by vertex. `roots`: m, one a column. Returns how many are out of reach.
int holdingPins(const HairMesh& mesh, std::span<const PinnedVertex> pins, std::span<const Vec3> roots, double dt,
                const HairState& state, std::vector<PinnedVertex>& holding);

// Puts firmly pinned vertices on their targets.
void placePinned(std::span<const PinnedVertex> pins, HairState& state);

// Adds the constraints of firm pins to those of contacts, in whose place they come: x = x_hat + h v ends on the target.
void constrainPinned(std::span<const PinnedVertex> pins, std::span<const Vec3> x_hat, double h,
                     std::vector<VertexConstraint>& constraints);

}  // namespace sim

// Inversion recovery: columns that rest inverted are guided to the rest shape.
//
// A tip thrown through its neighbours keeps the length of every edge. The way back leads through a flat prism, so the
// mirrored shape can be an equilibrium of all forces, the volume force included. Forces come first: an element (a
// corner tetrahedron below kInvertedShare of its rest volume, a column folded back on itself) must stay inverted for
// kInvertedFor seconds, of which each that its columns spend at rest counts kRestWeight times. Then these move to the
// rest shape within kGuideTime seconds, along lines that are straight as seen from the head. Bodies push them out as
// ever, and columns that a body holds are left alone. An element that is inverted beside a guided column is one fold
// with it, and goes home with it. A column that inverts again waits four times as long each time.
#pragma once

#include <span>
#include <vector>

#include "sim/forces/pinned_vertex.h"
#include "sim/mesh/hair_mesh.h"
#include "sim/mesh/hair_state.h"

namespace sim {

inline constexpr double kInvertedFor = 6;  // s
inline constexpr double kRestWeight = 4;   // so 1.5 s at rest

// The step that was taken: positions (m) at its start; `state` holds its end, and a memory that has its size.
struct RecoveredStep {
  const HairMesh& mesh;
  std::span<const Vec3> start;
  double dt;                             // s
  bool looks = true;                     // for newly inverted columns, too
  std::span<const PinnedVertex> pins{};  // that hold: what a tie squeezes is not wound
};

// Looks for inverted columns every 0.1 s, and moves those that are guided: returns how many. `touched`: scratch.
int recoverInversions(const RecoveredStep& step, std::vector<char>& touched, HairState& state);

// Guides every column to where `there` has it, over the next steps.
void guideTo(const HairMesh& mesh, const HairState& there, RecoveryMemory& recovery);

}  // namespace sim

// Position correction and deformation minimization after a step (Wu and Yuksel 2016, figures 4 and 5), until nothing is
// left inside.
#pragma once

#include <span>
#include <vector>

#include "sim/contact.h"
#include "sim/deformation.h"
#include "sim/stage_clock.h"

namespace sim {

// What the corrections of one hair keep from step to step: sized once.
struct PositionCorrection {
  DeformationMinimizer minimizer;
  std::vector<int> all_vertices;  // but the roots
  std::vector<Vec3> uncorrected, displacement;
  std::vector<Penetration> penetrations;
  std::vector<int> corrected;  // vertices, of the last round
  std::vector<unsigned char> held;
  ContactScratch search;

  explicit PositionCorrection(const HairMesh& mesh);
};

// The step that is to be corrected.
struct CorrectedStep {
  const HairMesh& mesh;
  const SimParams& params;
  const Colliders& colliders;
  std::span<const Vec3> start;  // m, positions at its start
  double dt;                    // s
};

// Brings the vertices that lie inside a collider, or went through one within the step, back to its surface, lets the
// others follow, and enters the contacts into the state. Afterwards no external vertex (with collide_inner: no vertex)
// lies below the offset by more than the slack of contactMargins, but for overlaps that stood before the step: these
// shrink by max_depenetration, and leave no velocity behind. The work is bounded: five rounds, and eight more of what
// those corrected last.
void correctPositions(const CorrectedStep& step, StageClock& clock, PositionCorrection& scratch, HairState& state,
                      StepReport& report);

// Lets all others follow the vertices that were pushed apart among the hair's own bundles, positions and velocities.
// unmoved: m, where all were before; moved: per vertex, whether it was pushed.
void followPushed(const CorrectedStep& step, std::span<const Vec3> unmoved, std::span<const unsigned char> moved,
                  PositionCorrection& scratch, HairState& state);

// Who was pushed back to where it came from has no speed, whatever the solve had given it for its way in: seen from the
// root, a vertex that is not where it was unpushed (m) is no faster than its way from start to end. Hair that wind or
// gravity presses into itself would keep a velocity for ever that takes it nowhere.
void slowPushed(const CorrectedStep& step, std::span<const Vec3> unpushed, HairState& state);

}  // namespace sim

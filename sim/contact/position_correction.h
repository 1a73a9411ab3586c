// Position correction and deformation minimization after a step (Wu and Yuksel 2016, figures 4 and 5), until nothing is
// left inside.
#pragma once

#include <span>
#include <vector>

#include "sim/contact/contact.h"
#include "sim/contact/deformation.h"
#include "sim/step_report.h"

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
  int round = 0, moved = 0;  // rounds so far; vertices that the last one moved
  double follow_speed = 0;   // m/s, that followers take at most

  explicit PositionCorrection(const HairMesh& mesh);
};

// The step that is to be corrected.
struct CorrectedStep {
  const HairMesh& mesh;
  const SimParams& params;
  Colliders colliders;
  std::span<const Vec3> start;  // m, positions at its start
  double dt;                    // s
};

// Rounds of contact search, position correction and deformation minimization. Minimization may push other vertices into
// a body, which the paper leaves to future work: kRounds rounds minimize, holding what was corrected before, and
// kPlainRounds more correct alone. Afterwards no external vertex (with collide_inner: no vertex) lies below the contact
// offset by more than the slack of contactMargins, except for initial overlaps: these shrink by max_depenetration a
// step and leave no velocity.
//
// Usage: beginCorrections; while (findContacts) { correctPositions; minimizeDeformation }; updateVelocities.
void beginCorrections(PositionCorrection& scratch);

// Finds the vertices inside colliders, or gone through one within the step. Returns whether another round is due.
bool findContacts(const CorrectedStep& step, PositionCorrection& scratch, const HairState& state, StepReport& report);

// Moves what was found onto the surface (figure 4) and enters the contacts into the state.
void correctPositions(const CorrectedStep& step, PositionCorrection& scratch, HairState& state, StepReport& report);

// All others follow the corrected vertices so that edge vectors change least: equations (3) and (4).
void minimizeDeformation(const CorrectedStep& step, PositionCorrection& scratch, HairState& state, StepReport& report);

// Velocities follow the corrections, the contacts are sorted by vertex, and the two-step history of what moved
// restarts.
void updateVelocities(const CorrectedStep& step, PositionCorrection& scratch, HairState& state);

// All of the above, for callers that need no times of stages.
void correctContacts(const CorrectedStep& step, PositionCorrection& scratch, HairState& state, StepReport& report);

// Lets all others follow the vertices that were pushed apart among the hair's own bundles, positions and velocities.
// unmoved: m, where all were before; moved: per vertex, whether it was pushed.
void followPushed(const CorrectedStep& step, std::span<const Vec3> unmoved, std::span<const unsigned char> moved,
                  PositionCorrection& scratch, HairState& state);

// Who was pushed back to where it came from has no speed, whatever the solve had given it for its way in: seen from the
// root, a vertex that is not where it was unpushed (m) is no faster than its way from start to end. Hair that wind or
// gravity presses into itself would keep a velocity for ever that takes it nowhere.
void slowPushed(const CorrectedStep& step, std::span<const Vec3> unpushed, HairState& state);

}  // namespace sim

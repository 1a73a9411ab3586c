// Position correction and deformation minimization after a step (Wu and Yuksel 2016, figures 4 and 5).
#pragma once

#include <span>
#include <vector>

#include "sim/contact/contact.h"
#include "sim/contact/deformation.h"
#include "sim/step_report.h"

namespace sim {

// Scratch of the corrections of one hair, sized once.
struct PositionCorrection {
  DeformationMinimizer minimizer;
  std::vector<int> all_vertices;  // without roots
  std::vector<Vec3> uncorrected, displacement;
  std::vector<Penetration> penetrations;
  std::vector<int> corrected;  // vertices, of the last round
  std::vector<unsigned char> held;
  ContactScratch search;
  int round = 0, moved = 0;  // rounds so far; vertices that the last one moved
  bool followed = false;     // others moved after these
  double follow_speed = 0;   // m/s, bound of the velocity that followers take
  long points = 0;           // closest points of colliders asked for in this step (Colliders::counted)
  long max_points = 0;       // more of them cut the corrections short
  int max_minimizations = 0;
  int minimizations = 0;  // iterations of deformation minimization in this step

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
// a body, which the paper leaves to future work: kRounds rounds minimize with all corrected vertices held, and
// kPlainRounds more only correct. Afterwards no external vertex (with collide_inner: no vertex) lies below the contact
// offset by more than the slack of contactMargins, except initial overlaps: these shrink by max_depenetration a step
// and leave no velocity. Beyond max_points closest points of colliders the corrections are cut short: searches look at
// final positions only, and nothing else follows.
//
// Usage: limitCorrectionWork once a step, then beginCorrections; while (findContacts) { correctPositions;
// minimizeDeformation }; updateVelocities.
void beginCorrections(PositionCorrection& scratch);

// Before a step's first correction: its counts are zero. They are bounded by the corrections' own bounds and the
// step's; `published`: by neither.
void limitCorrectionWork(const WorkBounds& bounds, bool published, PositionCorrection& scratch);

// Finds the vertices that are inside a collider or went through one. Returns whether another round is due.
bool findContacts(const CorrectedStep& step, PositionCorrection& scratch, const HairState& state, StepReport& report);

// Moves the vertices found to the surface (figure 4) and enters their contacts into the state.
void correctPositions(const CorrectedStep& step, PositionCorrection& scratch, HairState& state, StepReport& report);

// Moves all other vertices so that edge vectors change least: equations (3) and (4).
void minimizeDeformation(const CorrectedStep& step, PositionCorrection& scratch, HairState& state, StepReport& report);

// Velocities follow the corrections. Sorts the contacts by vertex; restarts the two-step history of moved vertices.
void updateVelocities(const CorrectedStep& step, PositionCorrection& scratch, HairState& state);

// All of the above.
void correctContacts(const CorrectedStep& step, PositionCorrection& scratch, HairState& state, StepReport& report);

// Deformation minimization after self-contact: all others follow the pushed vertices, positions and velocities.
// unmoved: positions before the pushes, m; moved: per vertex, whether it was pushed.
void followPushed(const CorrectedStep& step, std::span<const Vec3> unmoved, std::span<const unsigned char> moved,
                  PositionCorrection& scratch, HairState& state);

// A vertex pushed back by self-contact keeps no more speed, relative to its root, than its net displacement over the
// step. unpushed: positions before the pushes, m.
void slowPushed(const CorrectedStep& step, std::span<const Vec3> unpushed, HairState& state);

}  // namespace sim

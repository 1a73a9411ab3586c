// How hair moves with a preset, in one moment: the hair as it is when the head has just turned and stopped.
#pragma once

#include <vector>

#include "app/figure/character.h"
#include "sim/contact/colliders.h"
#include "sim/mesh/hair_mesh.h"
#include "sim/sim_params.h"

namespace app {

// By value: it is simulated beside the frames.
struct Swing {
  sim::HairMesh mesh;
  sim::SimParams params;
  Rigid head = Rigid::Identity();    // scalp frame to world at the end
  std::vector<sim::Ellipsoid> body;  // at the end
};

// Turns head and body about the upright through the head's origin, by 60 degrees in 0.3 s to where they are given, from
// hair at rest. Returns the hair's positions (m, world).
std::vector<Vec3> swungHair(const Swing& swing);

}  // namespace app

// All that changes from step to step.
#pragma once

#include <vector>

#include "sim/hair_mesh.h"

namespace sim {

// A contact carried from one step to the next.
struct Contact {
  int vertex;
  int collider;            // index into StepInput::ellipsoids
  Vec3 normal;             // outward unit normal, world
  Vec3 collider_velocity;  // m/s of the collider's surface at the contact
  double pressure = 0;     // N, normal force of the last solve
  bool sticks = false;     // all three directions constrained (static friction)
};

struct HairState {
  std::vector<Vec3> positions;   // m, world, one per vertex
  std::vector<Vec3> velocities;  // m/s
  std::vector<Contact> contacts;
};

}  // namespace sim

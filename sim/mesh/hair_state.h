// All that changes from step to step: reset, compared, saved and restored as one (state_bytes.h).
#pragma once

#include <vector>

#include "sim/mesh/hair_memory.h"
#include "sim/mesh/hair_mesh.h"

namespace sim {

// A contact of an external vertex with a collider, carried from one step to the next.
struct Contact {
  int vertex = 0;
  int collider = 0;              // index into StepInput::ellipsoids
  Vec3 normal = Vec3::UnitY();   // outward unit normal at the step's end, world
  Vec3 velocity = Vec3::Zero();  // m/s that keeps the vertex at the contact offset and carried along with the surface
  double pressure = 0;           // N, normal force of the last solve
  bool sticks = false;           // static friction: all three directions are prescribed
  Vec3 friction_direction =
      Vec3::Zero();  // unit tangent: the way friction pushes it while it slides; zero: it has not slid
  HAIRMESH_FIELDS(vertex, collider, normal, velocity, pressure, sticks, friction_direction)
};

// Contacts a vertex, in the mean over all, that steps have memory for from the first: more take it when they come.
inline constexpr int kMaxTouches = 2;

struct HairState {
  std::vector<Vec3> positions;   // m, world, one per vertex
  std::vector<Vec3> velocities;  // m/s
  std::vector<Contact> contacts;
  // The step before, for two-step integrators; empty after a restart.
  std::vector<Vec3> previous_positions, previous_velocities;
  double previous_dt = 0;  // s
  HairMemory memory;
  HAIRMESH_FIELDS(positions, velocities, contacts, previous_positions, previous_velocities, previous_dt, memory)

  // Restarts the two-step history of a vertex: as if it had come here at its present velocity in a step of dt (s).
  void restartHistory(int vertex, double dt) {
    previous_positions[vertex] = positions[vertex] - dt * velocities[vertex];
    previous_velocities[vertex] = velocities[vertex];
  }
};

// Sizes the memory for a mesh. Of a memory that has its size it changes nothing.
void sizeMemory(const HairMesh& mesh, HairMemory& memory);

}  // namespace sim

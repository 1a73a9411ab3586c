#include "tests/stress/start_states.h"

#include <algorithm>
#include <limits>

#include "sim/step.h"

namespace stress {

void applyStart(const StressCase& one, const sim::HairMesh& mesh, Random& random, sim::HairState& state) {
  if (one.start == Start::kSettled) return;
  const std::vector<sim::Vec3> was = state.positions;
  const int layers = *std::max_element(mesh.layer_of.begin(), mesh.layer_of.end());
  const int chosen = 1 + random.below(std::max(layers, 1));
  for (int i = 0; i < mesh.vertexCount(); ++i) {
    if (mesh.isRoot(i)) continue;
    const int root_index = mesh.shape.column_first[mesh.column_of[i]];
    const sim::Vec3& root = was[root_index];
    sim::Vec3& x = state.positions[i];
    switch (one.start) {
      case Start::kCollapsed:
        x = root;
        break;
      case Start::kFlattened:
        if (mesh.layer_of[i] == chosen) x = was[i - 1];
        break;
      case Start::kInverted:
        // Every other layer stands on the far side of the layer below.
        if (mesh.layer_of[i] % 2 == 1) x = was[i - 1] - (was[i] - was[i - 1]);
        break;
      case Start::kInsideOut:
        x = 2 * root - was[i];
        break;
      case Start::kShuffled:
        x = was[random.below(mesh.vertexCount())];
        break;
      case Start::kNoise:
        x += random.box(one.start_size);
        break;
      case Start::kFast:
        state.velocities[i] = one.start_size * random.direction();
        break;
      case Start::kStretched:
        x = root + one.start_size * (was[i] - root);
        break;
      case Start::kSettled:
        break;
    }
  }
  state.contacts.clear();
  state.previous_dt = 0;
}

int injectFault(const sim::HairMesh& mesh, Random& random, sim::HairState& state) {
  const int vertex = random.below(mesh.vertexCount());
  sim::Vec3& value = random.chance(0.5) ? state.positions[vertex] : state.velocities[vertex];
  const double faults[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e30,
                           -1e6};
  value[random.below(3)] = faults[random.below(4)];
  return vertex;
}

}  // namespace stress

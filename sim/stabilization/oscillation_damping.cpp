#include "sim/stabilization/oscillation_damping.h"

#include <algorithm>
#include <limits>

namespace sim {
namespace {

constexpr double kOpposite = 0.5;  // of the larger of both squared speeds, that their product is below, negative
constexpr double kForced = 0.5;    // of a vertex's speed: roots that change theirs by more make it turn back

}  // namespace

int dampOscillation(const HairMesh& mesh, std::span<const Vec3> start, HairState& state) {
  OscillationMemory& memory = state.memory.oscillation;
  int held = 0;
  for (int c = 0; c < mesh.columnCount(); ++c) {
    const int root = mesh.shape.column_first[c];
    const Vec3 carrying = state.velocities[root], carried = state.positions[root] - start[root];
    const double jolt = (carrying - memory.carrying[c]).squaredNorm();
    memory.carrying[c] = carrying;
    for (int i = root + 1; i < mesh.shape.column_first[c + 1]; ++i) {
      Vec3& v = state.velocities[i];
      const Vec3 now = v - carrying;
      Vec3& before = memory.last[i];
      unsigned char& turns = memory.turns[i];
      const double square = now.squaredNorm();
      const bool back = square > kMinSpeed * kMinSpeed && jolt <= kForced * kForced * square &&
                        now.dot(before) < -kOpposite * std::max(square, before.squaredNorm());
      if (back && turns < std::numeric_limits<unsigned char>::max()) ++turns;
      if (!back && turns > 0) --turns;
      before = now;
      if (turns < kMinTurns) continue;
      ++held;
      const Vec3 unmoved = start[i] + carried;
      state.positions[i] = unmoved + 0.5 * (state.positions[i] - unmoved);
      v = carrying + 0.5 * now;
      before = 0.5 * now;
    }
  }
  return held;
}

}  // namespace sim

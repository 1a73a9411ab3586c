// A few steps of hair by every solver and arithmetic, on the kernels of one instruction set: writes where they end.
// kernel_sets_test.cpp compares what the sets write. Exit code 77: this processor does not have the set.
#include <cstdio>
#include <vector>

#include "tests/test_meshes.h"

namespace {

using sim::Integrator;
using sim::Precision;
using sim::Solver;
using sim::Vec3;
using test::Hair;

bool processorHasThem() {
#if HAIRMESH_KERNEL_LEVEL == 4
  return __builtin_cpu_supports("x86-64-v4");
#elif HAIRMESH_KERNEL_LEVEL == 3
  return __builtin_cpu_supports("x86-64-v3");
#else
  return true;
#endif
}

// Hair that is thrown, in double precision against a body (in single, what slides there and what sticks is a matter of
// rounding), three steps on.
std::vector<Vec3> steps(Solver solver, Precision precision, Integrator integrator) {
  sim::SimParams params;
  params.solver = solver, params.precision = precision, params.integrator = integrator;
  const bool single = precision != Precision::kDouble;
  params.tolerance = single ? 1e-6 : 1e-12;
  params.acceleration_tolerance = params.displacement_tolerance = 0, params.max_iterations = 2000;
  Hair hair(test::combedShape(test::mixedPatch(9, 0.2)), params);
  sim::Ellipsoid body;
  body.center = Vec3(0.04, -0.1, -0.06), body.radii = Vec3(0.06, 0.05, 0.03);
  if (!single) hair.bodies = {body};
  test::Random random(11);
  for (int i = 0; i < hair.mesh.vertexCount(); ++i) {
    if (!hair.mesh.isRoot(i)) hair.state.velocities[i] = Vec3(0.2, 0, -1) + random.vector(0.3);
  }
  for (int n = 0; n < 3; ++n) hair.step(1.0 / 60);
  return hair.state.positions;
}

}  // namespace

int main() {
  if (!processorHasThem()) return 77;
  for (int s = 0; s < static_cast<int>(Solver::kCount); ++s) {
    for (int p = 0; p < static_cast<int>(Precision::kCount); ++p) {
      for (int i = 0; i < static_cast<int>(Integrator::kCount); ++i) {
        for (const Vec3& x : steps(static_cast<Solver>(s), static_cast<Precision>(p), static_cast<Integrator>(i)))
          std::printf("%d %d %d %.17g %.17g %.17g\n", s, p, i, x.x(), x.y(), x.z());
      }
    }
  }
  return 0;
}

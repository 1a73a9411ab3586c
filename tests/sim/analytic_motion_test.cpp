// Small oscillations against the closed form of each time-stepping scheme: pendulum, stretching column, volume and
// shear element. For a mode x'' = -w^2 x - d x' the complex amplitude y = x - i v / w of the undamped scheme is
// multiplied by one number z a step: |z| is the decay, arg z the phase.
#include <gtest/gtest.h>

#include <complex>
#include <cstdio>

#include "tests/test_meshes.h"

namespace analytic_motion_test {

using sim::Integrator;
using sim::Vec3;
using test::Hair;
using Complex = std::complex<double>;

constexpr Integrator kIntegrators[] = {Integrator::kLinearizedEuler, Integrator::kBdf2};
const char* nameOf(Integrator integrator) {
  constexpr const char* kNames[] = {"linearized Euler", "BDF2"};
  return kNames[static_cast<int>(integrator)];
}

sim::SimParams bareMaterial(Integrator integrator) {
  sim::SimParams p = test::looseParticles();
  p.collide = false;
  p.integrator = integrator;
  p.solver = sim::Solver::kDefault;
  p.tolerance = 1e-13, p.acceleration_tolerance = 1e-16, p.displacement_tolerance = 0, p.max_iterations = 2000;
  return p;
}

test::PatchOptions oneSegment(bool triangles = false) {
  test::PatchOptions o;
  o.nx = o.nz = 1, o.layers = 2, o.spacing = 0.02, o.length = 0.05, o.mixed = triangles;
  return o;
}

// The factor of one step of length h on an undamped mode of frequency w (rad/s). Implicit Euler: y1 = y0 + i h w y1.
// BDF2: (3 y2 - 4 y1 + y0) / 2 = i h w y2, its principal root.
Complex factorOf(Integrator integrator, double h, double w) {
  const Complex step(0, h * w);
  if (integrator != Integrator::kBdf2) return 1.0 / (1.0 - step);
  return (2.0 + std::sqrt(1.0 + 2.0 * step)) / (3.0 - 2.0 * step);
}

// A mode: its frequency, and the displacement that it gives each vertex.
struct Mode {
  double frequency;  // rad/s
  std::vector<Vec3> shape;
};

template <class Displacement>
Mode modeOf(const sim::HairMesh& mesh, double frequency, const Displacement& displacement) {
  Mode mode{frequency, {}};
  for (int i = 0; i < mesh.vertexCount(); ++i) {
    mode.shape.push_back(mesh.isRoot(i) ? Vec3(Vec3::Zero()) : Vec3(displacement(mesh.shape.positions[i])));
  }
  return mode;
}

// Displaces the hair by `amplitude` of the mode and compares the factor of each step with `expected`; leaves out the
// first steps, in which BDF2's start dies away. Returns the largest difference.
double largestDeviation(Hair& hair, const Mode& mode, double amplitude, double dt, Complex expected) {
  const std::vector<Vec3> middle = hair.state.positions;
  double square = 0;
  for (std::size_t i = 0; i < middle.size(); ++i) {
    hair.state.positions[i] += amplitude * mode.shape[i];
    square += mode.shape[i].squaredNorm();
  }
  Complex before = 0;
  double worst = 0;
  for (int n = 0; n < 40; ++n) {
    hair.step(dt);
    Complex now = 0;
    for (std::size_t i = 0; i < middle.size(); ++i) {
      const Vec3& along = mode.shape[i];
      now += Complex(along.dot(hair.state.positions[i] - middle[i]),
                     -along.dot(hair.state.velocities[i]) / mode.frequency) /
             square;
    }
    // An amplitude that has all but died is lost in rounding.
    if (n > 15 && std::abs(now) > 1e-5 * amplitude) worst = std::max(worst, std::abs(now / before - expected));
    before = now;
  }
  return worst;
}

// One segment of taut column hangs; tension carries it back sideways: w^2 = g / length, stretch included.
TEST(Pendulum, PeriodAndDecayAreTheSchemes) {
  for (const Integrator integrator : kIntegrators) {
    std::vector<double> steps, phases;
    for (const double dt : {1.0 / 240, 1.0 / 120, 1.0 / 60, 1.0 / 30}) {
      sim::SimParams params = bareMaterial(integrator);
      params.stretch_along = 4e5;
      params.damping = 0.02;  // of stretch alone: a small swing does not feel it
      Hair hair(test::patchShape(oneSegment()), params);
      const sim::Edge& edge = hair.mesh.vertical_edges[0];
      const double mass = params.density * hair.mesh.vertex_volume[edge.b];
      const double length =
          edge.rest_length * (1 + mass * params.gravity * edge.rest_length / (params.stretch_along * edge.volume));
      for (int i = 0; i < hair.mesh.vertexCount(); ++i) {
        if (!hair.mesh.isRoot(i)) hair.state.positions[i].y() = -length;
      }
      const Mode mode =
          modeOf(hair.mesh, std::sqrt(params.gravity / length), [](const Vec3&) { return Vec3(0.6, 0, 0.8); });
      const Complex z = factorOf(integrator, dt, mode.frequency);
      EXPECT_LT(largestDeviation(hair, mode, 1e-6, dt, z), 1e-6) << nameOf(integrator) << ", step " << dt;
      const double period = 2 * M_PI * dt / std::arg(z), exact = 2 * M_PI / mode.frequency;
      std::printf("%-16s h 1/%-3.0f s: period %.4f s (continuous %.4f), amplitude kept a period %.3f\n",
                  nameOf(integrator), 1 / dt, period, exact, std::pow(std::abs(z), period / dt));
      steps.push_back(dt), phases.push_back(period / exact - 1);
    }
    RecordProperty(std::string("period_order_") + std::to_string(static_cast<int>(integrator)),
                   std::to_string(test::observedOrder(steps, phases)));
    EXPECT_NEAR(test::observedOrder(steps, phases), 2, 0.2) << "periods err with the square of the step";
  }
}

// A single prism of height H over a regular polygon of circumradius R. Its upper layer rises by z and widens by the
// share r: a tetrahedron about a lower corner changes by z / H, one about an upper corner by z / H + 2 r, and half the
// mass moves. In (z, R r): w^2 are the eigenvalues of K / rho [2 / H^2, 2 / HR; 2 / HR, 4 / R^2].
TEST(VolumeElement, SwingsAtItsTwoFrequencies) {
  constexpr double kHeight = 0.05, kRadius = 0.008;
  for (const int corners : {3, 4}) {
    sim::HairMeshShape shape;
    sim::RootFace face{corners, {0, 1, 2, corners == 4 ? 3 : -1}};
    for (int k = 0; k < corners; ++k) {
      const double turn = -2 * M_PI * k / corners;
      for (const double y : {0.0, kHeight}) {
        shape.positions.push_back(Vec3(kRadius * std::cos(turn), y, kRadius * std::sin(turn)));
      }
      shape.column_first.push_back(2 * k + 2);
    }
    shape.root_faces = {face};
    for (const Integrator integrator : kIntegrators) {
      sim::SimParams params = bareMaterial(integrator);
      params.gravity = 0;
      params.volume = 300;
      Hair hair(shape, params);
      Eigen::Matrix2d stiffness;
      const double cross = 2 / (kHeight * kRadius);
      stiffness << 2 / (kHeight * kHeight), cross, cross, 4 / (kRadius * kRadius);
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> modes(params.volume / params.density * stiffness);
      for (int m = 0; m < 2; ++m) {
        const Eigen::Vector2d rise = modes.eigenvectors().col(m);
        const Mode mode = modeOf(hair.mesh, std::sqrt(modes.eigenvalues()[m]), [&](const Vec3& p) {
          return Vec3(rise[1] * p.x() / kRadius, rise[0], rise[1] * p.z() / kRadius);
        });
        for (const double dt : {1.0 / 960, 1.0 / 240, 1.0 / 60}) {
          const Complex z = factorOf(integrator, dt, mode.frequency);
          hair.state = sim::restState(hair.mesh, Eigen::Isometry3d::Identity());
          EXPECT_LT(largestDeviation(hair, mode, 1e-8, dt, z), 1e-5)
              << nameOf(integrator) << ", step " << dt << ", corners " << corners << ", mode " << m;
        }
      }
    }
  }
}

// A wall of height H and width s shears by the lean x / H of its upper edge and by that edge's tilt y / s. Two of a
// square bundle's four walls lie in the motion's plane: w^2 = G / rho (1 / H^2 + 1 / s^2).
TEST(ShearElement, SwingsAtItsFrequency) {
  constexpr double kHeight = 0.05, kWidth = 0.02;
  for (const Integrator integrator : kIntegrators) {
    sim::SimParams params = bareMaterial(integrator);
    params.gravity = 0;
    params.shear = 300;
    Hair hair(test::patchShape(oneSegment()), params);
    const double frequency =
        std::sqrt(params.shear / params.density * (1 / (kHeight * kHeight) + 1 / (kWidth * kWidth)));
    const Mode mode = modeOf(hair.mesh, frequency, [](const Vec3& p) {
      return Vec3(1 / kHeight, p.x() > kWidth / 2 ? -1 / kWidth : 1 / kWidth, 0);
    });
    for (const double dt : {1.0 / 960, 1.0 / 240}) {
      hair.state = sim::restState(hair.mesh, Eigen::Isometry3d::Identity());
      EXPECT_LT(largestDeviation(hair, mode, 1e-10, dt, factorOf(integrator, dt, frequency)), 1e-5)
          << nameOf(integrator) << ", step " << dt;
    }
  }
}

// Stiffness-proportional damping and air drag in one mode: a step of the scheme is a 2 x 2 matrix on (x, v).
TEST(StretchingColumn, IsDampedByItsRelaxationTimeAndTheAir) {
  {
    for (const double tau : {0.0, 0.001, 0.02}) {
      sim::SimParams params = bareMaterial(Integrator::kLinearizedEuler);
      params.gravity = 0;
      params.stretch_along = 500;
      params.damping = tau, params.air_drag = 3;
      Hair hair(test::patchShape(oneSegment()), params);
      const sim::Edge& edge = hair.mesh.vertical_edges[0];
      const double mass = params.density * hair.mesh.vertex_volume[edge.b];
      const double w2 = params.stretch_along * edge.volume / (edge.rest_length * edge.rest_length * mass);
      for (const double dt : {1.0 / 960, 1.0 / 240, 1.0 / 60}) {
        // (1 + h c + h (h + tau) w^2) v1 = v0 - h w^2 x0, x1 = x0 + h v1
        const double d = 1 + dt * params.air_drag + dt * (dt + tau) * w2;
        Eigen::Matrix2d step;
        step << 1 - dt * dt * w2 / d, dt / d, -dt * w2 / d, 1 / d;
        hair.state = sim::restState(hair.mesh, Eigen::Isometry3d::Identity());
        const int tip = hair.mesh.shape.column_first[1] - 1;
        const double rest = hair.state.positions[tip].y(), amplitude = 1e-4;
        for (int i = 0; i < hair.mesh.vertexCount(); ++i) {
          if (!hair.mesh.isRoot(i)) hair.state.positions[i].y() += amplitude;
        }
        Eigen::Vector2d mode(amplitude, 0);
        for (int n = 0; n < 40; ++n) {
          hair.step(dt);
          mode = step * mode;
          ASSERT_NEAR(hair.state.positions[tip].y() - rest, mode[0], 1e-9 * amplitude)
              << nameOf(Integrator::kLinearizedEuler) << ", damping " << tau << ", step " << dt;
          ASSERT_NEAR(hair.state.velocities[tip].y(), mode[1], 1e-9 * amplitude * std::sqrt(w2));
        }
      }
    }
  }
}

}  // namespace analytic_motion_test

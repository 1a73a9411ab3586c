// Hair at rest under load, against what can be worked out on paper: a hanging column's stretch, a cantilever.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/test_meshes.h"

namespace analytic_statics_test {

using sim::Vec3;
using test::Hair;

constexpr double kWidth = 0.02, kLength = 0.2;  // m, of one bundle with a square root face

// Nothing but what a test switches on; no prestress, linear systems solved exactly.
sim::SimParams bareMaterial() {
  sim::SimParams p = test::looseParticles();
  p.damping = 0.02;
  p.collide = false;
  p.solver = sim::Solver::kDefault;
  p.tolerance = 1e-13, p.acceleration_tolerance = 1e-16, p.displacement_tolerance = 0, p.max_iterations = 2000;
  return p;
}

test::PatchOptions bundle(int segments) {
  test::PatchOptions o;
  o.nx = o.nz = 1, o.layers = segments + 1, o.spacing = kWidth, o.length = kLength;
  return o;
}

// Steps far longer than any motion lasts are Newton steps towards the equilibrium.
void settle(Hair& hair) {
  for (int n = 0; n < 60; ++n) hair.step(1.0);
  double fastest = 0;
  for (const Vec3& v : hair.state.velocities) fastest = std::max(fastest, v.norm());
  ASSERT_LT(fastest, 1e-12) << "m/s: settled";
}

TEST(HangingColumn, StretchesUnderTheWeightBelowEachSegment) {
  for (const int segments : {1, 4, 13}) {
    sim::SimParams params = bareMaterial();
    params.stretch_along = 2e4;
    Hair hair(test::patchShape(bundle(segments)), params);
    settle(hair);
    const double segment = kLength / segments, area = kWidth * kWidth;
    for (int c = 0; c < hair.mesh.columnCount(); ++c) {
      const int root = hair.mesh.shape.column_first[c];
      double below = 0;  // kg, by lumped masses: half a segment's at the tip
      for (int l = segments; l > 0; --l) {
        below += params.density * area / 4 * segment * (l == segments ? 0.5 : 1);
        const double strain = below * params.gravity / (params.stretch_along * area / 4);
        const double length = (hair.state.positions[root + l] - hair.state.positions[root + l - 1]).norm();
        EXPECT_NEAR(length / segment - 1, strain, 1e-9 * strain) << segments << " segments, layer " << l;
      }
      // At its vertices the column is where the continuous rod is, at every resolution: rho g L^2 / 2 E at the tip.
      const double sag = -hair.state.positions[root + segments].y() - kLength;
      const double rod = params.density * params.gravity * kLength * kLength / (2 * params.stretch_along);
      EXPECT_NEAR(sag, rod, 1e-9 * rod);
    }
  }
}

// A square bundle held out level bends under a weight too small for anything nonlinear. Its sections stay plane: w, the
// deflection, and u, the axial displacement of the upper two columns (the lower two go the other way), describe each
// layer. Stretch acts in the four columns, shear in the two upright walls, bend in the two level ones.
struct Beam {
  double stretch, shear, bend;  // Pa, Pa, Pa m^2
  double weight;                // N/m^3

  // Least energy over (u_l, w_l), l = 1 ... segments; returns w.
  Eigen::VectorXd deflection(int segments) const {
    const double s = kLength / segments, volume = kWidth * kWidth * s;
    Eigen::MatrixXd k = Eigen::MatrixXd::Zero(2 * segments, 2 * segments);
    const auto u = [](int l) { return 2 * (l - 1); };
    const auto w = [](int l) { return 2 * (l - 1) + 1; };
    // Adds stiffness c c^T of a condition with these coefficients; the root's layer is held.
    const auto add = [&](double stiffness, std::initializer_list<std::pair<int, double>> condition) {
      for (const auto& [i, a] : condition) {
        for (const auto& [j, b] : condition) {
          if (i >= 0 && j >= 0) k(i, j) += stiffness * a * b;
        }
      }
    };
    for (int l = 0; l < segments; ++l) {
      add(4 * stretch * volume / 4, {{u(l), -1 / s}, {u(l + 1), 1 / s}});
      add(2 * shear * volume / 4, {{w(l), -1 / s}, {w(l + 1), 1 / s}, {u(l), 1 / kWidth}, {u(l + 1), 1 / kWidth}});
      if (l > 0) {
        const double c = 1 / (s * s);
        add(2 * bend * volume / 4, {{w(l - 1), c}, {w(l), -2 * c}, {w(l + 1), c}});
      }
    }
    Eigen::VectorXd load = Eigen::VectorXd::Zero(2 * segments);
    for (int l = 1; l <= segments; ++l) load[w(l)] = -weight * volume * (l == segments ? 0.5 : 1);
    const Eigen::VectorXd both = k.ldlt().solve(load);
    Eigen::VectorXd out(segments);
    for (int l = 1; l <= segments; ++l) out[l - 1] = both[w(l)];
    return out;
  }
};

constexpr Beam kBeams[] = {{4e4, 2e3, 0, 1e-3}, {4e4, 2e3, 3, 1e-3}, {4e5, 2.5e3, 0.6, 1e-3}};

// The simulated deflection of the layers of a level bundle.
Eigen::VectorXd simulatedDeflection(const Beam& beam, int segments) {
  sim::SimParams params = bareMaterial();
  params.stretch_along = beam.stretch, params.shear = beam.shear, params.bend = beam.bend;
  params.stretch_across = 1e4;
  params.density = 60;
  params.gravity = beam.weight / params.density;
  sim::HairMeshShape shape = test::patchShape(bundle(segments));
  for (Vec3& p : shape.positions) p = Vec3(-p.y(), p.x(), p.z());  // a quarter turn about z: along x, roots upright
  Hair hair(std::move(shape), params);
  settle(hair);
  Eigen::VectorXd out = Eigen::VectorXd::Zero(segments);
  for (int i = 0; i < hair.mesh.vertexCount(); ++i) {
    if (hair.mesh.isRoot(i)) continue;
    out[hair.mesh.layer_of[i] - 1] += (hair.state.positions[i].y() - hair.mesh.shape.positions[i].y()) / 4;
  }
  return out;
}

TEST(Cantilever, BendsAsTheDiscreteBeam) {
  for (const Beam& beam : kBeams) {
    for (const int segments : {1, 2, 5, 12}) {
      const Eigen::VectorXd expected = beam.deflection(segments), found = simulatedDeflection(beam, segments);
      EXPECT_LT((found - expected).norm(), 1e-6 * expected.norm()) << segments << " segments, bend " << beam.bend;
    }
  }
}

TEST(Cantilever, NearsTheContinuousBeamWithTheSquareOfTheSegment) {
  for (const Beam& beam : kBeams) {
    const double area = kWidth * kWidth, load = beam.weight * area;
    // Without bend the limit is Timoshenko's beam: q L^4 / 8 EI + q L^2 / 2 GA, the columns half a width off the middle
    // and half of the walls upright. With it, the discrete beam's at 512 segments.
    double limit = -load * std::pow(kLength, 4) / (8 * beam.stretch * area * kWidth * kWidth / 4) -
                   load * kLength * kLength / (2 * beam.shear * area / 2);
    if (beam.bend > 0) limit = beam.deflection(512)[511];
    std::vector<double> steps, errors;
    for (const int segments : {4, 8, 16, 32}) {
      steps.push_back(1.0 / segments);
      errors.push_back(std::abs(simulatedDeflection(beam, segments)[segments - 1] / limit - 1));
    }
    if (beam.bend == 0) {
      EXPECT_LT(errors.front(), 1e-8) << "shear taken at the middle of a wall is exact at the layers";
      continue;
    }
    const double order = test::observedOrder(steps, errors);
    std::printf("stretch %.0f Pa, bend %.1f Pa m^2: tip error %.1e with 4 segments, %.1e with 32, order %.2f\n",
                beam.stretch, beam.bend, errors.front(), errors.back(), order);
    RecordProperty("order_bend_" + std::to_string(static_cast<int>(10 * beam.bend)), std::to_string(order));
    EXPECT_LT(errors.front(), 0.02);
    EXPECT_NEAR(order, 2, 0.25);
  }
}

}  // namespace analytic_statics_test

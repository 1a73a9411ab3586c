// Self-collision: bundles that strike each other stay apart, momentum is kept, nothing near costs nothing.
#include "sim/contact/self_contact.h"

#include <gtest/gtest.h>

#include "sim/forces/model.h"
#include "sim/stabilization/inversion_recovery.h"
#include "tests/sim_probes.h"
#include "tests/test_meshes.h"

namespace self_contact_test {

using sim::Vec3;
using test::Hair;

constexpr double kFrame = 1.0 / 60;

// Two curtains, `apart` from one another along x, of one hair mesh.
sim::HairMeshShape twoCurtains(double apart) {
  test::PatchOptions o;
  o.nx = 2, o.nz = 3, o.layers = 7, o.length = 0.25, o.spacing = 0.02;
  sim::HairMeshShape shape = test::patchShape(o);
  const sim::HairMeshShape second = shape;
  const int columns = shape.columnCount(), vertices = shape.vertexCount();
  for (Vec3 p : second.positions) shape.positions.push_back(p + Vec3(apart, -0.011, 0.007));
  for (int c = 1; c <= columns; ++c) shape.column_first.push_back(vertices + second.column_first[c]);
  for (sim::RootFace face : second.root_faces) {
    for (int k = 0; k < face.corner_count; ++k) face.columns[k] += columns;
    shape.root_faces.push_back(face);
  }
  return shape;
}

sim::SimParams quickHair() {
  sim::SimParams params = test::tautHair();
  params.tolerance = 1e-4, params.acceleration_tolerance = 0.01, params.max_iterations = 400;
  params.self_collide = true;
  return params;
}

// Whether p lies in a prism, cut into tetrahedra from its middle to the triangles of its faces.
bool insidePrism(const sim::Prism& prism, const std::vector<Vec3>& x, const Vec3& p) {
  const int n = prism.corner_count;
  Vec3 middle = Vec3::Zero();
  for (int c = 0; c < 2 * n; ++c) middle += x[prism.v[c]] / (2 * n);
  const auto behind = [&](int a, int b, int c) {
    Eigen::Matrix3d edges;
    edges << x[prism.v[a]] - middle, x[prism.v[b]] - middle, x[prism.v[c]] - middle;
    if (std::abs(edges.determinant()) < 1e-12) return false;
    const Vec3 share = edges.inverse() * (p - middle);
    // A little inside, so that what lies on a face is out.
    return share.minCoeff() >= 0 && share.sum() < 0.94;
  };
  for (int k = 0; k < n; ++k) {
    const int next = (k + 1) % n;
    if (behind(k, next, n + next) || behind(k, n + next, n + k)) return true;
    if (k >= 2 && (behind(0, k - 1, k) || behind(n, n + k - 1, n + k))) return true;
  }
  return false;
}

// External vertices of one curtain inside the other's prisms.
int crossings(const Hair& hair) {
  const int half = hair.mesh.vertexCount() / 2;
  int count = 0;
  for (int v : hair.mesh.external_vertices) {
    for (const sim::Prism& prism : hair.mesh.prisms) {
      if ((prism.v[0] < half) == (v < half)) continue;
      if (insidePrism(prism, hair.state.positions, hair.state.positions[v])) {
        ++count;
        break;
      }
    }
  }
  return count;
}

// Throws the curtains against one another.
void throwTogether(Hair& hair, double speed) {
  const int half = hair.mesh.vertexCount() / 2;
  for (int v = 0; v < hair.mesh.vertexCount(); ++v) {
    if (!hair.mesh.isRoot(v))
      hair.state.velocities[v] = Vec3(v < half ? speed : -speed, 0, 0) * hair.mesh.layer_of[v] / 6;
  }
}

TEST(SelfContact, CurtainsThatStrikeEachOtherDoNotInterpenetrate) {
  for (const double speed : {1.5, 3.0}) {
    int crossed[2] = {0, 0}, left = 0, met = 0;
    for (const bool on : {false, true}) {
      sim::SimParams params = quickHair();
      params.self_collide = on;
      Hair hair(twoCurtains(0.06), params);
      throwTogether(hair, speed);
      for (int n = 0; n < 60; ++n) {
        const sim::StepReport report = hair.step(kFrame);
        EXPECT_EQ(report.recoveries, 0);
        met += report.self_contacts;
        crossed[on] = std::max(crossed[on], crossings(hair));
      }
      left = crossings(hair);
    }
    std::printf("%.1f m/s: at most %d vertices crossed without, %d with; met %d\n", speed, crossed[0], crossed[1], met);
    EXPECT_GT(crossed[0], 5);
    EXPECT_GT(met, 5);
    EXPECT_LE(crossed[1], crossed[0] / 5) << "a vertex may pass where faces bulge beyond their mean planes";
    EXPECT_EQ(left, 0) << "and they part again";
  }
}

// External vertices inside prisms that belong to other places of the same hair: other bundles than their own
// and the next, or layers more than two away.
int foldedInto(const Hair& hair) {
  const sim::HairMesh& mesh = hair.mesh;
  int count = 0;
  for (const int v : mesh.external_vertices) {
    for (const sim::Prism& prism : mesh.prisms) {
      bool near = false;
      for (int c = 0; c < 2 * prism.corner_count; ++c) {
        const int corner = prism.v[c];
        const Vec3 across = mesh.shape.positions[mesh.shape.column_first[mesh.column_of[corner]]] -
                            mesh.shape.positions[mesh.shape.column_first[mesh.column_of[v]]];
        near = near || (across.norm() < 0.05 && std::abs(mesh.layer_of[corner] - mesh.layer_of[v]) <= 2);
      }
      if (near || !insidePrism(prism, hair.state.positions, hair.state.positions[v])) continue;
      ++count;
      break;
    }
  }
  return count;
}

// A curtain whose lower half has been turned up in front of its upper half, and moves into it; and one whose right half
// is turned in front of its left half as a page is.
TEST(SelfContact, ACurtainThatFoldsOverDoesNotRunIntoItself) {
  struct Fold {
    const char* name;
    int nx, nz, layers;
    bool upwards;
  };
  for (const Fold& fold : {Fold{"upwards", 3, 1, 13, true}, Fold{"like a page", 12, 1, 7, false}}) {
    int folded[2] = {0, 0}, met = 0;
    for (const bool on : {false, true}) {
      sim::SimParams params = quickHair();
      params.self_collide = on;
      params.stretch_along = 2e4, params.bend = 0.01, params.shear = params.volume = 300;
      test::PatchOptions o;
      o.nx = fold.nx, o.nz = fold.nz, o.layers = fold.layers, o.length = 0.3;
      const sim::HairMeshShape shape = test::patchShape(o);
      params.volume *= params.volume / sim::volumeModulus(sim::buildHairMesh(shape), params);  // whatever its section
      Hair hair(shape, params);
      for (int v = 0; v < hair.mesh.vertexCount(); ++v) {
        Vec3& x = hair.state.positions[v];
        const double middle = fold.upwards ? -0.15 : 0.12;
        const double past = fold.upwards ? middle - x.y() : x.x() - middle;
        if (past <= 0) continue;
        // Around half a circle, or less near the roots that stay where they are, and straight on from there.
        constexpr double kHalfTurn = EIGEN_PI;
        constexpr double kCentre = 0.028, kBend = 0.018;  // m, of the circle in z; its radius in the hair's middle
        const double most = kHalfTurn * (fold.upwards ? 1 : std::min(1.0, hair.mesh.layer_of[v] / 4.0));
        const double angle = std::min(past / kBend, most), straight = past - angle * kBend, radius = kCentre - x.z();
        const double along = radius * std::sin(angle) + straight * std::cos(angle);
        x.z() = kCentre - radius * std::cos(angle) + straight * std::sin(angle);
        (fold.upwards ? x.y() : x.x()) = fold.upwards ? middle - along : middle + along;
        (fold.upwards ? x.x() : x.y()) -= 0.5 * std::min(past, 0.018);  // so that edges do not fall on edges
        if (most == kHalfTurn) hair.state.velocities[v].z() = -60 * straight;
      }
      for (int n = 0; n < 30; ++n) {
        const sim::StepReport report = hair.step(kFrame);
        EXPECT_EQ(report.recoveries, 0);
        if (on) met += report.self_contacts;
        folded[on] = std::max(folded[on], foldedInto(hair));
      }
    }
    std::printf("%s: at most %d vertices inside without, %d with; met %d\n", fold.name, folded[0], folded[1], met);
    EXPECT_GT(folded[0], 3) << fold.name;
    EXPECT_GT(met, 1) << fold.name;
    EXPECT_LE(folded[1], std::max(1, folded[0] / 5)) << fold.name << ": faces bulge beyond their mean planes";
  }
}

TEST(SelfContact, KeepsMomentumAndAddsNoEnergy) {
  const sim::HairMesh mesh = sim::buildHairMesh(twoCurtains(0.06));
  sim::SelfContact self(mesh);
  const sim::SimParams params = quickHair();
  test::Random random(3);
  int met = 0;
  for (int trial = 0; trial < 50; ++trial) {
    sim::HairState state = sim::restState(mesh, Eigen::Isometry3d::Identity());
    const int half = mesh.vertexCount() / 2;
    for (int v = 0; v < mesh.vertexCount(); ++v) {
      if (mesh.layer_of[v] < 3) continue;  // roots do not give way
      state.positions[v] += Vec3(v < half ? 0.013 : -0.013, 0, 0) + random.vector(0.003);
      state.velocities[v] = Vec3(v < half ? 1 : -1, 0, 0) + random.vector(0.3);
    }
    const auto total = [&](auto&& of) {
      auto sum = of(0);
      for (int v = 1; v < mesh.vertexCount(); ++v) sum += of(v);
      return sum;
    };
    const auto momentum = [&](int v) { return Vec3(mesh.vertex_volume[v] * state.velocities[v]); };
    const auto middle = [&](int v) { return Vec3(mesh.vertex_volume[v] * state.positions[v]); };
    const auto energy = [&](int v) { return mesh.vertex_volume[v] * state.velocities[v].squaredNorm(); };
    const Vec3 momentum_before = total(momentum), middle_before = total(middle);
    const double energy_before = total(energy);
    const int found = sim::resolveSelfContacts({mesh, params, {}, kFrame}, self, state);
    met += found;
    EXPECT_LT((total(momentum) - momentum_before).norm(), 1e-12 * energy_before);
    EXPECT_LT((total(middle) - middle_before).norm(), 1e-15);
    if (found > 0) {
      EXPECT_LT(total(energy), energy_before);
    }
  }
  EXPECT_GT(met, 50);
}

// Limp hair whose one half is moved against the other by its roots, and stays there.
struct PressedTogether {
  Hair hair;
  explicit PressedTogether(double stretch_across) : hair(twoCurtains(0.04), limp(stretch_across)) {
    for (int c = 0; c < hair.mesh.columnCount(); ++c) {
      if (hair.mesh.shape.column_first[c] >= hair.mesh.vertexCount() / 2) hair.roots[c].x() -= 0.025;
    }
  }
  static sim::SimParams limp(double stretch_across) {
    sim::SimParams params = quickHair();
    params.stretch_across = stretch_across, params.shear = 100, params.bend = 0.01, params.volume = 200;
    params.air_drag = 5;
    return params;
  }
};

// What is pushed apart must be paid for by the step: in hair of stiff walls a push of a millimetre stores more than the
// hair has.
TEST(SelfContact, PushesAddNoEnergy) {
  PressedTogether pressed(4e5);
  Hair& hair = pressed.hair;
  const auto energy = [&] { return test::mechanicalEnergy(hair.mesh, hair.params, hair.context, hair.state); };
  int met = 0;
  double before = INFINITY, worst = 0, weight = 0;
  for (const double volume : hair.mesh.vertex_volume) weight += 9.81 * hair.params.density * volume;
  for (int n = 0; n < 120; ++n) {
    met += hair.step(kFrame).self_contacts;
    const double now = energy();
    if (n > 0) worst = std::max(worst, (now - before) / (weight * hair.mesh.hair_length));
    before = now;
  }
  std::printf("met %d, energy up by at most %.2g of weight times length\n", met, worst);
  EXPECT_GT(met, 10);
  EXPECT_LT(worst, 1e-3);
}

// Each step's solve, which does not know of the other half, goes into it, and what was pushed back must not keep the
// velocity of that.
TEST(SelfContact, HairPressedIntoItselfComesToRest) {
  PressedTogether pressed(100);
  Hair& hair = pressed.hair;
  int met = 0;
  double fastest = 0;
  for (int n = 0; n < 300; ++n) {
    met += hair.step(kFrame).self_contacts;
    if (n < 240) continue;
    for (const Vec3& v : hair.state.velocities) fastest = std::max(fastest, v.norm());
  }
  std::printf("met %d, fastest %.2g m/s\n", met, fastest);
  EXPECT_GT(met, 100);
  EXPECT_LT(fastest, 1e-3);
}

TEST(SelfContact, NothingNearNothingPaidAndTheAnswerKnowsNothingOfTheList) {
  const sim::SimParams params = quickHair();
  const sim::HairMesh mesh = sim::buildHairMesh(twoCurtains(0.06));
  sim::SelfContact self(mesh);
  sim::HairState state = sim::restState(mesh, Eigen::Isometry3d::Identity());
  for (int n = 0; n < 100; ++n) {  // a head that turns and travels, the hair with it
    const Eigen::Isometry3d pose =
        Eigen::Translation3d(0.1 * n, 0, 0) * Eigen::AngleAxisd(0.1 * n, Vec3(1, 2, 0.5).normalized());
    state.positions = sim::restState(mesh, pose).positions;
    EXPECT_EQ(sim::resolveSelfContacts({mesh, params, {}, kFrame}, self, state), 0);
  }
  EXPECT_EQ(self.rebuilds, 1);

  // A context of its own for every step against one for all; contexts also remember where solves began, but not
  // the paper's.
  sim::HairState ends[2];
  for (const bool fresh : {false, true}) {
    sim::SimParams published = params;
    published.solver = sim::Solver::kPaper;
    Hair hair(twoCurtains(0.06), published);
    throwTogether(hair, 1.5);
    for (int n = 0; n < 25; ++n) {
      if (fresh) hair.context = sim::StepContext(hair.mesh);
      hair.step(kFrame);
    }
    ends[fresh] = hair.state;
  }
  EXPECT_EQ(test::largestDistance(ends[0].positions, ends[1].positions), 0);
}

// The rest check leads hair back that has come to rest on the wrong side of itself.
TEST(SelfContact, HairThatIsGuidedHomePassesThroughItself) {
  Hair hair(twoCurtains(0.06), quickHair());
  hair.params.collide = false;
  const sim::HairState home = hair.state;
  const int half = hair.mesh.vertexCount() / 2;
  for (int v = 0; v < half; ++v) {
    if (!hair.mesh.isRoot(v)) hair.state.positions[v].x() += 0.12;
  }
  hair.step(1e-4);
  sim::guideTo(hair.mesh, home, hair.state.memory.recovery);
  int guided = 0, met = 0;
  for (int n = 0; n < 60; ++n) {
    const sim::StepReport report = hair.step(kFrame);
    guided += report.guided > 0;
    met += report.guided > 0 && report.self_contacts > 0;
  }
  EXPECT_GT(guided, 10);
  EXPECT_EQ(met, 0) << "bundles held it";
  const double off = test::largestDistance(hair.state.positions, home.positions);
  EXPECT_LT(off, 0.01) << "of curtains 6 cm apart";
}

TEST(SelfContact, WhatOverlapsAtRestStaysAsItIs) {
  Hair hair(twoCurtains(0.025), quickHair());
  const auto start = hair.state.positions;
  EXPECT_GT(crossings(hair), 0);
  for (int n = 0; n < 10; ++n) hair.step(kFrame);
  EXPECT_LT(test::largestDistance(hair.state.positions, start), 1e-5);
}

}  // namespace self_contact_test

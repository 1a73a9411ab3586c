// Self-collision: bundles that strike each other stay apart, momentum is kept, nothing near costs nothing.
#include "sim/self_contact.h"

#include <gtest/gtest.h>

#include "tests/test_meshes.h"

namespace {

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

bool insideTet(const sim::CornerTet& tet, const std::vector<Vec3>& x, const Vec3& p) {
  Eigen::Matrix3d edges;
  for (int k = 0; k < 3; ++k) edges.col(k) = x[tet.v[k + 1]] - x[tet.v[0]];
  if (std::abs(edges.determinant()) < 1e-12) return false;
  const Vec3 share = edges.inverse() * (p - x[tet.v[0]]);
  // A little inside, so that what lies on a face is out.
  return share.minCoeff() > 0.03 && share.sum() < 0.97;
}

// External vertices of one curtain inside the other's corner tetrahedra.
int crossings(const Hair& hair) {
  const int half = hair.mesh.vertexCount() / 2;
  int count = 0;
  for (int v : hair.mesh.external_vertices) {
    for (const sim::CornerTet& tet : hair.mesh.tets) {
      if ((tet.v[0] < half) == (v < half)) continue;
      if (insideTet(tet, hair.state.positions, hair.state.positions[v])) {
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
  int crossed[2] = {0, 0}, met = 0;
  for (const bool on : {false, true}) {
    sim::SimParams params = quickHair();
    params.self_collide = on;
    Hair hair(twoCurtains(0.06), params);
    throwTogether(hair, 1.5);
    for (int n = 0; n < 60; ++n) {
      const sim::StepReport report = hair.step(kFrame);
      EXPECT_EQ(report.recoveries, 0);
      met += report.self_contacts;
      crossed[on] = std::max(crossed[on], crossings(hair));
    }
  }
  std::printf("at most %d vertices crossed without, %d with; met %d\n", crossed[0], crossed[1], met);
  EXPECT_GT(crossed[0], 5);
  EXPECT_GT(met, 20);
  EXPECT_LE(crossed[1], crossed[0] / 10) << "a vertex may pass where faces bulge beyond their mean planes";
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
    const int found = sim::resolveSelfContacts(mesh, params, kFrame, self, state);
    met += found;
    EXPECT_LT((total(momentum) - momentum_before).norm(), 1e-12 * energy_before);
    EXPECT_LT((total(middle) - middle_before).norm(), 1e-15);
    if (found > 0) {
      EXPECT_LT(total(energy), energy_before);
    }
  }
  EXPECT_GT(met, 50);
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
    EXPECT_EQ(sim::resolveSelfContacts(mesh, params, kFrame, self, state), 0);
  }
  EXPECT_EQ(self.rebuilds, 1);

  // A context of its own for every step against one for all.
  sim::HairState ends[2];
  for (const bool fresh : {false, true}) {
    Hair hair(twoCurtains(0.06), params);
    throwTogether(hair, 1.5);
    for (int n = 0; n < 25; ++n) {
      if (fresh) hair.context = sim::StepContext(hair.mesh);
      hair.step(kFrame);
    }
    ends[fresh] = hair.state;
  }
  EXPECT_EQ(test::largestDistance(ends[0].positions, ends[1].positions), 0);
}

TEST(SelfContact, WhatOverlapsAtRestStaysAsItIs) {
  Hair hair(twoCurtains(0.025), quickHair());
  const auto start = hair.state.positions;
  EXPECT_GT(crossings(hair), 0);
  for (int n = 0; n < 10; ++n) hair.step(kFrame);
  EXPECT_LT(test::largestDistance(hair.state.positions, start), 1e-5);
}

}  // namespace

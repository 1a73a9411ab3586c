// Contacts of every kind: ellipsoids or signed distances, of the outer vertices or of all. Nothing is left inside, and
// what has left a body is not held by it.
#include <gtest/gtest.h>

#include <string>

#include "sim/contact/contact.h"
#include "tests/test_meshes.h"

namespace contact_kinds_test {

using sim::Ellipsoid;
using sim::Vec3;

constexpr double kFrame = 1.0 / 60;

struct Kind {
  sim::ColliderKind collider;
  bool inner;
};

void PrintTo(const Kind& kind, std::ostream* out) {
  *out << (kind.collider == sim::ColliderKind::kSdf ? "SignedDistances" : "Ellipsoids")
       << (kind.inner ? "OfAllVertices" : "OfOuterVertices");
}

// A body of either kind, of the same shape: an ellipsoid, or its signed distances about its centre.
struct Body {
  Ellipsoid shape;
  std::vector<float> distances;
  std::vector<sim::BodySdf> parts;

  Body(const Vec3& center, const Vec3& radii, sim::ColliderKind kind) {
    shape.center = center;
    shape.radii = radii;
    if (kind != sim::ColliderKind::kSdf) return;
    Ellipsoid own;
    own.radii = radii;
    sim::DistanceGrid grid;
    grid.spacing = std::min(0.005, 0.25 * radii.minCoeff());
    for (int a = 0; a < 3; ++a) {
      const int half = static_cast<int>(std::ceil(radii[a] / grid.spacing)) + 2;
      grid.nodes[a] = 2 * half + 1;
      grid.low[a] = -half * grid.spacing;
    }
    for (int k = 0; k < grid.nodes[2]; ++k) {
      for (int j = 0; j < grid.nodes[1]; ++j) {
        for (int i = 0; i < grid.nodes[0]; ++i) {
          const Vec3 p = grid.low + grid.spacing * Vec3(i, j, k);
          distances.push_back(static_cast<float>(sim::closestPoint(own, p).distance));
        }
      }
    }
    grid.values = distances;
    grid.deepest = radii.minCoeff();
    parts = {{shape, grid}};
    place();
  }
  Body(const Body&) = delete;
  Body& operator=(const Body&) = delete;

  void move(const Vec3& velocity, const Vec3& spin) {
    shape.velocity = velocity;
    shape.angular_velocity = spin;
    shape.center += kFrame * velocity;
    if (spin.norm() > 0)
      shape.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(spin.norm() * kFrame, spin.normalized())) * shape.rotation;
    place();
  }
  sim::Colliders colliders() const { return {{&shape, 1}, parts}; }

 private:
  void place() {
    if (parts.empty()) return;
    parts[0].bounds = shape;
    parts[0].bounds.radii = Vec3::Constant(parts[0].grid.low.norm());  // a ball around the box
  }
};

test::PatchOptions curtain() {
  test::PatchOptions o;
  o.nx = 4, o.nz = 3, o.layers = 7, o.length = 0.3, o.mixed = true;
  return o;
}

sim::SimParams paramsOf(const Kind& kind) {
  sim::SimParams params = test::tautHair();
  params.tolerance = 1e-3, params.acceleration_tolerance = 0.01, params.max_iterations = 400;
  params.collider = kind.collider;
  params.collide_inner = kind.inner;
  return params;
}

sim::StepReport step(const Body* body, test::Hair& hair) {
  hair.time += kFrame;
  sim::StepInput input{hair.roots, {}, hair.time};
  if (body) input.ellipsoids = {&body->shape, 1}, input.parts = body->parts;
  return sim::advance(hair.mesh, hair.params, input, kFrame, hair.context, hair.state);
}

// m that the deepest of the vertices that are held outside lies inside the body, as the kind in use has its surface.
double deepest(const Body& body, bool inner, const test::Hair& hair) {
  double depth = 0;
  const auto look = [&](int v) {
    depth = std::max(depth, -body.colliders().closest(0, hair.state.positions[v]).distance);
  };
  for (const int v : hair.mesh.external_vertices) look(v);
  for (int v = 0; inner && v < hair.mesh.vertexCount(); ++v) {
    if (!hair.mesh.isRoot(v)) look(v);
  }
  return depth;
}

class ContactKinds : public testing::TestWithParam<Kind> {};

INSTANTIATE_TEST_SUITE_P(Contact, ContactKinds,
                         testing::Values(Kind{sim::ColliderKind::kEllipsoids, false},
                                         Kind{sim::ColliderKind::kEllipsoids, true},
                                         Kind{sim::ColliderKind::kSdf, false}, Kind{sim::ColliderKind::kSdf, true}),
                         testing::PrintToStringParamName());

TEST_P(ContactKinds, NothingThatIsHeldOutsideIsInsideAfterAStep) {
  constexpr double kAllowed = 1e-4;  // m
  struct Play {
    const char* name;
    Vec3 center, radii, velocity, spin;
    int turns;  // steps after which the body goes back
  };
  const Play plays[] = {
      {"slow sweep", {-0.12, -0.15, 0.02}, {0.05, 0.07, 0.06}, {0.3, 0, 0}, {0, 0, 0}, 100},
      {"fast sweep", {-0.3, -0.15, 0.02}, {0.05, 0.09, 0.06}, {5, 0, 0}, {0, 3, 1}, 8},
      {"spinning disc", {0.05, -0.12, -0.1}, {0.09, 0.02, 0.09}, {0, 0, 0.1}, {8, 0, 5}, 100},
      {"thin fast arm", {0.04, -0.2, -0.5}, {0.3, 0.012, 0.012}, {0, 0, 10}, {0, 0, 0}, 6},
      {"thin arm at 20 m/s", {0.04, -0.2, -0.5}, {0.3, 0.035, 0.035}, {0, 0, 20}, {0, 0, 0}, 3},
  };
  double inner_depth = 0;
  for (const Play& play : plays) {
    test::Hair hair(test::combedShape(curtain()), paramsOf(GetParam()));
    Body body(play.center, play.radii, GetParam().collider);
    double worst = 0, found = 0;
    int recoveries = 0;
    for (int n = 0; n < 60; ++n) {
      body.move(n / play.turns % 2 == 0 ? play.velocity : Vec3(-play.velocity), play.spin);
      const sim::StepReport report = step(&body, hair);
      // What stood inside before the step is brought out gently.
      const double initial_overlap = std::max(0.0, report.initial_overlap_depth - hair.params.contact_offset);
      worst = std::max(worst, deepest(body, GetParam().inner, hair) - initial_overlap);
      inner_depth = std::max(inner_depth, deepest(body, true, hair));
      found = std::max(found, report.max_penetration);
      recoveries += report.recoveries;
    }
    std::printf("%-20s found %.1f mm deep, left %.4f mm\n", play.name, 1e3 * found, 1e3 * worst);
    EXPECT_GT(found, 1e-4) << play.name << ": the body did meet the hair";
    EXPECT_LE(worst, kAllowed) << play.name;
    EXPECT_EQ(recoveries, 0) << play.name;
  }
  std::printf("deepest of all vertices, inner ones too: %.3f mm\n", 1e3 * inner_depth);
  if (!GetParam().inner) {
    EXPECT_GT(inner_depth, kAllowed) << "what holding the inner vertices is for";
  }
}

// Pressed aside by a body that then leaves faster than the hair can follow: from its first step on the hair goes the
// way that it would without any body. A contact that held on would pull it along.
TEST_P(ContactKinds, ABodyThatLeavesHoldsNothingBack) {
  sim::SimParams params;
  params.collider = GetParam().collider, params.collide_inner = GetParam().inner;
  for (const double speed : {2.0, 10.0}) {
    test::Hair hair(test::patchShape(curtain()), params);
    Body body({0.04, -0.2, -0.1}, {0.08, 0.06, 0.06}, GetParam().collider);
    for (int n = 0; n < 20; ++n) {
      body.move({0, 0, 0.15}, {0, 0, 0});
      step(&body, hair);
    }
    for (int n = 0; n < 60; ++n) {
      body.move({0, 0, 0}, {0, 0, 0});
      step(&body, hair);
    }
    ASSERT_GE(hair.state.contacts.size(), 3u) << "the hair does lie on the body";
    test::Hair free(test::patchShape(curtain()), hair.params);
    free.state = hair.state;
    free.state.contacts.clear();
    double apart = 0, moved = 0;
    int gone = -1;
    const std::vector<Vec3> start = hair.state.positions;
    for (int n = 0; n < 30; ++n) {
      body.move({0, 0, -speed}, {0, 0, 0});
      step(&body, hair);
      step(nullptr, free);
      if (hair.state.contacts.empty() && gone < 0) gone = n + 1;
      if (gone >= 0) {
        EXPECT_TRUE(hair.state.contacts.empty()) << "and none comes back";
      }
      apart = std::max(apart, test::largestDistance(hair.state.positions, free.state.positions));
      moved = std::max(moved, test::largestDistance(hair.state.positions, start));
    }
    std::printf("%.0f m/s: contacts gone after %d steps; %.4f mm off the free hair, which moved %.1f mm\n", speed, gone,
                1e3 * apart, 1e3 * moved);
    EXPECT_GE(gone, 1);
    EXPECT_LE(gone, 2);
    EXPECT_GT(moved, 0.01);
    EXPECT_LT(apart, 3e-3 * moved);
  }
}

// Hair that lies on a body and is lifted off it by its roots: contacts let go one after the other, and once they have
// it hangs as it would have without them.
TEST_P(ContactKinds, HairThatIsLiftedOffABodyLetsGo) {
  test::Hair hair(test::patchShape(curtain()), paramsOf(GetParam()));
  Body body({0.04, -0.34, 0.03}, {0.15, 0.06, 0.15}, GetParam().collider);
  const auto moveRoots = [&](double speed) {
    for (Vec3& root : hair.roots) root.y() += speed * kFrame;
  };
  for (int n = 0; n < 60; ++n) {
    moveRoots(n < 30 ? -0.1 : 0);
    body.move({0, 0, 0}, {0, 0, 0});
    step(&body, hair);
  }
  ASSERT_GE(hair.state.contacts.size(), 3u) << "the hair does lie on the body";
  int gone = -1;
  for (int n = 0; n < 150; ++n) {
    moveRoots(n < 30 ? 0.5 : 0);
    step(&body, hair);
    EXPECT_LE(deepest(body, GetParam().inner, hair), 1e-4);
    if (hair.state.contacts.empty() && gone < 0) gone = n + 1;
  }
  double off = 0;
  const Vec3 lifted(0, hair.roots[0].y() - hair.mesh.shape.positions[0].y(), 0);
  for (int v = 0; v < hair.mesh.vertexCount(); ++v)
    off = std::max(off, (hair.state.positions[v] - hair.mesh.shape.positions[v] - lifted).norm());
  std::printf("contacts gone after %d steps; %.3f mm off the rest shape\n", gone, 1e3 * off);
  EXPECT_GE(gone, 1);
  EXPECT_LE(gone, 20);
  EXPECT_TRUE(hair.state.contacts.empty());
  EXPECT_LT(off, 1e-3);
}

// An arm that comes up under hair and sinks again: a second later the hair hangs as it hung.
TEST_P(ContactKinds, HairThatAnArmHasLiftedSlidesOffItAsItSinks) {
  constexpr int kUp = 30, kHeld = 60, kDown = 90, kAfter = 150;  // steps
  constexpr double kSpeed = 0.4;                                 // m/s
  test::Hair hair(test::patchShape(curtain()), paramsOf(GetParam()));
  Body body({0.04, -0.50, 0.03}, {0.15, 0.04, 0.04}, GetParam().collider);
  std::size_t touching = 0;
  double off = 0, lifted = 0;
  for (int n = 0; n < kAfter; ++n) {
    const double speed = n < kUp ? kSpeed : n >= kHeld && n < kDown ? -kSpeed : 0;
    body.move({0, speed, 0}, {0, 0, 0});
    step(&body, hair);
    touching = std::max(touching, hair.state.contacts.size());
    EXPECT_LE(deepest(body, GetParam().inner, hair), 1e-4);
    off = 0;
    for (int v = 0; v < hair.mesh.vertexCount(); ++v)
      off = std::max(off, (hair.state.positions[v] - hair.mesh.shape.positions[v]).norm());
    lifted = std::max(lifted, off);
  }
  std::printf("%zu contacts, lifted by %.0f mm, then %.3f mm off the rest shape\n", touching, 1e3 * lifted, 1e3 * off);
  EXPECT_GE(touching, 3u);
  EXPECT_GT(lifted, 0.02);
  EXPECT_LT(off, 2e-3);
}

TEST(Contact, WhatABodyLeavesBehindIsNotHeld) {
  constexpr double kStep = 1e-3;  // s
  const sim::SimParams params = test::tautHair();
  for (const double speed : {0.2, 5.0}) {
    sim::Ellipsoid ball;
    ball.radii.setConstant(0.1);
    ball.center.y() = -speed * kStep;
    ball.velocity = Vec3(0, -speed, 0);
    sim::HairState state;
    state.positions = {Vec3(0, 0.1 + params.contact_offset, 0)};
    state.velocities = {Vec3::Zero()};
    state.contacts = {sim::Contact{}};
    const std::vector<sim::Ellipsoid> bodies{ball};
    sim::carryContacts({bodies}, params, kStep, state);
    EXPECT_EQ(state.contacts.empty(), speed > 1) << speed << " m/s: near enough both times";
  }
}

}  // namespace contact_kinds_test

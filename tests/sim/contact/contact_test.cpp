// Contacts: nothing is left inside a body, contacts ride with it.
#include "sim/contact/contact.h"

#include <gtest/gtest.h>

#include "tests/sim_probes.h"
#include "tests/test_meshes.h"

namespace contact_test {

using sim::Contact;
using sim::Ellipsoid;
using sim::Vec3;
using test::Hair;

constexpr double kFrame = 1.0 / 60;

Ellipsoid ellipsoid(const Vec3& center, const Vec3& radii) {
  Ellipsoid e;
  e.center = center;
  e.radii = radii;
  return e;
}

// Moves a body rigidly over dt, so that its pose and velocities agree.
void move(Ellipsoid& e, const Vec3& velocity, const Vec3& spin, double dt) {
  e.velocity = velocity;
  e.angular_velocity = spin;
  e.center += dt * velocity;
  if (spin.norm() > 0)
    e.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(spin.norm() * dt, spin.normalized())) * e.rotation;
}

// How deep the deepest external vertex lies inside a body, m.
double deepest(const Hair& hair) {
  double depth = 0;
  for (int v : hair.mesh.external_vertices) {
    for (const Ellipsoid& e : hair.bodies)
      depth = std::max(depth, -sim::closestPoint(e, hair.state.positions[v]).distance);
  }
  return depth;
}

Vec3 toLocal(const Ellipsoid& e, const Vec3& p) {
  return e.rotation.conjugate() * (p - e.center);
}

sim::SimParams quickHair() {
  sim::SimParams params = test::tautHair();
  params.tolerance = 1e-3, params.acceleration_tolerance = 0.01, params.max_iterations = 400;
  return params;
}

test::PatchOptions curtain() {
  test::PatchOptions o;
  o.nx = 4, o.nz = 2, o.layers = 7, o.length = 0.3, o.mixed = true;
  return o;
}

// Bodies that come upon the hair: how they start, and what moves them before step n.
struct Play {
  const char* name;
  void (*start)(Hair&);
  void (*step)(Hair&, int);
};
const Play kPlays[] = {
    {"slow sweep",
     [](Hair& h) {
       h.bodies = {ellipsoid({-0.12, -0.15, 0.02}, {0.05, 0.07, 0.06})};
     },
     [](Hair& h, int) {
       move(h.bodies[0], {0.3, 0, 0}, {0, 0, 0}, kFrame);
     }},
    {"fast sweep, 5 m/s",
     [](Hair& h) {
       h.bodies = {ellipsoid({-0.3, -0.15, 0.02}, {0.05, 0.09, 0.06})};
     },
     [](Hair& h, int n) {
       move(h.bodies[0], {n < 10 ? 5.0 : -5.0, 0, 0}, {0, 3, 1}, kFrame);
     }},
    {"spinning disc",
     [](Hair& h) {
       h.bodies = {ellipsoid({0.05, -0.12, -0.06}, {0.09, 0.02, 0.09})};
     },
     [](Hair& h, int) {
       move(h.bodies[0], {0, 0, 0.1}, {8, 0, 5}, kFrame);
     }},
    {"two that overlap",
     [](Hair& h) {
       h.bodies = {ellipsoid({0.0, -0.2, -0.1}, {0.06, 0.06, 0.06}), ellipsoid({0.06, -0.2, -0.1}, {0.05, 0.09, 0.05})};
     },
     [](Hair& h, int) {
       for (Ellipsoid& e : h.bodies) move(e, {0, 0, 0.25}, {0, 1, 0}, kFrame);
     }},
    {"spawned inside",
     [](Hair& h) {
       h.bodies = {ellipsoid({0.04, -0.2, 0.02}, {0.08, 0.1, 0.07})};
     },
     [](Hair& h, int) {
       move(h.bodies[0], {0, 0, 0}, {0, 0, 0}, kFrame);
     }},
    {"a crowd that overlaps",
     [](Hair& h) {
       test::Random random(9);
       for (int k = 0; k < 7; ++k) {
         h.bodies.push_back(ellipsoid(Vec3(-0.25, -0.15, 0.03) + random.vector(0.07),
                                      Vec3(random(0.02, 0.06), random(0.02, 0.06), random(0.02, 0.06))));
       }
     },
     [](Hair& h, int n) {
       for (Ellipsoid& e : h.bodies) move(e, {n % 30 < 15 ? 2.5 : -2.5, 0, 0}, {4, 9, 2}, kFrame);
     }},
    {"appears and goes", [](Hair&) {},
     [](Hair& h, int n) {
       h.bodies.clear();
       if (n % 7 < 4) h.bodies.push_back(ellipsoid({0.04, -0.15 - 0.01 * (n % 5), 0.0}, {0.05, 0.05, 0.05}));
     }},
};

struct Configuration {
  const char* name;
  bool minimize;
  double offset;  // m; at 0 what a correction misses lies inside
};
constexpr Configuration kConfigurations[] = {
    {"minimized", true, 0.002}, {"corrected", false, 0.002}, {"no offset", true, 0}};

void expectNothingInside(const Play& play, const Configuration& configuration) {
  constexpr double kAllowed = 1e-4;  // m
  sim::SimParams params = quickHair();
  params.minimize_deformation = configuration.minimize;
  params.contact_offset = configuration.offset;
  Hair hair(test::combedShape(curtain()), params);
  play.start(hair);
  double worst = 0, found = 0;
  int recoveries = 0;
  for (int n = 0; n < 60; ++n) {
    play.step(hair, n);
    const sim::StepReport report = hair.step(kFrame);
    // Initial overlap is resolved at a limited speed, and must be gone by the end.
    const double initial_overlap = n < 50 ? std::max(0.0, report.initial_overlap_depth - configuration.offset) : 0;
    worst = std::max(worst, deepest(hair) - initial_overlap);
    found = std::max(found, report.max_penetration);
    recoveries += report.recoveries;
  }
  std::printf("%-20s %s: found %.1f mm deep, left %.4f mm\n", play.name, configuration.name, 1e3 * found, 1e3 * worst);
  EXPECT_GT(found, 1e-4) << play.name << ": the body did meet the hair";
  EXPECT_LE(worst, kAllowed) << play.name;
  EXPECT_EQ(recoveries, 0) << play.name;
}

TEST(Contact, NoExternalVertexIsInsideAfterAStepWhateverTheBodiesDo) {
  for (const Play& play : kPlays) {
    for (const Configuration& configuration : kConfigurations) expectNothingInside(play, configuration);
  }
}

TEST(Contact, PenetrationsAreFoundInFullAndTheirTargetsLieOutsideEveryBody) {
  test::Random random(6);
  const sim::HairMesh mesh = sim::buildHairMesh(test::patchShape(curtain()));
  int found_count = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<Ellipsoid> bodies;  // two that overlap, their crease within the hair
    const Vec3 middle = Vec3(0.04, -0.15, 0.02) + random.vector(0.05), apart = 0.035 * random.direction();
    for (const double side : {-1.0, 1.0}) {
      bodies.push_back(
          ellipsoid(middle + side * apart, Vec3(random(0.05, 0.07), random(0.05, 0.07), random(0.05, 0.07))));
      bodies.back().rotation = random.rotation();
    }
    std::vector<sim::Penetration> found;
    sim::ContactScratch scratch;
    sim::ContactSearch search{mesh.external_vertices, {bodies}, {}, kFrame, {0.002, 0, 1}};
    sim::findPenetrations(search, mesh.shape.positions, scratch, found);
    std::vector<int> expected, vertices;
    for (int v : mesh.external_vertices) {
      double nearest = 1;
      for (const Ellipsoid& e : bodies)
        nearest = std::min(nearest, sim::closestPoint(e, mesh.shape.positions[v]).distance);
      if (nearest < 0.002 - 1e-9) expected.push_back(v);
    }
    for (const sim::Penetration& hit : found) {
      vertices.push_back(hit.vertex);
      for (const Ellipsoid& e : bodies) EXPECT_GT(sim::closestPoint(e, hit.target).distance, 0.002 - 2e-4);
      EXPECT_NEAR(hit.normal.norm(), 1, 1e-12);
      EXPECT_GT(hit.depth, 0);
    }
    EXPECT_EQ(vertices, expected) << "all of them, in vertex order";
    found_count += static_cast<int>(found.size());
  }
  EXPECT_GT(found_count, 500);
}

// Projections between many bodies go to and fro; the targets must lie outside all the same.
TEST(Contact, ACrowdOfBodiesIsLeftAsAWhole) {
  test::Random random(7);
  const sim::HairMesh mesh = sim::buildHairMesh(test::patchShape(curtain()));
  int found_count = 0;
  double deepest = 0;
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<Ellipsoid> bodies;
    const Vec3 middle = Vec3(0.04, -0.15, 0.02) + random.vector(0.05);
    for (int k = 0; k < 8; ++k) {
      bodies.push_back(
          ellipsoid(middle + random.vector(0.05), Vec3(random(0.01, 0.07), random(0.01, 0.07), random(0.01, 0.07))));
      bodies.back().rotation = random.rotation();
    }
    std::vector<sim::Penetration> found;
    sim::ContactScratch scratch;
    sim::ContactSearch search{mesh.external_vertices, {bodies}, {}, kFrame, {0.002, 0, 1}};
    sim::findPenetrations(search, mesh.shape.positions, scratch, found);
    for (const sim::Penetration& hit : found) {
      // Bodies beside the hair are met by the next search, should a target lie in one.
      for (const auto& near : scratch.near)
        deepest = std::max(deepest, 0.002 - sim::closestPoint(bodies[near.index], hit.target).distance);
    }
    found_count += static_cast<int>(found.size());
  }
  std::printf("%d found, targets at most %.3f mm inside the offset\n", found_count, 1e3 * deepest);
  EXPECT_GT(found_count, 300);
  EXPECT_LE(deepest, 1e-5);
}

TEST(Contact, SwitchedOffNothingIsCorrected) {
  sim::SimParams params = quickHair();
  params.collide = false;
  Hair hair(test::combedShape(curtain()), params);
  hair.bodies = {ellipsoid({0.04, -0.2, 0.02}, {0.08, 0.1, 0.07})};
  const auto start = hair.state.positions;
  for (int n = 0; n < 5; ++n) EXPECT_EQ(hair.step(kFrame).corrected, 0);
  EXPECT_LT(test::largestDistance(hair.state.positions, start), 1e-6) << "sag-free hair at rest stays there";
}

// Figure 9: with deformation minimization inner vertices follow, and the prisms keep their volume.
TEST(Contact, DeformationMinimizationKeepsTheVolumeThatCorrectionAloneCrushes) {
  double smallest[2], inside[2];
  for (const bool minimize : {false, true}) {
    sim::SimParams params = quickHair();
    params.minimize_deformation = minimize;
    test::PatchOptions o;
    o.nx = 6, o.nz = 5, o.layers = 6, o.length = 0.2, o.spacing = 0.015;
    Hair hair(test::patchShape(o), params);
    hair.bodies = {ellipsoid({0.045, -0.14, -0.065}, {0.06, 0.06, 0.06})};
    double least = 1, deep = 0;
    for (int n = 0; n < 3; ++n) {  // large steps of a fast body, as in the figure
      move(hair.bodies[0], {0, 0, 2.0}, {0, 0, 0}, kFrame);
      hair.step(kFrame);
      for (const sim::CornerTet& tet : hair.mesh.tets) {
        least = std::min(least, test::tetVolume(tet, hair.state.positions) / tet.rest_volume);
      }
      for (const Vec3& p : hair.state.positions) deep = std::max(deep, -sim::closestPoint(hair.bodies[0], p).distance);
    }
    smallest[minimize] = least, inside[minimize] = deep;
  }
  std::printf("smallest volume ratio %.2f without, %.2f with; deepest inner vertex %.1f mm without, %.1f mm with\n",
              smallest[0], smallest[1], 1e3 * inside[0], 1e3 * inside[1]);
  EXPECT_GT(smallest[1], smallest[0] + 0.2);
  EXPECT_LT(inside[1], 0.2 * inside[0]);
}

TEST(Contact, CarriedContactKeepsItsVertexAtTheOffsetOfTheMovingBody) {
  test::Random random(2);
  const sim::SimParams params = test::tautHair();
  for (int trial = 0; trial < 100; ++trial) {
    Ellipsoid e = ellipsoid(random.vector(0.2), Vec3(random(0.05, 0.2), random(0.05, 0.2), random(0.05, 0.2)));
    e.rotation = random.rotation();
    sim::HairState state;
    const sim::SurfacePoint s = sim::closestPoint(e, e.center + 0.5 * random.direction());
    state.positions = {s.point + params.contact_offset * s.normal};
    state.contacts = {Contact{}};
    const Vec3 before = state.positions[0];
    move(e, random.vector(2), random.vector(6), kFrame);
    state.velocities = {sim::surfaceVelocity(e, before)};
    const std::vector<Ellipsoid> bodies{e};
    sim::carryContacts({bodies}, params, kFrame, state);
    ASSERT_EQ(state.contacts.size(), 1u);
    const Vec3 after = before + kFrame * state.contacts[0].velocity;
    EXPECT_NEAR(sim::closestPoint(e, after).distance, params.contact_offset, 1e-9);
    EXPECT_LT((state.contacts[0].normal - sim::closestPoint(e, after).normal).norm(), 1e-6);
  }
  sim::HairState state;
  state.positions = state.velocities = {Vec3::Zero()};
  state.contacts = {Contact{}};
  sim::carryContacts({}, params, kFrame, state);
  EXPECT_TRUE(state.contacts.empty()) << "its body is gone";
}

// Closing a dip is work: against a hundred newtons it would store more than the motion of light hair had left.
TEST(Contact, ADipBelowTheOffsetIsLeft) {
  const sim::SimParams params = test::tautHair();
  const Ellipsoid ball = ellipsoid(Vec3::Zero(), Vec3::Constant(0.1));
  const std::vector<Ellipsoid> bodies{ball};
  const double dip = 0.05 * params.contact_offset;
  for (const double pressure : {0.0, 0.01, 100.0}) {
    sim::HairState state;
    state.positions = {Vec3(0, 0.1 + params.contact_offset - dip, 0)};
    state.velocities = {Vec3::Zero()};
    state.contacts = {Contact{}};
    state.contacts[0].pressure = pressure;
    sim::carryContacts({bodies}, params, kFrame, state);
    ASSERT_EQ(state.contacts.size(), 1u);
    EXPECT_NEAR(kFrame * state.contacts[0].velocity.y(), 0, 1e-9) << pressure << " N";
    EXPECT_GT(state.contacts[0].normal.y(), 0.99);
  }
}

TEST(Contact, ConstraintsRemoveWhatTheirNormalsSpanAndPrescribeTheContactsVelocity) {
  test::Random random(3);
  for (int trial = 0; trial < 200; ++trial) {
    const int count = 1 + trial % 3;
    std::vector<Contact> contacts;
    for (int k = 0; k < count; ++k) {
      Contact c;
      c.vertex = 5, c.collider = k;
      c.normal = random.direction();
      c.velocity = random.vector(1);
      contacts.push_back(c);
    }
    Eigen::Matrix3d normals = Eigen::Matrix3d::Zero();
    for (int k = 0; k < count; ++k) normals.row(k) = contacts[k].normal.transpose();
    const double independence = normals.topRows(count).jacobiSvd().singularValues().minCoeff();
    if (independence < 0.2) continue;  // nearly parallel normals count as one
    std::vector<sim::VertexConstraint> constraints;
    sim::constrainContacts(contacts, constraints);
    ASSERT_EQ(constraints.size(), 1u);
    const sim::VertexConstraint& c = constraints[0];
    EXPECT_EQ(c.vertex, 5);
    EXPECT_LT((c.keep - c.keep.transpose()).norm(), 1e-12);
    EXPECT_LT((c.keep * c.keep - c.keep).norm(), 1e-12) << "a projector";
    EXPECT_NEAR(c.keep.trace(), 3 - count, 1e-12);
    const Vec3 v = c.keep * random.vector(5) + c.prescribed;  // any velocity that the constraint admits
    for (const Contact& contact : contacts) EXPECT_NEAR(contact.normal.dot(v - contact.velocity), 0, 1e-10);
    contacts[0].sticks = true;
    constraints.clear();
    sim::constrainContacts(contacts, constraints);
    EXPECT_EQ(constraints[0].keep.norm(), 0);
    EXPECT_LT((constraints[0].prescribed - contacts[0].velocity).norm(), 1e-12) << "sticking takes all three";
  }
}

// An ellipsoid switched on inside the hair: it comes out at the bounded speed, and no motion is left behind.
TEST(Contact, AnOverlapAtTheStartIsResolvedAtABoundedSpeedAndLeavesNoMotionBehind) {
  constexpr double kOwn = 0.6;  // m/s that the stretched hair reaches of itself
  for (const double speed : {0.2, 1.0}) {
    sim::SimParams params = quickHair();
    params.max_depenetration = speed;
    Hair hair(test::combedShape(curtain()), params);
    for (int n = 0; n < 30; ++n) hair.step(kFrame);
    hair.bodies = {ellipsoid({0.04, -0.2, 0.02}, {0.05, 0.06, 0.045})};
    const auto energy = [&] { return test::mechanicalEnergy(hair.mesh, params, hair.context, hair.state); };
    const double unsqueezed = energy();
    double before = deepest(hair), fastest = 0;
    const double at_first = before;
    int steps = 0;
    for (; steps < 600 && before > 1e-4; ++steps) {
      const auto positions = hair.state.positions;
      hair.step(kFrame);
      const double now = deepest(hair);
      EXPECT_LT(before - now, (speed + kOwn) * kFrame) << "no faster than it may, and the hair moves of itself";
      EXPECT_LT(now, before + 1e-6) << "never deeper";
      before = now;
      for (std::size_t i = 0; i < positions.size(); ++i) fastest = std::max(fastest, hair.state.velocities[i].norm());
    }
    EXPECT_GT(at_first, 0.02);
    EXPECT_NEAR(steps, (at_first + params.contact_offset) / (speed * kFrame), 0.5 * steps + 2) << "and no slower";
    // Making room stores energy in the squeezed hair; from then on none is added.
    double later = 0, left = energy(), most_added = 0;
    const double stored = left - unsqueezed;
    for (int n = 0; n < 60; ++n) {
      hair.step(kFrame);
      const double now = energy();
      most_added = std::max(most_added, now - left);
      left = now;
    }
    EXPECT_LT(most_added, 1e-3 * stored) << "in a step, to bring contacts back to their offset";
    EXPECT_LT(left, unsqueezed + stored);
    std::printf("%.2f mJ stored by making room, at most %.4f mJ added in a step, %.2f mJ left\n", 1e3 * stored,
                1e3 * most_added, 1e3 * (left - unsqueezed));
    for (const Vec3& v : hair.state.velocities) later = std::max(later, v.norm());
    std::printf("%.0f mm deep, allowed %.1f m/s: out in %d steps; fastest vertex %.2f m/s, afterwards %.2f m/s\n",
                1e3 * at_first, speed, steps, fastest, later);
    EXPECT_LT(fastest, speed + kOwn);
    EXPECT_LT(later, 0.1) << "a second later it hangs still";
    EXPECT_LE(deepest(hair), 1e-4);
  }
}

// The hair's patch hangs around z = 0; a flat body crosses it within one step.
TEST(Contact, AThinBodyCannotPassThroughInOneStep) {
  const Vec3 thin(0.12, 0.1, 0.008);
  struct Crossing {
    const char* name;
    Vec3 center, velocity, spin;
  };
  const Crossing crossings[] = {
      {"forwards", {0.04, -0.2, -0.06}, {0, 0, 9}, {0, 0, 0}},
      {"backwards", {0.04, -0.2, 0.12}, {0, 0, -9}, {0, 0, 0}},
      {"forwards, turning", {0.04, -0.2, -0.06}, {0, 0, 9}, {0, 12, 0}},
      {"a door that shuts", {-0.03, -0.2, -0.06}, {0, 0, 0}, {0, -70, 0}},
  };
  for (const Crossing& crossing : crossings) {
    sim::SimParams params = quickHair();
    Hair hair(test::patchShape(curtain()), params);
    hair.bodies = {ellipsoid(crossing.center, thin)};
    hair.step(kFrame);
    const auto before = hair.state.positions;
    const Ellipsoid start = hair.bodies[0];
    move(hair.bodies[0], crossing.velocity, crossing.spin, kFrame);
    hair.step(kFrame);
    const Ellipsoid& end = hair.bodies[0];
    int passed = 0, met = 0;
    for (int v : hair.mesh.external_vertices) {
      // In the flat body's own frame: which side, for those that it could have met face on.
      const Vec3 a = toLocal(start, before[v]), b = toLocal(end, hair.state.positions[v]);
      const Vec3 untouched = toLocal(end, before[v]);
      if (a.z() * untouched.z() > 0 || (0.5 * (a + untouched)).cwiseQuotient(1.2 * thin).head<2>().norm() > 0.6)
        continue;
      ++met;
      if (a.z() * b.z() < 0) ++passed;
    }
    std::printf("%-18s met %d vertices, %d passed through\n", crossing.name, met, passed);
    EXPECT_GT(met, 4) << crossing.name;
    EXPECT_EQ(passed, 0) << crossing.name;
    EXPECT_LE(deepest(hair), 1e-4) << crossing.name;
  }
}

// A flat arm, 2.4 cm through, at the speeds of a limb that strikes. Its way in a step is up to thirty times its own
// thickness; along the way it may turn, and its flat side may lead or lean.
TEST(Contact, AThinFlatArmCannotPassThroughAtAnySpeed) {
  const Vec3 radii(0.18, 0.12, 0.012);
  int met = 0, passed = 0;
  for (const double speed : {5.0, 10.0, 20.0, 40.0}) {
    for (const double side : {-1.0, 1.0}) {
      for (const double spin : {0.0, 6.0}) {
        for (const double lean : {0.0, 0.5}) {
          const double way = speed * kFrame;
          Hair hair(test::patchShape(curtain()), quickHair());
          Ellipsoid arm = ellipsoid({0.04, -0.15, 0}, radii);
          arm.center.z() = 0.02 - side * (0.5 * way);  // half of the way before the hair's middle, half behind it
          arm.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(lean, Vec3::UnitX()));
          hair.bodies = {arm};
          const Ellipsoid start = arm;
          const auto before = hair.state.positions;
          move(hair.bodies[0], {0, 0, side * speed}, {0, spin, 0}, kFrame);
          const sim::StepReport report = hair.step(kFrame);
          EXPECT_EQ(report.recoveries, 0);
          const Ellipsoid& end = hair.bodies[0];
          int here = 0, through = 0;
          for (const int v : hair.mesh.external_vertices) {
            const Vec3 a = toLocal(start, before[v]), untouched = toLocal(end, before[v]);
            const double apart = sim::closestPoint(start, before[v]).distance;
            if (apart < 0.002 || a.z() * untouched.z() > 0) continue;
            // Where it would have met the arm's middle plane; near the rim it may slide off.
            const double share = a.z() / (a.z() - untouched.z());
            if ((a + share * (untouched - a)).cwiseQuotient(radii).head<2>().norm() > 0.7) continue;
            ++here;
            through += a.z() * toLocal(end, hair.state.positions[v]).z() < 0;
          }
          EXPECT_EQ(through, 0) << speed << " m/s, side " << side << ", spin " << spin << ", lean " << lean << ": of "
                                << here;
          EXPECT_LE(deepest(hair), 1e-4);
          met += here, passed += through;
        }
      }
    }
  }
  std::printf("met %d vertices, %d passed through\n", met, passed);
  EXPECT_GT(met, 600);
}

}  // namespace contact_test

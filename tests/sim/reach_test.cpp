// Colliders out of reach of a cluster of vertices are not tested. What is found, and what the corrections make of it,
// is to the bit what tests of every vertex with every collider give: in a walk, thrown about, and among random bodies
// that jump and spin.
#include <gtest/gtest.h>

#include "app/files/data_path.h"
#include "app/scene/demo.h"
#include "sim/contact/position_correction.h"
#include "tests/test_meshes.h"

namespace sim {

inline void PrintTo(ColliderKind kind, std::ostream* out) {
  *out << (kind == ColliderKind::kSdf ? "SignedDistances" : "Ellipsoids");
}

}  // namespace sim

namespace reach_test {

using sim::Ellipsoid;
using sim::Vec3;

constexpr double kFrame = 1.0 / 60;

bool same(const sim::Penetration& a, const sim::Penetration& b) {
  return a.vertex == b.vertex && a.collider == b.collider && a.target == b.target && a.normal == b.normal &&
         a.depth == b.depth && a.initial_overlap == b.initial_overlap && a.left == b.left;
}

bool same(const sim::Contact& a, const sim::Contact& b) {
  return a.vertex == b.vertex && a.collider == b.collider && a.normal == b.normal;
}

// Searches with clusters and without.
struct Searches {
  sim::ContactScratch clustered, plain;
  std::vector<sim::Penetration> found, expected;

  explicit Searches(const sim::HairMesh& mesh) { sim::clusterVertices(mesh, clustered); }

  void compare(const sim::ContactSearch& search, const std::vector<Vec3>& positions) {
    sim::findPenetrations(search, positions, clustered, found);
    sim::findPenetrations(search, positions, plain, expected);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) ASSERT_TRUE(same(found[k], expected[k])) << k;
  }
};

test::PatchOptions curtain() {
  test::PatchOptions o = test::mixedPatch(12, 0.3);
  o.uneven = true;
  return o;
}

// A body near the hair, thin or round, that has come from up to `speed` m/s away and turned by up to `spin` rad.
Ellipsoid randomBody(double speed, double spin, test::Random& random) {
  Ellipsoid e;
  e.center = Vec3(0.04, -0.15, 0.03) + random.vector(0.25);
  e.rotation = random.rotation();
  e.radii = Vec3(random(0.004, 0.12), random(0.004, 0.12), random(0.004, 0.12));
  e.velocity = random.vector(speed);
  e.angular_velocity = random(0, spin) / kFrame * random.direction();
  return e;
}

TEST(Reach, RandomBodiesAreFoundToTheBit) {
  test::Random random(11);
  const sim::HairMesh mesh = sim::buildHairMesh(test::combedShape(curtain()));
  Searches searches(mesh);
  std::vector<int> all;
  for (int v = 0; v < mesh.vertexCount(); ++v) {
    if (!mesh.isRoot(v)) all.push_back(v);
  }
  long found = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const double speed = trial % 3 == 0 ? 20 : 0.5, spin = trial % 4 == 0 ? 3 : 0.15;
    std::vector<Ellipsoid> bodies;
    for (int k = 0; k < 6; ++k) bodies.push_back(randomBody(speed, spin, random));
    const Vec3 moved = random.vector(trial % 4 == 0 ? 0.3 : 0.01);
    std::vector<Vec3> start = mesh.shape.positions, end = start;
    for (Vec3& x : end) x += moved + random.vector(0.01);
    const sim::ContactSearch search{trial % 5 == 0 ? all : mesh.external_vertices,
                                    {bodies},
                                    trial % 7 == 0 ? std::span<const Vec3>() : start,
                                    kFrame,
                                    {0.002, 0.0004, 0.03}};
    ASSERT_NO_FATAL_FAILURE(searches.compare(search, end)) << "trial " << trial;
    found += static_cast<long>(searches.found.size());
  }
  const sim::SkipCount &left = searches.clustered.tests, &plain = searches.plain.tests;
  std::printf("%ld found; of %ld tests %ld left out, %ld by the whole hair's bounds\n", found, left.of, left.skipped,
              plain.skipped);
  EXPECT_GT(found, 10000);
  EXPECT_EQ(left.of, plain.of);
  EXPECT_GT(left.skipped, plain.skipped + left.of / 20);
}

// The count is that of the tests: none is left out where a body reaches all, all where none reaches any.
TEST(Reach, CountsTheTestsThatWereLeftOut) {
  const sim::HairMesh mesh = sim::buildHairMesh(test::patchShape(curtain()));
  Searches searches(mesh);
  Ellipsoid around, away, beside;
  around.radii.setConstant(2);
  away.center.x() = 9;
  beside.center = Vec3(-0.045, -0.15, 0.03), beside.radii = Vec3(0.02, 0.5, 0.02);  // to the left of the last columns
  const auto count = [&](const std::vector<Ellipsoid>& bodies) {
    searches.clustered.tests = {};
    const sim::ContactSearch search{
        mesh.external_vertices, {bodies}, mesh.shape.positions, kFrame, {0.002, 0.0004, 0.03}};
    searches.compare(search, mesh.shape.positions);
    return searches.clustered.tests;
  };
  const long vertices = static_cast<long>(mesh.external_vertices.size());
  EXPECT_EQ(count({around}).skipped, 0);
  EXPECT_EQ(count({around}).of, vertices);
  EXPECT_EQ(count({away, away}).skipped, 2 * vertices);
  EXPECT_EQ(count({around, away}).skipped, vertices);
  beside.radii.y() = 0.05;
  const sim::SkipCount part = count({beside});
  EXPECT_GT(part.skipped, 0);
  EXPECT_LE(part.skipped, part.of);
}

// The walking figure's own bodies, of either kind, and hair that is thrown at them from where it hangs.
class Walk : public testing::TestWithParam<sim::ColliderKind> {};

TEST_P(Walk, IsCorrectedToTheBit) {
  app::Scene scene;
  app::CharacterSpec spec;
  spec.motion = app::dataPath("assets/clips/walk.bvh");
  spec.style = app::Style::kLong;
  spec.resolution = app::Resolution::kLow;
  scene.characters = {spec};
  scene.playback.settle = 0.2;
  scene.sim.collider = GetParam();
  scene.skips.on.fill(false);
  app::Demo demo = app::openScene(std::move(scene), 1.5);
  app::Actor& actor = demo.actors[0];
  const sim::HairMesh& mesh = actor.haircut->mesh;
  sim::SimParams params = demo.running;
  sim::PositionCorrection clustered(mesh), plain(mesh);
  plain.search.cluster_of.clear(), plain.search.boxes.clear();
  test::Random random(5);
  sim::StepReport report, expected;
  for (int frame = 0; frame < 90; ++frame) {
    actor.playback.speed = frame < 60 ? 1 : 8;
    app::advanceFrame(demo, kFrame, {});
    const bool grids = GetParam() == sim::ColliderKind::kSdf;
    const sim::Colliders colliders{actor.ellipsoids, grids ? actor.parts : std::span<const sim::BodySdf>()};
    ASSERT_EQ(colliders.parts.empty(), !grids);
    // Softly, as hair sways, and across half of the head within one step.
    const Vec3 thrown = random.vector(frame % 3 == 0 ? 0.15 : 0.01);
    const std::vector<Vec3>& start = actor.hair.positions;
    sim::HairState state = actor.hair;
    state.previous_positions = state.positions, state.previous_velocities = state.velocities;
    for (int v = 0; v < mesh.vertexCount(); ++v) {
      if (!mesh.isRoot(v)) state.positions[v] += thrown + random.vector(0.005);
    }
    sim::HairState other = state;
    params.collide_inner = frame % 2 == 0;
    const sim::CorrectedStep step{mesh, params, colliders, start, kFrame};
    sim::correctContacts(step, clustered, state, report);
    sim::correctContacts(step, plain, other, expected);
    ASSERT_EQ(state.positions, other.positions) << "frame " << frame;
    ASSERT_EQ(state.velocities, other.velocities) << "frame " << frame;
    ASSERT_TRUE(std::ranges::equal(state.contacts, other.contacts, [](auto& a, auto& b) { return same(a, b); }));
  }
  std::printf("%d corrected; of %ld tests %ld left out, %ld by the whole hair's bounds\n", report.corrected,
              report.collider_tests.of, report.collider_tests.skipped, expected.collider_tests.skipped);
  EXPECT_EQ(report.corrected, expected.corrected);
  EXPECT_GT(report.corrected, 500);
  EXPECT_GT(report.collider_tests.skipped, expected.collider_tests.skipped + report.collider_tests.of / 6);
}

INSTANTIATE_TEST_SUITE_P(Reach, Walk, testing::Values(sim::ColliderKind::kEllipsoids, sim::ColliderKind::kSdf),
                         testing::PrintToStringParamName());

}  // namespace reach_test

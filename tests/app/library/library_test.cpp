// The C interface: the same motion as the simulator's, states, views, parameters, strands, threads, memory.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <map>
#include <string>
#include <thread>

#include "app/files/hair_file.h"
#include "app/scene/edit/render_faces.h"
#include "render/strands/strand_growth.h"
#include "tests/app/library/library_hair.h"

namespace library_test {

using namespace library_test;

TEST(Library, EndsInTheStateOfTheSimulatorToTheBit) {
  const hm_mesh mesh = makeMesh();
  const hm_hair hair = makeHair(mesh);
  const sim::HairMesh own = sim::buildHairMesh(someShape());
  sim::StepContext context(own);
  sim::HairState state = sim::restState(own, Eigen::Isometry3d::Identity());
  int contacts = 0;
  for (int n = 0; n < 90; ++n) {
    const Step step(n);
    hm_report report{};
    ASSERT_EQ(hm_hair_step(hair, &step.input, &report), HM_OK) << hm_error_message();
    contacts += report.contacts;
    Eigen::Isometry3d head = Eigen::Isometry3d::Identity();
    const double* q = step.input.head.rotation;
    head.linear() = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().toRotationMatrix();
    head.translation() = Vec3(step.input.head.position);
    std::vector<Vec3> roots;
    for (int c = 0; c < own.columnCount(); ++c) roots.push_back(head * own.shape.positions[own.shape.column_first[c]]);
    sim::Ellipsoid ball;
    ball.center = Vec3(step.ball.pose.position);
    ball.radii = Vec3(step.ball.radii);
    ball.velocity = Vec3(step.ball.velocity);
    sim::advance(own, {}, {roots, {&ball, 1}, step.input.time}, step.input.dt, context, state);
  }
  EXPECT_GT(contacts, 0);
  const std::vector<double> mine = positionsOf(hair);
  ASSERT_EQ(mine.size(), 3 * state.positions.size());
  EXPECT_EQ(std::memcmp(mine.data(), state.positions.data()->data(), mine.size() * sizeof(double)), 0);
  EXPECT_EQ(hm_hair_destroy(hair), HM_OK);
  EXPECT_EQ(hm_mesh_destroy(mesh), HM_OK);
}

TEST(Library, RootsGivenAsArraysMoveTheHairAsTheHeadDoes) {
  const hm_mesh mesh = makeMesh();
  const hm_hair by_head = makeHair(mesh), by_roots = makeHair(mesh);
  hm_mesh_info info{};
  ASSERT_EQ(hm_mesh_describe(mesh, &info), HM_OK);
  struct Root {
    float at[3], unused;
  };
  std::vector<Root> roots(static_cast<std::size_t>(info.column_count));
  for (int n = 0; n < 30; ++n) {
    Step step(n);
    ASSERT_EQ(hm_hair_step(by_head, &step.input, nullptr), HM_OK);
    const double* q = step.input.head.rotation;
    const Eigen::Quaterniond turn(q[3], q[0], q[1], q[2]);
    for (int c = 0; c < info.column_count; ++c) {
      const Vec3 root = turn * Vec3(info.rest.data + 3 * info.column_first[c]) + Vec3(step.input.head.position);
      for (int k = 0; k < 3; ++k) roots[static_cast<std::size_t>(c)].at[k] = static_cast<float>(root[k]);
    }
    step.input.roots = {roots.data(), sizeof(Root), roots.size(), HM_FLOAT32};
    ASSERT_EQ(hm_hair_step(by_roots, &step.input, nullptr), HM_OK) << hm_error_message();
  }
  const std::vector<double> a = positionsOf(by_head), b = positionsOf(by_roots);
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
  EXPECT_LT(worst, 5e-3) << "m: roots in single precision, with which contacts stick or slip";
  EXPECT_GT(worst, 0);
  hm_hair_destroy(by_head);
  hm_hair_destroy(by_roots);
  hm_mesh_destroy(mesh);
}

TEST(Library, ATextMakesTheSameMeshAsArrays) {
  const std::string text = app::writeHairMesh(someShape());
  hm_mesh mesh{};
  ASSERT_EQ(hm_mesh_create_from_text(text.data(), text.size(), "some.obj", 0, &mesh), HM_OK) << hm_error_message();
  hm_mesh_info info{};
  ASSERT_EQ(hm_mesh_describe(mesh, &info), HM_OK);
  const sim::HairMeshShape shape = someShape();
  EXPECT_EQ(info.vertex_count, shape.vertexCount());
  EXPECT_EQ(info.column_count, shape.columnCount());
  EXPECT_EQ(info.face_count, static_cast<int>(shape.root_faces.size()));
  EXPECT_EQ(info.layer_count, 8);
  EXPECT_EQ(info.hair_length, sim::buildHairMesh(shape).hair_length);
  EXPECT_EQ(info.column_first[info.column_count], info.vertex_count);
  EXPECT_EQ(std::memcmp(info.rest.data, shape.positions.data(), shape.positions.size() * sizeof(Vec3)), 0);
  // The text names the line; the wrong winding names the switch.
  EXPECT_EQ(hm_mesh_create_from_text(text.data(), text.size() / 2, "cut.obj", 0, &mesh), HM_ERROR_TEXT);
  EXPECT_NE(std::string(hm_error_message()).find("cut.obj: line"), std::string::npos) << hm_error_message();
  EXPECT_EQ(hm_mesh_create_from_text(text.data(), text.size(), nullptr, 1, &mesh), HM_ERROR_TEXT);
  EXPECT_EQ(hm_mesh_destroy(mesh), HM_OK);
}

// Strands of a converted groom grow beside its hair mesh.
TEST(Library, StrandsGrowAtGroomOffsets) {
  sim::HairMeshShape shape = someShape();
  const auto tips = [&] {
    const std::string text = app::writeHairMesh(shape);
    hm_mesh mesh{};
    EXPECT_EQ(hm_mesh_create_from_text(text.data(), text.size(), "some.obj", 0, &mesh), HM_OK) << hm_error_message();
    const hm_hair hair = makeHair(mesh);
    hm_strand_settings settings;
    hm_default_strand_settings(&settings);
    settings.count = 20;
    std::vector<double> points(3 * 20 * static_cast<std::size_t>(settings.points));
    hm_strand_output output{};
    output.positions = {points.data(), 3 * sizeof(double), points.size() / 3, HM_FLOAT64};
    EXPECT_EQ(hm_hair_grow_strands(hair, &settings, &output), HM_OK) << hm_error_message();
    hm_hair_destroy(hair);
    hm_mesh_destroy(mesh);
    std::vector<Vec3> at;
    for (int s = 1; s <= 20; ++s) at.emplace_back(&points[points.size() / 20 * static_cast<std::size_t>(s) - 3]);
    return at;
  };
  const std::vector<Vec3> before = tips();
  shape.groom_offsets.assign(shape.positions.size(), Vec3::Zero());
  for (int c = 0; c < shape.columnCount(); ++c)
    for (int v = shape.column_first[c] + 1; v < shape.column_first[c + 1]; ++v)
      shape.groom_offsets[static_cast<std::size_t>(v)] = Vec3(0.003, 0, 0);
  const std::vector<Vec3> after = tips();
  Vec3 moved = Vec3::Zero();  // m; single strands wander another way where hair is longer
  for (std::size_t s = 0; s < before.size(); ++s) moved += (after[s] - before[s]) / static_cast<double>(before.size());
  EXPECT_LT((moved - Vec3(0.003, 0, 0)).norm(), 0.0008);
}

// The first hair needs no file: every built-in style stands on the plain head and stays out of it.
TEST(Library, ABuiltInStyleStandsOnThePlainHead) {
  const Vec3 radii = 0.23 * Vec3(0.34, 0.5, 0.42);
  for (const char* style : {"short", "shoulder", "long", "bob", "pixie", "shaved"}) {
    for (const char* resolution : {"low", "medium"}) {
      hm_mesh mesh{};
      ASSERT_EQ(hm_mesh_create_style(style, resolution, 0.23, &mesh), HM_OK) << style << hm_error_message();
      hm_mesh_info info{};
      ASSERT_EQ(hm_mesh_describe(mesh, &info), HM_OK);
      for (int c = 0; c < info.column_count; ++c) {
        for (int v = info.column_first[c]; v < info.column_first[c + 1]; ++v) {
          const Vec3 p = Eigen::Map<const Vec3>(info.rest.data + 3 * v);
          const double out = p.cwiseQuotient(radii).norm();
          const bool root = v == info.column_first[c];
          EXPECT_TRUE(root ? std::abs(out - 1) < 0.01 : out > 1) << style << " vertex " << v << ": " << out;
        }
      }
      EXPECT_EQ(hm_mesh_destroy(mesh), HM_OK);
    }
  }
  hm_mesh mesh{};
  EXPECT_EQ(hm_mesh_create_style("mohawk", "low", 0.23, &mesh), HM_ERROR_ARGUMENT);
  EXPECT_NE(std::string(hm_error_message()).find("short, shoulder, long"), std::string::npos) << hm_error_message();
  EXPECT_NE(std::string(hm_error_message()).find("'mohawk' is not built in; choose one of short"), std::string::npos);
  EXPECT_EQ(hm_mesh_create_style("shrt", "low", 0.23, &mesh), HM_ERROR_ARGUMENT);
  EXPECT_NE(std::string(hm_error_message()).find("'shrt' is not built in; did you mean 'short'? Choose one of short, "),
            std::string::npos)
      << hm_error_message();
  EXPECT_EQ(hm_mesh_create_style("short", "8k", 0.23, &mesh), HM_ERROR_ARGUMENT);
  EXPECT_EQ(hm_mesh_create_style("short", "low", NAN, &mesh), HM_ERROR_VALUE);
  EXPECT_EQ(hm_mesh_create_style(nullptr, "low", 0.23, &mesh), HM_ERROR_ARGUMENT);
}

TEST(Library, ASavedStateGoesOnToTheBitAndViewsStayWhereTheyAre) {
  const hm_mesh mesh = makeMesh();
  const hm_hair hair = makeHair(mesh), other = makeHair(mesh);
  hm_view before{}, after{}, velocities{};
  ASSERT_EQ(hm_hair_positions(hair, &before), HM_OK);
  advance(hair, 0, 40);
  const std::vector<char> saved = stateOf(hair);
  advance(hair, 40, 60);
  const std::vector<char> end = stateOf(hair);
  ASSERT_EQ(hm_hair_restore(other, saved.data(), saved.size()), HM_OK) << hm_error_message();
  advance(other, 40, 60);
  EXPECT_EQ(end, stateOf(other));
  ASSERT_EQ(hm_hair_restore(hair, saved.data(), saved.size()), HM_OK);
  EXPECT_EQ(saved, stateOf(hair));
  ASSERT_EQ(hm_hair_positions(hair, &after), HM_OK);
  EXPECT_EQ(before.data, after.data);
  const hm_pose there{{1, 2, 3}, {0, 0, 0, 1}}, none{{0, 0, 0}, {0, 0, 0, 1}};
  const std::vector<double> here = positionsOf(hair);
  ASSERT_EQ(hm_hair_carry(hair, &none, &there), HM_OK);
  for (std::size_t i = 0; i < here.size(); ++i) EXPECT_NEAR(before.data[i], here[i] + there.position[i % 3], 1e-12);
  ASSERT_EQ(hm_hair_reset(hair, &none), HM_OK);
  ASSERT_EQ(hm_hair_positions(hair, &after), HM_OK);
  EXPECT_EQ(before.data, after.data);
  hm_mesh_info info{};
  ASSERT_EQ(hm_mesh_describe(mesh, &info), HM_OK);
  EXPECT_EQ(std::memcmp(after.data, info.rest.data, after.count * sizeof(Vec3)), 0);
  ASSERT_EQ(hm_hair_velocities(hair, &velocities), HM_OK);
  EXPECT_EQ(velocities.data[5], 0);
  std::vector<float> copied(4 * before.count);
  const hm_target target{copied.data(), 4 * sizeof(float), before.count, HM_FLOAT32};
  ASSERT_EQ(hm_hair_read_positions(hair, &target), HM_OK);
  EXPECT_EQ(copied[5], static_cast<float>(before.data[4]));
  ASSERT_EQ(hm_hair_read_velocities(hair, &target), HM_OK);
  EXPECT_EQ(copied[5], 0);
  hm_hair_destroy(hair);
  hm_hair_destroy(other);
  hm_mesh_destroy(mesh);
}

TEST(Library, ParametersAreKnownByNameWithRangeAndHelp) {
  const hm_mesh mesh = makeMesh();
  const hm_hair hair = makeHair(mesh);
  ASSERT_GT(hm_parameter_count(), 40);
  int strands = 0;
  for (int i = 0; i < hm_parameter_count(); ++i) {
    hm_parameter row{}, found{};
    ASSERT_EQ(hm_parameter_at(i, &row), HM_OK);
    ASSERT_EQ(hm_parameter_find(row.name, &found), HM_OK) << row.name;
    EXPECT_EQ(found.name, row.name);
    EXPECT_GT(std::strlen(row.help), 10u) << row.name;
    double value = NAN;
    EXPECT_EQ(hm_hair_get(hair, row.name, &value), HM_OK);
    EXPECT_EQ(value, row.default_value) << row.name;
    if (std::string_view(row.name) == "collider") {  // signed distances: the library has none
      EXPECT_EQ(hm_hair_set(hair, row.name, row.maximum), HM_ERROR_VALUE);
      continue;
    }
    EXPECT_EQ(hm_hair_set(hair, row.name, row.maximum), HM_OK) << row.name;
    EXPECT_EQ(hm_hair_get(hair, row.name, &value), HM_OK);
    EXPECT_NEAR(value, row.maximum, 1e-6 * std::abs(row.maximum)) << row.name;
    EXPECT_EQ(hm_hair_set(hair, row.name, row.maximum * 2 + 1), HM_ERROR_VALUE) << row.name;
    EXPECT_EQ(hm_hair_set(hair, row.name, NAN), HM_ERROR_VALUE) << row.name;
    strands += row.of_strands;
  }
  EXPECT_GT(strands, 10);
  EXPECT_EQ(hm_hair_reset_parameters(hair), HM_OK);
  double value = 0;
  EXPECT_EQ(hm_hair_set_text(hair, "solver", "paper"), HM_OK);
  EXPECT_EQ(hm_hair_get(hair, "solver", &value), HM_OK);
  EXPECT_EQ(value, 1);
  EXPECT_EQ(hm_hair_set_text(hair, "curl_radius", "0.01"), HM_OK);
  EXPECT_EQ(hm_hair_set_text(hair, "collide", "perhaps"), HM_ERROR_VALUE);
  EXPECT_EQ(hm_hair_set(hair, "max_iterations", 10.5), HM_ERROR_VALUE);
  EXPECT_EQ(hm_hair_set(hair, "densty", 60), HM_ERROR_NAME);
  EXPECT_NE(std::string(hm_error_message()).find("density"), std::string::npos) << hm_error_message();
  hm_hair_destroy(hair);
  hm_mesh_destroy(mesh);
}

TEST(Library, StrandsAreThoseOfTheShaders) {
  const hm_mesh mesh = makeMesh();
  const hm_hair hair = makeHair(mesh);
  ASSERT_EQ(hm_hair_set(hair, "strands", 500), HM_OK);
  ASSERT_EQ(hm_hair_set(hair, "curl_radius", 0.004), HM_OK);
  advance(hair, 0, 20);
  const sim::HairMesh own = sim::buildHairMesh(someShape());
  std::vector<float> rest, posed;
  for (const Vec3& p : own.shape.positions)
    for (const double x : {p.x(), p.y(), p.z()}) rest.push_back(static_cast<float>(x));
  for (const double x : positionsOf(hair)) posed.push_back(static_cast<float>(x));
  render::HairLook look;
  look.curl_radius = 0.004f;
  render::StrandGrowth growth(app::renderFaces(own), rest, 500, 3, look);
  ASSERT_TRUE(growth.setPositions(posed));
  const std::vector<std::int32_t> numbers{499, 3, 77};
  struct Point {
    float at[3], radius;
  };
  std::vector<Point> points(numbers.size() * 12);
  std::vector<double> tangents(points.size() * 3);
  hm_strand_settings settings;
  hm_default_strand_settings(&settings);
  settings.numbers = numbers.data();
  settings.count = 3;
  settings.points = 12;
  hm_strand_output output{};
  output.positions = {points[0].at, sizeof(Point), points.size(), HM_FLOAT32};
  output.radii = {&points[0].radius, sizeof(Point), points.size(), HM_FLOAT32};
  output.tangents = {tangents.data(), 0, points.size(), HM_FLOAT64};
  ASSERT_EQ(hm_hair_grow_strands(hair, &settings, &output), HM_OK) << hm_error_message();
  std::vector<render::CurvePoint> expected(12);
  for (std::size_t s = 0; s < numbers.size(); ++s) {
    const render::Strand strand = growth.strand(numbers[s]);
    growth.growEven(strand, expected);
    for (std::size_t i = 0; i < 12; ++i) {
      const Point& point = points[12 * s + i];
      EXPECT_LT((Eigen::Map<const Eigen::Vector3f>(point.at) - expected[i].position).norm(), 1e-5 * own.hair_length);
      EXPECT_NEAR(point.radius, growth.radius(strand, expected[i].along), 1e-8);
      EXPECT_NEAR(Vec3(&tangents[3 * (12 * s + i)]).norm(), 1, 1e-5);
    }
    hm_strand described{};
    ASSERT_EQ(hm_hair_describe_strand(hair, numbers[s], &described), HM_OK);
    EXPECT_EQ(described.face, strand.face);
    EXPECT_FLOAT_EQ(static_cast<float>(described.end), strand.end);
  }
  hm_hair_destroy(hair);
  hm_mesh_destroy(mesh);
}

TEST(Library, HairsOfOneMeshMoveOnDifferentThreadsAsTheyDoOnOne) {
  const hm_mesh mesh = makeMesh();
  const hm_hair alone = makeHair(mesh);
  advance(alone, 0, 40);
  std::vector<hm_hair> hairs;
  for (int i = 0; i < 4; ++i) hairs.push_back(makeHair(mesh));
  hm_mesh_destroy(mesh);  // hairs live on
  std::vector<std::thread> threads;
  for (const hm_hair hair : hairs) threads.emplace_back([hair] { advance(hair, 0, 40); });
  for (std::thread& thread : threads) thread.join();
  for (const hm_hair hair : hairs) {
    EXPECT_EQ(stateOf(hair), stateOf(alone));
    EXPECT_EQ(hm_hair_destroy(hair), HM_OK);
  }
  hm_hair_destroy(alone);
}

// Goes on until steps were taken and one was refused: how often threads meet is the operating system's choice.
TEST(Library, AHairThatAnotherThreadWorksOnIsRefused) {
  const hm_mesh mesh = makeMesh();
  const hm_hair hair = makeHair(mesh);
  std::atomic<int> done{0}, busy{0}, other{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 3; ++t) {
    threads.emplace_back([&] {
      const Step step(0);
      for (int n = 0; n < 10000000 && (done < 200 || busy == 0); ++n) {
        const hm_result result = hm_hair_step(hair, &step.input, nullptr);
        ++(result == HM_OK ? done : result == HM_ERROR_BUSY ? busy : other);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_GE(done, 200);
  EXPECT_GT(busy, 0);
  EXPECT_EQ(other, 0);
  EXPECT_EQ(hm_hair_destroy(hair), HM_OK);
  hm_mesh_destroy(mesh);
}

TEST(Library, TheLogHearsOfFaultsAndRepairs) {
  std::vector<std::pair<hm_log_level, std::string>> lines;
  hm_set_log([](hm_log_level level, const char* message,
                void* user) { static_cast<decltype(lines)*>(user)->emplace_back(level, message); },
             &lines);
  EXPECT_EQ(hm_hair_destroy({77}), HM_ERROR_HANDLE);
  hm_set_log(nullptr, nullptr);
  EXPECT_EQ(hm_hair_destroy({78}), HM_ERROR_HANDLE);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].first, HM_LOG_ERROR);
  EXPECT_EQ(lines[0].second, "hm_hair_destroy: no such hair; it was destroyed, never made, or is of another kind");
}

// Most often the positions are in centimetres.
TEST(Library, TheLogHearsOfHairOfMetres) {
  const std::string text =
      "g layer_0\nv 0 0 0\nv 2 0 0\nv 0 0 2\nf 1 3 2\ng layer_1\nv 0 25 0\nv 2 25 0\nv 0 25 2\nf 4 6 5\n";
  std::vector<std::string> lines;
  hm_set_log([](hm_log_level level, const char* message,
                void* user) { static_cast<decltype(lines)*>(user)->push_back(std::to_string(level) + message); },
             &lines);
  hm_mesh mesh{};
  EXPECT_EQ(hm_mesh_create_from_text(text.data(), text.size(), "long", 0, &mesh), HM_OK) << hm_error_message();
  hm_set_log(nullptr, nullptr);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0], "1the hair is 25 m long; positions are in metres, scale them");
  EXPECT_EQ(hm_mesh_destroy(mesh), HM_OK);
}

// Blocks that the library has of the caller's.
struct Counted {
  std::atomic<long> blocks{0}, bytes{0}, calls{0};
};

TEST(Library, TheCallersAllocatorGetsEveryBlockBack) {
  Counted counted;
  const hm_allocator allocator{[](std::size_t size, std::size_t alignment, void* user) -> void* {
                                 auto* c = static_cast<Counted*>(user);
                                 ++c->blocks, ++c->calls, c->bytes += static_cast<long>(size);
                                 return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
                               },
                               [](void* block, std::size_t size, void* user) {
                                 auto* c = static_cast<Counted*>(user);
                                 --c->blocks, c->bytes -= static_cast<long>(size);
                                 std::free(block);
                               },
                               &counted};
  const hm_result result = hm_set_allocator(&allocator);
  if (result == HM_ERROR_UNSUPPORTED) GTEST_SKIP() << hm_error_message();
  ASSERT_EQ(result, HM_OK);
  const hm_mesh mesh = makeMesh();
  const hm_hair hair = makeHair(mesh);
  advance(hair, 0, 30);
  const long warm = counted.calls;
  advance(hair, 30, 60);
  EXPECT_EQ(counted.calls, warm) << "a warm step takes memory";
  EXPECT_GT(counted.bytes, 100000);
  hm_hair_destroy(hair);
  hm_mesh_destroy(mesh);
  EXPECT_EQ(counted.blocks, 0);
  EXPECT_EQ(counted.bytes, 0);
  EXPECT_EQ(hm_set_allocator(nullptr), HM_OK);
}

}  // namespace library_test

// Wrong use of the C interface: every fault has its result and its message, and changes nothing.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "tests/app/library/library_hair.h"

namespace misuse_test {

using namespace library_test;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class LibraryMisuse : public ::testing::Test {
 protected:
  void SetUp() override {
    mesh_ = makeMesh();
    hair_ = makeHair(mesh_);
    advance(hair_, 0, 5);
  }
  void TearDown() override {
    EXPECT_EQ(hm_hair_destroy(hair_), HM_OK);
    EXPECT_EQ(hm_mesh_destroy(mesh_), HM_OK);
  }
  // A step that `spoil` makes wrong is refused with `expected`, its message names `word`, and the state stays.
  void refuses(hm_result expected, const std::string& word, const std::function<void(Step&)>& spoil) {
    Step step(5);
    spoil(step);
    const std::vector<char> before = stateOf(hair_);
    EXPECT_EQ(hm_hair_step(hair_, &step.input, nullptr), expected) << word;
    EXPECT_NE(std::string(hm_error_message()).find(word), std::string::npos) << hm_error_message();
    EXPECT_EQ(before, stateOf(hair_)) << word;
  }

  hm_mesh mesh_{};
  hm_hair hair_{};
};

TEST_F(LibraryMisuse, StepsThatCannotBeTakenAreRefusedWhole) {
  refuses(HM_ERROR_VALUE, "beyond 1e7", [](Step& step) { step.input.head.position[0] = 1e40; });
  refuses(HM_ERROR_VALUE, "dt is below 1e-6 s; give seconds", [](Step& s) { s.input.dt = 0; });
  refuses(HM_ERROR_VALUE, "dt is below 1e-6 s; give seconds", [](Step& s) { s.input.dt = NAN; });
  refuses(HM_ERROR_VALUE, "dt is below 1e-6 s; give seconds", [](Step& s) { s.input.dt = 1e-30; });
  refuses(HM_ERROR_VALUE, "dt is above 0.1 s; take several steps", [](Step& s) { s.input.dt = 1; });
  refuses(HM_ERROR_VALUE, "time", [](Step& s) { s.input.time = kInfinity; });
  refuses(HM_ERROR_VALUE, "max_work", [](Step& s) { s.input.max_work = 0; });
  refuses(HM_ERROR_VALUE, "max_work", [](Step& s) { s.input.max_work = NAN; });
  refuses(HM_ERROR_VALUE, "head.position", [](Step& s) { s.input.head.position[1] = NAN; });
  refuses(HM_ERROR_VALUE, "head.rotation", [](Step& s) { s.input.head.rotation[3] = 5; });
  refuses(HM_ERROR_VALUE, "head.rotation", [](Step& s) { s.input.head.rotation[0] = NAN; });
  refuses(HM_ERROR_VALUE, "ellipsoids[0].radii", [](Step& s) { s.ball.radii[2] = 0; });
  refuses(HM_ERROR_VALUE, "ellipsoids[0].velocity", [](Step& s) { s.ball.velocity[2] = -kInfinity; });
  refuses(HM_ERROR_ARGUMENT, "ellipsoids", [](Step& s) { s.input.ellipsoids = nullptr; });
}

TEST_F(LibraryMisuse, RootsOfAnotherNumberOrKindAreRefused) {
  hm_mesh_info info{};
  ASSERT_EQ(hm_mesh_describe(mesh_, &info), HM_OK);
  const auto columns = static_cast<std::size_t>(info.column_count);
  std::vector<double> roots(3 * columns, 0.1);
  refuses(HM_ERROR_SIZE, "roots", [&](Step& s) { s.input.roots = {roots.data(), 0, columns - 1, HM_FLOAT64}; });
  refuses(HM_ERROR_ARGUMENT, "roots", [&](Step& s) { s.input.roots = {nullptr, 0, columns, HM_FLOAT64}; });
  refuses(HM_ERROR_ARGUMENT, "roots.type", [&](Step& s) {
    s.input.roots = {roots.data(), 0, columns, static_cast<hm_type>(7)};
  });
  roots[8] = NAN;
  refuses(HM_ERROR_VALUE, "roots[2]", [&](Step& s) { s.input.roots = {roots.data(), 0, columns, HM_FLOAT64}; });
}

// Elements that lie in one another would be written over.
TEST_F(LibraryMisuse, AStrideBelowAnElementIsRefused) {
  hm_mesh_info info{};
  ASSERT_EQ(hm_mesh_describe(mesh_, &info), HM_OK);
  const auto count = static_cast<std::size_t>(info.vertex_count), columns = static_cast<std::size_t>(info.column_count);
  std::vector<double> room(3 * count, 7);
  for (const hm_target& target :
       {hm_target{room.data(), 4, count, HM_FLOAT64}, hm_target{room.data(), 23, count, HM_FLOAT64},
        hm_target{room.data(), 5, count, HM_FLOAT32}}) {
    EXPECT_EQ(hm_hair_read_positions(hair_, &target), HM_ERROR_ARGUMENT);
    EXPECT_NE(std::string(hm_error_message()).find("target.stride"), std::string::npos) << hm_error_message();
    EXPECT_EQ(hm_hair_read_velocities(hair_, &target), HM_ERROR_ARGUMENT);
  }
  EXPECT_EQ(room, std::vector<double>(room.size(), 7));
  for (const hm_target& target :
       {hm_target{room.data(), 0, count, HM_FLOAT64}, hm_target{room.data(), 24, count, HM_FLOAT64},
        hm_target{room.data(), 12, count, HM_FLOAT32}})
    EXPECT_EQ(hm_hair_read_positions(hair_, &target), HM_OK) << hm_error_message();
  refuses(HM_ERROR_ARGUMENT, "roots.stride", [&](Step& s) { s.input.roots = {room.data(), 8, columns, HM_FLOAT64}; });
  hm_strand_settings settings;
  hm_default_strand_settings(&settings);
  settings.count = 1;
  const auto points = static_cast<std::size_t>(settings.points);
  hm_strand_output output{};
  output.radii = {room.data(), 4, points, HM_FLOAT64};
  EXPECT_EQ(hm_hair_grow_strands(hair_, &settings, &output), HM_ERROR_ARGUMENT);
  output.radii.stride = 8;  // one number each
  EXPECT_EQ(hm_hair_grow_strands(hair_, &settings, &output), HM_OK) << hm_error_message();
}

TEST_F(LibraryMisuse, PinsThatNameNothingAreRefused) {
  hm_pin pin{100000, {0, 0, 0}, {0, 0, 0}, 1};
  const auto give = [&](Step& s) { s.input.pins = &pin, s.input.pin_count = 1; };
  refuses(HM_ERROR_ARGUMENT, "pins[0].vertex", give);
  pin.vertex = 0;
  refuses(HM_ERROR_VALUE, "pins[0].vertex is a root", give);
  pin.vertex = 3;
  pin.stiffness = -1;
  refuses(HM_ERROR_VALUE, "pins[0].stiffness", give);
  pin.stiffness = kInfinity;
  pin.target[1] = NAN;
  refuses(HM_ERROR_VALUE, "pins[0].target", give);
  refuses(HM_ERROR_ARGUMENT, "pins", [](Step& s) { s.input.pin_count = 1; });
}

TEST_F(LibraryMisuse, HandlesThatAreGoneAreAnsweredForEver) {
  const hm_hair gone = makeHair(mesh_);
  ASSERT_EQ(hm_hair_destroy(gone), HM_OK);
  const hm_hair next = makeHair(mesh_);  // in the same slot
  const Step step(0);
  std::size_t size = 0;
  hm_view view{};
  double value = 0;
  char byte = 0;
  const hm_pose pose = headAt(0);
  hm_strand strand{};
  hm_strand_settings settings{};
  const hm_strand_output output{};
  const hm_target target{};
  for (const hm_hair hair : {gone, hm_hair{0}, hm_hair{~std::uint64_t{0}}, hm_hair{gone.id + 1}}) {
    for (const hm_result result :
         {hm_hair_step(hair, &step.input, nullptr), hm_hair_destroy(hair), hm_hair_reset(hair, &pose),
          hm_hair_carry(hair, &pose, &pose), hm_hair_save(hair, nullptr, 0, &size), hm_hair_restore(hair, &byte, 1),
          hm_hair_positions(hair, &view), hm_hair_velocities(hair, &view), hm_hair_read_positions(hair, &target),
          hm_hair_read_velocities(hair, &target), hm_hair_get(hair, "density", &value),
          hm_hair_set(hair, "density", 60), hm_hair_set_text(hair, "density", "60"), hm_hair_reset_parameters(hair),
          hm_hair_describe_strand(hair, 0, &strand), hm_hair_grow_strands(hair, &settings, &output)})
      EXPECT_EQ(result, HM_ERROR_HANDLE);
  }
  EXPECT_EQ(hm_hair_destroy(next), HM_OK);
  hm_mesh_info info{};
  hm_hair hair{};
  EXPECT_EQ(hm_mesh_describe({12345}, &info), HM_ERROR_HANDLE);
  EXPECT_EQ(hm_mesh_describe({hair_.id}, &info), HM_ERROR_HANDLE) << "a hair is no mesh";
  EXPECT_EQ(hm_mesh_destroy({hair_.id}), HM_ERROR_HANDLE);
  EXPECT_EQ(hm_hair_get({mesh_.id}, "density", &value), HM_ERROR_HANDLE) << "a mesh is no hair";
  EXPECT_EQ(hm_mesh_destroy({0}), HM_ERROR_HANDLE);
  EXPECT_EQ(hm_hair_create({0}, nullptr, &hair), HM_ERROR_HANDLE);
}

TEST_F(LibraryMisuse, NullIsNamed) {
  double value = 0;
  hm_parameter row{};
  for (const hm_result result : {hm_mesh_create(nullptr, &mesh_),
                                 hm_mesh_create_from_text(nullptr, 3, nullptr, 0, &mesh_),
                                 hm_mesh_describe(mesh_, nullptr),
                                 hm_hair_create(mesh_, nullptr, nullptr),
                                 hm_hair_step(hair_, nullptr, nullptr),
                                 hm_hair_reset(hair_, nullptr),
                                 hm_hair_carry(hair_, nullptr, nullptr),
                                 hm_hair_save(hair_, nullptr, 0, nullptr),
                                 hm_hair_restore(hair_, nullptr, 7),
                                 hm_hair_positions(hair_, nullptr),
                                 hm_hair_velocities(hair_, nullptr),
                                 hm_hair_read_positions(hair_, nullptr),
                                 hm_hair_read_velocities(hair_, nullptr),
                                 hm_hair_get(hair_, nullptr, &value),
                                 hm_hair_get(hair_, "density", nullptr),
                                 hm_hair_set(hair_, nullptr, 1),
                                 hm_hair_set_text(hair_, "density", nullptr),
                                 hm_hair_set_text(hair_, nullptr, "1"),
                                 hm_parameter_at(0, nullptr),
                                 hm_parameter_at(-1, &row),
                                 hm_parameter_at(1000, &row),
                                 hm_parameter_find(nullptr, &row),
                                 hm_hair_grow_strands(hair_, nullptr, nullptr),
                                 hm_hair_describe_strand(hair_, 0, nullptr),
                                 hm_ellipsoid_moved(nullptr, nullptr, 1)}) {
    EXPECT_EQ(result, HM_ERROR_ARGUMENT) << hm_error_message();
  }
  hm_default_mesh_settings(nullptr);
  hm_default_hair_settings(nullptr);
  hm_default_step_input(nullptr);
  hm_default_ellipsoid(nullptr);
  hm_default_strand_settings(nullptr);
  EXPECT_STREQ(hm_result_name(HM_ERROR_INTERNAL), "HM_ERROR_INTERNAL");
  EXPECT_STREQ(hm_result_name(static_cast<hm_result>(99)), "no result of this library");
}

TEST_F(LibraryMisuse, MeshesThatCannotBeSimulatedAreRefused) {
  const sim::HairMeshShape shape = someShape();
  hm_mesh mesh{};
  const auto refused = [&](hm_result expected, const std::string& word, const std::function<void(Arrays&)>& spoil) {
    Arrays arrays(shape);
    spoil(arrays);
    EXPECT_EQ(hm_mesh_create(&arrays.settings, &mesh), expected) << word;
    EXPECT_NE(std::string(hm_error_message()).find(word), std::string::npos) << hm_error_message();
  };
  refused(HM_ERROR_MESH, "column 2", [](Arrays& a) { a.lengths[2] = 1; });
  refused(HM_ERROR_SIZE, "positions", [](Arrays& a) { a.lengths[2] += 1; });
  refused(HM_ERROR_VALUE, "positions[4]", [](Arrays& a) { a.positions[13] = NAN; });
  refused(HM_ERROR_MESH, "root face 1", [](Arrays& a) { a.faces[5] = 999; });
  refused(HM_ERROR_MESH, "root face", [](Arrays& a) { a.faces[5] = a.faces[4]; });
  refused(HM_ERROR_MESH, "", [](Arrays& a) { a.settings.reverse_faces = 1; });
  refused(HM_ERROR_MESH, "", [](Arrays& a) { a.settings.face_count = 0; });
  refused(HM_ERROR_ARGUMENT, "faces", [](Arrays& a) { a.settings.faces = nullptr; });
  refused(HM_ERROR_ARGUMENT, "column_lengths", [](Arrays& a) { a.settings.column_lengths = nullptr; });
}

TEST_F(LibraryMisuse, StatesOfOtherBytesAreRefused) {
  std::vector<char> bytes = stateOf(hair_);
  const std::vector<char> before = bytes;
  std::size_t size = 0;
  char small[8];
  EXPECT_EQ(hm_hair_save(hair_, small, sizeof small, &size), HM_ERROR_SIZE);
  EXPECT_EQ(size, before.size());
  EXPECT_EQ(hm_hair_restore(hair_, bytes.data(), bytes.size() - 1), HM_ERROR_STATE);
  EXPECT_EQ(hm_hair_restore(hair_, bytes.data(), 3), HM_ERROR_STATE);
  bytes[bytes.size() / 2] ^= 1;
  EXPECT_EQ(hm_hair_restore(hair_, bytes.data(), bytes.size()), HM_ERROR_STATE);
  EXPECT_EQ(before, stateOf(hair_));
}

TEST_F(LibraryMisuse, StrandsThatDoNotExistAreRefused) {
  ASSERT_EQ(hm_hair_set(hair_, "strands", 10), HM_OK);
  std::vector<double> room(3 * 32);
  hm_strand strand{};
  EXPECT_EQ(hm_hair_describe_strand(hair_, 10, &strand), HM_ERROR_ARGUMENT);
  EXPECT_EQ(hm_hair_describe_strand(hair_, -1, &strand), HM_ERROR_ARGUMENT);
  const auto grow = [&](hm_strand_settings settings, std::size_t elements) {
    hm_strand_output output{};
    output.positions = {room.data(), 0, elements, HM_FLOAT64};
    return hm_hair_grow_strands(hair_, &settings, &output);
  };
  const std::int32_t numbers[] = {3, 12};
  EXPECT_EQ(grow({nullptr, 0, 2, 16}, 32), HM_OK) << hm_error_message();
  EXPECT_EQ(grow({nullptr, 0, 2, 16}, 31), HM_ERROR_SIZE);
  EXPECT_EQ(grow({nullptr, 9, 2, 16}, 32), HM_ERROR_ARGUMENT);
  EXPECT_EQ(grow({nullptr, -1, 2, 16}, 32), HM_ERROR_ARGUMENT);
  EXPECT_EQ(grow({nullptr, 2147483647, 2, 16}, 32), HM_ERROR_ARGUMENT);
  EXPECT_EQ(grow({nullptr, 0, 32, 1}, 32), HM_ERROR_ARGUMENT);
  EXPECT_EQ(grow({nullptr, 0, -1, 16}, 0), HM_ERROR_ARGUMENT);
  EXPECT_EQ(grow({numbers, 0, 2, 16}, 32), HM_ERROR_ARGUMENT);
  EXPECT_EQ(hm_hair_set(hair_, "strands", 0), HM_OK);
  EXPECT_EQ(grow({nullptr, 0, 1, 16}, 16), HM_ERROR_ARGUMENT);
}

TEST(LibraryEllipsoid, TakesTheVelocitiesOfItsMotion) {
  hm_ellipsoid ball;
  hm_default_ellipsoid(&ball);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.3, Vec3::UnitZ()));
  ball.pose = {{1, 2, 3}, {turn.x(), turn.y(), turn.z(), turn.w()}};
  const hm_pose before{{0, 2, 3}, {0, 0, 0, 1}};
  ASSERT_EQ(hm_ellipsoid_moved(&ball, &before, 0.5), HM_OK);
  EXPECT_NEAR(ball.velocity[0], 2, 1e-12);
  EXPECT_NEAR(ball.angular_velocity[2], 0.6, 1e-12);
  EXPECT_EQ(hm_ellipsoid_moved(&ball, &before, 0), HM_ERROR_VALUE);
  EXPECT_EQ(hm_ellipsoid_moved(&ball, &before, NAN), HM_ERROR_VALUE);
}

}  // namespace misuse_test

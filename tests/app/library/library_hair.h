// A hair of the C interface and the same of the simulator's, for the library's tests.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "include/hairmesh.h"
#include "sim/step.h"
#include "tests/test_meshes.h"

namespace library_test {

using sim::Vec3;

inline sim::HairMeshShape someShape() {
  return test::combedShape(test::mixedPatch(8, 0.25));
}

// The arrays of a shape, as a caller has them.
struct Arrays {
  std::vector<std::int32_t> lengths, faces;
  std::vector<double> positions;
  hm_mesh_settings settings{};

  explicit Arrays(const sim::HairMeshShape& shape) {
    for (int c = 0; c < shape.columnCount(); ++c) lengths.push_back(shape.columnLength(c));
    for (const sim::RootFace& face : shape.root_faces)
      faces.insert(faces.end(), face.columns.begin(), face.columns.end());
    for (const Vec3& p : shape.positions) positions.insert(positions.end(), p.data(), p.data() + 3);
    hm_default_mesh_settings(&settings);
    settings.positions = {positions.data(), 0, shape.positions.size(), HM_FLOAT64};
    settings.column_lengths = lengths.data();
    settings.column_count = lengths.size();
    settings.faces = faces.data();
    settings.face_count = shape.root_faces.size();
  }
};

inline hm_mesh makeMesh() {
  const Arrays arrays(someShape());
  hm_mesh mesh{};
  EXPECT_EQ(hm_mesh_create(&arrays.settings, &mesh), HM_OK) << hm_error_message();
  return mesh;
}

inline hm_hair makeHair(hm_mesh mesh) {
  hm_hair hair{};
  EXPECT_EQ(hm_hair_create(mesh, nullptr, &hair), HM_OK) << hm_error_message();
  return hair;
}

// The head nods and turns; a ball sweeps through the hair.
inline hm_pose headAt(int step) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.8 * std::sin(0.2 * step), Vec3(0.3, 1, 0.2).normalized()));
  return {{0.02 * std::sin(0.3 * step), 0, 0}, {turn.x(), turn.y(), turn.z(), turn.w()}};
}

inline hm_ellipsoid ballAt(int step, double dt) {
  hm_ellipsoid ball;
  hm_default_ellipsoid(&ball);
  ball.pose.position[0] = 0.03 + 0.08 * std::sin(0.15 * step);
  ball.pose.position[1] = -0.12;
  ball.pose.position[2] = 0.03;
  ball.radii[0] = ball.radii[1] = ball.radii[2] = 0.03;
  ball.velocity[0] = 0.08 * 0.15 * std::cos(0.15 * step) / dt;
  return ball;
}

struct Step {
  hm_step_input input;
  hm_ellipsoid ball;
  explicit Step(int number) {
    hm_default_step_input(&input);
    input.time = number * input.dt;
    input.head = headAt(number);
    ball = ballAt(number, input.dt);
    input.ellipsoids = &ball;
    input.ellipsoid_count = 1;
  }
  Step(const Step&) = delete;
};

inline hm_report advance(hm_hair hair, int from, int to) {
  hm_report report{};
  for (int n = from; n < to; ++n) {
    const Step step(n);
    EXPECT_EQ(hm_hair_step(hair, &step.input, &report), HM_OK) << hm_error_message();
  }
  return report;
}

inline std::vector<double> positionsOf(hm_hair hair) {
  hm_view view{};
  EXPECT_EQ(hm_hair_positions(hair, &view), HM_OK);
  EXPECT_EQ(view.stride, 3 * sizeof(double));
  return std::vector<double>(view.data, view.data + 3 * view.count);
}

inline std::vector<char> stateOf(hm_hair hair) {
  std::size_t size = 0;
  EXPECT_EQ(hm_hair_save(hair, nullptr, 0, &size), HM_OK);
  std::vector<char> bytes(size);
  EXPECT_EQ(hm_hair_save(hair, bytes.data(), bytes.size(), &size), HM_OK);
  return bytes;
}

}  // namespace library_test

// Fields read from the colours of a mesh's vertices: what lies where, whatever unit and place, and what is refused.
#include "app/files/painted_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <numbers>

#include "app/files/errors.h"
#include "app/files/field_map.h"
#include "tests/run_program.h"

namespace painted_mesh_test {

using sim::Vec3;
using Shade = std::function<double(const Vec3&)>;

// A ball, or its upper part, as an OBJ text with a grey value a vertex.
std::string ball(const Shade& shade, double radius, const Vec3& middle, int rows = 24, double share = 1) {
  const int columns = 2 * rows;
  std::string text;
  for (int r = 0; r <= rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const double polar = share * std::numbers::pi * r / rows, azimuth = 2 * std::numbers::pi * c / columns;
      const Vec3 way(std::sin(polar) * std::sin(azimuth), std::cos(polar), std::sin(polar) * std::cos(azimuth));
      const Vec3 at = middle + radius * way;
      std::string line = "v";
      for (const double value : {at.x(), at.y(), at.z(), shade(way), shade(way), shade(way)})
        line += " " + std::to_string(value);
      text += line + "\n";
    }
  }
  const auto number = [&](int r, int c) { return std::to_string(1 + r * columns + c % columns); };
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c)
      text += "f " + number(r, c) + " " + number(r + 1, c) + " " + number(r + 1, c + 1) + " " + number(r, c + 1) + "\n";
  }
  return text;
}

std::string fileOf(const std::string& name, const std::string& text) {
  static const std::string folder = test::freshFolder("painted_mesh");
  std::ofstream(folder + "/" + name) << text;
  return folder + "/" + name;
}

double sideOf(const Vec3& way) {
  return 0.5 + 0.4 * way.x() - 0.1 * way.y();
}

TEST(PaintedMesh, ColoursLieInTheirDirectionWhateverUnitAndPlace) {
  struct Case {
    double radius, share;
    Vec3 middle;
  };
  for (const Case& c : {Case{0.1, 1, {0, 1.6, 0}}, Case{10, 1, {3, -160, 20}}, Case{0.09, 0.55, {0, 0, 0}}}) {
    const app::FieldMap map = app::readFieldMap(fileOf("ball.obj", ball(sideOf, c.radius, c.middle, 24, c.share)));
    double worst = 0;
    for (int row = 2; row < map.height - 2; ++row) {
      for (int column = 0; column < map.width; ++column) {
        const Vec3 way = app::directionOf(map, column, row);
        if (std::acos(way.y()) > 0.95 * c.share * std::numbers::pi) continue;  // no face lies there
        worst = std::max(worst, std::abs(map.at(way) - sideOf(way)));
      }
    }
    std::printf("radius %g, upper %.0f %%: off by at most %.3f\n", c.radius, 100 * c.share, worst);
    EXPECT_LT(worst, 0.03) << c.radius;
  }
}

// Faces of no area, and one that repeats a corner, change nothing.
TEST(PaintedMesh, FacesOfNoAreaChangeNothing) {
  const std::string whole = ball(sideOf, 0.1, {0, 0, 0});
  const app::FieldMap plain = app::readFieldMap(fileOf("whole.obj", whole));
  const app::FieldMap more =
      app::readFieldMap(fileOf("no_area.obj", whole + "f 500 500 501\nf 600 601 600\nf 700 700 700\n"));
  ASSERT_EQ(more.value.size(), plain.value.size());
  double worst = 0;
  for (std::size_t k = 0; k < more.value.size(); ++k)
    worst = std::max(worst, std::abs(double(more.value[k]) - double(plain.value[k])));
  EXPECT_LT(worst, 0.02);
}

TEST(PaintedMesh, WhiteIsWhiteEverywhereAlsoWhereNoFaceLies) {
  const app::FieldMap map =
      app::readFieldMap(fileOf("cap.obj", ball([](const Vec3&) { return 1; }, 0.1, {0, 0, 0}, 8, 0.4)));
  for (const float value : map.value) ASSERT_EQ(value, 1.0f);
}

// A PLY as scanners and modelling programs write it, colours in bytes.
TEST(PaintedMesh, APlyWithColoursIsRead) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 8\n"
      "property list uchar int vertex_indices\nend_header\n"
      "1 0 0 255 0 0\n-1 0 0 0 255 0\n0 1 0 0 0 255\n0 -1 0 255 255 0\n0 0 1 0 255 255\n0 0 -1 255 0 255\n";
  for (const char* face : {"2 4 0", "2 0 5", "2 5 1", "2 1 4", "3 0 4", "3 5 0", "3 1 5", "3 4 1"})
    text += std::string("3 ") + face + "\n";
  const app::ColorMap map = app::readColorMap(fileOf("octahedron.ply", text));
  const auto near = [&](const Vec3& way, double red, double green, double blue) {
    EXPECT_NEAR(map[0].at(way), red, 0.05);
    EXPECT_NEAR(map[1].at(way), green, 0.05);
    EXPECT_NEAR(map[2].at(way), blue, 0.05);
  };
  near({1, 0, 0}, 1, 0, 0);
  near({-1, 0, 0}, 0, 1, 0);
  near({0, 1, 0}, 0, 0, 1);
  near({0, 0, 1}, 0, 1, 1);
}

TEST(PaintedMesh, WhatCannotBeAFieldIsRefused) {
  struct Case {
    const char *name, *fault;
    std::string text;
  };
  const std::string flat =
      "v 0 0 0 1 1 1\nv 1 0 0 1 1 1\nv 1 1 0 1 1 1\nv 0 1 0 1 1 1\nf 1 2 3 4\n# so that it is long enough\n";
  const std::string claims =
      "ply\nformat ascii 1.0\nelement vertex 100000000\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n";
  for (const Case& c : {Case{"plain.obj", "no colours", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\n"},
                        Case{"flat.obj", "flat", flat}, Case{"empty.obj", "empty", ""},
                        Case{"text.ply", "cannot be read", "this is no mesh at all\n"},
                        Case{"bytes.obj", "vertex 0: has a colour that is not from 0 to 1",
                             ball([](const Vec3&) { return 200; }, 0.1, {0, 0, 0}, 6)},
                        Case{"none.obj", "has a colour that is not from 0 to 1",
                             ball([](const Vec3&) { return std::nan(""); }, 0.1, {0, 0, 0}, 6)},
                        Case{"claims.ply", "element vertex 100000000: does not fit into a file of", claims}}) {
    try {
      app::readFieldMap(fileOf(c.name, c.text));
      ADD_FAILURE() << c.name << " is taken";
    } catch (const app::InputError& fault) {
      EXPECT_NE(std::string(fault.what()).find(c.fault), std::string::npos) << fault.what();
    }
  }
}

}  // namespace painted_mesh_test

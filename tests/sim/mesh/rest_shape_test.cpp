// A reshaped mesh is the mesh that is built from that shape; brushes keep it valid.
#include "sim/mesh/rest_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "app/groom/edit/shape_brush.h"
#include "sim/mesh/rest_measures.h"
#include "tests/test_meshes.h"

namespace rest_shape_test {

using app::BrushTool;
using sim::Vec3;

sim::HairMesh combedMesh() {
  return sim::buildHairMesh(test::combedShape(test::mixedPatch(7, 0.3)));
}

void expectSame(const sim::HairMesh& a, const sim::HairMesh& b) {
  EXPECT_EQ(a.shape.positions, b.shape.positions);
  EXPECT_EQ(a.vertex_volume, b.vertex_volume);
  EXPECT_EQ(a.total_volume, b.total_volume);
  EXPECT_EQ(a.hair_length, b.hair_length);
  for (std::size_t k = 0; k < a.tets.size(); ++k) {
    ASSERT_EQ(a.tets[k].rest_volume, b.tets[k].rest_volume) << k;
    ASSERT_EQ(a.tets[k].volume, b.tets[k].volume) << k;
  }
  for (std::size_t k = 0; k < a.prisms.size(); ++k) ASSERT_EQ(a.prisms[k].volume, b.prisms[k].volume) << k;
  for (std::size_t k = 0; k < a.walls.size(); ++k) ASSERT_EQ(a.walls[k].volume, b.walls[k].volume) << k;
  for (std::size_t k = 0; k < a.horizontal_edges.size(); ++k) {
    ASSERT_EQ(a.horizontal_edges[k].rest_length, b.horizontal_edges[k].rest_length) << k;
    ASSERT_EQ(a.horizontal_edges[k].volume, b.horizontal_edges[k].volume) << k;
  }
  for (std::size_t k = 0; k < a.vertical_edges.size(); ++k) {
    ASSERT_EQ(a.vertical_edges[k].rest_length, b.vertical_edges[k].rest_length) << k;
    ASSERT_EQ(a.vertical_edges[k].volume, b.vertical_edges[k].volume) << k;
  }
  for (std::size_t k = 0; k < a.hinges.size(); ++k) {
    ASSERT_EQ(a.hinges[k].rest_angle, b.hinges[k].rest_angle) << k;
    ASSERT_EQ(a.hinges[k].length, b.hinges[k].length) << k;
    ASSERT_EQ(a.hinges[k].volume, b.hinges[k].volume) << k;
  }
}

TEST(RestShape, IsThatOfAMeshBuiltFromIt) {
  sim::HairMesh mesh = combedMesh();
  sim::RestShape shape(mesh);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> stir(-5e-4, 5e-4);
  for (int round = 0; round < 3; ++round) {
    sim::HairMeshShape other = mesh.shape;
    for (Vec3& p : other.positions) p += Vec3(stir(random), stir(random), stir(random));
    ASSERT_TRUE(shape.set(other.positions, mesh)) << round;
    expectSame(mesh, sim::buildHairMesh(other));
  }
}

TEST(RestShape, RefusesAFlatPrismAndChangesNothing) {
  sim::HairMesh mesh = combedMesh();
  const sim::HairMesh before = mesh;
  std::vector<Vec3> flat = mesh.shape.positions;
  flat[1] = flat[0];
  sim::RestShape shape(mesh);
  EXPECT_FALSE(shape.set(flat, mesh));
  flat = mesh.shape.positions;
  flat[2].x() = NAN;
  EXPECT_FALSE(shape.set(flat, mesh));
  expectSame(mesh, before);
}

double lengthOf(const sim::HairMesh& mesh, std::span<const Vec3> x, int c) {
  double length = 0;
  for (int v = mesh.shape.column_first[c] + 1; v < mesh.shape.column_first[c + 1]; ++v)
    length += (x[v] - x[v - 1]).norm();
  return length;
}

// A wild hand: 200 samples of every brush at random places. Whatever it does, the mesh can be built.
TEST(ShapeBrush, WhateverAHandDoesEveryPrismStaysPositive) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> share(0, 1);
  const auto away = [](const Vec3& p) { return (p - Vec3(0.3, 0.2, 0)).norm() - 0.01; };
  for (int tool = 0; tool < static_cast<int>(BrushTool::kFreeze); ++tool) {
    sim::HairMesh mesh = combedMesh();
    sim::RestShape shape(mesh);
    app::ShapeBrushes brushes(mesh);
    std::vector<Vec3> positions;
    int moved = 0;
    for (int k = 0; k < 200; ++k) {
      app::Brush brush;
      brush.tool = static_cast<BrushTool>(tool);
      brush.at = mesh.shape.positions[random() % mesh.shape.positions.size()];
      brush.along = 0.05 * Vec3(share(random) - 0.5, share(random) - 0.5, share(random) - 0.5);
      brush.radius = 0.01 + 0.1 * share(random);
      brush.strength = share(random);
      brush.falloff = 3 * share(random);
      if (k % 3 == 0) brush.mirror = 0.01;
      moved += brushes.apply(brush, mesh, mesh.shape.positions, away, positions);
      ASSERT_TRUE(shape.set(positions, mesh)) << app::kBrushNames[static_cast<std::size_t>(tool)] << " " << k;
    }
    EXPECT_GT(moved, 500) << tool;
    EXPECT_NO_THROW(sim::buildHairMesh(mesh.shape));
  }
}

TEST(ShapeBrush, EachDoesWhatItsNameSays) {
  sim::HairMesh mesh = combedMesh();
  app::ShapeBrushes brushes(mesh);
  const std::vector<Vec3> before = mesh.shape.positions;
  const int column = mesh.columnCount() / 2, tip = mesh.shape.column_first[column + 1] - 1;
  std::vector<Vec3> after;
  app::Brush brush;
  brush.at = before[tip];
  brush.radius = 0.05;
  brush.strength = 0.3;
  brush.along = {0.003, 0, 0};
  const auto apply = [&](BrushTool tool) {
    brush.tool = tool;
    return brushes.apply(brush, mesh, before, {}, after);
  };
  ASSERT_GT(apply(BrushTool::kComb), 0);
  EXPECT_GT((after[tip] - before[tip]).x(), 1e-4);
  EXPECT_NEAR(lengthOf(mesh, after, column), lengthOf(mesh, before, column), 0.01 * mesh.hair_length);
  ASSERT_GT(apply(BrushTool::kGrow), 0);
  EXPECT_GT(lengthOf(mesh, after, column), 1.001 * lengthOf(mesh, before, column));
  brush.at = before[tip - 1];
  ASSERT_GT(apply(BrushTool::kCut), 0);
  EXPECT_LT(lengthOf(mesh, after, column), 0.99 * lengthOf(mesh, before, column));
  brush.at = Vec3(5, 5, 5);
  for (const BrushTool tool : {BrushTool::kComb, BrushTool::kCut, BrushTool::kPuff}) {
    EXPECT_EQ(apply(tool), 0);
    EXPECT_EQ(after, before);
  }
}

// How far what a brush reaches lies from its middle, across the hair, in the mean square.
double spreadOf(const sim::HairMesh& mesh, std::span<const Vec3> x, const Vec3& at) {
  Vec3 middle = Vec3::Zero();
  double sum = 0, count = 0;
  for (const bool measure : {false, true}) {
    for (std::size_t v = 0; v < x.size(); ++v) {
      if ((mesh.shape.positions[v] - at).norm() > 0.04) continue;
      if (measure) sum += (x[v] - middle / count).squaredNorm();
      if (!measure) middle += x[v], ++count;
    }
  }
  return sum;
}

TEST(ShapeBrush, PinchGathersSpreadPartsTwistTurnsPushLeadsOut) {
  sim::HairMesh mesh = combedMesh();
  app::ShapeBrushes brushes(mesh);
  const std::vector<Vec3> before = mesh.shape.positions;
  std::vector<Vec3> after;
  app::Brush brush;
  brush.at = before[static_cast<std::size_t>(mesh.shape.column_first[mesh.columnCount() / 2 + 1] - 2)];
  brush.radius = 0.06;
  const Vec3 under = brush.at - Vec3(0, 0, 0.3);
  const auto body = [&](const Vec3& p) { return (p - under).norm() - 0.1; };
  const auto apply = [&](BrushTool tool) {
    brush.tool = tool;
    return brushes.apply(brush, mesh, before, body, after);
  };
  const double spread = spreadOf(mesh, before, brush.at);
  ASSERT_GT(apply(BrushTool::kPinch), 0);
  EXPECT_LT(spreadOf(mesh, after, brush.at), spread);
  ASSERT_GT(apply(BrushTool::kSpread), 0);
  EXPECT_GT(spreadOf(mesh, after, brush.at), spread);
  ASSERT_GT(apply(BrushTool::kTwist), 0);
  EXPECT_NEAR(spreadOf(mesh, after, brush.at), spread, 0.05 * spread);
  EXPECT_NE(after, before);
  ASSERT_GT(apply(BrushTool::kPush), 0);
  double nearer = 0, out = 0;
  for (std::size_t v = 0; v < after.size(); ++v) {
    nearer = std::max(nearer, body(before[v]) - body(after[v]));
    out = std::max(out, body(after[v]) - body(before[v]));
  }
  EXPECT_GT(out, 1e-4);
  EXPECT_LT(nearer, out);
  // What is frozen stays.
  const std::vector<float> frozen(before.size(), 1.0f);
  brush.frozen = frozen;
  EXPECT_EQ(apply(BrushTool::kTwist), 0);
}

// A ball in the way: nothing that the brush moves comes nearer to it than it was, or than the offset.
TEST(ShapeBrush, NothingIsPushedIntoTheBody) {
  sim::HairMesh mesh = combedMesh();
  sim::RestShape shape(mesh);
  app::ShapeBrushes brushes(mesh);
  const int tip = mesh.shape.column_first[mesh.columnCount() / 2 + 1] - 1;
  const Vec3 centre = mesh.shape.positions[tip] + Vec3(0.3, 0, 0);
  const auto body = [&](const Vec3& p) { return (p - centre).norm() - 0.25; };
  const std::vector<Vec3> before = mesh.shape.positions;
  std::vector<Vec3> positions;
  for (int k = 0; k < 100; ++k) {
    app::Brush brush;
    brush.at = mesh.shape.positions[tip];
    brush.along = {0.01, 0, 0};
    brush.radius = 0.1;
    brushes.apply(brush, mesh, mesh.shape.positions, body, positions);
    ASSERT_TRUE(shape.set(positions, mesh));
  }
  double farthest = 0;
  for (std::size_t v = 0; v < before.size(); ++v) {
    EXPECT_GE(body(mesh.shape.positions[v]), std::min(0.0019, body(before[v]) - 1e-12)) << v;
    farthest = std::max(farthest, (mesh.shape.positions[v] - before[v]).norm());
  }
  EXPECT_GT(farthest, 0.02) << "the brush has done nothing";
}

}  // namespace rest_shape_test

// Partings drawn and closed on both sides of the head at once.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "app/files/errors.h"
#include "app/groom/edit/mesh_edit.h"
#include "tests/app/scene/mesh_in_hand.h"

namespace mesh_mirror_test {

using app::Ask;
using app::Demo;
using sim::Vec3;
using test::ask;
using test::demoOf;
using test::expectValid;
using test::meshOf;

// Columns that root where another does, on one side of the head.
int partedColumns(const Demo& demo, bool left) {
  const sim::HairMeshShape& shape = meshOf(demo).shape;
  const double plane = demo.actors[0].body->character.scalp.center.x();
  const auto root = [&](int c) {
    return shape.positions[static_cast<std::size_t>(shape.column_first[static_cast<std::size_t>(c)])];
  };
  int parted = 0;
  for (int c = 0; c < shape.columnCount(); ++c) {
    for (int other = 0; other < c; ++other)
      parted += (root(c) - root(other)).norm() < 1e-4 && (root(c).x() > plane) == left;
  }
  return parted;
}

// Down the hair at the back, away from the style's own seams; 28 is the like of 16.
TEST(MeshMirror, APartingIsDrawnAndClosedOnBothSidesOfTheHead) {
  Demo demo = demoOf();
  const int before = meshOf(demo).columnCount();
  const int left = partedColumns(demo, true), right = partedColumns(demo, false);
  const std::string chain = "15 16 16 17";
  ASSERT_EQ(ask({Ask::kMesh, "split", "mirror " + chain}, demo), "");
  expectValid(demo);
  EXPECT_EQ(partedColumns(demo, true), left + 1);
  EXPECT_EQ(partedColumns(demo, false), right + 1);
  ASSERT_EQ(ask({Ask::kMesh, "merge", "mirror 16"}, demo), "");
  expectValid(demo);
  EXPECT_EQ(partedColumns(demo, true), left);
  EXPECT_EQ(partedColumns(demo, false), right);
  EXPECT_EQ(meshOf(demo).columnCount(), before);
  ASSERT_EQ(ask({Ask::kUndo, "", "", 2}, demo), "");
  EXPECT_EQ(meshOf(demo).columnCount(), before);
}

// The other way about, over a plane beside all hair.
TEST(MeshMirror, WhatHasNoLikeIsRefused) {
  const Demo demo = demoOf();
  const sim::HairMeshShape& shape = meshOf(demo).shape;
  const std::vector<int> column{3};
  EXPECT_THROW(app::withMirrored(shape, column, 1.0), app::InputError);
  const sim::RootFace& face = shape.root_faces[0];
  const std::vector<app::ColumnPair> edge{{face.columns[0], face.columns[1]}};
  EXPECT_THROW(app::withMirrored(shape, edge, 1.0), app::InputError);
  // And over a plane through a column that is its own like.
  const double own = shape.positions[static_cast<std::size_t>(shape.column_first[3])].x();
  EXPECT_EQ(app::withMirrored(shape, column, own), column);
}

}  // namespace mesh_mirror_test

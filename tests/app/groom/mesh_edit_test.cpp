// Changes of a hair mesh's structure: valid afterwards, strands where they were, what cannot be is refused.
#include "app/groom/edit/mesh_edit.h"

#include <gtest/gtest.h>

#include "app/files/errors.h"
#include "tests/test_meshes.h"

namespace mesh_edit_test {

using app::ColumnPair;
using app::EditedMesh;
using sim::HairMeshShape;
using sim::Vec3;

HairMeshShape combed(int layers, bool uneven) {
  test::PatchOptions options = test::mixedPatch(layers, 0.2);
  options.uneven = uneven;
  return test::combedShape(options);
}

// Column i, k of the patch of mixedPatch.
int at(int i, int k) {
  return 5 * k + i;
}

std::span<const Vec3> columnOf(const HairMeshShape& shape, int c) {
  return std::span(shape.positions)
      .subspan(static_cast<std::size_t>(shape.column_first[static_cast<std::size_t>(c)]),
               static_cast<std::size_t>(shape.columnLength(c)));
}

double distanceToCurve(const Vec3& p, std::span<const Vec3> column) {
  double least = INFINITY;
  for (int k = 0; k <= 200 * (static_cast<int>(column.size()) - 1); ++k)
    least = std::min(least, (app::onColumn(column, k / 200.0) - p).norm());
  return least;
}

// Farthest of the new curves from the old ones, by another way than the edit's own.
double farthest(const HairMeshShape& from, const HairMeshShape& to) {
  double most = 0;
  for (int c = 0; c < from.columnCount(); ++c) {
    const std::span<const Vec3> column = columnOf(from, c);
    for (int k = 0; k <= 10 * (static_cast<int>(column.size()) - 1); ++k)
      most = std::max(most, distanceToCurve(app::onColumn(column, k / 10.0), columnOf(to, c)));
  }
  return most;
}

std::string faultOf(const auto& edit) {
  try {
    edit();
  } catch (const app::InputError& fault) {
    return fault.what();
  }
  return "";
}

TEST(MeshEdit, TheCurveOfAColumnIsTheStrandsOwn) {
  const std::vector<Vec3> line{{0, 0, 0}, {1, 0, 0}, {2, 1, 0}, {4, 1, 0}};
  for (int k = 0; k < 4; ++k) EXPECT_LT((app::onColumn(line, k) - line[static_cast<std::size_t>(k)]).norm(), 1e-15);
  // Catmull-Rom at the middle: (-p0 + 9 p1 + 9 p2 - p3) / 16.
  EXPECT_LT((app::onColumn(line, 1.5) - (-line[0] + 9 * line[1] + 9 * line[2] - line[3]) / 16).norm(), 1e-15);
}

TEST(MeshEdit, AnAddedLayerLeavesEveryVertexAndAlmostEveryPointOfStrands) {
  for (const bool uneven : {false, true}) {
    const HairMeshShape before = combed(7, uneven);
    const double volume = sim::buildHairMesh(before).total_volume;
    for (int after = 0; after < 7; ++after) {
      const EditedMesh edited = app::addLayer(before, after, {});
      const sim::HairMesh mesh = sim::buildHairMesh(edited.shape);
      ASSERT_EQ(edited.sources.size(), edited.shape.positions.size());
      EXPECT_EQ(*std::ranges::max_element(mesh.bundle_layers), 8) << after;
      std::size_t kept = 0;
      for (std::size_t v = 0; v < edited.sources.size(); ++v) {
        const app::VertexSource& source = edited.sources[v];
        kept +=
            source.share == 0 && edited.shape.positions[v] == before.positions[static_cast<std::size_t>(source.from)];
      }
      EXPECT_EQ(kept, before.positions.size()) << after;
      EXPECT_LT(edited.moved, 8e-4) << after << ": of segments of 33 mm";
      EXPECT_LT(farthest(before, edited.shape), edited.moved + 1e-4) << after;
      if (after < 6) {
        EXPECT_NEAR(mesh.total_volume, volume, 0.01 * volume) << after;
      }
    }
  }
}

TEST(MeshEdit, ARemovedLayerLeavesStrandsAsNearAsItSays) {
  for (const bool uneven : {false, true}) {
    const HairMeshShape before = combed(9, uneven);
    for (int layer = 1; layer < 9; ++layer) {
      const EditedMesh edited = app::removeLayer(before, layer, {});
      const sim::HairMesh mesh = sim::buildHairMesh(edited.shape);
      EXPECT_EQ(*std::ranges::max_element(mesh.bundle_layers), 8) << layer;
      EXPECT_LT(edited.moved, 3e-3) << layer << ": of segments of 25 mm";
      EXPECT_LT(farthest(edited.shape, before), edited.moved + 1e-4) << layer;
    }
  }
}

TEST(MeshEdit, TheScalpAndTheLastLayerStay) {
  const HairMeshShape thin = test::patchShape({.nx = 2, .nz = 2, .layers = 2});
  EXPECT_NE(faultOf([&] { app::removeLayer(thin, 1, {}); }).find("a bundle needs two layers"), std::string::npos);
  EXPECT_NE(faultOf([&] { app::removeLayer(thin, 0, {}); }).find("is the scalp's"), std::string::npos);
  EXPECT_NE(faultOf([&] { app::removeLayer(thin, 2, {}); }).find("is not there"), std::string::npos);
  EXPECT_NE(faultOf([&] { app::addLayer(thin, -1, {}); }).find("is not there"), std::string::npos);
  HairMeshShape many = test::patchShape({.nx = 1, .nz = 1, .layers = app::kMaxEditedLayers});
  EXPECT_NE(faultOf([&] { app::addLayer(many, 3, {}); }).find("layers already"), std::string::npos);
}

// A parting through the middle of the patch doubles its columns where it reaches the border; welded it is as it was.
TEST(MeshEdit, APartingIsDrawnAndClosedAgain) {
  for (const bool uneven : {false, true}) {
    const HairMeshShape before = combed(6, uneven);
    const std::vector<ColumnPair> line{{at(2, 0), at(2, 1)}, {at(2, 1), at(2, 2)}, {at(2, 2), at(2, 3)}};
    const EditedMesh split = app::splitColumns(before, line);
    const sim::HairMesh mesh = sim::buildHairMesh(split.shape);
    EXPECT_EQ(split.shape.columnCount(), before.columnCount() + 4);
    EXPECT_EQ(split.moved, 0);
    EXPECT_NEAR(mesh.total_volume, sim::buildHairMesh(before).total_volume, 1e-12);
    for (std::size_t v = 0; v < split.sources.size(); ++v)
      EXPECT_EQ(split.shape.positions[v], before.positions[static_cast<std::size_t>(split.sources[v].from)]);
    const EditedMesh merged = app::mergeColumns(split.shape, std::vector<int>{at(2, 0), at(2, 1), at(2, 2), at(2, 3)});
    EXPECT_EQ(merged.shape.column_first, before.column_first);
    EXPECT_EQ(merged.shape.positions, before.positions);
    EXPECT_EQ(merged.moved, 0);
    for (std::size_t f = 0; f < before.root_faces.size(); ++f)
      EXPECT_EQ(merged.shape.root_faces[f].columns, before.root_faces[f].columns);
  }
}

// A slit that ends inside the hair doubles no column at its ends.
TEST(MeshEdit, ASlitStaysJoinedAtItsEnds) {
  const HairMeshShape before = combed(5, false);
  const std::vector<ColumnPair> slit{{at(1, 1), at(2, 1)}, {at(2, 1), at(3, 1)}};
  const EditedMesh split = app::splitColumns(before, slit);
  EXPECT_EQ(split.shape.columnCount(), before.columnCount() + 1);
  sim::buildHairMesh(split.shape);
  EXPECT_NE(faultOf([&] {
              app::splitColumns(before, std::vector<ColumnPair>{{at(1, 1), at(2, 1)}});
            }).find("parts nothing"),
            std::string::npos);
  EXPECT_NE(faultOf([&] {
              app::splitColumns(before, std::vector<ColumnPair>{{at(0, 0), at(4, 3)}});
            }).find("share no edge"),
            std::string::npos);
}

// Sides that were combed apart meet half-way, and the edit says how far that is.
TEST(MeshEdit, AWeldMeetsHalfWay) {
  const HairMeshShape before = combed(5, false);
  const std::vector<ColumnPair> line{{at(2, 0), at(2, 1)}, {at(2, 1), at(2, 2)}, {at(2, 2), at(2, 3)}};
  HairMeshShape parted = app::splitColumns(before, line).shape;
  for (int c = before.columnCount(); c < parted.columnCount(); ++c) {
    const int first = parted.column_first[static_cast<std::size_t>(c)];
    for (int l = 1; l < parted.columnLength(c); ++l)
      parted.positions[static_cast<std::size_t>(first + l)].x() += 0.001 * l;
  }
  const EditedMesh merged = app::mergeColumns(parted, std::vector<int>{at(2, 0), at(2, 1), at(2, 2), at(2, 3)});
  sim::buildHairMesh(merged.shape);
  EXPECT_NEAR(merged.moved, 0.002, 1e-12);
  EXPECT_EQ(merged.shape.columnCount(), before.columnCount());
  EXPECT_NE(faultOf([&] { app::mergeColumns(before, std::vector<int>{at(1, 1)}); }).find("root beside no other"),
            std::string::npos);
  EXPECT_NE(faultOf([&] { app::mergeColumns(before, std::vector<int>{99}); }).find("is not there"), std::string::npos);
}

}  // namespace mesh_edit_test

// Skins of large triangles, divided so that their vertices stand for their surface.
#include "app/figure/fine_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace fine_mesh_test {

using Eigen::Vector3f;

// A square of two triangles; its corners hang on joints 0 to 3, the first two on 4 as well.
app::SkinnedMesh square(float side) {
  app::SkinnedMesh mesh;
  mesh.positions = {{0, 0, 0}, {side, 0, 0}, {side, side, 0}, {0, side, 0}};
  mesh.normals.assign(4, Vector3f::UnitZ());
  mesh.triangles = {0, 1, 2, 0, 2, 3};
  mesh.joints = {{0, 4, 0, 0}, {1, 4, 0, 0}, {2, 0, 0, 0}, {3, 0, 0, 0}};
  mesh.weights = {{0.75f, 0.25f, 0, 0}, {0.75f, 0.25f, 0, 0}, {1, 0, 0, 0}, {1, 0, 0, 0}};
  return mesh;
}

float areaOf(const app::SkinnedMesh& mesh) {
  float area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const Vector3f& a = mesh.positions[mesh.triangles[t]];
    area += 0.5f * (mesh.positions[mesh.triangles[t + 1]] - a).cross(mesh.positions[mesh.triangles[t + 2]] - a).z();
  }
  return area;
}

TEST(FineMesh, LongEdgesAreDividedAndNothingElseChanges) {
  const app::SkinnedMesh coarse = square(0.4f), fine = app::withoutLongEdges(coarse, 0.04f);
  EXPECT_GT(fine.positions.size(), 150u);
  EXPECT_NEAR(areaOf(fine), areaOf(coarse), 1e-5f);
  for (std::size_t t = 0; t < fine.triangles.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_LT((fine.positions[fine.triangles[t + k]] - fine.positions[fine.triangles[t + (k + 1) % 3]]).norm(),
                0.0401f);
  }
  for (std::size_t v = 0; v < fine.positions.size(); ++v) {
    float sum = 0, of_four = 0;
    for (std::size_t j = 0; j < 4; ++j) {
      sum += fine.weights[v][j];
      if (fine.joints[v][j] == 4) of_four += fine.weights[v][j];
    }
    EXPECT_NEAR(sum, 1, 1e-5f);
    EXPECT_LE(of_four, 0.2501f);
    EXPECT_NEAR(fine.normals[v].z(), 1, 1e-6f);
  }
  // Half-way along the lower edge: of both its corners.
  const auto middle = std::ranges::find_if(
      fine.positions, [](const Vector3f& p) { return (p - Vector3f(0.2f, 0, 0)).norm() < 0.021f; });
  ASSERT_NE(middle, fine.positions.end());
  EXPECT_EQ(app::withoutLongEdges(square(0.02f), 0.04f).positions.size(), 4u) << "short edges stay";
  EXPECT_LE(app::withoutLongEdges(square(1e4f), 0.04f).positions.size(), 4 + app::kMaxDivided);
}

}  // namespace fine_mesh_test

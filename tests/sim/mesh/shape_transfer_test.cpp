// A shape handed from one mesh to another of the same hair.
#include "sim/mesh/shape_transfer.h"

#include <gtest/gtest.h>

#include "tests/test_meshes.h"

namespace shape_transfer_test {

using sim::Vec3;

sim::HairMesh patchOf(int columns, int layers) {
  test::PatchOptions o;
  o.nx = o.nz = columns, o.spacing = 0.08 / columns, o.layers = layers, o.length = 0.2;
  return sim::buildHairMesh(test::patchShape(o));
}

// Straight columns over one flat scalp: what is linear in place is known at every place, whatever layers and columns a
// mesh has. Both meshes give it to the other without a loss.
TEST(ShapeTransfer, IsExactForWhatIsLinear) {
  const Eigen::Matrix3d stretch{{1.2, 0.1, -0.2}, {0.05, 0.9, 0.1}, {-0.1, 0.2, 1.1}};
  const auto moved = [&](const Vec3& p) { return Vec3(stretch * p + Vec3(0.3, -0.1, 0.2)); };
  for (const auto& [fine_layers, coarse_layers] : {std::pair{9, 5}, std::pair{10, 4}, std::pair{7, 7}}) {
    const sim::HairMesh fine = patchOf(5, fine_layers), coarse = patchOf(3, coarse_layers);
    for (const auto& [from, to] : {std::pair{&fine, &coarse}, std::pair{&coarse, &fine}}) {
      const sim::ShapeTransfer transfer = sim::makeShapeTransfer(*from, *to);
      std::vector<Vec3> source, velocities, target(to->vertexCount()), given(to->vertexCount());
      for (const Vec3& p : from->shape.positions) source.push_back(moved(p)), velocities.push_back(stretch * p);
      sim::transferPositions(transfer, *from, *to, Eigen::Isometry3d::Identity(), source, target);
      sim::transferVectors(transfer, velocities, given);
      for (int i = 0; i < to->vertexCount(); ++i) {
        EXPECT_LT((target[i] - moved(to->shape.positions[i])).norm(), 1e-6) << i;
        EXPECT_LT((given[i] - stretch * to->shape.positions[i]).norm(), 1e-6) << i;
      }
    }
  }
}

// Hair that moves as a whole stays itself.
TEST(ShapeTransfer, CarriesARigidMotion) {
  const sim::HairMesh from = sim::buildHairMesh(test::combedShape(test::mixedPatch(9, 0.3))),
                      to = sim::buildHairMesh(test::combedShape(test::mixedPatch(6, 0.3)));
  const sim::ShapeTransfer transfer = sim::makeShapeTransfer(from, to);
  const Eigen::Isometry3d motion = Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(0.8, Vec3(1, 2, -1).normalized());
  std::vector<Vec3> source, target(to.vertexCount());
  for (const Vec3& p : from.shape.positions) source.push_back(motion * p);
  sim::transferPositions(transfer, from, to, motion, source, target);
  for (int i = 0; i < to.vertexCount(); ++i) EXPECT_LT((target[i] - motion * to.shape.positions[i]).norm(), 1e-6) << i;
}

}  // namespace shape_transfer_test

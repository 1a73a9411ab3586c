#include "render/body/skinning.h"

#include <Eigen/Geometry>

namespace render {
namespace {

using Eigen::Vector3f;
using Eigen::Vector4f;

constexpr float kRigid = 1e-3f;  // of a column's length and of the angles between columns

Vector3f moved(const DualQuaternion& q, const Vector3f& p) {
  const Vector3f v = q.real.head<3>();
  const float w = q.real.w();
  const Vector3f turned = p + 2 * v.cross(v.cross(p) + w * p);
  return turned + 2 * (w * q.dual.head<3>() - q.dual.w() * v + v.cross(q.dual.head<3>()));
}

Vector3f blended(std::span<const DualQuaternion> motions, const BodyInput& body, std::size_t v, const Vector3f& rest) {
  DualQuaternion sum{Vector4f::Zero(), Vector4f::Zero()};
  const Vector4f first = motions[body.joints[4 * v]].real;
  for (std::size_t k = 4 * v; k < 4 * v + 4; ++k) {
    const DualQuaternion& motion = motions[body.joints[k]];
    const float weight = body.weights[k] * (motion.real.dot(first) < 0 ? -1.0f : 1.0f);
    sum.real += weight * motion.real;
    sum.dual += weight * motion.dual;
  }
  const float norm = sum.real.norm();
  return moved({sum.real / norm, sum.dual / norm}, rest);
}

}  // namespace

std::vector<DualQuaternion> rigidMotions(std::span<const Mat4> joint_matrices) {
  std::vector<DualQuaternion> motions;
  for (const Mat4& m : joint_matrices) {
    const Eigen::Map<const Eigen::Matrix4f> matrix(m.data());
    const Eigen::Matrix3f turn = matrix.topLeftCorner<3, 3>();
    if (!((turn.transpose() * turn - Eigen::Matrix3f::Identity()).cwiseAbs().maxCoeff() < kRigid) ||
        turn.determinant() < 0)
      return {};
    const Eigen::Quaternionf q = Eigen::Quaternionf(turn).normalized();
    const Vector3f half = 0.5f * matrix.topRightCorner<3, 1>();
    DualQuaternion motion{q.coeffs(), Vector4f::Zero()};
    motion.dual.head<3>() = half * q.w() + half.cross(q.vec());
    motion.dual.w() = -half.dot(q.vec());
    motions.push_back(motion);
  }
  return motions;
}

std::vector<Vector3f> skinnedPositions(const BodyInput& body) {
  const std::vector<DualQuaternion> motions = rigidMotions(body.joint_matrices);
  std::vector<Vector3f> world(body.positions.size() / 3);
  for (std::size_t v = 0; v < world.size(); ++v) {
    const Eigen::Map<const Vector3f> vertex(&body.positions[3 * v]), normal(&body.normals[3 * v]);
    const float lower = body.scalp_id != 0 && body.root_cover.size() > 2 * v + 1 ? body.root_cover[2 * v + 1] : 0;
    const Vector3f rest = vertex - lower * normal;
    if (!motions.empty()) {
      world[v] = blended(motions, body, v, rest);
      continue;
    }
    world[v].setZero();
    for (std::size_t k = 4 * v; k < 4 * v + 4; ++k) {
      const Eigen::Map<const Eigen::Matrix4f> joint(body.joint_matrices[body.joints[k]].data());
      world[v] += body.weights[k] * (joint * rest.homogeneous()).head<3>();
    }
  }
  return world;
}

}  // namespace render

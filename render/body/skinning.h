// Skinning as shaders/common/skinning.glsl has it, on the CPU: dual quaternions where all joints move rigidly, so that
// a bent elbow keeps its girth (Kavan et al. 2007, "Skinning with Dual Quaternions"), else a blend of matrices.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "render/frame_input.h"

namespace render {

// A rigid motion: a rotation quaternion (x, y, z, w) and half of translation times rotation.
struct DualQuaternion {
  Eigen::Vector4f real{0, 0, 0, 1}, dual{0, 0, 0, 0};
};

// One for each joint; empty if a matrix scales or shears by over a thousandth or mirrors.
std::vector<DualQuaternion> rigidMotions(std::span<const Mat4> joint_matrices);

// World positions (m) of a body's vertices; what isSound refuses must not be given.
std::vector<Eigen::Vector3f> skinnedPositions(const BodyInput& body);

}  // namespace render

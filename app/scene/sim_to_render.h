// The one place where the simulator's values become the renderer's. Its numbers are single precision, so that places
// are handed over relative to an origin near the camera: a figure that has walked for miles does not shake.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "app/figure/body_sdf.h"
#include "app/figure/character.h"
#include "app/scene/edit/render_faces.h"
#include "render/frame_input.h"
#include "sim/mesh/hair_mesh.h"

namespace app {

// The origin for a camera whose anchor is there: on a grid over the ground, so that it seldom changes.
Vec3 pictureOrigin(const Vec3& anchor);

// from + fraction (to - from) - origin, three floats a vertex. Returns whether any bit changed.
bool blendPositions(std::span<const sim::Vec3> from, std::span<const sim::Vec3> to, double fraction, const Vec3& origin,
                    std::vector<float>& floats);

// Each joint within its parent's frame, rotations by slerp, so that limbs keep their length however far a step reaches;
// then all are moved as one so that the joint `head` is where a blend in the world has it, as the hair's vertices are.
void blendPoses(const Skeleton& skeleton, int head, const Pose& from, const Pose& to, double fraction, Pose& pose);

// Rest model space to world less origin, column-major. Returns whether any bit changed.
bool jointMatrices(const Skeleton& skeleton, const Pose& pose, const Vec3& origin, std::vector<render::Mat4>& matrices);

// What strands are lifted out of; the grids' distances belong to the parts.
struct ShownSkin {
  std::vector<render::SkinEllipsoid> ellipsoids;
  std::vector<render::SkinGrid> grids;
};

// A pose's collision ellipsoids relative to `origin` (m), and in place of those that do not fit, `unfit_parts`.
void showSkin(const Character& character, std::span<const PartDistance> unfit_parts, const Pose& pose,
              const Vec3& origin, ShownSkin& skin);

render::Float3 toFloat3(const Vec3& v);

}  // namespace app

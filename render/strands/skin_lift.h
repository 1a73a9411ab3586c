// Drawn strands are lifted out of the skin: shaders/common/skin.glsl on the CPU, step by step.
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "render/frame_input.h"

namespace render {

// Of a strand's last point: where it would be without skin, and m that it was lifted by. Zero before the root.
struct SkinLift {
  Eigen::Vector3f free = Eigen::Vector3f::Zero(), by = free;
};

// m that a point may be lifted towards another ellipsoid: strands of a lock on both sides of a shoulder lie 47 mm deep,
// and a tip below it begins where the strand before it was lifted to.
inline constexpr float kMostLifted = 0.08f;

// The squared distance from an ellipsoid's middle, in its own measure, beyond which it lifts nothing: its surface is
// farther away than kSkinGap and kSkinBlend.
float liftsWithin(const SkinEllipsoid& skin);

// `position` (m) of a strand's point leaves ellipsoids and grids; `tangent`, a unit vector, turns with it and is none
// any more. s: curve parameter, in layers; a root (0) leaves
// grids, and no ellipsoid. lift: of the point before, on return of this one.
void leaveSkin(std::span<const SkinEllipsoid> skin, std::span<const SkinGrid> grids, float s, SkinLift& lift,
               Eigen::Vector3f& position, Eigen::Vector3f& tangent);

// Around an ellipsoid (m), with how far it reaches out for strands.
Eigen::AlignedBox3f liftingBox(const SkinEllipsoid& skin);

// What strands may be lifted out of, and where its parts are.
struct SkinAround {
  std::vector<SkinEllipsoid> ellipsoids;
  std::vector<Eigen::AlignedBox3f> boxes;  // of the ellipsoids
  std::vector<SkinGrid> grids;

  SkinAround() = default;
  SkinAround(std::span<const SkinEllipsoid> skin, std::span<const SkinGrid> grids);
  // The part that a strand may meet whose points lie in the box (m) before they are lifted.
  SkinAround near(const Eigen::AlignedBox3f& strand) const;
};

// Those that may lift a point of the box (m), in their order; at most kMaxSkin of shaders/shared.h, the first ones.
std::vector<SkinEllipsoid> skinNear(std::span<const SkinEllipsoid> skin, const Eigen::Vector3f& low,
                                    const Eigen::Vector3f& high);
// Whether a box (m, middle and half its sides) may reach into a grid's.
bool meetsBox(const SkinGrid& grid, const Eigen::Vector3f& middle, const Eigen::Vector3f& half);

// As for ellipsoids; at most kMaxSkinGrids.
std::vector<SkinGrid> skinNear(std::span<const SkinGrid> grids, const Eigen::Vector3f& low,
                               const Eigen::Vector3f& high);

}  // namespace render

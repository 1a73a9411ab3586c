#include "app/figure/limb_check.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>

#include "app/figure/ellipsoid_fit.h"

namespace app {
namespace {

constexpr double kEvery = 0.1;  // s of a clip
constexpr double kAlong = 0.5;  // of the long radius: places along a limb
constexpr double kSunk = 0.5;   // of a limb's thickness, that is worth saying

bool isLimb(std::string_view name) {
  return name.ends_with("_forearm") || name.ends_with("_hand");
}

bool isTrunk(std::string_view name) {
  constexpr std::array<std::string_view, 6> kTrunk{"pelvis",      "waist",     "chest",
                                                   "upper_chest", "left_bust", "right_bust"};
  return std::ranges::find(kTrunk, name) != kTrunk.end();
}

// m from a limb's middle line, at a share of its long radius, to the trunk's surface: negative under it.
double gapAlong(const BodyEllipsoid& limb, const BodyEllipsoid& trunk, const Pose& pose, double share) {
  int axis = 0;
  limb.radii.maxCoeff(&axis);
  const Vec3 place = limb.center + share * limb.radii[axis] * (limb.rotation * Vec3::Unit(axis));
  const Rigid& of_limb = pose.world[static_cast<std::size_t>(limb.joint)];
  const Rigid& of_trunk = pose.world[static_cast<std::size_t>(trunk.joint)];
  return ellipsoidGap(trunk, of_trunk.inverse(Eigen::Isometry) * (of_limb * place));
}

}  // namespace

LimbInTrunk limbInTrunk(const Character& character, const Clip& clip) {
  LimbInTrunk found;
  Pose pose;
  for (int look = 0; look * kEvery <= clip.duration() + 1e-9; ++look) {
    const double time = look * kEvery;
    samplePose(character.skeleton, clip, time, pose);
    for (const BodyEllipsoid& limb : character.ellipsoids) {
      if (!isLimb(limb.name)) continue;
      for (const BodyEllipsoid& trunk : character.ellipsoids) {
        if (!isTrunk(trunk.name)) continue;
        for (const double share : {-kAlong, 0.0, kAlong}) {
          const double depth = limb.radii.minCoeff() - gapAlong(limb, trunk, pose, share);
          if (depth > found.depth) found = {depth, time, limb.name, trunk.name};
        }
      }
    }
  }
  return found;
}

std::string limbNote(const Character& character, const Clip& clip) {
  const LimbInTrunk in = limbInTrunk(character, clip);
  const auto limb = std::ranges::find(character.ellipsoids, in.limb, &BodyEllipsoid::name);
  if (limb == character.ellipsoids.end() || in.depth < kSunk * 2 * limb->radii.minCoeff()) return {};
  char note[160];
  std::snprintf(note, sizeof note,
                "the clip leads the %s %.0f mm into the %s (at %.1f s): the hair between them has no room",
                in.limb.c_str(), 1e3 * in.depth, in.part.c_str(), in.time);
  std::string text = note;
  std::ranges::replace(text, '_', ' ');
  return text;
}

}  // namespace app

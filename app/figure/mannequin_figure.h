// The figure that a mannequin is grown on: a skeleton stood upright in a neutral pose, and its measures.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "app/figure/character_roles.h"
#include "app/motion/motion.h"

namespace app {

// Everything in metres, in the canonical rest pose: y up, facing +z, left is +x, soles on y = 0, arms held away from
// the body.
struct Figure {
  struct Arm {
    bool present = false;
    Vec3 shoulder, elbow, wrist, tip;
    double side = 1;  // +1 left, -1 right
  };
  struct Leg {
    bool present = false;
    Vec3 hip, knee, ankle, toe;
    double side = 1;
  };
  // A branch with no human role: the points along it.
  struct Appendage {
    std::vector<Vec3> points;
    std::vector<int> joints;
  };

  double height = 1.7;                            // crown to sole
  double head_height = 0.23;                      // chin to crown
  double sole = 0;                                // y of the ground under the feet
  Vec3 skull_base;                                // where the skull sits on the neck (atlanto-occipital joint)
  Vec3 neck_base;                                 // root of the neck, level with C7
  Vec3 pelvis;                                    // middle of the hip joints
  double shoulder_half = 0.16, hip_half = 0.085;  // half distances between the joints
  double shoulder_level = 1.38;                   // y
  std::array<Arm, 2> arms;
  std::array<Leg, 2> legs;
  std::vector<Appendage> appendages;
};

// The skeleton with its rest pose replaced by the canonical one (clips are absolute, so they play unchanged), its roles
// and measures. Throws InputError when no joint can carry a head.
struct StoodSkeleton {
  Skeleton skeleton;
  BodyRoles roles;
  Figure figure;
  std::vector<std::string> notes;
};
StoodSkeleton standSkeleton(const BvhMotion& motion, const std::string& file);

}  // namespace app

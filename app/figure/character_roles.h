// Which joint does what: head, spine, arms, legs and the facing direction of a skeleton whose names and hierarchy are
// unknown.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "app/figure/character.h"

namespace app {

// An arm's joints, -1 where the skeleton has none. `clavicle` moves the shoulder point.
struct ArmRoles {
  int clavicle = -1, upper = -1, fore = -1, hand = -1, tip = -1;
};

struct LegRoles {
  int upper = -1, lower = -1, foot = -1, toe = -1;
};

// Joint numbers; index 0 of a pair is the character's left, 1 its right.
struct BodyRoles {
  int head = -1;              // carries the skull
  bool head_is_neck = false;  // the joint is a neck: the skull sits a neck's length above it
  std::vector<int> spine;     // from the root to the head, both included
  int chest = -1;             // the spine joint that the arms hang from
  std::array<ArmRoles, 2> arms;
  std::array<LegRoles, 2> legs;
  std::vector<int> appendages;  // first joints of branches with none of these roles: tails, third arms, wings
};

// A pose by which the skeleton is judged: joint-to-model transforms, and the end of every joint that ends a chain.
struct ReferencePose {
  std::vector<Rigid> world;  // y up
  std::vector<Vec3> ends;    // m, per joint; the joint's own origin where it has no end site
};

// Lower case, without a namespace ("mixamorig:Head" -> "head"), spaces, dots and underscores.
std::string plainName(std::string_view name);

// The joint that carries the head: by name, else what goes on above a neck by name, or that neck, else the topmost
// chain's end. -1 when nothing in the
// skeleton rises above its root.
int findHeadJoint(const Skeleton& skeleton, const ReferencePose& reference, bool& is_neck);

// Roles by names first, geometry second. `head` as found by findHeadJoint.
BodyRoles inferRoles(const Skeleton& skeleton, const ReferencePose& reference, int head, bool head_is_neck);

// The same by the rest pose; none where nothing carries a head.
BodyRoles rolesAtRest(const Skeleton& skeleton);

// Horizontal unit vector that the figure faces in the reference pose: toes, else left and right, else +z (`how` says
// which).
Vec3 inferForward(const Skeleton& skeleton, const ReferencePose& reference, const BodyRoles& roles, std::string& how);

// Puts the figure's left limbs at index 0, given where it faces.
void orderSides(const ReferencePose& reference, const Vec3& forward, BodyRoles& roles);

}  // namespace app

// A smooth shop-window mannequin grown around any skeleton.
#pragma once

#include "app/figure/mannequin_field.h"
#include "app/motion/motion.h"

namespace app {

struct Mannequin {
  Skeleton skeleton;  // the file's, stood in the canonical rest pose
  BodyRoles roles;
  BodyField field;   // its implicit function, rest pose
  SkinnedMesh mesh;  // closed, 20 to 60 thousand triangles
  Rigid head_frame;  // scalp frame to head joint frame
  std::vector<std::string> notes;
};

// Throws InputError when no joint can carry a head.
Mannequin growMannequin(const BvhMotion& motion, const std::string& file);

}  // namespace app

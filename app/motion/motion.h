// Motion files: BVH and ARCSim .mot.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "app/figure/character.h"

namespace app {

// What a BVH text says, in metres and y up.
struct BvhMotion {
  Skeleton skeleton;
  std::vector<Vec3> end_sites;     // m, per joint: offset of its end site in the joint's frame (zero where it has none)
  std::vector<bool> has_end_site;  // per joint
  Clip clip;
  std::vector<std::string> notes;
};

// Reads BVH text: any joint names (with spaces too), any channel order and number, `End Site` in any case, CRLF, tabs.
// Infers the unit (m, cm, mm, inch, the CMU database's own) from the figure's height, a grown person's or else a
// child's, else scales it to 1.70 m, and the up axis (y or z) from rest pose and motion. Joint frames have the identity
// as rest rotation. Where the offsets do not stand like a body, the most upright frame becomes the rest pose. A rest
// pose that precedes the motion as frame 0 is left out of the clip. A single frame makes a still clip. `file` names the
// text in messages. Throws InputError with the line number. Memory used is bounded by a small multiple of the text's
// length.
BvhMotion readBvh(std::string_view text, const std::string& file);

// ARCSim motion: one rigid body's position and orientation per frame (file: z up, metres, 'body[b] position'). Only the
// world is turned to y up: a body's own frame stays the one of its mesh file, so `bodies` takes that mesh's vertices as
// they are.
struct RigidMotion {
  int body_count = 0, frame_count = 0;
  double frame_time = 1.0 / 30;  // s; the format does not say, ARCSim's data is at 30 per second
  std::vector<Rigid> bodies;     // frames x bodies, y up
};
RigidMotion readMot(std::string_view text, const std::string& file);

}  // namespace app

// Motion files and playback: BVH, ARCSim .mot, and the clock that plays a clip.
#pragma once

#include <span>
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
// Infers the unit (m, cm, mm, inch, the CMU database's own) from the figure's height, else scales it to 1.70 m, and the
// up axis (y or z) from rest pose and motion. Joint frames have the identity as rest rotation. Where the offsets do not
// stand like a body, the most upright frame becomes the rest pose. A rest pose that precedes the motion as frame 0 is
// left out of the clip. A single frame makes a still clip. `file` names the text in messages. Throws InputError with
// the line number. Memory used is bounded by a small multiple of the text's length.
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

// Plays a clip: speed 0 to 20 (larger is allowed), pause, scrub, loop with a blend over the seam.
struct Playback {
  double time = 0;  // s into the clip; may be set to any value, poses clamp it to the clip
  double speed = 1;
  bool paused = false;
  bool loop = true;
  double blend = 0.4;  // s before the seam over which a loop leads into the clip's start; 0 jumps
  // The figure starts over the origin, and its net travel and turn from first to last frame are taken out evenly over
  // the clip, as on a treadmill: a steady drift that hair does not feel. False: it travels as captured (and a loop
  // brings it back within the blend).
  bool in_place = true;
};

// Moves the clock by `seconds` of wall time. A loop wraps around, however large the step; otherwise time stops at the
// end. Negative and non-finite seconds or speeds do not move it.
void advancePlayback(const Clip& clip, double seconds, Playback& playback);

// Pose of the playback. In a loop the last `blend` seconds lead into the first frame with matching pose and velocity,
// joint by joint, and the rest of the clip is untouched: a clip that already loops is played as it is. Allocates only
// when `pose` grows. With `needed` (one flag a joint, ancestors of needed joints being needed) the other joints are
// left as they were.
void poseAt(const Skeleton& skeleton, const Clip& clip, const Playback& playback, Pose& pose,
            std::span<const unsigned char> needed = {});

}  // namespace app

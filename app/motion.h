// Motion files and playback: BVH, ARCSim .mot, and the clock that plays a clip.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/character.h"

namespace app {

// What a BVH text says, in metres and y up.
struct BvhMotion {
  Skeleton skeleton;
  std::vector<Vec3> end_sites;      // m, per joint: offset of its end site in the joint's frame (zero where it has none)
  std::vector<bool> has_end_site;   // per joint
  Clip clip;
  std::vector<std::string> notes;
};

// Reads BVH text: any joint names (with spaces too), any channel order, `End Site` in any case, CRLF, tabs. Infers the unit
// (m, cm, inch) from the skeleton's height and the up axis from the rest pose and first frame. `file` names it in messages.
// Throws InputError with the line number. Memory used is bounded by a small multiple of the text's length.
BvhMotion readBvh(std::string_view text, const std::string& file);

// ARCSim motion: one rigid body's position and orientation per frame (format: z up, metres, 'body[b] position').
struct RigidMotion {
  int body_count = 0, frame_count = 0;
  double frame_time = 1.0 / 30;
  std::vector<Rigid> bodies;  // frames x bodies, y up
};
RigidMotion readMot(std::string_view text, const std::string& file);

// Reads a whole file, throwing InputError when it is missing, empty, a directory or over `limit_bytes`.
std::string readText(const std::string& file, std::size_t limit_bytes = std::size_t{256} << 20);

// Plays a clip: speed 0 to 20 (larger is allowed), pause, scrub, loop with a blend over the seam.
struct Playback {
  double time = 0;          // s into the clip
  double speed = 1;
  bool paused = false;
  bool loop = true;
  double blend = 0.4;       // s of clip time blended at the seam, so that the loop has no jump; 0 jumps
  double root_drift = 0;    // see playback.cpp; loops keep the character in place
};
void advancePlayback(const Clip& clip, double seconds, Playback& playback);
// Pose of the playback, the seam's blend included. A clip's forward travel is kept within the loop: position blends as well.
void poseAt(const Skeleton& skeleton, const Clip& clip, const Playback& playback, Pose& pose);

}  // namespace app

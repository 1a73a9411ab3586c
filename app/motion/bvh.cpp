// From the text of a BVH file to a skeleton and a clip in metres and y up.
//
// A joint's local transform in frame f is T(offset or position channels) R_first R_second R_third, angles in degrees
// about the parent's axes. All that is inferred (unit, up axis, a missing rest pose) is said in the notes.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <span>

#include "app/files/errors.h"
#include "app/files/median.h"
#include "app/motion/bvh_text.h"
#include "app/motion/motion.h"

namespace app {

namespace {

using Quaternion = Eigen::Quaterniond;

// Local transforms of all frames in the file's unit and axes: frames x joints.
struct LocalFrames {
  std::vector<Quaternion> rotations;
  std::vector<Vec3> translations;
};

// World rotations and positions of the joints of one frame.
struct WorldFrame {
  std::vector<Quaternion> rotations;
  std::vector<Vec3> positions;
};

// What is inferred about the figure before it is converted.
struct Inference {
  bool rest_z_up = false, motion_z_up = false;
  bool rest_is_folded = false;  // the rest offsets do not stand like a body: a frame of the motion takes their place
  int rest_frames = 0;          // frames before the motion that are a rest pose, or lead from it into the motion
  int upright_frame = 0;        // the sampled frame of greatest height
  double height = 0;            // file's unit
  double scale = 1;             // m per file's unit
  std::string unit, doubt;
  bool legs = true;
};

Quaternion axisRotation(int axis, double degrees) {
  const double half = degrees * std::numbers::pi / 360;
  Vec3 xyz = Vec3::Zero();
  xyz[axis] = std::sin(half);
  return {std::cos(half), xyz.x(), xyz.y(), xyz.z()};
}

// Position channels stand in for OFFSET axis by axis, which is what exporters mean by them; but a joint below the root
// whose position channels are zero throughout would fold onto its parent, so there they are taken as added to OFFSET.
std::vector<bool> positionsAdd(const BvhText& bvh) {
  std::vector<bool> adds(bvh.joints.size(), false);
  for (std::size_t j = 1; j < bvh.joints.size(); ++j) {
    const BvhTextJoint& joint = bvh.joints[j];
    if (joint.offset.isZero(0)) continue;
    bool all_zero = true;
    for (int f = 0; f < bvh.frame_count && all_zero; ++f) {
      const std::size_t row = static_cast<std::size_t>(f) * static_cast<std::size_t>(bvh.channel_count);
      for (std::size_t c = 0; c < joint.channels.size(); ++c) {
        const double value = bvh.values[row + static_cast<std::size_t>(joint.first_channel) + c];
        if (isPosition(joint.channels[c]) && value != 0) all_zero = false;
      }
    }
    adds[j] = all_zero;
  }
  return adds;
}

LocalFrames localFrames(const BvhText& bvh) {
  const std::vector<bool> adds = positionsAdd(bvh);
  LocalFrames frames;
  frames.rotations.reserve(static_cast<std::size_t>(bvh.frame_count) * bvh.joints.size());
  frames.translations.reserve(static_cast<std::size_t>(bvh.frame_count) * bvh.joints.size());
  for (int f = 0; f < bvh.frame_count; ++f) {
    const std::size_t row = static_cast<std::size_t>(f) * static_cast<std::size_t>(bvh.channel_count);
    for (std::size_t j = 0; j < bvh.joints.size(); ++j) {
      const BvhTextJoint& joint = bvh.joints[j];
      Quaternion rotation = Quaternion::Identity();
      Vec3 translation = joint.offset;
      for (std::size_t c = 0; c < joint.channels.size(); ++c) {
        const double value = bvh.values[row + static_cast<std::size_t>(joint.first_channel) + c];
        const int axis = axisOf(joint.channels[c]);
        if (!isPosition(joint.channels[c])) {
          rotation = rotation * axisRotation(axis, value);
        } else if (!adds[j]) {
          translation[axis] = value;
        }
      }
      frames.rotations.push_back(rotation.normalized());
      frames.translations.push_back(translation);
    }
  }
  return frames;
}

WorldFrame worldFrame(const BvhText& bvh, const LocalFrames& frames, int frame) {
  const std::size_t joints = bvh.joints.size(), first = static_cast<std::size_t>(frame) * joints;
  WorldFrame world{std::vector<Quaternion>(joints), std::vector<Vec3>(joints)};
  for (std::size_t j = 0; j < joints; ++j) {
    world.rotations[j] = frames.rotations[first + j];
    world.positions[j] = frames.translations[first + j];
    if (bvh.joints[j].parent < 0) continue;
    const auto p = static_cast<std::size_t>(bvh.joints[j].parent);
    world.positions[j] = world.positions[p] + world.rotations[p] * world.positions[j];
    world.rotations[j] = (world.rotations[p] * world.rotations[j]).normalized();
  }
  return world;
}

WorldFrame restFrame(const BvhText& bvh) {
  WorldFrame world{std::vector<Quaternion>(bvh.joints.size(), Quaternion::Identity()), {}};
  for (const BvhTextJoint& joint : bvh.joints) {
    const Vec3 parent = joint.parent < 0 ? Vec3::Zero() : world.positions[static_cast<std::size_t>(joint.parent)];
    world.positions.push_back(parent + joint.offset);
  }
  return world;
}

Eigen::AlignedBox3d bounds(const BvhText& bvh, const WorldFrame& world) {
  Eigen::AlignedBox3d box;
  for (std::size_t j = 0; j < bvh.joints.size(); ++j) {
    box.extend(world.positions[j]);
    if (bvh.joints[j].has_end_site) box.extend(world.positions[j] + world.rotations[j] * bvh.joints[j].end_site);
  }
  return box;
}

// Whether anything but the spine comes near the lowest point: legs, or arms that hang down to there.
bool hasLegs(const BvhText& bvh, const WorldFrame& world, bool z_up) {
  constexpr double kNearGround = 0.15;  // of the height
  std::vector<double> tops, bottoms;
  for (std::size_t j = 0; j < bvh.joints.size(); ++j) {
    const Vec3 at = world.positions[j], end = at + world.rotations[j] * bvh.joints[j].end_site;
    const auto up = [&](const Vec3& p) { return z_up ? p.z() : p.y(); };
    tops.push_back(std::max(up(at), up(end)));
    bottoms.push_back(std::min(up(at), up(end)));
  }
  const auto highest = std::ranges::max_element(tops);
  const double low = *std::ranges::min_element(bottoms);
  const double ground = low + kNearGround * (*highest - low);
  std::vector<bool> spine(tops.size(), false);
  for (int j = static_cast<int>(highest - tops.begin()); j >= 0; j = bvh.joints[static_cast<std::size_t>(j)].parent)
    spine[static_cast<std::size_t>(j)] = true;
  for (std::size_t j = 0; j < tops.size(); ++j) {
    if (!spine[j] && bottoms[j] < ground) return true;
  }
  return false;
}

// Figures whose height is plausible in one of these units are taken to be in it. The ranges of height are disjoint:
// each unit is over 2.2 times the one before it. 0.056444 m is the unit of the CMU database's own ASF files, an inch
// over 0.45. Without legs the height is first taken for that from the hips up, 0.47 of a body's. What is no grown
// person's in any unit is taken for a child's in the usual ones.
void inferUnit(Inference& inferred) {
  struct Unit {
    double metres;
    const char* name;
  };
  constexpr Unit kUnits[] = {
      {1, "m"}, {0.001, "mm"}, {0.01, "cm"}, {0.0254, "inch"}, {0.0254 / 0.45, "CMU unit (inch / 0.45)"}};
  constexpr double kSmallest = 1.1, kTallest = 2.4;  // m, between the outermost joints
  constexpr double kSmallestChild = 0.75;
  constexpr double kHipsUp = 0.47;  // of the mannequin's height
  for (const double share : {kHipsUp, 1.0}) {
    if (share < 1 && inferred.legs) continue;
    for (const Unit& unit : kUnits) {
      const double height = inferred.height * unit.metres / share;
      if (height < kSmallest || height > kTallest) continue;
      inferred.scale = unit.metres;
      inferred.unit = unit.name;
      if (share < 1) inferred.doubt = "; not certain: without legs it is taken for a body from the hips up";
      return;
    }
  }
  for (const Unit& unit : std::span(kUnits).first(4)) {
    const double height = inferred.height * unit.metres;
    if (!inferred.legs || height < kSmallestChild || height >= kSmallest) continue;
    inferred.scale = unit.metres;
    inferred.unit = unit.name;
    inferred.doubt = "; a child's size, on a body of a grown person's proportions";
    return;
  }
  inferred.scale = 1.70 / inferred.height;
  inferred.unit = "unknown, scaled to 1.70 m";
}

Inference infer(const BvhText& bvh, const LocalFrames& frames) {
  constexpr int kSamples = 65;
  constexpr double kClearly = 1.3;  // by how much the extent along one axis must exceed the other's to be called up
  Inference inferred;
  std::vector<double> y_extents, z_extents, z_floors;
  std::vector<int> sampled;
  const int samples = std::min(kSamples, bvh.frame_count);
  for (int s = 0; s < samples; ++s) {
    const int frame =
        samples > 1 ? static_cast<int>(static_cast<long long>(s) * (bvh.frame_count - 1) / (samples - 1)) : 0;
    const Eigen::AlignedBox3d box = bounds(bvh, worldFrame(bvh, frames, frame));
    y_extents.push_back(box.sizes().y());
    z_extents.push_back(box.sizes().z());
    z_floors.push_back(box.min().z());
    sampled.push_back(frame);
  }
  const Vec3 rest = bounds(bvh, restFrame(bvh)).sizes();
  const double y_motion = median(y_extents), z_motion = median(z_extents);
  inferred.rest_z_up = rest.z() > kClearly * rest.y();
  const bool rest_y_up = rest.y() > kClearly * rest.z();
  inferred.motion_z_up = z_motion > kClearly * y_motion;
  // A figure that lies down in most frames is long in z too; only one that also stands on the plane z = 0 is z up.
  if (inferred.motion_z_up && rest_y_up && std::abs(median(z_floors)) > 0.2 * z_motion) inferred.motion_z_up = false;
  // The other way round: z up at rest, y clearly longer in motion only where the rotations turn the figure to y up.
  if (inferred.rest_z_up && !inferred.motion_z_up && y_motion < kClearly * z_motion) inferred.motion_z_up = true;

  const double rest_height = inferred.rest_z_up ? rest.z() : rest.y();
  const std::vector<double>& heights = inferred.motion_z_up ? z_extents : y_extents;
  inferred.upright_frame =
      sampled[static_cast<std::size_t>(std::max_element(heights.begin(), heights.end()) - heights.begin())];
  const double motion_height = inferred.motion_z_up ? z_motion : y_motion;
  inferred.rest_is_folded = rest_height < 0.6 * motion_height;
  inferred.height = std::max(rest_height, motion_height);
  inferred.legs = inferred.rest_is_folded
                      ? hasLegs(bvh, worldFrame(bvh, frames, inferred.upright_frame), inferred.motion_z_up)
                      : hasLegs(bvh, restFrame(bvh), inferred.rest_z_up);
  return inferred;
}

// (x, y, z) of a z-up world to (x, z, -y).
Quaternion zUpToYUp(bool z_up) {
  return z_up ? axisRotation(0, -90) : Quaternion::Identity();
}

// Per joint, the turn from the file's joint frame to ours, whose rest rotation is the identity in the y-up world.
std::vector<Quaternion> frameTurns(const BvhText& bvh, const LocalFrames& frames, const Inference& inferred) {
  if (!inferred.rest_is_folded) return std::vector<Quaternion>(bvh.joints.size(), zUpToYUp(inferred.rest_z_up));
  std::vector<Quaternion> turns = worldFrame(bvh, frames, inferred.upright_frame).rotations;
  for (Quaternion& turn : turns) turn = zUpToYUp(inferred.motion_z_up) * turn;
  return turns;
}

void buildSkeleton(const BvhText& bvh, const LocalFrames& frames, const Inference& inferred,
                   const std::vector<Quaternion>& turns, BvhMotion& motion) {
  const std::size_t upright = static_cast<std::size_t>(inferred.upright_frame) * bvh.joints.size();
  for (std::size_t j = 0; j < bvh.joints.size(); ++j) {
    const BvhTextJoint& source = bvh.joints[j];
    Joint joint;
    joint.name = source.name;
    joint.parent = source.parent;
    Vec3 offset = inferred.rest_is_folded ? frames.translations[upright + j] : source.offset;
    const Quaternion world = zUpToYUp(inferred.rest_is_folded ? inferred.motion_z_up : inferred.rest_z_up);
    offset = (source.parent < 0 ? world : turns[static_cast<std::size_t>(source.parent)]) * offset * inferred.scale;
    joint.rest_local.translation() = offset;
    joint.rest_world = joint.rest_local;
    if (joint.parent >= 0) {
      joint.rest_world = motion.skeleton.joints[static_cast<std::size_t>(joint.parent)].rest_world * joint.rest_local;
    }
    motion.skeleton.joints.push_back(std::move(joint));
    motion.end_sites.push_back(turns[j] * source.end_site * inferred.scale);
    motion.has_end_site.push_back(source.has_end_site);
  }
}

void buildClip(const BvhText& bvh, LocalFrames&& frames, const Inference& inferred,
               const std::vector<Quaternion>& turns, Clip& clip) {
  const std::size_t joints = bvh.joints.size();
  const Quaternion world = zUpToYUp(inferred.motion_z_up);
  for (std::size_t i = 0; i < frames.rotations.size(); ++i) {
    const std::size_t j = i % joints;
    const Quaternion parent = bvh.joints[j].parent < 0 ? world : turns[static_cast<std::size_t>(bvh.joints[j].parent)];
    Quaternion& rotation = frames.rotations[i];
    rotation = (parent * rotation * turns[j].conjugate()).normalized();
    if (i >= joints && rotation.dot(frames.rotations[i - joints]) < 0) rotation.coeffs() = -rotation.coeffs();
    frames.translations[i] = parent * frames.translations[i] * inferred.scale;
  }
  const auto left_out = static_cast<std::ptrdiff_t>(joints) * inferred.rest_frames;
  frames.rotations.erase(frames.rotations.begin(), frames.rotations.begin() + left_out);
  frames.translations.erase(frames.translations.begin(), frames.translations.begin() + left_out);
  clip.frame_time = bvh.frame_time;
  clip.joint_count = static_cast<int>(joints);
  clip.rotations = std::move(frames.rotations);
  clip.translations = std::move(frames.translations);
}

// Many files (the CMU database's BVH releases among them) put the rest pose before the motion as frame 0; where the
// frame rate was changed afterwards, it swings into the motion over several frames. Played, it would throw every limb
// across the body. It is taken for one when some joint moves farther from frame 0 to 1 than any joint does between
// later frames, by a clear factor and by a clear distance. Later frames are those from 1 on, or else those from a tenth
// of a second on. Returns how many frames come before them.
int leadingRestFrames(const BvhText& bvh, const LocalFrames& frames, double height) {
  constexpr int kMaxCompared = 600;
  constexpr double kFactor = 4, kMinJump = 0.08, kSwing = 0.1;  // the jump in figure heights, s
  if (bvh.frame_count < 4) return 0;
  std::vector<double> jumps;
  WorldFrame before = worldFrame(bvh, frames, 0);
  for (int f = 1; f < std::min(bvh.frame_count, kMaxCompared); ++f) {
    WorldFrame world = worldFrame(bvh, frames, f);
    double& jump = jumps.emplace_back(0);
    for (std::size_t j = 0; j < bvh.joints.size(); ++j)
      jump = std::max(jump, (world.positions[j] - before.positions[j]).norm());
    before = std::move(world);
  }
  const int swing = std::min(bvh.frame_count / 4, static_cast<int>(kSwing / bvh.frame_time));
  for (const int leading : {1, std::max(swing, 1)}) {
    const double largest_later = *std::max_element(jumps.begin() + leading, jumps.end());
    if (jumps.front() > kFactor * largest_later && jumps.front() > kMinJump * height) return leading;
  }
  return 0;
}

std::vector<std::string> describe(const BvhText& bvh, const Inference& inferred) {
  char line[200];
  std::vector<std::string> notes;
  const auto note = [&](const char* format, auto... values) {
    std::snprintf(line, sizeof line, format, values...);
    notes.emplace_back(line);
  };
  note("unit: %s (figure %.4g units from lowest to highest joint = %.2f m%s)", inferred.unit.c_str(), inferred.height,
       inferred.height * inferred.scale, inferred.doubt.c_str());
  note("up axis: %s", inferred.motion_z_up ? "z, turned to y" : "y");
  if (inferred.rest_z_up != inferred.motion_z_up && !inferred.rest_is_folded) {
    note("rest pose: %s up, unlike the motion", inferred.rest_z_up ? "z" : "y");
  }
  if (inferred.rest_is_folded) note("rest pose: the file has none that stands; frame %d taken", inferred.upright_frame);
  note("frame rate: %.4g per second, %d frames, %.2f s", 1 / bvh.frame_time, bvh.frame_count,
       bvh.frame_time * (bvh.frame_count - 1));
  if (inferred.rest_frames == 1)
    notes.emplace_back("frame 0 is a rest pose apart from the motion: left out of the clip");
  if (inferred.rest_frames > 1)
    note("frames 0 to %d lead from a rest pose into the motion: left out of the clip", inferred.rest_frames - 1);
  if (bvh.has_surplus_row) notes.emplace_back("one row more than 'Frames:' says: left out");
  if (bvh.frame_count == 1) notes.emplace_back("the clip has one frame: a still pose");
  return notes;
}

}  // namespace

BvhMotion readBvh(std::string_view text, const std::string& file) {
  const BvhText bvh = readBvhText(text, file);
  LocalFrames frames = localFrames(bvh);
  Inference inferred = infer(bvh, frames);
  if (!(inferred.height > 1e-6)) {
    throw InputError(file, "line " + std::to_string(bvh.hierarchy_line), "the skeleton has no height",
                     "give the joints OFFSETs that stand like a body");
  }
  inferUnit(inferred);
  inferred.rest_frames = leadingRestFrames(bvh, frames, inferred.height);
  const std::vector<Quaternion> turns = frameTurns(bvh, frames, inferred);

  BvhMotion motion;
  buildSkeleton(bvh, frames, inferred, turns, motion);
  buildClip(bvh, std::move(frames), inferred, turns, motion.clip);
  motion.clip.name = std::filesystem::path(file).stem().string();
  motion.notes = describe(bvh, inferred);
  return motion;
}

}  // namespace app

// Clips and playbacks for tests of motion.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "app/files/text_file.h"
#include "app/motion/motion.h"
#include "app/motion/playback.h"

namespace test {

using app::BvhMotion;
using app::LoopKind;
using app::Playback;
using app::Pose;
using app::Vec3;
namespace fs = std::filesystem;

inline const fs::path kSource = HAIRMESH_SOURCE_DIR;

inline BvhMotion load(const fs::path& file) {
  return app::readBvh(app::readText(file.string()), file.string());
}
inline BvhMotion ownClip(const std::string& name) {
  return load(kSource / "assets" / "clips" / (name + ".bvh"));
}

// The project's own, and the captures where they are at hand.
inline std::vector<BvhMotion> allClips() {
  std::vector<BvhMotion> clips;
  const fs::path own = kSource / "assets" / "clips";
  for (const fs::path& folder : {own, kSource / ".." / "shared" / "mocap"}) {
    if (folder != own && !fs::exists(folder)) continue;
    const std::size_t before = clips.size();
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.path().extension() == ".bvh") clips.push_back(load(entry.path()));
    }
    EXPECT_GT(clips.size(), before) << "no clips in " << folder;
  }
  return clips;
}

inline Playback playing(const BvhMotion& motion, LoopKind kind) {
  Playback playback;
  playback.loop = app::clipLoop(motion.skeleton, motion.clip, kind);
  return playback;
}

inline Pose at(const BvhMotion& motion, Playback playback, double time) {
  Pose pose;
  playback.time = time;
  app::poseAt(motion.skeleton, motion.clip, playback, pose);
  return pose;
}

// Largest distance of a joint between two poses, m.
inline double distance(const Pose& a, const Pose& b) {
  double largest = 0;
  for (std::size_t j = 0; j < a.world.size(); ++j) {
    largest = std::max(largest, (a.world[j].translation() - b.world[j].translation()).norm());
  }
  return largest;
}

// Two joints; the root turns about y by 10 degrees a frame and moves along x by 0.1 m a frame.
inline BvhMotion turning(int frames) {
  std::string text =
      "HIERARCHY\nROOT a {\nOFFSET 0 0.9 0\nCHANNELS 6 Xposition Yposition Zposition Yrotation Xrotation Zrotation\n"
      "JOINT b {\nOFFSET 0 1.5 0.1\nCHANNELS 3 Xrotation Yrotation Zrotation\n}\n}\nMOTION\nFrames: " +
      std::to_string(frames) + "\nFrame Time: 0.1\n";
  for (int f = 0; f < frames; ++f) {
    text.append(std::to_string(0.1 * f)).append(" 0.9 0 ").append(std::to_string(10 * f));
    text.append(f % 2 ? " 0 0 30 0 0\n" : " 0 0 0 0 0\n");
  }
  return app::readBvh(text, "turning");
}

}  // namespace test

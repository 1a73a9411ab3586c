// How far the drawn strands reach into the drawn skin, and how far the skin sticks out of the ellipsoids that hair
// collides with, over whole clips of every figure at hand.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace bench {

struct SkinOptions {
  std::vector<std::string> styles;                        // "long low"; empty: three styles at low resolution
  std::vector<std::string> clips;                         // file names; empty: all
  std::vector<std::pair<std::string, std::string>> sets;  // parameters as for --set
  int strands = 1200;
  double speed = 1;    // of playback
  std::string folder;  // whose skin.md gets the table by figure, and data/skin.csv every clip; empty: none
};

// The file names of the figures that are there; none where Embree was missing when this was built.
std::vector<std::string> skinClips();

// The project's own clips, and where they are there those of ../shared: mocap, the rigid parts of arcsim, characters;
// and an FBX figure of Debian's assimp-testmodels. One round's time of each in steps of 1/60 s, looked at ten times a
// second. Returns whether all keep the bounds: at most a thousandth of the points 1 mm inside, none 4 mm. Throws
// app::InputError.
bool runSkin(const SkinOptions& options);

}  // namespace bench

// How collisions hold: what is left inside the body, how often contacts come and go, how quietly hair rests.
#pragma once

#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "app/scene/actor.h"

namespace bench {

struct CollisionOptions {
  int frames = 240;  // measured per style and clip
  std::vector<std::string> clips{"walk.bvh", "dance.bvh", "jump_spin.bvh"};
  std::vector<std::string> styles;                       // names to measure, such as "long low"; empty: all nine
  std::vector<std::pair<std::string, std::string>> set;  // parameters, as --set takes them
};

// A style's hair on the figure that plays one of the program's clips; not settled. Throws app::InputError.
app::Actor makeDancer(const std::string& clip, app::Style style, app::Resolution resolution,
                      app::AssetCache& asset_cache);

// Writes one row a style and clip. Throws app::InputError.
void writeClips(const CollisionOptions& options, std::FILE* out);

// Writes the rest speed of each style on the standing figure. Throws app::InputError.
void writeRests(const CollisionOptions& options, std::FILE* out);

}  // namespace bench

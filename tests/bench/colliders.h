// Ellipsoids and signed distances side by side: what each costs, and how far from the true skin it holds the hair.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

namespace bench {

struct ColliderOptions {
  int frames = 240;
  std::vector<std::string> clips{"walk.bvh", "dance.bvh"};
  std::vector<std::string> styles;  // such as "long low"; empty: the three of medium resolution
};

// Writes one row a style, clip and collider. Throws app::InputError.
void runColliders(const ColliderOptions& options, std::FILE* out);

}  // namespace bench

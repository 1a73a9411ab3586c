// What the skips' measurements say: tables, plots, the bounds they are held to, the document.
#pragma once

#include <string>
#include <vector>

#include "tests/bench/skipping_scene.h"

namespace bench {

using SkipScenes = std::vector<std::vector<SkipRow>>;  // rows of each scene; none first, all last

inline constexpr double kCrowdRatio = 6;   // the crowd's simulation over a close-up's
inline constexpr double kShapePixels = 3;  // that shapes may be off by

struct SkipBound {
  std::string what;
  double value, most;
  bool holds() const { return value <= most; }
};
std::vector<SkipBound> skipBounds(const SkipScenes& scenes);
std::string boundText(const SkipBound& bound);

// Of one scene.
std::string skipTableOf(const std::vector<SkipRow>& rows);
void plotSkips(const std::vector<SkipRow>& rows, const std::string& folder);

// skipping.md in `folder`: its measured parts are written anew, the prose around them is a person's. The start writes
// the table of skips, data/skips.md, which needs no measuring. Throw InputError where a part's marks are missing.
void startSkipDocument(const std::string& folder);
void writeSkipDocument(const SkipScenes& scenes, const std::vector<SkipBound>& held, const std::string& folder);

}  // namespace bench

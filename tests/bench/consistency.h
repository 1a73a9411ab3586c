// Whether a parameter means the same at every resolution and time step: the paths of the same points of a haircut.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tests/bench/trajectory.h"

namespace bench {

// Where points of the hair have gone (m, in the head's frame) since the scene's start: [sample][point].
using TipPaths = std::vector<std::vector<sim::Vec3>>;

// Runs the scene and follows the points that lie at `points` in the rest shape's frame.
TipPaths followTips(TrajectoryStage& stage, std::span<const sim::Vec3> points, const sim::SimParams& params);

// Root mean square over points and samples of a path's length from the start, or of what lies between two paths, over
// hair length.
double pathSize(const TipPaths& a, double hair_length);
double pathDifference(const TipPaths& a, const TipPaths& b, double hair_length);

// A style in motion, in its three resolutions.
struct ResolutionSpread {
  double motion = 0;              // of the high resolution
  double low = 0, medium = 0;     // differences to the high one
  std::array<double, 4> steps{};  // of the low resolution at 1/30, 1/60, 1/120, 1/240 s, to the limit of small steps
};

// `motion`: a clip of assets/clips.
ResolutionSpread measureSpread(app::Style style, const char* motion, bool collide, double seconds);

struct ConsistencyOptions {
  std::string folder;  // its consistency.md gets the tables
};

// Prints the tables for a head shake without contact and a walk with contacts, three styles, and writes them into
// consistency.md. Throws InputError.
void runConsistency(const ConsistencyOptions& options);

}  // namespace bench

#include "tests/bench/consistency.h"

#include <cmath>
#include <cstdio>

#include "sim/mesh/rigid_motion.h"
#include "tests/bench/material_points.h"
#include "tests/bench/measured_part.h"

namespace bench {
namespace {

using app::Resolution;
using app::Style;

constexpr double kFinest = 960;  // steps a second, of the limit of small steps
constexpr std::array<double, 4> kRates{30, 60, 120, 240};

std::vector<sim::Vec3> rootsIn(const sim::HairMesh& mesh, std::span<const sim::Vec3> positions) {
  std::vector<sim::Vec3> roots;
  for (int c = 0; c < mesh.columnCount(); ++c) roots.push_back(positions[mesh.shape.column_first[c]]);
  return roots;
}

TrajectoryScene sceneOf(Style style, Resolution resolution, const char* motion, bool collide, double seconds) {
  return {"consistency", motion, style, resolution, 1, collide, false, seconds};
}

// Solved so well that only the mesh and the step differ.
sim::SimParams wellSolved(double rate) {
  sim::SimParams params;
  params.time_step = 1 / rate;
  params.tolerance = 1e-4;
  params.max_iterations = 2000;
  params.acceleration_tolerance = params.displacement_tolerance = 0;
  return params;
}

}  // namespace

TipPaths followTips(TrajectoryStage& stage, std::span<const sim::Vec3> points, const sim::SimParams& params) {
  const sim::HairMesh& mesh = stage.mesh();
  const std::vector<sim::Vec3> rest_roots = rootsIn(mesh, mesh.shape.positions);
  std::vector<MaterialPoint> followed;
  for (const sim::Vec3& p : points) followed.push_back(materialPoint(mesh, p));
  const auto inHead = [&](std::span<const sim::Vec3> positions) {
    const Eigen::Isometry3d to_head = sim::rigidMotion(rootsIn(mesh, positions), rest_roots);
    std::vector<sim::Vec3> places;
    for (const MaterialPoint& point : followed) places.push_back(to_head * point.at(positions));
    return places;
  };
  const std::vector<sim::Vec3> start = inHead(stage.start().positions);
  TipPaths paths;
  for (const std::vector<sim::Vec3>& positions : stage.run(params).trajectory) {
    paths.push_back(inHead(positions));
    for (std::size_t k = 0; k < start.size(); ++k) paths.back()[k] -= start[k];
  }
  return paths;
}

double pathSize(const TipPaths& a, double hair_length) {
  const TipPaths none(a.size(), std::vector<sim::Vec3>(a.front().size(), sim::Vec3::Zero()));
  return pathDifference(a, none, hair_length);
}

double pathDifference(const TipPaths& a, const TipPaths& b, double hair_length) {
  return difference(a, b, hair_length, static_cast<int>(a.size())).rms;
}

ResolutionSpread measureSpread(Style style, const char* motion, bool collide, double seconds) {
  TrajectoryStage low(sceneOf(style, Resolution::kLow, motion, collide, seconds));
  TrajectoryStage medium(sceneOf(style, Resolution::kMedium, motion, collide, seconds));
  TrajectoryStage high(sceneOf(style, Resolution::kHigh, motion, collide, seconds));
  const std::vector<sim::Vec3> tips = tipsOf(low.mesh());
  const double length = low.mesh().hair_length;
  const sim::SimParams standard = wellSolved(60);
  const TipPaths finest = followTips(high, tips, standard);
  ResolutionSpread spread;
  spread.motion = pathSize(finest, length);
  spread.low = pathDifference(followTips(low, tips, standard), finest, length);
  spread.medium = pathDifference(followTips(medium, tips, standard), finest, length);
  const TipPaths limit = followTips(low, tips, wellSolved(kFinest));
  for (std::size_t k = 0; k < kRates.size(); ++k) {
    spread.steps[k] = pathDifference(followTips(low, tips, wellSolved(kRates[k])), limit, length);
  }
  return spread;
}

void runConsistency(const ConsistencyOptions& options) {
  std::string resolutions =
      "| style | motion | how far the tips go | low to high | medium to high |\n|---|---|---|---|---|\n";
  std::string steps = "| style | motion | 1/30 s | 1/60 s | 1/120 s | 1/240 s |\n|---|---|---|---|---|---|\n";
  for (const Style style : {Style::kShort, Style::kShoulder, Style::kLong}) {
    for (const bool walk : {false, true}) {
      const ResolutionSpread s = measureSpread(style, walk ? "walk.bvh" : "head_shake.bvh", walk, 1);
      const std::string name(app::styleName(style));
      const char* motion = walk ? "walk, contacts" : "head shake";
      resolutions += formatted("| %s | %s | %.4f | %.4f | %.4f |\n", name.c_str(), motion, s.motion, s.low, s.medium);
      steps += formatted("| %s | %s | %.4f | %.4f | %.4f | %.4f |\n", name.c_str(), motion, s.steps[0], s.steps[1],
                         s.steps[2], s.steps[3]);
      std::printf("%-9s %-15s motion %.4f  low %.4f  medium %.4f  steps %.4f %.4f %.4f %.4f\n", name.c_str(), motion,
                  s.motion, s.low, s.medium, s.steps[0], s.steps[1], s.steps[2], s.steps[3]);
      std::fflush(stdout);
    }
  }
  const std::string file = options.folder + "/consistency.md";
  writeMeasuredPart(file, "resolutions", resolutions + "\n");
  writeMeasuredPart(file, "steps", steps + "\n");
}

}  // namespace bench

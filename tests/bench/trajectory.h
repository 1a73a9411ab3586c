// Scenes whose trajectories are compared: the same motion, simulated in different ways from the same start.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/scene/actor.h"
#include "sim/forces/model.h"

namespace bench {

// A declared scene. Times are simulated seconds; `speed` plays the clip faster while the hair lives in real time.
struct TrajectoryScene {
  const char* name;
  const char* motion;
  app::Style style;
  app::Resolution resolution;
  double speed;
  bool collide;
  bool collapsed;  // starts with every vertex on its root
  double seconds;
};
std::vector<TrajectoryScene> trajectoryScenes();

// Positions of all vertices (m) at the sample times 1/60, 2/60, ... s: the pictures that a 60 Hz display shows. With a
// longer step those in between are interpolated, as the demo does.
inline constexpr int kSamplesPerSecond = 60;
using Trajectory = std::vector<std::vector<sim::Vec3>>;

struct RunResult {
  Trajectory trajectory;
  std::vector<double> energy;    // J at the samples: elastic, kinetic and in the field of gravity
  double seconds = 0;            // CPU seconds of the simulation alone (motion left out)
  double iterations = 0;         // linear iterations a step, mean
  double worst_stretch = 0;      // largest |l / l0 - 1| along the columns at the samples
  double volume_error = 0;       // mean |V / V0 - 1| of the corner tetrahedra at the samples
  double worst_penetration = 0;  // m, of external vertices at the samples
  int recoveries = 0;
  int measured = 0;  // states that the last figures are over
};

// One scene, loaded and settled, that can be run over and over from the same state.
class TrajectoryStage {
 public:
  explicit TrajectoryStage(const TrajectoryScene& scene);
  // Simulates the scene, or its first `samples`. `collide` follows the scene.
  RunResult run(sim::SimParams params, int samples);
  RunResult run(const sim::SimParams& params) { return run(params, sampleCount()); }
  const sim::HairMesh& mesh() const { return actor_.haircut->mesh; }
  const TrajectoryScene& scene() const { return scene_; }
  const sim::HairState& start() const { return start_; }
  int sampleCount() const;

  // Calls `visit(step, input, state)` before each step of the scene, run with `params`.
  using Visit = std::function<void(int step, const sim::StepInput& input, const sim::HairState& state)>;
  void visitSteps(sim::SimParams params, const Visit& visit);

 private:
  TrajectoryScene scene_;
  app::AssetCache asset_cache_;
  app::Actor actor_;
  sim::HairState start_;
  app::Playback playback_;
  sim::ForceModel<double> model_;  // for the energy
  void restart();
  double energy() const;
  void measure(RunResult& result) const;
};

// Difference of two trajectories over hair length: root mean square and largest, over vertices and the first `samples`.
struct TrajectoryError {
  double rms = 0, most = 0;
};
TrajectoryError difference(const Trajectory& a, const Trajectory& b, double hair_length, int samples);

}  // namespace bench

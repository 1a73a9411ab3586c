// One character whose motion is simulated again and again from the same start, by the simulator or by the plain oracle,
// with the processor's time of every frame and stage.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "app/scene/actor.h"
#include "tests/bench/trajectory.h"

namespace oracle {
struct PlainContext;
}

namespace bench {

struct TimedFrame {
  std::array<double, sim::kStageCount> stages{};  // s
  double character = 0, simulation = 0;           // s: posing the body; the step
  int iterations = 0, contacts = 0;
};

struct TimedRun {
  std::vector<TimedFrame> frames;
  Trajectory trajectory;  // every frame that kSamplesPerSecond asks for
  int recoveries = 0;
  double median() const;  // s, of a frame's simulation
  double total() const;   // s, of all frames' simulation
};

enum class Method { kSimulator, kPlain };

class TimedScene {
 public:
  // Settled and at the start of its clip. Throws app::InputError.
  TimedScene(std::string motion, app::Style style, app::Resolution resolution, bool collide);
  ~TimedScene();

  // Simulates `seconds` in steps of params.time_step, which must divide 1/60 s. The step contexts are kept from run to
  // run, so that all but the first run are warm.
  TimedRun run(sim::SimParams params, double seconds, Method method = Method::kSimulator);

  const sim::HairMesh& mesh() const { return actor_.haircut->mesh; }
  const std::string& name() const { return name_; }  // "long high"
  app::Actor& actor() { return actor_; }
  void restart();

 private:
  std::string name_;
  bool collide_;
  app::AssetCache asset_cache_;
  app::Actor actor_;
  sim::HairState start_;
  app::Playback playback_;
  std::unique_ptr<oracle::PlainContext> plain_;
};

}  // namespace bench

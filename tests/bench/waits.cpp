#include "tests/bench/waits.h"

#include <algorithm>
#include <cmath>

#include "app/files/data_path.h"
#include "app/files/hair_file.h"
#include "tests/bench/cpu_clock.h"
#include "tests/bench/scene_times.h"

namespace bench {
namespace {

constexpr int kWaitFrames = 20, kDragFrames = 60;

}  // namespace

StartUp measureStartUp(app::Style style, app::Resolution resolution) {
  StartUp times;
  double started = cpuSeconds();
  const auto lap = [&] {
    const double now = cpuSeconds(), spent = now - started;
    started = now;
    return spent;
  };
  app::CharacterSpec spec;
  spec.motion = app::findFile("walk.bvh", "", "clips");
  spec.style = style;
  spec.resolution = resolution;
  app::AssetCache asset_cache;
  app::Actor actor = app::makeActor(spec, {}, asset_cache);
  times.character = lap();
  const std::string text = app::writeHairMesh(actor.haircut->mesh.shape);
  lap();
  sim::HairMeshShape shape = app::readHairMesh(text, "style.obj");
  times.parse = lap();
  const sim::HairMesh mesh = sim::buildHairMesh(std::move(shape));
  times.build = lap();
  sim::StepContext context(mesh);
  sim::advance(mesh, {}, {actor.roots, actor.ellipsoids, kFrame}, kFrame, context, actor.hair);
  times.factor = lap();
  return times;
}

DragTimes measureDrag(TimedScene& scene, const std::string& parameter) {
  const sim::ParamField& field = *sim::findParam(parameter);
  scene.actor().context->refreshGradually(true);  // as in the window
  DragTimes times;
  for (const bool dragged : {false, true}) {
    scene.restart();
    sim::SimParams params;
    params.time_step = kFrame;
    std::vector<double> frames;
    for (int frame = 1; frame <= kWaitFrames + kDragFrames; ++frame) {
      app::moveActor(kFrame, scene.actor());
      const int moved = frame - kWaitFrames;
      // There and back over a factor of two, a pixel or two of the slider a frame.
      const double turn = std::sin(2 * 3.14159265358979 * moved / kDragFrames);
      if (dragged && moved > 0) field.set(params, field.default_value * std::pow(2.0, turn));
      const double started = cpuSeconds();
      const sim::StepReport report = app::simulateActor(params, kFrame, frame * kFrame, scene.actor());
      if (moved <= 0) continue;
      frames.push_back(cpuSeconds() - started);
      if (dragged) times.converged = times.converged && report.converged;
    }
    (dragged ? times.worst : times.still_worst) = *std::max_element(frames.begin(), frames.end());
    (dragged ? times.median : times.still_median) = medianOf(frames);
  }
  scene.actor().context->refreshGradually(false);
  return times;
}

}  // namespace bench

#include "tests/bench/gate_drawing.h"

#include <algorithm>
#include <cstdio>
#include <optional>

#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/platform/egl_context.h"
#include "tests/bench/draw_sweep.h"
#include "tests/bench/measured_part.h"

namespace bench {
namespace {

constexpr double kDrawnBehindFront = 1.1;  // times faster that no other setting may be

}  // namespace

void addDrawingFigures(const GateOptions& options, const std::function<void(const Figure&)>& add) {
  std::optional<app::EglContext> context;
  try {
    context.emplace();
  } catch (const app::ContextError& error) {
    std::printf("nothing of drawing is measured: %s\n", error.what());
    return;
  }
  render::Renderer renderer(app::dataPath("shaders"));
  for (const DrawScene& scene : drawScenes()) {
    DrawStage stage(scene, renderer);
    const DrawSweep sweep = sweepDrawing(stage, settingsToDraw(true), std::min(3, options.rounds));
    const DrawLag lag = confirmedLag(stage, sweep, options.rounds);
    const DrawPoint& standard = sweep.points.front();
    add({std::string("fastest way with no more error over the default: ") + scene.name, lag.ratio, kDrawnBehindFront,
         false, "",
         formatted("%s; the default is %.2f levels off in %.0f ms", lag.point->setting.name().c_str(),
                   standard.error.rms, standard.time)});
  }
}

}  // namespace bench

#include "render/renderer.h"

#include <vector>

#include "render/gl/gpu_timer.h"
#include "render/gl/render_target.h"
#include "render/passes.h"
#include "render/stage.h"

namespace render {

struct Renderer::Impl {
  Stage stage;
  std::vector<PassEntry> passes;
  bool has_drawn = false;  // the radiance shows what the passes' inputs say
  ImageTarget image;
  GpuTimer timer;

  explicit Impl(const std::string& shader_dir) {
    for (const PassMaker make : kPasses) passes.push_back(make(shader_dir));
  }

  // Whether the radiance shows another frame than this one. Uploads what changed.
  bool update(const FrameInput& input, FrameReport& report) {
    bool changed = stage.update(input, report) || !has_drawn;
    for (const PassEntry& pass : passes) {
      const bool pass_changed = pass.update(pass.pass.get(), input);
      changed = changed || (pass_changed && pass.target == Target::kRadiance);
    }
    return changed;
  }

  void drawInto(Target target, FrameReport& report) {
    for (const PassEntry& pass : passes) {
      if (pass.target != target) continue;
      target == Target::kRadiance ? stage.beginRadiance() : stage.beginScreen();
      pass.draw(pass.pass.get(), stage, report);
      timer.mark(pass.name);
    }
  }
};

Renderer::Renderer(std::string shader_dir) : impl_(std::make_unique<Impl>(shader_dir)) {}

Renderer::~Renderer() = default;

FrameReport Renderer::renderFrame(const FrameInput& input, unsigned framebuffer, bool measure) {
  Impl& r = *impl_;
  Stage& stage = r.stage;
  FrameReport report;
  if (input.width <= 0 || input.height <= 0) return report;
  stage.framebuffer = framebuffer;
  stage.width = input.width;
  stage.height = input.height;
  r.timer.start(measure);
  const bool changed = r.update(input, report);
  r.timer.mark("upload");
  const bool kept = input.skips.frame && !changed;
  report.skip_counts.frame = {kept, 1};
  if (!kept) {
    r.has_drawn = false;  // should a pass throw
    r.drawInto(Target::kRadiance, report);
    r.has_drawn = true;
  }
  r.drawInto(Target::kScreen, report);
  report.stages = r.timer.finish();
  report.gpu_bytes_hair = stage.hairs.gpuBytes();
  report.gpu_bytes_shadows = stage.shadows.gpuBytes();
  return report;
}

FrameReport Renderer::renderImage(const FrameInput& input, std::vector<unsigned char>& rgba, bool measure) {
  rgba.clear();
  if (input.width <= 0 || input.height <= 0) return {};
  impl_->image.prepare(input.width, input.height);
  FrameReport report = renderFrame(input, impl_->image.framebuffer(), measure);
  impl_->image.read(rgba);
  return report;
}

ReloadReport Renderer::reloadShaders(Reload which) {
  ReloadReport report;
  for (const PassEntry& pass : impl_->passes) report += pass.reload(pass.pass.get(), which);
  if (report.programs > 0) {
    impl_->has_drawn = false;
    impl_->stage.shadows.forget();
  }
  return report;
}

}  // namespace render

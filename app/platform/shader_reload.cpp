#include "app/platform/shader_reload.h"

#include <utility>

namespace app {

bool reloadSavedShaders(double moment, ShaderWatch& watch, render::Renderer& renderer, Demo& demo) {
  if (!watch.reload_all && moment < watch.looked + kShaderLook) return false;
  watch.looked = moment;
  const bool all = std::exchange(watch.reload_all, false);
  const render::ReloadReport report = renderer.reloadShaders(all ? render::Reload::kAll : render::Reload::kChanged);
  if (report.programs == 0 && report.fault.empty()) return false;
  demo.message_is_fault = !report.fault.empty();
  demo.message = demo.message_is_fault ? report.fault : std::to_string(report.programs) + " shader programs reloaded";
  return true;
}

}  // namespace app

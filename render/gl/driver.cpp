#include "render/gl/driver.h"

#include <string>

#include "render/renderer.h"

namespace render {
namespace {

bool isNamed(const std::string& renderer, const char* driver) {
  return renderer.find(driver) != std::string::npos;
}

}  // namespace

bool rasterizesInSoftware() {
  const std::string name = rendererName();
  return isNamed(name, "llvmpipe") || isNamed(name, "softpipe") || isNamed(name, "SWR");
}

// Zink names the Vulkan driver under it, and there a map waits for all that was drawn; softpipe interprets its shaders.
StrandPath pathFor(StrandPath asked) {
  if (asked != StrandPath::kAuto) return asked;
  const std::string name = rendererName();
  return isNamed(name, "llvmpipe") && !isNamed(name, "zink") ? StrandPath::kSoftware : StrandPath::kGeometry;
}

}  // namespace render

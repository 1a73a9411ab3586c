// Resolves the multisampled radiance and brings it to the screen: exposure, film curve, sRGB.
#pragma once

#include <string>

#include "render/render_target.h"
#include "render/shader.h"

namespace render {

class ToneMap {
 public:
  explicit ToneMap(const std::string& shader_dir);

  // Reads `radiance`, writes width x height pixels of `framebuffer`.
  void draw(const RadianceTarget& radiance, unsigned framebuffer, int width, int height, float exposure);

  std::string reload() { return program_.reloadIfChanged(); }

 private:
  ShaderProgram program_;
  VertexArray no_attributes_;
};

}  // namespace render

// Draws a hair's deep opacity map on drivers that rasterize in software: a shader grows the strands once, line_raster.h
// fills depth and layers.
#pragma once

#include <string>

#include "render/hair_store.h"
#include "render/line_raster.h"
#include "render/shader.h"
#include "render/shadow_maps.h"
#include "render/stored_buffer.h"

namespace render {

class SoftwareShadow {
 public:
  explicit SoftwareShadow(const std::string& shader_dir);
  // Draws a bound hair into a map.
  void draw(const HairResources& hair, std::size_t map, ShadowMaps& shadows);
  ReloadReport reload(Reload which) { return grow_.reload(which); }

 private:
  ShaderProgram grow_;
  StoredBuffer strands_, points_;
  OpacityTile tile_;
};

}  // namespace render

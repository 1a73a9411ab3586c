// Draws a hair's deep opacity map on drivers that rasterize in software: a shader grows the strands once, line_raster.h
// fills depth and layers.
#pragma once

#include <string>

#include "render/gl/shader.h"
#include "render/gl/stored_buffer.h"
#include "render/hair/hair_store.h"
#include "render/shadow_maps.h"
#include "render/software/line_raster.h"

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

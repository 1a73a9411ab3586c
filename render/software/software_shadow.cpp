#include "render/software/software_shadow.h"

#include "render/hair/stored_points.h"

namespace render {
using shared::kSlotPoints, shared::kSlotStrands;

SoftwareShadow::SoftwareShadow(const std::string& shader_dir) : grow_(shader_dir, {{"strand_lines.comp"}, {}, {}}) {}

void SoftwareShadow::draw(const HairResources& hair, std::size_t map, ShadowMaps& shadows) {
  const auto strands = static_cast<std::size_t>(hair.strandCount(hair.shadow_draw)),
             stride = static_cast<std::size_t>(hair.pointsPerStrand(hair.shadow_draw));
  strands_.reserve(static_cast<GLsizeiptr>(strands * sizeof(std::uint32_t)));
  points_.reserve(static_cast<GLsizeiptr>(strands * stride * sizeof(LinePoint)));
  strands_.bind(kSlotStrands, 0);
  points_.bind(kSlotPoints, 0);
  grow_.use();
  dispatchStrands(static_cast<int>(strands));
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  shadows.describeTile(map, tile_);
  rasterizeLines({strands_.open<std::uint32_t>(strands, GL_MAP_READ_BIT),
                  points_.open<LinePoint>(strands * stride, GL_MAP_READ_BIT), static_cast<std::uint32_t>(stride)},
                 tile_);
  strands_.close();
  points_.close();
  shadows.fillHairMap(map, tile_);
}

}  // namespace render

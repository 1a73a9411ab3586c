#include "render/grown/grown_strands.h"

#include <algorithm>

#include "render/hair/stored_points.h"

namespace render {
namespace {

using namespace shared;

constexpr std::uint32_t kBatchPoints = 1u << 19;  // 42 MB of them
constexpr GLint kFirst = 0;                       // the growing shaders' first strand, the shading one's count

// Strands that fit into so many points, in whole groups.
int strandsThatFit(std::uint32_t points, int stride) {
  return static_cast<int>(points) / std::max(stride, 1) / kStrandGroup * kStrandGroup;
}

}  // namespace

GrownStrands::GrownStrands(const std::string& shader_dir)
    : grow_(shader_dir, {{"strand_points.comp"}, {"KEEP_ASIDE"}, {}}),
      shade_(shader_dir, {{"strand_shade.comp"}, {"ALL_POINTS"}, {}}),
      show_(shader_dir, {{"strand_grown.vert", "strand.frag"}, {}, {}}),
      no_attributes_(makeVertexArray()) {}

StrandCount GrownStrands::draw(Stage& stage) {
  StrandCount count;
  for (std::size_t i = 0; i < stage.hairs.hairs().size(); ++i) {
    HairResources& hair = stage.hairs.hairs()[i];
    if (!hair.drawable || !hair.in_view) continue;
    hair.view_draw.shadow_map = stage.shadows.mapOf(i);
    const int strands = hair.strandCount(hair.view_draw), stride = hair.pointsPerStrand(hair.view_draw);
    add(i, strands, stride, stage);
    count += {strands, 2L * strands * stride, 3};
  }
  drawBatch(stage);
  return count;
}

void GrownStrands::add(std::size_t hair, int strands, int stride, Stage& stage) {
  for (int first = 0; first < strands;) {
    const int room = strandsThatFit(kBatchPoints - point_count_, stride);
    if (room == 0 && !batch_.empty()) {
      drawBatch(stage);
      continue;
    }
    const int some = std::min(std::max(room, kStrandGroup), strands - first);
    batch_.push_back({hair, first, some, stride, strand_count_, point_count_});
    strand_count_ += alignedCount(static_cast<std::uint32_t>(some));
    point_count_ += alignedCount(static_cast<std::uint32_t>(some * stride));
    first += some;
  }
}

void GrownStrands::bind(Stage& stage, const Piece& piece) {
  HairResources& hair = stage.hairs.hairs()[piece.hair];
  HairStore::bind(hair, hair.view_draw, &stage.detail.table());
  ribbons_.bind(kSlotRibbons, piece.first_point * kStoredTexel);
  strands_.bind(kSlotStrands, piece.first_strand * kStoredStrand);
  points_.bind(kSlotPoints, piece.first_point * kPointTexels * kStoredTexel);
  colors_.bind(kSlotColors, piece.first_point * kStoredTexel);
}

void GrownStrands::drawBatch(Stage& stage) {
  if (batch_.empty()) return;
  ribbons_.reserve(point_count_ * kStoredTexel);
  strands_.reserve(strand_count_ * kStoredStrand);
  points_.reserve(point_count_ * kPointTexels * kStoredTexel);
  colors_.reserve(point_count_ * kStoredTexel);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);  // the batch before has been drawn
  grow_.use();
  for (const Piece& piece : batch_) {
    bind(stage, piece);
    glUniform1i(kFirst, piece.first);
    dispatchStrands(piece.strands);
  }
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  shade_.use();
  stage.shadows.bindMaps();
  for (const Piece& piece : batch_) {
    bind(stage, piece);
    glUniform1i(kFirst, piece.strands * piece.stride);
    dispatchStrands(piece.strands * piece.stride);
  }
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  show_.use();
  glBindVertexArray(no_attributes_.id());
  for (const Piece& piece : batch_) {
    bind(stage, piece);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 2 * piece.stride, piece.strands);
  }
  batch_.clear();
  strand_count_ = point_count_ = 0;
}

GrownLines::GrownLines(const std::string& shader_dir)
    : grow_(shader_dir, {{"strand_lines.comp"}, {}, {}}),
      depth_(shader_dir, {{"strand_line.vert", "depth_only.frag"}, {}, {}}),
      opacity_(shader_dir, {{"strand_line.vert", "opacity.frag"}, {}, {}}),
      no_attributes_(makeVertexArray()) {}

void GrownLines::draw(const HairResources& hair, const ShaderProgram& program, bool fresh) {
  const int strands = hair.strandCount(hair.shadow_draw), stride = hair.pointsPerStrand(hair.shadow_draw),
            most = std::max(strandsThatFit(kBatchPoints, stride), kStrandGroup);
  glBindVertexArray(no_attributes_.id());
  for (int first = 0; first < strands; first += most) {
    const int some = std::min(most, strands - first);
    strands_.reserve(static_cast<GLsizeiptr>(alignedCount(static_cast<std::uint32_t>(some)) * sizeof(std::uint32_t)));
    points_.reserve(static_cast<GLsizeiptr>(some) * stride * kStoredTexel);
    strands_.bind(kSlotStrands, 0);
    points_.bind(kSlotPoints, 0);
    if (fresh || strands > most) {
      glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);  // what was there has been drawn
      grow_.use();
      glUniform1i(kFirst, first);
      dispatchStrands(some);
      glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    }
    program.use();
    glDrawArraysInstanced(GL_LINE_STRIP, 0, stride, some);
  }
}

}  // namespace render

#include "render/software/software_strands.h"

#include "render/hair/stored_points.h"

namespace render {
namespace {

using namespace shared;

static_assert(sizeof(StoredStrand) == kStoredStrand);

SamplePattern patternOf(int samples) {
  SamplePattern pattern;
  pattern.count = samples;
  for (int s = 0; s < samples; ++s) {
    GLfloat at[2];
    glGetMultisamplefv(GL_SAMPLE_POSITION, static_cast<GLuint>(s), at);
    pattern.x[static_cast<std::size_t>(s)] = at[0];
    pattern.y[static_cast<std::size_t>(s)] = at[1];
  }
  return pattern;
}

}  // namespace

SoftwareStrands::SoftwareStrands(const std::string& shader_dir)
    : grow_(shader_dir, {{"strand_points.comp"}, {}, {}}),
      shade_(shader_dir, {{"strand_shade.comp"}, {}, {}}),
      show_(shader_dir, {{"full_screen.vert", "strand_samples.frag"}, {}, {}}),
      no_attributes_(makeVertexArray()) {}

bool SoftwareStrands::place(Stage& stage) {
  placed_.clear();
  point_count_ = strand_count_ = 0;
  for (std::size_t i = 0; i < stage.hairs.hairs().size(); ++i) {
    HairResources& hair = stage.hairs.hairs()[i];
    if (!hair.drawable || !hair.in_view || hair.strandCount(hair.view_draw) == 0) continue;
    hair.view_draw.shadow_map = stage.shadows.mapOf(i);
    const Placed placed{i, hair.strandCount(hair.view_draw), hair.pointsPerStrand(hair.view_draw), strand_count_,
                        point_count_};
    const auto points = static_cast<std::uint64_t>(placed.strands) * static_cast<std::uint64_t>(placed.stride);
    if (points + point_count_ > kMaxRasterPoints - kStoredAlign) return false;
    strand_count_ += alignedCount(static_cast<std::uint32_t>(placed.strands));
    point_count_ += alignedCount(static_cast<std::uint32_t>(points));
    placed_.push_back(placed);
  }
  return true;
}

void SoftwareStrands::bind(Stage& stage, const Placed& placed) {
  HairResources& hair = stage.hairs.hairs()[placed.hair];
  HairStore::bind(hair, hair.view_draw, &stage.detail.table());
  strands_.bind(kSlotStrands, placed.first_strand * kStoredStrand);
  points_.bind(kSlotPoints, placed.first_point * kPointTexels * kStoredTexel);
}

void SoftwareStrands::grow(Stage& stage) {
  ribbons_.reserve(point_count_ * static_cast<GLsizeiptr>(sizeof(RibbonEdges)));
  strands_.reserve(strand_count_ * kStoredStrand);
  points_.reserve(point_count_ * kPointTexels * kStoredTexel);
  colors_.reserve(point_count_ * kStoredTexel);
  grow_.use();
  for (const Placed& placed : placed_) {
    bind(stage, placed);
    ribbons_.bind(kSlotRibbons, placed.first_point * static_cast<GLintptr>(sizeof(RibbonEdges)));
    dispatchStrands(placed.strands);
  }
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
}

PixelBox SoftwareStrands::rasterize(const Stage& stage) {
  const int width = stage.width, height = stage.height;
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const bool fresh =
      samples_.reserve(static_cast<GLsizeiptr>(pixels * sizeof(SampledPixel))) || width != width_ || height != height_;
  width_ = width;
  height_ = height;
  SampleGrid grid{samples_.open<SampledPixel>(pixels, GL_MAP_READ_BIT | GL_MAP_WRITE_BIT), width, height,
                  patternOf(stage.radiance.samples())};
  clearSamples(fresh ? PixelBox{0, 0, width, height} : touched_, grid);
  touched_ = {};
  const auto ribbons = ribbons_.open<RibbonEdges>(point_count_, GL_MAP_READ_BIT);
  const auto strands = strands_.open<StoredStrand>(strand_count_, GL_MAP_READ_BIT);
  for (const Placed& placed : placed_) {
    const StoredHair hair{strands.subspan(placed.first_strand, static_cast<std::size_t>(placed.strands)),
                          ribbons.subspan(placed.first_point), static_cast<std::uint32_t>(placed.stride),
                          placed.first_point};
    touched_.add(rasterizeStrands(hair, grid));
  }
  is_seen_.assign(point_count_ + 1, 0);
  markSeen(touched_, grid, is_seen_);
  strands_.close();
  ribbons_.close();
  samples_.close();
  return touched_;
}

void SoftwareStrands::listSeen(bool all, SkipCount& unshaded) {
  seen_.clear();
  for (Placed& placed : placed_) {
    placed.first_seen = static_cast<std::uint32_t>(seen_.size());
    const int points = placed.strands * placed.stride;
    for (int point = 0; point < points; ++point)
      if (all || is_seen_[placed.first_point + static_cast<std::uint32_t>(point)] != 0) seen_.push_back(point);
    placed.seen = static_cast<std::uint32_t>(seen_.size()) - placed.first_seen;
    unshaded += {points - static_cast<long>(placed.seen), points};
    seen_.resize(alignedCount(static_cast<std::uint32_t>(seen_.size())));
  }
  seen_buffer_.upload(seen_.data(), static_cast<GLsizeiptr>(seen_.size() * sizeof(int)));
}

void SoftwareStrands::shade(Stage& stage) {
  shade_.use();
  stage.shadows.bindMaps();
  colors_.bind(kSlotColors, 0);
  for (const Placed& placed : placed_) {
    if (placed.seen == 0) continue;
    bind(stage, placed);
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, kSlotSeen, seen_buffer_.id(), placed.first_seen * sizeof(int),
                      placed.seen * sizeof(int));
    glUniform1i(0, static_cast<GLint>(placed.seen));
    glUniform1i(1, static_cast<GLint>(placed.first_point));
    dispatchStrands(static_cast<int>(placed.seen));
  }
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void SoftwareStrands::show(const PixelBox& box) {
  show_.use();
  samples_.bind(kSlotSamples, 0);
  colors_.bind(kSlotColors, 0);
  glBindVertexArray(no_attributes_.id());
  glEnable(GL_SCISSOR_TEST);
  glScissor(box.low_x, box.low_y, box.high_x - box.low_x, box.high_y - box.low_y);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_SCISSOR_TEST);
}

bool SoftwareStrands::draw(Stage& stage, bool shade_all, StrandCount& count, SkipCount& unshaded) {
  if (stage.radiance.samples() > kMaxRasterSamples || !place(stage)) return false;
  if (placed_.empty()) return true;
  grow(stage);
  const PixelBox box = rasterize(stage);
  for (const Placed& placed : placed_) count += {placed.strands, 2L * placed.strands * placed.stride, 2};
  if (box.empty()) return true;
  listSeen(shade_all, unshaded);
  shade(stage);
  show(box);
  return true;
}

}  // namespace render

// Draws strands, lit: by the geometry stage or by vertex pulling, the same curves either way.
#include <string>

#include "render/pass.h"
#include "render/stage.h"
#include "render/strand_draw.h"
#include "shaders/shared.h"

namespace render {

class StrandPass {
 public:
  static constexpr const char* kName = "strands";
  static constexpr Target kTarget = Target::kRadiance;
  struct Input {
    bool show = true;
    StrandPath path = StrandPath::kGeometry;
    bool operator==(const Input&) const = default;
  };
  static Input inputOf(const FrameInput& frame) { return {frame.view.show_strands, frame.view.strand_path}; }

  explicit StrandPass(const std::string& shader_dir);
  void draw(const Input& input, Stage& stage, FrameReport& report);
  ReloadReport reload(Reload which) { return reloadPrograms({&geometry_, &pulling_}, which); }

 private:
  ShaderProgram geometry_, pulling_;
  VertexArray no_attributes_;
};

// GL 4.5 promises this much output of one geometry shader invocation; Mesa allows more, other drivers do not.
static_assert(2 * shared::kChunkPoints * shared::kRibbonComponents <= shared::kMaxOutputComponents);
static_assert(shared::kChunkPoints * shared::kLineComponents <= shared::kMaxOutputComponents);

StrandPass::StrandPass(const std::string& shader_dir)
    : geometry_(shader_dir, {{"strand.vert", "strand.geom", "strand.frag"}, {}, {}}),
      pulling_(shader_dir, {{"strand_pull.vert", "strand.frag"}, {}, {}}),
      no_attributes_(makeVertexArray()) {}

void StrandPass::draw(const Input& input, Stage& stage, FrameReport& report) {
  if (!input.show) return;
  StrandCount count;
  stage.shadows.bindMaps();
  glBindVertexArray(no_attributes_.id());
  for (std::size_t i = 0; i < stage.hairs.hairs().size(); ++i) {
    HairResources& hair = stage.hairs.hairs()[i];
    if (!hair.drawable || !hair.in_view) continue;
    hair.view_draw.shadow_map = stage.shadows.mapOf(i);
    HairStore::bind(hair, hair.view_draw, &stage.detail.table());
    (input.path == StrandPath::kGeometry ? geometry_ : pulling_).use();
    count += issueStrands(hair, hair.view_draw, input.path, {GL_TRIANGLE_STRIP, 2});
  }
  report.strands_drawn = count.strands;
  report.strand_vertices = count.vertices;
  report.draw_calls += count.draw_calls;
}

template PassEntry makePass<StrandPass>(const std::string& shader_dir);

}  // namespace render

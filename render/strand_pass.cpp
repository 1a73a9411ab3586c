// Draws strands, lit: grown by the geometry stage, by compute shaders, or in software, the same curves each way.
#include <string>

#include "render/gl/driver.h"
#include "render/grown/grown_strands.h"
#include "render/hair/strand_draw.h"
#include "render/pass.h"
#include "render/software/software_strands.h"
#include "render/stage.h"
#include "shaders/shared.h"

namespace render {

class StrandPass {
 public:
  static constexpr const char* kName = "strands";
  static constexpr Target kTarget = Target::kRadiance;
  struct Input {
    bool show = true, shade_all = false;
    StrandPath path = StrandPath::kAuto;
    bool operator==(const Input&) const = default;
  };
  static Input inputOf(const FrameInput& frame) {
    return {frame.view.show_strands, !frame.skips.shading, frame.view.strand_path};
  }

  explicit StrandPass(const std::string& shader_dir);
  void draw(const Input& input, Stage& stage, FrameReport& report);
  ReloadReport reload(Reload which) {
    ReloadReport report = geometry_.reload(which);
    report += grown_.reload(which);
    report += software_.reload(which);
    return report;
  }

 private:
  StrandCount drawByGeometryStage(Stage& stage);

  ShaderProgram geometry_;
  GrownStrands grown_;
  SoftwareStrands software_;
  VertexArray no_attributes_;
};

// GL 4.5 promises this much output of one geometry shader invocation; Mesa allows more, other drivers do not.
static_assert(2 * shared::kChunkPoints * shared::kRibbonComponents <= shared::kMaxOutputComponents);
static_assert(shared::kChunkPoints * shared::kLineComponents <= shared::kMaxOutputComponents);

StrandPass::StrandPass(const std::string& shader_dir)
    : geometry_(shader_dir, {{"strand.vert", "strand.geom", "strand.frag"}, {}, {}}),
      grown_(shader_dir),
      software_(shader_dir),
      no_attributes_(makeVertexArray()) {}

StrandCount StrandPass::drawByGeometryStage(Stage& stage) {
  StrandCount count;
  stage.shadows.bindMaps();
  glBindVertexArray(no_attributes_.id());
  for (std::size_t i = 0; i < stage.hairs.hairs().size(); ++i) {
    HairResources& hair = stage.hairs.hairs()[i];
    if (!hair.drawable || !hair.in_view) continue;
    hair.view_draw.shadow_map = stage.shadows.mapOf(i);
    HairStore::bind(hair, hair.view_draw, &stage.detail.table());
    geometry_.use();
    count += issueStrands(hair, hair.view_draw, 2);
  }
  return count;
}

void StrandPass::draw(const Input& input, Stage& stage, FrameReport& report) {
  if (!input.show) return;
  StrandPath path = pathFor(input.path);
  StrandCount count;
  if (path == StrandPath::kSoftware && !software_.draw(stage, input.shade_all, count, report.skip_counts.shading))
    path = StrandPath::kGeometry;
  if (path == StrandPath::kCompute)
    count = grown_.draw(stage);
  else if (path == StrandPath::kGeometry)
    count = drawByGeometryStage(stage);
  report.strands_drawn = count.strands;
  report.strand_vertices = count.vertices;
  report.draw_calls += count.draw_calls;
}

template PassEntry makePass<StrandPass>(const std::string& shader_dir);

}  // namespace render

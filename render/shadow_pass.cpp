// The key light's shadow maps, as shadow_maps.h plans them; maps that show already what they should are kept.
#include <string>

#include "render/gl/driver.h"
#include "render/grown/grown_strands.h"
#include "render/hair/strand_draw.h"
#include "render/pass.h"
#include "render/shadow_maps.h"
#include "render/software/software_shadow.h"
#include "render/stage.h"

namespace render {
namespace {

// Draws all bodies' depth with the program in use. What stands between the light and the frustum shades too: it is
// clamped onto the frustum's near side.
void drawBodies(const BodyStore& bodies, const LightFrustum& frustum, bool cull) {
  glEnable(GL_DEPTH_CLAMP);
  bodies.drawAll(frustum.clip_from_world, cull);
  glDisable(GL_DEPTH_CLAMP);
}

}  // namespace

// Deep opacity maps of the hairs, and the bodies' depth in the same views.
class HairShadowPass {
 public:
  static constexpr const char* kName = "hair shadows";
  static constexpr Target kTarget = Target::kRadiance;
  struct Input {
    bool keep_maps = true, cull_bodies = true;
    StrandPath path = StrandPath::kAuto;
    bool operator==(const Input&) const = default;
  };
  static Input inputOf(const FrameInput& frame) {
    return {frame.skips.shadows, frame.skips.shadow_view, frame.view.strand_path};
  }

  explicit HairShadowPass(const std::string& shader_dir);
  void draw(const Input& input, Stage& stage, FrameReport& report);
  ReloadReport reload(Reload which);

 private:
  // Draws a bound hair's strands into a map, not in software.
  void drawStages(StrandPath path, const HairResources& hair, const ShadowMaps::HairMap& map, ShadowMaps& shadows);

  ShaderProgram depth_, opacity_, layers_, body_depth_;
  GrownLines grown_;
  SoftwareShadow software_;
  VertexArray no_attributes_;
};

// Depth of the bodies.
class BodyShadowPass {
 public:
  static constexpr const char* kName = "body shadow";
  static constexpr Target kTarget = Target::kRadiance;
  struct Input {
    bool keep_maps = true;
    bool operator==(const Input&) const = default;
  };
  static Input inputOf(const FrameInput& frame) { return {frame.skips.shadows}; }

  explicit BodyShadowPass(const std::string& shader_dir);
  void draw(const Input& input, Stage& stage, FrameReport& report);
  ReloadReport reload(Reload which) { return depth_.reload(which); }

 private:
  ShaderProgram depth_;
};

HairShadowPass::HairShadowPass(const std::string& shader_dir)
    : depth_(shader_dir, {{"strand.vert", "strand_shadow.geom", "depth_only.frag"}, {}, {}}),
      opacity_(shader_dir, {{"strand.vert", "strand_shadow.geom", "opacity.frag"}, {}, {}}),
      layers_(shader_dir, {{"opacity_layers.comp"}, {}, {}}),
      body_depth_(shader_dir, {{"body.vert", "depth_only.frag"}, {}, {}}),
      grown_(shader_dir),
      software_(shader_dir),
      no_attributes_(makeVertexArray()) {}

void HairShadowPass::drawStages(StrandPath path, const HairResources& hair, const ShadowMaps::HairMap& map,
                                ShadowMaps& shadows) {
  const bool compute = path == StrandPath::kCompute;
  const auto growAndDraw = [&](const ShaderProgram& program) {
    glBindVertexArray(no_attributes_.id());
    program.use();
    issueStrands(hair, hair.shadow_draw, 1);
  };
  shadows.beginHairDepth(map);
  compute ? grown_.drawDepth(hair) : growAndDraw(depth_);
  shadows.beginOpacity(map);
  compute ? grown_.drawOpacity(hair) : growAndDraw(opacity_);
  layers_.use();
  shadows.sumOpacity(map);
}

void HairShadowPass::draw(const Input& input, Stage& stage, FrameReport& report) {
  ShadowMaps& shadows = stage.shadows;
  const StrandPath path = pathFor(input.path);
  bool changed = false;
  for (std::size_t i = 0; i < shadows.hairMaps().size(); ++i) {
    const bool kept = shadows.claimHairMap(i) && input.keep_maps;
    report.skip_counts.shadows += {kept, 1};
    if (kept) continue;
    changed = true;
    const ShadowMaps::HairMap& map = shadows.hairMaps()[i];
    HairResources& hair = stage.hairs.hairs()[map.hair];
    hair.shadow_draw.shadow_map = static_cast<int>(i);
    HairStore::bind(hair, hair.shadow_draw, &stage.detail.table());
    if (path == StrandPath::kSoftware)
      software_.draw(hair, i, shadows);
    else
      drawStages(path, hair, map, shadows);
    report.draw_calls += 2;
    if (shadows.bodyMaps().empty()) continue;
    shadows.beginBodyInHairDepth(map);
    body_depth_.use();
    drawBodies(stage.bodies, map.frustum, input.cull_bodies);
  }
  if (changed) shadows.finishOpacity();
}

ReloadReport HairShadowPass::reload(Reload which) {
  ReloadReport report = reloadPrograms({&depth_, &opacity_, &layers_, &body_depth_}, which);
  report += grown_.reload(which);
  report += software_.reload(which);
  return report;
}

BodyShadowPass::BodyShadowPass(const std::string& shader_dir)
    : depth_(shader_dir, {{"body.vert", "depth_only.frag"}, {}, {}}) {}

void BodyShadowPass::draw(const Input& input, Stage& stage, FrameReport& report) {
  for (std::size_t i = 0; i < stage.shadows.bodyMaps().size(); ++i) {
    const ShadowMaps::BodyMap& map = stage.shadows.bodyMaps()[i];
    const bool kept = stage.shadows.claimBodyMap(i) && input.keep_maps;
    report.skip_counts.shadows += {kept, 1};
    if (kept) continue;
    stage.shadows.beginBodyDepth(i);
    depth_.use();
    drawBodies(stage.bodies, map.frustum, map.some);
  }
}

template PassEntry makePass<HairShadowPass>(const std::string& shader_dir);
template PassEntry makePass<BodyShadowPass>(const std::string& shader_dir);

}  // namespace render

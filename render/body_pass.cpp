// The bodies, lit.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "render/body/body_store.h"
#include "render/pass.h"
#include "render/stage.h"
#include "shaders/shared.h"

namespace render {

class BodyPass {
 public:
  static constexpr const char* kName = "bodies";
  static constexpr Target kTarget = Target::kRadiance;
  struct Input {
    bool show = true, cull_bodies = true, cull_parts = true, light_at_vertices = true;
    bool operator==(const Input&) const = default;
  };
  static Input inputOf(const FrameInput& frame) {
    return {frame.view.show_body, frame.skips.view, frame.skips.body_parts, frame.skips.hair_light};
  }

  explicit BodyPass(const std::string& shader_dir);
  void draw(const Input& input, Stage& stage, FrameReport& report);
  ReloadReport reload(Reload which) {
    return reloadPrograms({&plain_.lit, &plain_.coarse, &plain_.small, &own_.lit, &own_.coarse, &own_.small}, which);
  }

 private:
  // What the hair over a body lets through; `none_` where no hair is.
  void bindOpenness(const Body& body, Stage& stage);
  // Fills counts_ and offsets_ with the triangles whose joint may be in view. Returns how many are left out.
  long chooseTriangles(const Body& body, const BodyMesh& mesh, const Frustum* cull);

  struct Programs {
    ShaderProgram lit;     // per pixel, but for the hair's shadow: at the vertices
    ShaderProgram coarse;  // all of it per pixel, for meshes too coarse for that
    ShaderProgram small;   // per vertex, for bodies of few pixels
    Programs(const std::string& shader_dir, const std::vector<std::string>& defines);
  };
  Programs plain_, own_;  // of one colour; of the mesh's own materials
  Texture none_;
  std::vector<int> counts_;
  std::vector<const void*> offsets_;
};

BodyPass::Programs::Programs(const std::string& shader_dir, const std::vector<std::string>& defines)
    : coarse(shader_dir, {{"body.vert", "body.frag"}, defines, {}}),
      small(shader_dir, {{"body_small.vert", "body_small.frag"}, defines, {}}) {
  std::vector<std::string> at_vertices = defines;
  at_vertices.emplace_back("HAIR_LIGHT_AT_VERTICES");
  lit = ShaderProgram(shader_dir, {{"body.vert", "body.frag"}, at_vertices, {}});
}

BodyPass::BodyPass(const std::string& shader_dir)
    : plain_(shader_dir, {}), own_(shader_dir, {"OWN_MATERIALS"}), none_(makeTexture(GL_TEXTURE_3D)) {
  constexpr std::array<std::uint8_t, 4> kOpen{255, 128, 128, 128};
  glTextureStorage3D(none_.id(), 1, GL_RGBA8, 1, 1, 1);
  glTextureSubImage3D(none_.id(), 0, 0, 0, 0, 1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, kOpen.data());
}

void BodyPass::bindOpenness(const Body& body, Stage& stage) {
  const auto hairs = stage.hairs.hairs();
  const auto hair = std::ranges::find_if(
      hairs, [&](const HairResources& one) { return one.id == body.hair_id && one.drawable && one.openness; });
  const bool found = body.hair_id != 0 && hair != hairs.end();
  glBindTextureUnit(shared::kUnitOpenness, found ? hair->openness.id() : none_.id());
  const Eigen::Matrix4f from_world = found ? hair->openness_from_world : Eigen::Matrix4f::Identity();
  glUniformMatrix4fv(1, 1, GL_FALSE, from_world.data());
}

long BodyPass::chooseTriangles(const Body& body, const BodyMesh& mesh, const Frustum* cull) {
  counts_.clear();
  offsets_.clear();
  long skipped = 0;
  int end = -1;
  for (const JointTriangles& triangles : mesh.by_joint) {
    Bounds box;
    for (std::size_t k = 0; k < triangles.joints.size(); ++k)
      addMoved(body.joint_matrices[static_cast<std::size_t>(triangles.joints[k])], triangles.boxes[k], box);
    if (cull != nullptr && !cull->maySee(box)) {
      skipped += triangles.index_count / 3;
      continue;
    }
    if (triangles.first_index == end) {
      counts_.back() += triangles.index_count;
    } else {
      counts_.push_back(triangles.index_count);
      offsets_.push_back(reinterpret_cast<const void*>(static_cast<std::uintptr_t>(triangles.first_index) * 4));
    }
    end = triangles.first_index + triangles.index_count;
  }
  return skipped;
}

// A disc of the hair's shadow (kMinRadius of shadow.glsl) is as wide as this many metres: nothing finer is in it.
constexpr float kShadowDisc = 0.016f;

bool hasFineVertices(const Body& body, const BodyMesh& mesh) {
  const Mat4& matrix = body.joint_matrices.front();
  return mesh.spacing * std::hypot(matrix[0], matrix[1], matrix[2]) <= kShadowDisc;
}

void BodyPass::draw(const Input& input, Stage& stage, FrameReport& report) {
  if (!input.show) return;
  for (ShaderProgram* program : {&own_.small, &own_.coarse, &own_.lit, &plain_.small, &plain_.coarse, &plain_.lit}) {
    program->use();
    glUniformMatrix4fv(0, 1, GL_FALSE, stage.view_projection.data());
  }
  stage.shadows.bindMaps();
  const Frustum frustum(stage.view_projection, 0.01f);
  for (const Body& body : stage.bodies.bodies()) {
    const BodyMesh& mesh = stage.bodies.meshOf(body);
    Programs& programs = body.finish.own_materials ? own_ : plain_;
    const long triangles = mesh.index_count / 3;
    report.skip_counts.body_parts.of += triangles;
    if (input.cull_bodies && !frustum.maySee(body.around())) {
      report.skip_counts.body_parts.skipped += triangles;
      continue;
    }
    report.skip_counts.body_detail.of += triangles;
    if (body.level > 0) {
      report.skip_counts.body_detail.skipped += triangles - mesh.levels[static_cast<std::size_t>(body.level)].count / 3;
      programs.small.use();
      bindOpenness(body, stage);
      stage.bodies.bind(body, mesh);
      BodyStore::drawLevel(body, mesh);
      report.draw_calls += 1;
      continue;
    }
    report.skip_counts.body_parts.skipped += chooseTriangles(body, mesh, input.cull_parts ? &frustum : nullptr);
    if (counts_.empty()) continue;
    const bool at_vertices = input.light_at_vertices && hasFineVertices(body, mesh);
    report.skip_counts.hair_light += {at_vertices ? triangles : 0, triangles};
    (at_vertices ? programs.lit : programs.coarse).use();
    bindOpenness(body, stage);
    stage.bodies.bind(body, mesh);
    glMultiDrawElements(GL_TRIANGLES, counts_.data(), GL_UNSIGNED_INT, offsets_.data(),
                        static_cast<GLsizei>(counts_.size()));
    report.draw_calls += 1;
  }
}

template PassEntry makePass<BodyPass>(const std::string& shader_dir);

}  // namespace render

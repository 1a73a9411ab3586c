#include "render/tone_map_pass.h"

#include "render/stage.h"
#include "shaders/shared.h"

namespace render {

ToneMapPass::ToneMapPass(const std::string& shader_dir)
    : program_(shader_dir, {{"full_screen.vert", "tone_map.frag"}, {}, {}}), no_attributes_(makeVertexArray()) {}

void ToneMapPass::draw(const Input& input, Stage& stage, FrameReport& report) {
  glBindTextureUnit(shared::kUnitColor, stage.radiance.color());
  program_.use();
  glUniform1i(0, stage.radiance.samples());
  glUniform1f(1, input.exposure);
  glBindVertexArray(no_attributes_.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  report.draw_calls += 1;
}

}  // namespace render

#include "render/backdrop_pass.h"

#include "render/stage.h"

namespace render {

BackdropPass::BackdropPass(const std::string& shader_dir)
    : backdrop_(shader_dir, {{"full_screen.vert", "backdrop.frag"}, {}, {}}),
      ground_(shader_dir, {{"ground.vert", "ground.frag"}, {}, {}}),
      no_attributes_(makeVertexArray()) {}

void BackdropPass::draw(const Input& input, Stage& stage, FrameReport& report) {
  glClear(GL_DEPTH_BUFFER_BIT);
  glBindVertexArray(no_attributes_.id());
  glDepthMask(GL_FALSE);
  glDisable(GL_DEPTH_TEST);
  backdrop_.use();
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  report.draw_calls += 1;
  if (!input.ground) return;
  stage.shadows.bindMaps();
  ground_.use();
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  report.draw_calls += 1;
}

}  // namespace render

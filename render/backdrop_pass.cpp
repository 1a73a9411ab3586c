#include "render/backdrop_pass.h"

namespace render {

BackdropPass::BackdropPass(const std::string& shader_dir)
    : backdrop_(shader_dir, {{"full_screen.vert", "backdrop.frag"}, {}, {}}),
      ground_(shader_dir, {{"ground.vert", "ground.frag"}, {}, {}}),
      no_attributes_(makeVertexArray()) {}

int BackdropPass::draw(bool ground) {
  glBindVertexArray(no_attributes_.id());
  glDepthMask(GL_FALSE);
  glDisable(GL_DEPTH_TEST);
  backdrop_.use();
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  if (!ground) return 1;
  ground_.use();
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  return 2;
}

std::string BackdropPass::reload() {
  const std::string first = backdrop_.reloadIfChanged(), second = ground_.reloadIfChanged();
  return first.empty() ? second : first;
}

}  // namespace render

#include "render/tone_map.h"

#include "shaders/shared.h"

namespace render {

ToneMap::ToneMap(const std::string& shader_dir)
    : program_(shader_dir, {{"full_screen.vert", "tone_map.frag"}, {}, {}}), no_attributes_(makeVertexArray()) {}

void ToneMap::draw(const RadianceTarget& radiance, unsigned framebuffer, int width, int height, float exposure) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, width, height);
  glDisable(GL_DEPTH_TEST);
  glBindTextureUnit(shared::kUnitColor, radiance.color());
  program_.use();
  glUniform1i(0, radiance.samples());
  glUniform1f(1, exposure);
  glBindVertexArray(no_attributes_.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace render

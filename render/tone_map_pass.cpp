// Resolves the multisampled radiance and brings it to the screen: exposure, film curve, sRGB.
#include <string>

#include "render/pass.h"
#include "render/stage.h"
#include "shaders/shared.h"

namespace render {

class ToneMapPass {
 public:
  static constexpr const char* kName = "tone map";
  static constexpr Target kTarget = Target::kScreen;
  struct Input {
    float exposure = 1;
    bool operator==(const Input&) const = default;
  };
  static Input inputOf(const FrameInput& frame) { return {frame.view.exposure}; }

  explicit ToneMapPass(const std::string& shader_dir);
  void draw(const Input& input, Stage& stage, FrameReport& report);
  ReloadReport reload(Reload which) { return program_.reload(which); }

 private:
  ShaderProgram program_;
  VertexArray no_attributes_;
};

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

template PassEntry makePass<ToneMapPass>(const std::string& shader_dir);

}  // namespace render

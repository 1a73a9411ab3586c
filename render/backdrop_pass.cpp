// The studio: a backdrop behind everything and a ground disc that fades into it. Clears the radiance.
#include <string>

#include "render/pass.h"
#include "render/stage.h"

namespace render {

class BackdropPass {
 public:
  static constexpr const char* kName = "backdrop";
  static constexpr Target kTarget = Target::kRadiance;
  struct Input {
    bool ground = true;
    bool operator==(const Input&) const = default;
  };
  static Input inputOf(const FrameInput& frame) { return {frame.view.ground}; }

  explicit BackdropPass(const std::string& shader_dir);
  void draw(const Input& input, Stage& stage, FrameReport& report);
  ReloadReport reload(Reload which) { return reloadPrograms({&backdrop_, &ground_}, which); }

 private:
  ShaderProgram backdrop_, ground_;
  VertexArray no_attributes_;
};

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

template PassEntry makePass<BackdropPass>(const std::string& shader_dir);

}  // namespace render

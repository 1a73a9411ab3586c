// Shaders are reloaded when their files change and when asked for; a broken one leaves the picture and names its line.
#include "app/platform/shader_reload.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "app/files/image_io.h"
#include "app/ui/ui.h"
#include "render/renderer.h"
#include "tests/gl_fixture.h"
#include "tests/synthetic_hair.h"

namespace shader_reload_test {

constexpr int kWidth = 160, kHeight = 90;

class ShaderReload : public gl_fixture::GlTest {
 protected:
  std::string folder_ = gl_fixture::copyShaders("reloaded_shaders");
  synthetic::Hair hair_ = synthetic::makeHair();
  synthetic::Body body_ = synthetic::makeBody();
  render::HairInput hairs_[1] = {synthetic::hairInput(hair_, 300)};
  render::BodyInput bodies_[1] = {synthetic::bodyInput(body_)};

  std::vector<unsigned char> draw(render::Renderer& renderer, bool* kept = nullptr) const {
    std::vector<unsigned char> rgba;
    const render::FrameReport report =
        renderer.renderImage(synthetic::frameInput(hairs_, bodies_, kWidth, kHeight), rgba);
    if (kept != nullptr) *kept = report.skip_counts.frame.skipped == 1;
    return rgba;
  }
  std::string text(const std::string& file) const {
    std::ifstream stream(folder_ + "/" + file);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  void save(const std::string& file, const std::string& content) const {
    std::ofstream(folder_ + "/" + file) << content;
  }
  // Saves the file with `from`, which it must hold, put right or wrong as `to`.
  void replace(const std::string& file, const std::string& from, const std::string& to) const {
    std::string content = text(file);
    ASSERT_NE(content.find(from), std::string::npos) << file << " does not hold " << from;
    save(file, content.replace(content.find(from), from.size(), to));
  }
};

TEST_F(ShaderReload, ASavedIncludeChangesThePictureAsAFreshStartWould) {
  render::Renderer renderer(folder_);
  const auto before = draw(renderer);
  EXPECT_EQ(renderer.reloadShaders(render::Reload::kChanged).programs, 0) << "nothing was saved";
  bool kept = false;
  EXPECT_EQ(draw(renderer, &kept), before);
  EXPECT_TRUE(kept) << "a look at the files' times draws nothing";
  for (const auto& [file, from, to] :
       {std::array{"common/backdrop.glsl", "return sweep", "return vec3(0.5, 0.0, 0.0) + sweep"},
        std::array{"common/surface.glsl", "return albedo * diffuse", "return 0.3 * albedo * diffuse"},
        std::array{"common/hair_shading.glsl", "return radiance;", "return 3.0 * radiance;"},
        std::array{"common/opacity_line.glsl", "opacity = width.z", "opacity = 9.0 * width.z"},
        std::array{"body.vert", "clip_from_world * vec4(world, 1.0)", "clip_from_world * vec4(world.xy, 0.2, 1.0)"},
        std::array{"tone_map.frag", "exposure * texelFetch", "0.5 * exposure * texelFetch"}}) {
    const auto last = draw(renderer);
    replace(file, from, to);
    const render::ReloadReport report = renderer.reloadShaders(render::Reload::kChanged);
    EXPECT_GT(report.programs, 0) << file;
    EXPECT_EQ(report.fault, "") << file;
    const auto after = draw(renderer);
    EXPECT_NE(after, last) << file;
    render::Renderer fresh(folder_);
    EXPECT_EQ(after, draw(fresh)) << file;
  }
}

TEST_F(ShaderReload, ABrokenShaderLeavesThePictureAndNamesItsLineUntilItIsMended) {
  render::Renderer renderer(folder_);
  const auto before = draw(renderer);
  const std::string good = text("common/film.glsl");
  const auto lines = std::count(good.begin(), good.end(), '\n');
  save("common/film.glsl", good + "\nvec3 broken() { return nonsense; }\n");
  const render::ReloadReport broken = renderer.reloadShaders(render::Reload::kChanged);
  EXPECT_EQ(broken.programs, 0);
  EXPECT_NE(broken.fault.find("common/film.glsl:" + std::to_string(lines + 2)), std::string::npos) << broken.fault;
  EXPECT_EQ(draw(renderer), before);
  EXPECT_EQ(renderer.reloadShaders(render::Reload::kChanged).fault, "") << "the same fault is reported once";
  EXPECT_NE(renderer.reloadShaders(render::Reload::kAll).fault, "") << "but again when all are reloaded";

  save("common/film.glsl", "#include \"common/nowhere.glsl\"\n" + good);
  const render::ReloadReport missing = renderer.reloadShaders(render::Reload::kChanged);
  EXPECT_NE(missing.fault.find("common/film.glsl:1: includes"), std::string::npos) << missing.fault;
  EXPECT_EQ(draw(renderer), before);
  save("common/nowhere.glsl", "");
  EXPECT_GT(renderer.reloadShaders(render::Reload::kChanged).programs, 0) << "the file that was missed is watched";
  EXPECT_EQ(draw(renderer), before);

  std::filesystem::remove(folder_ + "/strand.frag");
  EXPECT_NE(renderer.reloadShaders(render::Reload::kChanged).fault.find("strand.frag: cannot be read"),
            std::string::npos);
  EXPECT_EQ(draw(renderer), before);
}

TEST_F(ShaderReload, TheWindowLooksNowAndThenAndShowsWhatCameOfIt) {
  render::Renderer renderer(folder_);
  app::Demo demo;
  app::UiState ui;
  app::ShaderWatch watch;
  double moment = 10;
  EXPECT_FALSE(app::reloadSavedShaders(moment, watch, renderer, demo));
  replace("body.frag", "normal, cover, garment,", "normal, uncovered, garment,");
  const std::string broken = text("body.frag");
  const auto lines = std::count(broken.begin(), broken.begin() + static_cast<long>(broken.find("uncovered")), '\n');
  EXPECT_FALSE(app::reloadSavedShaders(moment + 0.5 * app::kShaderLook, watch, renderer, demo)) << "too early";
  EXPECT_TRUE(app::reloadSavedShaders(moment += app::kShaderLook, watch, renderer, demo));
  EXPECT_TRUE(demo.message_is_fault);
  EXPECT_NE(demo.message.find("body.frag:" + std::to_string(lines + 1)), std::string::npos) << demo.message;
  EXPECT_FALSE(app::reloadSavedShaders(moment += app::kShaderLook, watch, renderer, demo));
  EXPECT_TRUE(demo.message_is_fault) << "the message stays while the file is broken";
  replace("body.frag", "uncovered", "cover");
  EXPECT_TRUE(app::reloadSavedShaders(moment += app::kShaderLook, watch, renderer, demo));
  EXPECT_FALSE(demo.message_is_fault);
  EXPECT_NE(demo.message.find("reloaded"), std::string::npos) << demo.message;

  demo.message.clear();
  app::pressKey(app::kKeyF5, demo, ui);
  watch.reload_all = ui.reload_shaders;
  EXPECT_TRUE(app::reloadSavedShaders(moment, watch, renderer, demo)) << "F5 reloads at once";
  EXPECT_FALSE(app::reloadSavedShaders(moment, watch, renderer, demo)) << "and once";
  const int programs = renderer.reloadShaders(render::Reload::kAll).programs;
  EXPECT_GT(programs, 10);
  EXPECT_EQ(demo.message, std::to_string(programs) + " shader programs reloaded");
}

}  // namespace shader_reload_test

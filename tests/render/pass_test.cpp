// A pass that lacks a part does not compile, and an entry keeps what its pass depends on.
#include "render/pass.h"

#include <gtest/gtest.h>

#include <string>

#include "render/stage.h"
#include "tests/gl_fixture.h"

namespace pass_test {

// Whole, and then without one part each.
struct WholePass {
  static constexpr const char* kName = "whole";
  static constexpr render::Target kTarget = render::Target::kScreen;
  struct Input {
    bool operator==(const Input&) const = default;
  };
  static Input inputOf(const render::FrameInput&) { return {}; }
  explicit WholePass(const std::string&) {}
  void draw(const Input&, render::Stage&, render::FrameReport&) {}
  render::ReloadReport reload(render::Reload) { return {}; }
};
struct WithoutInput {
  static constexpr const char* kName = "without input";
  static constexpr render::Target kTarget = render::Target::kScreen;
  explicit WithoutInput(const std::string&) {}
  void draw(render::Stage&, render::FrameReport&) {}
  render::ReloadReport reload(render::Reload) { return {}; }
};
struct InputWithoutComparison : WholePass {
  using WholePass::WholePass;
  struct Input {};
  static Input inputOf(const render::FrameInput&) { return {}; }
  void draw(const Input&, render::Stage&, render::FrameReport&) {}
};
struct SeesTheFrame : WholePass {
  using WholePass::WholePass;
  void draw(const render::FrameInput&, render::Stage&, render::FrameReport&) {}
};
struct WithoutReload {
  static constexpr const char* kName = "without reload";
  static constexpr render::Target kTarget = render::Target::kScreen;
  using Input = WholePass::Input;
  static Input inputOf(const render::FrameInput&) { return {}; }
  explicit WithoutReload(const std::string&) {}
  void draw(const Input&, render::Stage&, render::FrameReport&) {}
};
struct WithoutTarget {
  static constexpr const char* kName = "without target";
  using Input = WholePass::Input;
  static Input inputOf(const render::FrameInput&) { return {}; }
  explicit WithoutTarget(const std::string&) {}
  void draw(const Input&, render::Stage&, render::FrameReport&) {}
  render::ReloadReport reload(render::Reload) { return {}; }
};
static_assert(render::Pass<WholePass>);
static_assert(!render::Pass<WithoutInput>);
static_assert(!render::Pass<InputWithoutComparison>);
static_assert(!render::Pass<SeesTheFrame>);
static_assert(!render::Pass<WithoutReload>);
static_assert(!render::Pass<WithoutTarget>);

int built = 0;
struct CountsItself : WholePass {
  explicit CountsItself(const std::string& folder) : WholePass(folder) { ++built; }
  CountsItself(CountsItself&& other) noexcept : WholePass(other) { ++built; }
  ~CountsItself() { --built; }
  struct Input {
    float exposure = 1;
    bool operator==(const Input&) const = default;
  };
  static Input inputOf(const render::FrameInput& frame) { return {frame.view.exposure}; }
  void draw(const Input& input, render::Stage&, render::FrameReport&) { drawn = input.exposure; }
  static inline float drawn = 0;
};

class PassEntry : public gl_fixture::GlTest {};

TEST_F(PassEntry, TellsAChangeOfItsInputDrawsTheLastOneAndEndsWithItsPass) {
  {
    const render::PassEntry entry = render::makePass<CountsItself>("");
    EXPECT_EQ(built, 1);
    EXPECT_STREQ(entry.name, "whole");
    EXPECT_EQ(entry.target, render::Target::kScreen);
    render::FrameInput frame;
    frame.view.exposure = 3;
    EXPECT_TRUE(entry.update(entry.pass.get(), frame));
    EXPECT_FALSE(entry.update(entry.pass.get(), frame));
    render::Stage stage;
    render::FrameReport report;
    entry.draw(entry.pass.get(), stage, report);
    EXPECT_EQ(CountsItself::drawn, 3);
  }
  EXPECT_EQ(built, 0);
}

}  // namespace pass_test

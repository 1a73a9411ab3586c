// Pictures are read back top row first: OpenGL's first row is the bottom one.
#include "render/gl/read_back.h"

#include <GL/glew.h>
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "render/gl/render_target.h"
#include "tests/gl_fixture.h"

namespace read_back_test {

struct ReadBack : gl_fixture::GlTest {};

// A corner of its own colour each: upper left red, upper right green, lower left blue, lower right black.
TEST_F(ReadBack, EveryPixelIsWhereItWasDrawn) {
  constexpr int kWidth = 7, kHeight = 5;
  render::ImageTarget target;
  target.prepare(kWidth, kHeight);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer());
  glEnable(GL_SCISSOR_TEST);
  const auto fill = [](int x, int y, int width, int height, float red, float green, float blue) {
    glScissor(x, y, width, height);
    glClearColor(red, green, blue, 1);
    glClear(GL_COLOR_BUFFER_BIT);
  };
  fill(0, 0, kWidth, kHeight, 0, 0, 0);
  fill(0, 3, 4, 2, 1, 0, 0);
  fill(4, 3, 3, 2, 0, 1, 0);
  fill(0, 0, 4, 3, 0, 0, 1);
  glDisable(GL_SCISSOR_TEST);
  std::vector<unsigned char> rgba;
  target.read(rgba);
  ASSERT_EQ(rgba.size(), 4u * kWidth * kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const bool upper = y < 2, left = x < 4;
      const std::array<int, 4> expected{upper && left ? 255 : 0, upper && !left ? 255 : 0, !upper && left ? 255 : 0,
                                        255};
      for (int c = 0; c < 4; ++c) EXPECT_EQ(rgba[4 * (y * kWidth + x) + c], expected[c]) << x << ", " << y << ", " << c;
    }
  }
}

}  // namespace read_back_test

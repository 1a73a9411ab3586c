#include "render/gl/read_back.h"

#include <GL/glew.h>

#include <algorithm>

namespace render {

void readFramebuffer(unsigned framebuffer, int width, int height, std::vector<unsigned char>& rgba) {
  const std::size_t row = 4 * static_cast<std::size_t>(width);
  rgba.resize(row * static_cast<std::size_t>(height));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  for (int y = 0; y < height / 2; ++y) {
    std::swap_ranges(rgba.begin() + y * static_cast<std::ptrdiff_t>(row),
                     rgba.begin() + (y + 1) * static_cast<std::ptrdiff_t>(row),
                     rgba.begin() + (height - 1 - y) * static_cast<std::ptrdiff_t>(row));
  }
  // What the window's alpha holds is the compositor's affair; a picture file is opaque.
  for (std::size_t i = 3; i < rgba.size(); i += 4) rgba[i] = 255;
}

}  // namespace render

// Reads a drawn framebuffer, panels included.
#pragma once

#include <vector>

namespace render {

// 8-bit RGBA, opaque, top row first, of the back buffer (framebuffer 0) or a framebuffer object. Needs a current
// context.
void readFramebuffer(unsigned framebuffer, int width, int height, std::vector<unsigned char>& rgba);

}  // namespace render

// Two pictures in one: side by side, or the second one right of a line through both.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/renderer.h"

namespace render {

struct PairLayout {
  bool side_by_side = false;
  double line = 0.5;  // share of the width left of the line
};

// Pixels of the first picture's and the second one's width, of a pair that is `width` wide.
int firstWidth(const PairLayout& layout, int width);
int secondWidth(const PairLayout& layout, int width);

// Owns what the second picture needs: a renderer keeps what it knows of one scene.
class PicturePair {
 public:
  explicit PicturePair(std::string shader_dir);
  ~PicturePair();
  PicturePair(const PicturePair&) = delete;
  PicturePair& operator=(const PicturePair&) = delete;

  // Draws both into `framebuffer` (0: the window's) at `width` x first.height. The inputs' widths are firstWidth and
  // secondWidth, their heights alike. The report is the first one's. Throws std::runtime_error as Renderer does.
  FrameReport renderFrame(Renderer& renderer, const FrameInput& first, const FrameInput& second,
                          const PairLayout& layout, int width, unsigned framebuffer, bool measure = false);

  // The same, read back: 8-bit RGBA sRGB, top row first.
  FrameReport renderImage(Renderer& renderer, const FrameInput& first, const FrameInput& second,
                          const PairLayout& layout, int width, std::vector<unsigned char>& rgba, bool measure = false);

  ReloadReport reloadShaders(Reload which);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace render

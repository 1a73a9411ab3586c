// Pictures of levels from 0 to 255: a larger one averaged down to a reference, and how far another is off.
#pragma once

#include <vector>

namespace bench {

// RGB levels a pixel, 0 to 255, with fractions; top row first.
struct LevelPicture {
  int width = 0, height = 0;
  std::vector<float> levels;
};

// 8-bit RGBA as the renderer reads it back.
LevelPicture levelsOf(int width, int height, const std::vector<unsigned char>& rgba);

enum class Half { kAll, kEven, kOdd };

// `larger` with every `finer` x `finer` pixels averaged as the renderer averages the samples of a pixel
// (shaders/tone_map.frag): as radiance, each weighed by 1 / (1 + luminance). A half takes every other of these pixels,
// as the squares of a chessboard.
LevelPicture averagedDown(const LevelPicture& larger, int finer, Half half = Half::kAll);

// Levels of 255. rms: over pixels and channels. blocks: of means over 8 x 8 pixels, that is without what grain does.
struct PictureError {
  double rms = 0, blocks = 0;
};
PictureError differenceOf(const LevelPicture& a, const LevelPicture& b);

}  // namespace bench

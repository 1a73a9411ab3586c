// The renderer's own picture of what the reference traces, term by term.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "render/frame_input.h"

namespace reference {

// What is shown. kCover: strands in red, skin in green. kShadow, kSkinShadow: what is left of key, fill and rim on
// strands, and on skin. kLight: radiance of strands, as the shaders have it.
enum class Term { kCover, kShadow, kSkinShadow, kLight };

struct DrawOptions {
  int width = 80, height = 100;  // of the pixels of the result
  int finer = 4;                 // drawn pixels along one of them
  float brightest = 1;           // radiance that still fits
};

// Means over pixels, all in linear values; what does not belong to the term is black.
std::vector<Eigen::Vector3f> drawTerm(render::FrameInput frame, Term term, const DrawOptions& options);

}  // namespace reference

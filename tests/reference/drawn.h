// The renderer's own picture of what the reference traces, term by term.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "render/frame_input.h"

namespace reference {

// Which term the strands show.
enum class Term { kCover, kShadow, kLight };

struct DrawOptions {
  int width = 80, height = 100;  // of the pixels of the result
  int finer = 4;                 // drawn pixels along one of them
  float brightest = 1;           // radiance that still fits
};

// Means over pixels, all in linear values: strands alone, before black. kShadow: what is left of key, fill and rim;
// kLight: radiance as the shaders have it.
std::vector<Eigen::Vector3f> drawTerm(render::FrameInput frame, Term term, const DrawOptions& options);

}  // namespace reference

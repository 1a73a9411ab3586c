// A drawn picture's distance from a traced one, term by term.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace reference {

using Eigen::Vector3f;
using Eigen::Vector4f;

// Means over the samples of a pixel.
struct TracedPixel {
  int samples = 1;                       // how many
  float cover = 0;                       // share of them that see hair
  Vector4f lit = Vector4f::Zero();       // share of those that each light reaches
  Vector4f skin = Vector4f::Zero();      // share of all that see skin which faces a light
  Vector4f skin_lit = Vector4f::Zero();  // share of those that it reaches
  // Of those that see hair: radiance by the key light alone, and the variance of its mean.
  Vector3f single = Vector3f::Zero(), full = Vector3f::Zero(), full_variance = Vector3f::Zero();
};

// What is drawn of a pixel, before black.
struct DrawnPixel {
  float cover = 0, skin = 0;             // share that shows hair, and skin
  Vector4f lit = Vector4f::Zero();       // what is left of each light, times the share that shows hair
  Vector4f skin_lit = Vector4f::Zero();  // the same of skin
};

// Pixels that hair fills in both pictures.
inline constexpr float kFull = 0.9f;
inline bool bothFull(float traced, float drawn) {
  return traced > kFull && drawn > kFull;
}

struct CoverError {
  float ratio = 0;  // of the means, drawn over traced
  float rms = 0;    // of the difference, over pixels that either covers; the tracer's own noise is taken off
};
CoverError coverError(std::span<const TracedPixel> traced, std::span<const DrawnPixel> drawn);

// Over points that are seen lit: what is left of the light is more than exp(-2). The tracer's own noise is taken off.
struct ShadowError {
  Vector4f rms = Vector4f::Zero(), bias = Vector4f::Zero();  // of what is left of each light
};
ShadowError shadowError(std::span<const TracedPixel> traced, std::span<const DrawnPixel> drawn);

// Over pixels that hair, or skin which faces the light, fills in both pictures and where no sample of the traced one is
// lit: what is drawn of the light.
struct Leaks {
  Vector4f pixels = Vector4f::Zero();                          // how many
  Vector4f mean = Vector4f::Zero(), above = Vector4f::Zero();  // share of the light; share of pixels with over 1 %
};
Leaks hairLeaks(std::span<const TracedPixel> traced, std::span<const DrawnPixel> drawn);
Leaks skinLeaks(std::span<const TracedPixel> traced, std::span<const DrawnPixel> drawn);

struct LightError {
  Vector3f single = Vector3f::Zero(), full = Vector3f::Zero();  // ratio of the means, drawn over traced
  Vector3f noise = Vector3f::Zero();                            // of the traced mean, relative
  float spread = 0;                                             // RMS of the difference over the traced mean, green
};
// single, full: drawn radiance before black.
LightError lightError(std::span<const TracedPixel> traced, std::span<const DrawnPixel> drawn,
                      std::span<const Vector3f> single, std::span<const Vector3f> full);

}  // namespace reference

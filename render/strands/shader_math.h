// The functions of GLSL and of shaders/common/hash.glsl that the strands are grown with, under their names there. In
// single precision, operation by operation.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace render {

using uint = std::uint32_t;

inline uint hash(uint x) {
  const uint state = x * 747796405u + 2891336453u;
  const uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return (word >> 22u) ^ word;
}

inline uint hash(uint x, uint y) {
  return hash(x ^ hash(y));
}

// [0, 1): 24 bits, exact in a float.
inline float unitFloat(uint x) {
  return static_cast<float>(x >> 8u) * (1.0f / 16777216.0f);
}

// The n-th independent number of a key, in [0, 1).
inline float randomOf(uint key, uint n) {
  return unitFloat(hash(key + n * 0x9e3779b9u));
}

inline float fract(float x) {
  return x - std::floor(x);
}

inline float mix(float from, float to, float t) {
  return from * (1.0f - t) + to * t;
}

inline float smoothstep(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

}  // namespace render

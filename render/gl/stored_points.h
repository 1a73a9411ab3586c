// How points of strands are laid out in buffers that shaders write: strands of several hairs, one after another.
#pragma once

#include <GL/glew.h>

#include <cstdint>

#include "shaders/shared.h"

namespace render {

// Hairs begin at multiples of so many strands, points and entries: OpenGL binds from multiples of 256 bytes.
inline constexpr std::uint32_t kStoredAlign = 64;
inline constexpr GLsizeiptr kStoredTexel = 4 * sizeof(float), kStoredStrand = 2 * kStoredTexel;

inline std::uint32_t alignedCount(std::uint32_t count) {
  return (count + kStoredAlign - 1) / kStoredAlign * kStoredAlign;
}

// Runs the compute shader in use, in groups of kStrandGroup.
inline void dispatchStrands(int invocations) {
  glDispatchCompute(static_cast<GLuint>((invocations + shared::kStrandGroup - 1) / shared::kStrandGroup), 1, 1);
}

}  // namespace render

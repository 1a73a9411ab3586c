// How points of strands are laid out in buffers that shaders write: strands of several hairs, one after another.
#pragma once

#include <GL/glew.h>

#include <algorithm>
#include <cstdint>

#include "shaders/shared.h"

namespace render {

// Hairs begin at multiples of so many strands, points and entries: OpenGL binds from multiples of 256 bytes.
inline constexpr std::uint32_t kStoredAlign = 64;
inline constexpr GLsizeiptr kStoredTexel = 4 * sizeof(float), kStoredStrand = 2 * kStoredTexel;

inline std::uint32_t alignedCount(std::uint32_t count) {
  return (count + kStoredAlign - 1) / kStoredAlign * kStoredAlign;
}

// Runs the compute shader in use, in groups of kStrandGroup, in rows of as many groups as OpenGL promises (see
// invocation() of shaders/common/invocation.glsl).
inline void dispatchStrands(int invocations) {
  constexpr GLuint kRow = 65535;
  const auto groups = static_cast<GLuint>((invocations + shared::kStrandGroup - 1) / shared::kStrandGroup);
  glDispatchCompute(std::min(groups, kRow), (groups + kRow - 1) / kRow, 1);
}

}  // namespace render

// Path tracing of a hair's light, one key light that casts from a direction.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "render/frame_input.h"
#include "tests/reference/fiber.h"
#include "tests/reference/traced_scene.h"

namespace reference {

struct TraceOptions {
  int width = 80, height = 100, samples = 64;  // of a pixel
  int threads = 2;
};

// Means over the samples of a pixel that see hair.
struct TracedPixel {
  float cover = 0;                                              // share of the samples that see hair
  Vector3f lit = Vector3f::Zero();                              // share that key, fill and rim reach
  Vector3f single = Vector3f::Zero(), full = Vector3f::Zero();  // radiance by the key light alone
  Vector3f full_variance = Vector3f::Zero();                    // of the mean
};

// Shares of key, fill and rim; without colours.
std::vector<TracedPixel> traceShadows(const TracedScene& scene, const render::FrameInput& frame,
                                      const TraceOptions& options);
// single, full and cover.
std::vector<TracedPixel> traceLight(const TracedScene& scene, const Fiber& fiber, const render::FrameInput& frame,
                                    const TraceOptions& options);

}  // namespace reference

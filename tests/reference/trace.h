// Path tracing of a hair's light, one key light that casts from a direction.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "render/frame_input.h"
#include "tests/reference/errors.h"
#include "tests/reference/fiber.h"
#include "tests/reference/traced_scene.h"

namespace reference {

struct TraceOptions {
  int width = 80, height = 100, samples = 64;  // of a pixel
  int threads = 2;
};

// to_lights: unit. Without colours. Pixels full of hair, or of skin that faces a light, where no sample is lit have 16
// times as many: what is dark there is sure to be.
std::vector<TracedPixel> traceShadows(const TracedScene& scene, const render::FrameInput& frame,
                                      const std::array<Vector3f, 4>& to_lights, const TraceOptions& options);
// single, full and cover.
std::vector<TracedPixel> traceLight(const TracedScene& scene, const Fiber& fiber, const render::FrameInput& frame,
                                    const TraceOptions& options);

}  // namespace reference

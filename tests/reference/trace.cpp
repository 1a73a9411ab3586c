#include "tests/reference/trace.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <thread>

#include "render/view_math.h"

namespace reference {
namespace {

constexpr int kMaxBounces = 400, kCertainBounces = 8;
constexpr float kAside = 2.5f;  // radii that a ray starts off its strand

// Rays through a picture's pixels.
struct Eye {
  Vector3f at, ahead, right, up;
  float half_height, aspect;

  Eye(const render::CameraInput& camera, int width, int height)
      : at(render::asVector(camera.eye)),
        ahead((render::asVector(camera.target) - at).normalized()),
        right(ahead.cross(render::asVector(camera.up)).normalized()),
        up(right.cross(ahead)),
        half_height(std::tan(0.5f * camera.fov_y)),
        aspect(static_cast<float>(width) / static_cast<float>(height)) {}

  // x, y: 0..1 from the top left.
  Vector3f through(float x, float y) const {
    return (ahead + half_height * ((2 * x - 1) * aspect * right + (1 - 2 * y) * up)).normalized();
  }
};

// What a strand stands in its own way of: more where the ray runs along it.
float startOff(const Hit& hit, const Vector3f& direction) {
  const float across = std::max(hit.tangent.cross(direction).norm(), 0.15f);
  return kAside * hit.radius / across;
}

// Light of the key that comes to the eye from a strand after at least one more strand.
Vector3f scatteredOn(const TracedScene& scene, const Fiber& fiber, Hit hit, Vector3f to_eye, const Vector3f& to_key,
                     Random& random) {
  Vector3f share = Vector3f::Ones(), sum = Vector3f::Zero();
  for (int bounce = 0; bounce < kMaxBounces; ++bounce) {
    const Fiber::Sample sample = fiber.drawLight(hit.tangent, to_eye, random);
    share = share.cwiseProduct(sample.share);
    if (bounce >= kCertainBounces) {
      const float kept = std::min(share.maxCoeff(), 1.0f);
      if (!(unit(random) < kept)) break;
      share /= kept;
    }
    const auto next = scene.first(hit.at, sample.to_light, startOff(hit, sample.to_light));
    if (!next || !next->hair) break;
    hit = *next;
    to_eye = -sample.to_light;
    if (scene.lit(hit.at, to_key, startOff(hit, to_key)))
      sum += share.cwiseProduct(fiber.scattered(hit.tangent, to_eye, to_key));
  }
  return sum;
}

// Runs rows of the picture on all threads.
void eachRow(const TraceOptions& options, const std::function<void(int)>& row) {
  std::vector<std::thread> threads;
  for (int t = 0; t < options.threads; ++t) {
    threads.emplace_back([&, t] {
      for (int y = t; y < options.height; y += options.threads) row(y);
    });
  }
  for (std::thread& thread : threads) thread.join();
}

using See = std::function<void(const Hit&, const Vector3f& to_eye, Random&, TracedPixel&)>;

std::vector<TracedPixel> trace(const TracedScene& scene, const render::FrameInput& frame, const TraceOptions& options,
                               const See& see) {
  const Eye eye(frame.camera, options.width, options.height);
  std::vector<TracedPixel> picture(static_cast<std::size_t>(options.width * options.height));
  eachRow(options, [&](int y) {
    for (int x = 0; x < options.width; ++x) {
      const auto place = static_cast<std::size_t>(y * options.width + x);
      Random random(static_cast<unsigned>(place) * 7919u + 17u);
      TracedPixel& pixel = picture[place];
      for (int sample = 0; sample < options.samples; ++sample) {
        const Vector3f ray = eye.through((static_cast<float>(x) + unit(random)) / static_cast<float>(options.width),
                                         (static_cast<float>(y) + unit(random)) / static_cast<float>(options.height));
        const auto hit = scene.first(eye.at, ray, 0);
        if (!hit || !hit->hair) continue;
        pixel.cover += 1;
        see(*hit, -ray, random, pixel);
      }
      const float seen = std::max(pixel.cover, 1.0f);
      pixel.lit /= seen;
      pixel.single /= seen;
      pixel.full /= seen;
      pixel.full_variance = (pixel.full_variance / seen - pixel.full.cwiseProduct(pixel.full)) / seen;
      pixel.cover /= static_cast<float>(options.samples);
    }
  });
  return picture;
}

}  // namespace

std::vector<TracedPixel> traceShadows(const TracedScene& scene, const render::FrameInput& frame,
                                      const TraceOptions& options) {
  const std::array<Vector3f, 3> lights{render::directionOr(frame.light.to_light, Vector3f::UnitY()),
                                       render::directionOr(frame.light.to_fill, Vector3f::UnitX()),
                                       render::directionOr(frame.light.to_rim, -Vector3f::UnitZ())};
  return trace(scene, frame, options, [&](const Hit& hit, const Vector3f&, Random&, TracedPixel& pixel) {
    for (int k = 0; k < 3; ++k) {
      const Vector3f& to_light = lights[static_cast<std::size_t>(k)];
      pixel.lit[k] += scene.lit(hit.at, to_light, startOff(hit, to_light)) ? 1.0f : 0.0f;
    }
  });
}

std::vector<TracedPixel> traceLight(const TracedScene& scene, const Fiber& fiber, const render::FrameInput& frame,
                                    const TraceOptions& options) {
  const Vector3f to_key = render::directionOr(frame.light.to_light, Vector3f::UnitY()),
                 key = render::asVector(frame.light.key);
  return trace(scene, frame, options, [&](const Hit& hit, const Vector3f& to_eye, Random& random, TracedPixel& pixel) {
    Vector3f single = Vector3f::Zero();
    if (scene.lit(hit.at, to_key, startOff(hit, to_key)))
      single = key.cwiseProduct(fiber.scattered(hit.tangent, to_eye, to_key));
    const Vector3f full = single + key.cwiseProduct(scatteredOn(scene, fiber, hit, to_eye, to_key, random));
    pixel.single += single;
    pixel.full += full;
    pixel.full_variance += full.cwiseProduct(full);
  });
}

}  // namespace reference

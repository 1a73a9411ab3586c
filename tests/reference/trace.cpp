#include "tests/reference/trace.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <thread>

#include "render/view_math.h"

namespace reference {
namespace {

constexpr int kMaxBounces = 400, kCertainBounces = 8;
constexpr float kLampRadius = 0.05f;  // rad, of the lamps over skin: half of kLampAngle of shaders/common/shadow.glsl
constexpr int kDarkSamples = 16;      // times as many where no sample is lit
constexpr float kAside = 2.5f;        // radii that a ray starts off its strand
constexpr float kOffSkin = 0.0005f;   // m that a ray starts off skin
constexpr float kFacing = 0.2f;       // cosine between the light and the normal of skin which faces it, or more

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

// Towards a point of a lamp of some size.
Vector3f towardsLamp(const Vector3f& to_middle, Random& random) {
  const Vector3f right = to_middle.unitOrthogonal(), up = to_middle.cross(right);
  const float angle = 2 * std::numbers::pi_v<float> * unit(random), off = kLampRadius * std::sqrt(unit(random));
  return (to_middle + off * (std::cos(angle) * right + std::sin(angle) * up)).normalized();
}

using See = std::function<void(const Hit&, const Vector3f& to_eye, Random&, TracedPixel&)>;

// Whether a light that the pixel may see has not been seen by one of its samples so far. Sums, not yet means.
bool looksDark(const TracedPixel& pixel) {
  const float full = kFull * static_cast<float>(pixel.samples);
  for (int k = 0; k < 4; ++k) {
    if (pixel.cover > full && pixel.lit[k] == 0) return true;
    if (pixel.skin[k] > full && pixel.skin_lit[k] == 0) return true;
  }
  return false;
}

std::vector<TracedPixel> trace(const TracedScene& scene, const render::FrameInput& frame, const TraceOptions& options,
                               int most, const See& see) {
  const Eye eye(frame.camera, options.width, options.height);
  std::vector<TracedPixel> picture(static_cast<std::size_t>(options.width * options.height));
  eachRow(options, [&](int y) {
    for (int x = 0; x < options.width; ++x) {
      const auto place = static_cast<std::size_t>(y * options.width + x);
      Random random(static_cast<unsigned>(place) * 7919u + 17u);
      TracedPixel& pixel = picture[place];
      pixel.samples = 0;
      while (pixel.samples < options.samples || (pixel.samples < most && looksDark(pixel))) {
        ++pixel.samples;
        const Vector3f ray = eye.through((static_cast<float>(x) + unit(random)) / static_cast<float>(options.width),
                                         (static_cast<float>(y) + unit(random)) / static_cast<float>(options.height));
        const auto hit = scene.first(eye.at, ray, 0);
        if (!hit) continue;
        pixel.cover += hit->hair ? 1.0f : 0.0f;
        see(*hit, -ray, random, pixel);
      }
      const float seen = std::max(pixel.cover, 1.0f);
      pixel.lit /= seen;
      pixel.single /= seen;
      pixel.full /= seen;
      pixel.full_variance = (pixel.full_variance / seen - pixel.full.cwiseProduct(pixel.full)) / seen;
      pixel.skin_lit = pixel.skin_lit.cwiseQuotient(pixel.skin.cwiseMax(1.0f));
      pixel.cover /= static_cast<float>(pixel.samples);
      pixel.skin /= static_cast<float>(pixel.samples);
    }
  });
  return picture;
}

}  // namespace

std::vector<TracedPixel> traceShadows(const TracedScene& scene, const render::FrameInput& frame,
                                      const std::array<Vector3f, 4>& to_lights, const TraceOptions& options) {
  return trace(scene, frame, options, kDarkSamples * options.samples,
               [&](const Hit& hit, const Vector3f&, Random& random, TracedPixel& pixel) {
                 for (int k = 0; k < 4; ++k) {
                   const Vector3f& to_light = to_lights[static_cast<std::size_t>(k)];
                   if (hit.hair) {
                     pixel.lit[k] += scene.lit(hit.at, to_light, startOff(hit, to_light)) ? 1.0f : 0.0f;
                   } else if (hit.normal.dot(to_light) > kFacing) {
                     pixel.skin[k] += 1;
                     pixel.skin_lit[k] += scene.lit(hit.at, towardsLamp(to_light, random), kOffSkin) ? 1.0f : 0.0f;
                   }
                 }
               });
}

std::vector<TracedPixel> traceLight(const TracedScene& scene, const Fiber& fiber, const render::FrameInput& frame,
                                    const TraceOptions& options) {
  const Vector3f to_key = render::directionOr(frame.light.to_light, Vector3f::UnitY()),
                 key = render::asVector(frame.light.key);
  return trace(
      scene, frame, options, 0, [&](const Hit& hit, const Vector3f& to_eye, Random& random, TracedPixel& pixel) {
        if (!hit.hair) return;
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

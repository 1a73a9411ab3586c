#include "tests/reference/errors.h"

#include <algorithm>
#include <cmath>

namespace reference {
namespace {

constexpr float kLeak = 0.01f;

// Of a share that so many samples tell: its variance, without bias (Bessel).
float noiseOf(float share, float samples) {
  return share * (1 - share) / std::max(samples - 1, 1.0f);
}

// One pixel's part of the leaks of light k; left: what is drawn of it.
void addLeak(int k, float left, Leaks& leaks) {
  leaks.pixels[k] += 1;
  leaks.mean[k] += left;
  leaks.above[k] += left > kLeak ? 1.0f : 0.0f;
}

Leaks meansOf(Leaks leaks) {
  const Vector4f count = leaks.pixels.cwiseMax(1.0f);
  leaks.mean = leaks.mean.cwiseQuotient(count);
  leaks.above = leaks.above.cwiseQuotient(count);
  return leaks;
}

}  // namespace

CoverError coverError(std::span<const TracedPixel> traced, std::span<const DrawnPixel> drawn) {
  float truth = 0, shown = 0, squares = 0, count = 0;
  for (std::size_t i = 0; i < traced.size(); ++i) {
    const float t = traced[i].cover, d = drawn[i].cover;
    if (t <= 0 && d <= 0) continue;
    truth += t;
    shown += d;
    squares += (d - t) * (d - t) - noiseOf(t, static_cast<float>(traced[i].samples));
    count += 1;
  }
  return {shown / std::max(truth, 1e-9f), std::sqrt(std::max(squares / std::max(count, 1.0f), 0.0f))};
}

ShadowError shadowError(std::span<const TracedPixel> traced, std::span<const DrawnPixel> drawn) {
  ShadowError error;
  Vector4f count = Vector4f::Zero();
  for (std::size_t i = 0; i < traced.size(); ++i) {
    if (!bothFull(traced[i].cover, drawn[i].cover)) continue;
    for (int k = 0; k < 4; ++k) {
      const float truth = traced[i].lit[k];
      if (truth < std::exp(-2.0f)) continue;
      const float off = drawn[i].lit[k] / drawn[i].cover - truth;
      error.rms[k] += off * off - noiseOf(truth, static_cast<float>(traced[i].samples) * traced[i].cover);
      error.bias[k] += off;
      count[k] += 1;
    }
  }
  count = count.cwiseMax(1.0f);
  error.bias = error.bias.cwiseQuotient(count);
  error.rms = error.rms.cwiseQuotient(count).cwiseMax(0.0f).cwiseSqrt();
  return error;
}

Leaks hairLeaks(std::span<const TracedPixel> traced, std::span<const DrawnPixel> drawn) {
  Leaks leaks;
  for (std::size_t i = 0; i < traced.size(); ++i) {
    if (!bothFull(traced[i].cover, drawn[i].cover)) continue;
    for (int k = 0; k < 4; ++k)
      if (traced[i].lit[k] == 0) addLeak(k, drawn[i].lit[k] / drawn[i].cover, leaks);
  }
  return meansOf(leaks);
}

Leaks skinLeaks(std::span<const TracedPixel> traced, std::span<const DrawnPixel> drawn) {
  Leaks leaks;
  for (std::size_t i = 0; i < traced.size(); ++i) {
    for (int k = 0; k < 4; ++k)
      if (bothFull(traced[i].skin[k], drawn[i].skin) && traced[i].skin_lit[k] == 0)
        addLeak(k, drawn[i].skin_lit[k] / drawn[i].skin, leaks);
  }
  return meansOf(leaks);
}

LightError lightError(std::span<const TracedPixel> traced, std::span<const DrawnPixel> drawn,
                      std::span<const Vector3f> single, std::span<const Vector3f> full) {
  LightError error;
  Vector3f truth_single = Vector3f::Zero(), truth = Vector3f::Zero(), variance = Vector3f::Zero();
  float squares = 0, count = 0;
  for (std::size_t i = 0; i < traced.size(); ++i) {
    if (!bothFull(traced[i].cover, drawn[i].cover)) continue;
    error.single += single[i] / drawn[i].cover;
    error.full += full[i] / drawn[i].cover;
    truth_single += traced[i].single;
    truth += traced[i].full;
    variance += traced[i].full_variance;
    const float off = full[i].y() / drawn[i].cover - traced[i].full.y();
    squares += off * off - traced[i].full_variance.y();
    count += 1;
  }
  error.single = error.single.cwiseQuotient(truth_single.cwiseMax(1e-9f));
  error.full = error.full.cwiseQuotient(truth.cwiseMax(1e-9f));
  error.noise = variance.cwiseSqrt().cwiseQuotient(truth.cwiseMax(1e-9f));
  error.spread =
      std::sqrt(std::max(squares / std::max(count, 1.0f), 0.0f)) / std::max(truth.y() / std::max(count, 1.0f), 1e-9f);
  return error;
}

}  // namespace reference

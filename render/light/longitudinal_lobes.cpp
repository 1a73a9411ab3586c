#include "render/light/longitudinal_lobes.h"

#include <algorithm>
#include <cmath>

namespace render {
namespace {

constexpr int kNodes = shared::kScatterPhi, kHalf = kNodes / 2;
constexpr int kQuadrature = 4 * kNodes;  // inclinations of integrals: finer than the narrowest lobe
constexpr int kSweeps = 40;

struct Inclination {
  float theta, cosine, weight;  // weight: cos^2 theta times the step
  int node;                     // between this node and the next
  float into;
};

const std::array<Inclination, kQuadrature>& quadrature() {
  static const std::array<Inclination, kQuadrature> points = [] {
    std::array<Inclination, kQuadrature> result{};
    for (int q = 0; q < kQuadrature; ++q) {
      const float u = (q + 0.5f) / kQuadrature, theta = kPi * (u - 0.5f), at = u * (kNodes - 1);
      const int node = std::min(static_cast<int>(at), kNodes - 2);
      const float cosine = std::cos(theta);
      result[q] = {theta, cosine, cosine * cosine * kPi / kQuadrature, node, at - static_cast<float>(node)};
    }
    return result;
  }();
  return points;
}

float nodeAngle(int node) {
  return kPi * (static_cast<float>(node) / (kNodes - 1) - 0.5f);
}

using Norms = std::array<float, kNodes>;

float between(const Norms& norms, const Inclination& at) {
  return (1 - at.into) * norms[at.node] + at.into * norms[at.node + 1];
}

// a of a lobe without shift: symmetric scaling of its matrix to unit row sums (Sinkhorn and Knopp 1967). Inclinations
// of both signs have one norm.
Norms normOf(float deviation) {
  std::array<std::array<float, kHalf>, kHalf> matrix{};
  for (int i = 0; i < kHalf; ++i) {
    const float theta = nodeAngle(i), cosine = std::max(std::cos(theta), 0.0f);
    for (const Inclination& q : quadrature()) {
      const float k = q.weight * longitudinalShape(0.5f * (theta + q.theta), cosine * q.cosine, deviation);
      for (int side = 0; side < 2; ++side) {
        const int node = q.node + side;
        matrix[i][std::min(node, kNodes - 1 - node)] += k * (side == 0 ? 1 - q.into : q.into);
      }
    }
  }
  std::array<float, kHalf> a;
  a.fill(1);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    std::array<float, kHalf> sum{};
    for (int i = 0; i < kHalf; ++i) {
      for (int j = 0; j < kHalf; ++j) sum[i] += matrix[i][j] * a[j];
    }
    for (int i = 0; i < kHalf; ++i) a[i] /= std::sqrt(std::max(sum[i] * a[i], 1e-20f));
  }
  Norms norms;
  for (int i = 0; i < kNodes; ++i) norms[i] = a[std::min(i, kNodes - 1 - i)];
  return norms;
}

float shareAt(const std::array<float, shared::kScatterTheta>& share, float cos_d) {
  const float at = cos_d * (shared::kScatterTheta - 1);
  const int row = std::min(static_cast<int>(at), shared::kScatterTheta - 2);
  const float into = at - static_cast<float>(row);
  return (1 - into) * share[row] + into * share[row + 1];
}

}  // namespace

float longitudinalShape(float half_angle, float cos_product, float deviation) {
  const float v = 4 * deviation * deviation, sine = std::sin(half_angle);
  return std::exp(-2 * sine * sine / v) / (cos_product + shared::kGrazing * v);
}

std::array<float, kLobes> lobeShifts(float cuticle_angle) {
  return {cuticle_angle, -0.5f * cuticle_angle, -1.5f * cuticle_angle};
}

LongitudinalLobes tabulateInclinations(const std::array<float, kLobes>& deviations, float cuticle_angle,
                                       const AzimuthalLobes& azimuth) {
  const std::array<float, kLobes> shifts = lobeShifts(cuticle_angle);
  const std::array<Norms, 4> norms{normOf(deviations[0]), normOf(deviations[1]), normOf(deviations[2]),
                                   normOf(shared::kVolumeSpread)};
  LongitudinalLobes result;
  for (int i = 0; i < kNodes; ++i) {
    for (int lobe = 0; lobe < 4; ++lobe) result.norm[i][lobe] = norms[lobe][i];
    const float theta = nodeAngle(i), cosine = std::max(std::cos(theta), 0.0f);
    float sum = 0;
    for (const Inclination& q : quadrature()) {
      const float half_angle = 0.5f * (theta + q.theta), cos_d = std::cos(0.5f * (theta - q.theta));
      for (int lobe = 0; lobe < kLobes; ++lobe) {
        sum += q.weight * norms[lobe][i] * between(norms[lobe], q) * shareAt(azimuth.share[lobe], cos_d) *
               longitudinalShape(half_angle + shifts[lobe] * cos_d, cosine * q.cosine, deviations[lobe]);
      }
    }
    result.eye[i] = 1 / std::max(sum, 1e-6f);
  }
  return result;
}

}  // namespace render

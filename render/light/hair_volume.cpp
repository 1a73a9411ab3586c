// Legend: psi azimuth that light travels in (0 into the slab), mu its cosine, I(psi) radiance, P what a fibre makes of
// I, t optical depth: mu dI/dt = -I + P I + source exp(-t). Even in psi, so psi in (0, pi) is enough.
#include "render/light/hair_volume.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace render {
namespace {

using shared::kScatterPhi;
using shared::kVolumeSteps;

constexpr int kDirections = 8;
constexpr double kStep = std::numbers::pi / kDirections;
constexpr double kStays = 1 - kSideLoss;
constexpr double kLargestAlbedo = 1 - 1e-4;  // without loss two solutions of the equations fall together
// Sizes are told when it runs: with sizes that are types, this file takes half a minute to compile.
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kDirections, kDirections>;
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kDirections, 1>;

double direction(int j) {
  return (j + 0.5) * kStep;
}

// N of one channel at normal incidence, all lobes.
struct Azimuth {
  std::array<double, kScatterPhi> value{};
  double albedo = 0;

  Azimuth(const AzimuthalLobes& lobes, int channel) {
    for (int j = 0; j < kScatterPhi; ++j) {
      for (int lobe = 0; lobe < kLobes; ++lobe)
        value[j] += lobes.at(lobe, shared::kScatterTheta - 1, j)[static_cast<std::size_t>(channel)];
      albedo += azimuthWeight(j) * value[j];
    }
    albedo = std::clamp(albedo, 1e-6, kLargestAlbedo);
  }

  // Mean around an angle, over the width of a direction.
  double around(double phi) const {
    constexpr int kSamples = 5;
    double sum = 0;
    for (int k = 0; k < kSamples; ++k) {
      const double x = std::abs(std::remainder(phi + kStep * ((k + 0.5) / kSamples - 0.5), 2 * std::numbers::pi));
      const double at = x / std::numbers::pi * (kScatterPhi - 1);
      const int j = std::min(static_cast<int>(at), kScatterPhi - 2);
      sum += value[j] + (at - j) * (value[j + 1] - value[j]);
    }
    return sum / kSamples;
  }
};

// The solutions of the equations of one channel: modes exp(lambda t), and a part that follows the light itself.
class Slab {
 public:
  explicit Slab(const Azimuth& azimuth) {
    Vector source(kDirections);
    for (int to = 0; to < kDirections; ++to) {
      mu_[to] = std::cos(direction(to));
      source[to] = azimuth.around(direction(to) - std::numbers::pi);
      for (int from = 0; from < kDirections; ++from) {
        scatter_(to, from) = azimuth.around(direction(to) - direction(from) - std::numbers::pi) +
                             azimuth.around(direction(to) + direction(from) - std::numbers::pi);
      }
    }
    source *= kStays * azimuth.albedo / (2 * kStep * source.sum());
    scatter_ *= azimuth.albedo / scatter_.col(0).sum();  // symmetric, and all its columns have one sum
    // A mode v of rate r: mu r v = -loss v. With loss = L L^T, L^-1 mu L^-T has the eigenvalue -1 / r for L^T v.
    const Matrix loss = Matrix::Identity(kDirections, kDirections) - kStays * scatter_;
    const Eigen::LLT<Matrix> factor(loss);
    const Matrix half = factor.matrixL().solve(Matrix(mu_.asDiagonal()));
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(factor.matrixL().solve(half.transpose()));
    rate_ = -eigen.eigenvalues().cwiseInverse();
    modes_ = factor.matrixU().solve(eigen.eigenvectors());
    follows_ = (loss - Matrix(mu_.asDiagonal())).partialPivLu().solve(source);
  }

  // What a fibre at depth `front` sends on, by direction.
  Vector sentOn(double front, double behind) const {
    const double thickness = front + behind;
    const Matrix at_front = modesAt(0, thickness), at_back = modesAt(thickness, thickness);
    Matrix edges(kDirections, kDirections);
    Vector none(kDirections);
    for (int j = 0; j < kDirections; ++j) {
      edges.row(j) = mu_[j] > 0 ? at_front.row(j) : at_back.row(j);
      none[j] = mu_[j] > 0 ? -follows_[j] : -follows_[j] * std::exp(-thickness);
    }
    const Vector amount = edges.partialPivLu().solve(none);
    return scatter_ * (modesAt(front, thickness) * amount + follows_ * std::exp(-front));
  }

 private:
  // Modes that grow are measured from the back, so that none overflows.
  Matrix modesAt(double depth, double thickness) const {
    Vector size(kDirections);
    for (int k = 0; k < kDirections; ++k)
      size[k] = std::exp(rate_[k] > 0 ? rate_[k] * (depth - thickness) : rate_[k] * depth);
    return modes_ * size.asDiagonal();
  }

  Vector mu_{kDirections}, rate_, follows_;
  Matrix scatter_{kDirections, kDirections}, modes_;
};

// Least squares by the powers of the cosine of the azimuth between light and eye, which is -mu.
Matrix quadraticFit() {
  Matrix powers(kDirections, 3);
  for (int j = 0; j < kDirections; ++j) {
    const double x = -std::cos(direction(j));
    powers.row(j) << 1, x, x * x;
  }
  const Matrix normal = powers.transpose() * powers;
  return normal.partialPivLu().solve(powers.transpose());
}

double depthOf(int step) {
  return shared::kVolumeDepth * step / (kVolumeSteps - step);
}

}  // namespace

std::vector<VolumeLight> tabulateVolume(const AzimuthalLobes& azimuth) {
  static const Matrix fit = quadraticFit();
  std::vector<VolumeLight> table(static_cast<std::size_t>(kVolumeSteps * kVolumeSteps));
  for (int channel = 0; channel < 3; ++channel) {
    const Slab slab(Azimuth(azimuth, channel));
    for (int behind = 0; behind < kVolumeSteps; ++behind) {
      for (int front = 0; front < kVolumeSteps; ++front) {
        if (behind + front == 0) continue;
        const Eigen::Vector3d powers = fit * slab.sentOn(depthOf(front), depthOf(behind));
        VolumeLight& light = table[static_cast<std::size_t>(behind * kVolumeSteps + front)];
        for (int k = 0; k < 3; ++k) light.power[k][static_cast<std::size_t>(channel)] = static_cast<float>(powers[k]);
      }
    }
  }
  return table;
}

}  // namespace render

#include "app/groom/fit/strand_samples.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/files/length_units.h"
#include "app/files/median.h"

namespace app {
namespace {

using Eigen::Vector3f;

constexpr int kFine = 4;               // steps between two samples that a sample is the mean of
constexpr float kShortest = 0.001f;    // m
constexpr float kFarRoot = 4;          // medians: further out is none of the head's roots
constexpr double kHeadSpread = 0.075;  // m, root mean square of a head's roots about their middle

}  // namespace

double lineLength(std::span<const Vector3f> line) {
  double length = 0;
  for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  return length;
}

void resample(std::span<const Vector3f> line, std::span<Vector3f> even) {
  const auto step = static_cast<float>(lineLength(line) / static_cast<double>(even.size() - 1));
  std::size_t segment = 0;
  float passed = 0, here = (line[1] - line[0]).norm();
  for (std::size_t k = 0; k + 1 < even.size(); ++k) {
    const float wanted = step * static_cast<float>(k);
    while (passed + here < wanted && segment + 2 < line.size()) {
      passed += here;
      ++segment;
      here = (line[segment + 1] - line[segment]).norm();
    }
    const float share = here > 0 ? std::clamp((wanted - passed) / here, 0.0f, 1.0f) : 0;
    even[k] = line[segment] + share * (line[segment + 1] - line[segment]);
  }
  even.back() = line.back();
}

StrandSamples sampleStrands(const Groom& groom, double scale, int count, std::size_t step) {
  StrandSamples out;
  out.count = count;
  out.at.reserve((groom.strandCount() / step + 1) * static_cast<std::size_t>(count));
  std::vector<Vector3f> line, fine(static_cast<std::size_t>((count - 1) * kFine + 1));
  const int last = static_cast<int>(fine.size()) - 1;
  for (std::size_t s = 0; s < groom.strandCount(); ++s) {
    line.clear();
    bool finite = true;
    for (const Vector3f& p : groom.strand(s)) {
      line.push_back(static_cast<float>(scale) * p);
      finite = finite && line.back().allFinite();
    }
    const double length = finite && line.size() > 1 ? lineLength(line) : 0;
    if (!(length > kShortest && length < 1e3)) {
      ++out.left_out;
      continue;
    }
    if (s % step != 0) continue;
    resample(line, fine);
    for (int k = 0; k < count; ++k) {
      const int middle = k * kFine, reach = std::min({kFine, middle, last - middle});
      Vector3f sum = Vector3f::Zero();
      float weights = 0;
      for (int d = -reach; d <= reach; ++d) {
        const float weight = static_cast<float>(reach + 1 - std::abs(d));
        sum += weight * fine[static_cast<std::size_t>(middle + d)];
        weights += weight;
      }
      out.at.push_back(sum / weights);
    }
    out.length.push_back(static_cast<float>(length));
    out.source.push_back(static_cast<int>(s));
  }
  return out;
}

double quantile(std::vector<float> values, double share) {
  if (values.empty()) return 0;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

namespace {

// Root mean square of the roots about their middle; of those within kFarRoot medians of the middle of each axis.
double rootSpread(const Groom& groom) {
  std::vector<Vector3f> roots;
  std::array<std::vector<float>, 3> along;
  for (std::size_t s = 0; s < groom.strandCount(); ++s) {
    if (groom.pointCount(s) == 0 || !groom.strand(s)[0].allFinite()) continue;
    roots.push_back(groom.strand(s)[0]);
    for (int axis = 0; axis < 3; ++axis) along[static_cast<std::size_t>(axis)].push_back(roots.back()[axis]);
  }
  const Vector3f middle(median(along[0]), median(along[1]), median(along[2]));
  std::vector<float> away;
  for (const Vector3f& root : roots) away.push_back((root - middle).norm());
  const float far = kFarRoot * median(away);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double square = 0, count = 0;
  for (std::size_t n = 0; n < roots.size(); ++n) {
    if (away[n] > far) continue;
    const Eigen::Vector3d root = roots[n].cast<double>(), step = root - mean;
    mean += step / ++count;
    square += step.dot(root - mean);
  }
  return count > 1 ? std::sqrt(square / count) : kHeadSpread;
}

}  // namespace

double inferUnit(const Groom& groom, std::string& name) {
  const double spread = rootSpread(groom);
  const LengthUnit* best = &kLengthUnits[0];
  const auto miss = [&](const LengthUnit& unit) {
    return std::abs(std::log(std::max(spread, 1e-30) * unit.metres / kHeadSpread));
  };
  for (const LengthUnit& unit : kLengthUnits) {
    if (miss(unit) < miss(*best)) best = &unit;
  }
  name = best->words;
  return best->metres;
}

}  // namespace app

#include "app/groom/fit/clump_fit.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "app/groom/fit/grown_groom.h"

namespace app {
namespace {

using Eigen::Vector3f;

constexpr float kClumpsClosed = 0.55f;  // share of the layers at which clumps are closed, shaders/common/strand.glsl
// m, bounds of the distances of roots.
constexpr std::array kApart{0.001f, 0.0015f, 0.002f, 0.003f, 0.004f, 0.006f, 0.008f, 0.012f, 0.016f, 0.024f};
constexpr std::size_t kClasses = kApart.size() - 1, kMaxInCell = 6, kMaxPairs = 1500, kModelPairs = 300,
                      kMinClassPairs = 60, kMaxStrands = 60000;
constexpr std::size_t kPairStride = 7919;  // a prime: strands in their order may lie side by side
constexpr float kAcross = 0.5f;            // of a pair's distance that lies across the hair, where it is used
constexpr std::array kClumpSizes{0.0035, 0.005, 0.007, 0.0095, 0.0125, 0.017, 0.024};  // m
constexpr std::array kWanders{0.0, 0.001, 0.002, 0.003, 0.005};                        // m, as render::HairLook::offset
constexpr std::array kLocks{0.0, 0.15, 0.3, 0.45};
constexpr int kClumpSteps = 10, kModelStrands = 4000, kModelPoints = 25;
constexpr std::array kQuantiles{0.15, 0.3, 0.5};  // quantiles that are compared
constexpr double kLeastRatio = 0.05;              // is added to ratios before their logarithms are taken
// What looks that explain quantiles alike are told apart by: a clump of 1 has to explain so much of the squared misses,
// a lock of 1 this share of them; and so much more for the square of a size's logarithm off the usual.
constexpr double kClumpCost = 0.02, kLockShare = 0.3, kSizeCost = 0.03, kUsualSize = 0.011;
constexpr float kSharedReach = 0.6f;  // of a clump's size: pairs that share one more often than not

float acrossHair(const Vector3f& gap, const Vector3f& along) {
  const Vector3f unit = along.stableNormalized();
  return (gap - unit.dot(gap) * unit).norm();
}

struct AtClosing {
  std::vector<Vector3f> root, at, along;  // m; unit: where clumps are closed
};

struct RootPair {
  std::size_t one, other;
};
using RootPairs = std::array<std::vector<RootPair>, kClasses>;

RootPairs pairsOf(const std::vector<Vector3f>& roots) {
  RootPairs all;
  for (std::size_t c = 0; c < kClasses; ++c) {
    std::map<std::array<int, 3>, std::vector<std::size_t>> cells;
    for (std::size_t n = 0; n < roots.size() && all[c].size() < kMaxPairs; ++n) {
      const std::size_t s = roots.size() % kPairStride == 0 ? n : n * kPairStride % roots.size();
      std::array<int, 3> cell{};
      for (std::size_t k = 0; k < 3; ++k)
        cell[k] = static_cast<int>(std::floor(roots[s][static_cast<int>(k)] / kApart[c + 1]));
      std::vector<std::size_t>& seen = cells[cell];
      for (const std::size_t other : seen) {
        const float apart = (roots[s] - roots[other]).norm();
        if (apart >= kApart[c] && apart < kApart[c + 1]) all[c].push_back({other, s});
      }
      if (seen.size() < kMaxInCell) seen.push_back(s);
    }
  }
  return all;
}

using Quantiles = std::array<double, kQuantiles.size()>;

Quantiles logQuantiles(const std::vector<float>& ratios) {
  Quantiles logs{};
  for (std::size_t k = 0; k < logs.size(); ++k) logs[k] = std::log(quantile(ratios, kQuantiles[k]) + kLeastRatio);
  return logs;
}

// The given strands and those that grow in their places, as far as they reach.
struct GivenAtClosing {
  AtClosing strands, grown;
  std::vector<int> face;
  double share = kClumpsClosed;  // of the grown ones' length at which they are held against each other, in the median
};

GivenAtClosing givenStrands(const StrandSamples& samples, const HairFit& fit, const GrowthMap& growth) {
  GivenAtClosing out;
  std::vector<float> shares;
  const auto layers = static_cast<float>(fit.knots.size() - 1);
  std::vector<Vector3f> line(40), whole(40);
  const std::size_t step = 1 + samples.strandCount() / kMaxStrands;
  for (std::size_t s = 0; s < samples.strandCount(); s += step) {
    const auto strand = samples.strand(s);
    const RootPlace& root = fit.strands[s].root;
    growStrand(fit, growth, {root, kClumpsClosed * layers}, line);
    growStrand(fit, growth, {root, layers}, whole);
    const double way = lineLength(line), at = way / lineLength(strand) * (samples.count - 1);
    shares.push_back(static_cast<float>(way / std::max(lineLength(whole), 1e-6)));
    if (!(at < samples.count - 1)) continue;
    const auto k = static_cast<std::size_t>(at);
    const Vector3f along = strand[k + 1] - strand[k];
    out.strands.root.push_back(strand[0]);
    out.strands.at.push_back(strand[k] + static_cast<float>(at - static_cast<double>(k)) * along);
    out.strands.along.push_back(along.stableNormalized());
    out.grown.at.push_back(line.back());
    out.grown.along.push_back((line.back() - line[line.size() - 2]).stableNormalized());
    out.face.push_back(root.face);
  }
  out.share = quantile(std::move(shares), 0.5);
  return out;
}

std::vector<ClumpPair> ratiosOf(const GivenAtClosing& given, const std::vector<RootPair>& pairs) {
  std::vector<ClumpPair> out;
  const auto between = [](const AtClosing& strands, const RootPair& pair, float& all) {
    const Vector3f gap = strands.at[pair.one] - strands.at[pair.other];
    all = gap.norm();
    return acrossHair(gap, strands.along[pair.one] + strands.along[pair.other]);
  };
  for (const RootPair& pair : pairs) {
    float all = 0, unused = 0;
    const float grown = between(given.grown, pair, all);
    if (!(grown > kAcross * all)) continue;
    out.push_back({given.face[pair.one], (given.strands.root[pair.one] - given.strands.root[pair.other]).norm(),
                   between(given.strands, pair, unused) / grown});
  }
  return out;
}

// Strands with all or none of what draws them together, or with wander alone.
class GroupModel {
 public:
  GroupModel(const HairFit& fit, double share) : fit_(fit), share_(share) {
    plain_ = grow(0, 0, 0);
    noise_ = grow(0, 0, kWanders.back());
    pairs_ = pairsOf(plain_.root);
  }

  // What draws strands together is linear in each of the two pulls: between four corners it is interpolated.
  void setSize(double size) {
    size_ = size;
    std::array<AtClosing, 4> corner;
    for (unsigned k = 0; k < corner.size(); ++k) corner[k] = grow(k & 1u, k >> 1u, 0);
    for (std::size_t c = 0; c < kClasses; ++c) {
      gaps_[c].clear();
      for (const RootPair& pair : pairs_[c]) {
        if (gaps_[c].size() == kModelPairs) break;
        const auto gap = [&](const AtClosing& of) { return Vector3f(of.at[pair.one] - of.at[pair.other]); };
        Gap one;
        const Vector3f plain = gap(plain_);
        one.along = plain_.along[pair.one] + plain_.along[pair.other];
        one.grown = acrossHair(plain, one.along);
        if (!(one.grown > kAcross * plain.norm())) continue;
        for (std::size_t k = 0; k < corner.size(); ++k) one.at[k] = gap(corner[k]);
        one.noise = gap(noise_) - plain;
        gaps_[c].push_back(one);
      }
    }
  }

  std::vector<float> ratios(std::size_t in_class, double clump, double lock, double noise) const {
    std::array<float, 4> weight{};
    for (unsigned k = 0; k < weight.size(); ++k)
      weight[k] = static_cast<float>((k & 1u ? clump : 1 - clump) * (k >> 1u ? lock : 1 - lock));
    std::vector<float> out;
    for (const Gap& gap : gaps_[in_class]) {
      Vector3f now = static_cast<float>(noise / kWanders.back()) * gap.noise;
      for (std::size_t k = 0; k < weight.size(); ++k) now += weight[k] * gap.at[k];
      out.push_back(acrossHair(now, gap.along) / gap.grown);
    }
    return out;
  }

 private:
  struct Gap {
    Vector3f along, noise;
    std::array<Vector3f, 4> at;
    float grown = 1;
  };

  AtClosing grow(double clump, double lock, double wander) const {
    render::HairLook look;
    look.length_variation = look.wisp = look.drift = look.root_spread = look.curl_radius = look.wave_height =
        look.frizz = 0;
    look.flyaways = look.hairline = look.baby_hairs = 0;
    look.clump = static_cast<float>(clump);
    look.lock = static_cast<float>(lock);
    look.offset = static_cast<float>(wander);
    look.clump_size = static_cast<float>(size_);
    const Groom groom = growGroom(fit_.shape, look, kModelStrands, kModelPoints);
    const auto k = static_cast<std::size_t>(share_ * (kModelPoints - 2));
    AtClosing out;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
      const auto strand = groom.strand(s);
      out.root.push_back(strand[0]);
      out.at.push_back(strand[k]);
      out.along.push_back((strand[k + 1] - strand[k]).stableNormalized());
    }
    return out;
  }

  const HairFit& fit_;
  double share_, size_ = kClumpSizes[0];
  AtClosing plain_, noise_;
  RootPairs pairs_;
  std::array<std::vector<Gap>, kClasses> gaps_;
};

using WantedLogs = std::array<std::vector<double>, kClasses>;  // logarithms of quantiles; empty: too few pairs

double missOf(const GroupModel& model, const WantedLogs& wanted, double clump, double lock, double noise) {
  double miss = 0;
  for (std::size_t c = 0; c < kClasses; ++c) {
    if (wanted[c].empty()) continue;
    const std::vector<float> ratios = model.ratios(c, clump, lock, noise);
    if (ratios.size() < kMinClassPairs) continue;
    const Quantiles logs = logQuantiles(ratios);
    for (std::size_t k = 0; k < logs.size(); ++k) miss += (logs[k] - wanted[c][k]) * (logs[k] - wanted[c][k]);
  }
  return miss * (1 + kLockShare * lock) + kClumpCost * clump;
}

// Tries all pulls and wanders at the model's size; returns the least miss, and what has it.
double tryPulls(const GroupModel& model, const WantedLogs& wanted, ClumpFit& out) {
  double least = std::numeric_limits<double>::max();
  for (const double lock : kLocks)
    for (const double noise : kWanders)
      for (int step = 0; step <= kClumpSteps; ++step) {
        const double clump = static_cast<double>(step) / kClumpSteps;
        const double miss = missOf(model, wanted, clump, lock, noise);
        if (miss >= least) continue;
        least = miss;
        out.clump = clump, out.lock = lock;
      }
  return least;
}

}  // namespace

ClumpFit fitClumps(const StrandSamples& strands, const HairFit& fit, const GrowthMap& growth) {
  const GivenAtClosing given = givenStrands(strands, fit, growth);
  const RootPairs pairs = pairsOf(given.strands.root);
  std::array<std::vector<ClumpPair>, kClasses> all;
  WantedLogs wanted;
  for (std::size_t c = 0; c < kClasses; ++c) {
    all[c] = ratiosOf(given, pairs[c]);
    std::vector<float> ratios;
    for (const ClumpPair& pair : all[c]) ratios.push_back(pair.ratio);
    if (ratios.size() < kMinClassPairs) continue;
    const Quantiles logs = logQuantiles(ratios);
    wanted[c].assign(logs.begin(), logs.end());
  }
  if (std::ranges::all_of(wanted, &std::vector<double>::empty)) return {};
  GroupModel model(fit, given.share);
  ClumpFit best;
  double least = std::numeric_limits<double>::max();
  for (const double size : kClumpSizes) {
    model.setSize(size);
    ClumpFit here;
    const double off = std::log(size / kUsualSize);
    const double miss = tryPulls(model, wanted, here) + kSizeCost * off * off;
    if (miss >= least) continue;
    least = miss;
    best = here;
    best.size = size;
  }
  for (std::size_t c = 0; c < kClasses && kApart[c] < kSharedReach * best.size; ++c)
    best.pairs.insert(best.pairs.end(), all[c].begin(), all[c].end());
  return best;
}

}  // namespace app

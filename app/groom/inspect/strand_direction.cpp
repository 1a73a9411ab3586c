#include "app/groom/inspect/strand_direction.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace app {

using Eigen::Vector3f;

namespace {

constexpr float kSkullSpread = 0.08f, kSkullCoverage = 0.03f;  // SphereFit: of roots that lie about a skull
constexpr float kOffSkull = 0.25f, kOnSkull = 0.15f;           // radii from the skull: no root, and a root
constexpr double kMaxOff = 0.05;                               // of the roots, where directions are certain
constexpr int kTurningRounds = 4;
constexpr std::size_t kByChance = 500;  // of so many strands one may end on the skull and root off it

struct RootsAndTips {
  std::vector<Vector3f> root, tip;
  void swap(std::size_t n) { std::swap(root[n], tip[n]); }
};

// Of two strands whose ends are a to b and c to d.
struct Likeness {
  float unlike;   // 0 to 1; 0: both ends meet, 1: it cannot be told which way they run beside each other
  bool opposite;  // one runs against the other
};

Likeness likeness(const Vector3f& a, const Vector3f& b, const Vector3f& c, const Vector3f& d) {
  const float same = (a - c).squaredNorm() + (b - d).squaredNorm();
  const float cross = (a - d).squaredNorm() + (b - c).squaredNorm();
  const float most = std::max(same, cross);
  return {most > 0 ? std::min(same, cross) / most : 0, cross < same};
}

// Per strand: whether it runs against most others. A tree of the clearest pairs hands the direction on (Prim).
std::vector<bool> againstOthers(const StrandEnds& ends) {
  const std::size_t count = ends.first.size();
  std::vector<bool> turned(count, false), done(count, false);
  std::vector<float> least(count, std::numeric_limits<float>::infinity());
  std::size_t here = 0, against = 0;
  for (std::size_t reached = 1; reached < count; ++reached) {
    done[here] = true;
    std::size_t next = count;
    for (std::size_t n = 0; n < count; ++n) {
      if (done[n]) continue;
      const Likeness one = likeness(ends.first[here], ends.last[here], ends.first[n], ends.last[n]);
      if (one.unlike < least[n]) {
        least[n] = one.unlike;
        turned[n] = turned[here] != one.opposite;
      }
      if (next == count || least[n] < least[next]) next = n;
    }
    here = next;
    against += turned[here];
  }
  if (2 * against > count) turned.flip();
  return turned;
}

float shareOutside(const SphereFit& sphere, const std::vector<Vector3f>& points) {
  const auto outside = std::ranges::count_if(
      points, [&](const Vector3f& p) { return (p - sphere.center).norm() > 0.95f * sphere.radius; });
  return static_cast<float>(outside) / static_cast<float>(points.size());
}

// Turns all strands where the tips are the roots: the tips then lie about a skull that holds less or that the strands
// leave, and the roots lie further from a sphere.
bool turnAllStrands(RootsAndTips& ends, SphereFit& skull) {
  const SphereFit roots = skull = fitSphere(ends.root), tips = fitSphere(ends.tip);
  const float out = shareOutside(roots, ends.tip), in = shareOutside(tips, ends.root);
  const bool skull_at_tips = tips.spread < kSkullSpread && tips.coverage > kSkullCoverage && in > out - 0.3f;
  if (!skull_at_tips || !(tips.radius < roots.radius / 1.1f || roots.coverage < kSkullCoverage)) return false;
  skull = tips;
  std::swap(ends.root, ends.tip);
  return true;
}

float offSkull(const SphereFit& skull, const Vector3f& point) {
  return std::abs((point - skull.center).norm() / skull.radius - 1);
}

// Single strands whose roots are clearly off the skull, and whose tips are on it.
void turnSingleStrands(RootsAndTips& ends, StrandDirections& out) {
  for (int round = 0; round < kTurningRounds; ++round) {
    bool any = false;
    for (std::size_t n = 0; n < ends.root.size(); ++n) {
      if (offSkull(out.skull, ends.root[n]) < kOffSkull || offSkull(out.skull, ends.tip[n]) > kOnSkull) continue;
      ends.swap(n);
      out.turned[n] = !out.turned[n];
      any = true;
    }
    if (!any) return;
    out.skull = fitSphere(ends.root);
  }
}

// Mean distance of the roots from the skull, in the file's unit.
double meanOff(const SphereFit& skull, const std::vector<Vector3f>& roots) {
  double sum = 0;
  for (const Vector3f& root : roots) sum += std::abs((root - skull.center).norm() - skull.radius);
  return sum / static_cast<double>(roots.size());
}

StrandDirections directionsFrom(const StrandEnds& given, std::vector<bool> turned, double& off) {
  RootsAndTips ends{given.first, given.last};
  for (std::size_t n = 0; n < turned.size(); ++n) {
    if (turned[n]) ends.swap(n);
  }
  StrandDirections out;
  out.turned = std::move(turned);
  if (turnAllStrands(ends, out.skull)) out.turned.flip();
  turnSingleStrands(ends, out);
  off = meanOff(out.skull, ends.root);
  out.turned_count = static_cast<std::size_t>(std::ranges::count(out.turned, true));
  const std::size_t against = std::min(out.turned_count, out.turned.size() - out.turned_count);
  if (against * kByChance < out.turned.size()) {
    const bool all = out.turned_count > against;
    out.turned.assign(out.turned.size(), all);
    out.turned_count = all ? out.turned.size() : 0;
  }
  const auto far =
      std::ranges::count_if(ends.root, [&](const Vector3f& p) { return offSkull(out.skull, p) > kOffSkull; });
  out.certain = out.skull.spread < kSkullSpread && out.skull.coverage > kSkullCoverage &&
                static_cast<double>(far) <= kMaxOff * static_cast<double>(ends.root.size());
  return out;
}

}  // namespace

StrandDirections strandDirections(const StrandEnds& ends) {
  double off_given = 0, off_alike = 0;
  StrandDirections given = directionsFrom(ends, std::vector<bool>(ends.first.size(), false), off_given);
  StrandDirections alike = directionsFrom(ends, againstOthers(ends), off_alike);
  return off_alike < off_given ? alike : given;
}

std::vector<bool> backwardStrands(const Groom& groom) {
  std::vector<bool> backward(groom.strandCount(), false);
  const StrandEnds ends = strandEnds(groom, kMaxInspected);
  if (ends.first.size() < kMinRoots) return backward;
  const StrandDirections found = strandDirections(ends);
  std::vector<bool> looked_at(groom.strandCount(), false);
  for (std::size_t n = 0; n < ends.strands.size(); ++n) {
    looked_at[ends.strands[n]] = true;
    backward[ends.strands[n]] = found.turned[n];
  }
  const bool mostly = 2 * found.turned_count > found.turned.size();
  const bool alike = found.turned_count == 0 || found.turned_count == found.turned.size();
  for (std::size_t s = 0; s < groom.strandCount() && found.turned_count > 0; ++s) {
    if (looked_at[s] || groom.pointCount(s) == 0) continue;
    const Vector3f first = groom.strand(s).front(), last = groom.strand(s).back();
    const Vector3f &root = mostly ? last : first, &tip = mostly ? first : last;
    backward[s] = mostly;
    if (alike || offSkull(found.skull, tip) > offSkull(found.skull, root) + kOnSkull) continue;
    float least = std::numeric_limits<float>::infinity();
    for (std::size_t n = 0; n < ends.first.size(); ++n) {
      const Likeness one = likeness(first, last, ends.first[n], ends.last[n]);
      if (one.unlike >= least) continue;
      least = one.unlike;
      backward[s] = found.turned[n] != one.opposite;
    }
  }
  return backward;
}

}  // namespace app

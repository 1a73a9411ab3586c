#include "app/figure/skin_cover.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "app/figure/character_build.h"
#include "app/figure/cover_fit.h"
#include "app/figure/skin_samples.h"
#include "shaders/shared.h"

namespace app {
namespace {

constexpr std::size_t kMaxSamples = 3000;
constexpr int kMoments = 24;                      // of all clips together, beside the rest pose
constexpr float kFarGap = 0.05f;                  // m: all larger gaps are kept as this
const float kCovered = render::shared::kSkinGap;  // m: skin that sticks out less counts as covered
constexpr float kAllowed = 0.003f;                // m, likewise once there are many ellipsoids
constexpr double kPatch = 0.40;            // head heights: radius of the patch that an added ellipsoid begins with
constexpr double kSmaller = 0.6;           // of that, for a patch whose ellipsoid swallows too much
constexpr int kTries = 3, kMoreTries = 6;  // patches of one place; more once there are many ellipsoids
constexpr double kHold = 0.02;             // m, see fitCover
constexpr double kAround = 0.04;           // m: skin of another part so near may hide a place
constexpr double kHidden = 0.003;          // m under that
constexpr double kStraight = 0.7;          // cosine of the way there to that skin's normal, at least
constexpr std::size_t kMaxPoints = 400;    // of a fit's own
constexpr float kFits = 0.012f;            // m that skin may stick out at worst, below the chin, of ellipsoids that fit
constexpr double kUnfitShare = 0.05;       // of a joint's skin, the head's included, that may stick out farther
constexpr int kRounds = 3;                 // of setting unfit joints apart
constexpr float kBuried = 0.002f;  // m, that skin above the chin may lie deeper in an added ellipsoid than before

// Gaps (m) of every place, or of those at rest, to one ellipsoid.
using Gaps = std::vector<float>;

class Cover {
 public:
  explicit Cover(Character& character);
  void begin(int enough);
  std::vector<unsigned char> unfit() const;  // then, per joint that is not set apart
  CoverReport finish(int enough);

 private:
  Gaps gapsOf(const BodyEllipsoid& e) const { return gapsAt(e, skin_.world.size()); }
  Gaps restGapsOf(const BodyEllipsoid& e) const { return gapsAt(e, 1); }
  Gaps gapsAt(const BodyEllipsoid& e, std::size_t moments) const;
  float gapAt(const BodyEllipsoid& e, std::size_t place) const {
    return static_cast<float>(ellipsoidGap(e, skin_.inJoint(place, e.joint)));
  }
  void findNearest(std::size_t first);
  void findNearer(std::size_t e);
  void leaveOutHidden();
  std::vector<CoverPoint> pointsFor(const BodyEllipsoid& e, const Gaps& gaps, int number,
                                    const std::vector<int>& own) const;
  bool swallows(const BodyEllipsoid& e, const Gaps& gaps) const;
  bool refit(std::size_t e);
  void refitAdded();
  std::optional<BodyEllipsoid> patchAt(std::size_t place, double radius) const;
  bool add(std::size_t place, int tries);
  struct Pass {
    float least;  // m that skin may stick out
    int most, tries;
  };
  void coverAll(const Pass& pass);
  double over() const;
  bool wanted(std::size_t place) const {
    const SkinSample& sample = skin_.sampleOf(place);
    return skin_.reached[place] && !sample.of_head && !set_apart_[static_cast<std::size_t>(sample.joint)];
  }
  // Of the place that sticks out most and is asked for; none: all are covered.
  std::optional<std::size_t> worst(float least) const;

  Character& character_;
  PosedSkin skin_;
  CoverReport report_;
  std::size_t given_ = 0;                      // ellipsoids that were there
  std::vector<Gaps> gaps_;                     // per ellipsoid
  std::vector<float> nearest_gap_, head_gap_;  // per place; at rest, to the given ones, per sample
  std::vector<int> nearest_;                   // the ellipsoid, per place
  std::vector<float> given_gap_;               // both as the given ones alone leave them
  std::vector<int> given_nearest_;
  std::vector<unsigned char> given_up_;   // per sample
  std::vector<unsigned char> set_apart_;  // per joint: its ellipsoids do not fit
};

Cover::Cover(Character& character) : character_(character), skin_(poseSkin(character, kMaxSamples, kMoments)) {
  for (const BodyEllipsoid& e : character_.ellipsoids) gaps_.push_back(gapsOf(e));
  given_ = gaps_.size();
  set_apart_.resize(character_.skeleton.joints.size(), 0);
  for (const BodyEllipsoid& e : character_.ellipsoids)
    if (e.by_distances) set_apart_[static_cast<std::size_t>(e.joint)] = 1;
  nearest_gap_.assign(skin_.reached.size(), 1e9f);
  nearest_.assign(nearest_gap_.size(), -1);
  findNearest(0);
  given_gap_ = nearest_gap_;
  given_nearest_ = nearest_;
  head_gap_.assign(nearest_gap_.begin(), nearest_gap_.begin() + static_cast<std::ptrdiff_t>(skin_.samples.size()));
  given_up_.resize(skin_.samples.size(), 0);
  leaveOutHidden();
}

// Skin that sticks out of the ellipsoids but lies within another part's skin is out of hair's reach: pieces of a figure
// end in one another.
void Cover::leaveOutHidden() {
  for (std::size_t i = 0; i < nearest_gap_.size(); ++i) {
    if (nearest_gap_[i] <= kCovered || !skin_.reached[i]) continue;
    const std::vector<Vec3>& world = skin_.world[skin_.momentOf(i)];
    const Vec3& p = world[i % world.size()];
    double nearest = kAround * kAround;
    std::size_t other = world.size();
    for (std::size_t s = 0; s < world.size(); ++s) {
      const double apart = (world[s] - p).squaredNorm();
      if (apart < nearest && skin_.samples[s].joint != skin_.sampleOf(i).joint) nearest = apart, other = s;
    }
    if (other == world.size()) continue;
    const Vec3 normal = skin_.normalAt(skin_.momentOf(i) * world.size() + other);
    // Behind its nearest skin, not beside that skin's edge.
    if ((p - world[other]).dot(normal) < -std::max(kHidden, kStraight * std::sqrt(nearest))) skin_.reached[i] = 0;
  }
}

// At the first `moments`, of which number 0 is the rest pose.
Gaps Cover::gapsAt(const BodyEllipsoid& e, std::size_t moments) const {
  // A gap is at least (distance / largest radius - 1) times the smallest.
  const double beyond = e.radii.maxCoeff() * (1 + kFarGap / e.radii.minCoeff());
  Gaps gaps;
  gaps.reserve(moments * skin_.samples.size());
  for (std::size_t m = 0; m < moments; ++m) {
    const Rigid& to_joint = skin_.to_joint[m][static_cast<std::size_t>(e.joint)];
    for (const Vec3& world : skin_.world[m]) {
      const Vec3 p = to_joint * world;
      const bool far = (p - e.center).squaredNorm() > beyond * beyond;
      gaps.push_back(far ? kFarGap : static_cast<float>(ellipsoidGap(e, p)));
    }
  }
  return gaps;
}

void Cover::findNearest(std::size_t first) {
  for (std::size_t e = first; e < gaps_.size(); ++e) findNearer(e);
  // Of a place that is far from all of them only a bound is known yet.
  for (std::size_t i = 0; i < nearest_gap_.size(); ++i) {
    if (nearest_gap_[i] < kFarGap) continue;
    nearest_gap_[i] = 1e9f;
    for (std::size_t e = 0; e < gaps_.size(); ++e) {
      const float gap = gapAt(character_.ellipsoids[e], i);
      if (gap < nearest_gap_[i]) nearest_gap_[i] = gap, nearest_[i] = static_cast<int>(e);
    }
  }
}

void Cover::findNearer(std::size_t e) {
  for (std::size_t i = 0; i < nearest_gap_.size(); ++i) {
    if (gaps_[e][i] >= nearest_gap_[i]) continue;
    nearest_gap_[i] = gaps_[e][i];
    nearest_[i] = static_cast<int>(e);
  }
}

std::optional<std::size_t> Cover::worst(float least) const {
  std::optional<std::size_t> place;
  for (std::size_t i = 0; i < nearest_gap_.size(); ++i) {
    if (nearest_gap_[i] <= least || !wanted(i) || given_up_[i % skin_.samples.size()]) continue;
    least = nearest_gap_[i];
    place = i;
  }
  return place;
}

// Its own places, all that stick out and of the others as many as there is room for; every other sample at rest that is
// near or inside; and the air that it holds.
std::vector<CoverPoint> Cover::pointsFor(const BodyEllipsoid& e, const Gaps& gaps, int number,
                                         const std::vector<int>& own) const {
  std::vector<CoverPoint> points;
  std::vector<unsigned char> is_own(skin_.samples.size(), 0);
  const auto isOut = [&](int place) { return nearest_gap_[static_cast<std::size_t>(place)] > 0; };
  const auto out = static_cast<std::size_t>(std::ranges::count_if(own, isOut));
  const std::size_t room = out < kMaxPoints ? kMaxPoints - out : 1, step = (own.size() - out) / room + 1;
  std::size_t n = 0;
  for (const int place : own) {
    const auto i = static_cast<std::size_t>(place);
    is_own[i % is_own.size()] = 1;
    if (isOut(place) || n++ % step == 0) points.push_back({skin_.inJoint(i, e.joint), skin_.sampleOf(i).weight, true});
  }
  for (std::size_t i = 0; i < skin_.samples.size(); i += 2) {
    if (is_own[i] || gaps[i] > 0.02f) continue;
    // Skin that another ellipsoid buries deep is within the body: pieces of a figure end in one another.
    if (nearest_[i] != number && nearest_gap_[i] < -0.006f) continue;
    points.push_back({skin_.inJoint(i, e.joint), 2 * skin_.samples[i].weight, false});
  }
  const Rigid to_joint =
      character_.skeleton.joints[static_cast<std::size_t>(e.joint)].rest_world.inverse(Eigen::Isometry);
  for (const Vec3& air : skin_.air) {
    const Vec3 p = to_joint * air;
    if (ellipsoidGap(e, p) < 0.02) points.push_back({p, 4.0 / static_cast<double>(skin_.samples.size()), false});
  }
  return points;
}

bool Cover::swallows(const BodyEllipsoid& e, const Gaps& gaps) const {
  for (std::size_t i = 0; i < skin_.samples.size(); ++i) {
    if (skin_.samples[i].of_head && gaps[i] < std::min(head_gap_[i], 0.0f) - kBuried) return true;
  }
  const Rigid to_joint =
      character_.skeleton.joints[static_cast<std::size_t>(e.joint)].rest_world.inverse(Eigen::Isometry);
  return std::ranges::any_of(skin_.air, [&](const Vec3& air) { return ellipsoidGap(e, to_joint * air) < 0; });
}

// Returns whether it changed.
bool Cover::refit(std::size_t e) {
  std::vector<int> own;
  for (std::size_t i = 0; i < nearest_.size(); ++i) {
    if (wanted(i) && nearest_[i] == static_cast<int>(e) && nearest_gap_[i] > -0.008f)
      own.push_back(static_cast<int>(i));
  }
  if (own.size() < 8) return false;
  const BodyEllipsoid& now = character_.ellipsoids[e];
  const auto points = pointsFor(now, gaps_[e], static_cast<int>(e), own);
  const BodyEllipsoid next = fitCover(points, now, kHold * character_.scalp.head_height / 0.23);
  if (swallows(next, restGapsOf(next))) return false;
  character_.ellipsoids[e] = next;
  gaps_[e] = gapsOf(next);
  return true;
}

// Fitted to the skin around a place, as it lies at that place's moment.
std::optional<BodyEllipsoid> Cover::patchAt(std::size_t place, double radius) const {
  const std::size_t count = skin_.samples.size(), m = skin_.momentOf(place);
  const SkinSample& at = skin_.sampleOf(place);
  const Rigid to_joint =
      character_.skeleton.joints[static_cast<std::size_t>(at.joint)].rest_world.inverse(Eigen::Isometry);
  std::vector<FitPoint> around;
  std::vector<int> own;
  for (std::size_t s = 0; s < count; ++s) {
    const SkinSample& sample = skin_.samples[s];
    const bool other = (sample.rest - at.rest).norm() > radius || sample.normal.dot(at.normal) < 0.2;
    if (other || sample.of_head || nearest_gap_[m * count + s] < -0.001f) continue;
    around.push_back({to_joint * sample.rest, sample.weight});
    own.push_back(static_cast<int>(m * count + s));
  }
  BodyEllipsoid e;
  const Vec3 inward = to_joint.linear() * -at.normal;
  if (around.size() >= 6) {
    // As wide as the patch, and as deep under its middle as it is narrow.
    e = principalEllipsoid(around);
    const double depth = std::clamp(e.radii.sum() - e.radii.maxCoeff() - e.radii.minCoeff(), 0.008, 0.5 * radius);
    e.radii = e.radii.cwiseMax(depth);
    e.center += depth * inward;
  } else {
    e.radii = Vec3::Constant(0.25 * radius);
    e.center = to_joint * at.rest + 0.25 * radius * inward;
  }
  e.joint = at.joint;
  e.name = "cover_" + std::to_string(character_.ellipsoids.size());
  const auto points = pointsFor(e, restGapsOf(e), static_cast<int>(gaps_.size()), own);
  e = fitCover(points, e, 4 * kHold * character_.scalp.head_height / 0.23);
  if (swallows(e, restGapsOf(e))) return {};
  return e;
}

// An ellipsoid for the patch of skin around a place that sticks out. Returns whether less sticks out with it.
bool Cover::add(std::size_t place, int tries) {
  const float before = nearest_gap_[place];
  double radius = kPatch * character_.scalp.head_height;
  for (int attempt = 0; attempt < tries; ++attempt, radius *= kSmaller) {
    const std::optional<BodyEllipsoid> e = patchAt(place, radius);
    if (!e) continue;
    character_.ellipsoids.push_back(*e);
    gaps_.push_back(gapsOf(*e));
    if (gapAt(*e, place) < 0.5f * before) {
      findNearest(gaps_.size() - 1);
      return true;
    }
    character_.ellipsoids.pop_back();
    gaps_.pop_back();
  }
  return false;
}

// Fits the added ellipsoids that skin sticks out of anew.
void Cover::refitAdded() {
  std::vector<unsigned char> due(gaps_.size(), 0);
  for (std::size_t i = 0; i < nearest_.size(); ++i) {
    if (nearest_gap_[i] > kCovered && wanted(i)) due[static_cast<std::size_t>(nearest_[i])] = 1;
  }
  bool any = false;
  for (std::size_t e = given_; e < due.size(); ++e) {
    if (due[e]) any = refit(e) || any;
  }
  if (!any) return;
  nearest_gap_ = given_gap_;
  nearest_ = given_nearest_;
  findNearest(given_);
}

// m, of the rest pose's samples: the mean of how far they lie inside.
double Cover::over() const {
  double over = 0, weight = 0;
  for (std::size_t s = 0; s < skin_.samples.size(); ++s) {
    if (nearest_gap_[s] < -0.02f || skin_.samples[s].of_head) continue;
    over -= skin_.samples[s].weight * std::min(nearest_gap_[s], 0.0f);
    weight += skin_.samples[s].weight;
  }
  return over / std::max(weight, 1e-12);
}

// Adds ellipsoids until no skin that is asked for sticks out by more than `least`, or `most` have been added.
void Cover::coverAll(const Pass& pass) {
  given_up_.assign(given_up_.size(), 0);
  const std::size_t most = given_ + static_cast<std::size_t>(pass.most);
  for (auto place = worst(pass.least); place && gaps_.size() < most; place = worst(pass.least)) {
    if (!add(*place, pass.tries)) given_up_[*place % skin_.samples.size()] = 1;
    refitAdded();
  }
}

void Cover::begin(int enough) {
  if (skin_.samples.empty()) return;
  report_.over_before = over();
  if (const auto place = worst(0)) report_.before = nearest_gap_[*place];
  coverAll({kCovered, enough, kTries});
}

CoverReport Cover::finish(int enough) {
  if (skin_.samples.empty()) return report_;
  coverAll({kAllowed, 2 * enough, kMoreTries});
  given_up_.assign(given_up_.size(), 0);
  if (const auto place = worst(0)) {
    report_.after = nearest_gap_[*place];
    report_.where = character_.skeleton.joints[static_cast<std::size_t>(skin_.sampleOf(*place).joint)].name;
  }
  report_.added = static_cast<int>(gaps_.size() - given_);
  report_.over = over();
  return report_;
}

std::vector<unsigned char> Cover::unfit() const {
  std::vector<double> all(set_apart_.size(), 0), out(set_apart_.size(), 0);
  std::vector<unsigned char> unfit(set_apart_.size(), 0);
  for (std::size_t i = 0; i < nearest_gap_.size(); ++i) {
    const SkinSample& sample = skin_.sampleOf(i);
    const auto joint = static_cast<std::size_t>(sample.joint);
    if (!skin_.reached[i] || set_apart_[joint]) continue;
    all[joint] += sample.weight;
    if (nearest_gap_[i] <= kFits) continue;
    out[joint] += sample.weight;
    if (wanted(i)) unfit[joint] = 1;
  }
  for (std::size_t joint = 0; joint < unfit.size(); ++joint)
    if (out[joint] > kUnfitShare * all[joint]) unfit[joint] = 1;
  return unfit;
}

}  // namespace

CoverReport coverSkin(Character& character, int enough) {
  if (character.ellipsoids.empty() || character.mesh.positions.empty()) return {};
  std::vector<BodyEllipsoid> given = character.ellipsoids;
  std::string names;
  for (int round = 0;; ++round) {
    Cover cover(character);
    cover.begin(enough);
    const std::vector<unsigned char> unfit = cover.unfit();
    if (round == kRounds || std::ranges::find(unfit, 1) == unfit.end()) {
      CoverReport report = cover.finish(enough);
      report.unfit = names;
      return report;
    }
    for (BodyEllipsoid& e : given) {
      const auto joint = static_cast<std::size_t>(e.joint);
      if (!unfit[joint] || e.by_distances) continue;
      e.by_distances = true;
      const std::string& name = character.skeleton.joints[joint].name;
      if ((", " + names + ", ").find(", " + name + ", ") == std::string::npos)
        names += (names.empty() ? "" : ", ") + name;
    }
    character.ellipsoids = given;
  }
}

}  // namespace app

#include "app/styles/style_shorten.h"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <utility>

namespace app {

namespace {

constexpr double kShortGap = 0.0025;  // m, see untangle
constexpr double kShortFat = 0.002;   // with less, lengths are softened more
constexpr int kShortRounds = 5;       // of untangling
constexpr double kSteepest = 0.5;     // least length of a column over that of any of its root face

// Attempts, in turn: how fat prisms are before they are untangled. -0.2 is what untangling mends with moves of a few
// millimetres; from flatter ones it bends hair by centimetres, or never ends.
constexpr std::array kFlattest{-0.2, -0.07, 0.0};
constexpr double kRaise = 0.2;      // of the way to the longest column of a root face whose prisms are too flat
constexpr int kMostRaises = 60;     // softening is nearly done by then: 0.8^60
constexpr int kSweepsOfARaise = 2;  // that take as long
constexpr double kEqual = 0.98;     // shares of a root face that raising leaves alone

// Parts of the cut that are tried in turn where no softening leaves prisms.
constexpr std::array kParts{0.6, 0.3, 0.15};

// The column's points at the same shares of its first `share` of the way.
void shorten(std::span<Vec3> x, double share) {
  const std::vector<Vec3> old(x.begin(), x.end());
  std::vector<double> passed{0};
  for (std::size_t k = 1; k < old.size(); ++k) passed.push_back(passed.back() + (old[k] - old[k - 1]).norm());
  std::size_t segment = 1;
  for (std::size_t k = 1; k < old.size(); ++k) {
    const double place = share * passed[k];
    while (segment + 1 < old.size() && passed[segment] < place) ++segment;
    const double within = (place - passed[segment - 1]) / (passed[segment] - passed[segment - 1]);
    x[k] = old[segment - 1] + within * (old[segment] - old[segment - 1]);
  }
}

// Raises shares until none is less than kSteepest times one of the same root face.
void soften(const sim::HairMeshShape& shape, std::vector<double>& shares) {
  for (bool raised = true; raised;) {
    raised = false;
    for (const sim::RootFace& face : shape.root_faces) {
      double most = 0;
      for (int k = 0; k < face.corner_count; ++k)
        most = std::max(most, shares[static_cast<std::size_t>(face.columns[k])]);
      for (int k = 0; k < face.corner_count; ++k) {
        double& share = shares[static_cast<std::size_t>(face.columns[k])];
        raised |= share < kSteepest * most;
        share = std::max(share, kSteepest * most);
      }
    }
  }
}

// Raises the shares of root faces whose prisms are flatter than `fatness`; whether any was.
bool raiseWhereFlat(const sim::HairMeshShape& shape, double fatness, std::vector<double>& shares) {
  const std::vector<double> before = shares;
  bool any = false;
  for (const sim::RootFace& face : shape.root_faces) {
    double most = 0, least = 1;
    for (int k = 0; k < face.corner_count; ++k) {
      most = std::max(most, before[static_cast<std::size_t>(face.columns[k])]);
      least = std::min(least, before[static_cast<std::size_t>(face.columns[k])]);
    }
    if (least > kEqual * most || flattestOf(face, shape) >= fatness) continue;
    any = true;
    for (int k = 0; k < face.corner_count; ++k) {
      const auto column = static_cast<std::size_t>(face.columns[k]);
      shares[column] = std::max(shares[column], before[column] + kRaise * (most - before[column]));
    }
  }
  return any;
}

}  // namespace

Shortening::Shortening(const BodyDistance& body, double fatness, std::vector<double> shares, sim::HairMeshShape shape)
    : body_(body),
      whole_(shape.positions),
      shape_(std::move(shape)),
      shares_(std::move(shares)),
      untangling_(body_, fatness, kShortGap, shape_) {
  done_ = shares_.empty() || *std::ranges::min_element(shares_) >= 1;
  if (done_) return;
  soften(shape_, shares_);
  asked_ = shares_;
  beginAttempt();
}

void Shortening::cut() {
  shape_.positions = whole_;
  for (std::size_t c = 0; c < shares_.size(); ++c)
    shorten(std::span(shape_.positions)
                .subspan(static_cast<std::size_t>(shape_.column_first[c]),
                         static_cast<std::size_t>(shape_.columnLength(static_cast<int>(c)))),
            shares_[c]);
}

void Shortening::beginAttempt() {
  const auto attempt = static_cast<std::size_t>(attempt_);
  raising_ = attempt < kFlattest.size();
  raised_ = rounds_ = 0;
  if (!raising_) {
    done_ = attempt == kFlattest.size() + kParts.size();
    const double part = done_ ? 0 : kParts[attempt - kFlattest.size()];
    for (std::size_t c = 0; c < shares_.size(); ++c) shares_[c] = 1 - part * (1 - asked_[c]);
  }
  cut();
  if (!raising_) untangling_.begin();
}

int Shortening::raise() {
  raising_ = raised_++ < kMostRaises && raiseWhereFlat(shape_, kFlattest[static_cast<std::size_t>(attempt_)], shares_);
  if (raising_)
    cut();
  else
    untangling_.begin();
  return kSweepsOfARaise;
}

int Shortening::untangle(int sweeps) {
  const int made = untangling_.work(sweeps);
  if (!untangling_.done()) return made;
  done_ = untangling_.flattest() > kShortFat;
  if (!done_ && ++rounds_ < kShortRounds) untangling_.begin();
  if (!done_ && rounds_ == kShortRounds) ++attempt_, beginAttempt();
  return std::max(made, 1);
}

bool Shortening::work(int sweeps) {
  while (!done_ && sweeps > 0) sweeps -= raising_ ? raise() : untangle(sweeps);
  return done_;
}

void shortenColumns(const BodyDistance& body, double fatness, std::vector<double>& shares, sim::HairMeshShape& shape) {
  Shortening shortening(body, fatness, shares, shape);
  while (!shortening.work(std::numeric_limits<int>::max())) {
  }
  shares = shortening.shares();
  shape = shortening.shape();
}

}  // namespace app

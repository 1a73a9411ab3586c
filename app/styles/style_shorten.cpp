#include "app/styles/style_shorten.h"

#include <algorithm>
#include <array>

#include "app/styles/style_untangle.h"

namespace app {

namespace {

constexpr double kShortGap = 0.0025;  // m, see untangle
constexpr double kShortFat = 0.002;   // with less, lengths are softened more
constexpr int kShortRounds = 16;      // of untangling; evenly short hair takes the most
// Least length of a column over that of any of its root face.
constexpr std::array kSteepest{0.5, 0.65, 0.8, 0.9, 1.0};

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

// Raises shares until none is less than `step` times one of the same root face; whether any was.
bool soften(const sim::HairMeshShape& shape, double step, std::vector<double>& shares) {
  bool any = false;
  for (bool raised = true; raised; any |= raised) {
    raised = false;
    for (const sim::RootFace& face : shape.root_faces) {
      double most = 0;
      for (int k = 0; k < face.corner_count; ++k)
        most = std::max(most, shares[static_cast<std::size_t>(face.columns[k])]);
      for (int k = 0; k < face.corner_count; ++k) {
        double& share = shares[static_cast<std::size_t>(face.columns[k])];
        raised |= share < step * most;
        share = std::max(share, step * most);
      }
    }
  }
  return any;
}

}  // namespace

void shortenColumns(const BodyDistance& body, double fatness, std::vector<double>& shares, sim::HairMeshShape& shape) {
  if (shares.empty() || *std::ranges::min_element(shares) >= 1) return;
  const sim::HairMeshShape whole = shape;
  // Whether columns of these shares leave prisms.
  const auto cut = [&] {
    shape.positions = whole.positions;
    for (std::size_t c = 0; c < shares.size(); ++c)
      shorten(std::span(shape.positions)
                  .subspan(static_cast<std::size_t>(shape.column_first[c]),
                           static_cast<std::size_t>(shape.columnLength(static_cast<int>(c)))),
              shares[c]);
    for (int round = 0; round < kShortRounds; ++round) {
      if (untangle(body, fatness, kShortGap, shape) > kShortFat) return true;
    }
    return false;
  };
  std::vector<double> asked;
  for (const double step : kSteepest) {
    if (!soften(whole, step, shares) && step > kSteepest.front()) continue;
    if (asked.empty()) asked = shares;
    if (cut()) return;
  }
  for (const double part : kParts) {
    for (std::size_t c = 0; c < shares.size(); ++c) shares[c] = 1 - part * (1 - asked[c]);
    if (cut()) return;
  }
  shares.assign(shares.size(), 1);
  shape.positions = whole.positions;
}

}  // namespace app

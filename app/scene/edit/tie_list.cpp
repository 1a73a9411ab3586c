#include "app/scene/edit/tie_list.h"

#include <algorithm>
#include <cmath>

#include "sim/field_text.h"

namespace app {

std::string placeText(const TieSpec& tie) {
  if (!tie.at) return tie.place;
  std::string text;
  for (int axis = 0; axis < 3; ++axis)
    text += (axis > 0 ? ", " : "") + sim::numberText(std::round(1000 * (*tie.at)[axis]) / 10 + 0.0);
  return text + " cm";
}

std::vector<TieSpec> withRings(std::vector<TieSpec> ties, const std::vector<TieSpec>& rings, const Scalp& scalp) {
  if (ties.empty() || rings.empty()) return rings.empty() ? ties : rings;
  const std::vector<HairTie> placed = placeTies(ties, scalp);
  std::vector<TieSpec> added = rings;
  const Vec3 at = placeTies(added, scalp).front().at;
  const auto by = [&](const HairTie& a, const HairTie& b) { return (a.at - at).norm() < (b.at - at).norm(); };
  const auto nearest = std::ranges::min_element(placed, by) - placed.begin();
  TieSpec& near = ties[static_cast<std::size_t>(nearest)];
  const HairTie& there = placed[static_cast<std::size_t>(nearest)];
  const Vec3 way = at - there.at;
  if (added.size() == 1 && there.side == 0 && std::abs(way.x()) > std::abs(way.y())) {
    added[0].side = way.x() > 0 ? "left" : "right";
    added[0].above = near.above;
    near.side = way.x() > 0 ? "right" : "left";
    ties.push_back(added[0]);
    return ties;
  }
  const bool higher = way.y() > 0;
  const double between = std::round(1e3 * (0.5 * (at.y() + there.at.y()) - scalp.center.y())) / 1e3;
  for (TieSpec& ring : added) {
    if (added.size() == 1) ring.side = near.side;
    ring.above = higher ? between : near.above;
  }
  if (!higher) near.above = between;
  ties.insert(ties.begin() + nearest + (higher ? 0 : 1), added.begin(), added.end());
  return ties;
}

}  // namespace app

#include "app/scene/edit/carry_hair.h"

#include <algorithm>

#include "app/scene/actor.h"

namespace app {

// m, from the root to each vertex of a column.
std::vector<double> wayAlong(std::span<const Vec3> column) {
  std::vector<double> way{0};
  for (std::size_t k = 1; k < column.size(); ++k) way.push_back(way.back() + (column[k] - column[k - 1]).norm());
  return way;
}

std::span<const Vec3> columnOf(std::span<const Vec3> positions, const sim::HairMeshShape& shape, int c) {
  return positions.subspan(static_cast<std::size_t>(shape.column_first[static_cast<std::size_t>(c)]),
                           static_cast<std::size_t>(shape.columnLength(c)));
}

void carryWithShape(std::span<const Vec3> before, Actor& actor) {
  const sim::HairMeshShape& shape = actor.haircut->mesh.shape;
  const Rigid head = scalpToWorld(actor.body->character, actor.pose);
  std::vector<Vec3> off;  // m, world: of moving hair from where it hung at rest
  for (std::size_t v = 0; v < before.size(); ++v) off.push_back(actor.hair.positions[v] - head * before[v]);
  for (int c = 0; c < shape.columnCount(); ++c) {
    const auto first = static_cast<std::size_t>(shape.column_first[static_cast<std::size_t>(c)]);
    const std::vector<double> was = wayAlong(columnOf(before, shape, c)),
                              is = wayAlong(columnOf(shape.positions, shape, c));
    std::size_t segment = 1;
    for (std::size_t k = 1; k < is.size(); ++k) {
      while (segment + 1 < was.size() && was[segment] < is[k]) ++segment;
      const double within = std::min(1.0, (is[k] - was[segment - 1]) / std::max(1e-9, was[segment] - was[segment - 1]));
      const Vec3 &near = off[first + segment - 1], &far = off[first + segment];
      actor.hair.positions[first + k] = head * shape.positions[first + k] + near + within * (far - near);
    }
  }
  actor.hair.previous_dt = 0;
  actor.previous_positions = actor.hair.positions;
  actor.shown_still = false;
}

}  // namespace app

#include "app/scene/record/card_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace app {

namespace {

constexpr double kLiesFlat = 0.5;  // cosine between a card's normal and the way out of the head, in the mean

using CardEdge = std::pair<int, int>;  // columns

// How flat the strip between two columns lies at rest: -1 to 1, positive where the first column is on the left of one
// who looks at it from outside with the root on top.
double facing(const CardEdge& edge, const sim::HairMeshShape& shape, const Vec3& centre) {
  const auto at = [&](int column, int layer) -> const Vec3& {
    return shape.positions[static_cast<std::size_t>(shape.column_first[static_cast<std::size_t>(column)] + layer)];
  };
  const int layers = std::min(shape.columnLength(edge.first), shape.columnLength(edge.second));
  double sum = 0;
  for (int l = 0; l + 1 < layers; ++l) {
    const Vec3 across = at(edge.second, l) - at(edge.first, l), along = at(edge.first, l + 1) - at(edge.first, l);
    const Vec3 normal = along.cross(across), out = at(edge.first, l) - centre;
    const double size = normal.norm() * out.norm();
    sum += size > 0 ? normal.dot(out) / size : 0;
  }
  return layers > 1 ? sum / (layers - 1) : 0;
}

// The edges that get a card, each turned so that it faces outwards.
std::vector<CardEdge> cardEdges(const sim::HairMeshShape& shape, const Vec3& centre) {
  std::map<CardEdge, double> flat;  // of each edge, its smaller column first
  const auto edgeOf = [](const sim::RootFace& face, int k) {
    const int a = face.columns[static_cast<std::size_t>(k)],
              b = face.columns[static_cast<std::size_t>((k + 1) % face.corner_count)];
    return CardEdge(std::min(a, b), std::max(a, b));
  };
  std::map<CardEdge, bool> chosen;
  for (const sim::RootFace& face : shape.root_faces) {
    CardEdge best;
    double most = -1;
    bool any = false;
    for (int k = 0; k < face.corner_count; ++k) {
      const CardEdge edge = edgeOf(face, k);
      const auto [known, fresh] = flat.try_emplace(edge, 0);
      if (fresh) known->second = facing(edge, shape, centre);
      const double now = std::abs(known->second);
      if (now >= kLiesFlat) any = chosen[edge] = true;
      if (now > most) most = now, best = edge;
    }
    if (!any) chosen[best] = true;
  }
  std::vector<CardEdge> edges;
  for (const auto& [edge, taken] : chosen) {
    if (taken) edges.push_back(flat[edge] > 0 ? edge : CardEdge(edge.second, edge.first));
  }
  return edges;
}

void addCard(const CardEdge& edge, const sim::HairMeshShape& shape, std::uint32_t before, CardMesh& cards) {
  const int layers = std::min(shape.columnLength(edge.first), shape.columnLength(edge.second));
  if (layers < 2) return;
  const auto first = static_cast<std::uint32_t>(cards.vertices.size());
  for (int l = 0; l < layers; ++l) {
    const float along = static_cast<float>(l) / static_cast<float>(layers - 1);
    for (const auto& [column, across] : {std::pair(edge.first, 0.0f), std::pair(edge.second, 1.0f)}) {
      const int vertex = shape.column_first[static_cast<std::size_t>(column)] + l;
      cards.vertices.push_back(before + static_cast<std::uint32_t>(vertex));
      cards.coordinates.emplace_back(across, along);
    }
  }
  for (std::uint32_t l = 0; l + 1 < static_cast<std::uint32_t>(layers); ++l) {
    const std::uint32_t left = first + 2 * l, right = left + 1, below = left + 2, opposite = left + 3;
    for (const std::uint32_t v : {left, below, right, right, below, opposite}) cards.triangles.push_back(v);
  }
  ++cards.count;
}

}  // namespace

CardMesh cardsOf(const Demo& demo) {
  CardMesh cards;
  std::uint32_t before = 0;
  for (const Actor& actor : demo.actors) {
    const sim::HairMeshShape& shape = actor.haircut->mesh.shape;
    for (const CardEdge& edge : cardEdges(shape, actor.body->character.scalp.center))
      addCard(edge, shape, before, cards);
    before += static_cast<std::uint32_t>(shape.vertexCount());
  }
  return cards;
}

}  // namespace app

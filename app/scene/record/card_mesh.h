// The hair mesh as cards, for engines that draw hair as textured strips: one a root edge whose strip lies flat over the
// head, from the scalp to its tips.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "app/scene/demo.h"

namespace app {

struct CardMesh {
  std::vector<std::uint32_t> triangles;      // three card vertices each, counter-clockwise seen from outside
  std::vector<Eigen::Vector2f> coordinates;  // per card vertex: across 0 to 1, and from root 0 to tip 1
  std::vector<std::uint32_t> vertices;       // per card vertex: which of all hair mesh vertices of the scene, in order
  int count = 0;                             // of cards
};

// Of all characters. Every root face has a card on at least one of its edges.
CardMesh cardsOf(const Demo& demo);

}  // namespace app

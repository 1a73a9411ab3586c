// Which corner tetrahedra of a prism couple which of its vertices, at compile time.
#pragma once

#include <array>

#include "sim/mesh/hair_mesh.h"

namespace sim {

// Vertices of a prism over a face of N corners: its lower corners 0 .. N - 1, then the upper ones above them.
template <int N>
struct PrismShares {
  static constexpr int kVertices = 2 * N;
  // Coupled pairs: in the lower layer, between the layers, in the upper layer. All but a hexahedron's inner diagonals.
  static constexpr int kLayerPairs = N == 4 ? 6 : 3, kPairs = 2 * kLayerPairs + 3 * N;
  // Tetrahedra at a vertex; most that share a pair.
  static constexpr int kOfVertex = 4, kMaxOfPair = 3;

  struct Share {
    int tet, p, q;  // the pair's first and second vertex are its p-th and q-th
  };
  struct Pair {
    int u, v, shares = 0;
    std::array<Share, kMaxOfPair> share{};
  };

  std::array<std::array<int, 4>, kVertices> tets{};
  std::array<Pair, kPairs> pairs{};
  std::array<std::array<int, kOfVertex>, kVertices> place_in{};  // per vertex: 4 * tetrahedron + place in it

  constexpr PrismShares() {
    for (int k = 0; k < kVertices; ++k) tets[k] = cornerTetOf(k, N);
    int count = 0;
    for (const int crossing : {0, 1, 2}) {
      for (int u = 0; u < kVertices; ++u) {
        for (int v = u + 1; v < kVertices; ++v) {
          const int upper = (u >= N) + (v >= N);
          if (upper != crossing) continue;
          Pair pair{u, v};
          for (int k = 0; k < kVertices; ++k) addShare(k, pair);
          if (pair.shares > 0) pairs[count++] = pair;
        }
      }
    }
    for (int u = 0; u < kVertices; ++u) {
      int at = 0;
      for (int k = 0; k < kVertices; ++k) {
        for (int p = 0; p < 4; ++p) {
          if (tets[k][p] == u) place_in[u][at++] = 4 * k + p;
        }
      }
    }
  }

 private:
  constexpr void addShare(int k, Pair& pair) const {
    for (int p = 0; p < 4; ++p) {
      for (int q = 0; q < 4; ++q) {
        if (tets[k][p] == pair.u && tets[k][q] == pair.v) pair.share[pair.shares++] = {k, p, q};
      }
    }
  }
};

template <int N>
inline constexpr PrismShares<N> kPrismShares{};

}  // namespace sim

// A skin with vertices enough to stand for its surface. A box of a modelling program has eight.
#pragma once

#include "app/figure/character.h"

namespace app {

// The mesh with triangles of edges over `longest` (m) divided evenly, their skinning interpolated; the others stay.
// Neighbours are divided apart, so edges do not meet. At most kMaxDivided vertices are added, by wider steps where that
// asks for more. Positions, normals, triangles and skinning alone.
inline constexpr std::size_t kMaxDivided = 100000;
SkinnedMesh withoutLongEdges(const SkinnedMesh& mesh, float longest);

// Halves every edge whose ends are both `inside`, one a vertex, and divides the triangles along: edges meet. Vertices
// are added at the end, all that they have interpolated but materials.
void halveEdges(const std::vector<bool>& inside, SkinnedMesh& mesh);

}  // namespace app

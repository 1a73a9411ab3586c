// A coarse space of the hair mesh: patches, a few columns wide and some layers high, each moving as a rigid body.
//
// What layers and columns, each solved alone, leave of an error are soft motions of many vertices at once: hair that
// bends over a shoulder turns there, at little energy, while each of its layers and each of its columns alone would
// have to strain against its neighbours. Translations of patches, or smooth displacements between them, cannot tell of
// a turn but by straining, however many there are. With turns beside them (rigid body modes, as in the smoothed
// aggregation of Vanek, Mandel and Brezina 1996, here without smoothing), and of the current matrix, solves of a walk
// of 10,241 vertices, with patches of four layers, take 0.7 of the iterations to the same error that they took with
// smooth displacements of the rest shape, and 0.63 to half that error.
#pragma once

#include <span>
#include <vector>

#include "sim/linear/column_matrix.h"
#include "sim/linear/envelope_cholesky.h"
#include "sim/mesh/vertex_constraint.h"

namespace sim {

// z = B C^-1 B^T r. B: the rigid motions of the patches at the positions that it was made at, without roots and the
// vertices that were constrained; C = B^T A B for the matrix A that it was made of, so that the answer is the best that
// the patches can give, and never too large.
template <class T>
class CoarseSpace {
 public:
  // Layers of a patch. With 4 a step takes a tenth fewer iterations, and the factor several times the operations:
  // along the hair the columns' own factor sees far.
  static constexpr int kLayers = 12;

  CoarseSpace(const HairMesh& mesh, const ColumnLayout& layout, const ColumnPattern& pattern);

  // Takes a positive definite matrix, the positions (m, one a vertex) and the constraints; false when a pivot was not
  // positive, and it must not be used. Allocates nothing.
  bool make(const ColumnMatrix<T>& a, std::span<const V3<T>> x, std::span<const VertexConstraint> constraints);

  // How many of these constrained vertices were free when it was made.
  int unknown(std::span<const VertexConstraint> constraints) const;

  // Finds the answer to r; `add` then adds it to z. Allocate nothing.
  void solve(const ColumnField<T>& r);
  void add(ColumnField<T>& z);

  int patches() const { return patch_first_.back(); }

 private:
  // Where the sums over lanes [first, last] of a class go: the block that couples two patches, `row` being the later
  // one. `turned`: the class has it transposed.
  struct Target {
    int first, last, row, column;
    bool turned;
  };
  // The block diagonals of the matrix between the columns of two groups, at one offset of layers.
  struct Class {
    int diagonal_first, diagonal_end;  // in `diagonals_`
    int target_first, target_end;
    bool symmetric;
  };
  const HairMesh* mesh_;
  const ColumnLayout* layout_;
  const ColumnPattern* pattern_;
  std::vector<int> group_of_;               // per column
  std::vector<int> group_first_, grouped_;  // columns by group
  // Group g has patches patch_first_[g] ... patch_first_[g + 1] - 1, the m-th at layers m * kLayers + 1 and up.
  std::vector<int> patch_first_{0};
  std::vector<Class> classes_;
  std::vector<int> diagonals_;
  std::vector<Target> targets_;
  EnvelopeCholesky<T> factor_;       // of a patch, six rows: its translation and its turn
  ColumnField<T> arm_;               // m, from the centre of the patch; zero where the next is
  LineVector<T> moves_;              // 1, or 0 for what does not move: roots, constrained vertices, padding
  LineVector<T> sums_;               // of one class: 36 entries, a stride each; or of one group: 6
  std::vector<V3<T>> motion_;        // two a patch: force and torque, then translation and turn
  std::vector<unsigned char> held_;  // per vertex

  int patchOf(int column, int layer) const { return patch_first_[group_of_[column]] + (layer - 1) / kLayers; }
  void formGroups();
  void couplePatches();
  void setArms(std::span<const V3<T>> x, std::span<const VertexConstraint> constraints);
  void addSums(const Class& one);
  bool factor();
};

}  // namespace sim

// Fast kernels, run by the solve: elements arranged by root edge and root face, with layers along the vector lanes.
// evaluate() over ForceModel is the plain reference that tests hold them to.
#pragma once

#include <array>
#include <vector>

#include "sim/forces/evaluate.h"
#include "sim/forces/model.h"
#include "sim/linear/column_matrix.h"

namespace sim {

// The kinds with a kernel. All others run through the plain evaluation (evaluate.h).
using KernelKinds = KindList<Stretch, Shear, Bend, Volume>;

// The joint of a wall and the one above it: vertices a, b of the lower layer, of the middle one, of the upper one. Its
// pairs of vertices, the lower side first, in an order that keeps pairs one layer apart far from each other.
inline constexpr std::array<std::array<int, 2>, 15> kJointPairs{{{0, 1},
                                                                 {0, 4},
                                                                 {0, 5},
                                                                 {1, 4},
                                                                 {1, 5},
                                                                 {2, 3},
                                                                 {0, 2},
                                                                 {0, 3},
                                                                 {1, 2},
                                                                 {1, 3},
                                                                 {4, 5},
                                                                 {2, 4},
                                                                 {2, 5},
                                                                 {3, 4},
                                                                 {3, 5}}};

// Element arrays have `stride` entries a root edge, face corner or column; entry l is of layers l and l + 1 (hinges:
// and l + 2). Stiffness is zero where there is no element.
template <class T>
struct ColumnModel {
  struct StretchArrays {
    std::vector<T> stiffness, inverse_length, shift;
  };
  struct RootEdge {
    int a, b;                          // columns
    int walls, sides;                  // entries to walk, multiples of kLanes
    std::size_t first;                 // of its element arrays
    std::array<int, 6> own;            // places of the joint's diagonal blocks
    std::array<BlockPlace, 15> pairs;  // of kJointPairs
  };
  struct Face {
    int corner_count;
    std::array<int, 4> columns;
    int prisms;                        // entries to walk
    std::size_t first;                 // of its element arrays: one per corner tetrahedron
    std::array<BlockPlace, 24> pairs;  // of PrismShares
  };
  std::vector<RootEdge> edges;
  std::vector<Face> faces;
  std::vector<BlockPlace> vertical_pairs;  // per column
  std::vector<int> diagonal;               // per column: start of its own offset 0
  std::vector<int> column_lanes;           // per column: entries to walk
  StretchArrays vertical, horizontal;
  std::vector<T> shear_stiffness, shear_shift, inverse_along, inverse_across;
  std::vector<T> bend_stiffness, bend_rest_angle, bend_inverse_length, bend_smallest_square;
  std::vector<T> volume_stiffness, volume_rest;
  ForceModel<T> plain;  // the kinds without a kernel
  // Kinds without an element are not assembled.
  bool has_vertical = true, has_horizontal = true, has_shear = true, has_bend = true, has_volume = true;

  ColumnModel(const HairMesh& mesh, const ColumnLayout& layout, const ColumnPattern& pattern);
  // Copies stiffnesses and rest values.
  void setElements(const HairMesh& mesh, const ColumnLayout& layout, const ForceModel<double>& model);
  // Copies the elements of moving kinds, for positions relative to `origin` (m).
  void setMoving(const ForceModel<double>& model, const Vec3& origin);

 private:
  // Entry of an element in its arrays, and whether it is wound against the root edge. Kept while the set of elements is
  // the same, for a dragged slider changes values in every frame.
  struct Entry {
    std::size_t at;
    bool against;
  };
  struct Located {
    std::vector<Entry> stretch, shear, bend;
    std::array<int, 2> first_stretch{-1, -1};  // with the sizes: identifies the set
  };
  Located located_;
  void locate(const HairMesh& mesh, const ColumnLayout& layout, const ForceModel<double>& model);
  void setStretch(const HairMesh& mesh, const Elements<Stretch, double>& stretch);
  void setWalls(const Elements<Shear, double>& shear, const Elements<Bend, double>& bend);
  void setVolume(const HairMesh& mesh, std::size_t stride, const Elements<Volume, double>& volume);
};

// As evaluate() over ForceModel, within rounding.
template <class T>
T evaluate(const ColumnModel<T>& model, const ColumnLayout& layout, const ColumnField<T>& x,
           const ColumnEvaluation<T>& out);

}  // namespace sim

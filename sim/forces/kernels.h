// The force model in column layout: the elements of the kinds that have a fast kernel, arranged by root edge and root
// face with their layers along the vector lanes. This is what the simulator runs; evaluate() over ForceModel is the
// plain reference that tests hold it to.
#pragma once

#include <array>
#include <vector>

#include "sim/forces/evaluate.h"
#include "sim/forces/model.h"
#include "sim/linear/column_matrix.h"

namespace sim {

// The kinds with a fast kernel. Those without run through the plain evaluation (evaluate.h).
using KernelKinds = KindList<Stretch, Shear, Bend, Volume>;

// A wall with the one above it: vertices of columns a, b in its lower layer, between the walls, in the upper layer. Its
// pairs, the lower side first, so ordered that those one layer apart are far from each other.
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

// Element arrays are `stride` long per root edge, face corner or column; entry l belongs to layers l, l + 1 (and l + 2
// for hinges); stiffness is zero where there is no element.
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
  // Whether any element of the kind has a stiffness: kinds without one are not assembled.
  bool has_vertical = true, has_horizontal = true, has_shear = true, has_bend = true, has_volume = true;

  ColumnModel(const HairMesh& mesh, const ColumnLayout& layout, const ColumnPattern& pattern);
  // Takes over stiffnesses and rest values; the topology stays.
  void setElements(const HairMesh& mesh, const ColumnLayout& layout, const ForceModel<double>& model);
  // Takes over the elements that the step's input moves, for positions relative to `origin` (m).
  void setMoving(const ForceModel<double>& model, const Vec3& origin);

 private:
  // Entry of an element in its arrays, and whether it is wound against the root edge. Looked up once for each set of
  // elements: a dragged slider changes their values in every frame.
  struct Entry {
    std::size_t at;
    bool against;
  };
  struct Located {
    std::vector<Entry> stretch, shear, bend;
    std::array<int, 2> first_stretch{-1, -1};  // tells sets of one size apart
  };
  Located located_;
  void locate(const HairMesh& mesh, const ColumnLayout& layout, const ForceModel<double>& model);
};

// As evaluate() over ForceModel, within rounding.
template <class T>
T evaluate(const ColumnModel<T>& model, const ColumnLayout& layout, const ColumnField<T>& x,
           const ColumnEvaluation<T>& out);

}  // namespace sim

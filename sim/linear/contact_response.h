// What a factor answers to forces at the constrained vertices: the dense part of a constrained preconditioner.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "sim/contact/contact.h"
#include "sim/linear/block_cholesky.h"

namespace sim {

// For an approximate inverse P = L^-T L^-1 that knows nothing of the constraints, the constrained P is
//   P - P N (N^T P N)^-1 N^T P,   N: the removed directions.
// P N is combined from the answers to three unit forces at each constrained vertex. These depend on the factor alone,
// so that they are kept for as long as it lives: a contact that lasts, returns or turns costs nothing more.
template <class T>
struct ContactResponses {
  static constexpr int kMaxVertices = 96;     // answers kept; those unused for longest make room
  static constexpr int kMaxDirections = 160;  // corrected for; the filter alone serves the rest
  static constexpr int kVerticesPerBatch = BlockCholesky<T>::kBatch / 3;

  // Forgets all answers: the factor has changed. `vertices`: length of z.
  void reset(int vertices);

  // Vertices among the constraints whose answer is not known.
  int unknown(std::span<const VertexConstraint> constraints) const;

  // Takes the removed directions of the coming solves, turned into the factor's frame by `turn` (3x3 rotations per
  // vertex, transposed on use; empty: the same frame). Answers are computed for at most `batches` batches of new
  // vertices. Returns whether all constraints are corrected for.
  bool setConstraints(BlockCholesky<T>& factor, std::span<const M3<T>> turn,
                      std::span<const VertexConstraint> constraints, int batches);
  void clear() { directions_.clear(); }

  // z -= P N (N^T P N)^-1 N^T z for z = P r, in the factor's frame.
  void correct(std::span<V3<T>> z);

 private:
  struct Slot {
    int vertex = -1;
    long used = 0;
    std::vector<V3<T>> answers;  // three columns, one after the other
  };
  struct Direction {
    int slot = 0, vertex = 0;
    V3<T> d;
  };
  std::vector<Slot> slots_;
  std::vector<int> slot_of_;  // per vertex, or -1
  std::vector<Direction> directions_;
  std::vector<int> wanted_, touched_;
  std::vector<T> batch_;
  std::vector<V3<T>> forces_;  // per slot
  Eigen::MatrixXd gram_;       // top left corner in use: the factor of N^T P N
  Eigen::VectorXd multipliers_;
  long now_ = 0;

  int claimSlot();
  void computeAnswers(BlockCholesky<T>& factor, std::span<const int> vertices);
  bool factorGram();
};

}  // namespace sim

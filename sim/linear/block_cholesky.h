// Sparse Cholesky factorization of a symmetric positive definite block matrix, supernodal: columns with the same
// structure are kept as one dense panel, so that factor and solves run on dense kernels.
//
// Method: approximate minimum degree order of the vertex graph (Amestoy, Davis, Duff 1996, Eigen's implementation),
// elimination tree, relaxed supernodes, multifrontal numeric factorization (Duff and Reid 1983).
#pragma once

#include <span>
#include <vector>

#include "sim/linear/block_matrix.h"

namespace sim {

template <class T>
struct BlockCholesky {
  // A panel: `width` scalar columns, the dense lower triangle L_ss kept inverted, over `height` scalar rows L_rs.
  struct Supernode {
    int first = 0, columns = 0;    // block columns, in elimination order
    int rows_first = 0, rows = 0;  // block rows below, in `row_index`
    std::size_t values = 0;        // start of the panel: inverse of L_ss (width x width), then L_rs (height x width)
    int parent = -1;
    int width() const { return 3 * columns; }
    int height() const { return 3 * rows; }
  };
  std::vector<int> order;     // elimination position -> block row of the matrix
  std::vector<int> position;  // block row -> elimination position, or -1 for rows left out
  std::vector<Supernode> supernodes;
  std::vector<int> row_index;  // elimination positions of the rows below, per supernode, ascending
  std::vector<T> values;

  // Lays out the factor of the rows listed, eliminated in about that order (postordered within the elimination tree);
  // rows not listed are treated as fixed and left out. See elimination_order.h.
  void analyze(const BlockPattern& pattern, std::vector<int> elimination_order);

  // Factors the matrix; false when a pivot is not positive (the factor is then unusable). Needs analyze.
  bool factor(const BlockMatrix<T>& a);

  // The same in slices, bit for bit, for factors that must not stall a frame: beginFactor, then continueFactor with the
  // same matrix until the progress is not kMore. A slice does pieces of work until about `operations` floating-point
  // operations are spent, at least one piece; a piece is at most a few tens of columns of one panel.
  enum class Progress { kMore, kDone, kFailed };
  void beginFactor();
  Progress continueFactor(const BlockMatrix<T>& a, double operations);
  double factorOperations() const;  // of a whole factorization
  // Frees what beginFactor takes again; the layout stays.
  void release();

  // z = A^-1 r over the kept rows, zero at the others.
  void solve(std::span<const V3<T>> r, std::span<V3<T>> z);

 private:
  std::vector<T> work_;            // right-hand side in elimination order
  std::vector<T> gathered_;        // rows of one panel
  std::vector<T> front_, stack_;   // numeric factorization
  std::vector<int> supernode_of_;  // per elimination position
  std::vector<int> local_;         // elimination position -> row in the front
  struct Pending {
    int supernode;
    std::size_t at;  // in stack_
  };
  std::vector<Pending> pending_;  // update matrices on the stack
  // Where a factorization in slices stands: what is done of a supernode is its stage, and the columns of it.
  struct Place {
    int supernode = 0, stage = 0, column = 0;
  };
  Place at_;
  void findSupernodes(const std::vector<std::vector<int>>& below, const std::vector<int>& parent);
  void sizeScratch();
  void sortEntries(const BlockPattern& pattern);
  // One piece of the supernode at hand; adds the operations it took. False when a pivot is not positive.
  bool assembleFront(const BlockMatrix<T>& a, double& spent);
  bool factorDiagonal(double& spent);
  bool invertDiagonal(double& spent);
  bool computeRows(double& spent);
  bool computeUpdate(double& spent);
  bool workColumn(double& spent);  // the present stage's, on the present column
  // A block of the matrix: where it lies in the column that eliminates it, and whether it is needed transposed there.
  struct Entry {
    int block, row;
    bool turned;
  };
  std::vector<Entry> entries_;  // by elimination column
  std::vector<int> entries_first_;
  std::size_t stack_size_ = 0, deepest_stack_ = 0, value_count_ = 0;
  int largest_front_ = 0;
};

}  // namespace sim

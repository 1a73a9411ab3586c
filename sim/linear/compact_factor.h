// The rest factor in 16 bits, for the triangular solves of the warped preconditioner. On large meshes these are bound
// by memory, and half the bytes take about half the time.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/linear/block_cholesky.h"

namespace sim {

// Each column of a panel is kept as 16-bit integers times one scale, so that an entry is wrong by at most 2^-16 of its
// column's largest: L is then the exact factor of a matrix close by, which serves a preconditioner as well (the
// iterations stay the same down to 12 bits, measured; 8 bits take over ten times as many).
//
// Layout: strips of sixteen rows, a strip's columns one after the other and two to a word, so that one load brings
// sixteen rows of two columns. Supernodes as in the factor it was made from, which it needs for the structure only.
class CompactFactor {
 public:
  void assign(const BlockCholesky<float>& factor);

  // The same a few supernodes at a time, as they become final: begin, then append up to the supernode given.
  void begin(const BlockCholesky<float>& factor);
  void append(const BlockCholesky<float>& factor, int end);

  // z = (L L^T)^-1 r over the kept rows, zero at the others. `factor`: the one given to assign.
  void solve(const BlockCholesky<float>& factor, std::span<const V3<float>> r, std::span<V3<float>> z);

  std::size_t bytes() const { return values_.size() * sizeof(std::int32_t) + scales_.size() * sizeof(float); }

 private:
  std::vector<std::int32_t> values_;
  std::vector<float> scales_;                       // per supernode: columns of the triangle, columns of the rows below
  std::vector<std::size_t> triangle_at_, rows_at_;  // into values_
  std::vector<std::size_t> scales_at_;
  std::vector<float> x_, gathered_, scaled_;
};

}  // namespace sim

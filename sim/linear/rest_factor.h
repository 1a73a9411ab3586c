// The factor of the rest shape's matrix with everything that is derived from it, made at once or a slice a step.
#pragma once

#include <optional>
#include <span>

#include "sim/linear/block_cholesky.h"
#include "sim/linear/compact_factor.h"
#include "sim/linear/contact_response.h"

namespace sim {

template <class T>
struct RestFactor {
  BlockCholesky<T> factor;  // analyzed by whoever owns it
  std::optional<CompactFactor> compact;
  ContactResponses<T> responses;
  bool fine = false;  // else a pivot was not positive, and it must not be used

  // `compact`: keep the factor in 16 bits for the solves (single precision only).
  void make(const BlockMatrix<T>& rest, bool use_compact);

  // z = A_rest^-1 r, corrected for the constraints that the responses were given.
  void solve(std::span<const V3<T>> r, std::span<V3<T>> z);
};

// A rest factor in the making. It has its own memory, so that the one in use serves until it is ready; how far it gets
// in a step depends on operations counted, never on time, so that runs repeat to the bit.
template <class T>
struct RestFactorInMaking {
  RestFactor<T> next;
  BlockMatrix<T> matrix;
  enum class Stage { kIdle, kMemory, kFactor, kAnswers };
  Stage stage = Stage::kIdle;

  // Takes `matrix` as it is; `like`: the factor in use, for the layout and the precision.
  void begin(const RestFactor<T>& like);

  // Works for about `operations` floating-point operations and, when all is done, changes places with `used`; answers
  // whether it just has. `lasting`, `turn`: the constraints of the last solve and the rotations of its vertices; what
  // the new factor answers to them is computed beforehand, a batch a step. A factor that fails leaves `used` in place.
  bool work(double operations, std::span<const VertexConstraint> lasting, std::span<const M3<T>> turn,
            RestFactor<T>& used);

 private:
  int answered_ = 0;  // batches
  bool compact_ = false;
};

}  // namespace sim

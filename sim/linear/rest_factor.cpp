#include "sim/linear/rest_factor.h"

#include <type_traits>
#include <utility>

namespace sim {
namespace {

constexpr int kMaxBatches = 16;  // of answers before a new factor takes over; the rest is computed as it is needed

template <class T>
int vertexCount(const BlockCholesky<T>& factor) {
  return static_cast<int>(factor.position.size());
}

}  // namespace

template <class T>
void RestFactor<T>::make(const BlockMatrix<T>& rest, bool use_compact) {
  fine = factor.factor(rest);
  responses.reset(vertexCount(factor));
  if constexpr (std::is_same_v<T, float>) {
    if (use_compact && fine) {
      if (!compact) compact.emplace();
      compact->assign(factor);
      return;
    }
  }
  compact.reset();
}

template <class T>
void RestFactor<T>::solve(std::span<const V3<T>> r, std::span<V3<T>> z) {
  if constexpr (std::is_same_v<T, float>) {
    if (compact) {
      compact->solve(factor, r, z);
      return responses.correct(z);
    }
  }
  factor.solve(r, z);
  responses.correct(z);
}

template <class T>
void RestFactorInMaking<T>::begin(const RestFactor<T>& like) {
  if (next.factor.order.empty()) {
    next.factor.copyLayout(like.factor);
    stage = Stage::kMemory;
  } else {
    stage = Stage::kFactor;
  }
  compact_ = like.compact.has_value();
  answered_ = 0;
  next.factor.beginFactor();
  if constexpr (std::is_same_v<T, float>) {
    if (compact_) {
      if (!next.compact) next.compact.emplace();
      next.compact->begin(next.factor);
    } else {
      next.compact.reset();
    }
  }
}

template <class T>
bool RestFactorInMaking<T>::work(double operations, std::span<const VertexConstraint> lasting,
                                 std::span<const M3<T>> turn, RestFactor<T>& used) {
  if (stage == Stage::kMemory) {
    next.responses.reset(vertexCount(next.factor));
    stage = Stage::kFactor;
    return false;
  }
  if (stage == Stage::kFactor) {
    const auto progress = next.factor.continueFactor(matrix, operations);
    if constexpr (std::is_same_v<T, float>) {
      if (compact_) next.compact->append(next.factor, next.factor.supernodesDone());
    }
    if (progress == BlockCholesky<T>::Progress::kFailed) stage = Stage::kIdle;
    if (progress == BlockCholesky<T>::Progress::kDone) {
      next.fine = true;
      next.responses.reset(vertexCount(next.factor));
      stage = Stage::kAnswers;
    }
    return false;
  }
  if (stage == Stage::kAnswers) {
    const bool known = next.responses.unknown(lasting) == 0;
    if (!known && answered_++ < kMaxBatches) {
      next.responses.setConstraints(next.factor, turn, lasting, 1);
      return false;
    }
    std::swap(used, next);
    stage = Stage::kIdle;
    return true;
  }
  return false;
}

template struct RestFactor<float>;
template struct RestFactor<double>;
template struct RestFactorInMaking<float>;
template struct RestFactorInMaking<double>;

}  // namespace sim

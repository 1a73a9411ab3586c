#include "sim/linear/contact_response.h"

#include <algorithm>

#include "sim/linear/lanes.h"
#include "sim/linear/small_cholesky.h"

namespace sim {
namespace {

// z -= a x + b y + c z over flat arrays.
template <class T>
void subtractCombination(T* z, const T* answers, std::size_t n, const V3<T>& f) {
  const T *a = answers, *b = answers + n, *c = answers + 2 * n;
  for (std::size_t i = 0; i < n; ++i) z[i] -= f.x * a[i] + f.y * b[i] + f.z * c[i];
}
HAIRMESH_CLONES void subtract(float* z, const float* answers, std::size_t n, const V3<float>& f) {
  subtractCombination(z, answers, n, f);
}
HAIRMESH_CLONES void subtract(double* z, const double* answers, std::size_t n, const V3<double>& f) {
  subtractCombination(z, answers, n, f);
}

}  // namespace

template <class T>
void ContactResponses<T>::reset(int vertices) {
  slots_.resize(kMaxVertices);
  for (Slot& slot : slots_) {
    slot.vertex = -1;
    slot.used = 0;
    slot.answers.resize(3 * static_cast<std::size_t>(vertices));
  }
  slot_of_.assign(vertices, -1);
  forces_.resize(kMaxVertices);
  directions_.clear();
  directions_.reserve(kMaxDirections);
  wanted_.clear();
  wanted_.reserve(vertices);
  touched_.reserve(kVerticesPerBatch);
  batch_.resize(3 * static_cast<std::size_t>(vertices) * BlockCholesky<T>::kBatch);
  gram_.resize(kMaxDirections, kMaxDirections);
  multipliers_.resize(kMaxDirections);
}

template <class T>
int ContactResponses<T>::unknown(std::span<const VertexConstraint> constraints) const {
  return static_cast<int>(
      std::count_if(constraints.begin(), constraints.end(), [&](const auto& c) { return slot_of_[c.vertex] < 0; }));
}

// The slot unused for longest, or -1 when all are in use by the constraints at hand.
template <class T>
int ContactResponses<T>::claimSlot() {
  const auto oldest =
      std::min_element(slots_.begin(), slots_.end(), [](const Slot& a, const Slot& b) { return a.used < b.used; });
  if (oldest->used == now_) return -1;
  if (oldest->vertex >= 0) slot_of_[oldest->vertex] = -1;
  oldest->used = now_;
  return static_cast<int>(oldest - slots_.begin());
}

// Three unit forces at each of up to kVerticesPerBatch vertices.
template <class T>
void ContactResponses<T>::computeAnswers(BlockCholesky<T>& factor, std::span<const int> vertices) {
  constexpr int kSides = BlockCholesky<T>::kBatch;
  std::fill(batch_.begin(), batch_.end(), T(0));
  touched_.clear();
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const std::size_t position = factor.position[vertices[k]];
    for (std::size_t axis = 0; axis < 3; ++axis) batch_[(3 * position + axis) * kSides + 3 * k + axis] = T(1);
    touched_.push_back(static_cast<int>(position));
  }
  factor.solveBatch(batch_, touched_);
  const std::size_t n = slot_of_.size();
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    std::vector<V3<T>>& answers = slots_[slot_of_[vertices[k]]].answers;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        V3<T>& z = answers[axis * n + i];
        z = {0, 0, 0};
        if (factor.position[i] < 0) continue;
        const T* at = batch_.data() + 3 * static_cast<std::size_t>(factor.position[i]) * kSides + 3 * k + axis;
        z = {at[0], at[kSides], at[2 * kSides]};
      }
    }
  }
}

template <class T>
bool ContactResponses<T>::setConstraints(BlockCholesky<T>& factor, std::span<const M3<T>> turn,
                                         std::span<const VertexConstraint> constraints, int batches) {
  directions_.clear();
  ++now_;
  for (const VertexConstraint& constraint : constraints) {
    if (const int slot = slot_of_[constraint.vertex]; slot >= 0) slots_[slot].used = now_;
  }
  bool complete = true;
  wanted_.clear();
  for (const VertexConstraint& constraint : constraints) {
    if (constraint.removed == 0 || slot_of_[constraint.vertex] >= 0) continue;
    const int slot = static_cast<int>(wanted_.size()) < batches * kVerticesPerBatch ? claimSlot() : -1;
    if (slot < 0) {
      complete = false;
      continue;
    }
    slots_[slot].vertex = constraint.vertex;
    slot_of_[constraint.vertex] = slot;
    wanted_.push_back(constraint.vertex);
  }
  for (std::size_t first = 0; first < wanted_.size(); first += kVerticesPerBatch) {
    computeAnswers(factor,
                   std::span(wanted_).subspan(first, std::min<std::size_t>(kVerticesPerBatch, wanted_.size() - first)));
  }
  for (const VertexConstraint& constraint : constraints) {
    const int slot = slot_of_[constraint.vertex];
    if (slot < 0) continue;
    if (static_cast<int>(directions_.size()) + constraint.removed > kMaxDirections) {
      complete = false;
      break;
    }
    for (int k = 0; k < constraint.removed; ++k) {
      const Vec3& d = constraint.directions[k];
      const V3<T> narrow{static_cast<T>(d.x()), static_cast<T>(d.y()), static_cast<T>(d.z())};
      directions_.push_back(
          {slot, constraint.vertex, turn.empty() ? narrow : transposeTimes(turn[constraint.vertex], narrow)});
    }
  }
  if (!factorGram()) directions_.clear();  // the filter alone serves
  return complete;
}

template <class T>
bool ContactResponses<T>::factorGram() {
  const int count = static_cast<int>(directions_.size());
  const std::size_t n = slot_of_.size();
  for (int j = 0; j < count; ++j) {
    const Direction& column = directions_[j];
    const V3<T>* answers = slots_[column.slot].answers.data();
    for (int i = j; i < count; ++i) {
      const Direction& row = directions_[i];
      const V3<T> z = column.d.x * answers[row.vertex] + column.d.y * answers[n + row.vertex] +
                      column.d.z * answers[2 * n + row.vertex];
      gram_(i, j) = static_cast<double>(dot(row.d, z));
    }
  }
  return factorLowerInPlace(gram_.topLeftCorner(count, count));
}

template <class T>
void ContactResponses<T>::correct(std::span<V3<T>> z) {
  if (directions_.empty()) return;
  const auto count = static_cast<Eigen::Index>(directions_.size());
  auto m = multipliers_.head(count);
  for (Eigen::Index k = 0; k < count; ++k) m[k] = static_cast<double>(dot(directions_[k].d, z[directions_[k].vertex]));
  const auto lower = gram_.topLeftCorner(count, count).template triangularView<Eigen::Lower>();
  lower.solveInPlace(m);
  lower.transpose().solveInPlace(m);
  for (Eigen::Index k = 0; k < count; ++k) {
    V3<T>& force = forces_[directions_[k].slot];
    if (k == 0 || directions_[k].slot != directions_[k - 1].slot) force = {0, 0, 0};
    force += static_cast<T>(m[k]) * directions_[k].d;
    const bool last = k + 1 == count || directions_[k + 1].slot != directions_[k].slot;
    if (last) subtract(&z[0].x, &slots_[directions_[k].slot].answers[0].x, 3 * z.size(), force);
  }
}

template struct ContactResponses<float>;
template struct ContactResponses<double>;

}  // namespace sim

// All elements of a hair mesh, with stiffness and rest value of each.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "sim/forces/kinds.h"
#include "sim/linear/block_matrix.h"
#include "sim/skip_count.h"

namespace sim {

template <class T>
struct ForceModel {
  ForceKinds::Tables<T> tables;

  template <class Kind>
  Elements<Kind, T>& of() {
    return std::get<Elements<Kind, T>>(tables);
  }
  template <class Kind>
  const Elements<Kind, T>& of() const {
    return std::get<Elements<Kind, T>>(tables);
  }
  // Calls f with the elements of each kind in turn.
  void forEach(auto&& f) {
    std::apply([&](auto&... elements) { (f(elements), ...); }, tables);
  }
  void forEach(auto&& f) const {
    std::apply([&](const auto&... elements) { (f(elements), ...); }, tables);
  }

  // The same without moving kinds.
  void forEachOfMaterial(auto&& f) {
    forEach([&]<class Kind>(Elements<Kind, T>& elements) {
      if constexpr (!MovingKind<Kind>) f(elements);
    });
  }

  // Kinds without an element, of all.
  SkipCount kindsLeftOut() const {
    int empty = 0;
    forEach([&](const auto& elements) { empty += elements.size() == 0; });
    return {empty, ForceKinds::kCount};
  }
};

// The vertex pairs that any element couples: the pattern of every system matrix of this mesh.
BlockPattern systemPattern(const HairMesh& mesh);

// The elements alone, at rest in the styled pose without gravity. `before`: others of the pattern, which save time.
ForceModel<double> makeElements(const ForceSource& source, const BlockPattern& pattern,
                                const ForceModel<double>& before = {});

// Sets the stiffnesses that makeElements would give. False if its set of elements would differ, because a modulus has
// become zero or was.
bool setStiffness(const ForceSource& source, ForceModel<double>& model);

// Makes the elements of moving kinds anew. Allocates only where there are more than ever before.
void setMovingElements(const ForceSource& source, const BlockPattern& pattern, ForceModel<double>& model);

// Whether two sets of parameters give the same stiffnesses and the same balance of gravity.
bool sameMaterial(const SimParams& a, const SimParams& b);

// The same in another precision.
template <class Kind, class T>
void convertElements(const Elements<Kind, double>& from, Elements<Kind, T>& to) {
  to.vertices = from.vertices;
  to.slots = from.slots;
  to.stiffness.assign(from.stiffness.begin(), from.stiffness.end());
  to.shift.assign(from.shift.begin(), from.shift.end());
  to.rest.clear();
  for (const auto& rest : from.rest) std::copy(rest.begin(), rest.end(), to.rest.emplace_back().begin());
}

// The sums of an evaluation. Null pointers, empty spans and zero scales skip their part.
template <class T>
struct Evaluation {
  std::span<V3<T>> force;            // N, -dE/dx, added
  BlockMatrix<T>* matrix = nullptr;  // added: matrix_scale sum k g g^T + tension_scale sum k curvature
  T matrix_scale = 0, tension_scale = 0;
  // m/s; adds damping forces -damping k (g . v + drift) g. Without velocities moving kinds add those of the drift.
  std::span<const V3<T>> velocities;
  T damping = 0;  // s
  // Per vertex; an element's damping, and what of the matrix scale is beyond the tension scale, times the mean.
  // Empty: 1.
  std::span<const T> damping_share{};
};

// Adds forces and Hessian at positions x (m); returns the elastic energy plus, with velocities, the dissipation
// potential damping / 2 sum k (g . v)^2 (J). Fixed order of summation.
template <class T>
T evaluate(const ForceModel<T>& model, std::span<const V3<T>> x, const Evaluation<T>& out);

}  // namespace sim

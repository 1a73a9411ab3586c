// All elements of a hair mesh with the stiffness and rest value of each: what the material parameters make of the rest
// shape.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sim/block_matrix.h"
#include "sim/forces/conditions.h"
#include "sim/hair_mesh.h"
#include "sim/sim_params.h"

namespace sim {

// Elements of one kind: N vertices each, stiffness k (J for dimensionless conditions), and `shift`, the value of the
// condition at which the element is at rest (0: the styled pose; sag-free hair is prestressed). `slots`: the matrix
// block of each vertex pair (p, q), p < q, in lexicographic order.
template <class T, int N>
struct Elements {
  static constexpr int kPairs = N * (N - 1) / 2;
  std::vector<std::array<int, N>> vertices;
  std::vector<std::array<int, kPairs>> slots;
  std::vector<T> stiffness, shift;
  std::size_t size() const { return vertices.size(); }
};

template <class T>
struct StretchElements : Elements<T, 2> {
  std::vector<T> inverse_length;  // 1/m
};
template <class T>
struct ShearElements : Elements<T, 4> {
  std::vector<T> inverse_along, inverse_across;  // 1/m
};
template <class T>
struct BendElements : Elements<T, 6> {
  std::vector<T> rest_angle, inverse_length, smallest_square;  // rad, 1/m, m^4
};
template <class T>
struct VolumeElements : Elements<T, 4> {
  std::vector<T> rest_volume;  // m^3
};

template <class T>
struct ForceModel {
  StretchElements<T> stretch;
  ShearElements<T> shear;
  BendElements<T> bend;
  VolumeElements<T> volume;
};

// The vertex pairs that any element couples: the pattern of every system matrix of this mesh.
BlockPattern systemPattern(const HairMesh& mesh);

// The modulus (Pa) with which this mesh's prisms resist a change of volume: params.volume where they measure 1.5 cm^2
// or less across the hair, and in inverse proportion less where they are wider. Hair as a whole yields to a bend by
// widening here and narrowing there; a wide prism cannot follow within itself, and with the same modulus a coarse mesh
// would move 0.7 to 0.8 times as far as a fine one (docs/consistency.md). Not below what the hair's own weight asks
// for, twice its density times 9.81 m/s^2 times its length: softer hair would not keep its shape.
double volumeModulus(const HairMesh& mesh, const SimParams& params);

// Stiffnesses from the moduli and each element's share of the hair's volume. With sag_free, rest shifts are solved for
// so that the styled pose carries gravity (down the scalp frame's y): the elastic forces there equal minus the weight.
// Relative residual of that balance: below 1e-9, unless a shift had to be bounded (strain 0.5, 1 rad a hinge) because
// the material is too soft to hold the style.
ForceModel<double> makeForceModel(const HairMesh& mesh, const BlockPattern& pattern, const SimParams& params);

// The elements alone, at rest in the styled pose without gravity.
ForceModel<double> makeElements(const HairMesh& mesh, const BlockPattern& pattern, const SimParams& params);

// The stiffnesses that makeElements would give, over its elements. False, and nothing changed, when other elements
// would exist: a modulus has become zero or was.
bool setStiffness(const HairMesh& mesh, const SimParams& params, ForceModel<double>& model);

// The same in another precision.
template <class T>
ForceModel<T> convertModel(const ForceModel<double>& model);

// What an evaluation adds up. Null pointers and zero scales skip their part.
template <class T>
struct Evaluation {
  std::span<V3<T>> force;            // N, -dE/dx, added
  BlockMatrix<T>* matrix = nullptr;  // added: matrix_scale sum k g g^T + tension_scale (tension part of stretch)
  T matrix_scale = 0, tension_scale = 0;
  // Damping forces -damping k (g . v) g, added when velocities are given (m/s).
  std::span<const V3<T>> velocities;
  T damping = 0;  // s
};

// Adds forces and Hessian at positions x (m); returns the elastic energy plus, with velocities, the dissipation
// potential damping / 2 sum k (g . v)^2 (J). Fixed order of summation.
template <class T>
T evaluate(const ForceModel<T>& model, std::span<const V3<T>> x, const Evaluation<T>& out);

}  // namespace sim

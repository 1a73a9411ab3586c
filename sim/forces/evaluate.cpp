// Energy, force and Hessian of many elements.
//
// k: stiffness, c: condition with its rest shift taken off, g: its gradient; see conditions.h.
#include "sim/forces/force_model.h"

namespace sim {
namespace {

// Adds s a b^T to the block.
template <class T>
void addOuter(M3<T>& m, T s, const V3<T>& a, const V3<T>& b) {
  const V3<T> sa = s * a;
  m.m[0] += sa.x * b.x, m.m[1] += sa.x * b.y, m.m[2] += sa.x * b.z;
  m.m[3] += sa.y * b.x, m.m[4] += sa.y * b.y, m.m[5] += sa.y * b.z;
  m.m[6] += sa.z * b.x, m.m[7] += sa.z * b.y, m.m[8] += sa.z * b.z;
}

template <class T>
void addBlock(M3<T>& m, const M3<T>& b, T sign) {
  for (int i = 0; i < 9; ++i) m.m[i] += sign * b.m[i];
}

// One element's condition: force, damping force and Gauss-Newton Hessian into the sums; returns its energy
// and dissipation potential.
template <class T, int N>
T addCondition(const Elements<T, N>& elements, std::size_t e, const Condition<T, N>& condition, T shift,
               const Evaluation<T>& out) {
  const auto& v = elements.vertices[e];
  const T k = elements.stiffness[e], c = condition.value - shift;
  T pull = k * c, dissipation = 0;
  if (!out.velocities.empty()) {
    T rate = 0;
    for (int p = 0; p < N; ++p) rate += dot(condition.g[p], out.velocities[v[p]]);
    pull += out.damping * k * rate;
    dissipation = out.damping * k * rate * rate;
  }
  if (!out.force.empty()) {
    for (int p = 0; p < N; ++p) out.force[v[p]] -= pull * condition.g[p];
  }
  if (out.matrix) {
    const T s = out.matrix_scale * k;
    int pair = 0;
    for (int p = 0; p < N; ++p) {
      addOuter(out.matrix->diagonal[v[p]], s, condition.g[p], condition.g[p]);
      for (int q = p + 1; q < N; ++q, ++pair) {
        const bool swapped = v[p] < v[q];  // the block's row is the larger vertex
        addOuter(out.matrix->lower[elements.slots[e][pair]], s, condition.g[swapped ? q : p],
                 condition.g[swapped ? p : q]);
      }
    }
  }
  return T(0.5) * (k * c * c + dissipation);
}

// BendCondition::crush, as a multiple of the unit matrix per pair of vertices.
template <class T>
void addCrush(const BendElements<T>& bend, std::size_t e, T scale, BlockMatrix<T>& matrix) {
  int pair = 0;
  const auto add = [&](M3<T>& block, int p, int q) {
    const T share = scale * bend.stiffness[e] * static_cast<T>(crushWeight(p, q));
    for (int i = 0; i < 9; i += 4) block.m[i] += share;
  };
  for (int p = 0; p < 6; ++p) {
    add(matrix.diagonal[bend.vertices[e][p]], p, p);
    for (int q = p + 1; q < 6; ++q, ++pair) add(matrix.lower[bend.slots[e][pair]], p, q);
  }
}

template <class T, int N>
void gather(std::span<const V3<T>> x, const std::array<int, N>& v, V3<T>* local) {
  for (int p = 0; p < N; ++p) local[p] = x[v[p]];
}

template <class T>
T evaluateStretch(const StretchElements<T>& elements, std::span<const V3<T>> x, const Evaluation<T>& out) {
  T energy = 0;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const auto [a, b] = elements.vertices[e];
    const StretchCondition<T> s = stretchCondition(x[a], x[b], elements.inverse_length[e]);
    const V3<T> g = s.inverse_length * s.direction;
    const T k = elements.stiffness[e], c = s.value - elements.shift[e];
    T pull = k * c, dissipation = 0;
    if (!out.velocities.empty()) {
      const T rate = dot(g, out.velocities[b] - out.velocities[a]);
      pull += out.damping * k * rate;
      dissipation = out.damping * k * rate * rate;
    }
    if (!out.force.empty()) {
      out.force[a] += pull * g;
      out.force[b] -= pull * g;
    }
    if (out.matrix) {
      M3<T> block{};
      // Under tension the edge also resists turning: k c / (L |d|) (I - direction direction^T).
      const T turn = c > 0 ? out.tension_scale * k * c * s.tension_slope : T(0);
      addOuter(block, out.matrix_scale * k, g, g);
      addOuter(block, -turn, s.direction, s.direction);
      for (int i = 0; i < 9; i += 4) block.m[i] += turn;
      addBlock(out.matrix->diagonal[a], block, T(1));
      addBlock(out.matrix->diagonal[b], block, T(1));
      addBlock(out.matrix->lower[elements.slots[e][0]], block, T(-1));
    }
    energy += T(0.5) * (k * c * c + dissipation);
  }
  return energy;
}

}  // namespace

template <class T>
T evaluate(const ForceModel<T>& model, std::span<const V3<T>> x, const Evaluation<T>& out) {
  T energy = evaluateStretch(model.stretch, x, out);
  for (std::size_t e = 0; e < model.shear.size(); ++e) {
    V3<T> p[4];
    gather<T, 4>(x, model.shear.vertices[e], p);
    energy +=
        addCondition(model.shear, e, shearCondition(p, model.shear.inverse_along[e], model.shear.inverse_across[e]),
                     model.shear.shift[e], out);
  }
  for (std::size_t e = 0; e < model.bend.size(); ++e) {
    V3<T> p[6];
    gather<T, 6>(x, model.bend.vertices[e], p);
    // Its shift is one of the rest angle: where the angle jumps by a full turn, or means nothing any more, the energy
    // does not.
    const T rest = model.bend.rest_angle[e] + model.bend.shift[e] / model.bend.inverse_length[e];
    const BendCondition<T> bend = bendCondition(p, rest, model.bend.inverse_length[e], model.bend.smallest_square[e]);
    energy += addCondition(model.bend, e, bend, T(0), out);
    if (out.matrix && bend.crush > 0) addCrush(model.bend, e, out.tension_scale * bend.crush, *out.matrix);
  }
  for (std::size_t e = 0; e < model.volume.size(); ++e) {
    V3<T> p[4];
    gather<T, 4>(x, model.volume.vertices[e], p);
    energy +=
        addCondition(model.volume, e, volumeCondition(p, model.volume.rest_volume[e]), model.volume.shift[e], out);
  }
  return energy;
}

template float evaluate(const ForceModel<float>&, std::span<const V3<float>>, const Evaluation<float>&);
template double evaluate(const ForceModel<double>&, std::span<const V3<double>>, const Evaluation<double>&);

}  // namespace sim

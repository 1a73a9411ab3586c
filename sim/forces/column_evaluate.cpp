// The kernels: kLanes layers of one root edge, face or column at a time.
//
// k: stiffness, c: condition with its rest shift taken off, g: its gradient; see conditions.h.
#include "sim/forces/column_model.h"

namespace sim {
namespace {

// What the kernels add to, by plain pointers.
template <class T>
struct Sums {
  ColumnField<T>* force;
  const ColumnField<T>* velocity;
  T* values;
  std::size_t stride;
  Lanes<T> matrix_scale, tension_scale, damping, energy;
};

template <class T>
HAIRMESH_INLINE void addSymmetric(T* at, std::size_t s, const V3<Lanes<T>>& a, const V3<Lanes<T>>& b) {
  addTo<T>(at, a.x * b.x);
  addTo<T>(at + s, a.x * b.y);
  addTo<T>(at + 2 * s, a.x * b.z);
  addTo<T>(at + 3 * s, a.y * b.y);
  addTo<T>(at + 4 * s, a.y * b.z);
  addTo<T>(at + 5 * s, a.z * b.z);
}

template <class T>
HAIRMESH_INLINE void addOuter(T* at, std::size_t s, const V3<Lanes<T>>& a, const V3<Lanes<T>>& b) {
  addTo<T>(at, a.x * b.x);
  addTo<T>(at + s, a.x * b.y);
  addTo<T>(at + 2 * s, a.x * b.z);
  addTo<T>(at + 3 * s, a.y * b.x);
  addTo<T>(at + 4 * s, a.y * b.y);
  addTo<T>(at + 5 * s, a.y * b.z);
  addTo<T>(at + 6 * s, a.z * b.x);
  addTo<T>(at + 7 * s, a.z * b.y);
  addTo<T>(at + 8 * s, a.z * b.z);
}

// Force, damping and Gauss-Newton blocks of kLanes elements. at: entries of the vertices in padded fields; diagonals,
// pairs: places of their blocks, `layer` further on.
template <class T, int N>
HAIRMESH_INLINE void addCondition(const Condition<Lanes<T>, N>& condition, const Lanes<T>& k, const Lanes<T>& shift,
                                  const std::array<int, N>& at, const std::array<int, N>& diagonals,
                                  const BlockPlace* pairs, int layer, Sums<T>& sums) {
  const Lanes<T> c = condition.value - shift;
  Lanes<T> pull = k * c;
  sums.energy += pull * c;
  if (sums.velocity) {
    Lanes<T> rate = constant<Lanes<T>>(0);
    for (int p = 0; p < N; ++p) rate += dot(condition.g[p], loadAt(*sums.velocity, at[p]));
    const Lanes<T> resistance = sums.damping * k * rate;
    pull += resistance;
    sums.energy += resistance * rate;
  }
  if (sums.force) {
    for (int p = 0; p < N; ++p) addAt(*sums.force, at[p], -pull * condition.g[p]);
  }
  if (!sums.values) return;
  const Lanes<T> s = sums.matrix_scale * k;
  for (int p = 0, pair = 0; p < N; ++p) {
    const V3<Lanes<T>> scaled = s * condition.g[p];
    addSymmetric<T>(sums.values + diagonals[p] + layer, sums.stride, scaled, condition.g[p]);
    for (int q = p + 1; q < N; ++q, ++pair) {
      T* block = sums.values + pairs[pair].at + layer;
      if (pairs[pair].transposed)
        addOuter<T>(block, sums.stride, condition.g[q], scaled);
      else
        addOuter<T>(block, sums.stride, scaled, condition.g[q]);
    }
  }
}

// Stretch of kLanes edges between entries a and b.
template <class T>
HAIRMESH_INLINE void addStretch(const typename ColumnModel<T>::Stretch& elements, std::size_t e,
                                const ColumnField<T>& x, int a, int b, const std::array<int, 2>& diagonals,
                                const BlockPlace& pair, int layer, Sums<T>& sums) {
  const auto stretch = stretchCondition(loadAt(x, a), loadAt(x, b), load<T>(elements.inverse_length.data() + e));
  const V3<Lanes<T>> g = stretch.inverse_length * stretch.direction;
  const Lanes<T> k = load<T>(elements.stiffness.data() + e), c = stretch.value - load<T>(elements.shift.data() + e);
  Lanes<T> pull = k * c;
  sums.energy += pull * c;
  if (sums.velocity) {
    const Lanes<T> rate = dot(g, loadAt(*sums.velocity, b) - loadAt(*sums.velocity, a));
    const Lanes<T> resistance = sums.damping * k * rate;
    pull += resistance;
    sums.energy += resistance * rate;
  }
  if (sums.force) {
    addAt(*sums.force, a, pull * g);
    addAt(*sums.force, b, -pull * g);
  }
  if (!sums.values) return;
  const Lanes<T> zero = constant<Lanes<T>>(0), tension = k * c;
  const Lanes<T> turn = (tension > zero ? tension : zero) * sums.tension_scale * stretch.tension_slope;
  const Lanes<T> axial = sums.matrix_scale * k * stretch.inverse_length * stretch.inverse_length - turn;
  const V3<Lanes<T>>& d = stretch.direction;
  const V3<Lanes<T>> ad = axial * d;
  const Lanes<T> xx = ad.x * d.x + turn, xy = ad.x * d.y, xz = ad.x * d.z, yy = ad.y * d.y + turn, yz = ad.y * d.z,
                 zz = ad.z * d.z + turn;
  const std::size_t s = sums.stride;
  for (const int diagonal : diagonals) {
    T* at = sums.values + diagonal + layer;
    addTo<T>(at, xx), addTo<T>(at + s, xy), addTo<T>(at + 2 * s, xz), addTo<T>(at + 3 * s, yy),
        addTo<T>(at + 4 * s, yz), addTo<T>(at + 5 * s, zz);
  }
  T* at = sums.values + pair.at + layer;
  addTo<T>(at, -xx), addTo<T>(at + s, -xy), addTo<T>(at + 2 * s, -xz), addTo<T>(at + 3 * s, -xy),
      addTo<T>(at + 4 * s, -yy), addTo<T>(at + 5 * s, -yz), addTo<T>(at + 6 * s, -xz), addTo<T>(at + 7 * s, -yz),
      addTo<T>(at + 8 * s, -zz);
}

template <class T>
HAIRMESH_INLINE void addColumns(const ColumnModel<T>& model, const ColumnLayout& layout, const ColumnField<T>& x,
                                Sums<T>& sums) {
  for (int c = 0; c < layout.columns; ++c) {
    const int first = layout.first(c);
    for (int l = 0; l < model.vertical_lanes[c]; l += kLanes) {
      addStretch<T>(model.vertical, static_cast<std::size_t>(c) * layout.stride + l, x, first + l, first + l + 1,
                    {model.diagonal[c], model.diagonal[c] + 1}, model.vertical_pairs[c], l, sums);
    }
  }
}

template <class T>
HAIRMESH_INLINE void addRootEdges(const ColumnModel<T>& model, const ColumnLayout& layout, const ColumnField<T>& x,
                                  Sums<T>& sums) {
  for (const typename ColumnModel<T>::RootEdge& edge : model.edges) {
    const int a = layout.first(edge.a), b = layout.first(edge.b);
    for (int l = 0; l < layout.stride && l < edge.walls + kLanes; l += kLanes) {
      addStretch<T>(model.horizontal, edge.first + l, x, a + l, b + l, {model.diagonal[edge.a], model.diagonal[edge.b]},
                    edge.rung, l, sums);
    }
    for (int l = 0; l < edge.walls; l += kLanes) {
      const std::size_t e = edge.first + l;
      const std::array<int, 4> at{a + l, b + l, b + l + 1, a + l + 1};
      V3<Lanes<T>> p[4];
      for (int k = 0; k < 4; ++k) p[k] = loadAt(x, at[k]);
      addCondition<T, 4>(
          shearCondition(p, load<T>(model.inverse_along.data() + e), load<T>(model.inverse_across.data() + e)),
          load<T>(model.shear_stiffness.data() + e), load<T>(model.shear_shift.data() + e), at, edge.wall_diagonal,
          edge.wall_pairs.data(), l, sums);
    }
    for (int l = 0; l < edge.hinges; l += kLanes) {
      const std::size_t e = edge.first + l;
      const std::array<int, 6> at{a + l, b + l, a + l + 1, b + l + 1, a + l + 2, b + l + 2};
      V3<Lanes<T>> p[6];
      for (int k = 0; k < 6; ++k) p[k] = loadAt(x, at[k]);
      addCondition<T, 6>(
          bendCondition(p, load<T>(model.bend_rest_angle.data() + e), load<T>(model.bend_inverse_length.data() + e),
                        load<T>(model.bend_smallest_square.data() + e)),
          load<T>(model.bend_stiffness.data() + e), constant<Lanes<T>>(0), at,
          {edge.hinge_a[0], edge.hinge_b[0], edge.hinge_a[1], edge.hinge_b[1], edge.hinge_a[2], edge.hinge_b[2]},
          edge.hinge_pairs.data(), l, sums);
    }
  }
}

template <class T>
HAIRMESH_INLINE void addFaces(const ColumnModel<T>& model, const ColumnLayout& layout, const ColumnField<T>& x,
                              Sums<T>& sums) {
  for (const typename ColumnModel<T>::Face& face : model.faces) {
    for (int l = 0; l < face.prisms; l += kLanes) {
      for (int k = 0; k < 2 * face.corner_count; ++k) {
        const std::size_t e = face.first + static_cast<std::size_t>(k) * layout.stride + l;
        std::array<int, 4> at, diagonals;
        V3<Lanes<T>> p[4];
        for (int v = 0; v < 4; ++v) {
          at[v] = layout.first(face.columns_of[k][v]) + face.layers_of[k][v] + l;
          diagonals[v] = model.diagonal[face.columns_of[k][v]] + face.layers_of[k][v];
          p[v] = loadAt(x, at[v]);
        }
        addCondition<T, 4>(volumeCondition(p, load<T>(model.volume_rest.data() + e)),
                           load<T>(model.volume_stiffness.data() + e), constant<Lanes<T>>(0), at, diagonals,
                           face.pairs[k].data(), l, sums);
      }
    }
  }
}

template <class T>
HAIRMESH_INLINE void evaluateAll(const ColumnModel<T>& model, const ColumnLayout& layout, const ColumnField<T>& x,
                                 Sums<T>& sums) {
  addColumns(model, layout, x, sums);
  addRootEdges(model, layout, x, sums);
  addFaces(model, layout, x, sums);
}

HAIRMESH_CLONES void run(const ColumnModel<float>& m, const ColumnLayout& l, const ColumnField<float>& x,
                         Sums<float>& s) {
  evaluateAll(m, l, x, s);
}
HAIRMESH_CLONES void run(const ColumnModel<double>& m, const ColumnLayout& l, const ColumnField<double>& x,
                         Sums<double>& s) {
  evaluateAll(m, l, x, s);
}

}  // namespace

template <class T>
T evaluate(const ColumnModel<T>& model, const ColumnLayout& layout, const ColumnField<T>& x,
           const ColumnEvaluation<T>& out) {
  const auto all = [](T value) { return Lanes<T>{} + value; };
  Sums<T> sums{out.force,
               out.velocity,
               out.matrix ? out.matrix->values.data() : nullptr,
               static_cast<std::size_t>(layout.stride),
               all(out.matrix_scale),
               all(out.tension_scale),
               all(out.damping),
               all(0)};
  run(model, layout, x, sums);
  T energy = 0;
  for (int k = 0; k < kLanes; ++k) energy += sums.energy[k];
  return energy / 2;
}

template float evaluate(const ColumnModel<float>&, const ColumnLayout&, const ColumnField<float>&,
                        const ColumnEvaluation<float>&);
template double evaluate(const ColumnModel<double>&, const ColumnLayout&, const ColumnField<double>&,
                         const ColumnEvaluation<double>&);

}  // namespace sim

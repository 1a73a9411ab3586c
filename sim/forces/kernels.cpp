// The kernels: kLanes layers of one column, root edge or face at a time.
//
// k: stiffness, c: condition less its shift, g: its gradient; see force_kind.h.
//
// The terms of a wall with its hinge, or of a prism, are summed by block and added to memory once. Blocks one layer
// apart overlap in memory, and a load that overlaps an unfinished store stalls: they are added far from each other, or
// shifted onto each other in registers.
#include "sim/forces/kernels.h"

#include "sim/forces/prism_shares.h"

namespace sim {
namespace {

// The sums of an evaluation.
template <class T>
struct Sums {
  ColumnField<T>* force;
  const ColumnField<T>* velocity;
  T* values;
  std::size_t stride;
  Lanes<T> matrix_scale, tension_scale, damping, energy;
  const T* damping_share;  // null: 1 everywhere
};

// Of the elements whose vertices have these entries: damping, s, and what their Hessians are multiplied by.
template <class T>
struct Damping {
  Lanes<T> time, matrix_scale;
};
template <class T>
HAIRMESH_INLINE Damping<T> dampingOf(const Sums<T>& sums, const auto&... entries) {
  if (!sums.damping_share) return {sums.damping, sums.matrix_scale};
  const Lanes<T> share = constant<Lanes<T>>(1.0 / sizeof...(entries)) * (load<T>(sums.damping_share + entries) + ...);
  return {share * sums.damping, sums.tension_scale + share * (sums.matrix_scale - sums.tension_scale)};
}

// Blocks of kLanes layers: symmetric ones as xx, xy, xz, yy, yz, zz, others row by row.
template <class T>
struct OwnBlock {
  Lanes<T> m[6] = {};
  HAIRMESH_INLINE void addSquare(const V3<Lanes<T>>& a) {
    m[0] += a.x * a.x, m[1] += a.x * a.y, m[2] += a.x * a.z;
    m[3] += a.y * a.y, m[4] += a.y * a.z, m[5] += a.z * a.z;
  }
  HAIRMESH_INLINE void addUnit(const Lanes<T>& scale) { m[0] += scale, m[3] += scale, m[5] += scale; }
  HAIRMESH_INLINE void addTo(T* at, std::size_t stride) const {
    for (int k = 0; k < 6; ++k) sim::addTo<T>(at + k * stride, m[k]);
  }
};
template <class T>
struct PairBlock {
  Lanes<T> m[9] = {};
  HAIRMESH_INLINE void addOuter(const V3<Lanes<T>>& a, const V3<Lanes<T>>& b) {
    m[0] += a.x * b.x, m[1] += a.x * b.y, m[2] += a.x * b.z;
    m[3] += a.y * b.x, m[4] += a.y * b.y, m[5] += a.y * b.z;
    m[6] += a.z * b.x, m[7] += a.z * b.y, m[8] += a.z * b.z;
  }
  HAIRMESH_INLINE void addUnit(const Lanes<T>& scale) { m[0] += scale, m[4] += scale, m[8] += scale; }
  HAIRMESH_INLINE void subtract(const OwnBlock<T>& block) {
    constexpr int kPlace[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
    for (int k = 0; k < 9; ++k) m[k] -= block.m[kPlace[k]];
  }
  HAIRMESH_INLINE void addTo(T* at, std::size_t stride) const {
    for (int k = 0; k < 9; ++k) sim::addTo<T>(at + k * stride, m[k]);
  }
};

// Force along -g of a condition, elastic and damping. `rate` gives dC/dt.
template <class T>
HAIRMESH_INLINE Lanes<T> pullOf(const Lanes<T>& c, const Lanes<T>& k, const Lanes<T>& damping, Sums<T>& sums,
                                const auto& rate) {
  Lanes<T> pull = k * c;
  sums.energy += pull * c;
  if (sums.velocity) {
    const Lanes<T> speed = rate(), resistance = damping * k * speed;
    pull += resistance;
    sums.energy += resistance * speed;
  }
  return pull;
}

// The same, with dC/dt from the gradient: vertex v of the condition has entry at(v).
template <class T, int N>
HAIRMESH_INLINE Lanes<T> pullOf(const Lanes<T>& c, const Lanes<T>& k, const Lanes<T>& damping, Sums<T>& sums,
                                const V3<Lanes<T>> (&g)[N], const auto& at) {
  return pullOf<T>(c, k, damping, sums, [&] {
    Lanes<T> rate = constant<Lanes<T>>(0);
    for (int v = 0; v < N; ++v) rate += dot(g[v], loadAt(*sums.velocity, at(v)));
    return rate;
  });
}

// Stretch of kLanes edges between entries a and b.
template <class T>
struct StretchTerms {
  V3<Lanes<T>> push;  // force on a; that on b is the opposite
  OwnBlock<T> block;  // of a and of b; that between them is the opposite
};
template <class T>
HAIRMESH_INLINE StretchTerms<T> stretchTerms(const typename ColumnModel<T>::StretchArrays& elements, std::size_t e,
                                             const ColumnField<T>& x, int a, int b, Sums<T>& sums) {
  const auto stretch = stretchCondition(loadAt(x, a), loadAt(x, b), load<T>(elements.inverse_length.data() + e));
  const V3<Lanes<T>>& d = stretch.direction;
  const V3<Lanes<T>> g = stretch.inverse_length * d;
  const Lanes<T> k = load<T>(elements.stiffness.data() + e), c = stretch.value - load<T>(elements.shift.data() + e);
  const Damping<T> damping = dampingOf(sums, a, b);
  const Lanes<T> pull = pullOf<T>(c, k, damping.time, sums,
                                  [&] { return dot(g, loadAt(*sums.velocity, b) - loadAt(*sums.velocity, a)); });
  const Lanes<T> zero = constant<Lanes<T>>(0), tension = k * c;
  const Lanes<T> turn = (tension > zero ? tension : zero) * sums.tension_scale * stretch.tension_slope;
  const Lanes<T> axial = damping.matrix_scale * k * stretch.inverse_length * stretch.inverse_length - turn;
  const V3<Lanes<T>> ad = axial * d;
  return {pull * g, {{ad.x * d.x + turn, ad.x * d.y, ad.x * d.z, ad.y * d.y + turn, ad.y * d.z, ad.z * d.z + turn}}};
}

// Every column's own edges. A vertex takes the terms of the edge above it and, shifted by one layer, of the one below.
template <class T>
HAIRMESH_INLINE void addColumns(const ColumnModel<T>& model, const ColumnLayout& layout, const ColumnField<T>& x,
                                Sums<T>& sums) {
  const Lanes<T> zero = constant<Lanes<T>>(0);
  for (int c = 0; c < layout.columns; ++c) {
    StretchTerms<T> below{{zero, zero, zero}, {}};
    for (int l = 0; l < model.column_lanes[c]; l += kLanes) {
      const int at = layout.first(c) + l;
      const StretchTerms<T> terms =
          stretchTerms<T>(model.vertical, static_cast<std::size_t>(c) * layout.stride + l, x, at, at + 1, sums);
      if (sums.force) {
        const V3<Lanes<T>>&p = terms.push, &q = below.push;
        addAt(*sums.force, at, p - V3<Lanes<T>>{shifted<T>(q.x, p.x), shifted<T>(q.y, p.y), shifted<T>(q.z, p.z)});
      }
      if (sums.values) {
        PairBlock<T> between;
        between.subtract(terms.block);
        between.addTo(sums.values + model.vertical_pairs[c].at + l, sums.stride);
        OwnBlock<T> own = terms.block;
        for (int k = 0; k < 6; ++k) own.m[k] += shifted<T>(below.block.m[k], terms.block.m[k]);
        own.addTo(sums.values + model.diagonal[c] + l, sums.stride);
      }
      below = terms;
    }
  }
}

constexpr std::array<int, 4> kWall{0, 1, 3, 2};  // a wall's corners as wound, among the joint's vertices

// What kLanes walls, with their lower sides and hinges, add to the matrix.
template <class T>
struct WallShare {
  V3<Lanes<T>> s[4], g[6];  // gradients of shear and bend, by the joint's vertices, times the root of their weight
  OwnBlock<T> side;
  Lanes<T> crush;
  bool crushed;
};

template <class T>
HAIRMESH_INLINE void addBlocks(const WallShare<T>& share, const typename ColumnModel<T>::RootEdge& edge, int layer,
                               Sums<T>& sums) {
  const auto addOwn = [&](int v) {
    OwnBlock<T> block;
    if (v < 2) block = share.side;
    if (v < 4) block.addSquare(share.s[v]);
    block.addSquare(share.g[v]);
    if (share.crushed) block.addUnit(constant<Lanes<T>>(crushWeight(v, v)) * share.crush);
    block.addTo(sums.values + edge.own[v] + layer, sums.stride);
  };
  const auto addPair = [&](int pair) {
    const BlockPlace& place = edge.pairs[pair];
    const int u = kJointPairs[pair][place.transposed], v = kJointPairs[pair][1 - place.transposed];
    PairBlock<T> block;
    block.addOuter(share.g[u], share.g[v]);
    if (u < 4 && v < 4) block.addOuter(share.s[u], share.s[v]);
    if (pair == 0) block.subtract(share.side);
    if (share.crushed) block.addUnit(constant<Lanes<T>>(crushWeight(u, v)) * share.crush);
    block.addTo(sums.values + place.at + layer, sums.stride);
  };
  // Lower, lower with uppermost, middle, lower with middle, uppermost, middle with uppermost.
  for (int part = 0; part < 3; ++part) {
    addOwn(2 * part), addOwn(2 * part + 1);
    for (int pair = 5 * part; pair < 5 * part + 5; ++pair) addPair(pair);
  }
}

// The walls of kLanes layers over a root edge, each with its lower side and its hinge to the wall above.
template <class T>
HAIRMESH_INLINE void addWalls(const ColumnModel<T>& model, const typename ColumnModel<T>::RootEdge& edge,
                              const std::array<int, 6>& at, int layer, const ColumnField<T>& x, Sums<T>& sums) {
  using V = V3<Lanes<T>>;
  const std::size_t e = edge.first + layer;
  V p[6];
  for (int v = 0; v < 6; ++v) p[v] = loadAt(x, at[v]);
  const V wall[4] = {p[0], p[1], p[3], p[2]};
  const auto shear =
      shearCondition(wall, load<T>(model.inverse_along.data() + e), load<T>(model.inverse_across.data() + e));
  const auto bend =
      bendCondition(p, load<T>(model.bend_rest_angle.data() + e), load<T>(model.bend_inverse_length.data() + e),
                    load<T>(model.bend_smallest_square.data() + e));
  const Lanes<T> k_shear = load<T>(model.shear_stiffness.data() + e), k_bend = load<T>(model.bend_stiffness.data() + e);
  const Damping<T> of_wall = dampingOf(sums, at[0], at[1], at[2], at[3]),
                   of_hinge = dampingOf(sums, at[0], at[1], at[2], at[3], at[4], at[5]);
  const Lanes<T> shear_pull = pullOf<T>(shear.value - load<T>(model.shear_shift.data() + e), k_shear, of_wall.time,
                                        sums, shear.g, [&](int v) { return at[kWall[v]]; });
  const Lanes<T> bend_pull = pullOf<T>(bend.value, k_bend, of_hinge.time, sums, bend.g, [&](int v) { return at[v]; });
  const StretchTerms<T> side = stretchTerms<T>(model.horizontal, e, x, at[0], at[1], sums);
  if (sums.force) {
    V push[6];
    for (int v = 0; v < 6; ++v) push[v] = -bend_pull * bend.g[v];
    for (int v = 0; v < 4; ++v) push[kWall[v]] -= shear_pull * shear.g[v];
    push[0] += side.push, push[1] -= side.push;
    for (int v = 0; v < 6; ++v) addAt(*sums.force, at[v], push[v]);
  }
  if (!sums.values) return;
  WallShare<T> share;
  const Lanes<T> shear_root = squareRoot(of_wall.matrix_scale * k_shear),
                 bend_root = squareRoot(of_hinge.matrix_scale * k_bend);
  for (int v = 0; v < 4; ++v) share.s[kWall[v]] = shear_root * shear.g[v];
  for (int v = 0; v < 6; ++v) share.g[v] = bend_root * bend.g[v];
  share.side = side.block;
  share.crushed = anyOf(bend.crush > constant<Lanes<T>>(0));
  share.crush = sums.tension_scale * k_bend * bend.crush;
  addBlocks(share, edge, layer, sums);
}

template <class T>
HAIRMESH_INLINE void addEdges(const ColumnModel<T>& model, const ColumnLayout& layout, const ColumnField<T>& x,
                              Sums<T>& sums) {
  for (const typename ColumnModel<T>::RootEdge& edge : model.edges) {
    const int a = layout.first(edge.a), b = layout.first(edge.b);
    const int walls = model.has_shear || model.has_bend ? edge.walls : 0;
    for (int l = 0; l < walls; l += kLanes) {
      addWalls(model, edge, {a + l, b + l, a + l + 1, b + l + 1, a + l + 2, b + l + 2}, l, x, sums);
    }
    // Sides without a wall: the uppermost, where the lanes of the walls do not reach them.
    for (int l = walls; l < edge.sides; l += kLanes) {
      const StretchTerms<T> side = stretchTerms<T>(model.horizontal, edge.first + l, x, a + l, b + l, sums);
      if (sums.force) {
        const Lanes<T> zero = constant<Lanes<T>>(0);
        addAt(*sums.force, a + l, side.push);
        addAt(*sums.force, b + l, V3<Lanes<T>>{zero, zero, zero} - side.push);
      }
      if (!sums.values) continue;
      for (const int own : {edge.own[0], edge.own[1]}) side.block.addTo(sums.values + own + l, sums.stride);
      PairBlock<T> between;
      between.subtract(side.block);
      between.addTo(sums.values + edge.pairs[0].at + l, sums.stride);
    }
  }
}

// The corner tetrahedra of kLanes prisms over a face of N corners.
template <class T, int N>
HAIRMESH_INLINE void addPrisms(const ColumnModel<T>& model, const typename ColumnModel<T>::Face& face,
                               const std::array<int, 2 * N>& at, int layer, const ColumnField<T>& x, Sums<T>& sums) {
  using V = V3<Lanes<T>>;
  constexpr const PrismShares<N>& shares = kPrismShares<N>;
  constexpr int kVertices = 2 * N;
  const Lanes<T> zero = constant<Lanes<T>>(0);
  V p[kVertices], push[kVertices];
  V g[4 * kVertices];  // gradients times the root of what they weigh in the matrix
  for (int v = 0; v < kVertices; ++v) {
    p[v] = loadAt(x, at[v]);
    push[v] = {zero, zero, zero};
  }
  for (int k = 0; k < kVertices; ++k) {
    const std::size_t e = face.first + k * sums.stride + layer;
    const std::array<int, 4>& tet = shares.tets[k];
    const V corners[4] = {p[tet[0]], p[tet[1]], p[tet[2]], p[tet[3]]};
    const auto volume = volumeCondition(corners, load<T>(model.volume_rest.data() + e));
    const Lanes<T> stiffness = load<T>(model.volume_stiffness.data() + e);
    const Damping<T> damping = dampingOf(sums, at[tet[0]], at[tet[1]], at[tet[2]], at[tet[3]]);
    const Lanes<T> pull =
        pullOf<T>(volume.value, stiffness, damping.time, sums, volume.g, [&](int v) { return at[tet[v]]; });
    const Lanes<T> root = squareRoot(damping.matrix_scale * stiffness);
    for (int v = 0; v < 4; ++v) {
      push[tet[v]] -= pull * volume.g[v];
      g[4 * k + v] = root * volume.g[v];
    }
  }
  if (sums.force) {
    for (int v = 0; v < kVertices; ++v) addAt(*sums.force, at[v], push[v]);
  }
  if (!sums.values) return;
  const auto addOwn = [&](int first) {
    for (int v = first; v < first + N; ++v) {
      OwnBlock<T> block;
      for (const int place : shares.place_in[v]) block.addSquare(g[place]);
      block.addTo(sums.values + model.diagonal[face.columns[v % N]] + v / N + layer, sums.stride);
    }
  };
  const auto addPairs = [&](int first, int end) {
    for (int pair = first; pair < end; ++pair) {
      const auto& coupling = shares.pairs[pair];
      const BlockPlace& place = face.pairs[pair];
      PairBlock<T> block;
      for (int k = 0; k < coupling.shares; ++k) {
        const V& u = g[4 * coupling.share[k].tet + coupling.share[k].p];
        const V& v = g[4 * coupling.share[k].tet + coupling.share[k].q];
        block.addOuter(place.transposed ? v : u, place.transposed ? u : v);
      }
      block.addTo(sums.values + place.at + layer, sums.stride);
    }
  };
  addOwn(0);
  addPairs(0, shares.kLayerPairs);
  addPairs(shares.kLayerPairs, shares.kPairs - shares.kLayerPairs);
  addOwn(N);
  addPairs(shares.kPairs - shares.kLayerPairs, shares.kPairs);
}

template <class T, int N>
HAIRMESH_INLINE void addFace(const ColumnModel<T>& model, const ColumnLayout& layout,
                             const typename ColumnModel<T>::Face& face, const ColumnField<T>& x, Sums<T>& sums) {
  for (int l = 0; l < face.prisms; l += kLanes) {
    std::array<int, 2 * N> at;
    for (int v = 0; v < 2 * N; ++v) at[v] = layout.first(face.columns[v % N]) + v / N + l;
    addPrisms<T, N>(model, face, at, l, x, sums);
  }
}

template <class T>
HAIRMESH_INLINE void addFaces(const ColumnModel<T>& model, const ColumnLayout& layout, const ColumnField<T>& x,
                              Sums<T>& sums) {
  for (const typename ColumnModel<T>::Face& face : model.faces) {
    if (face.corner_count == 4)
      addFace<T, 4>(model, layout, face, x, sums);
    else
      addFace<T, 3>(model, layout, face, x, sums);
  }
}

template <class T>
HAIRMESH_INLINE void evaluateAll(const ColumnModel<T>& model, const ColumnLayout& layout, const ColumnField<T>& x,
                                 Sums<T>& sums) {
  if (model.has_vertical) addColumns(model, layout, x, sums);
  if (model.has_horizontal || model.has_shear || model.has_bend) addEdges(model, layout, x, sums);
  if (model.has_volume) addFaces(model, layout, x, sums);
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
               all(0),
               out.damping_share.empty() ? nullptr : out.damping_share.data()};
  run(model, layout, x, sums);
  T energy = 0;
  for (int k = 0; k < kLanes; ++k) energy += sums.energy[k];
  energy /= 2;
  model.plain.forEach([&](const auto& elements) {
    if (elements.size() > 0) evaluateElements(elements, ColumnSums<T>{layout, x, out}, energy);
  });
  return energy;
}

template float evaluate(const ColumnModel<float>&, const ColumnLayout&, const ColumnField<float>&,
                        const ColumnEvaluation<float>&);
template double evaluate(const ColumnModel<double>&, const ColumnLayout&, const ColumnField<double>&,
                         const ColumnEvaluation<double>&);

}  // namespace sim

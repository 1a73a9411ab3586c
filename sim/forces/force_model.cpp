#include "sim/forces/force_model.h"

#include <algorithm>
#include <cmath>

#include "sim/block_cholesky.h"

namespace sim {
namespace {

V3<double> plain(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

template <class Table, std::size_t N>
void addElement(Table& elements, const BlockPattern& pattern, const std::array<int, N>& vertices, double stiffness) {
  elements.vertices.push_back(vertices);
  elements.stiffness.push_back(stiffness);
  elements.shift.push_back(0);
  auto& slots = elements.slots.emplace_back();
  int pair = 0;
  for (std::size_t p = 0; p < N; ++p) {
    for (std::size_t q = p + 1; q < N; ++q) {
      slots[pair++] = pattern.find(std::max(vertices[p], vertices[q]), std::min(vertices[p], vertices[q]));
    }
  }
}

double length(const HairMesh& mesh, int a, int b) {
  return (mesh.shape.positions[b] - mesh.shape.positions[a]).norm();
}

void addStretch(const HairMesh& mesh, const BlockPattern& pattern, const SimParams& params, ForceModel<double>& model) {
  const auto add = [&](const Edge& edge, double modulus) {
    if (modulus * edge.volume <= 0) return;
    addElement(model.stretch, pattern, std::array{edge.a, edge.b}, modulus * edge.volume);
    model.stretch.inverse_length.push_back(1 / edge.rest_length);
  };
  for (const Edge& edge : mesh.vertical_edges) add(edge, params.stretch_along);
  // A horizontal edge carries the walls' stretch across the hair and its own.
  for (const Edge& edge : mesh.horizontal_edges) add(edge, params.stretch_across + params.stretch_edge);
}

void addShear(const HairMesh& mesh, const BlockPattern& pattern, const SimParams& params, ForceModel<double>& model) {
  if (params.shear <= 0) return;
  for (const Wall& wall : mesh.walls) {
    addElement(model.shear, pattern, wall.v, params.shear * wall.volume);
    const double along = (length(mesh, wall.v[0], wall.v[3]) + length(mesh, wall.v[1], wall.v[2])) / 2;
    const double across = (length(mesh, wall.v[0], wall.v[1]) + length(mesh, wall.v[3], wall.v[2])) / 2;
    model.shear.inverse_along.push_back(1 / along);
    model.shear.inverse_across.push_back(1 / across);
    V3<double> p[4];
    for (int k = 0; k < 4; ++k) p[k] = plain(mesh.shape.positions[wall.v[k]]);
    model.shear.shift.back() = shearCondition(p, 1 / along, 1 / across).value;
  }
}

void addBend(const HairMesh& mesh, const BlockPattern& pattern, const SimParams& params, ForceModel<double>& model) {
  if (params.bend <= 0) return;
  for (const Hinge& hinge : mesh.hinges) {
    addElement(model.bend, pattern, hinge.v, params.bend * hinge.volume);
    model.bend.rest_angle.push_back(hinge.rest_angle);
    model.bend.inverse_length.push_back(1 / hinge.length);
    // Below a tenth of its rest height a wall counts as collapsed.
    const double area = 0.1 * hinge.length * length(mesh, hinge.v[2], hinge.v[3]);
    model.bend.smallest_square.push_back(area * area);
  }
}

void addVolume(const HairMesh& mesh, const BlockPattern& pattern, const SimParams& params, ForceModel<double>& model) {
  if (params.volume <= 0) return;
  for (const CornerTet& tet : mesh.tets) {
    addElement(model.volume, pattern, tet.v, params.volume * tet.volume / (tet.rest_volume * tet.rest_volume));
    model.volume.rest_volume.push_back(tet.rest_volume);
  }
}

// The rest shifts that let the styled pose carry gravity. With C = shift + (change) at that pose, balance asks for
// sum k s g = M a with s the extra shift and a = -gravity up; of all solutions the one of least energy is s = -g . y,
// where K y = M (0, -gravity, 0) and K = sum k g g^T over the free vertices: one linear solve.
void solveRestShifts(const HairMesh& mesh, const BlockPattern& pattern, const SimParams& params,
                     ForceModel<double>& model) {
  const int n = mesh.vertexCount();
  std::vector<V3<double>> x(n);
  for (int v = 0; v < n; ++v) x[v] = plain(mesh.shape.positions[v]);
  BlockMatrix<double> stiffness(&pattern);
  Evaluation<double> out;
  out.matrix = &stiffness;
  out.matrix_scale = 1;
  evaluate<double>(model, x, out);

  std::vector<unsigned char> free_vertex(n);
  std::vector<V3<double>> load(n, V3<double>{0, 0, 0}), y(n), residual(n), more(n);
  double scale = 0;
  for (int i = 0; i < n; ++i) scale = std::max(scale, stiffness.diagonal[i].m[0]);
  for (int i = 0; i < n; ++i) {
    free_vertex[i] = !mesh.isRoot(i);
    if (free_vertex[i]) load[i].y = -params.density * mesh.vertex_volume[i] * params.gravity;
    // A material without bend or shear leaves modes without stiffness; the smallest share keeps the solve defined.
    for (int k = 0; k < 9; k += 4) stiffness.diagonal[i].m[k] += 1e-13 * scale;
  }
  BlockCholesky<double> factor;
  factor.analyze(mesh, pattern, free_vertex);
  if (!factor.factor(stiffness)) return;
  factor.solve(load, y);
  multiply<double>(stiffness, y, residual);
  for (int i = 0; i < n; ++i) residual[i] = load[i] - residual[i];
  factor.solve(residual, more);
  for (int i = 0; i < n; ++i) {
    y[i] += more[i];
    if (!std::isfinite(dot(y[i], y[i]))) return;
  }
  const auto bounded = [](double change, double bound) { return std::clamp(change, -bound, bound); };
  for (std::size_t e = 0; e < model.stretch.size(); ++e) {
    const auto [a, b] = model.stretch.vertices[e];
    const auto s = stretchCondition(x[a], x[b], model.stretch.inverse_length[e]);
    model.stretch.shift[e] -= bounded(s.inverse_length * dot(s.direction, y[b] - y[a]), 0.5);
  }
  const auto shift = [&]<int N>(Elements<double, N>& elements, const auto& conditionOf, const auto& bound) {
    for (std::size_t e = 0; e < elements.size(); ++e) {
      V3<double> p[N];
      for (int k = 0; k < N; ++k) p[k] = x[elements.vertices[e][k]];
      const Condition<double, N> c = conditionOf(e, p);
      double change = 0;
      for (int k = 0; k < N; ++k) change += dot(c.g[k], y[elements.vertices[e][k]]);
      elements.shift[e] -= bounded(change, bound(e));
    }
  };
  shift(
      model.shear,
      [&](std::size_t e, const V3<double>* p) {
        return shearCondition(p, model.shear.inverse_along[e], model.shear.inverse_across[e]);
      },
      [](std::size_t) { return 0.5; });
  shift(
      model.bend,
      [&](std::size_t e, const V3<double>* p) {
        return bendCondition(p, model.bend.rest_angle[e], model.bend.inverse_length[e], model.bend.smallest_square[e]);
      },
      [&](std::size_t e) { return 1.0 * model.bend.inverse_length[e]; });
  shift(
      model.volume, [&](std::size_t e, const V3<double>* p) { return volumeCondition(p, model.volume.rest_volume[e]); },
      [&](std::size_t e) { return 0.5 * model.volume.rest_volume[e]; });
}

template <class T>
std::vector<T> converted(const std::vector<double>& values) {
  return std::vector<T>(values.begin(), values.end());
}

template <class T, int N>
void convertElements(const Elements<double, N>& from, Elements<T, N>& to) {
  to.vertices = from.vertices;
  to.slots = from.slots;
  to.stiffness = converted<T>(from.stiffness);
  to.shift = converted<T>(from.shift);
}

}  // namespace

BlockPattern systemPattern(const HairMesh& mesh) {
  std::vector<std::pair<int, int>> pairs;
  const auto add = [&](const auto& v) {
    for (std::size_t p = 0; p < v.size(); ++p) {
      for (std::size_t q = p + 1; q < v.size(); ++q) pairs.emplace_back(v[p], v[q]);
    }
  };
  for (const Wall& wall : mesh.walls) add(wall.v);
  for (const Hinge& hinge : mesh.hinges) add(hinge.v);
  for (const CornerTet& tet : mesh.tets) add(tet.v);
  return makePattern(mesh.vertexCount(), std::move(pairs));
}

ForceModel<double> makeForceModel(const HairMesh& mesh, const BlockPattern& pattern, const SimParams& params) {
  ForceModel<double> model;
  addStretch(mesh, pattern, params, model);
  addShear(mesh, pattern, params, model);
  addBend(mesh, pattern, params, model);
  addVolume(mesh, pattern, params, model);
  if (params.sag_free && params.gravity > 0) solveRestShifts(mesh, pattern, params, model);
  return model;
}

template <class T>
ForceModel<T> convertModel(const ForceModel<double>& model) {
  ForceModel<T> out;
  convertElements(model.stretch, out.stretch);
  convertElements(model.shear, out.shear);
  convertElements(model.bend, out.bend);
  convertElements(model.volume, out.volume);
  out.stretch.inverse_length = converted<T>(model.stretch.inverse_length);
  out.shear.inverse_along = converted<T>(model.shear.inverse_along);
  out.shear.inverse_across = converted<T>(model.shear.inverse_across);
  out.bend.rest_angle = converted<T>(model.bend.rest_angle);
  out.bend.inverse_length = converted<T>(model.bend.inverse_length);
  out.bend.smallest_square = converted<T>(model.bend.smallest_square);
  out.volume.rest_volume = converted<T>(model.volume.rest_volume);
  return out;
}

template ForceModel<float> convertModel(const ForceModel<double>&);
template ForceModel<double> convertModel(const ForceModel<double>&);

}  // namespace sim

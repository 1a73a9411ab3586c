#include "sim/forces/force_model.h"

#include <algorithm>

namespace sim {
namespace {

constexpr double kResolvedSection = 1.5e-4;  // m^2
constexpr double kCarrying =
    2 * 9.81;  // m/s^2, times density and length: a modulus that still carries the hair's weight

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
    // Below three tenths of its rest height a wall counts as collapsed.
    const double area = 0.3 * hinge.length * length(mesh, hinge.v[2], hinge.v[3]);
    model.bend.smallest_square.push_back(area * area);
  }
}

void addVolume(const HairMesh& mesh, const BlockPattern& pattern, const SimParams& params, ForceModel<double>& model) {
  if (params.volume <= 0) return;
  const double modulus = volumeModulus(mesh, params);
  for (const CornerTet& tet : mesh.tets) {
    addElement(model.volume, pattern, tet.v, modulus * tet.volume / (tet.rest_volume * tet.rest_volume));
    model.volume.rest_volume.push_back(tet.rest_volume);
  }
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

double volumeModulus(const HairMesh& mesh, const SimParams& params) {
  double section = 0;  // m^2, of a prism across the hair, mean by volume
  for (const Prism& prism : mesh.prisms) {
    double along = 0;
    for (int k = 0; k < prism.corner_count; ++k) along += length(mesh, prism.v[k], prism.v[prism.corner_count + k]);
    section += prism.volume * prism.volume * prism.corner_count / along;
  }
  section /= mesh.total_volume;
  const double yielding = params.volume * std::min(1.0, kResolvedSection / section);
  return std::max(yielding, std::min(params.volume, kCarrying * params.density * mesh.hair_length));
}

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

ForceModel<double> makeElements(const HairMesh& mesh, const BlockPattern& pattern, const SimParams& params) {
  ForceModel<double> model;
  addStretch(mesh, pattern, params, model);
  addShear(mesh, pattern, params, model);
  addBend(mesh, pattern, params, model);
  addVolume(mesh, pattern, params, model);
  return model;
}

bool setStiffness(const HairMesh& mesh, const SimParams& params, ForceModel<double>& model) {
  const auto count = [](bool on, std::size_t elements) { return on ? elements : 0; };
  if (params.stretch_along <= 0 || params.stretch_across + params.stretch_edge <= 0 ||
      model.stretch.size() != mesh.vertical_edges.size() + mesh.horizontal_edges.size() ||
      model.shear.size() != count(params.shear > 0, mesh.walls.size()) ||
      model.bend.size() != count(params.bend > 0, mesh.hinges.size()) ||
      model.volume.size() != count(params.volume > 0, mesh.tets.size())) {
    return false;
  }
  std::size_t e = 0;
  for (const Edge& edge : mesh.vertical_edges) model.stretch.stiffness[e++] = params.stretch_along * edge.volume;
  const double across = params.stretch_across + params.stretch_edge;
  for (const Edge& edge : mesh.horizontal_edges) model.stretch.stiffness[e++] = across * edge.volume;
  for (e = 0; e < model.shear.size(); ++e) model.shear.stiffness[e] = params.shear * mesh.walls[e].volume;
  for (e = 0; e < model.bend.size(); ++e) model.bend.stiffness[e] = params.bend * mesh.hinges[e].volume;
  const double modulus = volumeModulus(mesh, params);
  for (e = 0; e < model.volume.size(); ++e) {
    const CornerTet& tet = mesh.tets[e];
    model.volume.stiffness[e] = modulus * tet.volume / (tet.rest_volume * tet.rest_volume);
  }
  return true;
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

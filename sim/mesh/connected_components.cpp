#include "sim/mesh/connected_components.h"

#include <algorithm>
#include <numeric>

namespace sim {
namespace {

// Per column, the lowest column that it is connected to.
std::vector<int> lowestConnected(const HairMesh& mesh) {
  std::vector<int> parent(static_cast<std::size_t>(mesh.columnCount()));
  std::iota(parent.begin(), parent.end(), 0);
  const auto find = [&](int c) {
    while (parent[c] != c) c = parent[c] = parent[parent[c]];
    return c;
  };
  for (const RootFace& face : mesh.shape.root_faces) {
    for (int k = 1; k < face.corner_count; ++k) {
      const int a = find(face.columns[0]), b = find(face.columns[k]);
      parent[std::max(a, b)] = std::min(a, b);
    }
  }
  for (std::size_t c = 0; c < parent.size(); ++c) parent[c] = find(static_cast<int>(c));
  return parent;
}

HairPart partOf(const HairMesh& mesh, const std::vector<int>& lowest, int part_column) {
  HairPart part;
  HairMeshShape shape;
  std::vector<int> column_number(lowest.size(), -1);
  part.place.assign(static_cast<std::size_t>(mesh.vertexCount()), -1);
  for (int c = 0; c < mesh.columnCount(); ++c) {
    if (lowest[c] != part_column) continue;
    column_number[c] = shape.columnCount();
    part.columns.push_back(c);
    for (int v = mesh.shape.column_first[c]; v < mesh.shape.column_first[c + 1]; ++v) {
      part.place[v] = static_cast<int>(part.vertices.size());
      part.vertices.push_back(v);
      shape.positions.push_back(mesh.shape.positions[v]);
    }
    shape.column_first.push_back(static_cast<int>(part.vertices.size()));
  }
  for (RootFace face : mesh.shape.root_faces) {
    if (lowest[face.columns[0]] != part_column) continue;
    for (int k = 0; k < face.corner_count; ++k) face.columns[k] = column_number[face.columns[k]];
    shape.root_faces.push_back(face);
  }
  part.mesh = buildHairMesh(std::move(shape));
  return part;
}

void gather(const std::vector<int>& vertices, const std::vector<Vec3>& whole, std::vector<Vec3>& part) {
  part.clear();
  if (whole.empty()) return;
  for (const int v : vertices) part.push_back(whole[v]);
}

void scatter(const std::vector<int>& vertices, const std::vector<Vec3>& part, std::vector<Vec3>& whole) {
  for (std::size_t i = 0; i < part.size() && !whole.empty(); ++i) whole[vertices[i]] = part[i];
}

}  // namespace

std::vector<HairPart> connectedParts(const HairMesh& mesh) {
  const std::vector<int> lowest = lowestConnected(mesh);
  std::vector<HairPart> parts;
  if (std::ranges::all_of(lowest, [](int c) { return c == 0; })) return parts;
  for (int c = 0; c < mesh.columnCount(); ++c) {
    if (lowest[c] == c) parts.push_back(partOf(mesh, lowest, c));
  }
  return parts;
}

void gatherPart(const HairPart& part, const HairState& whole, HairState& state) {
  gather(part.vertices, whole.positions, state.positions);
  gather(part.vertices, whole.velocities, state.velocities);
  gather(part.vertices, whole.previous_positions, state.previous_positions);
  gather(part.vertices, whole.previous_velocities, state.previous_velocities);
  state.previous_dt = whole.previous_dt;
  state.contacts.clear();
  for (const Contact& contact : whole.contacts) {
    if (part.place[contact.vertex] < 0) continue;
    state.contacts.push_back(contact);
    state.contacts.back().vertex = part.place[contact.vertex];
  }
}

void scatterPart(const HairPart& part, const HairState& state, HairState& whole) {
  scatter(part.vertices, state.positions, whole.positions);
  scatter(part.vertices, state.velocities, whole.velocities);
  scatter(part.vertices, state.previous_positions, whole.previous_positions);
  scatter(part.vertices, state.previous_velocities, whole.previous_velocities);
  std::erase_if(whole.contacts, [&](const Contact& contact) { return part.place[contact.vertex] >= 0; });
  for (const Contact& contact : state.contacts) {
    whole.contacts.push_back(contact);
    whole.contacts.back().vertex = part.vertices[contact.vertex];
  }
  // Contacts of one vertex keep their order: insertion by hand, for a stable sort would allocate.
  for (std::size_t i = 1; i < whole.contacts.size(); ++i) {
    for (std::size_t j = i; j > 0 && whole.contacts[j].vertex < whole.contacts[j - 1].vertex; --j)
      std::swap(whole.contacts[j], whole.contacts[j - 1]);
  }
}

void addPart(const StepReport& part, StepReport& whole) {
  for (std::size_t s = 0; s < part.seconds.size(); ++s) whole.seconds[s] += part.seconds[s];
  whole.solver_iterations += part.solver_iterations;
  whole.solves = std::max(whole.solves, part.solves);
  whole.residual = std::max(whole.residual, part.residual);
  whole.residual_acceleration = std::max(whole.residual_acceleration, part.residual_acceleration);
  whole.converged = whole.converged && part.converged;
  whole.contacts += part.contacts;
  whole.corrected += part.corrected;
  whole.minimization_iterations += part.minimization_iterations;
  whole.max_penetration = std::max(whole.max_penetration, part.max_penetration);
  whole.initial_overlap += part.initial_overlap;
  whole.initial_overlap_depth = std::max(whole.initial_overlap_depth, part.initial_overlap_depth);
  whole.self_contacts += part.self_contacts;
  whole.guided += part.guided;
  whole.refreshes += part.refreshes;
  whole.pins += part.pins;
  whole.pins_out_of_reach += part.pins_out_of_reach;
  whole.pin_force = std::max(whole.pin_force, part.pin_force);
  whole.force_kinds += part.force_kinds;
  whole.collider_tests += part.collider_tests;
  whole.work += part.work;
  whole.work_units += part.work_units;
  whole.solve_cut = whole.solve_cut || part.solve_cut;
  whole.corrections_cut = whole.corrections_cut || part.corrections_cut;
  whole.recoveries += part.recoveries;
  if (part.recoveries > 0) whole.fault_report = part.fault_report;
  whole.carried = whole.carried || part.carried;
}

}  // namespace sim

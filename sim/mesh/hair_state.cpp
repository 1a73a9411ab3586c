#include "sim/mesh/hair_state.h"

namespace sim {

void sizeMemory(const HairMesh& mesh, HairMemory& memory) {
  const auto n = static_cast<std::size_t>(mesh.vertexCount()), columns = static_cast<std::size_t>(mesh.columnCount());
  if (memory.recovery.folded.size() == n && memory.recovery.columns.size() == columns &&
      memory.recovery.turned.size() == mesh.tets.size()) {
    return;
  }
  memory = {};
  for (auto* array : {&memory.self_contact.start, &memory.self_contact.end}) array->reserve(n);
  for (PartMemory* part : {&memory.solve.two_level.factors, &memory.solve.two_level.coarse}) {
    part->input.positions.reserve(n);
    part->input.constraints.reserve(n);
  }
  for (auto& change : memory.solve.projection.changes) change.reserve(n);
  memory.recovery.columns.resize(columns);
  memory.recovery.turned.resize(mesh.tets.size());
  memory.recovery.folded.resize(n);
  memory.recovery.target = mesh.shape.positions;
  HairState& reference = memory.rest.reference.emplace_back();
  for (auto* array :
       {&reference.positions, &reference.velocities, &reference.previous_positions, &reference.previous_velocities})
    array->resize(n, Vec3::Zero());
}

}  // namespace sim

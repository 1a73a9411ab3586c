#include "sim/mesh/state_bytes.h"

#include <algorithm>
#include <cstdint>

#include "sim/mesh/field_bytes.h"

namespace sim {
namespace {

constexpr std::uint64_t kMagic = 0x6574617473'6d68;  // "hmstate", read from its last letter

struct Head {
  std::uint64_t magic = kMagic, version = kStateVersion;
  std::uint64_t mesh = 0, size = 0, checksum = 0;  // fingerprint; bytes that follow and their FNV-1a
  HAIRMESH_FIELDS(magic, version, mesh, size, checksum)
};

std::uint64_t meshFingerprint(const HairMesh& mesh) {
  Bytes bytes;
  writeBytes(mesh.shape.positions, bytes);
  writeBytes(mesh.shape.column_first, bytes);
  for (const RootFace& face : mesh.shape.root_faces) {
    for (int k = 0; k < face.corner_count; ++k) writeBytes(face.columns[k], bytes);
  }
  return fingerprint(bytes);
}

bool partFits(const HairMesh& mesh, const PartMemory& part) {
  const auto n = static_cast<std::size_t>(mesh.vertexCount());
  const auto inside = [&](int vertex) { return vertex >= 0 && vertex < mesh.vertexCount(); };
  return (part.input.positions.empty() || part.input.positions.size() == n) &&
         std::ranges::all_of(part.input.constraints, [&](const VertexConstraint& c) {
           return inside(c.vertex) && c.removed >= 0 && c.removed <= 3;
         });
}

// Whether every array has the mesh's size or none, and every number of a vertex is one of the mesh's: bytes may have
// been made by hand.
bool fits(const HairMesh& mesh, const HairState& state) {
  const auto n = static_cast<std::size_t>(mesh.vertexCount()), columns = static_cast<std::size_t>(mesh.columnCount());
  const auto sized = [](std::size_t size, const auto&... arrays) {
    return ((arrays.empty() || arrays.size() == size) && ...);
  };
  const HairMemory& memory = state.memory;
  const bool known = std::ranges::all_of(state.contacts, [&](const Contact& contact) {
    return contact.vertex >= 0 && contact.vertex < mesh.vertexCount() && contact.collider >= 0;
  });
  const SolveMemory& solve = memory.solve;
  const ProjectionMemory& projection = solve.projection;
  bool projects =
      projection.newest >= 0 && projection.newest < 2 && projection.recorded >= 0 && projection.recorded <= 2;
  for (int k = 0; projects && k < projection.recorded; ++k)
    projects = projection.changes[(projection.newest + 2 - k) % 2].size() == n;
  return known && projects && partFits(mesh, solve.two_level.factors) && partFits(mesh, solve.two_level.coarse) &&
         state.positions.size() == n && state.velocities.size() == n &&
         sized(n, state.previous_positions, state.previous_velocities, memory.good.positions, memory.good.velocities,
               memory.recovery.folded, memory.recovery.target, memory.self_contact.start, memory.self_contact.end) &&
         sized(columns, memory.recovery.columns) && sized(mesh.tets.size(), memory.recovery.turned) &&
         memory.rest.reference.size() <= 1 &&
         std::ranges::all_of(memory.rest.reference, [&](const HairState& one) { return fits(mesh, one); });
}

}  // namespace

std::vector<std::byte> saveState(const HairMesh& mesh, const HairState& state) {
  Bytes body, bytes;
  writeBytes(state, body);
  writeBytes(Head{.mesh = meshFingerprint(mesh), .size = body.size(), .checksum = fingerprint(body)}, bytes);
  bytes.insert(bytes.end(), body.begin(), body.end());
  return bytes;
}

std::string loadState(const HairMesh& mesh, std::span<const std::byte> bytes, HairState& state) {
  ByteReader from{bytes};
  Head head;
  readBytes(from, head);
  if (!from.complete || head.magic != kMagic) return "is no saved state; give all the bytes that were saved";
  if (head.version != kStateVersion)
    return "is a state of version " + std::to_string(head.version) + ", not " + std::to_string(kStateVersion) +
           "; save it anew with this program";
  if (head.mesh != meshFingerprint(mesh)) return "is the state of another hair mesh; choose the one it was saved with";
  if (head.size != from.left.size())
    return "has " + std::to_string(bytes.size()) + " bytes where " +
           std::to_string(head.size + (bytes.size() - from.left.size())) + " were saved; save it anew";
  HairState restored;
  const bool changed = fingerprint(from.left) != head.checksum;
  if (!changed) readBytes(from, restored);
  if (changed || !from.complete || !from.left.empty() || !fits(mesh, restored))
    return "has been changed since it was saved; save it anew";
  state = std::move(restored);
  return "";
}

}  // namespace sim

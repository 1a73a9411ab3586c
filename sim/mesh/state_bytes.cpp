#include "sim/mesh/state_bytes.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <tuple>
#include <type_traits>

namespace sim {
namespace {

using Bytes = std::vector<std::byte>;

static_assert(std::endian::native == std::endian::little, "saved states are little endian");

constexpr std::uint64_t kMagic = 0x6574617473'6d68;  // "hmstate", read from its last letter

struct Head {
  std::uint64_t magic = kMagic, version = kStateVersion;
  std::uint64_t mesh = 0, size = 0, checksum = 0;  // fingerprint; bytes that follow and their FNV-1a
  HAIRMESH_FIELDS(magic, version, mesh, size, checksum)
};

template <class T>
concept Numbers = std::is_arithmetic_v<T> || requires {
  T::SizeAtCompileTime;
};  // one, or a fixed matrix of them

template <class T>
concept Array = requires(T& values) {
  values.emplace_back();
};

template <class T>
concept FixedArray = requires(T& values) {
  values.fill(values[0]);
}
&&!Numbers<T>;

template <class T>
void write(const T& value, Bytes& out) {
  if constexpr (Numbers<T>) {
    const auto bytes = std::as_bytes(std::span(&value, 1));
    out.insert(out.end(), bytes.begin(), bytes.end());
  } else if constexpr (FixedArray<T>) {
    for (const auto& one : value) write(one, out);
  } else if constexpr (Array<T>) {
    write(std::uint64_t{value.size()}, out);
    for (const auto& one : value) write(one, out);
  } else if constexpr (std::is_same_v<T, SimParams>) {
    for (const ParamField& field : paramFields()) write(field.get(value), out);
  } else {
    std::apply([&](const auto&... field) { (write(field, out), ...); }, T::fields(value));
  }
}

// What is left to be read; all of it is gone once something was missing.
struct Reader {
  std::span<const std::byte> left;
  bool complete = true;

  bool take(void* to, std::size_t size) {
    if (left.size() < size) {
      complete = false, left = {};
      return false;
    }
    std::memcpy(to, left.data(), size);
    left = left.subspan(size);
    return true;
  }
};

template <class T>
void read(Reader& from, T& value) {
  if constexpr (std::is_same_v<T, bool>) {
    unsigned char byte = 0;
    from.take(&byte, 1);
    value = byte != 0;
  } else if constexpr (Numbers<T>) {
    from.take(static_cast<void*>(&value), sizeof(T));
  } else if constexpr (FixedArray<T>) {
    for (auto& one : value) read(from, one);
  } else if constexpr (Array<T>) {
    std::uint64_t count = 0;
    read(from, count);
    value.clear();
    // One by one: a count that promises more than there is must not take memory.
    for (std::uint64_t i = 0; i < count && from.complete; ++i) read(from, value.emplace_back());
  } else if constexpr (std::is_same_v<T, SimParams>) {
    for (const ParamField& field : paramFields()) {
      double number = 0;
      read(from, number);
      // Limits may have taken a number beyond its slider's range; a choice beyond its own has no meaning.
      const bool fits = field.kind == FieldKind::kReal || (number >= field.minimum && number <= field.maximum);
      if (!fits) from.complete = false;
      if (fits) field.set(value, number);
    }
  } else {
    std::apply([&](auto&... field) { (read(from, field), ...); }, T::fields(value));
  }
}

std::uint64_t fingerprint(std::span<const std::byte> bytes) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const std::byte byte : bytes) hash = (hash ^ static_cast<std::uint64_t>(byte)) * 0x100000001b3ull;
  return hash;
}

std::uint64_t meshFingerprint(const HairMesh& mesh) {
  Bytes bytes;
  write(mesh.shape.positions, bytes);
  write(mesh.shape.column_first, bytes);
  for (const RootFace& face : mesh.shape.root_faces) {
    for (int k = 0; k < face.corner_count; ++k) write(face.columns[k], bytes);
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
               memory.oscillation.last, memory.oscillation.turns, memory.recovery.folded, memory.recovery.target,
               memory.self_contact.start, memory.self_contact.end) &&
         sized(columns, memory.oscillation.carrying, memory.recovery.columns) &&
         sized(mesh.tets.size(), memory.recovery.turned) && memory.rest.reference.size() <= 1 &&
         std::ranges::all_of(memory.rest.reference, [&](const HairState& one) { return fits(mesh, one); });
}

}  // namespace

std::vector<std::byte> saveState(const HairMesh& mesh, const HairState& state) {
  Bytes body, bytes;
  write(state, body);
  write(Head{.mesh = meshFingerprint(mesh), .size = body.size(), .checksum = fingerprint(body)}, bytes);
  bytes.insert(bytes.end(), body.begin(), body.end());
  return bytes;
}

std::string loadState(const HairMesh& mesh, std::span<const std::byte> bytes, HairState& state) {
  Reader from{bytes};
  Head head;
  read(from, head);
  if (!from.complete || head.magic != kMagic) return "is no saved state; give a file that a run saved";
  if (head.version != kStateVersion)
    return "is a state of version " + std::to_string(head.version) + ", not " + std::to_string(kStateVersion) +
           "; save it anew with this program";
  if (head.mesh != meshFingerprint(mesh)) return "is the state of another hair mesh; choose the one it was saved with";
  if (head.size != from.left.size())
    return "has " + std::to_string(from.left.size()) + " bytes where " + std::to_string(head.size) +
           " were saved; save it anew";
  HairState restored;
  const bool changed = fingerprint(from.left) != head.checksum;
  if (!changed) read(from, restored);
  if (changed || !from.complete || !from.left.empty() || !fits(mesh, restored))
    return "has been changed since it was saved; save it anew";
  state = std::move(restored);
  return "";
}

bool sameBits(const HairState& a, const HairState& b) {
  Bytes one, other;
  write(a, one);
  write(b, other);
  return one == other;
}

}  // namespace sim

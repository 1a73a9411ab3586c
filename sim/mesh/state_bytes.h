// A state as bytes: to save it, to restore it in another process, and to tell whether two are the same to the bit.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "sim/mesh/hair_state.h"

namespace sim {

// Of the bytes' layout; another one after every change of a field.
inline constexpr unsigned kStateVersion = 3;

// All of a state. Steps that go on from the restored state end in the same bits as those that go on from the saved one,
// on the same build and processor, with the same input, parameters and settings of the context.
std::vector<std::byte> saveState(const HairMesh& mesh, const HairState& state);

// Returns what is wrong with the bytes (cut off, of another version or mesh, changed) and what would mend it, and
// leaves `state` as it is; "" when it was restored.
std::string loadState(const HairMesh& mesh, std::span<const std::byte> bytes, HairState& state);

}  // namespace sim

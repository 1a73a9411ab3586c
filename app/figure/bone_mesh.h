// The mesh of one rigid body of a figure: an OBJ text of which vertices and faces are read.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "app/figure/character.h"

namespace app {

struct PartMesh {
  std::vector<Vec3> vertices;  // m, in the body's frame
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

// Faces of any number of corners ('v', 'v/t', 'v/t/n', negative ones counting from the end) become fans of triangles;
// lines of other kinds are passed over. `file` names the text in messages. Throws InputError with the line's number.
// Memory used is bounded by a small multiple of the text's length.
PartMesh readPart(std::string_view text, const std::string& file);

}  // namespace app

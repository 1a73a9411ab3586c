// Hair meshes as OBJ text: one group a layer, layer_0 the scalp. The convention is told in assets/hair/README.md.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/mesh/hair_mesh.h"

namespace app {

// Shares, 0 to 1, of a look's values for the strands that root at a column.
struct ColumnShare {
  double clump = 1, curl = 1, frizz = 1, width = 1;
  bool operator==(const ColumnShare&) const = default;
};

// Reads a hair mesh: metres, y up, the head's frame. Columns are numbered in the order of their vertices in layer_0,
// root faces in the order of its faces. `file` names the text in messages. Throws InputError naming the line, the fault
// and the mend; what it returns has passed sim::buildHairMesh. Memory used is bounded by a small multiple of the text's
// length. With `reverse_faces` every face is taken to be wound the other way; `reverse_switch` is what a caller calls
// that, for messages. A mesh whose faces are all wound the wrong way is refused, or with `turned` read the right way
// and told there. `shares`: one a column, or none where the file has none.
sim::HairMeshShape readHairMesh(std::string_view text, const std::string& file, bool reverse_faces = false,
                                const char* reverse_switch = "--reverse-faces", bool* turned = nullptr,
                                std::vector<ColumnShare>* shares = nullptr);

// Writes a hair mesh so that readHairMesh gives back the same bits; `shares`: one a column, or none.
std::string writeHairMesh(const sim::HairMeshShape& shape, std::span<const ColumnShare> shares = {});

}  // namespace app

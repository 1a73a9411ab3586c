// Hair meshes as OBJ text: one group a layer, layer_0 the scalp. The convention is told in assets/hair/README.md.
#pragma once

#include <string>
#include <string_view>

#include "sim/mesh/hair_mesh.h"

namespace app {

// Reads a hair mesh: metres, y up, the head's frame. Columns are numbered in the order of their vertices in layer_0,
// root faces in the order of its faces. `file` names the text in messages. Throws InputError naming the line, the fault
// and the mend; what it returns has passed sim::buildHairMesh. Memory used is bounded by a small multiple of the text's
// length. With `reverse_faces` every face is taken to be wound the other way; `reverse_switch` is what a caller calls
// that, for messages. A mesh whose faces are all wound the wrong way is refused, or with `turned` read the right way
// and told there.
sim::HairMeshShape readHairMesh(std::string_view text, const std::string& file, bool reverse_faces = false,
                                const char* reverse_switch = "--reverse-faces", bool* turned = nullptr);

// Writes a hair mesh so that readHairMesh gives back the same bits.
std::string writeHairMesh(const sim::HairMeshShape& shape);

}  // namespace app

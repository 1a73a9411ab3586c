// A head whose vertices are coloured, as modelling programs paint them: the picture that a field is read from.
#pragma once

#include <string>

#include "app/files/image_io.h"

namespace app {

// Whether the name ends like a mesh that may hold such colours: .obj, .ply, .glb, .gltf, .fbx.
bool hasPaintedEnding(const std::string& file);

// The unrolled head (see field_map.h) with the colours of a mesh's vertices, linear over its faces; what lies outermost
// counts, and where no face lies the nearest colour. The head's middle is that of the sphere nearest to the vertices:
// unit and place of the file do not matter, y is up and z to the front. Colours are taken as they are; a field's value
// is their brightness. Throws InputError for a file without colours or of no shape that goes round a head.
Image readPaintedMesh(const std::string& file);

}  // namespace app

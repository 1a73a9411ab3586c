// Polygon files of modelling programs: OBJ, FBX, glTF and VRM, through assimp.
#pragma once

#include <string>
#include <string_view>

#include "app/groom/strips/polygon_mesh.h"

namespace app {

// All meshes of a file where their nodes put them, quads as quads where the format has them. Skins and morphs are left
// out: the bind pose is what is read. Files over 256 MiB and over 4,000,000 corners are refused. Throws InputError.
PolygonMesh readPolygons(const std::string& file);

// Whether the name ends like such a file's: .obj, .fbx, .glb, .gltf, .vrm.
bool hasPolygonEnding(const std::string& file);

// Whether its format says that y is up: glTF and what is built on it (Khronos, glTF 2.0, 3.4).
bool isYUp(const std::string& file);

// Whether an OBJ text has groups or objects called layer_<n>: then it is a hair mesh of hair_file.h.
bool hasLayers(std::string_view obj_text);

// Whether a file holds hair alone: no bones, no animation. Throws InputError where it cannot be read.
bool holdsStillMeshes(const std::string& file);

}  // namespace app

// The file of a figure as assimp reads it.
#pragma once

#include <assimp/Importer.hpp>
#include <string>

struct aiScene;

namespace app {

// Of glTF, FBX, Collada and OBJ, for as long as the importer lives: triangles alone, equal vertices joined, with
// normals. Throws InputError where the file cannot be read, holds no mesh, or has a vertex at no finite place.
const aiScene& readFigureFile(const std::string& file, Assimp::Importer& importer);

}  // namespace app

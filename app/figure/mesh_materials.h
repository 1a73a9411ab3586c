// Colours that a figure's file brings: base colours of its materials and their pictures.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/figure/character.h"

struct aiScene;
struct aiMesh;

namespace app {

// Numbers of materials in the order in which meshes first use them; SkinnedMesh::material_places name them.
class MaterialList {
 public:
  // Appends a vertex's place on the material of its mesh: its first coordinates, zero where it has none.
  void appendPlace(const aiMesh& mesh, unsigned vertex, SkinnedMesh& into);

  // Fills `into.materials` with a picture for each material: its base colour times its picture, both of glTF's, or the
  // diffuse ones of other formats. Pictures lie in the file or beside it; the largest sets the size, at most 1024
  // texels a side and 64 MiB in all. One that cannot be read is named in `notes` and leaves its material's colour.
  // Places and pictures stay empty where the file says no more than white or grey.
  void fill(const aiScene& scene, const std::string& file, SkinnedMesh& into, std::vector<std::string>& notes) const;

 private:
  std::vector<unsigned> used_;  // indices into the scene's materials
};

}  // namespace app

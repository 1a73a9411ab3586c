#include "app/figure/figure_file.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <cmath>
#include <exception>

#include "app/figure/uri_files.h"
#include "app/files/errors.h"
#include "app/files/text_file.h"
#include "app/files/vertex_place.h"

namespace app {

namespace {

constexpr const char* kExportAgain = "export it again";

// Before vertices are joined and numbered anew.
void expectFinitePlaces(const aiScene& scene, const std::string& file) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D& at = mesh.mVertices[v];
      if (std::isfinite(at.x) && std::isfinite(at.y) && std::isfinite(at.z)) continue;
      throw InputError(file, vertexPlace(file, "mesh '" + std::string(mesh.mName.C_Str()) + "'", v, at),
                       "is not at a finite place", "export the mesh again");
    }
  }
}

}  // namespace

const aiScene& readFigureFile(const std::string& file, Assimp::Importer& importer) {
  // Read first: a missing or empty file gets the same message whatever its kind, and size is bounded.
  if (readText(file).size() < 12)
    throw InputError(file, "", "is too short to be a character",
                     "give a complete .glb, .gltf, .fbx, .dae or .obj file");
  importer.SetIOHandler(new UriFiles);  // the importer's from here on
  importer.SetPropertyBool("IMPORT_NO_SKELETON_MESHES", true);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene = nullptr;
  try {
    scene = importer.ReadFile(file, aiProcess_ValidateDataStructure);
    if (scene && scene->mRootNode) {
      expectFinitePlaces(*scene, file);
      scene = importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_SortByPType |
                                           aiProcess_JoinIdenticalVertices | aiProcess_GenSmoothNormals);
    }
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& fault) {
    throw InputError(file, "", std::string("cannot be read: ") + fault.what(), kExportAgain);
  }
  if (!scene || !scene->mRootNode)
    throw InputError(file, "", std::string("cannot be read: ") + importer.GetErrorString(), kExportAgain);
  if (scene->mNumMeshes == 0)
    throw InputError(file, "", "holds no mesh", "export the character with its skinned mesh, or give a .bvh motion");
  return *scene;
}

}  // namespace app

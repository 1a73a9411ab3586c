#include "app/files/polygon_file.h"

#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <utility>

#include "app/files/errors.h"
#include "app/files/file_ending.h"
#include "app/files/text_file.h"
#include "app/files/text_scanner.h"
#include "app/files/vertex_place.h"
#include "sim/field_text.h"

namespace app {

namespace {

using Mat4 = Eigen::Matrix4d;

constexpr std::size_t kMaxCorners = 4'000'000, kMaxNodes = 20'000;
constexpr double kLargest = 1e6;  // of a coordinate
constexpr const char* kExport = "export it again, as OBJ, FBX or glTF";

Mat4 toEigen(const aiMatrix4x4& m) {
  Mat4 e;
  e << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4;
  return e;
}

// assimp takes the room that a PLY header asks for before it reads on.
void refusePlyCounts(std::string_view bytes, const std::string& file) {
  const std::string_view header = bytes.substr(0, bytes.find("end_header"));
  for (std::size_t at = header.find("element "); at != std::string_view::npos; at = header.find("element ", at + 1)) {
    const std::string line(header.substr(at, header.find_first_of("\r\n", at) - at));
    double count = 0;
    const std::size_t space = line.rfind(' ');
    if (!sim::parseNumber(line.substr(space + 1), count) || !(count <= static_cast<double>(bytes.size())))
      throw InputError(file, line, "does not fit into a file of " + std::to_string(bytes.size()) + " bytes", kExport);
  }
}

const aiScene& importScene(const std::string& file, Assimp::Importer& importer) {
  const std::string bytes = readText(file);
  if (bytes.size() < 12) throw InputError(file, "", "is too short to be a polygon file", kExport);
  // assimp would guess by the content, which takes any text for an OBJ.
  if (endingOf(file) != ".vrm" && !importer.IsExtensionSupported(endingOf(file)))
    throw InputError(file, "", "is no mesh: no kind of mesh file ends so", kExport);
  if (endingOf(file) == ".obj" || endingOf(file) == ".gltf") refuseUtf16(bytes, file);
  if (endingOf(file) == ".ply") refusePlyCounts(bytes, file);
  importer.SetPropertyBool("IMPORT_NO_SKELETON_MESHES", true);
  const unsigned steps = aiProcess_ValidateDataStructure;
  const aiScene* scene = nullptr;
  try {
    // VRM is binary glTF under another name.
    scene = endingOf(file) == ".vrm" ? importer.ReadFileFromMemory(bytes.data(), bytes.size(), steps, "glb")
                                     : importer.ReadFile(file, steps);
  } catch (const std::exception& fault) {
    throw InputError(file, "", std::string("cannot be read: ") + fault.what(), kExport);
  }
  if (!scene || !scene->mRootNode)
    throw InputError(file, "", std::string("cannot be read: ") + importer.GetErrorString(), kExport);
  return *scene;
}

struct Gatherer {
  const std::string& file;
  const aiScene& scene;
  PolygonMesh out;

  std::string nameOf(const aiNode& node, const aiMesh& mesh) const {
    std::string name = node.mName.C_Str();
    const auto add = [&](const std::string& more) {
      if (!more.empty() && name.find(more) == std::string::npos) name += (name.empty() ? "" : " ") + more;
    };
    add(mesh.mName.C_Str());
    if (mesh.mMaterialIndex < scene.mNumMaterials) {
      const std::string material = scene.mMaterials[mesh.mMaterialIndex]->GetName().C_Str();
      if (material != "DefaultMaterial") add(material);
    }
    return name.substr(0, 80);
  }

  // glTF's base colour, Kd of an OBJ's library, FBX' diffuse colour; none where assimp has put in a material of its
  // own.
  std::optional<std::array<float, 3>> colorOf(const aiMesh& mesh) const {
    if (mesh.mMaterialIndex >= scene.mNumMaterials) return std::nullopt;
    const aiMaterial& material = *scene.mMaterials[mesh.mMaterialIndex];
    aiColor4D color;
    if (material.GetName() == aiString(AI_DEFAULT_MATERIAL_NAME) ||
        material.Get(AI_MATKEY_COLOR_DIFFUSE, color) != aiReturn_SUCCESS)
      return std::nullopt;
    const auto share = [](float value) { return std::isfinite(value) ? std::clamp(value, 0.0f, 1.0f) : 0.0f; };
    return std::array{share(color.r), share(color.g), share(color.b)};
  }

  void addFace(const aiMesh& mesh, const aiFace& face, int base, const std::string& name) {
    if (face.mNumIndices < 3) return;  // points and lines
    if (out.corners.size() + face.mNumIndices > kMaxCorners)
      throw InputError(file, name, "has over 4,000,000 corners", "reduce the mesh, or leave other objects out");
    for (unsigned k = 0; k < face.mNumIndices; ++k) {
      if (face.mIndices[k] >= mesh.mNumVertices)
        throw InputError(file, name, "names a vertex that is not there", kExport);
      out.corners.push_back(base + static_cast<int>(face.mIndices[k]));
    }
    out.face_first.push_back(out.corners.size());
    out.face_object.push_back(static_cast<int>(out.objects.size()) - 1);
  }

  // Of the mesh that was added last; vertices of meshes without colours are white.
  void addColors(const aiMesh& mesh) {
    constexpr std::array kWhite{1.0f, 1.0f, 1.0f};
    if (mesh.mColors[0] == nullptr && out.vertex_colors.empty()) return;
    out.vertex_colors.resize(out.positions.size() - mesh.mNumVertices, kWhite);
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiColor4D color = mesh.mColors[0] == nullptr ? aiColor4D(1, 1, 1, 1) : mesh.mColors[0][v];
      out.vertex_colors.push_back({color.r, color.g, color.b});
    }
  }

  void addMesh(const aiNode& node, const aiMesh& mesh, const Mat4& to_world) {
    const std::string name = nameOf(node, mesh);
    out.objects.push_back(name);
    out.colors.push_back(colorOf(mesh));
    const int base = static_cast<int>(out.positions.size());
    if (out.positions.size() + mesh.mNumVertices > kMaxCorners)
      throw InputError(file, name, "has over 4,000,000 vertices", "reduce the mesh, or leave other objects out");
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D p = mesh.mVertices[v];
      const Eigen::Vector4d world = to_world * Eigen::Vector4d(p.x, p.y, p.z, 1);
      if (!world.allFinite() || world.head<3>().cwiseAbs().maxCoeff() > kLargest)
        throw InputError(file, vertexPlace(file, name, v, p), "is not at a finite place", kExport);
      out.positions.push_back(world.head<3>());
    }
    addColors(mesh);
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) addFace(mesh, mesh.mFaces[f], base, name);
  }

  void gather() {
    std::vector<std::pair<const aiNode*, Mat4>> open{{scene.mRootNode, Mat4::Identity()}};
    std::size_t nodes = 0;
    while (!open.empty()) {
      const auto [node, above] = open.back();
      open.pop_back();
      if (++nodes > kMaxNodes) throw InputError(file, "", "has over 20,000 nodes", "leave other objects out");
      const Mat4 world = above * toEigen(node->mTransformation);
      for (unsigned m = 0; m < node->mNumMeshes; ++m) addMesh(*node, *scene.mMeshes[node->mMeshes[m]], world);
      for (unsigned c = node->mNumChildren; c-- > 0;) open.emplace_back(node->mChildren[c], world);
    }
  }

  void readUnit() {
    const std::string ending = endingOf(file);
    if (ending == ".glb" || ending == ".gltf" || ending == ".vrm") out.meters_per_unit = 1;
    double centimetres = 0;
    float single = 0;
    if (!scene.mMetaData) return;
    if (scene.mMetaData->Get("UnitScaleFactor", centimetres) && centimetres > 0)
      out.meters_per_unit = 0.01 * centimetres;
    if (scene.mMetaData->Get("UnitScaleFactor", single) && single > 0) out.meters_per_unit = 0.01 * single;
  }
};

// What an OBJ text says of its materials' file that is not there. assimp takes one of the OBJ's name in its place.
std::string libraryNote(std::string_view text, const std::string& file) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (fs::exists(fs::path(file).replace_extension(".mtl"), ignored)) return "";
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find_first_of("\r\n", at), text.size());
    const std::string_view line = text.substr(at, end - at);
    at = end + 1;
    if (!line.starts_with("mtllib ")) continue;
    const std::string name(line.substr(7, line.find_last_not_of(' ') - 6));
    if (!fs::exists(fs::path(file).parent_path() / name, ignored))
      return "its materials '" + name + "' are not there: put that file beside it for their colours";
  }
  return "";
}

}  // namespace

PolygonMesh readPolygons(const std::string& file) {
  Assimp::Importer importer;
  Gatherer gatherer{file, importScene(file, importer), {}};
  gatherer.gather();
  gatherer.readUnit();
  if (endingOf(file) == ".obj") gatherer.out.note = libraryNote(readText(file), file);
  if (gatherer.out.faceCount() == 0)
    throw InputError(file, "", "holds no faces",
                     "give a mesh with faces: hair as strips of quads or tubes, one a lock; curves come as .hair, "
                     ".abc, .usda, .tfx or .ply");
  return std::move(gatherer.out);
}

bool hasPolygonEnding(const std::string& file) {
  constexpr std::array<std::string_view, 5> kEndings{".obj", ".fbx", ".glb", ".gltf", ".vrm"};
  return std::ranges::find(kEndings, endingOf(file)) != kEndings.end();
}

bool isYUp(const std::string& file) {
  const std::string ending = endingOf(file);
  return ending == ".glb" || ending == ".gltf" || ending == ".vrm";
}

bool hasLayers(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find_first_of("\r\n", at), text.size());
    std::string_view line = text.substr(at, end - at);
    at = end + 1;
    while (!line.empty() && (line.front() == ' ' || line.front() == '\t')) line.remove_prefix(1);
    if (line.size() < 2 || (line[0] != 'g' && line[0] != 'o') || (line[1] != ' ' && line[1] != '\t')) continue;
    for (std::size_t found = line.find("layer_"); found != std::string_view::npos;
         found = line.find("layer_", found + 1)) {
      const bool begins = line[found - 1] == ' ' || line[found - 1] == '\t';
      if (begins && found + 6 < line.size() && std::isdigit(static_cast<unsigned char>(line[found + 6]))) return true;
    }
  }
  return false;
}

bool holdsStillMeshes(const std::string& file) {
  Assimp::Importer importer;
  const aiScene& scene = importScene(file, importer);
  if (scene.mNumAnimations > 0 || scene.mNumMeshes == 0) return false;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    if (scene.mMeshes[m]->mNumBones > 0) return false;
  }
  return true;
}

}  // namespace app

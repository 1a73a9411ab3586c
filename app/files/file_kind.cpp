#include "app/files/file_kind.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <string>

#include "app/files/errors.h"
#include "app/files/json_reader.h"
#include "app/files/text_file.h"

namespace app {

FileKind fileKind(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  if (ending == ".json") {
    return parseJson(readText(file), file).contains("characters") ? FileKind::kScene : FileKind::kPreset;
  }
  if (ending == ".obj") return FileKind::kHairMesh;
  if (ending == ".mot") return FileKind::kRigidMotion;
  for (const char* known : {".bvh", ".glb", ".gltf", ".fbx", ".dae"}) {
    if (ending == known) return FileKind::kMotion;
  }
  if (std::string title(15, '\0');
      std::ifstream(file, std::ios::binary).read(title.data(), 15) && title == "hairmesh-state ")
    return FileKind::kState;
  throw InputError(file, "", "is no kind of file that this program reads",
                   "give a scene or preset (.json), a motion (.bvh, .glb, .gltf, .fbx, .mot) or a hair mesh (.obj)");
}

std::string partsBeside(const std::string& motion_file) {
  return (std::filesystem::path(motion_file).parent_path() / "female-objs").string();
}

}  // namespace app

#include "app/files/file_kind.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "app/figure/attachment.h"
#include "app/files/errors.h"
#include "app/files/json_reader.h"
#include "app/files/polygon_file.h"
#include "app/files/text_file.h"
#include "app/groom/formats/groom_bytes.h"
#include "app/groom/groom_file.h"
#include "sim/field_text.h"

namespace app {

namespace {

// By a key that a preset has not, or one that was meant to be "characters".
bool looksLikeScene(const nlohmann::json& text) {
  if (!text.is_object()) return false;
  static constexpr std::array<std::string_view, 9> kKeys{"characters", "camera", "playback", "preset", "name",
                                                         "sim",        "hair",   "light",    "view"};
  return std::ranges::any_of(text.items(), [](const auto& item) {
    const std::string_view near = sim::nearestName(item.key(), kKeys);
    return std::find(kKeys.begin(), kKeys.begin() + 4, near) != kKeys.begin() + 4;
  });
}

FileKind kindOfStillMesh(const std::string& file) {
  if (hasLayers(readText(file))) return FileKind::kHairMesh;
  try {
    return looksWorn(readPolygons(file)) ? FileKind::kAttachment : FileKind::kHairMesh;
  } catch (const InputError&) {
    return FileKind::kHairMesh;  // whose reader says what is wrong
  }
}

}  // namespace

FileKind fileKind(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  if (ending == ".json") {
    const nlohmann::json text = parseJson(readText(file), file);
    if (text.is_object() && text.contains("hairmesh-project")) return FileKind::kProject;
    return looksLikeScene(text) ? FileKind::kScene : FileKind::kPreset;
  }
  if (ending == ".obj") return kindOfStillMesh(file);
  if (ending == ".mot") return FileKind::kRigidMotion;
  if (ending == ".vrm") return FileKind::kHairMesh;
  if (ending == ".glb" || ending == ".gltf" || ending == ".fbx")
    return holdsStillMeshes(file) ? kindOfStillMesh(file) : FileKind::kMotion;
  for (const char* known : {".bvh", ".dae"}) {
    if (ending == known) return FileKind::kMotion;
  }
  if (hasGroomEnding(file)) return FileKind::kHairMesh;
  if (ending == ".hairmesh") return FileKind::kCache;
  const std::string bytes = readText(file, kMaxGroomFile);
  if (bytes.starts_with("hairmesh-state ")) return FileKind::kState;
  if (bytes.starts_with("hairmesh-cache ")) return FileKind::kCache;
  if (groomFormat(bytes, file)) return FileKind::kHairMesh;
  throw InputError(
      file, "", "is no kind of file that this program reads",
      "give a scene or preset (.json), a motion (.bvh, .glb, .gltf, .fbx, .mot), a hair mesh (.obj) "
      "or a groom: curves (.hair, .abc, .usda, .tfx, .ply), strips or tubes (.obj, .fbx, .glb, .gltf, .vrm)");
}

std::string partsBeside(const std::string& motion_file) {
  return (std::filesystem::path(motion_file).parent_path() / "female-objs").string();
}

}  // namespace app

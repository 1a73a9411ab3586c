#include "app/files/file_kind.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "app/figure/attachment.h"
#include "app/figure/still_body.h"
#include "app/files/errors.h"
#include "app/files/json_kind.h"
#include "app/files/json_reader.h"
#include "app/files/polygon_file.h"
#include "app/files/text_file.h"
#include "app/groom/formats/groom_bytes.h"
#include "app/groom/groom_file.h"

namespace app {

namespace {

constexpr std::size_t kTitleBytes = 15;  // of a state and of a cache

std::string beginningOf(const std::string& file, std::size_t count) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return "";
  std::string bytes(count, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

FileKind kindOfStillMesh(const std::string& file) {
  if (hasLayers(readText(file))) return FileKind::kHairMesh;
  try {
    const PolygonMesh mesh = readPolygons(file);
    if (looksLikeBody(mesh)) return FileKind::kMotion;
    return looksWorn(mesh) ? FileKind::kAttachment : FileKind::kHairMesh;
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
    switch (jsonKind(JsonPlace(text, file))) {
      case JsonKind::kProject:
        return FileKind::kProject;
      case JsonKind::kScene:
        return FileKind::kScene;
      case JsonKind::kPreset:
        return FileKind::kPreset;
    }
  }
  if (ending == ".obj") return kindOfStillMesh(file);
  if (ending == ".mot") return FileKind::kRigidMotion;
  if (ending == ".vrm") return FileKind::kHairMesh;
  if (ending == ".hdr") return FileKind::kEnvironment;
  for (const char* picture : {".png", ".jpg", ".jpeg", ".exr"}) {
    if (ending == picture)
      throw InputError(file, "", "is no Radiance picture",
                       "name a panorama saved as .hdr (RGBE); a PNG paints a field: choose that first (Hair, Brushes), "
                       "or write --map FIELD=FILE");
  }
  if (ending == ".glb" || ending == ".gltf" || ending == ".fbx")
    return holdsStillMeshes(file) ? kindOfStillMesh(file) : FileKind::kMotion;
  for (const char* known : {".bvh", ".dae"}) {
    if (ending == known) return FileKind::kMotion;
  }
  if (hasGroomEnding(file)) return FileKind::kHairMesh;
  const std::string beginning = beginningOf(file, kTitleBytes);  // a cache may be larger than memory
  if (beginning.starts_with("hairmesh-state ")) return FileKind::kState;
  if (beginning.starts_with("hairmesh-cache ")) return FileKind::kCache;
  if (ending == ".hairmesh")
    throw InputError(file, "", beginning.empty() ? "is empty" : "is no cache of simulated hair",
                     "make one with --cache");
  const std::string bytes = readText(file, kMaxGroomFile);
  if (isRecording(bytes)) throw InputError(file, "", "is a recording", "play it with --replay");
  if (groomFormat(bytes, file)) return FileKind::kHairMesh;
  throw InputError(
      file, "", "is no kind of file that this program reads",
      "give a scene or preset (.json), a motion or body (.bvh, .glb, .gltf, .fbx, .mot, .obj), a panorama (.hdr), a "
      "hair mesh (.obj) or a groom: curves (.hair, .abc, .usda, .tfx, .ply), strips or tubes (.obj, .fbx, .glb, "
      ".gltf, .vrm)");
}

bool isRecording(std::string_view text) {
  return text.substr(0, text.find('\n')).find("\"hairmesh-recording\"") != std::string_view::npos;
}

std::pair<std::string, std::string> kindAndUse(const std::string& file, bool of_tool) {
  const std::string give = of_tool ? "give it to hairmesh " : "give it to ",
                    open = of_tool ? "open it with hairmesh" : "open it without an option",
                    load = std::string(of_tool ? "name its scene to hairmesh" : "name its scene") +
                           ", and it with --load-state";
  try {
    switch (fileKind(file)) {
      case FileKind::kScene:
        return {"is a scene", open};
      case FileKind::kPreset:
        return {"is a preset", give + "--preset"};
      case FileKind::kMotion:
      case FileKind::kRigidMotion:
        return {"is a motion", give + "--motion"};
      case FileKind::kHairMesh:
        return {"is hair", give + "--hair"};
      case FileKind::kState:
        return {"is a saved state", load};
      case FileKind::kCache:
        return {"is a cache of simulated hair", load};
      case FileKind::kProject:
        return {"is a project", open};
      case FileKind::kAttachment:
        return {"is a mesh to wear", give + "--attach"};
      case FileKind::kEnvironment:
        return {"is a panorama", give + "--environment"};
    }
  } catch (const InputError&) {  // no kind that is read
  }
  return {"", ""};
}

void requireRecording(const std::string& file) {
  constexpr std::size_t kFirstLine = 4096;  // bytes
  const std::string beginning = beginningOf(file, kFirstLine);
  if (beginning.empty() || isRecording(beginning)) return;
  const auto [kind, use] = kindAndUse(file);
  throw InputError(file, "", kind.empty() ? "is no recording" : kind + ", no recording",
                   kind.empty() ? "give a file that --record wrote" : use);
}

std::string partsBeside(const std::string& motion_file) {
  return (std::filesystem::path(motion_file).parent_path() / "female-objs").string();
}

void refuseOwnExport(std::string_view bytes, const std::string& file) {
  if (bytes.starts_with("glTF") && bytes.find("\"generator\":\"hairmesh\"") != std::string_view::npos)
    throw InputError(file, "", "is a moving hair mesh that this program has exported, and is not read back",
                     "export strands (.abc, .usda, .hair, .ply), or write the hair mesh (--write-hair FILE.obj)");
}

void refuseNoHair(const std::string& file, bool of_tool) {
  refuseOtherBeginning(file);
  const auto [kind, use] = kindAndUse(file, of_tool);
  if (!kind.empty()) throw InputError(file, "", kind + ", no hair", use);
  throw InputError(
      file, "", "holds no hair",
      "give a hair mesh (.obj with groups layer_0, layer_1, ...), curves (.hair, .abc, .usda, .tfx, .ply), "
      "or strips and tubes (.obj, .fbx, .glb, .gltf, .vrm)");
}

}  // namespace app

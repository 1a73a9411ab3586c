#include "app/scene/present_scene.h"

#include <filesystem>

#include "app/files/data_path.h"
#include "app/files/hair_file.h"
#include "app/files/output_file.h"
#include "app/scene/edit/brushed_hair.h"
#include "app/scene/edit/hand_pins.h"

namespace app {

namespace {

namespace fs = std::filesystem;

fs::path folderOf(const std::string& file) {
  std::error_code ignored;
  return file.empty() ? fs::path() : fs::weakly_canonical(fs::absolute(file, ignored).parent_path(), ignored);
}

void makeMovable(const std::string& kind, const fs::path& beside, std::string& file) {
  if (file.empty() || isPictureText(file)) return;
  std::error_code ignored;
  const fs::path whole = fs::weakly_canonical(file, ignored);
  const fs::path ours = fs::weakly_canonical(dataPath("assets/" + kind), ignored);
  const fs::path from_there = beside.empty() ? fs::path() : whole.lexically_relative(beside);
  if (whole.parent_path() == ours) {
    file = whole.filename().string();
  } else if (!from_there.empty() && *from_there.begin() != "..") {
    file = from_there.string();
  } else {
    file = fs::absolute(file, ignored).lexically_normal().string();
  }
}

// Where a camera stands, from the head or in the world.
void placeCamera(const Camera& camera, bool of_head, CameraSpec& spec) {
  spec.fov = camera.fov;
  spec.follow = camera.follow;
  spec.of_head = of_head;
  spec.target = of_head ? camera.target : Vec3(camera.anchor + camera.target);
  spec.eye = *spec.target + camera.distance * viewBack(camera);
}

}  // namespace

Scene presentScene(const Demo& demo) {
  Scene scene = demo.scene;
  for (std::size_t i = 0; i < demo.actors.size(); ++i) scene.characters[i] = demo.actors[i].spec;
  placeCamera(demo.camera, demo.camera.follow, scene.camera);
  for (std::size_t i = 0; i < demo.bookmarks.size(); ++i) {
    scene.bookmarks[i].reset();
    if (demo.bookmarks[i]) placeCamera(*demo.bookmarks[i], true, scene.bookmarks[i].emplace());
  }
  return scene;
}

Scene movable(Scene scene, const std::string& file) {
  const fs::path beside = folderOf(file);
  for (CharacterSpec& spec : scene.characters) {
    makeMovable("clips", beside, spec.motion);
    makeMovable("clips", beside, spec.parts);
    makeMovable("hair", beside, spec.hair);
    for (AttachmentSpec& one : spec.attachments) makeMovable("attachments", beside, one.file);
    for (const std::string_view field : kFieldNames) makeMovable("maps", beside, *findMap(field, spec.maps));
  }
  return scene;
}

std::vector<std::string> saveReshapedHair(const std::string& scene_file, const Demo& demo, Scene& scene) {
  std::vector<std::string> written;
  for (std::size_t i = 0; i < demo.actors.size(); ++i) {
    const std::optional<sim::HairMeshShape> shape = looseBrushed(demo.actors[i]);
    if (!shape) continue;
    const std::filesystem::path beside =
        std::filesystem::path(scene_file).replace_extension().string() + "-hair" + std::to_string(i + 1) + ".obj";
    writeFile(beside.string(), writeHairMesh(*shape));
    written.push_back(beside.filename().string());
    scene.characters[i].hair = beside.string();
    scene.characters[i].mends.clear();
    scene.characters[i].maps.length.clear();  // it is in the shape
    scene.characters[i].fit = scene.characters[i].reverse_faces = false;
    scene.characters[i].pins = pinsForAnotherMesh(demo.actors[i]);  // the file may order vertices otherwise
  }
  return written;
}

}  // namespace app

#include "app/scene/present_scene.h"

#include <filesystem>

#include "app/files/data_path.h"

namespace app {

namespace {

namespace fs = std::filesystem;

void makeMovable(const std::string& kind, std::string& file) {
  if (file.empty() || isPictureText(file)) return;
  std::error_code ignored;
  const fs::path whole = fs::weakly_canonical(file, ignored);
  const fs::path ours = fs::weakly_canonical(dataPath("assets/" + kind), ignored);
  if (whole.parent_path() == ours) {
    file = whole.filename().string();
  } else {
    file = fs::absolute(file, ignored).lexically_normal().string();
  }
}

}  // namespace

Scene presentScene(const Demo& demo) {
  Scene scene = demo.scene;
  for (std::size_t i = 0; i < demo.actors.size(); ++i) scene.characters[i] = demo.actors[i].spec;
  const Camera& camera = demo.camera;
  scene.camera.fov = camera.fov;
  scene.camera.follow = scene.camera.of_head = camera.follow;
  scene.camera.target = camera.follow ? camera.target : Vec3(camera.anchor + camera.target);
  scene.camera.eye = *scene.camera.target + camera.distance * viewBack(camera);
  return scene;
}

Scene movable(Scene scene) {
  for (CharacterSpec& spec : scene.characters) {
    makeMovable("clips", spec.motion);
    makeMovable("clips", spec.parts);
    makeMovable("hair", spec.hair);
    for (AttachmentSpec& one : spec.attachments) makeMovable("attachments", one.file);
    for (const std::string_view field : kFieldNames) makeMovable("maps", *findMap(field, spec.maps));
  }
  return scene;
}

}  // namespace app

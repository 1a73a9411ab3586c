#include "app/scene/save_requests.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "app/files/data_path.h"
#include "app/files/output_file.h"
#include "app/files/presets.h"
#include "app/scene/demo.h"
#include "app/scene/demo_state.h"
#include "app/scene/present_scene.h"
#include "app/scene/project.h"

namespace app {

void savePreset(const Request& request, Demo& demo) {
  writeFile(request.text,
            writePreset(stem(request.text), demo.scene.sim, selectedActor(demo).spec.look, demo.scene.look));
  demo.scene.preset = request.text;
  keepBase(demo);
  showMessage("saved " + request.text, demo);
}

void saveScene(const Request& request, Demo& demo) {
  Scene scene = presentScene(demo);
  scene.name = stem(request.text);
  const std::vector<std::string> beside = saveReshapedHair(request.text, demo, scene);
  writeFile(request.text, writeScene(movable(std::move(scene), request.text)));
  demo.scene.file = request.text;
  demo.scene.name = stem(request.text);
  for (std::size_t i = 0; i < demo.actors.size(); ++i) demo.scene.characters[i] = demo.actors[i].spec;
  demo.edits.saved = lastDone(demo.edits);
  const bool tied = std::ranges::any_of(
      demo.actors, [](const Actor& actor) { return !actor.spec.ties.empty() && reshapedByHand(*actor.haircut); });
  std::string text = "saved " + request.text;
  for (std::size_t k = 0; k < beside.size(); ++k) text += (k == 0 ? ", its hair beside it in " : ", ") + beside[k];
  showMessage(text + (tied ? ", without the strokes on tied hair: a project keeps them" : ""), demo);
}

void saveState(const Request& request, Demo& demo) {
  writeFile(request.text, demoStateBytes(demo));
  showMessage("saved " + request.text, demo);
}

void saveAsProject(const Request& request, Demo& demo) {
  saveProject(request.text, demo, stem(request.text));
  demo.scene.file = request.text, demo.scene.name = stem(request.text);
  demo.edits.saved = lastDone(demo.edits);
  showMessage("saved " + request.text, demo);
}

}  // namespace app

#include <exception>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>

#include "app/files/errors.h"
#include "app/files/hair_file.h"
#include "app/files/output_file.h"
#include "app/files/scene_file.h"
#include "app/options.h"
#include "app/platform/headless.h"
#include "app/platform/window.h"
#include "app/run_main.h"
#include "app/scene/actor.h"
#include "app/scene/demo.h"
#include "app/scene/project.h"

namespace {

int writeHair(const app::Scene& scene, const app::Options& options) {
  const std::string& file = options.write_hair;
  app::AssetCache asset_cache;
  std::optional<app::Demo> project;  // whose hair may be brushed
  if (!options.project.empty()) project = app::readProject(options.project, scene, true, 1);
  app::Actor made;
  if (!project) made = app::makeActor(scene.characters.front(), scene.playback, asset_cache);
  const app::Actor& actor = project ? project->actors.front() : made;
  const sim::HairMesh& mesh = actor.haircut->mesh;
  app::writeFile(file, app::writeHairMesh(mesh.shape));
  std::istringstream notes(app::hairNotes({&actor, 1}));
  for (std::string note; std::getline(notes, note);) std::cerr << "hairmesh: " << note << "\n";
  std::cout << mesh.vertexCount() << " vertices in " << mesh.columnCount() << " columns written to " << file << "\n";
  if (!actor.haircut->braids.empty())
    std::cerr << "hairmesh: plaits and buns are drawn alone: the file holds what is simulated for them\n";
  return app::kExitFine;
}

int run(const app::Options& options) {
  app::Scene scene = app::sceneFromOptions(options);
  if (!options.write_hair.empty()) return writeHair(scene, options);
  if (options.headless) return app::runHeadless(std::move(scene), options);
  if (options.replay.empty()) return app::runWindow(std::move(scene), options);
  // A replay is checked all the same where no window can be opened.
  try {
    return app::runWindow(scene, options);
  } catch (const app::ContextError&) {
    std::cerr << "hairmesh: no window can be opened here: replaying without one\n";
  }
  return app::runHeadless(std::move(scene), app::withoutWindow(options));
}

}  // namespace

int main(int argc, char** argv) {
  app::failAtFileLimit();
  return app::runMain("hairmesh", [&] {
    app::Options options;
    int exit_code = app::kExitFine;
    if (app::parseOptions(argc, argv, options, exit_code)) exit_code = run(app::sortedOut(options));
    return exit_code;
  });
}

#include "tests/fuzz/readers.h"

#include <array>

#include "app/figure/bone_mesh.h"
#include "app/files/errors.h"
#include "app/files/hair_file.h"
#include "app/files/presets.h"
#include "app/files/recording.h"
#include "app/files/scene_file.h"
#include "app/groom/formats/alembic_file.h"
#include "app/groom/formats/hair_strands_file.h"
#include "app/groom/formats/ply_file.h"
#include "app/groom/formats/tfx_file.h"
#include "app/groom/formats/usda_file.h"
#include "app/groom/groom_file.h"
#include "app/groom/inspect/groom_inspect.h"
#include "app/motion/motion.h"

namespace tests {

namespace {

void readHairMesh(std::string_view text) {
  try {
    sim::buildHairMesh(app::readHairMesh(text, "fuzz.obj"));
  } catch (const sim::MeshError&) {
  }
}

void readScene(std::string_view text) {
  const app::Scene scene = app::readScene(text, "fuzz.json");
  app::readScene(app::writeScene(scene), "written.json");
}

void readPreset(std::string_view text) {
  sim::SimParams sim;
  app::SceneLook scene;
  app::CharacterLook look;
  std::array<app::CharacterLook*, 1> looks{&look};
  app::applyPreset(text, "fuzz.json", {&sim, &scene, looks});
}

void readAlembic(std::string_view bytes) {
  app::readAlembic(bytes, "fuzz.abc");
  app::readAlembic(bytes, "fuzz.abc", 1);
  app::alembicTimes(bytes, "fuzz.abc");
}

void readUsda(std::string_view bytes) {
  app::readUsda(bytes, "fuzz.usda");
  app::readUsda(bytes, "fuzz.usda", 1);
  app::usdaTimes(bytes, "fuzz.usda");
}

// Any groom, told by its content, inspected and mended.
void inspectGroom(std::string_view bytes) {
  const app::HeadModel head{[](const Eigen::Vector3f& p) { return p.norm() - 0.09f; }, Eigen::Vector3f::Zero(), {}};
  app::GroomHints hints;
  app::Groom groom = app::readGroom(bytes, "fuzz", &hints);
  const app::GroomInspection found = app::inspectGroom(groom, hints, &head);
  app::mendGroom(found.mends, &head, groom);
}

constexpr Reader kReaders[] = {{"hair_mesh", readHairMesh},
                               {"bvh", [](std::string_view text) { app::readBvh(text, "fuzz.bvh"); }},
                               {"mot", [](std::string_view text) { app::readMot(text, "fuzz.mot"); }},
                               {"part", [](std::string_view text) { app::readPart(text, "fuzz.obj"); }},
                               {"scene", readScene},
                               {"preset", readPreset},
                               {"recording", [](std::string_view text) { app::readRecording(text, "fuzz.hmr"); }},
                               {"hair_strands", [](std::string_view text) { app::readHairStrands(text, "fuzz.hair"); }},
                               {"alembic", readAlembic},
                               {"usda", readUsda},
                               {"ply", [](std::string_view text) { app::readPlyStrands(text, "fuzz.ply"); }},
                               {"tfx", [](std::string_view text) { app::readTfx(text, "fuzz.tfx"); }},
                               {"groom_inspect", inspectGroom}};

}  // namespace

std::span<const Reader> readers() {
  return kReaders;
}

}  // namespace tests

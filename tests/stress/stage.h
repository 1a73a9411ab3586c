// A figure with its hair, loaded once and used by every case that asks for the same.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/scene/actor.h"
#include "tests/stress/stress_case.h"

namespace stress {

struct Stage {
  std::string key;
  app::Actor actor;
  app::Playback start;     // at the clip's first pose
  sim::HairState settled;  // there, with the default parameters but for the kind of colliders
  const sim::HairMesh& mesh() const { return actor.haircut->mesh; }
};

// The figure as signed distances, made when first asked for: it takes a good part of a second.
const std::vector<app::PartDistance>& partsOf(Stage& stage);

class StageStore {
 public:
  // The stage at the clip's first pose, its hair settled against the case's kind of colliders. Throws InputError when
  // the clip is not there.
  Stage& stage(const StressCase& one);

 private:
  app::AssetCache asset_cache_;
  std::vector<std::unique_ptr<Stage>> stages_;
};

// "" when no file of that name is known: clips of this project, then those beside its checkout.
std::string findClip(const std::string& name);

std::string hairName(const HairChoice& hair);

}  // namespace stress

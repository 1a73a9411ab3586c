// Hair meshes as actors wear them: of a style or a file, painted, tied.
#pragma once

#include <cstdint>
#include <vector>

#include "app/scene/actor.h"

namespace app {

// Never the same twice in a process: the renderer keeps GPU resources by these, also across scenes opened one after
// another.
std::uint64_t freshId();

// Marks the faces of a haircut that lie under an attachment.
void markCovered(const Haircut& haircut, std::vector<render::HairFace>& faces);

// After another rest shape of the same structure: what is drawn of it.
void followRest(Haircut& haircut);

// Strands grow off the haircut's mesh from now on as they did off `loaded`, of the same structure.
void bindGroom(const sim::HairMeshShape& loaded, Haircut& haircut);

// The haircut that `spec` asks for on a body, built on first use. Throws InputError.
const Haircut& cutHair(const CharacterSpec& spec, LoadedBody& body, AssetCache& asset_cache);

}  // namespace app

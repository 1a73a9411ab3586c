#include "app/scene/haircuts.h"

#include <atomic>
#include <nlohmann/json.hpp>

#include "app/files/errors.h"
#include "app/scene/attachments.h"
#include "app/scene/hair_from_file.h"
#include "app/scene/painted_fields.h"
#include "app/scene/sim_to_render.h"

namespace app {

namespace {

std::string styleTitle(const CharacterSpec& spec) {
  return std::string(styleName(spec.style)) + " " + std::string(resolutionName(spec.resolution));
}

// Ties the hair; `tied` takes the vertices in the rings.
void applyTies(const CharacterSpec& spec, const LoadedBody& body, sim::HairMeshShape& shape, std::vector<int>& tied) {
  const Scalp& scalp = body.character.scalp;
  TiedHair result = tieHair(shape, scalp, body.distance, placeTies(spec.ties, scalp));
  shape = std::move(result.shape);
  for (const std::vector<int>& ring : result.rings) {
    if (ring.empty())
      throw InputError("", "tie " + writeTies(spec.ties).dump(), "takes no hair", "move it, or widen what it takes");
    tied.insert(tied.end(), ring.begin(), ring.end());
  }
}

}  // namespace

std::uint64_t freshId() {
  static std::atomic<std::uint64_t> next{1};
  return next++;
}

const Haircut& cutHair(const CharacterSpec& spec, LoadedBody& body, AssetCache& asset_cache) {
  const std::string title = spec.hair.empty() ? styleTitle(spec) : spec.hair + (spec.reverse_faces ? " reversed" : "");
  const std::string ties = spec.ties.empty() ? "" : " tied " + writeTies(spec.ties).dump();
  std::string painted = writeCurves(spec.curves).dump();
  for (const std::string* map : {&spec.maps.stiffness, &spec.maps.length, &spec.maps.density, &spec.maps.mass})
    painted += "|" + *map;
  const std::vector<const Attachment*> worn = attach(spec, body, asset_cache);
  std::string under;
  for (const Attachment* attachment : worn) under += "|" + attachment->key;
  const std::string key = body.key + "|" + title + (spec.fit ? " fitted " : "") + spec.mends + ties + painted + under;
  for (const auto& haircut : asset_cache.haircuts) {
    if (haircut->key == key) return *haircut;
  }
  auto haircut = std::make_unique<Haircut>();
  haircut->key = key;
  haircut->id = freshId();
  // Built-in styles, ties and attachments ask for the distance, and it is a grid that takes time to fill.
  if ((spec.hair.empty() || !spec.ties.empty() || !worn.empty()) && !body.distance)
    body.distance = restBodyDistance(body.character);
  try {
    sim::HairMeshShape shape = spec.hair.empty()
                                   ? makeStyle(spec.style, spec.resolution, body.character.scalp, body.distance)
                                   : hairFromFile(spec, body.character, *haircut);
    const Scalp& scalp = body.character.scalp;
    // Hair of a file may lie nearer to the body than a style's.
    const BodyDistance around = spec.hair.empty() ? body.distance : [](const Vec3&) { return 1.0; };
    haircut->unpainted = shape.positions;
    if (!spec.maps.length.empty()) paintLength(readFieldMap(spec.maps.length), scalp, around, shape);
    if (!spec.ties.empty()) applyTies(spec, body, shape, haircut->tied);
    haircut->painted = shape.positions;
    haircut->covered = layUnder(worn, scalp, body.distance, shape);
    if (!spec.ties.empty() || !haircut->covered.empty()) haircut->unpainted.clear();
    haircut->mesh = sim::buildHairMesh(std::move(shape));
    haircut->shares = paintedShares(spec.maps, spec.curves, scalp, haircut->mesh.shape);
    applyShares(haircut->shares, haircut->mesh);
  } catch (const sim::MeshError& error) {
    if (!spec.maps.length.empty())
      throw InputError("map " + spec.maps.length.substr(0, 80), "length", "cuts hair so that its layers cross",
                       "paint it lighter or more evenly");
    if (!haircut->covered.empty() && !spec.ties.empty())
      throw InputError(spec.attachments.front().file, "with a tie", "leaves the tied hair no room",
                       "tie it where nothing lies over it, or take off one of the two");
    if (!haircut->covered.empty())
      throw InputError(spec.attachments.front().file, "", "leaves the hair no room",
                       "make it wider, or move it off the head");
    if (!spec.ties.empty())
      throw InputError("", "tie " + writeTies(spec.ties).dump(), "leaves the hair no room",
                       "move it off the head, or make it wider");
    throw InputError(spec.hair.empty() ? "style " + title + " on " + spec.motion : spec.hair, error.place, error.fault,
                     error.mend);
  }
  haircut->faces = renderFaces(haircut->mesh);
  if (!spec.maps.density.empty())
    paintDensity(readFieldMap(spec.maps.density), body.character.scalp, haircut->mesh, haircut->faces);
  blendPositions(haircut->mesh.shape.positions, haircut->mesh.shape.positions, 1, Vec3::Zero(), haircut->rest);
  // Hair of a style that divides over the shoulders lies against itself: it sleeps as a whole.
  asset_cache.haircuts.push_back(std::move(haircut));
  return *asset_cache.haircuts.back();
}

}  // namespace app

#include "app/scene/haircuts.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <span>

#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/scene/attachments.h"
#include "app/scene/edit/brushed_hair.h"
#include "app/scene/edit/painted_fields.h"
#include "app/scene/hair_from_file.h"
#include "app/scene/sim_to_render.h"
#include "app/styles/tie_ring.h"
#include "sim/field_text.h"
#include "sim/mesh/field_bytes.h"

namespace app {

namespace {

std::string styleTitle(const CharacterSpec& spec) {
  return std::string(styleName(spec.style)) + " " + std::string(resolutionName(spec.resolution));
}

// What is said where ties are elsewhere than they are named.
std::string loweredNote(const CharacterSpec& spec, const Scalp& scalp, double lower) {
  double most = 0;
  const std::vector<HairTie> asked = placeTies(spec.ties, scalp), placed = placeTies(spec.ties, scalp, lower);
  for (std::size_t t = 0; t < asked.size(); ++t) most = std::max(most, (asked[t].at - placed[t].at).norm());
  return "tied " + std::to_string(std::lround(1000 * most)) + " mm lower, to leave the hair room under " +
         stem(spec.attachments.front().file);
}

void addNote(const std::string& note, Haircut& haircut) {
  haircut.note += (haircut.note.empty() ? "" : "\n") + note;
}

constexpr double kFarthestRing = 0.2;   // m off the body
constexpr double kShortOfRing = 0.005;  // m: what lacks less does for the want of room

// rad, that ties are lowered by, one after another, where what is worn leaves the tied hair no room.
constexpr double kLower = 0.1;
constexpr std::size_t kLowerings = 17;

// Places by name that none of these ties has.
std::string otherPlaces(const std::vector<TieSpec>& ties) {
  std::string places;
  for (const char* name : {"back", "high", "low"}) {
    const bool taken = std::ranges::any_of(ties, [&](const TieSpec& tie) { return !tie.at && tie.place == name; });
    if (!taken) places += (places.empty() ? "" : " or ") + std::string(name);
  }
  return "tie it at another place (" + places + ")";
}

std::string centimetres(double metres) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f cm", 100 * metres);
  return text;
}

// A ring inside of the body holds no hair on it.
void checkRings(const CharacterSpec& spec, const LoadedBody& body, const std::vector<HairTie>& ties) {
  for (std::size_t t = 0; t < ties.size(); ++t) {
    const double off = body.distance(ties[t].at);
    if (off < 0)
      throw InputError("", tieTitle({spec.ties[t]}), "lies " + centimetres(-off) + " inside the body",
                       "move it off the head, or " + otherPlaces(spec.ties));
    if (off > kFarthestRing)
      throw InputError("", tieTitle({spec.ties[t]}), "lies " + centimetres(off) + " off the body",
                       "move it to the head (within " + centimetres(kFarthestRing) + "), or " + otherPlaces(spec.ties));
  }
}

std::string shortBunNote(const TieSpec& tie, double left) {
  const double fits = tie.radius * left / shortestBun(tie.radius);
  return tieTitle({tie}) + ": " + centimetres(left) + " of hair below the ring are too short for a bun (" +
         centimetres(shortestBun(tie.radius)) + "): a tail" +
         (fits < kThinnestTie
              ? ""
              : "; a ring of \"radius\": " + sim::numberText(std::floor(1e3 * fits) / 1e3) + " makes one");
}

constexpr const char* kLooseNote =
    ": hair whose way to the ring would lead across the face hangs loose; a ring farther back takes it";

// `lacks`: m that the shortest hair is too short to reach its ring.
void noteLengthened(const CharacterSpec& spec, double lacks, Haircut& haircut) {
  constexpr double kWorthSaying = 0.05;
  if (lacks > kWorthSaying)
    addNote(tieTitle(spec.ties) + ": hair is lengthened, by up to " + centimetres(lacks) + ", to reach its ring",
            haircut);
}

// What each tie holds.
struct Held {
  std::vector<int> ring;  // vertices
  double left = 0;        // m of hair beyond it
  bool wound = false;     // to a bun
};
using Rings = std::vector<Held>;

void applyTies(const CharacterSpec& spec, const LoadedBody& body, sim::HairMeshShape& shape, Haircut& haircut,
               Rings& rings) {
  TiedHair result = tieHair(shape, body.character.scalp, body.distance, haircut.ties,
                            spec.attachments.empty() ? Seams::kClosed : Seams::kOpen);
  shape = std::move(result.shape);
  putBrushed(spec, body, haircut, Dress::kTied, shape);
  if (result.loose > 0 && haircut.note.find(kLooseNote) == std::string::npos)
    addNote(tieTitle(spec.ties) + kLooseNote, haircut);
  haircut.tied.clear();
  haircut.bands.clear();
  haircut.wound.clear();
  rings.clear();
  for (std::size_t t = 0; t < result.rings.size(); ++t) {
    const std::vector<int>& ring = result.rings[t];
    if (ring.empty())
      throw InputError("", tieTitle({spec.ties[t]}), "takes no hair",
                       "ties before it take theirs first; let it take hair of both sides, or hair that is rooted lower "
                       "(\"above\")");
    haircut.tied.insert(haircut.tied.end(), ring.begin(), ring.end());
    const HairTie& tie = haircut.ties[t];
    haircut.bands.push_back(
        fittedRing(tie, body.character.scalp, ringPlaces(shape, body.character.scalp, {&tie, 1}, ring)));
    rings.push_back({ring, result.left[t], result.wound[t]});
    if (!result.wound[t]) continue;
    for (const int v : ring) {
      const auto end = std::ranges::upper_bound(shape.column_first, v);
      for (int beyond = v + 1; beyond < *end; ++beyond) haircut.wound.push_back(beyond);
    }
  }
  std::ranges::sort(haircut.wound);
}

// A style for which a head leaves no room may lie in the body.
void sayDepth(const sim::HairMeshShape& shape, const BodyDistance& body, Haircut& haircut) {
  constexpr double kDeep = 0.01;  // m
  double deepest = 0;
  int count = 0;
  for (int c = 0; c < shape.columnCount(); ++c) {
    for (int v = shape.column_first[c] + 1; v < shape.column_first[c + 1]; ++v) {
      const double depth = -body(shape.positions[static_cast<std::size_t>(v)]);
      count += depth > kDeep;
      deepest = std::max(deepest, depth);
    }
  }
  if (count > 0)
    addNote(std::to_string(count) + " of " + std::to_string(shape.positions.size()) + " vertices lie up to " +
                std::to_string(std::lround(1000 * deepest)) +
                " mm inside the body: this head leaves the style no room at that resolution",
            haircut);
}

// The hair as it grows, cut by a map.
sim::HairMeshShape grownHair(const CharacterSpec& spec, const LoadedBody& body, Haircut& haircut) {
  const Scalp& scalp = body.character.scalp;
  sim::HairMeshShape shape = spec.hair.empty() ? makeStyle(spec.style, spec.resolution, scalp, body.distance)
                                               : hairFromFile(spec, body.character, haircut);
  // Hair of a file may lie nearer to the body than a style's.
  const BodyDistance around = spec.hair.empty() ? body.distance : [](const Vec3&) { return 1.0; };
  if (spec.hair.empty()) sayDepth(shape, body.distance, haircut);
  haircut.unpainted = shape.positions;
  if (spec.maps.length.empty()) return shape;
  constexpr double kWorthSaying = 0.15;
  const double more = paintLength(readFieldMap(spec.maps.length), scalp, around, shape);
  if (more > kWorthSaying)
    addNote("painted length: for want of room the hair keeps " + std::to_string(std::lround(100 * more)) +
                " % more of its length than is painted",
            haircut);
  return shape;
}

// Tied and under what is worn. Throws sim::MeshError where there is no room.
void dressHair(const CharacterSpec& spec, const LoadedBody& body, std::span<const Attachment* const> worn,
               sim::HairMeshShape shape, Haircut& haircut, Rings& rings) {
  const Scalp& scalp = body.character.scalp;
  if (!spec.ties.empty()) applyTies(spec, body, shape, haircut, rings);
  haircut.uncovered = shape.positions;
  haircut.covered = layUnder(worn, scalp, body.distance, haircut.tied, shape);
  if (haircut.covered.empty()) haircut.uncovered.clear();
  if (!spec.ties.empty() || !haircut.covered.empty()) {
    haircut.unpainted.clear();
    haircut.painted = shape.positions;
    haircut.remeshed = false;
  }
  haircut.mesh = sim::buildHairMesh(std::move(shape));
}

// Whether a hat lies over a tie's ring or bun, which would come out through it.
bool ringUnderHat(const Haircut& haircut) {
  const auto covered = [&](int vertex) { return std::ranges::binary_search(haircut.covered, vertex); };
  return std::ranges::any_of(haircut.tied, covered) || std::ranges::any_of(haircut.wound, covered);
}

void dressAt(double lower, const CharacterSpec& spec, const LoadedBody& body, std::span<const Attachment* const> worn,
             const sim::HairMeshShape& shape, Haircut& haircut, Rings& rings) {
  haircut.ties = placeTies(spec.ties, body.character.scalp, lower);
  checkRings(spec, body, haircut.ties);
  dressHair(spec, body, worn, shape, haircut, rings);
}

// The same with the ties where they are named or, where a hat leaves no room or lies over them, as little lower as
// there is. Where they cannot be lower than the hat, they stay under it.
void dressWhereThereIsRoom(const CharacterSpec& spec, const LoadedBody& body, std::span<const Attachment* const> worn,
                           const sim::HairMeshShape& shape, Haircut& haircut, Rings& rings) {
  const bool named = std::ranges::any_of(spec.ties, [](const TieSpec& tie) { return !tie.at; });
  const std::size_t tries = named && !worn.empty() ? kLowerings : 1;
  std::optional<double> under;  // the least that gives room, under the hat
  double lower = 0;
  for (std::size_t k = 0; k < tries; ++k) {
    lower = kLower * static_cast<double>(k);
    try {
      dressAt(lower, spec, body, worn, shape, haircut, rings);
      if (tries == 1 || !ringUnderHat(haircut)) {
        under.reset();
        break;
      }
      if (!under) under = lower;
    } catch (const sim::MeshError&) {
      if (!under && k + 1 == tries) throw;
    } catch (const InputError&) {
      if (!under) throw;
      break;
    }
  }
  if (under) dressAt(lower = *under, spec, body, worn, shape, haircut, rings);
  if (lower > 0) addNote(loweredNote(spec, body.character.scalp, lower), haircut);
}

// Hair, as it grows, that its ties leave no room.
[[noreturn]] void refuseTies(const CharacterSpec& spec, const Scalp& scalp, const sim::HairMeshShape& grown,
                             const Haircut& haircut) {
  const double lacks = shortOfRing(grown, scalp, haircut.ties);
  const std::string elsewhere = otherPlaces(spec.ties);
  if (lacks > kShortOfRing)
    throw InputError("", tieTitle(spec.ties),
                     "the hair is too short: it ends up to " + centimetres(lacks) + " before the ring",
                     elsewhere + ", or take longer hair");
  throw InputError("", tieTitle(spec.ties), "leaves the hair no room in its ring",
                   elsewhere + ", or take a wider ring" +
                       (spec.resolution == Resolution::kLow ? "" : " or a coarser hair mesh (low)"));
}

// Measured with the hats of assets/attachments on bob and pixie.
constexpr const char* kRoomForFringe =
    "make it a tenth wider (\"size\") or move it 20 mm up (\"at\": [0, 0.02, 0]), or take a style without a fringe";

constexpr const char* kRoomUnderIt = "move it up (for instance by \"at\": [0, 0.06, 0]) or make it wider (\"size\")";

[[noreturn]] void refuseHair(const CharacterSpec& spec, const std::string& title, const Scalp& scalp,
                             const sim::HairMeshShape& grown, const Haircut& haircut, const sim::MeshError& error) {
  if (!spec.maps.length.empty())
    throw InputError("map " + spec.maps.length.substr(0, 80), "length",
                     haircut.covered.empty() ? "cuts hair so that its layers cross"
                                             : "cuts hair so that it has no room under what is worn",
                     haircut.covered.empty() ? "paint it lighter or more evenly"
                                             : "take off one of the two, or paint it lighter where the hat lies");
  if (!haircut.covered.empty() && !spec.ties.empty())
    throw InputError(spec.attachments.front().file, "with a tie", "leaves the tied hair no room",
                     "take a coarser hair mesh (low) or longer hair, or take off one of the two");
  if (!haircut.covered.empty())
    throw InputError(spec.attachments.front().file, "", "leaves the hair no room",
                     hasFringe(spec.style) && spec.hair.empty() ? kRoomForFringe : kRoomUnderIt);
  if (!spec.ties.empty()) refuseTies(spec, scalp, grown, haircut);
  throw InputError(spec.hair.empty() ? "style " + title + " on " + spec.motion : spec.hair, error.place, error.fault,
                   error.mend);
}

// Faces, rest shape and painted look are there.
void braidTails(const CharacterSpec& spec, const Scalp& scalp, const Rings& rings, Haircut& haircut) {
  std::vector<BraidTie> braided;
  std::vector<std::string> names;
  for (std::size_t t = 0; t < rings.size(); ++t) {
    const auto& [ring, left, wound] = rings[t];
    if (spec.ties[t].bun && !wound) addNote(shortBunNote(spec.ties[t], left), haircut);
    if (!spec.ties[t].braided && !wound) continue;
    const Vec3 off = haircut.ties[t].at - scalp.center, axis = off.normalized();
    braided.push_back({axis, haircut.ties[t].radius, axis.x() < 0, ring, spec.ties[t].braided, wound ? left : 0,
                       haircut.ties[t].at, off.norm() - scalp.radiusAt(axis), scalp.radiusAt(axis)});
    names.push_back(tieTitle({spec.ties[t]}));
  }
  if (braided.empty()) return;
  haircut.braids = planBraids(haircut.faces, haircut.mesh.shape.column_first,
                              haircut.offsets.empty() ? haircut.rest : haircut.rest_drawn, haircut.look_shares.roots,
                              braided, names);
  if (!haircut.braids.note.empty()) addNote(haircut.braids.note, haircut);
}

}  // namespace

std::uint64_t freshId() {
  static std::atomic<std::uint64_t> next{1};
  return next++;
}

void markCovered(const Haircut& haircut, std::vector<render::HairFace>& faces) {
  for (render::HairFace& face : faces) {
    face.covered = std::ranges::any_of(face.first_vertex, [&](int root) {
      if (root < 0) return false;
      const auto next = std::ranges::upper_bound(haircut.covered, root);
      return next != haircut.covered.end() && *next < root + face.layers;
    });
  }
}

void followRest(Haircut& haircut) {
  sim::HairMeshShape& shape = haircut.mesh.shape;
  blendPositions(shape.positions, shape.positions, 1, Vec3::Zero(), haircut.rest);
  haircut.rest_drawn.clear();
  shape.groom_offsets.clear();
  if (haircut.offsets.empty()) return;
  haircut.offsets.add(haircut.rest, haircut.rest_drawn);
  for (std::size_t v = 0; v < shape.positions.size(); ++v) {
    const auto at = [&](const std::vector<float>& from) { return Eigen::Map<const Eigen::Vector3f>(&from[3 * v]); };
    shape.groom_offsets.push_back((at(haircut.rest_drawn) - at(haircut.rest)).cast<double>());
  }
}

void bindGroom(const sim::HairMeshShape& loaded, Haircut& haircut) {
  std::vector<float> rest, offsets;
  blendPositions(loaded.positions, loaded.positions, 1, Vec3::Zero(), rest);
  blendPositions(loaded.groom_offsets, loaded.groom_offsets, 1, Vec3::Zero(), offsets);
  haircut.offsets = render::GroomOffsets(haircut.faces, rest, offsets);
  followRest(haircut);
}

const Haircut& cutHair(const CharacterSpec& spec, LoadedBody& body, AssetCache& asset_cache) {
  const std::string title = spec.hair.empty() ? styleTitle(spec) : spec.hair + (spec.reverse_faces ? " reversed" : "");
  const std::string ties = spec.ties.empty() ? "" : " tied " + writeTies(spec.ties).dump();
  const std::vector<const Attachment*> worn = attach(spec, body, asset_cache);
  std::string under = spec.brushed.empty() ? "" : "|brushed" + std::to_string(sim::fingerprint(spec.brushed));
  for (const Attachment* attachment : worn) under += "|" + attachment->key;
  const auto keyOf = [&](const FieldFiles& maps, bool has_fields) {
    std::string painted = writeCurves(spec.curves).dump() + (has_fields ? "" : "|its file's fields");
    for (const std::string_view field : kFieldNames) painted += "|" + mapOf(field, maps);
    return body.key + "|" + title + (spec.fit ? " fitted " : "") + spec.mends + ties + painted + under;
  };
  const std::string key = keyOf(spec.maps, spec.fields_of == spec.hair);
  for (const auto& haircut : asset_cache.haircuts) {
    if (haircut->key == key || haircut->key_with_fields == key) return *haircut;
  }
  auto haircut = std::make_unique<Haircut>();
  haircut->key = key;
  haircut->id = freshId();
  // Built-in styles, ties and attachments ask for the distance, and it is a grid that takes time to fill.
  if ((spec.hair.empty() || !spec.ties.empty() || !worn.empty()) && !body.distance)
    body.distance = restBodyDistance(body.character);
  sim::HairMeshShape shape;
  Rings rings;
  try {
    shape = grownHair(spec, body, *haircut);
    haircut->painted = shape.positions;
    putBrushed(spec, body, *haircut, Dress::kLoose, shape);
    dressWhereThereIsRoom(spec, body, worn, shape, *haircut, rings);
    haircut->shares = paintedShares(spec.maps, spec.curves, body.character.scalp, haircut->mesh.shape);
    applyShares(haircut->shares, haircut->mesh);
  } catch (const sim::MeshError& error) {
    refuseHair(spec, title, body.character.scalp, shape, *haircut, error);
  }
  haircut->key_with_fields = keyOf(withFields(*haircut, spec), true);
  if (const std::string notes = mapNotes(spec.maps); !notes.empty()) addNote(notes, *haircut);
  haircut->faces = renderFaces(haircut->mesh);
  markCovered(*haircut, haircut->faces);
  if (!spec.maps.density.empty())
    paintDensity(readFieldMap(spec.maps.density), body.character.scalp, haircut->mesh, haircut->faces);
  haircut->look_shares =
      paintedLook(withFields(*haircut, spec), spec.curves, body.character.scalp, haircut->mesh.shape);
  if (!spec.ties.empty()) {
    noteLengthened(spec, shortOfRing(shape, body.character.scalp, haircut->ties), *haircut);
    shape = haircut->mesh.shape;
  }
  for (const int v : haircut->covered)
    if (!shape.groom_offsets.empty()) shape.groom_offsets[static_cast<std::size_t>(v)].setZero();
  bindGroom(shape, *haircut);
  if (haircut->frozen.size() != shape.positions.size()) haircut->frozen.clear();
  braidTails(spec, body.character.scalp, rings, *haircut);
  // Hair of a style that divides over the shoulders lies against itself: it sleeps as a whole.
  asset_cache.haircuts.push_back(std::move(haircut));
  return *asset_cache.haircuts.back();
}

}  // namespace app

#include "app/scene/edit/mesh_change.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/files/errors.h"
#include "app/scene/demo.h"
#include "app/scene/edit/groom_brush.h"
#include "app/scene/edit/hand_pins.h"
#include "app/scene/edit/painted_fields.h"
#include "app/scene/edit/render_faces.h"
#include "app/scene/haircuts.h"
#include "app/scene/sim_to_render.h"
#include "sim/field_text.h"
#include "sim/forces/rest_balance.h"

namespace app {

namespace {

constexpr double kFarthestMove = 100;      // m
constexpr std::size_t kMaxChosen = 20000;  // numbers in a text

// The numbers of a text, none where they are more than can be or no numbers.
std::vector<double> allNumbersOf(const std::string& text) {
  const auto blanks = static_cast<std::size_t>(std::ranges::count(text, ' '));
  std::vector<double> numbers(std::min(blanks + 1, kMaxChosen));
  return numbersOf(text, numbers) == numbers.size() ? numbers : std::vector<double>();
}

// False where one is no whole number from 0 on.
bool wholeNumbers(std::span<const double> numbers, std::vector<int>& whole) {
  for (const double number : numbers) {
    if (!(number >= 0 && number < 1e9 && number == std::floor(number))) return false;
    whole.push_back(static_cast<int>(number));
  }
  return true;
}

int elementCount(MeshElement element, const sim::HairMesh& mesh) {
  if (element == MeshElement::kColumn) return mesh.columnCount();
  if (element == MeshElement::kLayer) return *std::ranges::max_element(mesh.bundle_layers);
  return mesh.vertexCount();
}

}  // namespace

std::string moveText(const MoveSample& sample) {
  std::string text;
  for (const double value :
       {sample.along.x(), sample.along.y(), sample.along.z(), sample.radius, sample.falloff, sample.mirror ? 1.0 : 0.0})
    text.append(text.empty() ? "" : " ").append(sim::numberText(value));
  for (const int number : sample.chosen) text.append(" ").append(std::to_string(number));
  return text;
}

MoveSample parseMove(const std::string& element, const std::string& text) {
  const auto name = std::ranges::find(kElementNames, element);
  if (name == kElementNames.end())
    throw InputError("", "element '" + element.substr(0, 40) + "'", "is unknown",
                     sim::nameHint(element, kElementNames));
  const std::vector<double> numbers = allNumbersOf(text);
  const auto within = [](double value, double low, double high) { return value >= low && value <= high; };
  MoveSample sample;
  sample.element = static_cast<MeshElement>(name - kElementNames.begin());
  bool fine = numbers.size() > 6 && within(numbers[3], 0, kLargestBrush) && within(numbers[4], 0, kLargestFalloff);
  for (std::size_t k = 0; fine && k < 3; ++k) fine = within(numbers[k], -kFarthestMove, kFarthestMove);
  fine = fine && wholeNumbers(std::span(numbers).subspan(6), sample.chosen);
  if (!fine || (sample.element == MeshElement::kEdge && sample.chosen.size() % 2 != 0))
    throw InputError("", "move", "is not numbers in their ranges",
                     "write the way x y z, radius 0 to 0.3, falloff 0 to 8, mirror 0 or 1, then what is chosen");
  sample.along = {numbers[0], numbers[1], numbers[2]};
  sample.radius = numbers[3], sample.falloff = numbers[4], sample.mirror = numbers[5] != 0;
  return sample;
}

std::vector<int> verticesOf(MeshElement element, std::span<const int> chosen, const sim::HairMesh& mesh) {
  std::vector<unsigned char> is(static_cast<std::size_t>(mesh.vertexCount()), 0);
  const int count = elementCount(element, mesh);
  for (const int number : chosen) {
    if (number < 0 || number >= count)
      throw InputError("", std::string(kElementNames[static_cast<std::size_t>(element)]) + " " + std::to_string(number),
                       "is not there", "choose numbers from 0 to " + std::to_string(count - 1));
    if (element == MeshElement::kColumn) {
      const int first = mesh.shape.column_first[static_cast<std::size_t>(number)];
      std::fill_n(is.begin() + first, mesh.shape.columnLength(number), 1);
    } else if (element == MeshElement::kLayer) {
      for (std::size_t v = 0; v < is.size(); ++v) is[v] |= mesh.layer_of[v] == number;
    } else {
      is[static_cast<std::size_t>(number)] = 1;
    }
  }
  std::vector<int> vertices;
  for (int v = 0; v < mesh.vertexCount(); ++v) {
    if (is[static_cast<std::size_t>(v)]) vertices.push_back(v);
  }
  return vertices;
}

const char* heldText(HeldBy by) {
  switch (by) {
    case HeldBy::kPrism:
      return ": hair beside it would be flat or inside out";
    case HeldBy::kEdge:
      return ": it would meet the vertex beside it";
    case HeldBy::kBody:
      return ": hair would go into the body";
    case HeldBy::kFrozen:
      return ": it is frozen";
    case HeldBy::kNothing:
    case HeldBy::kCount:
      break;
  }
  return "";
}

void applyMove(const MoveSample& sample, int index, Demo& demo) {
  Actor& actor = demo.actors[static_cast<std::size_t>(index)];
  const sim::HairMesh& mesh = actor.haircut->mesh;
  HairMove move;
  move.vertices = verticesOf(sample.element, sample.chosen, mesh);
  std::erase_if(move.vertices, [&](int v) { return mesh.isRoot(v); });
  if (move.vertices.empty())
    throw InputError("", "the move", "has nothing to move", "choose hair beyond the roots, which the scalp carries");
  move.along = sample.along, move.radius = sample.radius, move.falloff = sample.falloff;
  move.bends = sample.element == MeshElement::kColumn;
  if (sample.mirror) move.mirror = actor.body->character.scalp.center.x();
  move.frozen = actor.haircut->frozen;
  const std::vector<Vec3> seen = seenFromScalp(actor);
  std::vector<Vec3> positions;
  ShapeBrushes& hands = handsOn(actor);
  if (hands.move(move, mesh, seen, actor.body->distance, positions) > 0) {
    const std::vector<Vec3> before = mesh.shape.positions;
    std::vector<int> dragged = move.vertices;
    for (const int v : move.vertices) {
      if (move.mirror) dragged.push_back(likeAcross(v, *move.mirror, mesh));
    }
    reshapeHair(positions, index, demo);
    return carryPins(dragged, before, actor);
  }
  demo.message = std::string("stays where it is") + heldText(hands.heldBy());
  demo.message_is_fault = false;
}

namespace {

std::vector<ColumnPair> pairsOf(const std::vector<int>& numbers) {
  std::vector<ColumnPair> pairs;
  for (std::size_t k = 0; k + 1 < numbers.size(); k += 2) pairs.push_back({numbers[k], numbers[k + 1]});
  return pairs;
}

EditedMesh changed(MeshChange change, const std::vector<int>& numbers, bool mirror, const Actor& actor) {
  const sim::HairMeshShape& shape = actor.haircut->mesh.shape;
  const BodyDistance& body = actor.body->distance;
  const Scalp& scalp = actor.body->character.scalp;
  const auto both = [&](const auto& of) { return mirror ? withMirrored(shape, of, scalp.center.x()) : of; };
  switch (change) {
    case MeshChange::kAddLayer:
      return addLayer(shape, numbers[0], body);
    case MeshChange::kRemoveLayer:
      return removeLayer(shape, numbers[0], body);
    case MeshChange::kSplit:
      return splitColumns(shape, both(pairsOf(numbers)));
    case MeshChange::kMerge:
      return mergeColumns(shape, both(numbers));
    case MeshChange::kExtrude:
      break;
  }
  return extrudeColumns(shape, both(pairsOf(numbers)), scalp, body);
}

std::string saidOf(MeshChange change, double moved) {
  static constexpr std::array<const char*, 5> kDone{"layer added", "layer removed", "parting drawn", "parting closed",
                                                    "bundle grown"};
  char text[100];
  std::snprintf(text, sizeof text, "%s: strands within %.2g mm of where they were",
                kDone[static_cast<std::size_t>(change)], 1e3 * moved);
  return text;
}

}  // namespace

void applyMeshChange(const std::string& name, const std::string& text, int index, Demo& demo) {
  const auto found = std::ranges::find(kMeshChangeNames, name);
  if (found == kMeshChangeNames.end())
    throw InputError("", "change of the mesh '" + name.substr(0, 40) + "'", "is unknown",
                     sim::nameHint(name, kMeshChangeNames));
  const auto change = static_cast<MeshChange>(found - kMeshChangeNames.begin());
  const bool layer = change == MeshChange::kAddLayer || change == MeshChange::kRemoveLayer;
  const bool mirror = !layer && text.starts_with(kMirrorText);
  std::vector<int> numbers;
  const bool whole = wholeNumbers(allNumbersOf(mirror ? text.substr(kMirrorText.size()) : text), numbers);
  const bool paired = change == MeshChange::kSplit || change == MeshChange::kExtrude;
  if (!whole || numbers.empty() || (layer && numbers.size() != 1) || (paired && numbers.size() % 2 != 0)) {
    static constexpr std::array<const char*, 5> kSubjects{"the layer", "the layer", "the parting", "the parting",
                                                          "the bundle"};
    throw InputError("", kSubjects[static_cast<std::size_t>(change)], "has no place among what is chosen",
                     layer    ? "choose a layer"
                     : paired ? "choose an edge between two roots on the scalp, or two columns that such an edge joins"
                              : "choose columns on both sides of it");
  }
  const Actor& actor = demo.actors[static_cast<std::size_t>(index)];
  handsOn(actor);  // makes the distance to the body
  EditedMesh edited = changed(change, numbers, mirror, actor);
  remeshHair(std::move(edited.shape), edited.sources, index, demo);
  demo.message = saidOf(change, edited.moved);
  demo.message_is_fault = false;
}

namespace {

// Old places of a vertex's sources and what its rest place adds to them.
Vec3 followed(const VertexSource& source, const Vec3& rest, const std::vector<Vec3>& old_rest,
              const Eigen::Matrix3d& turn, const std::vector<Vec3>& old) {
  const auto blend = [&](const std::vector<Vec3>& x) {
    return Vec3((1 - source.share) * x[static_cast<std::size_t>(source.from)] +
                source.share * x[static_cast<std::size_t>(source.to)]);
  };
  return blend(old) + turn * (rest - blend(old_rest));
}

// The hair as it moves, on the new mesh.
void carryOver(const Haircut& fresh, std::span<const VertexSource> sources, Actor& actor) {
  const std::vector<Vec3>&old_rest = actor.haircut->mesh.shape.positions, &rest = fresh.mesh.shape.positions;
  const Rigid head = scalpToWorld(actor.body->character, actor.pose);
  const Eigen::Matrix3d before = scalpToWorld(actor.body->character, actor.previous_pose).linear();
  sim::HairState hair = sim::restState(fresh.mesh, head);
  std::vector<Vec3> previous = hair.positions;
  for (std::size_t v = 0; v < sources.size(); ++v) {
    const VertexSource& source = sources[v];
    const auto from = static_cast<std::size_t>(source.from), to = static_cast<std::size_t>(source.to);
    hair.positions[v] = followed(source, rest[v], old_rest, head.linear(), actor.hair.positions);
    previous[v] = followed(source, rest[v], old_rest, before, actor.previous_positions);
    hair.velocities[v] = (1 - source.share) * actor.hair.velocities[from] + source.share * actor.hair.velocities[to];
  }
  actor.hair = std::move(hair);
  actor.previous_positions = std::move(previous);
}

std::vector<float> carriedMask(const std::vector<float>& frozen, std::span<const VertexSource> sources) {
  std::vector<float> mask;
  if (frozen.empty()) return mask;
  for (const VertexSource& source : sources)
    mask.push_back(
        std::max(frozen[static_cast<std::size_t>(source.from)], frozen[static_cast<std::size_t>(source.to)]));
  return mask;
}

std::vector<Vec3> carriedOffsets(const std::vector<Vec3>& offsets, std::span<const VertexSource> sources) {
  std::vector<Vec3> carried;
  if (offsets.empty()) return carried;
  for (const VertexSource& source : sources)
    carried.push_back((1 - source.share) * offsets[static_cast<std::size_t>(source.from)] +
                      source.share * offsets[static_cast<std::size_t>(source.to)]);
  return carried;
}

// How far gravity would draw the hair of the new mesh, by what is known of the old one's.
std::vector<sim::V3<double>> carriedSag(std::span<const sim::V3<double>> sag, std::span<const VertexSource> sources) {
  std::vector<sim::V3<double>> carried;
  if (sag.empty()) return carried;
  for (const VertexSource& source : sources)
    carried.push_back((1 - source.share) * sag[static_cast<std::size_t>(source.from)] +
                      source.share * sag[static_cast<std::size_t>(source.to)]);
  return carried;
}

std::unique_ptr<Haircut> haircutOf(sim::HairMeshShape shape, std::span<const VertexSource> sources,
                                   const Actor& actor) {
  const Haircut& worn = *actor.haircut;
  auto own = std::make_unique<Haircut>();
  if (shape.groom_offsets.size() != shape.positions.size())
    shape.groom_offsets = carriedOffsets(worn.mesh.shape.groom_offsets, sources);
  try {
    own->mesh = sim::buildHairMesh(std::move(shape));
  } catch (const sim::MeshError& error) {
    throw InputError("", error.place, error.fault, error.mend);
  }
  own->key = freshKey(worn.key);
  own->id = freshId();
  own->note = worn.note, own->look = worn.look, own->findings = worn.findings;
  own->edited = own->remeshed = true;
  const Scalp& scalp = actor.body->character.scalp;
  own->shares = paintedShares(actor.spec.maps, actor.spec.curves, scalp, own->mesh.shape);
  applyShares(own->shares, own->mesh);
  own->faces = renderFaces(own->mesh);
  if (!actor.spec.maps.density.empty())
    paintDensity(readFieldMap(actor.spec.maps.density), scalp, own->mesh, own->faces);
  bindGroom(sim::HairMeshShape(own->mesh.shape), *own);
  own->frozen = carriedMask(worn.frozen, sources);
  return own;
}

}  // namespace

void remeshHair(sim::HairMeshShape shape, std::span<const VertexSource> sources, int index, Demo& demo) {
  Actor& actor = demo.actors[static_cast<std::size_t>(index)];
  if (std::ranges::any_of(actor.pins, [](const ActorPin& pin) { return !pin.of_spec; }))
    throw InputError("", "the mesh", "of hair that is tied or under an attachment stays as it is",
                     "take that off first");
  std::vector<PinSpec> pins = pinsForAnotherMesh(actor);
  std::unique_ptr<Haircut> own = haircutOf(std::move(shape), sources, actor);
  if (actor.coarse.active) leaveCoarse(actor);
  carryOver(*own, sources, actor);
  std::vector<sim::V3<double>> sag = carriedSag(actor.context->material().sag(), sources);
  AssetCache& asset_cache = demo.asset_cache;
  asset_cache.haircuts.push_back(std::move(own));
  wearHaircut(*asset_cache.haircuts.back(), actor, asset_cache);
  actor.context->material().startFrom(std::move(sag));
  repin(std::move(pins), actor);
  tidy(demo.actors, asset_cache);
  beginAnew(demo.timeline);
  demo.shown_fraction = -1;
}

void bringBackShape(const sim::HairMeshShape& shape, const std::vector<sim::V3<double>>& sag, int index, Demo& demo) {
  const Actor& actor = demo.actors[static_cast<std::size_t>(index)];
  const Haircut& worn = *actor.haircut;
  if (worn.remeshed && sameStructure(worn.mesh.shape, shape)) return reshapeHair(shape.positions, index, demo);
  remeshHair(shape, {}, index, demo);
  actor.context->material().startFrom(sag);
}

}  // namespace app

#include "app/scene/edit/groom_brush.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "app/files/errors.h"
#include "app/scene/demo.h"
#include "app/scene/edit/carry_hair.h"
#include "app/scene/edit/painted_fields.h"
#include "app/scene/haircuts.h"
#include "sim/field_text.h"
#include "sim/forces/rest_balance.h"

namespace app {

namespace {

constexpr double kFarthest = 100;  // m

bool wornByOthers(const Actor& actor, const Demo& demo) {
  const auto wears = [&](const Actor& one) { return one.haircut == actor.haircut; };
  return std::ranges::count_if(demo.actors, wears) > 1 ||
         std::ranges::any_of(demo.asset_cache.pairs, [&](const auto& pair) { return pair->coarse == actor.haircut; });
}

}  // namespace

std::string freshKey(const std::string& key) {
  static std::atomic<int> next{1};
  return key.substr(0, key.find("|edited")) + "|edited" + std::to_string(next++);
}

Haircut& ownHaircut(Actor& actor, Demo& demo) {
  AssetCache& asset_cache = demo.asset_cache;
  const auto found =
      std::ranges::find_if(asset_cache.haircuts, [&](const auto& one) { return one.get() == actor.haircut; });
  Haircut& worn = **found;
  if (!wornByOthers(actor, demo)) {
    worn.key = freshKey(worn.key);
    worn.key_with_fields.clear();
    return worn;
  }
  auto own = std::make_unique<Haircut>();
  own->key = freshKey(worn.key);
  own->id = worn.id;
  own->mesh = worn.mesh;
  own->faces = worn.faces;
  own->rest = worn.rest, own->rest_drawn = worn.rest_drawn;
  own->offsets = worn.offsets;
  own->edited = worn.edited, own->remeshed = worn.remeshed;
  own->ties = worn.ties;
  own->tied = worn.tied;
  own->bands = worn.bands;
  own->wound = worn.wound;
  own->braids = worn.braids;
  own->covered = worn.covered;
  own->shares = worn.shares, own->look_shares = worn.look_shares;
  own->unpainted = worn.unpainted, own->painted = worn.painted, own->uncovered = worn.uncovered;
  own->loose = worn.loose, own->grown = worn.grown;
  own->frozen = worn.frozen;
  actor.haircut = own.get();
  const std::unique_ptr<sim::StepContext> old = std::move(actor.context);
  actor.context = std::make_unique<sim::StepContext>(own->mesh, now);
  actor.context->refreshGradually(true);
  actor.context->material().startFrom(old->material().sag());
  asset_cache.haircuts.push_back(std::move(own));
  return *asset_cache.haircuts.back();
}

namespace {

// A coarser mesh of the style is not of this shape.
void dropWhatIsOfTheOldShape(Haircut& own, Actor& actor, AssetCache& asset_cache) {
  if (actor.coarse.active) leaveCoarse(actor);
  actor.coarse.pair = nullptr;
  actor.detail.coarse.reset();
  std::erase_if(asset_cache.pairs, [&](const auto& pair) { return pair->fine == &own; });
}

// Makes the rest quantities of a shape and what is painted. What moves goes on moving. Throws InputError where a prism
// would not be positive; then nothing has changed.
Haircut& setRest(const std::vector<Vec3>& positions, Actor& actor, Demo& demo) {
  Haircut& own = ownHaircut(actor, demo);
  if (!own.reshape) own.reshape.emplace(own.mesh);
  if (!own.reshape->set(positions, own.mesh))
    throw InputError("", "the hair", "would be flat or inverted in this shape", "make a smaller change");
  followRestPins(actor);
  applyShares(own.shares, own.mesh);
  dropWhatIsOfTheOldShape(own, actor, demo.asset_cache);
  actor.context->reshape(actor.hair);
  actor.shown_still = false;
  wakeAll(actor);
  return own;
}

// The same of an edit, which a paused picture shows at once and the timeline heeds.
Haircut& remake(const std::vector<Vec3>& positions, int index, Demo& demo) {
  Actor& actor = demo.actors[static_cast<std::size_t>(index)];
  const std::vector<Vec3> before = actor.haircut->mesh.shape.positions;
  Haircut& own = setRest(positions, actor, demo);
  carryWithShape(before, actor);
  if (demo.paused) demo.shown_fraction = -1;
  keepEarlierMoments(index, before, demo);
  return own;
}

}  // namespace

std::string brushText(const BrushSample& sample) {
  std::string text;
  const auto add = [&](double value) { text.append(text.empty() ? "" : " ").append(sim::numberText(value)); };
  for (const Vec3* v : {&sample.at, &sample.along}) {
    for (int axis = 0; axis < 3; ++axis) add((*v)[axis]);
  }
  for (const double value : {sample.radius, sample.strength, sample.falloff, sample.mirror ? 1.0 : 0.0}) add(value);
  return text;
}

std::size_t numbersOf(std::string_view text, std::span<double> numbers) {
  std::size_t count = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    if (count == numbers.size() || !sim::parseNumber(text.substr(at, end - at), numbers[count++]))
      return numbers.size() + 1;
    at = end + 1;
  }
  return count;
}

BrushSample parseBrush(const std::string& tool, const std::string& text) {
  const auto name = std::ranges::find(kBrushNames, tool);
  if (name == kBrushNames.end())
    throw InputError("", "brush '" + tool.substr(0, 40) + "'", "is unknown", sim::nameHint(tool, kBrushNames));
  std::array<double, 10> numbers{};
  const std::size_t count = numbersOf(text, numbers);
  bool fine = true;
  const auto within = [](double value, double low, double high) { return value >= low && value <= high; };
  for (int k = 0; k < 6; ++k) fine = fine && within(numbers[k], -kFarthest, kFarthest);
  fine = fine && count == numbers.size() && within(numbers[6], kSmallestBrush, kLargestBrush) &&
         within(numbers[7], 0, 1) && within(numbers[8], 0, kLargestFalloff);
  if (!fine)
    throw InputError("", "brush stroke", "is not ten numbers in their ranges",
                     "write x y z, the way x y z, radius 0.003 to 0.3, strength 0 to 1, falloff 0 to 8, mirror 0 or 1");
  BrushSample sample;
  sample.tool = static_cast<BrushTool>(name - kBrushNames.begin());
  sample.at = {numbers[0], numbers[1], numbers[2]};
  sample.along = {numbers[3], numbers[4], numbers[5]};
  sample.radius = numbers[6], sample.strength = numbers[7], sample.falloff = numbers[8];
  sample.mirror = numbers[9] != 0;
  return sample;
}

void reshapeHair(const std::vector<Vec3>& positions, int index, Demo& demo) {
  Haircut& own = remake(positions, index, demo);
  own.edited = true;
  followRest(own);
}

void repaintHair(const PaintedShares& shares, int index, Demo& demo) {
  Actor& actor = demo.actors[static_cast<std::size_t>(index)];
  if (shares == actor.haircut->shares) return;
  ownHaircut(actor, demo).shares = shares;
  remake(std::vector<Vec3>(actor.haircut->mesh.shape.positions), index, demo);
}

void inShapes(const std::vector<std::vector<Vec3>>& shapes, const std::function<void()>& act, Demo& demo) {
  std::vector<std::vector<Vec3>> now;
  for (const Actor& actor : demo.actors) now.push_back(actor.haircut->mesh.shape.positions);
  const auto wear = [&](const std::vector<std::vector<Vec3>>& wanted) {
    for (std::size_t i = 0; i < demo.actors.size(); ++i) {
      if (wanted[i] != demo.actors[i].haircut->mesh.shape.positions) setRest(wanted[i], demo.actors[i], demo);
    }
  };
  try {
    wear(shapes);
    act();
  } catch (...) {
    wear(now);
    throw;
  }
  wear(now);
}

bool reshapedByHand(const Haircut& haircut) {
  return haircut.edited && haircut.mesh.shape.positions != haircut.painted;
}

void freezeHair(const std::vector<float>& frozen, int index, Demo& demo) {
  ownHaircut(demo.actors[static_cast<std::size_t>(index)], demo).frozen = frozen;
}

namespace {

// Paints the mask that other brushes heed.
void paintFrozen(const Brush& brush, std::span<const Vec3> seen, int index, Demo& demo) {
  std::vector<float> frozen = demo.actors[static_cast<std::size_t>(index)].haircut->frozen;
  frozen.resize(seen.size());
  const double way = brush.tool == BrushTool::kFreeze ? brush.strength : -brush.strength;
  const auto touch = [&](const Vec3& at, std::size_t v) {
    Brush here = brush;
    here.at = at;
    frozen[v] = static_cast<float>(std::clamp(frozen[v] + way * brushReach(here, seen[v]), 0.0, 1.0));
  };
  for (std::size_t v = 0; v < seen.size(); ++v) {
    touch(brush.at, v);
    if (brush.mirror) touch(mirrored(brush.at, *brush.mirror), v);
  }
  if (std::ranges::all_of(frozen, [](float share) { return share == 0; })) frozen.clear();
  freezeHair(frozen, index, demo);
}

}  // namespace

std::vector<Vec3> seenFromScalp(const Actor& actor) {
  const Rigid to_scalp = scalpToWorld(actor.body->character, actor.pose).inverse(Eigen::Isometry);
  std::vector<Vec3> seen;
  seen.reserve(actor.hair.positions.size());
  for (const Vec3& p : actor.hair.positions) seen.push_back(to_scalp * p);
  return seen;
}

ShapeBrushes& handsOn(const Actor& actor) {
  if (!actor.body->distance) actor.body->distance = restBodyDistance(actor.body->character);
  if (!actor.haircut->brushes) actor.haircut->brushes.emplace(actor.haircut->mesh);
  return *actor.haircut->brushes;
}

namespace {

bool asksForLess(const ShapeBrushes& brushes, const CutStroke& stroke) {
  const std::vector<double>& asked = brushes.askedLengths();
  for (std::size_t c = 0; c < asked.size(); ++c)
    if (asked[c] < stroke.lengths[c] - 1e-6) return true;
  return false;
}

const char* whatStays(BrushTool tool) {
  if (tool == BrushTool::kCut)
    return "hair there ends before the ring, is 3 cm long or less, which is not cut, or frozen";
  if (tool == BrushTool::kGrow) return "hair there is as long as it may be (1.2 m), or frozen";
  return "hair there is frozen, or has no room to go";
}

// Whether all hair that the brush reaches is frozen.
bool allFrozen(const Brush& brush, const sim::HairMesh& mesh, const std::vector<Vec3>& seen) {
  if (brush.frozen.empty()) return false;
  for (int v = 0; v < mesh.vertexCount(); ++v) {
    const auto at = static_cast<std::size_t>(v);
    if (!mesh.isRoot(v) && brush.frozen[at] < 1 && brushReach(brush, seen[at]) > 0) return false;
  }
  return true;
}

}  // namespace

void applyBrush(const BrushSample& sample, int index, Demo& demo) {
  const Actor& actor = demo.actors[static_cast<std::size_t>(index)];
  const sim::HairMesh& mesh = actor.haircut->mesh;
  const std::vector<Vec3> seen = seenFromScalp(actor);
  std::vector<Vec3> positions;
  Brush brush;
  brush.tool = sample.tool;
  brush.at = sample.at, brush.along = sample.along;
  brush.radius = sample.radius, brush.strength = sample.strength, brush.falloff = sample.falloff;
  brush.centre = actor.body->character.scalp.center;
  if (sample.mirror) brush.mirror = brush.centre.x();
  const bool off_hair = std::ranges::none_of(seen, [&](const Vec3& p) { return brushReach(brush, p) > 0; });
  if (off_hair && goesOn(Ask::kBrush, demo.edits)) return;
  if (off_hair) throw InputError("", "the brush", "reaches no hair", "move it onto the hair, or make it larger");
  if (sample.tool == BrushTool::kFreeze || sample.tool == BrushTool::kThaw)
    return paintFrozen(brush, seen, index, demo);
  brush.frozen = actor.haircut->frozen;
  const bool cuts = sample.tool == BrushTool::kCut;
  if (cuts) brush.lengths = cutLengths(mesh.shape, ownHaircut(demo.actors[static_cast<std::size_t>(index)], demo).cut);
  ShapeBrushes& brushes = handsOn(actor);
  const int moved = brushes.apply(brush, actor.haircut->mesh, seen, actor.body->distance, positions);
  const bool stays = moved == 0 && !(cuts && asksForLess(brushes, *actor.haircut->cut));
  // A comb's first samples lead nowhere yet.
  const bool led = sample.tool == BrushTool::kComb && !allFrozen(brush, mesh, seen);
  if (stays && !led && !goesOn(Ask::kBrush, demo.edits))
    throw InputError("", "the brush", "moves nothing", whatStays(sample.tool));
  if (moved > 0) reshapeHair(positions, index, demo);
  if (cuts) {
    Haircut& own = ownHaircut(demo.actors[static_cast<std::size_t>(index)], demo);
    followCut(brushes.askedLengths(), own.mesh.shape, own.cut);
  }
}

}  // namespace app

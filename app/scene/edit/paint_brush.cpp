#include "app/scene/edit/paint_brush.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "app/files/errors.h"
#include "app/scene/demo.h"
#include "app/scene/edit/painted_fields.h"
#include "app/scene/edit/render_faces.h"
#include "app/scene/haircuts.h"
#include "sim/field_text.h"

namespace app {

namespace {

constexpr int kPictureWidth = 64, kPictureHeight = 32;  // pixels: 9 mm of scalp
constexpr double kSpread = 0.12, kFarthestRoot = 0.45;  // rad: how far a root speaks for the scalp around it
constexpr double kFarthestStroke = 100;                 // m
constexpr double kNothing = 1e-3;                       // of a brush's weight
constexpr double kAlike = 2.0 / 255;                    // of two values of a field
constexpr float kCurlRadius = 0.006f;                   // m, of straight hair where it is painted

FieldMap evenly(float value) {
  return {kPictureWidth, kPictureHeight, std::vector<float>(kPictureWidth * kPictureHeight, value)};
}

FieldMap white() {
  return evenly(1);
}

// A picture at the brushes' resolution.
FieldMap paintable(FieldMap given) {
  FieldMap map = white();
  if (given.width == kPictureWidth && given.height == kPictureHeight) return given;
  for (int row = 0; row < kPictureHeight; ++row) {
    for (int column = 0; column < kPictureWidth; ++column)
      map.value[static_cast<std::size_t>(row * kPictureWidth + column)] =
          static_cast<float>(given.at(directionOf(map, column, row)));
  }
  return map;
}

struct TouchedRoot {
  Vec3 direction;  // unit, from the head's middle
  double weight;   // of the brush: the most at any vertex of the column
};

std::vector<TouchedRoot> touchedRoots(const PaintSample& sample, const Actor& actor) {
  const sim::HairMesh& mesh = actor.haircut->mesh;
  const Vec3& middle = actor.body->character.scalp.center;
  const Rigid to_scalp = scalpToWorld(actor.body->character, actor.pose).inverse(Eigen::Isometry);
  Brush brush;
  brush.radius = sample.radius, brush.falloff = sample.falloff;
  const Vec3 other(2 * middle.x() - sample.at.x(), sample.at.y(), sample.at.z());
  std::vector<TouchedRoot> roots;
  for (int c = 0; c < mesh.columnCount(); ++c) {
    const int first = mesh.shape.column_first[static_cast<std::size_t>(c)];
    TouchedRoot root{(mesh.shape.positions[static_cast<std::size_t>(first)] - middle).normalized(), 0};
    for (int v = first; v < first + mesh.shape.columnLength(c); ++v) {
      const Vec3 p = to_scalp * actor.hair.positions[static_cast<std::size_t>(v)];
      brush.at = sample.at;
      root.weight = std::max(root.weight, brushReach(brush, p));
      brush.at = other;
      if (sample.mirror) root.weight = std::max(root.weight, brushReach(brush, p));
    }
    roots.push_back(root);
  }
  return roots;
}

// The brush's weight in a direction: that of the roots around, the nearer the more.
double weightAt(const Vec3& direction, const std::vector<TouchedRoot>& roots) {
  double sum = 0, all = 0;
  for (const TouchedRoot& root : roots) {
    const double cosine = root.direction.dot(direction);
    if (cosine < std::cos(kFarthestRoot)) continue;
    const double share = std::exp((cosine - 1) / (kSpread * kSpread));
    sum += share * root.weight;
    all += share;
  }
  return all > 0 ? sum / all : 0;
}

// A step towards the value, at least of one grey, so that a light hand comes there too.
float drawnTowards(double value, double share, float now) {
  constexpr double kGrey = 1.0 / 255;
  const double way = value - static_cast<double>(now), step = std::max(kGrey, share * std::abs(way));
  return static_cast<float>(static_cast<double>(now) + std::copysign(std::min(std::abs(way), step), way));
}

// Returns how far the map was from what is wanted: the most, weighted by the brush.
double dab(const PaintSample& sample, double wanted, const std::vector<TouchedRoot>& roots, FieldMap& map) {
  double away = 0;
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      const double weight = weightAt(directionOf(map, column, row), roots);
      if (weight < kNothing) continue;
      float& value = map.value[static_cast<std::size_t>(row * map.width + column)];
      away = std::max(away, weight * std::abs(wanted - static_cast<double>(value)));
      value = drawnTowards(wanted, sample.strength * weight, value);
    }
  }
  return away;
}

struct Painted {
  std::string picture;
  double away = 0;  // of what was there from what is wanted
};

// The field's picture after a sample of a stroke.
Painted painted(const PaintSample& sample, const std::vector<TouchedRoot>& roots, const std::string& picture) {
  if (sample.field != "color") {
    FieldMap map = picture.empty() ? white() : paintable(readFieldMap(picture));
    const double away = dab(sample, sample.value, roots, map);
    return {pictureText(map), away};
  }
  ColorMap map = picture.empty() ? ColorMap{white(), white(), white()} : readColorMap(picture);
  double away = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    map[c] = paintable(std::move(map[c]));
    away = std::max(away, dab(sample, sample.color[c], roots, map[c]));
  }
  return {pictureText(map), away};
}

// Straight hair has no curls that paint could make less: they come where they are painted, and nowhere else. Returns
// whether it was straight.
bool curlStraightHair(const PaintSample& sample, std::string& picture, Actor& actor) {
  float& radius = actor.spec.look.hair.curl_radius;
  if (sample.field != "curl" || sample.value == 0 || radius != 0 || !picture.empty()) return false;
  picture = pictureText(evenly(0));
  radius = kCurlRadius;
  return true;
}

// Faces, or shares of the look, have changed.
void drawAnew(Haircut& own, Actor& actor) {
  own.id = freshId();
  ++actor.layout_revision;
  actor.shown_still = false;
}

// Without a map as dense everywhere.
void repaintDensity(const std::optional<FieldMap>& map, int index, Demo& demo) {
  Actor& actor = demo.actors[static_cast<std::size_t>(index)];
  Haircut& own = ownHaircut(actor, demo);
  own.faces = renderFaces(own.mesh);
  markCovered(own, own.faces);
  if (map) paintDensity(*map, actor.body->character.scalp, own.mesh, own.faces);
  drawAnew(own, actor);
}

void repaintLook(const FieldFiles& maps, const FieldCurves& curves, int index, Demo& demo) {
  Actor& actor = demo.actors[static_cast<std::size_t>(index)];
  PaintedLook look = paintedLook(maps, curves, actor.body->character.scalp, actor.haircut->mesh.shape);
  Haircut& own = ownHaircut(actor, demo);
  own.look_shares = std::move(look);
  drawAnew(own, actor);
}

void repaintLength(const FieldMap& map, int index, Demo& demo) {
  const Actor& actor = demo.actors[static_cast<std::size_t>(index)];
  const Haircut& worn = *actor.haircut;
  if (worn.remeshed)
    throw InputError("", "length", "of hair whose mesh was changed is not painted", "use the brushes cut and grow");
  if (worn.unpainted.empty())
    throw InputError("", "length", "of hair that is tied or under an attachment is not painted", "take that off first");
  if (reshapedByHand(worn))
    throw InputError("", "length", "of hair that brushes have reshaped is not painted", "use the brushes cut and grow");
  sim::HairMeshShape shape = worn.mesh.shape;
  shape.positions = worn.unpainted;
  const BodyDistance around = actor.spec.hair.empty() ? actor.body->distance : [](const Vec3&) { return 1.0; };
  paintLength(map, actor.body->character.scalp, around, shape);
  reshapeHair(shape.positions, index, demo);
  ownHaircut(demo.actors[static_cast<std::size_t>(index)], demo).painted = shape.positions;
}

}  // namespace

std::string paintText(const PaintSample& sample) {
  std::string text;
  const auto add = [&](double value) { text.append(text.empty() ? "" : " ").append(sim::numberText(value)); };
  for (const double value : {sample.at.x(), sample.at.y(), sample.at.z(), sample.radius, sample.strength,
                             sample.falloff, sample.mirror ? 1.0 : 0.0})
    add(value);
  if (sample.field != "color") add(sample.value);
  for (std::size_t c = 0; c < 3 && sample.field == "color"; ++c) add(sample.color[c]);
  return text;
}

PaintSample parsePaint(const std::string& field, const std::string& text) {
  if (std::ranges::find(kFieldNames, field) == kFieldNames.end())
    throw InputError("", "field '" + field.substr(0, 40) + "'", "is unknown", sim::nameHint(field, kFieldNames));
  const bool color = field == "color";
  std::array<double, 10> numbers{};
  const std::size_t count = numbersOf(text, numbers);
  const auto within = [](double value, double low, double high) { return value >= low && value <= high; };
  bool fine = count == (color ? 10u : 8u) && within(numbers[3], kSmallestBrush, kLargestBrush) &&
              within(numbers[4], 0, 1) && within(numbers[5], 0, kLargestFalloff) && within(numbers[7], 0, 1) &&
              within(numbers[8], 0, 1) && within(numbers[9], 0, 1);
  for (std::size_t k = 0; k < 3; ++k) fine = fine && within(numbers[k], -kFarthestStroke, kFarthestStroke);
  if (!fine)
    throw InputError("", "stroke of paint",
                     std::string("is not ") + (color ? "ten" : "eight") + " numbers in their ranges",
                     std::string("write x y z, radius 0.003 to 0.3, strength 0 to 1, falloff 0 to 8, mirror 0 or 1, ") +
                         (color ? "red, green and blue 0 to 1" : "value 0 to 1"));
  PaintSample sample{field, {numbers[0], numbers[1], numbers[2]}, numbers[3], numbers[4], numbers[5], numbers[6] != 0};
  if (color)
    sample.color = {numbers[7], numbers[8], numbers[9]};
  else
    sample.value = numbers[7];
  return sample;
}

void applyPaint(const PaintSample& sample, int index, Demo& demo) {
  Actor& actor = demo.actors[static_cast<std::size_t>(index)];
  const std::vector<TouchedRoot> roots = touchedRoots(sample, actor);
  const bool off_hair = std::ranges::none_of(roots, [](const TouchedRoot& root) { return root.weight > kNothing; });
  if (off_hair && goesOn(Ask::kPaint, demo.edits)) return;
  if (off_hair) throw InputError("", "the paint", "reaches no hair", "move it onto the hair, or make the brush larger");
  FieldFiles maps = actor.spec.maps;
  std::string& picture = *findMap(sample.field, maps);
  const bool curled = curlStraightHair(sample, picture, actor);
  Painted anew = painted(sample, roots, picture);
  if (anew.away < kAlike && !goesOn(Ask::kPaint, demo.edits))
    throw InputError("", "the paint", "is there already", "choose another value, or another place");
  picture = std::move(anew.picture);
  // As it will be read again.
  if (sample.field == "length") {
    repaintLength(readFieldMap(picture), index, demo);
  } else if (sample.field == "density") {
    repaintDensity(readFieldMap(picture), index, demo);
  } else if (isOfLook(sample.field)) {
    repaintLook(maps, actor.spec.curves, index, demo);
  } else {
    repaintHair(paintedShares(maps, actor.spec.curves, actor.body->character.scalp, actor.haircut->mesh.shape), index,
                demo);
  }
  Actor& painted_actor = demo.actors[static_cast<std::size_t>(index)];
  painted_actor.spec.maps = std::move(maps);
  if (std::string note = paintNote(sample.field, painted_actor.spec); !note.empty())
    demo.message = note, demo.message_is_fault = false;
  else if (curled)
    showMessage("curls of 6 mm where curl is painted; Look has their radius", demo);
}

void repaint(const FieldFiles& maps, const FieldCurves& curves, int index, Demo& demo) {
  const Actor& actor = demo.actors[static_cast<std::size_t>(index)];
  const bool another_density = maps.density != actor.spec.maps.density;
  std::optional<FieldMap> density;
  if (another_density && !maps.density.empty()) density = readFieldMap(maps.density);
  const PaintedShares shares = paintedShares(maps, curves, actor.body->character.scalp, actor.haircut->mesh.shape);
  repaintLook(maps, curves, index, demo);
  if (another_density) repaintDensity(density, index, demo);
  repaintHair(shares, index, demo);
}

std::string paintNote(const std::string& field, const CharacterSpec& spec) {
  const render::HairLook& look = spec.look.hair;
  const char* parameter = field == "curl" && look.curl_radius == 0 ? "curl_radius"
                          : field == "clump" && look.clump == 0    ? "clump"
                          : field == "frizz" && look.frizz == 0    ? "frizz"
                                                                   : nullptr;
  if (parameter == nullptr || (mapOf(field, spec.maps).empty() && curveOf(field, spec.curves).empty())) return "";
  return "painted " + field + " changes nothing while " + parameter + " is 0";
}

void applyCurve(const std::string& name, const std::string& text, int index, Demo& demo) {
  Actor& actor = demo.actors[static_cast<std::size_t>(index)];
  FieldCurves curves = actor.spec.curves;
  setCurve(name, text, curves);
  if (isOfLook(name))
    repaintLook(actor.spec.maps, curves, index, demo);
  else
    repaintHair(paintedShares(actor.spec.maps, curves, actor.body->character.scalp, actor.haircut->mesh.shape), index,
                demo);
  actor.spec.curves = std::move(curves);
}

}  // namespace app

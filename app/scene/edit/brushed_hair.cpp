#include "app/scene/edit/brushed_hair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "app/groom/edit/mesh_edit.h"
#include "app/scene/edit/groom_brush.h"
#include "app/scene/haircuts.h"
#include "app/styles/style_untangle.h"
#include "sim/field_text.h"
#include "sim/mesh/field_bytes.h"
#include "sim/mesh/shape_transfer.h"

namespace app {

namespace {

constexpr double kMendedFatness = 0.04, kMendedGap = 0.002;  // see untangle; m
constexpr double kFlattest = 1e-3;                           // fatness of a corner that counts as flat
constexpr int kCarryRounds = 10;                             // of giving columns less of what brushes have made
constexpr double kLessNext = 0.6;                            // of their share, for columns of flat prisms
constexpr double kNearlyAll = 0.97;                          // of it: no word of what lacks

// What brushes worked on: the same on every head and at every resolution.
std::string brushedOn(const CharacterSpec& spec) {
  const std::string hair = spec.hair.empty() ? std::string(styleName(spec.style)) : spec.hair + " " + spec.mends;
  return hair + "|" + spec.maps.length;
}

std::string placedTies(const CharacterSpec& spec, const std::vector<HairTie>& ties) {
  std::string text = writeTies(spec.ties).dump();
  for (const HairTie& tie : ties) {
    for (const double value : tie.at) text.append(1, ' ').append(sim::numberText(value));
  }
  return text;
}

// What is worn presses hair down; strokes on it are added to the hair as it was before.
BrushedShape shapeOf(const Haircut& worn, const std::optional<BrushedShape>& earlier) {
  BrushedShape now{worn.mesh.shape, {}, worn.frozen};
  if (!worn.remeshed) now.before = worn.uncovered.empty() ? worn.painted : worn.uncovered;
  std::vector<Vec3>& positions = now.shape.positions;
  for (std::size_t v = 0; v < worn.uncovered.size(); ++v)
    positions[v] = worn.uncovered[v] + (positions[v] - worn.painted[v]);
  if (earlier && !worn.remeshed && sameStructure(earlier->shape, now.shape)) now.before = earlier->before;
  return now;
}

// m, by how much brushes have moved each vertex of `grown`.
std::vector<Vec3> broughtBy(const BrushedShape& brushed, const sim::HairMeshShape& grown) {
  std::vector<Vec3> way;
  for (std::size_t v = 0; v < brushed.before.size(); ++v) way.push_back(brushed.shape.positions[v] - brushed.before[v]);
  if (sameStructure(brushed.shape, grown)) return way;
  sim::HairMeshShape before = brushed.shape;
  before.positions = brushed.before;
  const sim::HairMesh from = sim::buildHairMesh(std::move(before)), to = sim::buildHairMesh(sim::HairMeshShape(grown));
  std::vector<Vec3> carried(grown.positions.size());
  sim::transferVectors(sim::makeShapeTransfer(from, to), way, carried);
  for (int v = 0; v < to.vertexCount(); ++v) {
    if (to.isRoot(v)) carried[static_cast<std::size_t>(v)].setZero();
  }
  return carried;
}

// The columns that a flat or inverted prism has among its corners.
std::set<int> flatColumns(const sim::HairMeshShape& shape) {
  std::set<int> flat;
  for (const sim::RootFace& face : shape.root_faces) {
    const int n = face.corner_count;
    const auto column = [&](int corner) { return face.columns[static_cast<std::size_t>(corner % n)]; };
    for (int l = 0; l + 1 < shape.bundleLayers(face); ++l) {
      for (int k = 0; k < 2 * n; ++k) {
        std::array<Vec3, 4> at;
        const std::array<int, 4> tet = sim::cornerTetOf(k, n);
        for (std::size_t j = 0; j < 4; ++j)
          at[j] = shape.positions[static_cast<std::size_t>(
              shape.column_first[static_cast<std::size_t>(column(tet[j]))] + l + tet[j] / n)];
        if (cornerFatness(at[0], at[1], at[2], at[3]) >= kFlattest) continue;
        for (const int corner : tet) flat.insert(column(corner));
      }
    }
  }
  return flat;
}

// Moves `shape` as brushes moved another mesh. Returns the share that found room, in the mean over what it moves.
double carry(const BrushedShape& brushed, double scale, const BodyDistance& distance, sim::HairMeshShape& shape) {
  const BodyDistance around = distance ? distance : [](const Vec3&) { return 1.0; };
  const std::vector<Vec3> way = broughtBy(brushed, shape);
  std::vector<double> share(static_cast<std::size_t>(shape.columnCount()), 1.0);
  for (int round = 0; round < kCarryRounds; ++round) {
    sim::HairMeshShape tried = shape;
    double kept = 0, all = 0;
    for (std::size_t c = 0; c < share.size(); ++c) {
      for (auto v = static_cast<std::size_t>(shape.column_first[c]);
           v < static_cast<std::size_t>(shape.column_first[c + 1]); ++v) {
        tried.positions[v] += share[c] * scale * way[v];
        kept += share[c] * way[v].norm(), all += way[v].norm();
      }
    }
    untangle(around, kMendedFatness, kMendedGap, tried);
    const std::set<int> flat = flatColumns(tried);
    if (flat.empty() && isValid(tried)) {
      shape = std::move(tried);
      return all > 0 ? kept / all : 1;
    }
    if (flat.empty()) break;
    for (const int c : flat) share[static_cast<std::size_t>(c)] *= kLessNext;
  }
  return 0;
}

void noteShare(double share, Haircut& haircut) {
  if (share > kNearlyAll) return;
  const std::string note = share == 0
                               ? "what brushes made of the hair finds no room here, Ctrl+Z brings it back"
                               : "for want of room " + std::to_string(std::lround(100 * share)) +
                                     " % of what brushes made of the hair is kept here, Ctrl+Z brings all of it back";
  if (haircut.note.find(note) == std::string::npos) haircut.note += (haircut.note.empty() ? "" : "\n") + note;
}

}  // namespace

std::vector<std::byte> brushedHair(const Actor& actor) {
  const Haircut& worn = *actor.haircut;
  const CharacterSpec& spec = actor.spec;
  BrushedHair brushed = readBrushed(spec.brushed).value_or(BrushedHair{});
  const bool at_home = brushed.body == actor.body->key && brushed.resolution == spec.resolution;
  const bool as_carried =
      !at_home && worn.frozen.empty() && worn.loose && worn.loose->positions == worn.mesh.shape.positions;
  if (as_carried || (!reshapedByHand(worn) && !worn.remeshed && worn.frozen.empty())) return spec.brushed;
  if (!at_home) brushed = {};
  brushed.hair = brushedOn(spec);
  brushed.body = actor.body->key;
  brushed.resolution = spec.resolution;
  brushed.head_height = actor.body->character.scalp.head_height;
  if (spec.ties.empty()) {
    brushed.loose = shapeOf(worn, brushed.loose);
    brushed.tied.reset();
  } else {
    const std::string ties = placedTies(spec, worn.ties);
    if (!brushed.loose && worn.loose) brushed.loose = BrushedShape{*worn.loose, worn.grown, {}};
    brushed.tied = shapeOf(worn, brushed.ties == ties ? brushed.tied : std::nullopt);
    brushed.ties = ties;
  }
  return brushedBytes(brushed);
}

std::optional<sim::HairMeshShape> looseBrushed(const Actor& actor) {
  const Haircut& worn = *actor.haircut;
  if (!worn.edited || !actor.spec.ties.empty() || (!reshapedByHand(worn) && !worn.remeshed)) return worn.loose;
  return shapeOf(worn, std::nullopt).shape;
}

std::string keepBrushed(const Actor& actor, bool another_hair, CharacterSpec& spec) {
  const CharacterSpec& now = actor.spec;
  spec.brushed.clear();
  const std::vector<std::byte> bytes = brushedHair(actor);
  std::optional<BrushedHair> brushed = readBrushed(bytes);
  if (!brushed) return "";
  const bool another_head = spec.motion != now.motion || spec.parts != now.parts,
             another_mesh = spec.resolution != now.resolution,
             own_mesh = brushed->loose && brushed->loose->before.empty();
  const bool keeps = !another_hair && brushed->hair == brushedOn(spec) && !(own_mesh && (another_head || another_mesh));
  const bool untied = brushed->tied && writeTies(spec.ties) != writeTies(now.ties);
  if (untied) brushed->tied.reset();
  if (keeps && !untied) {
    spec.brushed = bytes;
    return "";
  }
  if (keeps && brushed->loose) spec.brushed = brushedBytes(*brushed);
  return std::string("; what brushes made of the ") + (keeps ? "tied " : "") + "hair is gone, Ctrl+Z brings it back";
}

void putBrushed(const CharacterSpec& spec, const LoadedBody& body, Haircut& haircut, Dress dress,
                sim::HairMeshShape& shape) {
  const std::optional<BrushedHair> brushed = readBrushed(spec.brushed);
  if (!brushed || brushed->hair != brushedOn(spec)) return;
  const bool tied = dress == Dress::kTied;
  const std::optional<BrushedShape>& own = tied ? brushed->tied : brushed->loose;
  if (!own || (tied && brushed->ties != placedTies(spec, haircut.ties))) return;
  const bool at_home = brushed->body == body.key && brushed->resolution == spec.resolution;
  const bool own_mesh = own->before.empty();
  std::vector<Vec3> grown = own_mesh ? std::vector<Vec3>() : shape.positions;
  if (at_home && (own_mesh || sameStructure(own->shape, shape)) && isValid(own->shape)) {
    shape = own->shape;
    haircut.frozen = own->frozen;
    haircut.remeshed = own_mesh;
  } else {
    const double scale = body.character.scalp.head_height / brushed->head_height;
    const double share = own_mesh ? 0 : carry(*own, scale, body.distance, shape);
    noteShare(share, haircut);
    if (share == 0) return;
  }
  haircut.edited = true;
  if (tied) return;
  haircut.loose = shape;
  haircut.grown = std::move(grown);
}

std::vector<FaceRow> faceRows(const sim::HairMeshShape& shape) {
  std::vector<FaceRow> rows;
  for (const auto& [corners, columns] : shape.root_faces)
    rows.push_back({corners, columns[0], columns[1], columns[2], columns[3]});
  return rows;
}

std::vector<sim::RootFace> rootFaces(std::span<const FaceRow> rows) {
  std::vector<sim::RootFace> faces;
  for (const auto& [corners, a, b, c, d] : rows) faces.push_back({corners, {a, b, c, d}});
  return faces;
}

namespace {

std::vector<char> lettersOf(const std::string& text) {
  return {text.begin(), text.end()};
}

std::string readLetters(sim::ByteReader& from) {
  std::vector<char> letters;
  sim::readBytes(from, letters);
  return {letters.begin(), letters.end()};
}

void writeShape(const std::optional<BrushedShape>& one, sim::Bytes& out) {
  sim::writeBytes(static_cast<int>(one.has_value()), out);
  if (!one) return;
  sim::writeBytes(faceRows(one->shape), out);
  sim::writeBytes(one->shape.column_first, out);
  for (const std::vector<Vec3>* places : {&one->shape.positions, &one->shape.groom_offsets, &one->before})
    sim::writeBytes(*places, out);
  sim::writeBytes(one->frozen, out);
}

// Whether the sizes are those of one hair mesh: bytes may have been made by hand.
bool fitsItself(const BrushedShape& one) {
  const sim::HairMeshShape& shape = one.shape;
  const std::size_t vertices = shape.positions.size();
  const auto sized = [&](std::size_t size) { return size == 0 || size == vertices; };
  const auto column = [&](int c) { return c >= 0 && c < shape.columnCount(); };
  return !shape.column_first.empty() && shape.column_first.front() == 0 && std::ranges::is_sorted(shape.column_first) &&
         static_cast<std::size_t>(shape.vertexCount()) == vertices && sized(shape.groom_offsets.size()) &&
         sized(one.before.size()) && sized(one.frozen.size()) &&
         std::ranges::all_of(shape.root_faces, [&](const sim::RootFace& face) {
           return (face.corner_count == 3 || face.corner_count == 4) &&
                  std::all_of(face.columns.begin(), face.columns.begin() + face.corner_count, column);
         });
}

void readShape(sim::ByteReader& from, std::optional<BrushedShape>& one) {
  int there = 0;
  sim::readBytes(from, there);
  if (there == 0) return;
  BrushedShape read;
  std::vector<FaceRow> faces;
  sim::readBytes(from, faces);
  read.shape.root_faces = rootFaces(faces);
  read.shape.column_first.clear();
  sim::readBytes(from, read.shape.column_first);
  for (std::vector<Vec3>* places : {&read.shape.positions, &read.shape.groom_offsets, &read.before})
    sim::readBytes(from, *places);
  sim::readBytes(from, read.frozen);
  from.complete = from.complete && fitsItself(read);
  one = std::move(read);
}

}  // namespace

std::vector<std::byte> brushedBytes(const BrushedHair& brushed) {
  sim::Bytes out;
  for (const std::string* text : {&brushed.hair, &brushed.body, &brushed.ties}) sim::writeBytes(lettersOf(*text), out);
  sim::writeBytes(static_cast<int>(brushed.resolution), out);
  sim::writeBytes(brushed.head_height, out);
  for (const auto* one : {&brushed.loose, &brushed.tied}) writeShape(*one, out);
  return out;
}

std::optional<BrushedHair> readBrushed(std::span<const std::byte> bytes) {
  if (bytes.empty()) return {};
  sim::ByteReader from{bytes};
  BrushedHair read;
  int resolution = 0;
  for (std::string* text : {&read.hair, &read.body, &read.ties}) *text = readLetters(from);
  sim::readBytes(from, resolution);
  read.resolution = static_cast<Resolution>(std::clamp(resolution, 0, static_cast<int>(Resolution::kMinimal)));
  sim::readBytes(from, read.head_height);
  for (auto* one : {&read.loose, &read.tied}) readShape(from, *one);
  if (!from.complete || !(read.head_height > 0) || !std::isfinite(read.head_height)) return {};
  return read;
}

}  // namespace app

#include "tests/stress/stage.h"

#include <algorithm>
#include <filesystem>

#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "tests/stress/random.h"

namespace stress {
namespace {

constexpr double kSettle = 1.5;  // s
constexpr int kTenThousandVertices = 10000;

// Columns of `lengths` layers each; the faces whose columns are all kept.
sim::HairMeshShape trimmed(const sim::HairMeshShape& shape, const std::vector<int>& lengths,
                           const std::vector<sim::RootFace>& faces) {
  sim::HairMeshShape out;
  std::vector<int> renamed(static_cast<std::size_t>(shape.columnCount()), -1);
  for (int c = 0; c < shape.columnCount(); ++c) {
    if (lengths[c] == 0) continue;
    renamed[c] = out.columnCount();
    const auto first = shape.positions.begin() + shape.column_first[c];
    out.positions.insert(out.positions.end(), first, first + lengths[c]);
    out.column_first.push_back(static_cast<int>(out.positions.size()));
  }
  for (sim::RootFace face : faces) {
    for (int k = 0; k < face.corner_count; ++k) face.columns[k] = renamed[face.columns[k]];
    out.root_faces.push_back(face);
  }
  return out;
}

// Bundles end anywhere between half and all of their length; a column is as long as its longest bundle.
sim::HairMeshShape uneven(const sim::HairMeshShape& shape) {
  Random random(7);
  std::vector<int> lengths(static_cast<std::size_t>(shape.columnCount()), 2);
  for (const sim::RootFace& face : shape.root_faces) {
    const int layers = std::max(2, static_cast<int>(random(0.4, 1.0) * shape.bundleLayers(face) + 0.5));
    for (int k = 0; k < face.corner_count; ++k) lengths[face.columns[k]] = std::max(lengths[face.columns[k]], layers);
  }
  return trimmed(shape, lengths, shape.root_faces);
}

sim::HairMeshShape singleBundle(const sim::HairMeshShape& shape) {
  const sim::RootFace& face = shape.root_faces[shape.root_faces.size() / 2];
  const int layers = shape.bundleLayers(face);
  std::vector<int> lengths(static_cast<std::size_t>(shape.columnCount()), 0);
  for (int k = 0; k < face.corner_count; ++k) lengths[face.columns[k]] = layers;
  return trimmed(shape, lengths, {face});
}

// Layers interpolated along the columns until there are `vertices`.
sim::HairMeshShape refined(const sim::HairMeshShape& shape, int vertices) {
  const double factor = static_cast<double>(vertices) / shape.vertexCount();
  sim::HairMeshShape out;
  out.root_faces = shape.root_faces;
  for (int c = 0; c < shape.columnCount(); ++c) {
    const int segments = shape.columnLength(c) - 1;
    const int fine = static_cast<int>(factor * (segments + 1));
    for (int l = 0; l <= fine; ++l) {
      const double at = static_cast<double>(l) * segments / fine;
      const int below = std::min(static_cast<int>(at), segments - 1);
      const sim::Vec3 &a = shape.positions[shape.column_first[c] + below],
                      &b = shape.positions[shape.column_first[c] + below + 1];
      out.positions.push_back(a + (at - below) * (b - a));
    }
    out.column_first.push_back(static_cast<int>(out.positions.size()));
  }
  return out;
}

sim::HairMeshShape recut(Cut cut, const sim::HairMeshShape& shape) {
  switch (cut) {
    case Cut::kUneven:
      return uneven(shape);
    case Cut::kSingleBundle:
      return singleBundle(shape);
    case Cut::kTenThousand:
      return refined(shape, kTenThousandVertices);
    case Cut::kStyle:
      break;
  }
  return shape;
}

}  // namespace

std::string findClip(const std::string& name) {
  for (const std::string& folder :
       {app::dataPath("assets/clips"), app::dataPath("../shared/mocap"), app::dataPath("../shared/arcsim")}) {
    const std::string file = (std::filesystem::path(folder) / name).string();
    if (std::filesystem::exists(file)) return file;
  }
  return "";
}

std::string hairName(const HairChoice& hair) {
  const std::string style =
      std::string(app::styleName(hair.style)) + "-" + std::string(app::resolutionName(hair.resolution));
  switch (hair.cut) {
    case Cut::kUneven:
      return "uneven-" + style;
    case Cut::kSingleBundle:
      return "bundle-" + style;
    case Cut::kTenThousand:
      return "ten-thousand-" + style;
    case Cut::kStyle:
      break;
  }
  return style;
}

const std::vector<app::PartDistance>& partsOf(Stage& stage) {
  app::LoadedBody& body = *stage.actor.body;
  if (!body.has_parts) body.parts = app::partDistances(body.character);
  body.has_parts = true;
  return body.parts;
}

Stage& StageStore::stage(const StressCase& one) {
  sim::SimParams settling;
  settling.collider = colliderOf(one);
  const std::string key =
      one.clip + "|" + hairName(one.hair) + (settling.collider == sim::ColliderKind::kSdf ? "|distances" : "");
  for (const auto& known : stages_) {
    if (known->key == key) {
      known->actor.playback = known->start;
      app::placeActor(known->actor, true);
      known->actor.hair = known->settled;
      return *known;
    }
  }
  app::CharacterSpec spec;
  spec.motion = findClip(one.clip);
  if (spec.motion.empty()) throw app::InputError(one.clip, "", "is not here", "see --list for the clips in use");
  if (spec.motion.ends_with(".mot"))
    spec.parts = (std::filesystem::path(spec.motion).parent_path() / "female-objs").string();
  spec.style = one.hair.style;
  spec.resolution = one.hair.resolution;
  auto stage = std::make_unique<Stage>();
  stage->key = key;
  stage->actor = app::makeActor(spec, {}, asset_cache_);
  if (one.hair.cut != Cut::kStyle) {
    auto haircut = std::make_unique<app::Haircut>();
    haircut->key = key;
    haircut->mesh = sim::buildHairMesh(recut(one.hair.cut, stage->actor.haircut->mesh.shape));
    stage->actor.haircut = haircut.get();
    asset_cache_.haircuts.push_back(std::move(haircut));
    stage->actor.context = std::make_unique<sim::StepContext>(stage->mesh());
    app::placeActor(stage->actor, true);
  }
  app::settleActor(settling, kSettle, stage->actor);
  stage->settled = stage->actor.hair;
  stage->start = stage->actor.playback;
  stages_.push_back(std::move(stage));
  return *stages_.back();
}

}  // namespace stress

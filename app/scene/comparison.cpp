#include "app/scene/comparison.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/files/file_kind.h"
#include "app/files/presets.h"
#include "app/files/report_line.h"
#include "app/scene/demo.h"
#include "app/scene/demo_state.h"
#include "app/scene/edit/groom_brush.h"
#include "app/scene/edit/hand_pins.h"
#include "app/scene/edit/mesh_change.h"
#include "app/scene/present_scene.h"
#include "sim/forces/rest_balance.h"

namespace app {

namespace {

std::vector<CharacterLook*> looksOf(Scene& scene) {
  std::vector<CharacterLook*> looks;
  for (CharacterSpec& spec : scene.characters) looks.push_back(&spec.look);
  return looks;
}

// "bend=0.1,friction=0.5".
void setAll(const std::string& text, Scene& scene) {
  std::vector<CharacterLook*> looks = looksOf(scene);
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size()), equals = text.find('=', at);
    if (equals >= end) throw InputError("", "'" + text.substr(at, end - at) + "'", "is no setting", "write NAME=VALUE");
    const std::string fault = setAnywhere(text.substr(at, equals - at), text.substr(equals + 1, end - equals - 1),
                                          scene.sim, looks, scene.look);
    if (!fault.empty()) throw InputError("", text.substr(at, equals - at), fault, "");
    at = end + 1;
  }
}

Scene sceneFromFile(const std::string& file, Scene scene) {
  std::vector<CharacterLook*> looks = looksOf(scene);
  switch (fileKind(file)) {
    case FileKind::kScene:
      return loadScene(file);
    case FileKind::kPreset:
      loadPreset(file, {&scene.sim, &scene.look, looks});
      return scene;
    case FileKind::kHairMesh:
      for (CharacterSpec& spec : scene.characters) spec.hair = file;
      return scene;
    default:
      throw InputError(file, "", "is nothing to compare with",
                       "give a preset, a scene, a hair mesh, a groom, or NAME=VALUE");
  }
}

}  // namespace

Scene comparedScene(const std::string& with, Scene scene) {
  if (with.empty()) return scene;
  if (with.find('=') != std::string::npos) {
    setAll(with, scene);
    return scene;
  }
  std::string file = with;
  for (const char* kind : {"hair", "scenes"}) file = findFile(file, "", kind);
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) file = presetFile(with, "");
  return sceneFromFile(file, std::move(scene));
}

namespace {

bool sameHair(const Demo& a, const Demo& b) {
  return std::ranges::equal(a.actors, b.actors, [](const Actor& one, const Actor& other) {
    const bool as_many = one.haircut->mesh.vertexCount() == other.haircut->mesh.vertexCount();
    return (as_many || one.haircut->remeshed) && one.spec.hair == other.spec.hair &&
           one.spec.style == other.spec.style && one.spec.motion == other.spec.motion;
  });
}

// The other one where the first one is by now: its very state, or where the hair is another its place in the clip.
void catchUp(const Demo& demo, Demo& other) {
  if (sameHair(demo, other)) {
    for (std::size_t i = 0; i < demo.actors.size(); ++i) {
      if (demo.actors[i].haircut->remeshed)
        bringBackShape(demo.actors[i].haircut->mesh.shape, demo.actors[i].context->material().sag(),
                       static_cast<int>(i), other);
      else if (demo.actors[i].haircut->edited)
        reshapeHair(demo.actors[i].haircut->mesh.shape.positions, static_cast<int>(i), other);
      repin(demo.actors[i].spec.pins, other.actors[i]);
    }
    return restoreDemoState(demoStateBytes(demo), "comparison", true, other);
  }
  for (std::size_t i = 0; i < std::min(demo.actors.size(), other.actors.size()); ++i) {
    if (demo.actors[i].spec.motion != other.actors[i].spec.motion) continue;
    other.actors[i].playback = demo.actors[i].playback;
    placeActor(other.actors[i], true);
    settleActor(other.scene.sim, other.scene.playback.settle, other.actors[i]);
  }
  other.clock = demo.clock;
  other.frames = demo.frames;
}

// The same hair in the same place, but for its resolution.
bool comparable(const Demo& a, const Demo& b) {
  return std::ranges::equal(a.actors, b.actors, [](const Actor& one, const Actor& other) {
    const CharacterSpec &x = one.spec, &y = other.spec;
    return x.style == y.style && x.hair == y.hair && writeTies(x.ties) == writeTies(y.ties) &&
           wornText(x.attachments) == wornText(y.attachments) && x.maps.length == y.maps.length &&
           x.motion == y.motion && x.position == y.position && x.heading == y.heading;
  });
}

// Of hair with as many vertices vertex by vertex, of a style at two resolutions at the first one's vertices.
HairDifference measure(const Demo& demo, const Demo& other) {
  if (!comparable(demo, other)) return {};
  double squares = 0, worst = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < demo.actors.size(); ++i) {
    const Actor &a = demo.actors[i], &b = other.actors[i];
    const sim::HairMesh &mesh = a.haircut->mesh, &from = b.haircut->mesh;
    std::vector<Vec3> moved = b.hair.positions;
    if (moved.size() != a.hair.positions.size()) {
      moved.resize(a.hair.positions.size());
      sim::transferPositions(sim::makeShapeTransfer(from, mesh), from, mesh, scalpToWorld(b.body->character, b.pose),
                             b.hair.positions, moved);
    }
    for (std::size_t v = 0; v < moved.size(); ++v) {
      const double apart = (moved[v] - a.hair.positions[v]).squaredNorm();
      squares += apart;
      worst = std::max(worst, apart);
    }
    count += moved.size();
  }
  return {true, std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, count))), std::sqrt(worst)};
}

constexpr std::array kOfBoth{Ask::kPause,    Ask::kPauseMotion, Ask::kSingleStep, Ask::kReset,      Ask::kRestart,
                             Ask::kCollapse, Ask::kCarryAlong,  Ask::kSpeed,      Ask::kLoop,       Ask::kClip,
                             Ask::kSelect,   Ask::kDebugView,   Ask::kRewind,     Ask::kMotionFile, Ask::kClearBake};

}  // namespace

void startComparison(const std::string& with, Demo& demo) {
  Scene scene = presentScene(demo);
  for (std::size_t i = 0; i < demo.actors.size(); ++i) scene.characters[i].pins = pinsForAnotherMesh(demo.actors[i]);
  Demo other = openScene(comparedScene(with, std::move(scene)), demo.aspect);
  if (demo.frames > 0) catchUp(demo, other);
  other.paused = demo.paused;
  other.timeline.on = demo.timeline.on;
  other.debug = demo.debug;
  Comparison fresh;
  fresh.with = with;
  fresh.side_by_side = demo.comparison.side_by_side;
  fresh.line = demo.comparison.line;
  fresh.other.push_back(std::move(other));
  demo.comparison = std::move(fresh);
  demo.shown_fraction = -1;
}

std::vector<Request> sharedRequests(const std::vector<Request>& requests) {
  std::vector<Request> shared;
  for (const Request& request : requests) {
    if (std::ranges::find(kOfBoth, request.what) != kOfBoth.end()) shared.push_back(request);
  }
  return shared;
}

void advanceCompared(double seconds, std::vector<Request> requests, Demo& demo) {
  Comparison& comparison = demo.comparison;
  if (!comparison.on()) return;
  Demo& other = comparison.other.front();
  other.requests = std::move(requests);
  other.governor.counted = demo.governor.counted;
  other.deadline.counted = demo.deadline.counted;
  other.picture_height = demo.picture_height;
  other.timeline.in = demo.timeline.in, other.timeline.out = demo.timeline.out;
  advanceFrame(other, seconds, {});
  other.camera = demo.camera;
  other.paused = demo.paused;
  comparison.now = measure(demo, other);
  if (demo.stats.steps == 0) return;
  ++comparison.frames;
  comparison.rms_sum += comparison.now.rms;
  comparison.worst = std::max(comparison.worst, comparison.now.worst);
  comparison.seconds[0] += demo.stats.simulation();
  comparison.seconds[1] += other.stats.simulation();
}

std::string comparisonText(const Demo& demo) {
  const Comparison& comparison = demo.comparison;
  if (!comparison.on()) return "";
  const double frames = static_cast<double>(std::max(1L, comparison.frames));
  std::string apart = "other hair";
  if (comparison.now.known)
    apart = "hair apart by " + threeDigits(1e3 * comparison.rms_sum / frames) + " mm RMS in the mean (" +
            threeDigits(100 * comparison.rms_sum / frames / demo.actors.front().haircut->mesh.hair_length) +
            " % of its length), " + threeDigits(1e3 * comparison.worst) + " mm at most";
  return apart + "; simulation " + threeDigits(1e3 * comparison.seconds[0] / frames) +
         " ms a frame in the mean against " + threeDigits(1e3 * comparison.seconds[1] / frames) + " ms";
}

}  // namespace app

#include "app/scene/project.h"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/files/errors.h"
#include "app/files/folder_list.h"
#include "app/files/json_kind.h"
#include "app/files/json_reader.h"
#include "app/files/output_file.h"
#include "app/files/text_file.h"
#include "app/scene/demo_state.h"
#include "app/scene/edit/brushed_hair.h"
#include "app/scene/edit/cut_stroke.h"
#include "app/scene/edit/groom_brush.h"
#include "app/scene/edit/mesh_change.h"
#include "app/scene/present_scene.h"
#include "sim/forces/rest_balance.h"
#include "sim/linear/vector3.h"
#include "sim/mesh/field_bytes.h"

namespace app {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double kKeepEvery = 2;       // s, between edits: at most so often
constexpr double kKeepInGesture = 20;  // s, while one goes on: writing would show in it
constexpr double kTryAgain = 20;       // s, after a fault
constexpr double kLookEvery = 1;       // s, whether the file was saved
const std::string kKey(kProjectKey), kAutosaveOf(kAutosaveKey);

std::string hex(std::uint64_t value) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

std::string textOf(const sim::Bytes& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// How far gravity would draw hair whose mesh is its own: from there its balance goes on where the project is opened.
std::vector<Vec3> sagOf(const Actor& actor) {
  std::vector<Vec3> sag;
  if (!actor.haircut->remeshed) return sag;
  for (const sim::V3<double>& way : actor.context->material().sag()) sag.emplace_back(way.x, way.y, way.z);
  return sag;
}

sim::Bytes binaryOf(const Demo& demo) {
  sim::Bytes bytes;
  for (const Actor& actor : demo.actors) sim::writeBytes(actor.spec.brushed, bytes);
  for (const Actor& actor : demo.actors) {
    const sim::HairMeshShape& shape = actor.haircut->mesh.shape;
    sim::writeBytes(actor.haircut->edited ? shape.positions : std::vector<Vec3>(), bytes);
    sim::writeBytes(actor.haircut->remeshed ? shape.column_first : std::vector<int>(), bytes);
    sim::writeBytes(actor.haircut->remeshed ? faceRows(shape) : std::vector<FaceRow>(), bytes);
    sim::writeBytes(actor.haircut->remeshed ? shape.groom_offsets : std::vector<Vec3>(), bytes);
    sim::writeBytes(sagOf(actor), bytes);
  }
  const std::string state = demoStateBytes(demo);
  sim::writeBytes(std::vector<char>(state.begin(), state.end()), bytes);
  return bytes;
}

// What the file holds; nothing where it cannot be read.
json contentOf(const std::string& file) {
  try {
    json content = parseJson(readText(file), file);
    return content.is_object() ? content : json::object();
  } catch (const std::exception&) {
    return json::object();
  }
}

// The binary that a project names; empty where it is none.
std::string binaryNamedBy(const std::string& file) {
  const json content = contentOf(file);
  const auto named = content.find("binary");
  return named != content.end() && named->is_string() ? named->get<std::string>() : "";
}

std::string besides(const std::string& file, const std::string& name) {
  return (fs::path(file).parent_path() / fs::path(name).filename()).string();
}

// The shape of one character's hair, where brushes have made it another.
void takeShape(sim::ByteReader& from, double version, const std::string& file, int index, Demo& demo) {
  sim::HairMeshShape shape;
  std::vector<FaceRow> faces;
  std::vector<int> columns;
  sim::readBytes(from, shape.positions);
  if (version > 1) {
    sim::readBytes(from, columns);
    sim::readBytes(from, faces);
  }
  if (version > 2) sim::readBytes(from, shape.groom_offsets);
  std::vector<Vec3> sag;
  if (version > 4) sim::readBytes(from, sag);
  if (shape.positions.empty()) return;
  const std::size_t vertices = demo.actors[static_cast<std::size_t>(index)].hair.positions.size();
  if (!from.complete || (columns.empty() && shape.positions.size() != vertices))
    throw InputError(file, "", "does not fit the scene", "save the project anew");
  if (columns.empty()) return reshapeHair(shape.positions, index, demo);
  shape.column_first = columns;
  shape.root_faces = rootFaces(faces);
  remeshHair(std::move(shape), {}, index, demo);
  // A start that is no number has the balance begin from nothing.
  if (!std::all_of(sag.begin(), sag.end(), [](const Vec3& way) { return way.allFinite(); })) sag.clear();
  std::vector<sim::V3<double>> start;
  for (const Vec3& way : sag) start.push_back({way.x(), way.y(), way.z()});
  demo.actors[static_cast<std::size_t>(index)].context->material().startFrom(std::move(start));
}

}  // namespace

namespace {

// `more`: further keys at its top.
void writeProject(const std::string& file, const Demo& demo, const std::string& scene_name, const json& more) {
  const sim::Bytes binary = binaryOf(demo);
  const std::string checksum = hex(sim::fingerprint(binary));
  const std::string name = fs::path(file).stem().string() + "-" + checksum + ".bin";
  const std::string before = binaryNamedBy(file);
  Scene scene = presentScene(demo);
  if (!scene_name.empty()) scene.name = scene_name;
  json project = {{kKey, kProjectVersion},
                  {"scene", parseJson(writeScene(movable(std::move(scene), file)), file)},
                  {"binary", name},
                  {"checksum", checksum}};
  project.update(more);
  writeFile(besides(file, name), textOf(binary));
  writeFile(file, project.dump(2, ' ', false, json::error_handler_t::replace) + "\n");
  std::error_code ignored;
  if (!before.empty() && before != name) fs::remove(besides(file, before), ignored);
}

json parseProject(const std::string& file) {
  json parsed = parseJson(readText(file), file);
  const JsonPlace place(parsed, file);
  if (jsonKind(place) == JsonKind::kProject) expectTopKeys(place, JsonKind::kProject);
  if (!place.has(kKey)) place.refuse("is no project", "give a file that Save project wrote");
  const double version = place.at(kKey).number(1, 1e6);
  if (version > kProjectVersion)
    place.refuse("is a project of version " + std::to_string(static_cast<int>(version)) +
                     ", newer than this program's " + std::to_string(kProjectVersion),
                 "open it with the program that saved it, or a newer one");
  expectTopKeys(place, JsonKind::kProject);
  for (const std::string_view key : kProjectKeys) {
    if (key != kAutosaveKey && !place.has(std::string(key)))
      place.refuse("lacks \"" + std::string(key) + "\"", "save the project anew");
  }
  return parsed;
}

// When the file was last written, in the file system's own time; empty: it is not there.
std::string savedAt(const std::string& file) {
  std::error_code gone;
  const fs::file_time_type at = fs::last_write_time(file, gone);
  return gone ? "" : std::to_string(at.time_since_epoch().count());
}

// By what it says of itself: a person may save under any name.
bool isAutosave(const std::string& file) {
  return contentOf(file).contains(kAutosaveOf);
}

}  // namespace

void saveProject(const std::string& file, const Demo& demo, const std::string& scene_name) {
  writeProject(file, demo, scene_name, json::object());
}

Scene projectScene(const std::string& file) {
  return readScene(parseProject(file).at("scene").dump(), file);
}

Demo readProject(const std::string& file, Scene scene, bool keep_view, double aspect) {
  const json parsed = parseProject(file);
  const JsonPlace place(parsed, file);
  const std::string binary_file = besides(file, place.at("binary").text());
  const std::string binary = readText(binary_file);
  const auto bytes = std::as_bytes(std::span(binary));
  if (hex(sim::fingerprint(bytes)) != place.at("checksum").text())
    throw InputError(binary_file, "", "is not the one that " + file + " was saved with", "save the project anew");
  std::vector<std::vector<PinSpec>> pins;  // of the shapes, which the scene does not have
  sim::ByteReader from{bytes};
  const double version = place.at(kKey).number(1, 1e6);
  for (CharacterSpec& character : scene.characters) {
    pins.push_back(std::exchange(character.pins, {}));
    if (version > 3) sim::readBytes(from, character.brushed);
    if (!character.brushed.empty() && !readBrushed(character.brushed)) from.complete = false;
  }
  if (!from.complete) throw InputError(binary_file, "", "does not fit the scene", "save the project anew");
  Demo fresh = openScene(std::move(scene), aspect);
  for (std::size_t i = 0; i < fresh.actors.size(); ++i) {
    takeShape(from, version, binary_file, static_cast<int>(i), fresh);
    repin(std::move(pins[i]), fresh.actors[i]);
  }
  std::vector<char> state;
  sim::readBytes(from, state);
  restoreDemoState(std::string(state.begin(), state.end()), binary_file, keep_view, fresh);
  fresh.scene.file = place.has(kAutosaveOf) ? place.at(kAutosaveOf).text() : file;
  return fresh;
}

bool holdsProject(const std::string& file) {
  return contentOf(file).contains(kKey);
}

void openProject(const std::string& file, Demo& demo) {
  replaceScene(readProject(file, projectScene(file), false, demo.aspect), demo);
}

Autosave::Autosave(const std::string& kept_folder) : folder_(kept_folder) {
  if (!folder_.empty()) file_ = (fs::path(folder_) / ("autosave-" + std::to_string(getpid()) + ".json")).string();
}

Autosave::~Autosave() {
  if (file_.empty() || std::uncaught_exceptions() > 0) return;
  forget(file_);
  if (!replaced_.empty()) forget(replaced_);
}

void Autosave::keep(double now, const Demo& demo) {
  // What the last step asked for may still be loading, or be worked on.
  if (file_.empty() || now < look_at_ || !loadingNote(demo).empty() || cutsAreComing(demo)) return;
  look_at_ = now + kLookEvery;
  // What was saved is newer than what was kept before it: that is kept anew at once.
  const std::string& scene = demo.scene.file;
  const std::string saved = scene + " " + savedAt(scene);
  const EditHistory& history = demo.edits;
  if (saved == saved_ && now - last_ < (history.gesture ? kKeepInGesture : kKeepEvery)) return;
  const EditStep* step = history.done > 0 ? &history.steps[history.done - 1] : nullptr;
  const std::string edits = step ? std::to_string(step->number) + " " + step->title : "none";
  if (history.steps.empty() || (edits == kept_ && saved == saved_)) return;
  last_ = now;
  try {
    std::error_code ignored;
    fs::create_directories(folder_, ignored);
    writeProject(file_, demo, "", {{kAutosaveOf, scene.empty() ? "" : fs::absolute(scene).string()}});
    kept_ = history.gesture ? "" : edits, saved_ = saved;
    if (!replaced_.empty()) forget(std::exchange(replaced_, ""));
  } catch (const std::exception&) {
    look_at_ = now + kTryAgain;
  }
}

std::string Autosave::left() const {
  if (folder_.empty()) return "";
  for (const FolderEntry& entry : listFolder(folder_, {".json"})) {
    if (!entry.name.starts_with("autosave-")) continue;
    const long process = std::strtol(entry.name.c_str() + 9, nullptr, 10);
    const bool runs = process > 0 && kill(static_cast<pid_t>(process), 0) == 0;
    const std::string file = (fs::path(folder_) / entry.name).string();
    if (!runs && isAutosave(file)) return file;
  }
  return "";
}

void Autosave::forget(const std::string& file) const {
  if (!isAutosave(file)) return;
  std::error_code ignored;
  if (const std::string binary = binaryNamedBy(file); !binary.empty()) fs::remove(besides(file, binary), ignored);
  fs::remove(file, ignored);
}

}  // namespace app

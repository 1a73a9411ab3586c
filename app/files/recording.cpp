#include "app/files/recording.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "app/files/errors.h"
#include "app/files/json_reader.h"
#include "app/files/report_line.h"
#include "app/files/text_file.h"
#include "sim/field_text.h"

namespace app {

namespace {

using nlohmann::json;

constexpr int kVersion = 3;
constexpr std::size_t kMaxRequests = 1000;                  // a frame
constexpr double kMaxSeconds = 1e6, kLargestValue = 1e300;  // s; of a request's value
constexpr double kFarthestView = 1e6, kMaxViewTurn = 1e3;   // m, rad; of a view
constexpr double kEndUnit = 1e-5, kMaxEndUnits = 1e12;      // m; of a coordinate in such units
constexpr std::size_t kMaxEndNumbers = std::size_t{3} << 20;
constexpr double kMaxAspect = 1e5, kTallestPicture = 1e5;

struct AskName {
  Ask what;
  std::string_view name;
};
// What can be recorded: all but the requests that write files.
constexpr std::array<AskName, 56> kAskNames{{{Ask::kSetParam, "set"},
                                             {Ask::kPause, "pause"},
                                             {Ask::kPauseMotion, "pause-motion"},
                                             {Ask::kSingleStep, "single-step"},
                                             {Ask::kReset, "reset"},
                                             {Ask::kRestart, "restart"},
                                             {Ask::kCollapse, "collapse"},
                                             {Ask::kCarryAlong, "carry-along"},
                                             {Ask::kSpeed, "speed"},
                                             {Ask::kLoop, "loop"},
                                             {Ask::kClip, "clip"},
                                             {Ask::kStyle, "style"},
                                             {Ask::kResolution, "resolution"},
                                             {Ask::kMotionFile, "motion-file"},
                                             {Ask::kBody, "body"},
                                             {Ask::kHairFile, "hair-file"},
                                             {Ask::kHairMends, "hair-mends"},
                                             {Ask::kOpenCache, "cache-file"},
                                             {Ask::kSceneFile, "scene-file"},
                                             {Ask::kPresetFile, "preset-file"},
                                             {Ask::kLoadState, "state-file"},
                                             {Ask::kOpenFile, "open-file"},
                                             {Ask::kSelect, "select"},
                                             {Ask::kView, "view"},
                                             {Ask::kFollow, "follow"},
                                             {Ask::kDebugView, "debug-view"},
                                             {Ask::kBudget, "budget"},
                                             {Ask::kDrawBudget, "draw-budget"},
                                             {Ask::kDeadline, "deadline"},
                                             {Ask::kSkip, "skip"},
                                             {Ask::kBrush, "brush"},
                                             {Ask::kMove, "move"},
                                             {Ask::kMesh, "mesh"},
                                             {Ask::kOpenProject, "project-file"},
                                             {Ask::kRewind, "rewind"},
                                             {Ask::kKeepView, "keep-view"},
                                             {Ask::kGoToView, "go-to-view"},
                                             {Ask::kLens, "lens"},
                                             {Ask::kTurntable, "turntable"},
                                             {Ask::kUndo, "undo"},
                                             {Ask::kRedo, "redo"},
                                             {Ask::kEndGesture, "end-gesture"},
                                             {Ask::kCompare, "compare"},
                                             {Ask::kCompareView, "compare-view"},
                                             {Ask::kMarkIn, "mark-in"},
                                             {Ask::kMarkOut, "mark-out"},
                                             {Ask::kBake, "bake"},
                                             {Ask::kClearBake, "clear-bake"},
                                             {Ask::kMap, "map"},
                                             {Ask::kTie, "tie"},
                                             {Ask::kPin, "pin"},
                                             {Ask::kAttach, "attach"},
                                             {Ask::kPaint, "paint"},
                                             {Ask::kCurve, "curve"},
                                             {Ask::kVary, "vary"},
                                             {Ask::kEnvironment, "environment"}}};

std::string_view nameOf(Ask what) {
  for (const AskName& row : kAskNames) {
    if (row.what == what) return row.name;
  }
  return {};
}

// The next line of `text`, taken off it.
std::string_view nextLine(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

Request readRequest(const JsonPlace& place) {
  if (place.arraySize(4) != 4) place.refuse("is no request", "write [what, name, text, value]");
  const std::string what = place.at(std::size_t{0}).text();
  Request request;
  request.name = place.at(1).text();
  request.text = place.at(2).text();
  request.value = place.at(3).number(-kLargestValue, kLargestValue);
  for (const AskName& row : kAskNames) {
    if (row.name != what) continue;
    request.what = row.what;
    return request;
  }
  place.refuse("names a request that cannot be replayed", "take the line out");
}

RecordedView readView(const JsonPlace& place) {
  place.expectObject({"target", "yaw", "pitch", "distance", "aspect", "height", "shift", "rise", "zoom"});
  const bool shifted = place.has("shift"), raised = place.has("rise"), zoomed = place.has("zoom");
  if (place.value().size() != std::size_t{6} + shifted + raised + zoomed)
    place.refuse("is no view", "write target, yaw, pitch, distance, aspect and height");
  RecordedView view;
  const std::array<double, 3> target = place.at("target").vector(-kFarthestView, kFarthestView);
  view.target = {target[0], target[1], target[2]};
  view.yaw = place.at("yaw").number(-kMaxViewTurn, kMaxViewTurn);
  view.pitch = place.at("pitch").number(-kMaxViewTurn, kMaxViewTurn);
  view.distance = place.at("distance").number(1e-6, kFarthestView);
  view.aspect = place.at("aspect").number(1 / kMaxAspect, kMaxAspect);
  view.height = static_cast<int>(place.at("height").number(1, kTallestPicture));
  if (shifted) view.place.shift = place.at("shift").number(-1, 1);
  if (raised) view.place.rise = place.at("rise").number(-2, 2);
  if (zoomed) view.place.zoom = place.at("zoom").number(0.01, 1);
  return view;
}

json writeView(const RecordedView& view) {
  json written{{"target", {view.target.x(), view.target.y(), view.target.z()}},
               {"yaw", view.yaw},
               {"pitch", view.pitch},
               {"distance", view.distance},
               {"aspect", view.aspect},
               {"height", view.height}};
  if (view.place.shift != 0) written["shift"] = view.place.shift;
  if (view.place.rise != 0) written["rise"] = view.place.rise;
  if (view.place.zoom != 1) written["zoom"] = view.place.zoom;
  return written;
}

RecordedView viewOf(const Demo& demo) {
  const Camera& camera = demo.camera;
  return {camera.target, camera.yaw, camera.pitch, camera.distance, demo.aspect, demo.picture_height, demo.place};
}

void show(const RecordedView& view, Demo& demo) {
  demo.camera.target = view.target;
  demo.camera.yaw = view.yaw;
  demo.camera.pitch = view.pitch;
  demo.camera.distance = view.distance;
  demo.aspect = view.aspect;
  demo.picture_height = view.height;
  demo.place = view.place;
}

RecordedFrame readFrame(const JsonPlace& place) {
  const std::size_t entries = place.arraySize(kMaxRequests + 2);
  if (entries == 0) place.refuse("is no frame", "write [seconds, requests ...]");
  RecordedFrame frame;
  frame.seconds = place.at(std::size_t{0}).number(0, kMaxSeconds);
  std::size_t next = 1;
  if (next < entries && place.at(next).value().is_object()) frame.view = readView(place.at(next++));
  for (; next < entries; ++next) frame.requests.push_back(readRequest(place.at(next)));
  return frame;
}

SkipSet readSkips(const JsonPlace& place) {
  SkipSet skips;
  const std::size_t count = place.arraySize(kSkipCount);
  for (std::size_t k = 0; k < count; ++k) {
    const Skip* skip = findSkip(place.at(k).text());
    if (!skip) place.at(k).refuse("names no skip", "take it out");
    skips.on[skip->id] = false;
  }
  return skips;
}

// Of a recording's text before its last line, and the state that this names.
std::string checksum(std::string_view before, std::string_view state) {
  Fnv hash;
  hash.add(before);
  hash.add(state);
  return hash.digits();
}

std::string headLine(double aspect, const SkipSet& skips) {
  json off = json::array();
  for (const Skip& skip : skipTable()) {
    if (!skips[skip.id]) off.push_back(skip.name);
  }
  return json{{"hairmesh-recording", kVersion}, {"aspect", aspect}, {"skips_off", off}}.dump();
}

std::string frameLine(double seconds, const RecordedView* view, const std::vector<Request>& requests) {
  json line = json::array({seconds});
  if (view) line.push_back(writeView(*view));
  for (const Request& request : requests) {
    const std::string_view name = nameOf(request.what);
    if (!name.empty()) line.push_back({name, request.name, request.text, request.value});
  }
  return line.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string endsLine(const std::vector<ColumnEnds>& ends) {
  json all = json::array();
  for (const ColumnEnds& of_actor : ends) {
    json& row = all.emplace_back(json::array());
    for (const Vec3& end : of_actor) {
      for (const double x : end) row.push_back(std::llround(std::clamp(x / kEndUnit, -kMaxEndUnits, kMaxEndUnits)));
    }
  }
  return json{{"ends", all}}.dump();
}

std::vector<ColumnEnds> readEnds(const JsonPlace& place) {
  std::vector<ColumnEnds> ends(place.arraySize(kMaxCharacters));
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const JsonPlace row = place.at(i);
    const std::size_t numbers = row.arraySize(kMaxEndNumbers);
    if (numbers % 3 != 0) row.refuse("has " + std::to_string(numbers) + " numbers", "write three an end");
    const auto metres = [&](std::size_t k) { return kEndUnit * row.at(k).number(-kMaxEndUnits, kMaxEndUnits); };
    for (std::size_t k = 0; k < numbers; k += 3) ends[i].emplace_back(metres(k), metres(k + 1), metres(k + 2));
  }
  return ends;
}

std::string millimetres(double metres) {
  const double tenths = std::round(1e4 * metres);
  return tenths < 1 ? "less than 0.1 mm" : sim::numberText(tenths / 10) + " mm";
}

// Why a replay ends elsewhere than the run that was recorded.
std::string whyOther(const std::optional<bool>& edited) {
  if (!edited) return "its text was changed after it was recorded, or another build or kind of processor recorded it";
  return *edited ? "its text was changed after it was recorded"
                 : "another build or kind of processor than the one that recorded rounds otherwise";
}

// What is said of a replay whose bits are not the recorded ones, and whether it differs by more than rounding does.
Tape::End otherEnd(const Recording& recorded, const Demo& demo) {
  const std::optional<Apart> apart = apartOf(recorded.ends, columnEnds(demo));
  const bool near = apart && apart->mean <= kMaxApart, whole = recorded.edited && !*recorded.edited;
  std::string words;
  if (apart) {
    words = "the hair ends " + millimetres(apart->mean) + " in the mean, " + millimetres(apart->most) +
            " at most, from where it was recorded to end, ";
    words += (near ? "within the " : "farther than the ") + millimetres(kMaxApart) + " in the mean that pass; ";
  } else if (!recorded.ends.empty()) {
    words = "the hair has not as many columns as when it was recorded: its style or mesh is another one now; ";
  }
  words += whyOther(recorded.edited);
  if (recorded.ends.empty() && !recorded.edited.value_or(false))
    words += "; the recording holds no ends of the hair that tell by how much: record it anew with --record";
  return {words, !(near && whole)};
}

}  // namespace

void Fnv::add(std::string_view text) {
  for (const char c : text) add(static_cast<unsigned char>(c));
}

std::string Fnv::digits() const {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string text;
  for (int shift = 60; shift >= 0; shift -= 4) text += kDigits[hash_ >> shift & 0xf];
  return text;
}

Recording readRecording(std::string_view text, const std::string& file) {
  const std::string_view whole = text;
  int line_number = 0;
  const auto next = [&] {
    ++line_number;
    if (text.empty()) throw InputError(file, "line " + std::to_string(line_number), "is missing", "record anew");
    return nextLine(text);
  };
  const auto named = [&] { return file + ", line " + std::to_string(line_number); };
  Recording recording;
  SkipSet skips;
  {
    const std::string_view line = next();
    const json head = parseJson(line, named());
    const JsonPlace place(head, named());
    place.expectObject({"hairmesh-recording", "aspect", "skips_off"});
    if (!place.has("hairmesh-recording")) place.refuse("is no recording", "give a file that --record wrote");
    const double version = place.at("hairmesh-recording").number(1, kVersion);
    if (version > 1) {
      if (!place.has("aspect") || !place.has("skips_off")) place.refuse("lacks aspect or skips_off", "record anew");
      recording.aspect = place.at("aspect").number(1 / kMaxAspect, kMaxAspect);
      skips = readSkips(place.at("skips_off"));
    }
  }
  const std::string_view scene = next();
  recording.scene = readScene(scene, file);
  recording.scene.skips = skips;
  while (!text.empty()) {
    const std::size_t before = whole.size() - text.size();
    const bool ended = text.find('\n') != std::string_view::npos;
    const std::string_view line = next();
    if (!ended && !json::accept(line))
      throw InputError(named(), "", "the recording is cut off in the middle of this line",
                       "delete the line to replay what is before it, or record anew");
    const json value = parseJson(line, named());
    const JsonPlace place(value, named());
    if (value.is_array()) {
      recording.frames.push_back(readFrame(place));
      continue;
    }
    if (place.has("ends")) {
      place.expectObject({"ends"});
      if (!recording.ends.empty()) place.refuse("ends a second time", "keep one such line");
      recording.ends = readEnds(place.at("ends"));
      continue;
    }
    place.expectObject({"frames", "state", "checksum"});
    if (!place.has("frames") || !place.has("state")) place.refuse("ends nothing", "record anew");
    const double frames = place.at("frames").number(0, 1e12);
    if (frames != static_cast<double>(recording.frames.size()))
      place.refuse(
          "counts " + sim::numberText(frames) + " frames where " + std::to_string(recording.frames.size()) + " are",
          "record anew");
    recording.state = place.at("state").text();
    if (place.has("checksum"))
      recording.edited = place.at("checksum").text() != checksum(whole.substr(0, before), recording.state);
    if (!text.empty()) place.refuse("is followed by more", "end the file here");
  }
  return recording;
}

std::string stateHash(const Demo& demo) {
  Fnv hash;
  const auto add = [&](const std::vector<sim::Vec3>& values) {
    for (const sim::Vec3& value : values) {
      for (int axis = 0; axis < 3; ++axis) {
        const auto bits = std::bit_cast<std::uint64_t>(value[axis]);
        for (int byte = 0; byte < 64; byte += 8) hash.add(bits >> byte & 0xff);
      }
    }
  };
  for (const Actor& actor : demo.actors) {
    add(actor.hair.positions);
    add(actor.hair.velocities);
  }
  return hash.digits();
}

std::vector<ColumnEnds> columnEnds(const Demo& demo) {
  std::vector<ColumnEnds> ends;
  for (const Actor& actor : demo.actors) {
    const sim::HairMesh& mesh = actor.haircut->mesh;
    ColumnEnds& of_actor = ends.emplace_back();
    for (int c = 0; c < mesh.columnCount(); ++c) {
      const int last = mesh.shape.column_first[static_cast<std::size_t>(c)] + mesh.shape.columnLength(c) - 1;
      of_actor.push_back(actor.hair.positions[static_cast<std::size_t>(last)]);
    }
  }
  return ends;
}

std::optional<Apart> apartOf(const std::vector<ColumnEnds>& a, const std::vector<ColumnEnds>& b) {
  Apart apart;
  std::size_t count = 0;
  if (a.size() != b.size()) return {};
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].size() != b[i].size()) return {};
    for (std::size_t k = 0; k < a[i].size(); ++k) {
      double distance = (a[i][k] - b[i][k]).norm();
      if (!std::isfinite(distance)) distance = kMaxEndUnits;
      apart.most = std::max(apart.most, distance);
      apart.mean += distance;
    }
    count += a[i].size();
  }
  if (count == 0) return {};
  apart.mean /= static_cast<double>(count);
  return apart;
}

// Appends to the recording and its checksum.
void Tape::write(const std::string& text) {
  record_->write(text);
  written_.add(text);
}

Tape::Tape(const Options& options, Scene& scene)
    : record_file_(options.record),
      replay_file_(options.replay),
      aspect_(static_cast<double>(options.width) / options.height) {
  if (!replay_file_.empty()) {
    replay_ = readRecording(readText(replay_file_), replay_file_);
    scene = replay_->scene;
    aspect_ = replay_->aspect.value_or(aspect_);
  }
  if (record_file_.empty()) return;
  record_.emplace(record_file_);
  write(headLine(aspect_, scene.skips) + "\n" + parseJson(writeScene(scene), "scene").dump() + "\n");
}

std::optional<int> Tape::frames() const {
  return replay_ ? std::optional<int>(static_cast<int>(replay_->frames.size())) : std::nullopt;
}

std::string Tape::sizeNote(int width, int height) const {
  if (!replay_view_) return "";
  const long across = std::lround(replay_view_->aspect * replay_view_->height), high = replay_view_->height;
  if (across == width && high == height) return "";
  const std::string size = std::to_string(across) + "x" + std::to_string(high);
  return "recorded at " + size + ": --size " + size + " gives its pictures\n";
}

double Tape::turn(int frame, double seconds, Demo& demo) {
  if (replay_) {
    const RecordedFrame& recorded = replay_->frames[static_cast<std::size_t>(frame)];
    demo.requests = recorded.requests;
    seconds = recorded.seconds;
    if (recorded.view) replay_view_ = recorded.view;
    // Every frame: the replay's own picture, and whoever drags in its window, change them.
    if (replay_view_) show(*replay_view_, demo);
  }
  if (record_) {
    const RecordedView view = viewOf(demo);
    write(frameLine(seconds, view == record_view_ ? nullptr : &view, demo.requests) + "\n");
    record_view_ = view;
  }
  ++turns_;
  // The clock does not repeat itself.
  if (replay_ || record_) demo.timeline.on = true;
  if (replay_ || record_) demo.governor.counted = demo.deadline.counted = true;
  return seconds;
}

Tape::End Tape::end(const Demo& demo) {
  End end;
  const std::string state = stateHash(demo), count = countOf(turns_, "frame");
  if (record_) {
    write(endsLine(columnEnds(demo)) + "\n");
    written_.add(state);
    record_->write(json{{"frames", turns_}, {"state", state}, {"checksum", written_.digits()}}.dump() + "\n");
    record_->commit();
    end.message = "recorded " + count + " in " + record_file_ + ", state " + state + "\n";
  }
  if (!replay_) return end;
  if (turns_ < static_cast<int>(replay_->frames.size())) {
    end.message += "replayed " + count + " of " + std::to_string(replay_->frames.size()) + "\n";
  } else if (replay_->state.empty()) {
    end.message +=
        "replayed " + count + " of a recording that was cut off, so that none knows its end; state " + state + "\n";
  } else {
    End reached{"the state is the recorded one to the bit: " + state};
    if (state == replay_->state && replay_->edited.value_or(false)) {
      reached = {reached.message + "; but its text was changed after it was recorded", true};
    } else if (state != replay_->state) {
      reached = otherEnd(*replay_, demo);
      reached.message = "but the state is " + state + ", not " + replay_->state + "; " + reached.message;
    }
    end.differs = reached.differs;
    end.message += "replayed " + count + ", " + reached.message + "\n";
  }
  return end;
}

}  // namespace app

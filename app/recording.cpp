#include "app/recording.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "app/errors.h"
#include "app/json_reader.h"
#include "app/motion.h"
#include "sim/field_text.h"

namespace app {

namespace {

using nlohmann::json;

constexpr int kVersion = 1;
constexpr std::size_t kMostRequests = 1000;                   // a frame
constexpr double kLongestFrame = 1e6, kLargestValue = 1e300;  // s; of a request's value

struct AskName {
  Ask what;
  std::string_view name;
};
// What can be recorded: all but the requests that write files.
constexpr std::array<AskName, 24> kAskNames{{{Ask::kSetParam, "set"},
                                             {Ask::kPause, "pause"},
                                             {Ask::kPauseMotion, "pause-motion"},
                                             {Ask::kSingleStep, "single-step"},
                                             {Ask::kReset, "reset"},
                                             {Ask::kRestart, "restart"},
                                             {Ask::kCollapse, "collapse"},
                                             {Ask::kCarryAlong, "carry-along"},
                                             {Ask::kSpeed, "speed"},
                                             {Ask::kLoop, "loop"},
                                             {Ask::kBlend, "blend"},
                                             {Ask::kInPlace, "in-place"},
                                             {Ask::kClip, "clip"},
                                             {Ask::kStyle, "style"},
                                             {Ask::kResolution, "resolution"},
                                             {Ask::kMotionFile, "motion-file"},
                                             {Ask::kHairFile, "hair-file"},
                                             {Ask::kSceneFile, "scene-file"},
                                             {Ask::kPresetFile, "preset-file"},
                                             {Ask::kOpenFile, "open-file"},
                                             {Ask::kSelect, "select"},
                                             {Ask::kView, "view"},
                                             {Ask::kFollow, "follow"},
                                             {Ask::kDebugView, "debug-view"}}};

std::string_view nameOf(Ask what) {
  for (const AskName& row : kAskNames) {
    if (row.what == what) return row.name;
  }
  return {};
}

// The next line of `text`, taken off it.
std::string_view takeLine(std::string_view& text) {
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

RecordedFrame readFrame(const JsonPlace& place) {
  const std::size_t entries = place.arraySize(kMostRequests + 1);
  if (entries == 0) place.refuse("is no frame", "write [seconds, requests ...]");
  RecordedFrame frame;
  frame.seconds = place.at(std::size_t{0}).number(0, kLongestFrame);
  for (std::size_t k = 1; k < entries; ++k) frame.requests.push_back(readRequest(place.at(k)));
  return frame;
}

std::string frameLine(double seconds, const std::vector<Request>& requests) {
  json line = json::array({seconds});
  for (const Request& request : requests) {
    const std::string_view name = nameOf(request.what);
    if (!name.empty()) line.push_back({name, request.name, request.text, request.value});
  }
  return line.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

Recording readRecording(std::string_view text, const std::string& file) {
  int line_number = 0;
  const auto next = [&] {
    ++line_number;
    if (text.empty()) throw InputError(file, "line " + std::to_string(line_number), "is missing", "record anew");
    return takeLine(text);
  };
  const auto named = [&] { return file + ", line " + std::to_string(line_number); };
  {
    const std::string_view line = next();
    const json head = parseJson(line, named());
    const JsonPlace place(head, named());
    place.expectObject({"hairmesh-recording"});
    if (!place.has("hairmesh-recording")) place.refuse("is no recording", "give a file that --record wrote");
    place.at("hairmesh-recording").number(kVersion, kVersion);
  }
  Recording recording;
  const std::string_view scene = next();
  recording.scene = readScene(scene, file);
  while (!text.empty()) {
    const std::string_view line = next();
    const json value = parseJson(line, named());
    const JsonPlace place(value, named());
    if (value.is_array()) {
      recording.frames.push_back(readFrame(place));
      continue;
    }
    place.expectObject({"frames", "state"});
    if (!place.has("frames") || !place.has("state")) place.refuse("ends nothing", "record anew");
    const double frames = place.at("frames").number(0, 1e12);
    if (frames != static_cast<double>(recording.frames.size()))
      place.refuse(
          "counts " + sim::numberText(frames) + " frames where " + std::to_string(recording.frames.size()) + " are",
          "record anew");
    recording.state = place.at("state").text();
    if (!text.empty()) place.refuse("is followed by more", "end the file here");
  }
  return recording;
}

std::string stateHash(const Demo& demo) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  const auto add = [&](const std::vector<sim::Vec3>& values) {
    for (const sim::Vec3& value : values) {
      for (int axis = 0; axis < 3; ++axis) {
        const auto bits = std::bit_cast<std::uint64_t>(value[axis]);
        for (int byte = 0; byte < 64; byte += 8) hash = (hash ^ (bits >> byte & 0xff)) * 0x100000001b3ull;
      }
    }
  };
  for (const Actor& actor : demo.actors) {
    add(actor.hair.positions);
    add(actor.hair.velocities);
  }
  constexpr const char* kDigits = "0123456789abcdef";
  std::string text;
  for (int shift = 60; shift >= 0; shift -= 4) text += kDigits[hash >> shift & 0xf];
  return text;
}

Tape::Tape(const Options& options, Scene& scene) : record_file_(options.record), replay_file_(options.replay) {
  if (!replay_file_.empty()) {
    replay_ = readRecording(readText(replay_file_), replay_file_);
    scene = replay_->scene;
  }
  if (record_file_.empty()) return;
  record_.open(record_file_, std::ios::binary);
  record_ << json{{"hairmesh-recording", kVersion}}.dump() << "\n" << json::parse(writeScene(scene)).dump() << "\n";
}

std::optional<int> Tape::frames() const {
  return replay_ ? std::optional<int>(static_cast<int>(replay_->frames.size())) : std::nullopt;
}

double Tape::turn(int frame, double seconds, Demo& demo) {
  if (replay_) {
    const RecordedFrame& recorded = replay_->frames[static_cast<std::size_t>(frame)];
    demo.requests = recorded.requests;
    seconds = recorded.seconds;
  }
  if (!record_file_.empty()) {
    record_ << frameLine(seconds, demo.requests) << "\n";
    ++recorded_;
  }
  return seconds;
}

Tape::End Tape::end(const Demo& demo) {
  End end;
  const std::string state = stateHash(demo);
  if (!record_file_.empty()) {
    record_ << json{{"frames", recorded_}, {"state", state}}.dump() << "\n";
    record_.close();
    if (!record_) {
      throw InputError(record_file_, "", "cannot be written", "choose a folder that exists and may be written to");
    }
    end.said = "recorded " + std::to_string(recorded_) + " frames in " + record_file_ + ", state " + state + "\n";
  }
  if (replay_ && replay_->state.empty()) end.said += "replayed a recording without an end, state " + state + "\n";
  if (replay_ && !replay_->state.empty()) {
    end.differs = state != replay_->state;
    end.said += "replayed " + std::to_string(replay_->frames.size()) + " frames, " +
                (end.differs ? "but the state is " + state + ", not " + replay_->state
                             : "the state is the recorded one to the bit: " + state) +
                "\n";
  }
  return end;
}

}  // namespace app

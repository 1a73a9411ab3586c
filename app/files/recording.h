// The inputs of a run, written down and played again: the scene, the length of every frame, from where it was seen and
// what was asked for in it. A state is a function of these alone, so a replay ends in the recorded state to the bit,
// whatever the size of its own pictures: level of detail goes by the recorded view.
//
// A recording is text, one JSON value a line:
//   {"hairmesh-recording": 3, "aspect": A, "skips_off": [name, ...]}
//   the scene, as writeScene writes it
//   [seconds, view, [what, name, text, value], ...]    one line a frame, with its requests; the view where it changed
//   {"ends": [[x, y, z, x, y, z, ...], ...]}            where each character's columns end, hundredths of a millimetre
//   {"frames": N, "state": "0123456789abcdef", "checksum": "0123456789abcdef"}
// The state is the FNV-1a of all positions and velocities at the end, the checksum that of all text before this line
// and the state's digits: it tells a recording that a person has changed. It may be missing. A view is {"target": [x,
// y, z], "yaw", "pitch", "distance", "aspect", "height", "shift", "rise", "zoom"}; of the last three, those that change
// nothing are left out. Version 1 had neither views nor what stands beside it; it is replayed as seen by the replay
// itself. Version 2 had no ends.
//
// Another build or kind of processor rounds otherwise, so its bits differ. A replay passes where columns end within
// kMaxApart in the mean of where they were recorded to end, and its text is as it was recorded.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/files/output_file.h"
#include "app/options.h"
#include "app/scene/demo.h"

namespace app {

// What level of detail goes by and a person turns without a request: the camera relative to its anchor, which follows
// from the state, and the picture.
struct RecordedView {
  Vec3 target = Vec3::Zero();  // m
  double yaw = 0, pitch = 0;   // rad
  double distance = 1;         // m
  double aspect = 1;
  int height = 720;  // pixels
  ViewPlace place;
  bool operator==(const RecordedView&) const = default;
};

struct RecordedFrame {
  double seconds = 0;
  std::optional<RecordedView> view;  // nothing: that of the frame before
  std::vector<Request> requests;
};

inline constexpr double kMaxApart = 5e-3;  // m in the mean: rounding alone moves a single lock by up to 42 mm

// Where a character's columns end, m.
using ColumnEnds = std::vector<Vec3>;

struct Recording {
  Scene scene;
  std::optional<double> aspect;  // of the picture that the scene was opened for
  std::vector<RecordedFrame> frames;
  std::string state;             // hash at the end; empty when the recording was cut off
  std::optional<bool> edited;    // since it was recorded; nothing: it has no checksum
  std::vector<ColumnEnds> ends;  // at the end, one a character; empty: it holds none
};

// FNV-1a, 64 bits.
class Fnv {
 public:
  void add(std::uint64_t byte) { hash_ = (hash_ ^ byte) * 0x100000001b3ull; }
  void add(std::string_view text);
  std::string digits() const;  // 16 hexadecimal ones

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325ull;
};

// Throws InputError naming the line. Requests that write files are refused, so that a recording cannot. Memory used is
// bounded by a small multiple of the text's length.
Recording readRecording(std::string_view text, const std::string& file);

// FNV-1a over the bits of every position and velocity, as 16 hexadecimal digits.
std::string stateHash(const Demo& demo);

// Where the hair of a demo ends now.
std::vector<ColumnEnds> columnEnds(const Demo& demo);

// How far the ends of two runs lie apart; nothing where there are none or not as many.
struct Apart {
  double most = 0, mean = 0;  // m
};
std::optional<Apart> apartOf(const std::vector<ColumnEnds>& a, const std::vector<ColumnEnds>& b);

// What a run does with --record and --replay: nothing, or either, or both.
class Tape {
 public:
  // Opens what the options name and puts the recorded scene in place of `scene`. Throws InputError and OutputError.
  Tape(const Options& options, Scene& scene);

  // Frames of the replay; nothing when none is played.
  std::optional<int> frames() const;
  // Of the picture to open the scene for: the recorded one, or that of the options.
  double aspect() const { return aspect_; }
  // What to say of pictures of a replay that are of another size (pixels) than its own; empty where there is nothing.
  std::string sizeNote(int width, int height) const;
  // Before frame `frame` of `seconds`: puts the recorded view and requests in place and returns the recorded length
  // when a replay is played; writes them down when one is made. Either way a budget goes by counted work.
  double turn(int frame, double seconds, Demo& demo);
  // After the last frame: closes the recording, compares the replay's end with the recorded one if it was reached.
  // Throws OutputError when the recording could not be written.
  struct End {
    std::string message;  // for the terminal; empty without a recording and a replay
    bool differs = false;
  };
  End end(const Demo& demo);

 private:
  void write(const std::string& text);

  std::string record_file_, replay_file_;
  std::optional<OutputFile> record_;  // appears under its name once the run has ended
  Fnv written_;
  int turns_ = 0;
  double aspect_ = 1;
  std::optional<Recording> replay_;
  std::optional<RecordedView> replay_view_, record_view_;  // last read, last written
};

}  // namespace app

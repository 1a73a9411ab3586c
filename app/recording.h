// The inputs of a run, written down and played again: the scene, the length of every frame and what was asked for in
// it. A state is a function of these alone, so a replay ends in the recorded state to the bit.
//
// A recording is text, one JSON value a line:
//   {"hairmesh-recording": 1}
//   the scene, as writeScene writes it
//   [seconds, [what, name, text, value], ...]     one line a frame, with its requests
//   {"frames": N, "state": "0123456789abcdef"}    FNV-1a of all positions and velocities at the end
#pragma once

#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/demo.h"
#include "app/options.h"

namespace app {

struct RecordedFrame {
  double seconds = 0;
  std::vector<Request> requests;
};

struct Recording {
  Scene scene;
  std::vector<RecordedFrame> frames;
  std::string state;  // hash at the end; empty when the recording was cut off
};

// Throws InputError naming the line. Requests that write files are refused, so that a recording cannot. Memory used is
// bounded by a small multiple of the text's length.
Recording readRecording(std::string_view text, const std::string& file);

// FNV-1a over the bits of every position and velocity, as 16 hexadecimal digits.
std::string stateHash(const Demo& demo);

// What a run does with --record and --replay: nothing, or either, or both.
class Tape {
 public:
  // Opens what the options name and puts the recorded scene in place of `scene`. Throws InputError.
  Tape(const Options& options, Scene& scene);

  // Frames of the replay; nothing when none is played.
  std::optional<int> frames() const;
  // Before frame `frame` of `seconds`: puts the recorded requests in place and returns the recorded length when a
  // replay is played; writes both down when one is made.
  double turn(int frame, double seconds, Demo& demo);
  // After the last frame: closes the recording, compares the replay's end. Returns what is to be said about it and
  // whether a replay ended elsewhere. Throws InputError when the recording could not be written.
  struct End {
    std::string said;
    bool differs = false;
  };
  End end(const Demo& demo);

 private:
  std::string record_file_, replay_file_;
  std::ofstream record_;
  int recorded_ = 0;
  std::optional<Recording> replay_;
};

}  // namespace app

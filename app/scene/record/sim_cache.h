// Simulated hair kept in a file, frame by frame, so that a timeline shows any of it at once: `.hairmesh`.
//
// Every frame has what the picture showed: positions of the hair in steps of 0.05 mm and the pose. Every 30th, the
// first and the last also have the whole state (demo_state.h), from which a run goes on to the bit on the same build
// and processor.
//
// Layout, little endian: "hairmesh-cache 1\n"; u64 place of the index, u64 frames (both 0: never finished), u64 size
// and the text of what moves; records; the index: per frame i64 its number, u64 its place, u32 its bytes, u32 1 for a
// state; u64 fingerprint (FNV-1a) of the index. A record: f64 time (s), u64 fingerprint of what follows, per character
// its joints as quaternion (x, y, z, w) and place in seven f32, then varints of differences between neighbouring
// vertices in steps (zigzag: 2n for n >= 0, -2n - 1 else), x, y, z in turn; then the state's bytes.
#pragma once

#include <cstdint>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/files/output_file.h"

namespace app {

struct Demo;

inline constexpr unsigned kCacheVersion = 1;
inline constexpr double kCacheStep = 5e-5;  // m
inline constexpr int kCacheKeyEvery = 30;   // frames

struct CacheFrame {
  std::int64_t frame = 0;
  std::uint64_t at = 0;  // place in the file
  std::uint32_t bytes = 0;
  std::uint32_t key = 0;  // 1: with the state
};

// Whole or not at all: what is not finished leaves no file behind. Each throws OutputError.
class SimCacheWriter {
 public:
  SimCacheWriter(const std::string& file, const Demo& demo);
  // After a frame, in the order of their numbers; takes memory for one.
  void add(const Demo& demo);
  // Returns what was written, in words. `demo`: as it was when the last frame was added.
  std::string finish(const Demo& demo);
  const std::string& file() const { return name_; }

 private:
  void addRecord(const Demo& demo, bool key);
  void put(std::string_view bytes);

  std::string name_;
  OutputFile out_;
  std::uint64_t written_ = 0;
  std::vector<CacheFrame> index_;
};

// A finished cache, read frame by frame. Throws InputError for another scene, another version, or a file that was
// changed or cut off.
class SimCache {
 public:
  SimCache(const std::string& file, const Demo& demo);

  long first() const { return static_cast<long>(index_.front().frame); }
  long last() const { return static_cast<long>(index_.back().frame); }
  bool holds(long frame) const { return frame >= first() && frame <= last(); }
  const std::string& file() const { return file_; }

  // The demo shows the last cached frame that is not after `frame`, without simulating. Its state is that of the key
  // frame before; see resume.
  void show(long frame, Demo& demo);
  // The last key frame that is not after `frame`, whole: what follows ends in the same bits as it did.
  // `keep_view`: the camera's direction and distance stay.
  void resume(long frame, bool keep_view, Demo& demo);

 private:
  const CacheFrame& entryOf(long frame, bool key) const;
  std::string record(const CacheFrame& entry);

  std::string file_;
  std::ifstream stream_;
  std::vector<CacheFrame> index_;
};

// Whether a file begins as a cache does.
bool isSimCache(const std::string& file);

}  // namespace app

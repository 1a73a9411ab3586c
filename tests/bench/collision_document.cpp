#include "tests/bench/collision_document.h"

#include <cstdio>
#include <cstdlib>

#include "tests/bench/colliders.h"
#include "tests/bench/collision_scenes.h"
#include "tests/bench/collisions.h"
#include "tests/bench/cpu_clock.h"
#include "tests/bench/measured_part.h"
#include "tests/bench/table.h"

namespace bench {
namespace {

// What `write` writes to a stream.
template <class Write>
std::string written(const Write& write) {
  char* text = nullptr;
  std::size_t size = 0;
  std::FILE* stream = open_memstream(&text, &size);
  write(stream);
  std::fclose(stream);
  std::string result(text, size);
  std::free(text);
  return result;
}

}  // namespace

void writeCollisionDocument(const std::string& folder, int frames) {
  const auto put = [&](const std::string& name, const Table& shown) {
    writeMeasuredPart(folder + "/collision.md", name, shown.markdown());
  };
  // Keeps the whole table and returns it.
  const auto measure = [&](const std::string& name, const auto& write) {
    const double started = cpuSeconds();
    const std::string text = written(write);
    writeTable(folder, "collision_" + name, tableOf(text));
    std::printf("%s: %.0f s\n", name.c_str(), cpuSeconds() - started);
    std::fflush(stdout);
    return tableOf(text);
  };
  CollisionOptions clips;
  clips.frames = frames;
  const Table clip = measure("clips", [&](std::FILE* out) { writeClips(clips, out); });
  const Table rest = measure("rest", [&](std::FILE* out) { writeRests(clips, out); });
  put("clips", joined(folded(clip, {"style"},
                             {{"contacts", Fold::kLargest},
                              {"corrected", Fold::kLargest},
                              {"outside vertices, mm inside", Fold::kLargest},
                              {"recoveries", Fold::kSum}}),
                      columns(rest, {"style", "rest speed, RMS mm/s", "largest mm/s"}), "style"));
  const Table spawn = measure("spawn", [](std::FILE* out) { writeSpawns(out); });
  put("spawn", columns(rowsWith(spawn, "style", "long medium"),
                       {"speed allowed, m/s", "deepest at first, mm", "out after, s", "fastest vertex, m/s", "when out",
                        "most afterwards", "two seconds later"}));
  put("crossing", folded(measure("crossing", [](std::FILE* out) { writeCrossings(out); }), {"speed, m/s"},
                         {{"vertices met", Fold::kSum},
                          {"slid over the rim", Fold::kSum},
                          {"passed through", Fold::kSum},
                          {"inside afterwards, mm", Fold::kLargest}}));
  put("self", columns(measure("self", [&](std::FILE* out) { writeSelfContacts(frames, out); }),
                      {"style", "clip", "ms a step, off", "ms a step, on", "on, against off"}));
  ColliderOptions kinds;
  kinds.frames = frames;
  put("colliders", columns(measure("colliders", [&](std::FILE* out) { runColliders(kinds, out); }),
                           {"style", "clip", "collider", "ms a step", "of it contacts", "deepest under the skin, mm",
                            "contacts' gap to the skin, median mm"}));
}

}  // namespace bench

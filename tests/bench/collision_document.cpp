#include "tests/bench/collision_document.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "app/errors.h"
#include "tests/bench/colliders.h"
#include "tests/bench/collision_scenes.h"
#include "tests/bench/collisions.h"
#include "tests/bench/cpu_clock.h"

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

void replacePart(const std::string& file, const std::string& name, const std::string& part) {
  std::ifstream stream(file);
  std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  stream.close();
  const std::string opening = "<!-- measured: " + name + " -->", closing = "<!-- end of " + name + " -->";
  const auto start = text.find(opening), end = text.find(closing);
  if (start == std::string::npos || end == std::string::npos || end < start) {
    throw app::InputError(file, "", "lacks the marks of its part '" + name + "'", "restore it from the repository");
  }
  std::ofstream(file) << text.substr(0, start) << opening << "\n\n" << part << "\n" << text.substr(end);
}

}  // namespace

void writeCollisionDocument(const std::string& folder, int frames) {
  const std::string file = folder + "/collision.md";
  const auto measure = [&](const std::string& name, const auto& write) {
    const double started = cpuSeconds();
    replacePart(file, name, written(write));
    std::printf("%s: %.0f s\n", name.c_str(), cpuSeconds() - started);
    std::fflush(stdout);
  };
  measure("spawn", [](std::FILE* out) { writeSpawns(out); });
  measure("crossing", [](std::FILE* out) { writeCrossings(out); });
  measure("self", [&](std::FILE* out) { writeSelfContacts(frames, out); });
  CollisionOptions clips;
  clips.frames = frames;
  measure("clips", [&](std::FILE* out) { runCollisions(clips, out); });
  ColliderOptions kinds;
  kinds.frames = frames;
  measure("colliders", [&](std::FILE* out) { runColliders(kinds, out); });
}

}  // namespace bench

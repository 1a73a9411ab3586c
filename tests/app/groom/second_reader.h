// What the readers in plain Python (tests/groom) find in a file, beside what was written into it.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "app/groom/groom.h"
#include "tests/run_program.h"

namespace test {

template <class Element>
void dumpArray(const std::vector<Element>& all, std::string& bytes) {
  const std::uint64_t size = all.size() * sizeof(Element);
  bytes.append(reinterpret_cast<const char*>(&size), sizeof size);
  bytes.append(reinterpret_cast<const char*>(all.data()), size);
}

// Every array: its length in bytes and its bytes. tests/groom/dump.py writes the same.
inline void dumpGroom(const app::Groom& groom, std::string& bytes) {
  dumpArray(groom.strand_first, bytes);
  dumpArray(groom.points, bytes);
  dumpArray(groom.widths, bytes);
  dumpArray(groom.colors, bytes);
  dumpArray(groom.root_uvs, bytes);
  dumpArray(groom.ids, bytes);
  dumpArray(groom.groups, bytes);
  dumpArray(groom.guides, bytes);
}

// The times of the moments (empty for a format of one frame) and each moment's groom.
inline std::string dumpClip(const std::vector<double>& times, const std::vector<app::Groom>& moments) {
  std::string bytes;
  dumpArray(times, bytes);
  for (const app::Groom& groom : moments) dumpGroom(groom, bytes);
  return bytes;
}

// The same by the reader in Python; a message where that fails.
inline std::string secondReading(const std::string& file) {
  const std::string dump = file + ".dump", fault = file + ".fault";
  const std::string command = "python3 " + shellQuoted(std::string(HAIRMESH_SOURCE_DIR) + "/tests/groom/read.py") +
                              " " + shellQuoted(file) + " " + shellQuoted(dump) + " 2>" + shellQuoted(fault);
  return std::system(command.c_str()) == 0 ? readAll(dump) : "the second reader failed: " + readAll(fault);
}

}  // namespace test

// The container of Alembic files: groups of data blocks and groups, by 64-bit offsets from the file's start.
//
// 16 bytes of header: "Ogawa", 0xff once the file is finished (0 before), version 0 and 1, offset of the root group. A
// group is its number of children and their offsets; a data block is its length and its bytes. The top bit of an offset
// tells data from groups; offset 0 is an empty group, the top bit alone empty data. Little-endian. Source: Alembic's
// own writer, lib/Alembic/Ogawa (OStream, OGroup) of the repository alembic/alembic.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "app/files/output_file.h"

namespace app {

inline constexpr std::uint64_t kOgawaData = std::uint64_t{1} << 63;  // empty data, and the bit that marks data

// Writes blocks one after another; what refers to others is written after them. Nothing is kept but the position.
class OgawaWriter {
 public:
  // Writes the header of an unfinished file. `output` needs to live as long.
  explicit OgawaWriter(OutputFile& output);

  // Each returns the offset to be listed by a group. Throws OutputError.
  std::uint64_t data(std::initializer_list<std::string_view> pieces);
  std::uint64_t group(const std::vector<std::uint64_t>& children);
  // Names the root and marks the file as finished. The caller commits the output.
  void finish(std::uint64_t root);

 private:
  void append(std::string_view bytes);

  OutputFile& output_;
  std::uint64_t end_ = 0;
};

// Reads from bytes that need to live as long. Each throws InputError naming the offset. All visits together are bounded
// by the file's size, so groups that lead in a circle end.
class OgawaReader {
 public:
  OgawaReader(std::string_view bytes, const std::string& file);

  std::uint64_t root() const { return root_; }
  std::vector<std::uint64_t> children(std::uint64_t group);
  std::string_view data(std::uint64_t block) const;
  static bool isData(std::uint64_t child) { return (child & kOgawaData) != 0; }
  const std::string& file() const { return file_; }
  [[noreturn]] void fail(std::uint64_t offset, const std::string& fault) const;

 private:
  std::uint64_t number(std::uint64_t offset, const char* what) const;

  std::string_view bytes_;
  std::string file_;
  std::uint64_t root_ = 0;
  std::uint64_t visits_ = 0;  // children listed so far
};

}  // namespace app

// PLY files element by element: the header, and the numbers of each row whatever their type and order. The format is
// described in ply_file.h.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace app {

struct PlyProperty {
  std::string name;
  int type = 0;         // of its values, see plyTypeBytes
  int count_type = -1;  // of a list's length; -1: no list
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;  // rows
  std::vector<PlyProperty> properties;
};

enum class PlyOrder { kText, kLittle, kBig };

// A cursor over the rows: every number is read from bytes that are there.
class PlyRows {
 public:
  // Reads the header. Throws InputError naming the line.
  PlyRows(std::string_view bytes, const std::string& file);

  const std::vector<PlyElement>& elements() const { return elements_; }
  const std::string& file() const { return file_; }
  // The next number of the rows, of a type. Throws InputError.
  double number(int type);
  // The next number as the length of a list or an index. Throws InputError when it is not a whole number of at least 0.
  std::size_t whole(int type);
  [[noreturn]] void fail(const std::string& fault, const std::string& mend) const;

  static bool isByte(int type) { return type <= 1; }

 private:
  std::string_view line();
  void readHeader();

  std::string_view bytes_;
  std::string file_;
  std::size_t at_ = 0;
  int line_ = 1;  // of at_, in the header and in text
  bool header_ = true;
  PlyOrder order_ = PlyOrder::kText;
  std::vector<PlyElement> elements_;
};

}  // namespace app

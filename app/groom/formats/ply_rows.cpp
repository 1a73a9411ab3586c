#include "app/groom/formats/ply_rows.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>

#include "app/files/errors.h"
#include "app/files/text_scanner.h"

namespace app {

namespace {

constexpr std::array<std::pair<std::string_view, int>, 16> kTypes{{{"char", 0},
                                                                   {"int8", 0},
                                                                   {"uchar", 1},
                                                                   {"uint8", 1},
                                                                   {"short", 2},
                                                                   {"int16", 2},
                                                                   {"ushort", 3},
                                                                   {"uint16", 3},
                                                                   {"int", 4},
                                                                   {"int32", 4},
                                                                   {"uint", 5},
                                                                   {"uint32", 5},
                                                                   {"float", 6},
                                                                   {"float32", 6},
                                                                   {"double", 7},
                                                                   {"float64", 7}}};
constexpr std::array<std::size_t, 8> kBytes{1, 1, 2, 2, 4, 4, 4, 8};

int typeOf(std::string_view name) {
  const auto found = std::ranges::find(kTypes, name, &std::pair<std::string_view, int>::first);
  return found == kTypes.end() ? -1 : found->second;
}

std::vector<std::string_view> wordsOf(std::string_view line) {
  std::vector<std::string_view> words;
  TextScanner scanner{line, ""};
  for (std::string_view word = scanner.word(); !word.empty(); word = scanner.word()) words.push_back(word);
  return words;
}

template <class Number>
double numberOf(const std::array<char, 8>& bytes) {
  Number value;
  std::memcpy(&value, bytes.data(), sizeof value);
  return static_cast<double>(value);
}

double binaryNumber(const std::array<char, 8>& bytes, int type) {
  switch (type) {
    case 0:
      return numberOf<std::int8_t>(bytes);
    case 1:
      return numberOf<std::uint8_t>(bytes);
    case 2:
      return numberOf<std::int16_t>(bytes);
    case 3:
      return numberOf<std::uint16_t>(bytes);
    case 4:
      return numberOf<std::int32_t>(bytes);
    case 5:
      return numberOf<std::uint32_t>(bytes);
    case 6:
      return numberOf<float>(bytes);
    default:
      return numberOf<double>(bytes);
  }
}

// A property line, or nothing.
std::optional<PlyProperty> propertyOf(const std::vector<std::string_view>& words) {
  PlyProperty property;
  if (words.size() == 3) {
    property = {std::string(words[2]), typeOf(words[1]), -1};
  } else if (words.size() == 5 && words[1] == "list") {
    property = {std::string(words[4]), typeOf(words[3]), typeOf(words[2])};
    if (property.count_type < 0) return std::nullopt;
  } else {
    return std::nullopt;
  }
  return property.type < 0 ? std::nullopt : std::optional(property);
}

}  // namespace

PlyRows::PlyRows(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {
  readHeader();
  header_ = false;
}

std::string_view PlyRows::line() {
  const std::size_t end = bytes_.find('\n', at_);
  if (end == std::string_view::npos) fail("the header has no end_header", "the file is cut off; export it again");
  std::string_view text = bytes_.substr(at_, end - at_);
  at_ = end + 1;
  ++line_;
  if (text.ends_with('\r')) text.remove_suffix(1);
  return text;
}

void PlyRows::readHeader() {
  if (line() != "ply") fail("the file does not begin with 'ply'", "give a PLY file");
  bool told = false;
  while (true) {
    const std::vector<std::string_view> words = wordsOf(line());
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") break;
    if (words[0] == "format" && words.size() == 3) {
      told = true;
      order_ = words[1] == "binary_little_endian" ? PlyOrder::kLittle
               : words[1] == "binary_big_endian"  ? PlyOrder::kBig
                                                  : PlyOrder::kText;
      if (order_ != PlyOrder::kText || words[1] == "ascii") continue;
    }
    if (words[0] == "element" && words.size() == 3) {
      std::size_t count = 0;
      const auto [end, error] = std::from_chars(words[2].data(), words[2].data() + words[2].size(), count);
      if (error == std::errc() && end == words[2].data() + words[2].size()) {
        elements_.push_back({std::string(words[1]), count, {}});
        continue;
      }
    }
    if (const std::optional<PlyProperty> property =
            words[0] == "property" && !elements_.empty() ? propertyOf(words) : std::nullopt) {
      elements_.back().properties.push_back(*property);
      continue;
    }
    --line_;
    fail(app::quoted(words[0]) + " begins no line that a PLY header may have here", "export the file again");
  }
  if (!told) fail("the header names no format", "write 'format ascii 1.0' or a binary one");
  for (const PlyElement& element : elements_) {
    if (element.count > 0 && element.properties.empty())
      fail("element " + app::quoted(element.name) + " has rows without properties", "export the file again");
  }
}

double PlyRows::number(int type) {
  if (order_ == PlyOrder::kText) {
    TextScanner scanner{bytes_, file_, at_, line_};
    std::string_view word = scanner.word();
    at_ = scanner.at;
    line_ = scanner.line;
    if (word.starts_with('+')) word.remove_prefix(1);
    if (type == 6) {
      float value = 0;  // the nearest float, not the nearest double rounded once more
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (!word.empty() && end == word.data() + word.size() && error == std::errc()) return value;
    }
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || end != word.data() + word.size() || error == std::errc::invalid_argument)
      fail(word.empty() ? "the rows end early" : app::quoted(word) + " is not a number", "export the file again");
    return value;
  }
  const std::size_t size = kBytes[static_cast<std::size_t>(type)];
  if (bytes_.size() - at_ < size) fail("the rows end early", "the file is cut off; export it again");
  std::array<char, 8> bytes{};
  std::memcpy(bytes.data(), bytes_.data() + at_, size);
  if (order_ == PlyOrder::kBig) std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
  at_ += size;
  return binaryNumber(bytes, type);
}

std::size_t PlyRows::whole(int type) {
  const double value = number(type);
  if (!(value >= 0) || value != std::floor(value) || value > 4294967295.0)
    fail("an index or a number of points is not a whole number of at least 0", "export the file again");
  return static_cast<std::size_t>(value);
}

void PlyRows::fail(const std::string& fault, const std::string& mend) const {
  const bool lines = header_ || order_ == PlyOrder::kText;
  throw InputError(file_, lines ? "line " + std::to_string(line_) : "byte " + std::to_string(at_), fault, mend);
}

}  // namespace app

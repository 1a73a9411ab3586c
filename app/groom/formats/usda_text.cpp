#include "app/groom/formats/usda_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "app/files/errors.h"
#include "app/files/text_file.h"
#include "app/files/text_scanner.h"

namespace app {

namespace {

constexpr int kDeepestPrim = 64;  // prims below one another

bool isUsdaBlank(char c) {
  return static_cast<unsigned char>(c) <= ' ';
}
bool isWord(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == ':' || c == '.' || c == '+' || c == '-' ||
         c == '!' || static_cast<unsigned char>(c) > 127;
}

// A cursor over the text; a token is a word, a quoted text, an asset or one mark.
class Scanner {
 public:
  Scanner(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  std::size_t at() const { return at_; }
  void rewind(std::size_t at) { at_ = at; }
  bool done() {
    skipBlanks();
    return at_ == text_.size();
  }
  char peek() { return done() ? '\0' : text_[at_]; }
  bool take(char mark) {
    const bool found = peek() == mark;
    at_ += found;
    return found;
  }
  void expect(char mark) {
    if (!take(mark)) fail(std::string("'") + mark + "' should stand here");
  }
  // Empty where something else stands.
  std::string_view word() {
    skipBlanks();
    const std::size_t begin = at_;
    while (at_ < text_.size() && isWord(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }
  // The content of a quoted text, of one line or, with three quotes, of several.
  std::string_view quotedText();
  // Passes over a value and returns its text.
  std::string_view value();
  [[noreturn]] void fail(const std::string& fault) const {
    throw InputError(file_, usdaLine(text_, at_), fault, "export the layer again, as text");
  }

 private:
  void skipBlanks();
  void skipBrackets();

  std::string_view text_;
  std::string file_;
  std::size_t at_ = 0;
};

void Scanner::skipBlanks() {
  while (at_ < text_.size()) {
    if (isUsdaBlank(text_[at_]) || text_[at_] == ';') {
      ++at_;
    } else if (text_[at_] == '#') {
      at_ = std::min(text_.find('\n', at_), text_.size());
    } else {
      return;
    }
  }
}

std::string_view Scanner::quotedText() {
  const char quote = peek();
  if (quote != '"' && quote != '\'') fail("a name in quotes should stand here");
  const std::string three(3, quote);
  const bool is_long = text_.substr(at_, 3) == three;
  const std::size_t begin = at_ + (is_long ? 3 : 1);
  for (std::size_t n = begin; n < text_.size(); ++n) {
    if (text_[n] == '\\') {
      ++n;
    } else if (text_[n] == quote && (!is_long || text_.substr(n, 3) == three)) {
      at_ = n + (is_long ? 3 : 1);
      return text_.substr(begin, n - begin);
    }
  }
  fail("a text in quotes has no end");
}

// Brackets of any kind, one in another, with texts and assets between them.
void Scanner::skipBrackets() {
  std::size_t depth = 0;
  do {
    const char c = peek();
    if (c == '\0') fail("a bracket is not closed");
    if (c == '"' || c == '\'') {
      quotedText();
      continue;
    }
    if (c == '@') {
      const std::size_t end = text_.find('@', at_ + 1);
      if (end == std::string_view::npos) fail("an asset has no end");
      at_ = end;
    }
    depth += c == '(' || c == '[' || c == '{' || c == '<';
    if (c == ')' || c == ']' || c == '}' || c == '>') --depth;
    ++at_;
  } while (depth > 0);
}

std::string_view Scanner::value() {
  const char c = peek();
  const std::size_t begin = at_;
  if (c == '(' || c == '[' || c == '{' || c == '<' || c == '@') {
    skipBrackets();
  } else if (c == '"' || c == '\'') {
    quotedText();
  } else if (word().empty()) {
    fail("a value should stand here");
  }
  return text_.substr(begin, at_ - begin);
}

// The attributes that are kept.
bool isWanted(std::string_view name) {
  constexpr std::array<std::string_view, 8> kNames{"points", "curveVertexCounts", "widths", "type", "basis",
                                                   "wrap",   "visibility",        "purpose"};
  return std::ranges::find(kNames, name) != kNames.end() || name.starts_with("primvars:") ||
         name.starts_with("xformOp");
}

struct TextReader {
  std::string_view text;
  const std::string& file;
  Scanner scanner;
  UsdaLayer layer;

  void stageMetadata();
  void prims();
  void prim(const UsdaPrim& above, int depth);
  void body(UsdaPrim& prim, const UsdaPrim& above, int depth);
  void hide(UsdaPrim& prim, const UsdaPrim& above) const;
  void variantSet();
  void attribute(std::string_view first, UsdaPrim& prim);
  std::vector<UsdaSample> samples();
  std::string interpolationOf(std::string_view metadata) const;
  double numberOf(std::string_view value) const;
  Eigen::Affine3d placeOf(const UsdaPrim& prim) const;
  Eigen::Affine3d operation(std::string_view name, const UsdaPrim& prim) const;
};

double TextReader::numberOf(std::string_view value) const {
  const std::vector<double> numbers = usdaNumbers<double>(value, text, file);
  return numbers.size() == 1 ? numbers[0] : 0;
}

void TextReader::stageMetadata() {
  if (!scanner.take('(')) return;
  while (!scanner.take(')')) {
    if (scanner.peek() == '"' || scanner.peek() == '\'') {  // a comment
      scanner.quotedText();
      continue;
    }
    std::string_view key = scanner.word();
    if (key.empty()) scanner.fail("metadata of the layer should stand here");
    if (key == "prepend" || key == "append" || key == "delete" || key == "add") key = scanner.word();
    scanner.expect('=');
    const std::string_view value = scanner.value();
    if (key == "metersPerUnit") layer.meters_per_unit = numberOf(value), layer.tells_unit = layer.meters_per_unit > 0;
    if (key == "timeCodesPerSecond") layer.time_codes_per_second = numberOf(value);
    if (key == "upAxis" && value.size() == 3)
      layer.up_axis = value[1], layer.tells_up = value[1] == 'Y' || value[1] == 'Z';
  }
}

void TextReader::prims() {
  const UsdaPrim stage;
  while (!scanner.done()) {
    const std::string_view specifier = scanner.word();
    if (specifier != "def" && specifier != "over" && specifier != "class") scanner.fail("a prim should begin here");
    prim(stage, 0);
  }
}

void TextReader::prim(const UsdaPrim& above, int depth) {
  if (depth > kDeepestPrim) scanner.fail("prims lie more than 64 deep");
  UsdaPrim prim;
  prim.at = scanner.at();
  prim.type = scanner.word();
  prim.name = scanner.quotedText();
  if (scanner.peek() == '(') scanner.value();
  scanner.expect('{');
  body(prim, above, depth);
}

// Prims below come after the attributes that place them, as every writer has it; a place told later would be lost.
void TextReader::body(UsdaPrim& prim, const UsdaPrim& above, int depth) {
  bool placed = false;
  const auto settle = [&] {
    if (!placed) {
      prim.place = above.place * placeOf(prim);
      hide(prim, above);
    }
    placed = true;
  };
  while (!scanner.take('}')) {
    const std::string_view word = scanner.word();
    if (word.empty()) scanner.fail("an attribute or a prim should stand here");
    if (word == "def" || word == "over" || word == "class") {
      settle();
      this->prim(prim, depth + 1);
    } else if (word == "variantSet") {
      variantSet();
    } else {
      attribute(word, prim);
    }
  }
  settle();
  if (prim.type != "BasisCurves") return;
  if (prim.invisible || prim.purpose == "guide" || prim.purpose == "proxy") {
    ++layer.hidden;
  } else {
    layer.curves.push_back(std::move(prim));
  }
}

// As UsdGeomImageable has it: what is invisible hides all below, a purpose counts until another is told.
void TextReader::hide(UsdaPrim& prim, const UsdaPrim& above) const {
  const auto word = [&prim](std::string_view name) {
    const auto found = prim.attributes.find(name);
    const std::string_view value = found == prim.attributes.end() ? std::string_view() : found->second.at(0);
    return value.size() > 2 ? value.substr(1, value.size() - 2) : std::string_view();
  };
  prim.invisible = above.invisible || word("visibility") == "invisible";
  const std::string_view purpose = word("purpose");
  prim.purpose = purpose.empty() ? above.purpose : purpose;
}

// Passed over: which variant is chosen is told elsewhere.
void TextReader::variantSet() {
  scanner.quotedText();
  scanner.expect('=');
  scanner.value();
}

void TextReader::attribute(std::string_view first, UsdaPrim& prim) {
  // [custom] [uniform] [prepend ...] type[] name, or rel name, or reorder names.
  std::string_view name = first;
  std::string_view before;
  while (scanner.peek() != '=' && scanner.peek() != '(') {
    if (scanner.take('[')) {
      scanner.expect(']');
      continue;
    }
    const std::size_t begin = scanner.at();
    const std::string_view word = scanner.word();
    if (word.empty()) break;
    // A word after the name begins the next statement: the attribute has no value.
    static constexpr std::array<std::string_view, 7> kBefore{"custom", "uniform", "varying", "prepend",
                                                             "append", "delete",  "add"};
    const bool named = !before.empty() && std::ranges::find(kBefore, before) == kBefore.end();
    if (named) {
      scanner.rewind(begin);
      break;
    }
    before = name;
    name = word;
  }
  constexpr std::string_view kSampled = ".timeSamples";
  const bool sampled = name.ends_with(kSampled);
  if (sampled) name.remove_suffix(kSampled.size());
  const bool wanted = isWanted(name);
  UsdaAttribute unwanted;
  UsdaAttribute& kept = wanted ? prim.attributes[std::string(name)] : unwanted;
  if (scanner.take('=')) {
    if (sampled && wanted) {
      kept.samples = samples();
    } else {
      const std::string_view value = scanner.value();
      if (!sampled) kept.value = value;
    }
  }
  if (scanner.peek() != '(') return;
  const std::string interpolation = interpolationOf(scanner.value());
  if (!interpolation.empty()) kept.interpolation = interpolation;
}

std::vector<UsdaSample> TextReader::samples() {
  std::vector<UsdaSample> all;
  scanner.expect('{');
  while (!scanner.take('}')) {
    std::string_view time = scanner.word();
    if (time.ends_with(':')) {
      time.remove_suffix(1);
    } else {
      scanner.expect(':');
    }
    all.push_back({numberOf(time), scanner.value()});
    scanner.take(',');
  }
  return all;
}

std::string TextReader::interpolationOf(std::string_view metadata) const {
  const std::size_t key = metadata.find("interpolation");
  if (key == std::string_view::npos) return "";
  const std::size_t open = metadata.find('"', key), close = metadata.find('"', open + 1);
  if (open == std::string_view::npos || close == std::string_view::npos) return "";
  return std::string(metadata.substr(open + 1, close - open - 1));
}

Eigen::Affine3d turned(double degrees, int axis) {
  return Eigen::Affine3d(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, Eigen::Vector3d::Unit(axis)));
}

// "xformOp:rotateXYZ:suffix" and its value. Matrices are kept for row vectors.
Eigen::Affine3d TextReader::operation(std::string_view name, const UsdaPrim& prim) const {
  constexpr std::string_view kBegin = "xformOp:";
  std::string_view kind = name.substr(std::min(kBegin.size(), name.size()));
  kind = kind.substr(0, kind.find(':'));
  const auto attribute = prim.attributes.find(name);
  const std::string_view value = attribute == prim.attributes.end() ? std::string_view() : attribute->second.at(0);
  const std::vector<double> n = usdaNumbers<double>(value, text, file);
  if (kind == "translate" && n.size() == 3) return Eigen::Affine3d(Eigen::Translation3d(n[0], n[1], n[2]));
  if (kind == "scale" && n.size() == 3) return Eigen::Affine3d(Eigen::Scaling(n[0], n[1], n[2]));
  if (kind == "transform" && n.size() == 16) return Eigen::Affine3d(Eigen::Map<const Eigen::Matrix4d>(n.data()));
  if (kind == "orient" && n.size() == 4)
    return Eigen::Affine3d(Eigen::Quaterniond(n[0], n[1], n[2], n[3]).normalized());
  const std::string_view axes = kind.starts_with("rotate") ? kind.substr(6) : std::string_view();
  Eigen::Affine3d place = Eigen::Affine3d::Identity();
  const bool known = axes.find_first_not_of("XYZ") == std::string_view::npos;
  if (known && axes.size() == 1 && n.size() == 1) return turned(n[0], axes[0] - 'X');
  if (known && axes.size() == 3 && n.size() == 3) {
    for (const char axis : axes) place = turned(n[static_cast<std::size_t>(axis - 'X')], axis - 'X') * place;
    return place;
  }
  throw InputError(file, usdaLine(text, prim.at), "the transform " + quoted(name) + " is not read",
                   "apply the transforms before exporting");
}

Eigen::Affine3d TextReader::placeOf(const UsdaPrim& prim) const {
  Eigen::Affine3d place = Eigen::Affine3d::Identity();
  const auto order = prim.attributes.find("xformOpOrder");
  if (order == prim.attributes.end()) return place;
  Scanner names(order->second.value, file);
  names.take('[');
  while (names.peek() == '"' || names.peek() == '\'') {
    place = place * operation(names.quotedText(), prim);
    names.take(',');
  }
  return place;
}

}  // namespace

std::string_view UsdaAttribute::at(std::size_t moment) const {
  return samples.empty() ? value : samples[std::min(moment, samples.size() - 1)].text;
}

UsdaLayer readUsdaLayer(std::string_view bytes, const std::string& file) {
  const std::string_view text = withoutByteOrderMark(bytes);
  TextReader reader{text, file, Scanner(text, file), {}};
  reader.stageMetadata();
  reader.prims();
  return std::move(reader.layer);
}

template <class Number>
std::vector<Number> usdaNumbers(std::string_view value, std::string_view text, const std::string& file) {
  std::vector<Number> numbers;
  const char* at = value.data();
  const char* const end = at + value.size();
  while (at < end) {
    if (isUsdaBlank(*at) || *at == ',' || *at == '[' || *at == ']' || *at == '(' || *at == ')') {
      ++at;
      continue;
    }
    Number number = 0;
    const auto [after, error] = std::from_chars(at, end, number);
    if (error != std::errc() || (after < end && isWord(*after))) {
      throw InputError(file, usdaLine(text, static_cast<std::size_t>(at - text.data())),
                       quoted(std::string_view(at, std::min<std::size_t>(12, static_cast<std::size_t>(end - at)))) +
                           " begins no number that fits here",
                       "export the layer again, as text");
    }
    numbers.push_back(number);
    at = after;
  }
  return numbers;
}
template std::vector<float> usdaNumbers(std::string_view, std::string_view, const std::string&);
template std::vector<double> usdaNumbers(std::string_view, std::string_view, const std::string&);
template std::vector<std::int32_t> usdaNumbers(std::string_view, std::string_view, const std::string&);

std::string usdaLine(std::string_view text, std::size_t at) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(at, text.size()));
  return "line " + std::to_string(1 + std::count(text.begin(), end, '\n'));
}

}  // namespace app

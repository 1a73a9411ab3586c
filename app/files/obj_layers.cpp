#include "app/files/obj_layers.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "app/files/errors.h"
#include "app/files/text_scanner.h"

namespace app {
namespace {

constexpr double kLargestCoordinate = 1e3;  // m
constexpr std::string_view kLayerPrefix = "layer_", kBundlePrefix = "bundle_", kOffsetPrefix = "#groom_offset ",
                           kSharePrefix = "#look_share ";
constexpr const char* kShares = "give those of clump, curl and frizz, and of width where it differs";

bool isObjBlank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}
bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

// Takes the first word off a line; empty at its end or at a comment.
std::string_view nextWord(std::string_view& line) {
  std::size_t begin = 0;
  while (begin < line.size() && isObjBlank(line[begin])) ++begin;
  std::size_t end = begin;
  while (end < line.size() && !isObjBlank(line[end]) && line[end] != '#') ++end;
  const std::string_view word = line.substr(begin, end - begin);
  line = word.empty() ? std::string_view() : line.substr(end);
  return word;
}

struct ObjReader {
  const std::string& file;
  ObjLayers out;
  int line = 0;
  ObjLayer* layer = nullptr;
  std::string_view bundle;

  [[noreturn]] void fail(const std::string& fault, const std::string& mend) const {
    throw InputError(file, "line " + std::to_string(line), fault, mend);
  }
  double coordinate(std::string_view word) const;
  sim::Vec3 threeCoordinates(std::string_view rest) const;
  void readVertex(std::string_view rest);
  void readOffset(std::string_view rest);
  void readShare(std::string_view rest);
  int corner(std::string_view word) const;
  void readFace(std::string_view rest);
  void enterLayer(std::string_view rest);
  void readLine(std::string_view text);
};

double ObjReader::coordinate(std::string_view word) const {
  if (word.empty()) fail("the vertex has fewer than three coordinates", "give x, y and z");
  std::string_view digits = word;
  if (digits.size() > 1 && digits[0] == '+') digits.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::invalid_argument || end != digits.data() + digits.size())
    fail(quoted(word) + " is not a number", "give coordinates in metres");
  if (error == std::errc::result_out_of_range || !std::isfinite(value) || std::abs(value) > kLargestCoordinate)
    fail("the coordinate " + quoted(word) + " is not finite or beyond 1000 m", "give metres near the head");
  return value;
}

sim::Vec3 ObjReader::threeCoordinates(std::string_view rest) const {
  sim::Vec3 p;
  for (int k = 0; k < 3; ++k) p[k] = coordinate(nextWord(rest));
  return p;
}

void ObjReader::readVertex(std::string_view rest) {
  out.positions.push_back(threeCoordinates(rest));
  out.position_lines.push_back(line);
}

void ObjReader::readOffset(std::string_view rest) {
  if (out.positions.empty()) fail("the groom offset belongs to no vertex", "put it after the vertex's line");
  out.offsets.resize(out.positions.size(), sim::Vec3::Zero());
  out.offsets.back() = threeCoordinates(rest);
}

void ObjReader::readShare(std::string_view rest) {
  if (out.positions.empty()) fail("the look shares belong to no vertex", "put them after the vertex's line");
  Eigen::Vector4d share = Eigen::Vector4d::Ones();
  int given = 0;
  for (std::string_view word = nextWord(rest); !word.empty(); word = nextWord(rest), ++given) {
    double value = -1;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !(value >= 0 && value <= 1))
      fail("the look share " + quoted(word) + " is not from 0 to 1", kShares);
    if (given < 4) share[given] = value;
  }
  if (given < 3 || given > 4) fail("there are " + std::to_string(given) + " look shares", kShares);
  out.shares.resize(out.positions.size(), Eigen::Vector4d::Ones());
  out.shares.back() = share;
}

// "7", "7/1", "7//2", "7/1/2", or counted back from the last vertex: "-1". Vertices written further down are found out
// later.
int ObjReader::corner(std::string_view word) const {
  const std::string_view index = word.substr(0, word.find('/'));
  long long value = 0;
  const auto [end, error] = std::from_chars(index.data(), index.data() + index.size(), value);
  if (error != std::errc() || end != index.data() + index.size() || value == 0)
    fail("the face's corner " + quoted(word) + " is not a vertex number", "count vertices from 1, or back from -1");
  const long long count = static_cast<long long>(out.positions.size());
  if (value < 0 ? value < -count : value > 2'000'000'000)
    fail("the face names vertex " + std::to_string(value) + ", which does not exist",
         std::to_string(count) + " vertices stand above it");
  return static_cast<int>(value < 0 ? count + value : value - 1);
}

void ObjReader::readFace(std::string_view rest) {
  if (!layer) fail("the face belongs to no layer", "put a line 'g layer_0' before the scalp's faces");
  ObjFace face;
  face.line = line;
  face.bundle = bundle;
  for (std::string_view word = nextWord(rest); !word.empty(); word = nextWord(rest)) {
    if (face.corner_count == 4) fail("the face has more than four corners", "split it into triangles and quads");
    face.v[face.corner_count++] = corner(word);
  }
  if (face.corner_count < 3) fail("the face has fewer than three corners", "give it three or four");
  layer->faces.push_back(face);
}

// A group or an object is a layer when one of its names is layer_<n>, alone or before what a modelling tool has
// appended.
void ObjReader::enterLayer(std::string_view rest) {
  for (std::string_view word = nextWord(rest); !word.empty(); word = nextWord(rest)) {
    if (word.substr(0, kLayerPrefix.size()) != kLayerPrefix) continue;
    word.remove_prefix(kLayerPrefix.size());
    int number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || number < 0)
      fail("the layer's number " + quoted(word) + " is not a number", "name layers layer_0, layer_1, ...");
    layer = &out.layers[number];
    if (layer->line == 0) layer->line = line;
    return;
  }
}

void ObjReader::readLine(std::string_view text) {
  if (text.starts_with(kOffsetPrefix)) return readOffset(text.substr(kOffsetPrefix.size()));
  if (text.starts_with(kSharePrefix)) return readShare(text.substr(kSharePrefix.size()));
  const std::string_view keyword = nextWord(text);
  if (keyword == "v") {
    readVertex(text);
  } else if (keyword == "f") {
    readFace(text);
  } else if (keyword == "g" || keyword == "o") {
    enterLayer(text);
  } else if (keyword == "usemtl") {
    const std::string_view name = nextWord(text);
    bundle = std::string_view();
    if (name.size() > kBundlePrefix.size() && name.substr(0, kBundlePrefix.size()) == kBundlePrefix &&
        isDigit(name[kBundlePrefix.size()]))
      bundle = name;
  }
}

}  // namespace

ObjLayers readObjLayers(std::string_view text, const std::string& file) {
  refuseUtf16(text, file);
  ObjReader reader{file, {}, 0, nullptr, {}};
  while (!text.empty()) {
    ++reader.line;
    const std::size_t end = std::min(text.find('\n'), text.size());
    reader.readLine(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  if (!reader.out.offsets.empty()) reader.out.offsets.resize(reader.out.positions.size(), sim::Vec3::Zero());
  if (!reader.out.shares.empty()) reader.out.shares.resize(reader.out.positions.size(), Eigen::Vector4d::Ones());
  const int count = static_cast<int>(reader.out.positions.size());
  for (const auto& [number, layer] : reader.out.layers) {
    for (const ObjFace& face : layer.faces) {
      reader.line = face.line;
      for (int k = 0; k < face.corner_count; ++k) {
        if (face.v[k] >= count)
          reader.fail("the face names vertex " + std::to_string(face.v[k] + 1LL) + ", which does not exist",
                      "the file has " + std::to_string(count) + " vertices");
      }
    }
  }
  return std::move(reader.out);
}

}  // namespace app

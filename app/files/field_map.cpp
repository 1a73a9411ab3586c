#include "app/files/field_map.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "app/files/image_io.h"
#include "app/files/painted_mesh.h"
#include "sim/field_text.h"

namespace app {

namespace {

constexpr std::string_view kPictureText = "data:image/png;base64,";
constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr double kMinShare = 0.01;  // of a curve

std::string toBase64(std::string_view bytes) {
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (at + k < bytes.size() ? static_cast<unsigned char>(bytes[at + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += at + k > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63];
  }
  return text;
}

// Empty where the text is none.
std::string fromBase64(std::string_view text) {
  if (text.size() % 4 != 0) return "";
  std::string bytes;
  for (std::size_t at = 0; at < text.size(); at += 4) {
    unsigned bits = 0;
    std::size_t count = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const bool filled = text[at + k] == '=' && at + 4 == text.size() && k > 1;
      const std::size_t digit = filled ? 0 : kDigits.find(text[at + k]);
      if (digit == std::string_view::npos) return "";
      bits = bits << 6 | static_cast<unsigned>(digit);
      count += !filled;
    }
    for (std::size_t k = 0; k + 1 < count; ++k) bytes += static_cast<char>(bits >> (16 - 8 * k) & 255);
  }
  return bytes;
}

std::string fieldHint() {
  std::string names;
  for (const std::string_view name : kFieldNames) names.append(names.empty() ? "" : ", ").append(name);
  return names;
}

std::string curveHint() {
  std::string names;
  for (const std::string_view name : kCurveNames) names.append(names.empty() ? "" : ", ").append(name);
  return names;
}

constexpr std::array kMapMembers{&FieldFiles::stiffness, &FieldFiles::length,  &FieldFiles::density,
                                 &FieldFiles::mass,      &FieldFiles::bend,    &FieldFiles::width,
                                 &FieldFiles::clump,     &FieldFiles::curl,    &FieldFiles::color,
                                 &FieldFiles::roughness, &FieldFiles::damping, &FieldFiles::frizz};
static_assert(kMapMembers.size() == kFieldNames.size());

using Curve = std::vector<double> FieldCurves::*;
constexpr std::array<Curve, kCurveNames.size()> kCurveMembers{&FieldCurves::stiffness,
                                                              &FieldCurves::mass,
                                                              &FieldCurves::bend,
                                                              &FieldCurves::width,
                                                              &FieldCurves::clump,
                                                              &FieldCurves::curl,
                                                              nullptr,
                                                              &FieldCurves::roughness,
                                                              &FieldCurves::damping};

// Null for color, which has three channels, and for a name of none.
Curve findCurve(std::string_view name) {
  const auto at = std::ranges::find(kCurveNames, name);
  return at == kCurveNames.end() ? nullptr : kCurveMembers[static_cast<std::size_t>(at - kCurveNames.begin())];
}

bool isShare(double share) {
  return share >= kMinShare && share <= kLargestShare;
}

// "#rrggbb" as shares of light, or one number for all three.
bool parseColor(std::string_view text, std::array<double, 3>& color) {
  if (text.size() != 7 || text[0] != '#') {
    double share = 0;
    if (!sim::parseNumber(text, share) || !isShare(share)) return false;
    color = {share, share, share};
    return true;
  }
  for (std::size_t c = 0; c < 3; ++c) {
    int value = 0;
    const char* const first = text.data() + 1 + 2 * c;
    if (std::from_chars(first, first + 2, value, 16).ptr != first + 2 || value < 0) return false;
    color[c] = linearShare(value / 255.0);
  }
  return true;
}

// The segment of a curve of `count` points at `along`: its first point, and how far along it.
std::pair<std::size_t, double> segmentAt(std::size_t count, double along) {
  const double at = std::clamp(along, 0.0, 1.0) * static_cast<double>(count - 1);
  const std::size_t first = std::min(static_cast<std::size_t>(at), count - 1);
  return {first, at - static_cast<double>(first)};
}

// What of the picture is not as a field's picture should be. `grey`: its brightness alone is read.
std::string noteOf(const Image& image, bool grey) {
  constexpr int kTint = 12, kSolid = 250;  // of 255
  std::size_t coloured = 0, clear = 0;
  for (std::size_t i = 0; i + 3 < image.rgba.size(); i += 4) {
    const auto [low, high] = std::minmax({image.rgba[i], image.rgba[i + 1], image.rgba[i + 2]});
    coloured += high - low > kTint;
    clear += image.rgba[i + 3] < kSolid;
  }
  bool even = true;
  for (std::size_t i = 4; i < image.rgba.size(); ++i) even = even && image.rgba[i] == image.rgba[i - 4];
  std::string note;
  const auto add = [&](const std::string& more) { note += (note.empty() ? "" : ", and ") + more; };
  if (grey && coloured > 0)
    add("is coloured: its brightness is read (grey is expected, white for the parameter's own value)");
  if (clear > 0) add("is transparent in places: the colour beneath is read (an opaque picture is expected)");
  if (!even && image.width != 2 * image.height)
    add("is " + std::to_string(image.width) + "x" + std::to_string(image.height) +
        ": it is stretched over the head (twice as wide as high is expected)");
  return note;
}

}  // namespace

double FieldMap::at(const sim::Vec3& direction) const {
  const double polar = std::acos(std::clamp(direction.y() / std::max(1e-12, direction.norm()), -1.0, 1.0));
  const double azimuth = std::atan2(direction.x(), direction.z());
  const double u = (azimuth / (2 * std::numbers::pi) + 0.5) * width - 0.5;
  const double v = std::clamp(polar / std::numbers::pi * height - 0.5, 0.0, height - 1.0);
  const int column = static_cast<int>(std::floor(u)), row = static_cast<int>(v);
  const double s = u - column, t = v - row;
  const auto texel = [&](int r, int c) {
    const int x = (c % width + width) % width, y = std::min(r, height - 1);
    return static_cast<double>(
        value[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)]);
  };
  const double upper = texel(row, column) + s * (texel(row, column + 1) - texel(row, column));
  const double lower = texel(row + 1, column) + s * (texel(row + 1, column + 1) - texel(row + 1, column));
  return upper + t * (lower - upper);
}

sim::Vec3 directionOf(const FieldMap& map, int column, int row) {
  const double azimuth = 2 * std::numbers::pi * ((column + 0.5) / map.width - 0.5);
  const double polar = std::numbers::pi * (row + 0.5) / map.height;
  return {std::sin(polar) * std::sin(azimuth), std::cos(polar), std::sin(polar) * std::cos(azimuth)};
}

FieldMap fieldOver(std::span<const sim::Vec3> directions, std::span<const double> values) {
  constexpr int kWidth = 128, kHeight = 64;
  constexpr double kSoft = 0.05;  // rad: of the border between two of them
  FieldMap map{kWidth, kHeight, {}, {}};
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const sim::Vec3 here = directionOf(map, column, row);
      double nearest = -1, sum = 0, weights = 0;
      for (const sim::Vec3& direction : directions) nearest = std::max(nearest, direction.dot(here));
      for (std::size_t k = 0; k < directions.size(); ++k) {
        const double weight = std::exp((directions[k].dot(here) - nearest) / (kSoft * kSoft));
        sum += weight * values[k];
        weights += weight;
      }
      map.value.push_back(static_cast<float>(sum / weights));
    }
  }
  return map;
}

double linearShare(double value) {
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

double pictureValue(double share) {
  const double value = share <= 0.0031308 ? 12.92 * share : 1.055 * std::pow(share, 1 / 2.4) - 0.055;
  return std::clamp(value, 0.0, 1.0);
}

namespace {

Image readPicture(const std::string& picture) {
  if (!isPictureText(picture)) return hasPaintedEnding(picture) ? readPaintedMesh(picture) : readPng(picture);
  return readPngBytes(fromBase64(std::string_view(picture).substr(kPictureText.size())), "painted field");
}

std::string channelsText(const FieldMap& red, const FieldMap& green, const FieldMap& blue) {
  std::vector<unsigned char> rgba;
  const auto byte = [](float value) {
    return static_cast<unsigned char>(std::lround(255 * std::clamp(value, 0.0f, 1.0f)));
  };
  for (std::size_t i = 0; i < red.value.size(); ++i)
    rgba.insert(rgba.end(), {byte(red.value[i]), byte(green.value[i]), byte(blue.value[i]), 255});
  return std::string(kPictureText) + toBase64(pngBytes(red.width, red.height, rgba));
}

}  // namespace

FieldMap readFieldMap(const std::string& picture) {
  const Image image = readPicture(picture);
  FieldMap map{image.width, image.height, {}, {}};
  for (std::size_t i = 0; i + 3 < image.rgba.size(); i += 4) {
    const int grey = 2126 * image.rgba[i] + 7152 * image.rgba[i + 1] + 722 * image.rgba[i + 2];
    map.value.push_back(static_cast<float>(grey) / 2550000.0f);
  }
  map.note = noteOf(image, true);
  return map;
}

std::string mapNotes(const FieldFiles& maps) {
  std::string notes;
  for (const auto member : kMapMembers) {
    const std::string& picture = maps.*member;
    if (picture.empty() || isPictureText(picture)) continue;
    const bool color = member == &FieldFiles::color;
    const std::string note = color ? readColorMap(picture)[0].note : readFieldMap(picture).note,
                      line = picture + " " + note;
    if (!note.empty() && notes.find(line) == std::string::npos) notes += (notes.empty() ? "" : "\n") + line;
  }
  return notes;
}

ColorMap readColorMap(const std::string& picture) {
  const Image image = readPicture(picture);
  ColorMap map;
  for (std::size_t c = 0; c < 3; ++c) {
    map[c] = {image.width, image.height, {}, {}};
    for (std::size_t i = c; i < image.rgba.size(); i += 4)
      map[c].value.push_back(static_cast<float>(image.rgba[i]) / 255.0f);
  }
  map[0].note = noteOf(image, false);
  return map;
}

std::string pictureText(const FieldMap& map) {
  return channelsText(map, map, map);
}

std::string pictureText(const ColorMap& map) {
  return channelsText(map[0], map[1], map[2]);
}

bool isPictureText(std::string_view picture) {
  return picture.starts_with(kPictureText);
}

std::string* findMap(std::string_view name, FieldFiles& maps) {
  const auto at = std::ranges::find(kFieldNames, name);
  return at == kFieldNames.end() ? nullptr : &(maps.*kMapMembers[static_cast<std::size_t>(at - kFieldNames.begin())]);
}

const std::string& mapOf(std::string_view name, const FieldFiles& maps) {
  return maps.*kMapMembers[static_cast<std::size_t>(std::ranges::find(kFieldNames, name) - kFieldNames.begin())];
}

std::string setMap(std::string_view name, const std::string& picture, FieldFiles& maps) {
  if (std::string* map = findMap(name, maps)) return *map = picture, "";
  return "there is no field '" + std::string(name.substr(0, 40)) + "'; choose one of " + fieldHint();
}

double curveAt(const std::vector<double>& curve, double along) {
  if (curve.empty()) return 1;
  const auto [first, within] = segmentAt(curve.size(), along);
  return curve[first] + within * (curve[std::min(first + 1, curve.size() - 1)] - curve[first]);
}

std::array<double, 3> colorAt(const std::vector<std::array<double, 3>>& curve, double along) {
  if (curve.empty()) return {1, 1, 1};
  const auto [first, within] = segmentAt(curve.size(), along);
  const std::array<double, 3>&from = curve[first], &to = curve[std::min(first + 1, curve.size() - 1)];
  return {from[0] + within * (to[0] - from[0]), from[1] + within * (to[1] - from[1]),
          from[2] + within * (to[2] - from[2])};
}

const std::vector<double>& curveOf(std::string_view name, const FieldCurves& curves) {
  static const std::vector<double> kNone;
  const Curve curve = findCurve(name);
  return curve ? curves.*curve : kNone;
}

namespace {

std::array<double, 3> readColor(const JsonPlace& point) {
  if (point.value().is_array()) return point.vector(0, kLargestShare);
  std::array<double, 3> color{};
  if (!point.value().is_string()) {
    color.fill(point.number(kMinShare, kLargestShare));
  } else if (const std::string text = point.text(); text.empty() || text[0] != '#' || !parseColor(text, color)) {
    point.refuse("is no colour", "write \"#rrggbb\", a share of light, or three");
  }
  return color;
}

}  // namespace

FieldCurves readCurves(const JsonPlace& place) {
  place.expectObject(kCurveNames);
  FieldCurves curves;
  for (const std::string_view name : kCurveNames) {
    if (!place.has(std::string(name))) continue;
    const JsonPlace points = place.at(std::string(name));
    const std::size_t count = points.arraySize(kMaxCurvePoints);
    const Curve curve = findCurve(name);
    for (std::size_t k = 0; k < count; ++k) {
      if (curve)
        (curves.*curve).push_back(points.at(k).number(kMinShare, kLargestShare));
      else
        curves.color.push_back(readColor(points.at(k)));
    }
  }
  return curves;
}

nlohmann::json writeCurves(const FieldCurves& curves) {
  nlohmann::json written{{"color", curves.color}};
  for (const std::string_view name : kCurveNames)
    if (name != "color") written[std::string(name)] = curveOf(name, curves);
  return written;
}

void setCurve(const std::string& name, const std::string& text, FieldCurves& curves) {
  const Curve curve = findCurve(name);
  if (!curve && name != "color")
    throw InputError("", "curve '" + name.substr(0, 40) + "'", "is of no field", "choose one of " + curveHint());
  std::vector<std::array<double, 3>> points;
  for (std::size_t at = 0; text != "none" && at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::string_view word = std::string_view(text).substr(at, end - at);
    std::array<double, 3> point{};
    if (!parseColor(word, point) || (curve && word[0] == '#') || points.size() == kMaxCurvePoints)
      throw InputError("", "curve '" + text.substr(0, 40) + "'", "is no list of shares",
                       "write up to 32 numbers from 0.01 to 10 with commas, from root to tip, or none" +
                           std::string(curve ? "" : "; a colour may be #rrggbb"));
    points.push_back(point);
    at = end + 1;
  }
  if (!curve) {
    curves.color = std::move(points);
    return;
  }
  (curves.*curve).clear();
  for (const std::array<double, 3>& point : points) (curves.*curve).push_back(point[0]);
}

}  // namespace app

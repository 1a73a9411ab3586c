// Scalar fields over the scalp, painted as grey pictures, and curves of them from root to tip.
//
// A picture is the head unrolled: its middle column is the front, its sides the back, its left half the figure's right
// side; its top row is the crown, the row half-way down lies level with the tops of the ears. White stands for the
// parameter's own value, black for its least; the picture of "color" is what pigment lets through. It is a PNG file,
// or the bytes of one in text (RFC 2397, "data:image/png;base64,..."), as brushes in the window leave it, or a mesh
// with coloured vertices (painted_mesh.h).
//
// A curve is a list of shares of the parameter's value, evenly spaced from root to tip: "curves": { "stiffness":
// [1, 0.5, 0.2] }; linear in between. Of "color" a share may be three (linear light), or a picture's colour "#rrggbb".
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/files/json_reader.h"
#include "sim/mesh/hair_mesh.h"

namespace app {

struct FieldMap {
  int width = 0, height = 0;
  std::vector<float> value;  // 0 to 1, top row first
  std::string note{};        // what was read otherwise than it looks, and what is expected; empty: nothing

  // In a direction from the head's middle (need not be unit), bilinear; the left and right sides meet.
  double at(const sim::Vec3& direction) const;
};

using ColorMap = std::array<FieldMap, 3>;

// A picture's value 0 to 1 (sRGB) as a share of light, and back.
double linearShare(double value);
double pictureValue(double share);

// The field that has these values in these directions from the head's middle (unit), and between them the nearest's.
FieldMap fieldOver(std::span<const sim::Vec3> directions, std::span<const double> values);

// The direction of a pixel's middle.
sim::Vec3 directionOf(const FieldMap& map, int column, int row);

// The luminance of a PNG, of a file or in text, or of a painted mesh, over the whole head whatever its sides. Throws
// InputError.
FieldMap readFieldMap(const std::string& picture);
// Its red, green and blue, as the picture has them (sRGB).
ColorMap readColorMap(const std::string& picture);

// As text that is read back, in 256 steps.
std::string pictureText(const FieldMap& map);
std::string pictureText(const ColorMap& map);
bool isPictureText(std::string_view picture);

// The pictures that a character is painted with; empty: none.
struct FieldFiles {
  std::string stiffness, length, density, mass, bend, width, clump, curl, color, roughness, damping, frizz;
  bool operator==(const FieldFiles&) const = default;
};

// The notes of pictures that are files, a line each, with their names. Throws InputError.
std::string mapNotes(const FieldFiles& maps);

inline constexpr std::array<std::string_view, 12> kFieldNames{"stiffness", "length",    "density", "mass",
                                                              "bend",      "width",     "clump",   "curl",
                                                              "color",     "roughness", "damping", "frizz"};
// Those with a curve.
inline constexpr std::array<std::string_view, 9> kCurveNames{"stiffness", "mass",  "bend",      "width",  "clump",
                                                             "curl",      "color", "roughness", "damping"};

// The picture of a field; null for a name of none.
std::string* findMap(std::string_view name, FieldFiles& maps);
const std::string& mapOf(std::string_view name, const FieldFiles& maps);

// Gives the field of a name another picture. Returns what is wrong with the name, empty when fine.
std::string setMap(std::string_view name, const std::string& picture, FieldFiles& maps);

// Shares from root to tip; empty: 1 everywhere.
struct FieldCurves {
  std::vector<double> stiffness, mass, bend, width, clump, curl, roughness, damping;
  std::vector<std::array<double, 3>> color;
  bool operator==(const FieldCurves&) const = default;
};

inline constexpr std::size_t kMaxCurvePoints = 32;
inline constexpr double kLargestShare = 10;

// At a share of the way from root to tip.
double curveAt(const std::vector<double>& curve, double along);
std::array<double, 3> colorAt(const std::vector<std::array<double, 3>>& curve, double along);
// The curve of a field's name but "color"; empty for those that have none.
const std::vector<double>& curveOf(std::string_view name, const FieldCurves& curves);

// Throw InputError.
FieldCurves readCurves(const JsonPlace& place);
nlohmann::json writeCurves(const FieldCurves& curves);
// "1,0.5,0.2", or none; of color "#ffffff,0.5,#803020" as well.
void setCurve(const std::string& name, const std::string& text, FieldCurves& curves);

}  // namespace app

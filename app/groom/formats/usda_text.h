// Prims of a USD layer in text (`.usda`): their types, their places and where the values of their attributes stand.
//
// A layer is "#usda 1.0", metadata in brackets, and prims: a specifier (def, over, class), a type, a name in quotes,
// metadata, and a body in braces of attributes and further prims. An attribute is its type, its name, its value and its
// metadata; NAME.timeSamples is a dictionary of time codes. Source: openusd.org, "Crate and text file formats" and the
// schemas of UsdGeom. References, payloads and variants are passed over: a file is read as it stands.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace app {

struct UsdaSample {
  double time = 0;        // code
  std::string_view text;  // the value
};

struct UsdaAttribute {
  std::string_view value;           // without time samples; empty: none
  std::vector<UsdaSample> samples;  // in the file's order
  std::string interpolation;        // empty: not told
  // The value at moment `moment`, the last where there are fewer; empty where there is none.
  std::string_view at(std::size_t moment) const;
};

struct UsdaPrim {
  std::string type, name;
  std::size_t at = 0;                                            // where it begins in the text
  Eigen::Affine3d place = Eigen::Affine3d::Identity();           // of the prims above and its own, at their default
  bool invisible = false;                                        // itself, or one above it
  std::string_view purpose;                                      // empty: default
  std::map<std::string, UsdaAttribute, std::less<>> attributes;  // of what a groom may need
};

struct UsdaLayer {
  double meters_per_unit = 0.01;  // USD's own default
  char up_axis = 'Y';
  bool tells_unit = false, tells_up = false;
  double time_codes_per_second = 24;
  std::vector<UsdaPrim> curves;  // of the type BasisCurves, in the file's order, but for
  int hidden = 0;                // those that are invisible or of the purpose guide or proxy
};

// Views live as long as `text`. Throws InputError naming the line.
UsdaLayer readUsdaLayer(std::string_view bytes, const std::string& file);

// The numbers of a value, whatever brackets stand between them. Throws InputError naming the line, with `text` as the
// whole file that `value` is a part of.
template <class Number>
std::vector<Number> usdaNumbers(std::string_view value, std::string_view text, const std::string& file);

// "line N" of a place in the text.
std::string usdaLine(std::string_view text, std::size_t at);

}  // namespace app

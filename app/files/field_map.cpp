#include "app/files/field_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/files/image_io.h"

namespace app {

double FieldMap::at(const sim::Vec3& direction) const {
  const double polar = std::acos(std::clamp(direction.y() / std::max(1e-12, direction.norm()), -1.0, 1.0));
  const double azimuth = std::atan2(direction.x(), direction.z());
  const double u = (azimuth / (2 * std::numbers::pi) + 0.5) * width - 0.5;
  const double v = std::clamp(polar / std::numbers::pi * height - 0.5, 0.0, height - 1.0);
  const int column = static_cast<int>(std::floor(u)), row = static_cast<int>(v);
  const double s = u - column, t = v - row;
  const auto texel = [&](int r, int c) {
    const int x = (c % width + width) % width, y = std::min(r, height - 1);
    return static_cast<double>(value[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                     static_cast<std::size_t>(x)]);
  };
  const double upper = texel(row, column) + s * (texel(row, column + 1) - texel(row, column));
  const double lower = texel(row + 1, column) + s * (texel(row + 1, column + 1) - texel(row + 1, column));
  return upper + t * (lower - upper);
}

FieldMap readFieldMap(const std::string& file) {
  const Image image = readPng(file);
  FieldMap map{image.width, image.height, {}};
  for (std::size_t i = 0; i + 3 < image.rgba.size(); i += 4) {
    const int grey = 2126 * image.rgba[i] + 7152 * image.rgba[i + 1] + 722 * image.rgba[i + 2];
    map.value.push_back(static_cast<float>(grey) / 2550000.0f);
  }
  return map;
}

std::string setMap(std::string_view name, const std::string& file, FieldFiles& maps) {
  if (name == "stiffness") return maps.stiffness = file, "";
  if (name == "length") return maps.length = file, "";
  if (name == "density") return maps.density = file, "";
  return "there is no field '" + std::string(name.substr(0, 40)) + "'; choose one of stiffness, length, density";
}

}  // namespace app

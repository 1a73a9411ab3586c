// How messages name a vertex of a mesh file.
#pragma once

#include <cstdio>
#include <string>

#include "app/files/file_ending.h"

namespace app {

// By its number in the file, from 0, where that is known: what reads other formats than glTF numbers corners of faces.
// Else by its coordinates there.
template <class Point>
std::string vertexPlace(const std::string& file, const std::string& mesh, unsigned number, const Point& at) {
  const std::string ending = endingOf(file);
  if (ending == ".glb" || ending == ".gltf" || ending == ".vrm") return mesh + ", vertex " + std::to_string(number);
  char text[80];
  std::snprintf(text, sizeof text, ", vertex at (%g, %g, %g)", static_cast<double>(at.x), static_cast<double>(at.y),
                static_cast<double>(at.z));
  return mesh + text;
}

}  // namespace app

// Optional arrays of a groom while it is read: an array that some parts of a file lack is filled where it lacks.
#pragma once

#include <cstddef>
#include <vector>

#include "app/groom/groom.h"

namespace app {

// Element `at` of an array that may yet be shorter; what lies between is `missing`.
template <class Element>
void putAt(std::vector<Element>& all, std::size_t at, const Element& value, const Element& missing) {
  if (all.size() <= at) all.resize(at, missing);
  if (all.size() == at) {
    all.push_back(value);
  } else {
    all[at] = value;
  }
}

// Makes every array that has begun whole: widths, colours, root UVs, groups and guides with 0, ids with -1.
inline void fillArrays(Groom& groom) {
  const auto fill = [](auto& all, std::size_t size, const auto& missing) {
    if (!all.empty()) all.resize(size, missing);
  };
  fill(groom.widths, groom.points.size(), 0.0f);
  fill(groom.colors, groom.points.size(), Eigen::Vector3f(Eigen::Vector3f::Zero()));
  fill(groom.root_uvs, groom.strandCount(), Eigen::Vector2f(Eigen::Vector2f::Zero()));
  fill(groom.ids, groom.strandCount(), -1);
  fill(groom.groups, groom.strandCount(), 0);
  fill(groom.guides, groom.strandCount(), std::uint8_t{0});
}

}  // namespace app

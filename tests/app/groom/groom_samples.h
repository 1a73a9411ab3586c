// Grooms for tests of the files: every array filled, strands of different lengths, bits that text must not lose.
#pragma once

#include <cstdint>
#include <random>
#include <string>

#include "app/groom/groom.h"

namespace test {

// `strands` of 2 to 9 points, seeded; positions of a head's hair in metres.
inline app::Groom sampleGroom(std::size_t strands, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto unit = [&random] { return static_cast<float>(random() >> 8) * 0x1p-24f; };
  app::Groom groom;
  for (std::size_t s = 0; s < strands; ++s) {
    Eigen::Vector3f at(unit() * 0.2f - 0.1f, 1.6f + 0.1f * unit(), unit() * 0.2f - 0.1f);
    const Eigen::Vector3f shade(unit(), unit(), unit());
    const std::size_t points = 2 + random() % 8;
    for (std::size_t p = 0; p < points; ++p) {
      groom.points.push_back(at);
      groom.widths.push_back(8e-5f * (1 - 0.1f * static_cast<float>(p)));
      groom.colors.push_back(shade * (0.9f + 0.01f * static_cast<float>(p)));
      at += Eigen::Vector3f(0.01f * unit(), -0.02f, 0.01f * unit());
    }
    groom.strand_first.push_back(static_cast<std::uint32_t>(groom.points.size()));
    groom.root_uvs.emplace_back(unit(), unit());
    groom.ids.push_back(static_cast<std::int32_t>(3 * s + 7));
    groom.groups.push_back(static_cast<std::int32_t>(s % 3));
    groom.guides.push_back(s % 5 == 0);
  }
  return groom;
}

// Empty where `text` holds `piece`, else the text.
inline std::string lacking(const std::string& text, const std::string& piece) {
  return text.find(piece) != std::string::npos ? "" : "'" + text + "'";
}

}  // namespace test

// Hair on the analytic head, whose place, axes and unit are known, for tests of the inspector.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <string>

#include "app/groom/inspect/groom_inspect.h"
#include "tests/analytic_head.h"

namespace combed {

using Eigen::Vector3f;

inline app::HeadModel head() {
  return {[](const Vector3f& p) { return static_cast<float>(tests::bodyDistance(p.cast<double>())); },
          Vector3f(0, 0.022f, -0.012f), std::nullopt};
}

struct Random {
  std::mt19937 engine;
  float unit() { return static_cast<float>(engine() >> 8) * 0x1p-24f; }
  float between(float low, float high) { return low + (high - low) * unit(); }
};

// Hair of 8 points a strand on the analytic head: rooted over the skull above the ears but for the face, combed down
// over it.
inline app::Groom combedGroom(std::size_t strands, std::uint32_t seed) {
  Random random{std::mt19937(seed)};
  const float length = random.between(0.12f, 0.35f);
  const app::HeadModel model = head();
  app::Groom groom;
  while (groom.strandCount() < strands) {
    const float azimuth = random.between(-3.14159f, 3.14159f), height = random.between(-0.15f, 1);
    const float level = std::sqrt(1 - height * height);
    const Vector3f direction(level * std::sin(azimuth), height, level * std::cos(azimuth));
    if (direction.z() > 0.35f && direction.y() < 0.75f) continue;  // the face
    Vector3f at = model.center;
    for (float out = 0; model.distance(at) < 0.0005f && out < 0.3f; out += 0.0005f) at = model.center + out * direction;
    Vector3f heading = direction;
    for (int p = 0; p < 8; ++p) {
      groom.points.push_back(at);
      groom.widths.push_back(1e-4f * (1 - 0.05f * static_cast<float>(p)));
      heading = (heading + Vector3f(0, -0.9f, 0)).normalized();
      at += length * random.between(0.9f, 1.1f) / 7 * heading;
      for (int round = 0; round < 8; ++round) {
        const float here = model.distance(at);
        if (here > 0.004f) break;
        Vector3f slope;
        for (int axis = 0; axis < 3; ++axis) slope[axis] = model.distance(at + 1e-3f * Vector3f::Unit(axis)) - here;
        at += (0.005f - here) * slope.normalized();
      }
    }
    groom.strand_first.push_back(static_cast<std::uint32_t>(groom.points.size()));
  }
  return groom;
}

inline void moveAll(app::Groom& groom, const Eigen::Matrix3f& turn, float scale, const Vector3f& shift) {
  for (Vector3f& point : groom.points) point = scale * (turn * point) + shift;
}

inline Eigen::Matrix3f turnOf(const char* up) {
  return app::axesOfUp(up)->transpose();
}

// Strands of 12 cm that stand off the head in a strip from brow to nape, or hang from the chin.
inline app::Groom strip(bool beard) {
  const app::HeadModel model = head();
  Random random{std::mt19937(3)};
  app::Groom groom;
  for (int s = 0; s < 400; ++s) {
    const float around = beard ? random.between(-0.9f, 0.9f) : random.between(-0.12f, 0.12f);
    const float over = beard ? random.between(-0.9f, -0.5f) : random.between(0.5f, 2.6f);
    const Vector3f direction =
        beard ? Vector3f(std::sin(around) * std::cos(over), std::sin(over), std::cos(around) * std::cos(over))
              : Vector3f(around, std::sin(over), std::cos(over)).normalized();
    Vector3f at = model.center;
    for (float out = 0; model.distance(at) < 0.0005f && out < 0.3f; out += 0.0005f) at = model.center + out * direction;
    const Vector3f way = beard ? Vector3f(0.3f * direction + Vector3f(0, -1, 0)).normalized() : direction;
    for (int p = 0; p < 8; ++p) groom.points.push_back(at + 0.12f * static_cast<float>(p) / 7 * way);
    groom.strand_first.push_back(static_cast<std::uint32_t>(groom.points.size()));
  }
  return groom;
}

inline std::string namesOf(const app::GroomInspection& inspection) {
  std::string names;
  for (const app::GroomFinding& finding : inspection.findings) names += finding.what + ": " + finding.text + "; ";
  return names;
}

}  // namespace combed

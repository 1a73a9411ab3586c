#include "app/scene/braid/braid_band.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace app {
namespace {

constexpr int kBandSides = 32, kBandEdges = 12;
constexpr float kBandRadius = 1.1f, kBandThickness = 0.2f;  // of the hair that it holds
constexpr std::uint64_t kBandIds = std::uint64_t{1} << 62;  // above all that are counted up, see freshId

struct Torus {
  std::vector<float> positions, normals, weights;
  std::vector<std::uint32_t> triangles;
  std::vector<std::uint16_t> joints;

  Torus() {
    for (int i = 0; i < kBandSides; ++i) {
      for (int j = 0; j < kBandEdges; ++j) {
        const float u = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / kBandSides,
                    v = 2 * std::numbers::pi_v<float> * static_cast<float>(j) / kBandEdges;
        const float out = kBandRadius + kBandThickness * std::cos(v), high = 1.6f * kBandThickness * std::sin(v);
        positions.insert(positions.end(), {out * std::cos(u), out * std::sin(u), high});
        normals.insert(normals.end(), {std::cos(v) * std::cos(u), std::cos(v) * std::sin(u), std::sin(v)});
        joints.insert(joints.end(), {0, 0, 0, 0});
        weights.insert(weights.end(), {1, 0, 0, 0});
        const auto at = [](int a, int b) {
          return static_cast<std::uint32_t>(a % kBandSides * kBandEdges + b % kBandEdges);
        };
        triangles.insert(triangles.end(), {at(i, j), at(i + 1, j), at(i + 1, j + 1)});
        triangles.insert(triangles.end(), {at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
  }
};

}  // namespace

render::BodyInput bandInput(std::uint64_t hair, std::size_t band) {
  static const Torus torus;
  constexpr std::uint64_t kMaxBands = 16;
  render::BodyInput input;
  input.id = kBandIds + hair * kMaxBands + band;
  input.mesh_id = kBandIds;
  input.positions = torus.positions;
  input.normals = torus.normals;
  input.triangles = torus.triangles;
  input.joints = torus.joints;
  input.weights = torus.weights;
  input.color = {0.05f, 0.045f, 0.05f};
  input.roughness = 0.6f;
  return input;
}

}  // namespace app

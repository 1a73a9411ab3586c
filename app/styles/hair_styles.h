// Built-in hair meshes on a given scalp: {short, shoulder, long, bob, pixie, shaved} x {low, medium, high, ultra}, and
// minimal.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "sim/contact/colliders.h"
#include "sim/mesh/hair_mesh.h"

namespace app {

using Vec3 = Eigen::Vector3d;

enum class Style { kShort, kShoulder, kLong, kBob, kPixie, kShaved };
inline constexpr std::array<std::string_view, 6> kStyleNames{"short", "shoulder", "long", "bob", "pixie", "shaved"};
// Minimal, the coarsest of all, is for hair that is small in the picture and is not offered by name.
enum class Resolution { kLow, kMedium, kHigh, kUltra, kMinimal };

// The head that a style grows on, in the head joint's frame turned so that y is up, z forward, x to the character's
// left. `radius` samples the skin as distance from `center` over a latitude-longitude grid: row i is polar angle i * pi
// / (rows - 1) from +y, column j azimuth j * 2 pi / columns from +z towards +x. Heads are star-shaped from their
// centre.
struct Scalp {
  Vec3 center = Vec3::Zero();  // m: the middle of the cranium, level with the top of the ears
  double head_height = 0.23;   // m, chin to crown: the scale of everything
  int rows = 0, columns = 0;
  std::vector<double> radius;  // m, rows x columns, row-major

  // Skin distance in a direction (need not be unit), bilinear.
  double radiusAt(const Vec3& direction) const;
};

// Signed distance (m, negative inside) from a point to the body in its rest pose, in the scalp's frame.
using BodyDistance = std::function<double(const Vec3&)>;

// Grows a hair mesh: hairline at forehead, temples, around the ears and nape; side parting; columns from the
// parting and crown outermost; ends cut along a smooth surface, the outer hair a little shorter. The coat lies on
// the head: from medium on it stands 3 to 8 mm over the scalp within 20 mm of the parting, and less than 18 mm at
// the crown; behind a fringe it stands up to 14 mm. Long hair divides over the shoulders: what is rooted before the
// ears falls in front of them, and no root face joins it to the rest. Bob and pixie have a fringe: hair of the front
// falls over the forehead to the brow. All but the roots keeps 2.5 mm off the body (on a head of 23 cm, and in
// proportion), 6 mm once the hair has left the scalp; edges are at least 3 mm. The resolutions are one haircut, meshed
// more or less finely, with the same topology on every head; the coarser ones stand off further, for their prisms would
// be inverted otherwise. Valid for any scalp: where a head leaves no room, the hair grows on a rounded one (see the
// source). Vertex counts: short 225 / 569 / 1,339 / 7,081, shoulder 360 / 913 / 2,306 / 9,617, long 368 / 902 / 2,257 /
// 9,997, bob 385 / 974 / 2,293 / 9,899, pixie 275 / 748 / 1,433 / 7,805; minimal 85 to 168. Columns of at most 8 or 16
// vertices where a plan can have them so, for whole vectors of the solver's kernels. Deterministic; under 0.5 s, ultra
// under 1.5 s.
//
// Shaved is the roots of short, each with 16 mm of hair of six vertices that stands off the scalp: what hairdos are
// grown from by hand.
sim::HairMeshShape makeStyle(Style style, Resolution resolution, const Scalp& scalp, const BodyDistance& body);

bool hasFringe(Style style);  // over the forehead

inline std::string_view styleName(Style style) {
  return kStyleNames[static_cast<std::size_t>(style)];
}
std::optional<Style> parseStyle(std::string_view name);
std::string_view resolutionName(Resolution resolution);  // "low", "medium", "high", "ultra"

}  // namespace app

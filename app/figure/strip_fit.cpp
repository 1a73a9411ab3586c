#include "app/figure/strip_fit.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "app/figure/hair_fit.h"
#include "app/figure/head_model.h"
#include "app/files/errors.h"
#include "app/files/polygon_file.h"

namespace app {

namespace {

constexpr double kTogether = 1.1;      // of the tips' spread: roots' ends lie no further apart
constexpr double kStandsNearer = 0.5;  // of the highest ends' distance from the head
constexpr double kOtherAxis = 0.6;     // of the distance with y up: z is up
constexpr double kNearerTip = 0.5;     // of the root's distance: the tip is the root

// What brought points from the one place to the other, turned, scaled and moved; at least four in no plane.
Eigen::Affine3d placeOf(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  const auto count = static_cast<Eigen::Index>(from.size());
  Eigen::Matrix3Xd before(3, count), after(3, count);
  for (Eigen::Index v = 0; v < count; ++v) {
    before.col(v) = from[static_cast<std::size_t>(v)];
    after.col(v) = to[static_cast<std::size_t>(v)];
  }
  return Eigen::Affine3d(Eigen::umeyama(before, after, true));
}

FittedStrips fitOnce(const PolygonMesh& mesh, const StripOptions& options, bool up_given, const std::string& file,
                     const Character& character, bool mend) {
  FittedStrips fitted;
  StripConversion& strips = fitted.conversion = convertStrips(mesh, options, file);
  const std::vector<Vec3> made = strips.mesh.shape.positions;
  fitted.fit = fitHair(character, mend, strips.mesh.shape, {.metres = true, .up = up_given ? options.up : '\0'},
                       strips.scalp_points, &fitted.as_made_distance);
  if (!fitted.fit.empty()) fitted.place = placeOf(made, strips.mesh.shape.positions);
  return fitted;
}

FittedStrips fitEitherUp(const PolygonMesh& mesh, const StripOptions& options, bool up_given, const std::string& file,
                         const Character& character, bool mend) {
  FittedStrips fitted = fitOnce(mesh, options, up_given, file, character, mend);
  if (!mend || up_given || isYUp(file) || fitted.fit.empty()) return fitted;
  StripOptions turned_options = options;
  turned_options.up = 'z';
  try {
    FittedStrips turned = fitOnce(mesh, turned_options, false, file, character, mend);
    const auto off = [&](const FittedStrips& one) { return rootDistance(one.conversion.mesh.shape, character.scalp); };
    return off(fitted) > 0.5 * kFarRoots && off(turned) < kOtherAxis * off(fitted) ? turned : fitted;
  } catch (const InputError&) {
    return fitted;  // no strips with z up
  }
}

// m, root mean square about their middle, of the columns' roots or tips.
double spreadOf(const sim::HairMeshShape& shape, bool tips) {
  Vec3 sum = Vec3::Zero();
  double square = 0;
  const double count = std::max(1, shape.columnCount());
  for (int c = 0; c < shape.columnCount(); ++c) {
    const Vec3& end = shape.positions[shape.column_first[c] + (tips ? shape.columnLength(c) - 1 : 0)];
    sum += end / count;
    square += end.squaredNorm() / count;
  }
  return std::sqrt(std::max(0.0, square - sum.squaredNorm()));
}

// Rooted at the lowest ends, where these fit and the highest as in `fitted` do not.
std::optional<FittedStrips> fitStanding(const PolygonMesh& mesh, StripOptions options, bool up_given,
                                        const std::string& file, const Character& character,
                                        const FittedStrips& fitted) {
  options.root = RootEdge::kLowest;
  try {
    FittedStrips standing = fitEitherUp(mesh, options, up_given, file, character, true);
    const sim::HairMeshShape& shape = standing.conversion.mesh.shape;
    const bool together = spreadOf(shape, false) < kTogether * spreadOf(shape, true);
    const bool nearer = farFromHead(fitted.conversion.mesh.shape, character)
                            ? !farFromHead(shape, character)
                            : standing.as_made_distance < kStandsNearer * fitted.as_made_distance;
    if (together && nearer) return standing;
  } catch (const InputError&) {
    // no strips with roots there
  }
  return std::nullopt;
}

// Single strips whose other end is on the head are rooted there, where fewer are rooted away from it then.
void turnSingle(const PolygonMesh& mesh, StripOptions options, bool up_given, const std::string& file,
                const Character& character, FittedStrips& fitted) {
  if (options.root != RootEdge::kAuto || options.other_end || !options.flipped.empty() ||
      farFromHead(fitted.conversion.mesh.shape, character))
    return;
  options.flipped = rootedAway(fitted.conversion.followed, character, fitted.place);
  if (options.flipped.empty() || 2 * options.flipped.size() > fitted.conversion.followed.size()) return;
  try {
    FittedStrips turned = fitEitherUp(mesh, options, up_given, file, character, true);
    if (rootedAway(turned.conversion.followed, character, turned.place).size() >= options.flipped.size()) return;
    turned.conversion.turned_by_head = true;
    for (FollowedStrip& strip : turned.conversion.followed) strip.unclear = strip.unclear && !strip.turned;
    fitted = std::move(turned);
  } catch (const InputError&) {
    // turned about it is no strip
  }
}

}  // namespace

std::vector<int> rootedAway(const std::vector<FollowedStrip>& strips, const Character& character,
                            const Eigen::Affine3d& place) {
  const HeadModel head = headModelOf(character);
  std::vector<int> numbers;
  for (const FollowedStrip& strip : strips) {
    const Vec3 root = place * middleOf(strip.rows.rows.front());
    const Vec3 tip = place * middleOf(strip.rows.rows.back()) - character.scalp.center;
    // Tips of long hair are near to the body, too, on shoulders and back.
    const double root_off = std::abs(head.distance(root.cast<float>())),
                 tip_off = std::abs(tip.norm() - character.scalp.radiusAt(tip));
    if (root_off > kAtScalp && tip_off < kAtScalp && tip_off < kNearerTip * root_off) numbers.push_back(strip.number);
  }
  return numbers;
}

FittedStrips fitStrips(const PolygonMesh& mesh, const StripOptions& options, bool up_given, const std::string& file,
                       const Character& character, bool mend) {
  FittedStrips fitted = fitEitherUp(mesh, options, up_given, file, character, mend);
  if (!mend || !fitted.conversion.scalp_points.empty()) return fitted;
  const bool far = fitted.as_made_distance > kFarRoots;
  if (far && options.root == RootEdge::kAuto) {
    std::optional<FittedStrips> standing = fitStanding(mesh, options, up_given, file, character, fitted);
    if (standing) return std::move(*standing);
  }
  turnSingle(mesh, options, up_given, file, character, fitted);
  if (far && farFromHead(fitted.conversion.mesh.shape, character))
    fitted.fit +=
        "; the file has no head that tells where its roots are: hairmesh-convert takes one by --scalp FILE, and the "
        "roots' ends by --root-edge lowest or --flip-strips";
  return fitted;
}

bool farFromHead(const sim::HairMeshShape& shape, const Character& character) {
  return rootDistance(shape, character.scalp) > 3 * kFarRoots;
}

}  // namespace app

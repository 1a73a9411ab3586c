#include "app/figure/hair_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <numbers>
#include <optional>
#include <vector>

#include "app/files/length_units.h"
#include "app/files/median.h"

namespace app {

namespace {

constexpr double kHead = 0.23;                               // m, the head that limits are given for
constexpr double kSmallestScale = 0.6, kLargestScale = 1.6;  // of another head's hair
constexpr double kCloser = 0.55;                             // of the limit: where size and place are fitted as well
constexpr double kMuchCloser = 0.25;                         // by size as well, than by place alone
constexpr double kSmallestSpread = 0.2;                      // of the roots over that of the scalp
// Hair hangs when its tips' mean way from the roots is so much of their mean length; then it points down within 70
// degrees.
constexpr double kHangs = 0.5, kDown = 0.34;
// Hair stands when its first thirds' mean direction is so long; then that points up within 41 degrees.
constexpr double kStands = 0.6, kSteep = 0.75;
constexpr double kFaceForward = 0.3, kFaceBelow = 0.1, kFaceCosts = 0.2;  // before the ears, below the brow; m
// Hair before the face itself: forward, beside and below, of its direction from the head's middle; m where all is. It
// is no fault of a fringe, whose roots spread less than those of a head of hair: so much of the scalp's radius, RMS.
constexpr double kBefore = 0.6, kBeside = 0.5, kBelowEyes = 0.0, kHiddenFaceCosts = 0.2, kWholeHead = 0.65;
constexpr std::size_t kMostLookedAt = 4000;            // vertices
constexpr double kOtherAxes = 0.005, kHeadShapes = 3;  // m; heads differ by so many limits
constexpr int kFitSteps = 20;
constexpr double kTurnedLeft = 0.3;  // of what is wrong with hair, that is left when it is turned about

struct Axes {
  const char* name;
  std::array<Vec3, 3> rows;  // x, y and z of the scalp's frame
};

const std::array<Axes, 4>& axesKnown() {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  static const std::array<Axes, 4> known{{{"y up", {x, y, z}},
                                          {"z up, facing -y", {x, z, -y}},
                                          {"z up, facing y", {-x, z, y}},
                                          {"y up, facing -z", {-x, y, -z}}}};
  return known;
}

// How a file's coordinates become the scalp's.
struct Reading {
  const LengthUnit* unit = &kLengthUnits[0];
  const Axes* axes = &axesKnown()[0];
  bool from_ground = false;  // the origin is the figure's, not the head joint
  Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();
  Vec3 shift = Vec3::Zero();
  Vec3 operator()(const Vec3& p) const { return linear * p + shift; }
};

std::vector<Vec3> rootsOf(const sim::HairMeshShape& shape) {
  std::vector<Vec3> roots;
  for (int c = 0; c < shape.columnCount(); ++c) roots.push_back(shape.positions[shape.column_first[c]]);
  return roots;
}

// Of hair as a whole, in its file's axes.
struct Ways {
  Vec3 hang = Vec3::Zero();  // the mean way from root to tip, over the mean length of these ways
  Vec3 rise = Vec3::Zero();  // the mean direction of the first thirds
};

Ways waysOf(const sim::HairMeshShape& shape) {
  Ways ways;
  double length = 0;
  for (int c = 0; c < shape.columnCount(); ++c) {
    const int root = shape.column_first[c], layers = shape.columnLength(c);
    const Vec3 way = shape.positions[root + layers - 1] - shape.positions[root];
    ways.hang += way;
    length += way.norm();
    ways.rise += (shape.positions[root + std::max(1, layers / 3)] - shape.positions[root]).stableNormalized();
  }
  ways.hang = length > 0 ? Vec3(ways.hang / length) : Vec3::Zero();
  ways.rise /= std::max(1, shape.columnCount());
  return ways;
}

Vec3 nearestOnScalp(const Vec3& p, const Scalp& scalp) {
  const Vec3 out = p - scalp.center;
  const double far = out.norm();
  return far < 1e-9 ? p : Vec3(scalp.center + scalp.radiusAt(out) / far * out);
}

// Share of the vertices, roots or not, that are before the face.
double beforeFace(const std::vector<Vec3>& vertices, const Reading& reading, const Scalp& scalp) {
  const std::size_t every = vertices.size() / kMostLookedAt + 1;
  double before = 0, count = 0;
  for (std::size_t v = 0; v < vertices.size(); v += every, ++count) {
    const Vec3 out = (reading(vertices[v]) - scalp.center).stableNormalized();
    before += out.z() > kBefore && std::abs(out.x()) < kBeside && out.y() < kBelowEyes ? 1 : 0;
  }
  return before / std::max(1.0, count);
}

double distanceOf(const std::vector<Vec3>& roots, const Reading& reading, const Scalp& scalp) {
  std::vector<double> gaps;
  for (const Vec3& root : roots) {
    const Vec3 p = reading(root);
    gaps.push_back((p - nearestOnScalp(p, scalp)).norm());
  }
  return median(std::move(gaps));
}

std::vector<Reading> readings(const Character& character, ToldPlace told) {
  const Rigid from_figure = scalpToWorld(character, restPose(character.skeleton)).inverse();
  std::vector<Reading> all;
  for (const bool from_ground : {false, true}) {
    for (const Axes& axes : axesKnown()) {
      if (told.up != 0 && axes.rows[1] != (told.up == 'z' ? Vec3::UnitZ() : Vec3::UnitY())) continue;
      for (const LengthUnit& unit : kLengthUnits) {
        if ((told.metres && &unit != &kLengthUnits[0]) || (told.axes && &axes != &axesKnown()[0])) continue;
        Reading reading{&unit, &axes, from_ground};
        for (int k = 0; k < 3; ++k) reading.linear.row(k) = unit.metres * axes.rows[static_cast<std::size_t>(k)];
        if (from_ground) {
          reading.linear = from_figure.linear() * reading.linear;
          reading.shift = from_figure.translation();
        }
        all.push_back(reading);
      }
    }
  }
  return all;
}

struct Cloud {
  Vec3 middle = Vec3::Zero();
  double spread = 0;  // m, root mean square about the middle
};

Cloud cloudOf(const std::vector<Vec3>& points) {
  Cloud cloud;
  const auto count = static_cast<double>(points.size());
  for (const Vec3& p : points) cloud.middle += p / count;
  for (const Vec3& p : points) cloud.spread += (p - cloud.middle).squaredNorm() / count;
  cloud.spread = std::sqrt(cloud.spread);
  return cloud;
}

// Where hair grows, roughly: the upper and back half of the scalp.
Cloud hairyScalp(const Scalp& scalp) {
  const Vec3 back = Vec3(0, 0.8, -0.6);
  std::vector<Vec3> points;
  constexpr int kRows = 24;
  for (int i = 1; i < kRows; ++i) {
    const double polar = i * std::numbers::pi / kRows;
    const int columns = std::max(1, static_cast<int>(2 * kRows * std::sin(polar)));
    for (int j = 0; j < columns; ++j) {
      const double azimuth = j * 2 * std::numbers::pi / columns;
      const Vec3 out(std::sin(polar) * std::sin(azimuth), std::cos(polar), std::sin(polar) * std::cos(azimuth));
      if (out.dot(back) > 0) points.push_back(scalp.center + scalp.radiusAt(out) * out);
    }
  }
  return cloudOf(points);
}

// m. `points` are brought to the scalp, `roots` are the hair's. Heads are nearly as round as they are the wrong way
// about, so hair also has to root above the middle and not on the face. A head of hair roots behind the middle in the
// mean and leaves the face free. Most files have y up and face z.
double misfit(const std::vector<Vec3>& points, const std::vector<Vec3>& roots, const std::vector<Vec3>& vertices,
              const Reading& reading, const Scalp& scalp) {
  double height = 0, forward = 0, on_face = 0;
  for (const Vec3& root : roots) {
    const Vec3 from_middle = reading(root) - scalp.center, out = from_middle.normalized();
    height += from_middle.y() / static_cast<double>(roots.size());
    forward += from_middle.z() / static_cast<double>(roots.size());
    on_face += out.z() > kFaceForward && out.y() < kFaceBelow ? 1 / static_cast<double>(roots.size()) : 0;
  }
  const double size = reading.linear.col(0).norm() / scalp.radiusAt(Vec3::UnitY());
  const bool whole = size * cloudOf(roots).spread > kWholeHead;
  return distanceOf(points, reading, scalp) + kFaceCosts * on_face +
         (whole ? kHiddenFaceCosts * beforeFace(vertices, reading, scalp) + std::max(0.0, forward) : 0) +
         std::max(0.0, -height) + (reading.axes == &axesKnown()[0] ? 0 : kOtherAxes);
}

// Whether hair read so is of a head's size, and hangs down if it hangs, or rises if it stands.
bool plausible(const std::vector<Vec3>& roots, const Ways& ways, const Reading& reading, const Scalp& scalp) {
  const double scale = reading.linear.col(0).norm();
  const double spread = scale * cloudOf(roots).spread / hairyScalp(scalp).spread;
  const Vec3 hang = reading.linear * ways.hang / scale, rise = reading.linear * ways.rise / scale;
  const bool stands = rise.norm() >= kStands && rise.y() >= kSteep * rise.norm();
  return spread >= kSmallestSpread && spread <= kLargestScale &&
         (stands || hang.norm() < kHangs || -hang.y() >= kDown * hang.norm());
}

// The shift and, where it is `sized`, the scale, without a turn, that bring the roots to the scalp: first over where
// hair grows, then by closest points again and again.
Reading broughtToScalp(const std::vector<Vec3>& roots, bool sized, Reading reading, const Scalp& scalp) {
  const auto rescale = [&](double asked, const Vec3& from, const Vec3& to) {
    const double scale = sized ? asked : 1;
    reading.linear *= scale;
    reading.shift = to + scale * (reading.shift - from);
  };
  std::vector<Vec3> read(roots.size()), on_scalp(roots.size());
  for (std::size_t i = 0; i < roots.size(); ++i) read[i] = reading(roots[i]);
  const Cloud hair = cloudOf(read), scalp_hair = hairyScalp(scalp);
  rescale(hair.spread > 0 ? scalp_hair.spread / hair.spread : 1, hair.middle, scalp_hair.middle);
  for (int step = 0; step < kFitSteps; ++step) {
    for (std::size_t i = 0; i < roots.size(); ++i) {
      read[i] = reading(roots[i]);
      on_scalp[i] = nearestOnScalp(read[i], scalp);
    }
    const Vec3 from = cloudOf(read).middle, to = cloudOf(on_scalp).middle;
    double along = 0, square = 0;
    for (std::size_t i = 0; i < roots.size(); ++i) {
      along += (read[i] - from).dot(on_scalp[i] - to);
      square += (read[i] - from).squaredNorm();
    }
    rescale(square > 0 ? along / square : 1, from, to);
  }
  return reading;
}

double scaleOf(const Reading& reading) {
  return reading.linear.col(0).norm() / reading.unit->metres;
}

// The readings that can be hair for another head, brought to this one: of that head's size, or sized to this one.
std::vector<Reading> forOtherHeads(const std::vector<Reading>& all, const std::vector<Vec3>& roots, const Ways& ways,
                                   bool sized, const Scalp& scalp) {
  std::vector<Reading> moved;
  for (const Reading& reading : all) {
    if (reading.from_ground) continue;  // the place is found anyway
    const Reading one = broughtToScalp(roots, sized, reading, scalp);
    const double scale = scaleOf(one);
    // A small patch of roots fits everywhere.
    const double spread = one.linear.col(0).norm() * cloudOf(roots).spread / hairyScalp(scalp).spread;
    if (std::min(scale, spread) >= kSmallestScale && scale <= kLargestScale && plausible(roots, ways, one, scalp))
      moved.push_back(one);
  }
  return moved;
}

// The reading of hair near the scalp that lies on it when it is turned about, and then leaves the face free.
std::optional<Reading> facingBack(const std::vector<Vec3>& roots, const std::vector<Vec3>& vertices,
                                  const Scalp& scalp) {
  Reading turned;
  turned.axes = &axesKnown()[3];
  for (int k = 0; k < 3; ++k) turned.linear.row(k) = turned.axes->rows[static_cast<std::size_t>(k)];
  const auto misfitOf = [&](const Reading& one) { return misfit(roots, roots, vertices, one, scalp); };
  const bool nearer = distanceOf(roots, turned, scalp) < distanceOf(roots, {}, scalp);
  return nearer && misfitOf(turned) < kTurnedLeft * misfitOf({}) ? std::optional(turned) : std::nullopt;
}

std::string length(double metres) {
  char text[32];
  if (metres < 0.1) {
    std::snprintf(text, sizeof text, "%.0f mm", 1e3 * metres);
  } else {
    std::snprintf(text, sizeof text, metres < 10 ? "%.2f m" : "%.0f m", metres);
  }
  return text;
}

std::string looksLike(const Reading& reading) {
  std::string text;
  const auto add = [&](const std::string& more) { text += (text.empty() ? "" : ", ") + more; };
  if (reading.unit != &kLengthUnits[0]) add(reading.unit->words);
  if (reading.axes != &axesKnown()[0]) add(reading.axes->name);
  if (reading.from_ground) add("the figure's origin");
  return text;
}

std::string anotherHeads(const Reading& reading) {
  char text[64] = "";
  if (std::abs(scaleOf(reading) - 1) > 1e-9) std::snprintf(text, sizeof text, "scaled by %.2f and ", scaleOf(reading));
  return "hair for another head, " + (text + ("moved by " + length(reading.shift.norm())));
}

}  // namespace

double rootDistance(const sim::HairMeshShape& shape, const Scalp& scalp) {
  return distanceOf(rootsOf(shape), Reading{}, scalp);
}

std::string fitHair(const Character& character, bool mend, sim::HairMeshShape& shape, ToldPlace told,
                    std::span<const Vec3> scalp_points, double* as_made_distance) {
  const Scalp& scalp = character.scalp;
  const std::vector<Vec3> hair_roots = rootsOf(shape);
  const double limit = kFarRoots * scalp.head_height / kHead, before = rootDistance(shape, scalp);
  if (as_made_distance != nullptr) *as_made_distance = before;
  if (hair_roots.empty()) return "";
  std::optional<Reading> about;
  if (before <= limit) {
    if (!told.axes && told.up != 'z') about = facingBack(hair_roots, shape.positions, scalp);
    if (!about) return "";
  }
  const Ways ways = scalp_points.empty() ? waysOf(shape) : Ways{};
  std::vector<Vec3> roots(scalp_points.begin(), scalp_points.end());
  if (roots.empty()) roots = hair_roots;
  const std::vector<Reading> all = readings(character, told);
  const auto best = [&](const std::vector<Reading>& of) {
    return std::min_element(of.begin(), of.end(), [&](const Reading& a, const Reading& b) {
      return misfit(roots, hair_roots, shape.positions, a, scalp) <
             misfit(roots, hair_roots, shape.positions, b, scalp);
    });
  };
  std::vector<Reading> as_made;
  std::ranges::copy_if(all, std::back_inserter(as_made),
                       [&](const Reading& reading) { return plausible(roots, ways, reading, scalp); });
  Reading found = about ? *about : as_made.empty() ? Reading{} : *best(as_made);
  std::string like = looksLike(found);
  if (as_made_distance != nullptr) *as_made_distance = as_made.empty() ? INFINITY : distanceOf(roots, found, scalp);
  if (!about && (as_made.empty() || distanceOf(roots, found, scalp) > limit)) {
    // A head of another shape is fitted somewhat better in another size: hair keeps its own unless that is much better.
    std::vector<Reading> moved = forOtherHeads(all, roots, ways, false, scalp);
    std::vector<Reading> sized = forOtherHeads(all, roots, ways, true, scalp);
    const auto off = [&](const std::vector<Reading>& of) {
      return of.empty() ? INFINITY : distanceOf(roots, *best(of), scalp);
    };
    const double close = scalp_points.empty() ? kCloser * limit : kHeadShapes * limit;
    // Size is no reason for other axes.
    if (off(moved) <= close) std::erase_if(sized, [&](const Reading& one) { return one.axes != best(moved)->axes; });
    if (off(moved) > close || off(sized) < kMuchCloser * off(moved)) moved = std::move(sized);
    if (moved.empty() || off(moved) > close)
      return "its roots are " + length(before) +
             " from the scalp, in no unit, axes or size that is known; it should be in metres, y up, about the head "
             "joint (assets/hair/README.md)";
    found = *best(moved);
    like = looksLike(found) + (looksLike(found).empty() ? "" : ", ") + anotherHeads(found);
  }
  const std::string far = "its roots are " + length(before) + " from the scalp";
  if (!mend) return far + "; it looks like " + like + ": --fit on reads it so";
  for (std::size_t v = 0; v < shape.groom_offsets.size(); ++v)
    shape.groom_offsets[v] = found(shape.positions[v] + shape.groom_offsets[v]) - found(shape.positions[v]);
  for (Vec3& p : shape.positions) p = found(p);
  return far + "; it looks like " + like + ", and is read so: now they are " + length(rootDistance(shape, scalp)) +
         " off (--fit off leaves it as it is)";
}

}  // namespace app

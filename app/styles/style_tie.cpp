// Hair is combed to the ring along circles on the sphere of directions from the head's middle. They part at one other
// direction, the source, where no hair grows, and so keep neighbours neighbours. A root's place in the ring is given by
// its way's length and azimuth there: the farther along its way, the higher over the scalp, for what comes from afar
// lies on what is rooted near.
#include "app/styles/style_tie.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "app/styles/ring_way.h"
#include "app/styles/style_comb.h"
#include "app/styles/style_untangle.h"
#include "app/styles/tie_ring.h"

namespace app {
namespace {

constexpr double kTieFatness = 0.05, kTieGap = 0.003;  // see untangle; m
constexpr double kFatEnough = 0.012;                   // with less a wider ring is tried
constexpr int kTieRounds = 12;                         // of untangling on
constexpr double kCoat = 0.010;                        // m over the scalp, half-way to the ring
constexpr double kStep = 0.01, kBend = 0.22;           // m; share of a step's heading that gravity takes
constexpr double kSwell = 1.35, kTaper = 0.7;  // of the ring's radius: the tail's where it is widest, at its end
constexpr double kShortestTail = 0.08;         // m
constexpr double kShortestBun = 15;            // in radii of the rope: about a turn and a half
constexpr double kBunLayer = 0.0042, kBunHeight = 0.03;  // m: of the stub, a layer and in all, at least
constexpr double kNarrowest = 0.004;                     // m, of a ring about hardly any hair
constexpr double kClose = 0.8;  // of the radius of the columns in a ring: its drawn strands', by eye
constexpr int kSectors = 24;
constexpr double kSeam = 0.003;      // m between roots on both sides of where hair divides
constexpr double kAlongside = 0.97;  // cosine between the ways that they leave the scalp

struct Path {
  std::vector<Vec3> at, across, up;  // the tail's middle every kStep, and its section
};

// The columns that one tie takes, and how they come to it.
struct Gathering {
  const HairTie& tie;
  const Scalp& scalp;
  const BodyDistance& body;
  Vec3 axis, e1, e2;                        // of the ring
  std::array<double, kSectors> farthest{};  // angle of the farthest root by azimuth

  Gathering(const HairTie& of, const Scalp& head, const BodyDistance& around) : tie(of), scalp(head), body(around) {
    axis = (tie.at - scalp.center).normalized();
    e1 = (std::abs(axis.y()) > 0.9 ? Vec3::UnitX() : Vec3::UnitY()).cross(axis).normalized();
    e2 = axis.cross(e1);
  }
  double angleOf(const Vec3& root) const {
    return RingWay((root - scalp.center).normalized(), axis, sourceOf(axis, tie.side)).length();
  }
  // Of the way's end.
  double azimuthOf(const Vec3& root) const {
    const Vec3 from = (root - scalp.center).normalized();
    const Vec3 d = (from - axis).cross(sourceOf(axis, tie.side) - axis).cross(axis);
    return std::atan2(d.dot(e2), d.dot(e1));
  }
  void addRoot(const Vec3& root);
  double farthestAt(double azimuth) const;
  Vec3 inSection(const Vec3& root, double radius, const Vec3& across, const Vec3& up) const;
  Vec3 onWay(const Vec3& root, double share) const;
  Path tail(double length) const;
  Path stub(double length) const;
};

// Each root counts in its own sector and, a little less, in those beside it, so that the ring is filled evenly.
void Gathering::addRoot(const Vec3& root) {
  const double angle = angleOf(root), turn = azimuthOf(root) / (2 * std::numbers::pi) + 1;
  const int sector = static_cast<int>(turn * kSectors) % kSectors;
  for (int off = -3; off <= 3; ++off) {
    double& far = farthest[static_cast<std::size_t>((sector + off + kSectors) % kSectors)];
    far = std::max(far, angle * (1 - 0.04 * std::abs(off)));
  }
}

double Gathering::farthestAt(double azimuth) const {
  const double turn = (azimuth / (2 * std::numbers::pi) + 1) * kSectors - 0.5;
  const int sector = static_cast<int>(std::floor(turn));
  const double share = turn - sector;
  const auto at = [&](int k) { return farthest[static_cast<std::size_t>((k + kSectors) % kSectors)]; };
  return (1 - share) * at(sector) + share * at(sector + 1);
}

// Where a root's hair lies in a round section of the tail, from its middle.
Vec3 Gathering::inSection(const Vec3& root, double radius, const Vec3& across, const Vec3& up) const {
  const double azimuth = azimuthOf(root);
  const double out = std::min(1.0, angleOf(root) / std::max(1e-6, farthestAt(azimuth)));
  return radius * out * (std::cos(azimuth) * across + std::sin(azimuth) * up);
}

// On the way from root to ring, `share` 0 to 1.
Vec3 Gathering::onWay(const Vec3& root, double share) const {
  const Vec3 goal = tie.at + inSection(root, tie.radius, e1, e2);
  const Vec3 to = (goal - scalp.center).normalized(), from = (root - scalp.center).normalized();
  if (share <= 0) return root;
  if (share >= 1) return goal;
  const Vec3 along = RingWay(from, to, sourceOf(to, tie.side)).at(share);
  const double here = (root - scalp.center).norm() - scalp.radiusAt(from);
  const double high = (goal - scalp.center).norm() - scalp.radiusAt(to);
  const double coat = 2 * kCoat * share;
  const double over = here * (1 - share) + coat * (1 - share * share) + high * share * share * share;
  return scalp.center + (scalp.radiusAt(along) + over) * along;
}

// Falls from the ring, stiff at first, around the body.
Path Gathering::tail(double length) const {
  Path path;
  Vec3 p = tie.at, heading = axis, across = e1;
  const int steps = static_cast<int>(std::ceil(length / kStep)) + 2;
  for (int k = 0; k < steps; ++k) {
    across = (across - across.dot(heading) * heading).normalized();
    path.at.push_back(p), path.across.push_back(across), path.up.push_back(heading.cross(across));
    heading = ((1 - kBend) * heading + kBend * Vec3(0, -1, 0)).normalized();
    p += kStep * heading;
    const double gap = kSwell * tie.radius + kTieGap, near = body(p);
    if (near >= gap || k < 3) continue;
    const Vec3 n = bodyNormal(body, p);
    p += (gap - near) * n;
    heading = (heading - std::min(0.0, heading.dot(n)) * n).normalized();
  }
  return path;
}

// Straight out of the ring.
Path Gathering::stub(double length) const {
  Path path;
  for (double way = 0; way < length + 2 * kStep; way += kStep) {
    path.at.push_back(tie.at + way * axis), path.across.push_back(e1), path.up.push_back(e2);
  }
  return path;
}

// Whether hair rooted in a direction from the head's middle can be combed to a ring there: its way is not across the
// face, nor so long that neighbours part to all sides of the head. Both unit.
bool comesTo(const Vec3& ring, int side, const Vec3& root) {
  constexpr double kFarthest = 3.0;               // rad, of a great circle
  constexpr double kBeside = 0.9, kAbove = 0.36;  // rad from the front; sine of the elevation: the face
  const RingWay way(root, ring, sourceOf(ring, side));
  if (way.great() && way.length() > kFarthest) return false;
  for (const double share : {0.25, 0.5, 0.75}) {
    const Vec3 along = way.at(share);
    if (std::abs(std::atan2(along.x(), along.z())) < kBeside && along.y() < kAbove) return false;
  }
  return true;
}

// The tie that takes a bundle; -1: none, kAcrossFace: none because of its way there.
constexpr int kAcrossFace = -2;
int tieOf(const sim::HairMeshShape& hair, const sim::RootFace& face, const Scalp& scalp,
          std::span<const HairTie> ties) {
  int tie = -1;
  Vec3 middle = Vec3::Zero();
  for (int k = 0; k < face.corner_count; ++k)
    middle += hair.positions[hair.column_first[face.columns[k]]] / face.corner_count;
  middle -= scalp.center;
  for (std::size_t t = 0; t < ties.size(); ++t) {
    const bool meant = (ties[t].side == 0 || ties[t].side * middle.x() > 0) && middle.y() > ties[t].above;
    if (meant) tie = kAcrossFace;
    const Vec3 ring = (ties[t].at - scalp.center).normalized();
    const auto comes = [&](int k) {
      return comesTo(ring, ties[t].side,
                     (hair.positions[hair.column_first[face.columns[k]]] - scalp.center).normalized());
    };
    bool all = meant;
    for (int k = 0; k < face.corner_count; ++k) all = all && comes(k);
    if (all) return static_cast<int>(t);
  }
  return tie;
}

// What one tie holds is one tail: columns on both sides of where hair divides over the shoulders become one, so that
// the tail does not come apart. At a parting hair leaves to both sides, and stays parted.
sim::HairMeshShape closedSeams(sim::HairMeshShape hair, const Scalp& scalp, std::span<const HairTie> ties) {
  constexpr int kNone = -3, kSeveral = -4;
  const auto count = static_cast<std::size_t>(hair.columnCount());
  std::vector<int> tie(count, kNone), nearest(count, -1);
  std::set<std::pair<int, int>> beside;  // columns of one face
  for (const sim::RootFace& face : hair.root_faces) {
    const int taken = std::max(-1, tieOf(hair, face, scalp, ties));
    for (int k = 0; k < face.corner_count; ++k) {
      int& of = tie[static_cast<std::size_t>(face.columns[k])];
      of = of == kNone || of == taken ? taken : kSeveral;
      for (int j = 0; j < face.corner_count; ++j) beside.insert({face.columns[k], face.columns[j]});
    }
  }
  const auto root = [&](std::size_t c) -> const Vec3& { return hair.positions[hair.column_first[c]]; };
  const auto alongside = [&](std::size_t a, std::size_t b) {
    const auto way = [&](std::size_t c) {
      return Vec3(hair.positions[hair.column_first[c] + 1] - root(c)).normalized();
    };
    return hair.columnLength(static_cast<int>(a)) > 1 && hair.columnLength(static_cast<int>(b)) > 1 &&
           way(a).dot(way(b)) > kAlongside;
  };
  for (std::size_t a = 0; a < count; ++a) {
    double least = kSeam;
    for (std::size_t b = 0; b < count; ++b) {
      const double apart = (root(a) - root(b)).norm();
      if (tie[a] >= 0 && tie[a] == tie[b] && apart < least && alongside(a, b) &&
          !beside.contains({static_cast<int>(a), static_cast<int>(b)}))
        least = apart, nearest[a] = static_cast<int>(b);
    }
  }
  const auto partner = [&](int column) {
    const int other = nearest[static_cast<std::size_t>(column)];
    if (other < 0 || nearest[static_cast<std::size_t>(other)] != column) return column;
    const int longer = hair.columnLength(other) - hair.columnLength(column);
    return longer > 0 || (longer == 0 && other < column) ? other : column;
  };
  for (sim::RootFace& face : hair.root_faces)
    for (int k = 0; k < face.corner_count; ++k) face.columns[k] = partner(face.columns[k]);
  return hair;
}

// The hair with its columns doubled where bundles of different ties meet; `of` says for each column which tie takes it.
// Columns stay in their order. A copy ends where the longest bundle of its tie does.
sim::HairMeshShape divided(const sim::HairMeshShape& hair, const Scalp& scalp, std::span<const HairTie> ties,
                           std::vector<int>& of) {
  sim::HairMeshShape out;
  std::map<std::pair<int, int>, int> copies;  // of (column, tie): first their layers, then their numbers
  std::vector<int> taken;
  for (const sim::RootFace& face : hair.root_faces) {
    taken.push_back(std::max(-1, tieOf(hair, face, scalp, ties)));
    for (int k = 0; k < face.corner_count; ++k) {
      int& layers = copies[{face.columns[k], taken.back()}];
      layers = std::max(layers, hair.bundleLayers(face));
    }
  }
  for (auto& [key, copy] : copies) {
    const auto [column, tie] = key;
    const auto first = hair.positions.begin() + hair.column_first[column];
    out.positions.insert(out.positions.end(), first, first + copy);
    copy = out.columnCount();
    of.push_back(tie);
    out.column_first.push_back(static_cast<int>(out.positions.size()));
  }
  for (std::size_t f = 0; f < hair.root_faces.size(); ++f) {
    sim::RootFace face = hair.root_faces[f];
    for (int k = 0; k < face.corner_count; ++k) face.columns[k] = copies[{face.columns[k], taken[f]}];
    out.root_faces.push_back(face);
  }
  return out;
}

double wayLength(const Gathering& gathering, const Vec3& root) {
  double length = 0;
  for (int k = 1; k <= 8; ++k) length += (gathering.onWay(root, k / 8.0) - gathering.onWay(root, (k - 1) / 8.0)).norm();
  return length;
}

double columnLength(const sim::HairMeshShape& hair, int column) {
  double length = 0;
  for (int v = hair.column_first[column] + 1; v < hair.column_first[column + 1]; ++v)
    length += (hair.positions[v] - hair.positions[v - 1]).norm();
  return length;
}

// The layer that lies in the ring: the same of all columns of a tie. `way`: share of the hair's length up to there;
// where it is most of it, few layers would cut through the head.
int ringLayer(int length, double way) {
  return std::clamp(std::max((2 * length) / 5, static_cast<int>(way * length)), 2, length - 2);
}

// `bound`: m, the radius of the tie before it was widened.
void gather(const HairTie& tie, double bound, int number, const Scalp& scalp, const BodyDistance& body,
            const std::vector<int>& of, TiedHair& tied) {
  sim::HairMeshShape& shape = tied.shape;
  Gathering gathering(tie, scalp, body);
  std::vector<int> columns;
  int shortest = 1 << 20, longest = 0;
  for (int c = 0; c < shape.columnCount(); ++c) {
    if (of[static_cast<std::size_t>(c)] != number || shape.columnLength(c) < 4) continue;
    columns.push_back(c);
    shortest = std::min(shortest, shape.columnLength(c));
    longest = std::max(longest, shape.columnLength(c));
    gathering.addRoot(shape.positions[shape.column_first[c]]);
  }
  if (columns.empty()) return;
  double left = 0, way = 0;
  for (const int c : columns) {
    const double to_ring = wayLength(gathering, shape.positions[shape.column_first[c]]);
    way += to_ring / columns.size();
    left += (columnLength(shape, c) - to_ring) / columns.size();
  }
  tied.left[static_cast<std::size_t>(number)] = std::max(0.0, left);
  left = std::max(left, kShortestTail);
  const bool wound = tie.bun && left >= shortestBun(bound);
  tied.wound[static_cast<std::size_t>(number)] = wound;
  const int ring = ringLayer(shortest, way / (way + left));
  if (wound) left = std::max(kBunHeight, kBunLayer * (longest - 1 - ring));
  const Path path = wound ? gathering.stub(left) : gathering.tail(left);
  const double swell = wound ? 1 : kSwell;
  for (const int c : columns) {
    const int first = shape.column_first[c], count = shape.columnLength(c);
    const Vec3 root = shape.positions[first];
    for (int l = 1; l < count; ++l) {
      if (l <= ring) {
        shape.positions[first + l] = gathering.onWay(root, static_cast<double>(l) / ring);
        continue;
      }
      const double share = static_cast<double>(l - ring) / (count - 1 - ring);
      const double place = share * left / kStep;
      const auto k = std::min(static_cast<std::size_t>(place), path.at.size() - 2);
      const double t = place - static_cast<double>(k);
      const double width = share < 0.3 ? 1 + (swell - 1) * share / 0.3 : swell + (kTaper - swell) * (share - 0.3) / 0.7;
      const Vec3 across = ((1 - t) * path.across[k] + t * path.across[k + 1]).normalized();
      const Vec3 up = ((1 - t) * path.up[k] + t * path.up[k + 1]).normalized();
      shape.positions[first + l] =
          (1 - t) * path.at[k] + t * path.at[k + 1] + gathering.inSection(root, width * tie.radius, across, up);
    }
    tied.rings[static_cast<std::size_t>(number)].push_back(first + ring);
  }
}

double leastFatness(const sim::HairMeshShape& shape) {
  double least = 1;
  for (const sim::RootFace& face : shape.root_faces) {
    const int n = face.corner_count;
    for (int l = 0; l + 1 < shape.bundleLayers(face); ++l) {
      for (int k = 0; k < 2 * n; ++k) {
        std::array<Vec3, 4> p;
        const std::array<int, 4> corner = sim::cornerTetOf(k, n);
        for (std::size_t i = 0; i < 4; ++i)
          p[i] = shape.positions[shape.column_first[face.columns[corner[i] % n]] + l + corner[i] / n];
        least = std::min(least, cornerFatness(p[0], p[1], p[2], p[3]));
      }
    }
  }
  return least;
}

// Hair as it was combed, and as it is untangled.
struct Untangled {
  std::vector<Vec3> combed;
  TiedHair tied;
};

// Up to the ring offsets lead back to where the hair was combed.
TiedHair withOffsets(Untangled hair) {
  auto& [combed, tied] = hair;
  sim::HairMeshShape& shape = tied.shape;
  shape.groom_offsets.assign(shape.positions.size(), Vec3::Zero());
  for (const std::vector<int>& ring : tied.rings) {
    for (const int end : ring) {
      const int first = *std::prev(std::ranges::upper_bound(shape.column_first, end));
      for (int v = first + 1; v < end; ++v)
        shape.groom_offsets[static_cast<std::size_t>(v)] =
            combed[static_cast<std::size_t>(v)] - shape.positions[static_cast<std::size_t>(v)];
    }
  }
  return std::move(tied);
}

}  // namespace

double shortestBun(double radius) {
  return kShortestBun * ropeRadius(radius);
}

// Where a narrow ring leaves prisms inverted, the hair at rest is gathered to a wider one, and held by the narrow one.
// Where none is enough, all are untangled on from where they have come to until one is: fine hair meshes need it.
TiedHair tieHair(const sim::HairMeshShape& hair, const Scalp& scalp, const BodyDistance& body,
                 std::span<const HairTie> ties, Seams seams) {
  std::vector<int> of;
  const sim::HairMeshShape parted =
      divided(seams == Seams::kClosed ? closedSeams(hair, scalp, ties) : hair, scalp, ties, of);
  const auto acrossFace = [&](const sim::RootFace& face) { return tieOf(hair, face, scalp, ties) == kAcrossFace; };
  const auto loose = static_cast<int>(std::ranges::count_if(hair.root_faces, acrossFace));
  std::vector<Untangled> tries;
  const auto attempt = [&](double wider) {
    auto& [combed, tied] = tries.emplace_back();
    tied = {parted, std::vector<std::vector<int>>(ties.size()), std::vector<double>(ties.size(), 0.0),
            std::vector<bool>(ties.size(), false), loose};
    for (std::size_t t = 0; t < ties.size(); ++t) {
      HairTie tie = ties[t];
      tie.radius *= wider;
      gather(tie, ties[t].radius, static_cast<int>(t), scalp, body, of, tied);
    }
    combed = tied.shape.positions;
    untangle(body, kTieFatness, kTieGap, tied.shape);
    return leastFatness(tied.shape) > kFatEnough;
  };
  for (const double wider : {1.2, 1.7, 2.4}) {
    if (attempt(wider)) return withOffsets(std::move(tries.back()));
  }
  for (int round = 0; round < kTieRounds; ++round) {
    for (Untangled& one : tries) {
      untangle(body, kTieFatness, kTieGap, one.tied.shape);
      if (leastFatness(one.tied.shape) > kFatEnough) return withOffsets(std::move(one));
    }
  }
  for (const double wider : {3.4, 4.8, 6.8}) {
    if (attempt(wider)) return withOffsets(std::move(tries.back()));
  }
  const auto thinner = [](const Untangled& a, const Untangled& b) {
    return leastFatness(a.tied.shape) < leastFatness(b.tied.shape);
  };
  return withOffsets(std::move(*std::ranges::max_element(tries, thinner)));
}

double shortOfRing(const sim::HairMeshShape& hair, const Scalp& scalp, std::span<const HairTie> ties) {
  std::vector<int> of;
  const sim::HairMeshShape parted = divided(hair, scalp, ties, of);
  const BodyDistance none;
  std::vector<Gathering> gatherings;
  for (const HairTie& tie : ties) gatherings.emplace_back(tie, scalp, none);
  const auto root = [&](std::size_t c) { return parted.positions[parted.column_first[c]]; };
  for (std::size_t c = 0; c < of.size(); ++c)
    if (of[c] >= 0) gatherings[static_cast<std::size_t>(of[c])].addRoot(root(c));
  double most = 0;
  for (std::size_t c = 0; c < of.size(); ++c) {
    if (of[c] < 0) continue;
    const double way = wayLength(gatherings[static_cast<std::size_t>(of[c])], root(c));
    most = std::max(most, way - columnLength(parted, static_cast<int>(c)));
  }
  return most;
}

std::vector<Vec3> ringPlaces(const sim::HairMeshShape& tied, const Scalp& scalp, std::span<const HairTie> ties,
                             std::span<const int> ring) {
  const BodyDistance none;
  std::vector<Gathering> gatherings;
  for (const HairTie& tie : ties) gatherings.emplace_back(tie, scalp, none);
  const auto rootOf = [&](int vertex) {
    const auto after = std::upper_bound(tied.column_first.begin(), tied.column_first.end(), vertex);
    return tied.positions[*std::prev(after)];
  };
  const auto nearest = [&](int vertex) -> Gathering& {
    return *std::min_element(gatherings.begin(), gatherings.end(), [&](const Gathering& a, const Gathering& b) {
      const Vec3& p = tied.positions[vertex];
      return (a.tie.at - p).norm() < (b.tie.at - p).norm();
    });
  };
  for (const int vertex : ring) nearest(vertex).addRoot(rootOf(vertex));
  std::vector<Vec3> places;
  for (const int vertex : ring) places.push_back(nearest(vertex).onWay(rootOf(vertex), 1));
  return places;
}

HairTie fittedRing(const HairTie& tie, const Scalp& scalp, std::span<const Vec3> places) {
  if (places.empty()) return tie;
  const Vec3 axis = (tie.at - scalp.center).normalized();
  const auto inPlane = [&](const Vec3& p) { return Vec3(p - axis.dot(p - tie.at) * axis); };
  const auto count = static_cast<double>(places.size());
  HairTie fitted = tie;
  fitted.at.setZero();
  for (const Vec3& p : places) fitted.at += inPlane(p) / count;
  double square = 0;
  for (const Vec3& p : places) square += (inPlane(p) - fitted.at).squaredNorm() / count;
  // The mean square in an evenly filled disc is half of its radius squared.
  fitted.radius = std::clamp(kClose * std::sqrt(2 * square), kNarrowest, tie.radius);
  return fitted;
}

}  // namespace app

#include "app/groom/edit/shape_brush.h"

#include <algorithm>
#include <cmath>

#include "sim/mesh/rest_measures.h"

namespace app {

namespace {

constexpr double kPuff = 0.004, kGrow = 0.03;   // m, share of the length: of one sample at full strength
constexpr double kGrownAs = 0.1;                // m, what shorter hair grows like
constexpr double kPinch = 0.08, kTwist = 0.10;  // share of the way to the middle; rad: of one sample at full strength
constexpr double kMinVolume = 0.02;             // of the mean corner volume
constexpr double kMinEdge = 0.001;              // m
constexpr double kOffBody = 0.002;              // m, or as near as it is
constexpr int kHalvings = 8, kStrokeUntanglings = 24;  // of a stroke that goes too far, before what it spoils stays
constexpr double kMoved = 1e-7;                        // m
constexpr double kBend = 2;  // radii along the hair over which a move goes from nothing to all of its way

Brush onOtherSide(Brush brush) {
  brush.at = mirrored(brush.at, *brush.mirror);
  brush.along.x() = -brush.along.x();
  return brush;
}

double columnLength(std::span<const Vec3> x, int first, int last) {
  double length = 0;
  for (int v = first + 1; v < last; ++v) length += (x[v] - x[v - 1]).norm();
  return length;
}

}  // namespace

double brushReach(const Brush& brush, const Vec3& seen) {
  const double share = (seen - brush.at).squaredNorm() / (brush.radius * brush.radius);
  return share < 1 ? std::pow(1 - share, brush.falloff) : 0;
}

ShapeBrushes::ShapeBrushes(const sim::HairMesh& mesh) {
  std::vector<std::vector<int>> of(mesh.vertexCount());
  for (const auto* edges : {&mesh.horizontal_edges, &mesh.vertical_edges}) {
    for (const sim::Edge& edge : *edges) {
      of[edge.a].push_back(edge.b);
      of[edge.b].push_back(edge.a);
    }
  }
  neighbour_first_ = {0};
  for (const std::vector<int>& list : of) {
    neighbours_.insert(neighbours_.end(), list.begin(), list.end());
    neighbour_first_.push_back(static_cast<int>(neighbours_.size()));
  }
  weight_.resize(of.size()), share_.resize(of.size()), wanted_.resize(of.size()), touched_.resize(of.size()),
      went_.resize(of.size());
}

void ShapeBrushes::reach(const Brush& brush, const sim::HairMesh& mesh, std::span<const Vec3> seen) {
  for (std::size_t v = 0; v < weight_.size(); ++v)
    weight_[v] = mesh.isRoot(static_cast<int>(v)) ? 0 : brush.strength * brushReach(brush, seen[v]);
  for (std::size_t v = 0; v < brush.frozen.size(); ++v) weight_[v] *= 1 - brush.frozen[v];
}

void ShapeBrushes::comb(const Brush&, const Vec3& along) {
  for (std::size_t v = 0; v < wanted_.size(); ++v) wanted_[v] += weight_[v] * along;
}

void ShapeBrushes::smooth(const sim::HairMesh& mesh) {
  const std::vector<Vec3>& x = mesh.shape.positions;
  for (std::size_t v = 0; v < wanted_.size(); ++v) {
    const int first = neighbour_first_[v], last = neighbour_first_[v + 1];
    if (weight_[v] == 0 || last == first) continue;
    Vec3 mean = Vec3::Zero();
    for (int k = first; k < last; ++k) mean += x[neighbours_[k]];
    wanted_[v] += 0.5 * weight_[v] * (mean / (last - first) - x[v]);
  }
}

void ShapeBrushes::puff(const Brush& brush, const sim::HairMesh& mesh) {
  const std::vector<Vec3>& x = mesh.shape.positions;
  for (std::size_t v = 0; v < wanted_.size(); ++v) {
    Vec3 out = x[v] - brush.centre;
    out.y() = std::max(0.0, out.y());  // below the head's middle: level
    if (weight_[v] > 0 && out.norm() > 1e-6) wanted_[v] += kPuff * weight_[v] * out.normalized();
  }
}

void ShapeBrushes::push(const sim::HairMesh& mesh, const std::function<double(const Vec3&)>& body) {
  constexpr double kAside = 0.003;  // m, of the differences that give the normal
  for (std::size_t v = 0; body && v < wanted_.size(); ++v) {
    if (weight_[v] == 0) continue;
    const Vec3& x = mesh.shape.positions[v];
    Vec3 out;
    for (int axis = 0; axis < 3; ++axis)
      out[axis] = body(x + kAside * Vec3::Unit(axis)) - body(x - kAside * Vec3::Unit(axis));
    if (out.norm() > 1e-9) wanted_[v] += kPuff * weight_[v] * out.normalized();
  }
}

// Pinching, spreading and twisting: about a line along the hair through the middle of what is reached.
void ShapeBrushes::aboutHair(BrushTool tool, const sim::HairMesh& mesh) {
  const std::vector<Vec3>& x = mesh.shape.positions;
  Vec3 middle = Vec3::Zero(), along = Vec3::Zero();
  double sum = 0;
  for (std::size_t v = 0; v < x.size(); ++v) {
    if (weight_[v] == 0) continue;
    sum += weight_[v], middle += weight_[v] * x[v], along += weight_[v] * (x[v] - x[v - 1]);
  }
  if (sum == 0 || along.norm() < 1e-9) return;
  middle /= sum, along.normalize();
  for (std::size_t v = 0; v < x.size(); ++v) {
    if (weight_[v] == 0) continue;
    const Vec3 off = x[v] - middle, across = off - off.dot(along) * along;
    if (tool == BrushTool::kTwist) {
      const double turn = kTwist * weight_[v];
      wanted_[v] += std::sin(turn) * along.cross(across) - (1 - std::cos(turn)) * across;
    } else {
      wanted_[v] += (tool == BrushTool::kPinch ? -kPinch : kPinch) * weight_[v] * across;
    }
  }
}

// Cutting and growing: the column's length changes, by the most that the brush reaches of it.
void ShapeBrushes::scaleColumns(const Brush& brush, const sim::HairMesh& mesh, std::span<const Vec3> seen) {
  const std::vector<Vec3>& x = mesh.shape.positions;
  for (int c = 0; c < mesh.columnCount(); ++c) {
    const int first = mesh.shape.column_first[c], last = mesh.shape.column_first[c + 1];
    int nearest = first;
    for (int v = first + 1; v < last; ++v) {
      if (weight_[v] > weight_[nearest]) nearest = v;
    }
    const double weight = weight_[nearest];
    if (nearest == first || weight == 0) continue;
    const double length = columnLength(x, first, last);
    const double counts = brush.lengths.empty() ? length : brush.lengths[static_cast<std::size_t>(c)];
    double wanted = length + kGrow * weight * std::max(length, kGrownAs);
    if (brush.tool == BrushTool::kCut) {
      // Where along the column the brush is: its nearest vertex, and the way from there along the hair as seen.
      double at = columnLength(x, first, nearest + 1);
      if (nearest + 1 < last || nearest > first) {
        const int below = nearest + 1 < last ? nearest : nearest - 1;
        const Vec3 way = seen[below + 1] - seen[below];
        at += std::clamp((brush.at - seen[nearest]).dot(way) / std::max(1e-9, way.norm()), -0.5 * way.norm(),
                         0.5 * way.norm());
      }
      wanted = counts - weight * std::max(0.0, counts - at);
    }
    const double shortest = std::min(length, brush.shortest), longest = std::max(length, brush.longest);
    double& asked = asked_[static_cast<std::size_t>(c)];
    asked = std::min(asked, std::clamp(wanted, shortest, longest));
    const double scale = asked / length;
    if (scale == 1) continue;
    // Hair keeps its curve: each vertex comes nearer the root along the old one, or goes on along it and beyond its
    // tip.
    double passed = 0;
    int segment = first;
    double before = 0, along = (x[first + 1] - x[first]).norm();
    for (int v = first + 1; v < last; ++v) {
      passed += (x[v] - x[v - 1]).norm();
      const double place = scale * passed;
      while (segment + 2 < last && before + along < place) {
        before += along;
        ++segment;
        along = (x[segment + 1] - x[segment]).norm();
      }
      wanted_[v] = x[segment] + (place - before) / along * (x[segment + 1] - x[segment]);
    }
  }
}

// From the root on, each segment as long as it was.
void ShapeBrushes::keepLengths(const sim::HairMesh& mesh) {
  const std::vector<Vec3>& x = mesh.shape.positions;
  for (int c = 0; c < mesh.columnCount(); ++c) {
    const int first = mesh.shape.column_first[c], last = mesh.shape.column_first[c + 1];
    for (int v = first + 1; v < last; ++v) {
      const Vec3 way = wanted_[v] - wanted_[v - 1];
      if (wanted_[v] == x[v] && wanted_[v - 1] == x[v - 1]) continue;
      wanted_[v] = wanted_[v - 1] + (x[v] - x[v - 1]).norm() / std::max(1e-9, way.norm()) * way;
    }
  }
}

// Each vertex goes as far of its way as leaves what hangs on it valid.
namespace {

// The least that a brush may leave of a measure. Below the bound it may halve what there is, down to a twentieth of the
// bound.
double atLeast(double bound, double present) {
  return std::min({bound, std::max(0.5 * present, 0.05 * bound), present});
}

}  // namespace

// Hair around what had to stay stays with it: along an edge the share of the way grows by its length over `spread` (m).
void ShapeBrushes::holdBack(const sim::HairMesh& mesh, double spread) {
  const std::vector<Vec3>& x = mesh.shape.positions;
  std::vector<std::size_t> held;
  for (std::size_t v = 0; v < x.size(); ++v) {
    if (touched_[v]) held.push_back(v);
  }
  for (std::size_t next = 0; next < held.size(); ++next) {
    const std::size_t v = held[next];
    for (int k = neighbour_first_[v]; k < neighbour_first_[v + 1]; ++k) {
      const auto u = static_cast<std::size_t>(neighbours_[static_cast<std::size_t>(k)]);
      const double most = share_[v] + (x[u] - x[v]).norm() / spread;
      if (share_[u] > most) share_[u] = most, held.push_back(u);
    }
  }
}

namespace {

// Those with an end in `touched`.
std::vector<const sim::Edge*> edgesAt(const std::vector<unsigned char>& touched, const sim::HairMesh& mesh) {
  std::vector<const sim::Edge*> found;
  for (const auto* edges : {&mesh.horizontal_edges, &mesh.vertical_edges}) {
    for (const sim::Edge& edge : *edges) {
      if (touched[edge.a] || touched[edge.b]) found.push_back(&edge);
    }
  }
  return found;
}

}  // namespace

void ShapeBrushes::limit(double spread, const sim::HairMesh& mesh, const std::function<double(const Vec3&)>& body,
                         std::vector<Vec3>& positions) {
  const std::vector<Vec3>& x = mesh.shape.positions;
  const std::size_t n = x.size();
  for (std::size_t v = 0; v < n; ++v) {
    touched_[v] = (wanted_[v] - x[v]).squaredNorm() > kMoved * kMoved;
    share_[v] = touched_[v];
  }
  tets_.clear();
  spoilt_.fill(0);
  double sum = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    sum += mesh.tets[t].rest_volume;
    if (std::ranges::any_of(mesh.tets[t].v, [&](int v) { return touched_[v]; })) tets_.push_back(static_cast<int>(t));
  }
  const double mean = sum / static_cast<double>(mesh.tets.size());
  const std::vector<const sim::Edge*> near = edgesAt(touched_, mesh);
  std::vector<unsigned char> moves = touched_;
  bool valid = false;
  for (int round = 0; round < kStrokeUntanglings && !valid; ++round) {
    for (std::size_t v = 0; v < n; ++v) {
      if (moves[v]) positions[v] = x[v] + share_[v] * (wanted_[v] - x[v]);
    }
    valid = true;
    std::fill(touched_.begin(), touched_.end(), 0);
    const auto changed = [&](int v) { return moves[v] != 0; };
    const auto spoilt = [&](int v, HeldBy by) {
      valid = false;
      touched_[v] = 1;
      ++spoilt_[static_cast<std::size_t>(by)];
    };
    // What was found fine and has not changed is fine.
    for (const int t : tets_) {
      const sim::CornerTet& tet = mesh.tets[t];
      if (std::ranges::none_of(tet.v, changed)) continue;
      const bool fine = sim::cornerVolume(tet.v, positions) >= atLeast(kMinVolume * mean, tet.rest_volume);
      for (const int v : tet.v) {
        if (!fine) spoilt(v, HeldBy::kPrism);
      }
    }
    for (const sim::Edge* edge : near) {
      if (!changed(edge->a) && !changed(edge->b)) continue;
      const double length = (positions[edge->a] - positions[edge->b]).norm();
      if (length < atLeast(kMinEdge, edge->rest_length)) spoilt(edge->a, HeldBy::kEdge), spoilt(edge->b, HeldBy::kEdge);
    }
    for (std::size_t v = 0; body && v < n; ++v) {
      if (!moves[v] || share_[v] == 0) continue;
      const double distance = body(positions[v]);
      if (distance < kOffBody && distance < body(x[v])) spoilt(static_cast<int>(v), HeldBy::kBody);
    }
    std::copy(share_.begin(), share_.end(), went_.begin());
    for (std::size_t v = 0; v < n; ++v) {
      if (touched_[v]) share_[v] = round < kHalvings ? 0.5 * share_[v] : 0;
    }
    if (spread > 0) holdBack(mesh, spread);
    for (std::size_t v = 0; v < n; ++v) moves[v] = share_[v] != went_[v];
  }
  if (!valid) positions.assign(x.begin(), x.end());
}

int ShapeBrushes::apply(const Brush& brush, const sim::HairMesh& mesh, std::span<const Vec3> seen,
                        const std::function<double(const Vec3&)>& body, std::vector<Vec3>& positions) {
  const std::vector<Vec3>& x = mesh.shape.positions;
  wanted_.assign(x.begin(), x.end());
  asked_.assign(static_cast<std::size_t>(mesh.columnCount()), INFINITY);
  for (const bool other : {false, true}) {
    if (other && !brush.mirror) break;
    const Brush here = other ? onOtherSide(brush) : brush;
    reach(here, mesh, seen);
    switch (brush.tool) {
      case BrushTool::kComb:
        comb(here, here.along);
        break;
      case BrushTool::kSmooth:
        smooth(mesh);
        break;
      case BrushTool::kPuff:
        puff(here, mesh);
        break;
      case BrushTool::kPush:
        push(mesh, body);
        break;
      case BrushTool::kPinch:
      case BrushTool::kSpread:
      case BrushTool::kTwist:
        aboutHair(brush.tool, mesh);
        break;
      case BrushTool::kFreeze:
      case BrushTool::kThaw:
        break;
      case BrushTool::kCut:
      case BrushTool::kGrow:
        scaleColumns(here, mesh, seen);
        break;
    }
  }
  const bool scales = brush.tool == BrushTool::kCut || brush.tool == BrushTool::kGrow;
  if (!scales) keepLengths(mesh);
  return finish(0, mesh, body, positions);
}

int ShapeBrushes::finish(double spread, const sim::HairMesh& mesh, const std::function<double(const Vec3&)>& body,
                         std::vector<Vec3>& positions) {
  const std::vector<Vec3>& x = mesh.shape.positions;
  positions.assign(x.begin(), x.end());
  limit(spread, mesh, body, positions);
  int moved = 0;
  for (std::size_t v = 0; v < x.size(); ++v) moved += (positions[v] - x[v]).squaredNorm() > kMoved * kMoved;
  return moved;
}

std::vector<double> reachAround(std::span<const int> led, std::span<const Vec3> seen, double radius, double falloff) {
  std::vector<double> reach(seen.size(), 0);
  Brush brush;
  brush.radius = radius, brush.falloff = falloff;
  for (std::size_t v = 0; v < seen.size() && radius > 0; ++v) {
    double least = INFINITY;
    for (const int l : led) {
      const double apart = (seen[v] - seen[static_cast<std::size_t>(l)]).squaredNorm();
      if (apart < least) least = apart, brush.at = seen[static_cast<std::size_t>(l)];
    }
    if (least < radius * radius) reach[v] = brushReach(brush, seen[v]);
  }
  for (const int l : led) reach[static_cast<std::size_t>(l)] = 1;
  return reach;
}

int likeAcross(int vertex, double plane, const sim::HairMesh& mesh) {
  const std::vector<Vec3>& x = mesh.shape.positions;
  const Vec3 place = mirrored(x[static_cast<std::size_t>(vertex)], plane);
  int nearest = -1;
  double least = INFINITY;
  for (int u = 0; u < mesh.vertexCount(); ++u) {
    if (mesh.layer_of[static_cast<std::size_t>(u)] != mesh.layer_of[static_cast<std::size_t>(vertex)]) continue;
    const double apart = (x[static_cast<std::size_t>(u)] - place).squaredNorm();
    if (apart < least) least = apart, nearest = u;
  }
  return nearest;
}

namespace {

// The likes of the vertices that are led, each once.
std::vector<int> acrossMirror(const HairMove& move, const sim::HairMesh& mesh) {
  std::vector<int> across;
  for (const int v : move.vertices) {
    const int like = likeAcross(v, *move.mirror, mesh);
    if (std::ranges::find(across, like) == across.end()) across.push_back(like);
  }
  return across;
}

}  // namespace

int ShapeBrushes::move(const HairMove& move, const sim::HairMesh& mesh, std::span<const Vec3> seen,
                       const std::function<double(const Vec3&)>& body, std::vector<Vec3>& positions) {
  const std::vector<Vec3>& x = mesh.shape.positions;
  wanted_.assign(x.begin(), x.end());
  const std::vector<double> here = reachAround(move.vertices, seen, move.radius, move.falloff);
  std::vector<double> there;
  if (move.mirror) there = reachAround(acrossMirror(move, mesh), seen, move.radius, move.falloff);
  const Vec3 other(-move.along.x(), move.along.y(), move.along.z());
  const double spread = kBend * move.radius;
  double from_root = 0;  // m, along the column
  for (std::size_t v = 0; v < x.size(); ++v) {
    from_root = mesh.isRoot(static_cast<int>(v)) ? 0 : from_root + (x[v] - x[v - 1]).norm();
    if (from_root == 0) continue;
    const double share = move.bends && from_root < spread ? from_root / spread : 1;
    const double a = here[v], b = there.empty() ? 0 : there[v];
    const double thawed = move.frozen.empty() ? 1 : 1 - static_cast<double>(move.frozen[v]);
    const double free = thawed * share * share * (3 - 2 * share);
    // What both sides lead goes between the two ways.
    if (a > 0 || b > 0) wanted_[v] += free / std::max(1.0, a + b) * (a * move.along + b * other);
  }
  const int moved = finish(spread, mesh, body, positions);
  held_by_ = HeldBy::kNothing;
  for (const int v : move.vertices) {
    const auto led = static_cast<std::size_t>(v);
    if (!move.frozen.empty() && move.frozen[led] > 0) ++spoilt_[static_cast<std::size_t>(HeldBy::kFrozen)];
    if (!move.bends && (x[led] + move.along - positions[led]).norm() <= kMoved) return moved;
    if (move.bends && (wanted_[led] - positions[led]).norm() <= kMoved) return moved;
  }
  const auto most = std::ranges::max_element(spoilt_);
  if (*most > 0) held_by_ = static_cast<HeldBy>(most - spoilt_.begin());
  return moved;
}

}  // namespace app

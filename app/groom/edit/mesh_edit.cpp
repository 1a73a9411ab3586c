#include "app/groom/edit/mesh_edit.h"

#include <algorithm>
#include <cmath>

#include "app/files/errors.h"
#include "app/styles/style_comb.h"
#include "app/styles/style_untangle.h"
#include "render/strands/layer_curve.h"

namespace app {

bool isValid(const sim::HairMeshShape& shape) {
  try {
    sim::buildHairMesh(shape);
    return true;
  } catch (const sim::MeshError&) {
    return false;
  }
}

namespace {

constexpr double kClear = 0.002;                        // m off the body, or as near as the hair was
constexpr int kCurvePoints = 6;                         // a segment, of the curves that are compared
constexpr int kReachOfLayer = 3;                        // layers beyond which a curve does not follow a vertex
constexpr std::array kSlideShares{0.0, 0.1, 0.2, 0.3};  // layers, towards the one that is taken away
constexpr double kFat = 0.02;                           // see untangle
constexpr int kUntanglings = 4;
constexpr double kMaxPasses = 16;                              // over the tips
constexpr std::array kChordShares{0.0, 0.25, 0.5, 0.75, 1.0};  // share of the chord in place of the curve

int longestColumn(const sim::HairMeshShape& shape) {
  int most = 0;
  for (int c = 0; c < shape.columnCount(); ++c) most = std::max(most, shape.columnLength(c));
  return most;
}

std::span<const Vec3> columnOf(const sim::HairMeshShape& shape, int column) {
  return std::span(shape.positions)
      .subspan(static_cast<std::size_t>(shape.column_first[static_cast<std::size_t>(column)]),
               static_cast<std::size_t>(shape.columnLength(column)));
}

double distanceToLine(const Vec3& p, std::span<const Vec3> line) {
  double least = INFINITY;
  for (std::size_t k = 1; k < line.size(); ++k) {
    const Vec3 way = line[k] - line[k - 1], off = p - line[k - 1];
    const double share = std::clamp(off.dot(way) / std::max(1e-18, way.squaredNorm()), 0.0, 1.0);
    least = std::min(least, (off - share * way).squaredNorm());
  }
  return std::sqrt(least);
}

std::vector<Vec3> curveBetween(std::span<const Vec3> column, int first, int last) {
  std::vector<Vec3> points;
  for (int k = first * kCurvePoints; k <= last * kCurvePoints; ++k)
    points.push_back(onColumn(column, static_cast<double>(k) / kCurvePoints));
  return points;
}

double farthest(std::span<const Vec3> points, std::span<const Vec3> line) {
  double most = 0;
  for (const Vec3& p : points) most = std::max(most, distanceToLine(p, line));
  return most;
}

// m, between the curves up to `reach` layers from `layer`. Where the tip is another, what is beyond either end does not
// count.
double apart(const sim::HairMeshShape& before, const sim::HairMeshShape& after, int layer, int reach) {
  double most = 0;
  for (int c = 0; c < before.columnCount(); ++c) {
    const std::span<const Vec3> old = columnOf(before, c), fresh = columnOf(after, c);
    const int more = static_cast<int>(fresh.size()) - static_cast<int>(old.size());
    if (more == 0 && reach <= kReachOfLayer) continue;
    const int first = std::max(0, layer - reach);
    const int last = std::min(static_cast<int>(old.size()) - 1, layer + reach);
    const bool same_tip = (old.back() - fresh.back()).norm() < 1e-9;
    const std::vector<Vec3> a = curveBetween(old, first, last);
    const std::vector<Vec3> b = curveBetween(fresh, first, std::min(last + more, static_cast<int>(fresh.size()) - 1));
    if (same_tip || more > 0) most = std::max(most, farthest(a, b));
    if (same_tip || more < 0) most = std::max(most, farthest(b, a));
  }
  return most;
}

// Where the vertices of each new column lie on the old one's curve, in layers.
using LayerPlan = std::vector<std::vector<double>>;

// Columns by a plan; between layers `straight` of the way from the curve to the chord. Beyond the tip: straight on.
EditedMesh byPlan(const sim::HairMeshShape& shape, const LayerPlan& plan, double straight) {
  EditedMesh edited;
  edited.shape.root_faces = shape.root_faces;
  for (int c = 0; c < shape.columnCount(); ++c) {
    const std::span<const Vec3> old = columnOf(shape, c);
    const int first = shape.column_first[static_cast<std::size_t>(c)], last = static_cast<int>(old.size()) - 1;
    for (const double at : plan[static_cast<std::size_t>(c)]) {
      const int below = std::clamp(static_cast<int>(at), 0, last), above = std::min(below + 1, last);
      const double share = at - below;
      const Vec3 &low = old[static_cast<std::size_t>(below)], &high = old[static_cast<std::size_t>(above)];
      Vec3 p = low;
      if (at > last) {
        p = 2 * old.back() - old[old.size() - 2];
      } else if (share > 0) {
        p = (1 - straight) * onColumn(old, at) + straight * ((1 - share) * low + share * high);
      }
      edited.shape.positions.push_back(p);
      edited.sources.push_back({first + below, first + above, at > last ? 0 : share});
    }
    edited.shape.column_first.push_back(static_cast<int>(edited.shape.positions.size()));
  }
  return edited;
}

// New places keep off the body, or as near to it as the hair was.
void clearOfBody(const sim::HairMeshShape& shape, const BodyDistance& body, EditedMesh& edited) {
  for (std::size_t v = 0; body && v < edited.sources.size(); ++v) {
    const VertexSource& source = edited.sources[v];
    Vec3& p = edited.shape.positions[v];
    const Vec3 &from = shape.positions[static_cast<std::size_t>(source.from)],
               &to = shape.positions[static_cast<std::size_t>(source.to)];
    if (p == from) continue;
    const double least = std::min({kClear, body(from), body(to)});
    for (int round = 0; round < 2 && body(p) < least; ++round) p += (least - body(p) + 1e-5) * bodyNormal(body, p);
  }
}

// Moves vertices, as little as it can, until the mesh is valid; whether it is.
bool untangled(const sim::HairMeshShape& before, const BodyDistance& body, int layer, EditedMesh& edited) {
  const BodyDistance around = body ? body : [](const Vec3&) { return 1.0; };
  for (int round = 0; round < kUntanglings; ++round) {
    if (untangle(around, kFat, kClear, edited.shape) > 0) break;
  }
  edited.moved = apart(before, edited.shape, layer, kMaxEditedLayers);
  return isValid(edited.shape);
}

// After the last layer columns go on in the mean direction of those around them, the more so with every pass, so that
// tapered ends do not cross.
void evenTips(const sim::HairMeshShape& shape, int layer, int passes, EditedMesh& edited) {
  const auto columns = static_cast<std::size_t>(shape.columnCount());
  std::vector<Vec3> ways(columns, Vec3::Zero());
  for (std::size_t c = 0; c < columns; ++c) {
    const std::span<const Vec3> column = columnOf(shape, static_cast<int>(c));
    ways[c] = column.back() - column[column.size() - 2];
  }
  for (int pass = 0; pass < passes; ++pass) {
    std::vector<Vec3> sum(columns, Vec3::Zero());
    std::vector<int> count(columns, 0);
    for (const sim::RootFace& face : shape.root_faces) {
      if (shape.bundleLayers(face) <= layer) continue;
      for (int k = 0; k < face.corner_count; ++k) {
        const auto of = static_cast<std::size_t>(face.columns[static_cast<std::size_t>(k)]);
        for (int other = 0; other < face.corner_count; ++other)
          sum[of] += ways[static_cast<std::size_t>(face.columns[static_cast<std::size_t>(other)])];
        count[of] += face.corner_count;
      }
    }
    for (std::size_t c = 0; c < columns; ++c) {
      if (count[c] > 0) ways[c] = sum[c] / count[c];
    }
  }
  for (std::size_t c = 0; c < columns; ++c) {
    const auto tip = static_cast<std::size_t>(edited.shape.column_first[c + 1]) - 1;
    if (edited.shape.columnLength(static_cast<int>(c)) == layer + 2)
      edited.shape.positions[tip] = edited.shape.positions[tip - 1] + ways[c];
  }
}

}  // namespace

Vec3 onColumn(std::span<const Vec3> column, double at) {
  const auto vertex = [&](int k) { return column[static_cast<std::size_t>(k)]; };
  return render::onLayers<Vec3>(vertex, static_cast<int>(column.size()), at);
}

EditedMesh addLayer(const sim::HairMeshShape& shape, int after, const BodyDistance& body) {
  const int layers = longestColumn(shape);
  if (after < 0 || after >= layers)
    throw InputError("", "layer " + std::to_string(after), "is not there",
                     "name a layer from 0 to " + std::to_string(layers - 1));
  if (layers >= kMaxEditedLayers)
    throw InputError("", "the hair mesh", "has " + std::to_string(layers) + " layers already", "use those");
  const bool tip = after == layers - 1;
  LayerPlan plan;
  for (int c = 0; c < shape.columnCount(); ++c) {
    std::vector<double>& column = plan.emplace_back();
    for (int l = 0; l < shape.columnLength(c); ++l) {
      column.push_back(l);
      if (l == after && (tip || l + 1 < shape.columnLength(c))) column.push_back(tip ? l + 1 : l + 0.5);
    }
  }
  for (const double straight : kChordShares) {
    EditedMesh edited = byPlan(shape, plan, straight);
    if (tip) evenTips(shape, after, static_cast<int>(kMaxPasses * straight), edited);
    clearOfBody(shape, body, edited);
    if (!isValid(edited.shape)) continue;
    edited.moved = apart(shape, edited.shape, after, kReachOfLayer);
    return edited;
  }
  EditedMesh edited = byPlan(shape, plan, 0);
  if (tip) evenTips(shape, after, static_cast<int>(kMaxPasses), edited);
  if (untangled(shape, body, after, edited)) return edited;
  throw InputError("", "a layer after layer " + std::to_string(after), "would leave prisms flat or inverted",
                   "smooth the hair there first");
}

EditedMesh removeLayer(const sim::HairMeshShape& shape, int layer, const BodyDistance& body) {
  const int layers = longestColumn(shape);
  if (layer == 0) throw InputError("", "layer 0", "is the scalp's, which stays", "name a layer from 1 on");
  if (layer < 0 || layer >= layers)
    throw InputError("", "layer " + std::to_string(layer), "is not there",
                     "name a layer from 1 to " + std::to_string(layers - 1));
  for (int c = 0; c < shape.columnCount(); ++c) {
    if (shape.columnLength(c) == 2 && layer == 1)
      throw InputError("", "layer 1", "is the last one of column " + std::to_string(c), "a bundle needs two layers");
  }
  EditedMesh best, plain;
  best.moved = INFINITY;
  for (const double slide : kSlideShares) {
    if (slide > 0 && layer == layers - 1) break;
    LayerPlan plan;
    for (int c = 0; c < shape.columnCount(); ++c) {
      std::vector<double>& column = plan.emplace_back();
      const int last = shape.columnLength(c) - 1;
      for (int l = 0; l <= last; ++l) {
        const bool slides = l > 0 && l < last && layer < last && std::abs(l - layer) == 1;
        if (l != layer) column.push_back(slides ? l + slide * (layer - l) : l);
      }
    }
    EditedMesh edited = byPlan(shape, plan, 0);
    clearOfBody(shape, body, edited);
    if (slide == 0) plain = edited;
    if (!isValid(edited.shape)) continue;
    edited.moved = apart(shape, edited.shape, layer, kReachOfLayer);
    if (edited.moved < best.moved) best = std::move(edited);
  }
  if (std::isfinite(best.moved)) return best;
  if (!untangled(shape, body, layer, plain))
    throw InputError("", "layer " + std::to_string(layer),
                     "holds prisms open that would be flat or inverted without it",
                     "choose another one, or smooth the hair there first");
  return plain;
}

bool sameStructure(const sim::HairMeshShape& a, const sim::HairMeshShape& b) {
  const auto same = [](const sim::RootFace& one, const sim::RootFace& other) {
    return one.corner_count == other.corner_count &&
           std::equal(one.columns.begin(), one.columns.begin() + one.corner_count, other.columns.begin());
  };
  return a.column_first == b.column_first && std::ranges::equal(a.root_faces, b.root_faces, same);
}

}  // namespace app

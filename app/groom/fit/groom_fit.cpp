#include "app/groom/fit/groom_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <stdexcept>

#include "app/files/report_line.h"
#include "app/groom/fit/column_fit.h"
#include "app/groom/fit/root_mesh.h"
#include "app/groom/fit/root_tears.h"
#include "app/groom/fit/usual_ways.h"
#include "app/styles/style_untangle.h"

namespace app {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr std::size_t kMinGroomStrands = 20;  // strands
constexpr std::size_t kFitStrands = 5000, kTrialStrands = 3000;
constexpr int kSlides = 2, kRounds = 5;
// rad; hair that goes apart by more is torn. The least finds where hair divides over shoulders. In drawn hair, whose
// strands go many ways, only the others find a parting.
constexpr std::array kTears{0.15, 0.3, 0.45};
constexpr int kOpenings = 3, kStiffenings = 8;
constexpr double kStiffer = 2;  // times that columns of a flat face are held more alike, a round
constexpr double kFatness = 0.012, kMinFatness = 0.003, kOpenFatness = 0.02,
                 kFlat = 1e-4;              // of corner tetrahedra: aimed for, held, where some were flat, refused
constexpr double kShortestLayer = 0.0045;   // m, of the median strand
constexpr float kShortestLength = 0.0035f;  // m, of a column: an edge (column_fit.cpp)
constexpr double kMinDensity = 0.5;         // of layers where hair is straight, over the mean
constexpr double kMeanBound = 0.01, kShareBound = 0.03;  // of the strands' length: what a fit is content with
constexpr int kMinLayers = 5, kMaxLayers = 16;           // of hair that is long enough for so many
constexpr double kSquareness = 0.5;
// Of a smaller hair mesh's cost, or of its mean error at no more cost: for less gain a larger one is not taken.
constexpr double kBetter = 0.8;
constexpr double kUnopened = 0.98;  // of the same before its prisms are opened: those of a fit are no less
constexpr int kPerLayer = 4;        // points of a grown strand

// A fit in the making.
struct Draft {
  const StrandSamples& strands;
  const RootRaster& raster;
  RootMesh roots;
  HairFit fit;
  std::vector<StrandTarget> targets;
};

// Every n-th strand, at most `most` of them.
std::vector<std::size_t> someOf(std::size_t count, std::size_t most) {
  const std::size_t step = std::max<std::size_t>(1, (count + most - 1) / most);
  std::vector<std::size_t> some;
  for (std::size_t s = 0; s < count; s += step) some.push_back(s);
  return some;
}

// Layers are denser where strands bend: the error of a smooth curve through few points grows with its bending.
std::vector<double> layerKnots(const RootRaster& raster, int layers) {
  std::vector<double> bend;
  for (const RootCell& cell : raster.cells) {
    if (cell.strands == 0) continue;
    bend.resize(cell.path.size(), 0);
    for (std::size_t k = 1; k + 1 < cell.path.size(); ++k) {
      const Vector3f a = cell.path[k] - cell.path[k - 1], b = cell.path[k + 1] - cell.path[k];
      const double lengths = a.norm() * b.norm();
      if (lengths > 0)
        bend[k] += cell.strands * std::acos(std::clamp(static_cast<double>(a.dot(b)) / lengths, -1.0, 1.0));
    }
  }
  bend.front() = bend[1];
  bend.back() = bend[bend.size() - 2];
  double mean = std::accumulate(bend.begin(), bend.end(), 0.0) / static_cast<double>(bend.size());
  std::vector<double> passed{0};
  for (std::size_t k = 0; k + 1 < bend.size(); ++k) {
    const double here = mean > 0 ? 0.5 * (bend[k] + bend[k + 1]) / mean : 1;
    passed.push_back(passed.back() + kMinDensity + std::min(std::sqrt(here), 2.0));
  }
  std::vector<double> knots{0};
  for (int l = 1; l + 1 < layers; ++l) {
    const double wanted = passed.back() * l / (layers - 1);
    std::size_t k = 0;
    while (passed[k + 1] < wanted) ++k;
    knots.push_back((static_cast<double>(k) + (wanted - passed[k]) / (passed[k + 1] - passed[k])) /
                    static_cast<double>(passed.size() - 1));
  }
  knots.push_back(1);
  return knots;
}

// The region whose hair around the root goes most as the strand does.
int regionOf(const RootRaster& raster, int cell, std::span<const Vector3f> strand) {
  const int x = cell % raster.columns, y = cell / raster.columns;
  int best = -1;
  double least = std::numeric_limits<double>::infinity();
  for (int j = y - 1; j <= y + 1; ++j) {
    for (int i = x - 1; i <= x + 1; ++i) {
      const int region = raster.regionAt(i, j);
      if (region < 0) continue;
      const std::vector<Vector3f>& path = raster.cells[static_cast<std::size_t>(j * raster.columns + i)].path;
      const Vector3f shift = strand[0] - path[0];
      double sum = i == x && j == y ? 0 : 1e-4;
      for (std::size_t k = 1; k < path.size(); ++k)
        sum += (strand[k * (strand.size() - 1) / (path.size() - 1)] - path[k] - shift).norm();
      if (sum >= least) continue;
      least = sum;
      best = region;
    }
  }
  return best;
}

StrandFit placeStrand(const Draft& draft, const GrowthMap& growth, std::size_t s) {
  const auto strand = draft.strands.strand(s);
  const int region = regionOf(draft.raster, draft.raster.cell_of[s], strand);
  const int face = faceAt(draft.roots, region, draft.raster.map.toMap(strand[0]));
  return {growth.placeIn(face, strand[0]), static_cast<float>(draft.fit.knots.size() - 1)};
}

// What the last layer stands for where a strand roots, m.
double columnLength(const Draft& draft, std::size_t s) {
  const float local = draft.raster.lengthAt(draft.raster.map.toMap(draft.strands.strand(s)[0]));
  return std::max({local, draft.strands.length[s], kShortestLength});
}

// Columns that stand straight out of the scalp: valid, and where the fit begins.
void standUp(Draft& draft) {
  sim::HairMeshShape& shape = draft.fit.shape;
  shape = {};
  const RootRaster& raster = draft.raster;
  for (const Vector2f& at : draft.roots.at) {
    const Vector3f root = raster.skinAt(at), out = raster.map.direction(at);
    const float length = std::max(raster.lengthAt(at), kShortestLength);
    for (const double knot : draft.fit.knots)
      shape.positions.push_back((root + static_cast<float>(knot) * length * out).cast<double>());
    shape.column_first.push_back(static_cast<int>(shape.positions.size()));
  }
  for (const std::array<int, 3>& t : draft.roots.triangles) shape.root_faces.push_back({3, {t[0], t[1], t[2], -1}});
  draft.fit.face_region = draft.roots.region;
}

void aim(const GrowthMap& growth, std::size_t most, Draft& draft) {
  draft.targets.clear();
  for (std::size_t s : someOf(draft.strands.strandCount(), most)) {
    const RootPlace root = placeStrand(draft, growth, s).root;
    // Where its face was left out it roots at the edge of another one, which it tells nothing of.
    if ((growth.rootAt(root) - draft.strands.strand(s)[0]).norm() > draft.raster.size) continue;
    StrandTarget& target = draft.targets.emplace_back();
    target.face = root.face;
    target.row = growth.row(root);
    layerTargets(draft.strands.strand(s), draft.strands.length[s], columnLength(draft, s), draft.fit.knots, target);
  }
}

double flattestCorner(const sim::HairMeshShape& shape, const sim::RootFace& face) {
  double least = 1;
  const int n = face.corner_count;
  for (int l = 0; l + 1 < shape.bundleLayers(face); ++l) {
    for (int k = 0; k < 2 * n; ++k) {
      std::array<sim::Vec3, 4> at;
      const std::array<int, 4> corners = sim::cornerTetOf(k, n);
      for (std::size_t i = 0; i < 4; ++i) {
        const int column = face.columns[static_cast<std::size_t>(corners[i] % n)];
        at[i] = shape.positions[static_cast<std::size_t>(shape.column_first[static_cast<std::size_t>(column)] + l +
                                                         corners[i] / n)];
      }
      least = std::min(least, cornerFatness(at[0], at[1], at[2], at[3]));
    }
  }
  return least;
}

// Leaves out faces with a corner that is still flat or inverted, and columns that no face uses then.
void dropFlat(Draft& draft) {
  const sim::HairMeshShape shape = std::move(draft.fit.shape);
  const RootMesh roots = std::move(draft.roots);
  sim::HairMeshShape& kept = draft.fit.shape = {};
  draft.roots = {};
  std::vector<int> number(static_cast<std::size_t>(shape.columnCount()), -1);
  for (std::size_t f = 0; f < shape.root_faces.size(); ++f) {
    if (flattestCorner(shape, shape.root_faces[f]) <= kFlat) {
      ++draft.fit.dropped_faces;
      continue;
    }
    std::array<int, 3>& triangle = draft.roots.triangles.emplace_back(roots.triangles[f]);
    draft.roots.region.push_back(roots.region[f]);
    for (int& column : triangle) {
      int& to = number[static_cast<std::size_t>(column)];
      if (to < 0) {
        to = kept.columnCount();
        draft.roots.at.push_back(roots.at[static_cast<std::size_t>(column)]);
        const auto first = shape.positions.begin() + shape.column_first[static_cast<std::size_t>(column)];
        kept.positions.insert(kept.positions.end(), first, first + shape.columnLength(column));
        kept.column_first.push_back(static_cast<int>(kept.positions.size()));
      }
      column = to;
    }
    kept.root_faces.push_back({3, {triangle[0], triangle[1], triangle[2], -1}});
  }
  draft.fit.face_region = draft.roots.region;
}

// A hair mesh with its prisms opened, as far as that went.
struct Opened {
  sim::HairMeshShape shape;
  std::vector<bool> flat;  // per root face
  std::size_t count = 0;   // of these
  double flattest = 0;
};

// Opens the prisms as in the built-in styles, a few times over.
Opened opened(const sim::HairMeshShape& shape) {
  const BodyDistance nobody = [](const sim::Vec3&) { return 1.0; };
  Opened best;
  sim::HairMeshShape now = shape;
  for (int round = 0; round < kOpenings && (round == 0 || best.count > 0); ++round) {
    const double flattest = untangle(nobody, round == 0 ? kMinFatness : kOpenFatness, 0, now);
    std::vector<bool> flat;
    for (const sim::RootFace& face : now.root_faces) flat.push_back(flattestCorner(now, face) <= kFlat);
    const auto count = static_cast<std::size_t>(std::count(flat.begin(), flat.end(), true));
    if (round == 0 || count < best.count) best = {now, flat, count, flattest};
  }
  return best;
}

// Opens the prisms. Where some stay flat, their columns are held more and more alike; the faces that are flat in the
// best of these are left out.
void openFlat(Draft& draft) {
  Opened best = opened(draft.fit.shape);
  sim::HairMeshShape shape = std::move(draft.fit.shape);
  std::vector<double> alike(static_cast<std::size_t>(shape.columnCount()), 1);
  std::vector<bool> flat = best.flat;
  for (int round = 0; round < kStiffenings && best.count > 0; ++round) {
    std::vector<bool> stiffer(alike.size(), false);
    for (std::size_t f = 0; f < flat.size(); ++f)
      for (const int column : std::span(shape.root_faces[f].columns).first(flat[f] ? 3 : 0))
        stiffer[static_cast<std::size_t>(column)] = true;
    for (std::size_t c = 0; c < alike.size(); ++c) alike[c] *= stiffer[c] ? kStiffer : 1;
    fitColumns(columnSystem(draft.targets, shape, {.alike = alike}), 2 * kFatness, {2 * kRounds, 1, 30}, shape);
    Opened now = opened(shape);
    flat = now.flat;
    if (now.count < best.count) best = std::move(now);
  }
  draft.fit.shape = std::move(best.shape);
  draft.fit.flattest = best.flattest;
  if (best.count > 0) dropFlat(draft);
}

// Slides the layers of a hair mesh along the strands and fits it, over and over; columns astray are held to the usual
// way. Returns the least fatness.
double slideAndFit(double fatness, const std::array<FitRounds, kSlides>& all, Draft& draft, sim::HairMeshShape& shape) {
  const std::vector<sim::Vec3> toward = usualWays(draft.raster, draft.roots, draft.fit.knots, shape);
  std::vector<double> weights(static_cast<std::size_t>(shape.columnCount()), kUsualWeight);
  double flattest = 0;
  for (const FitRounds& rounds : all) {
    slideTargets(shape, draft.targets);
    flattest = fitColumns(columnSystem(draft.targets, shape, {{}, toward, weights}), fatness, rounds, shape);
    holdAstray(shape, toward, weights);
  }
  return flattest;
}

// The strands' own layers, whose prisms may be flat or inverted: what is simulated lies as near to these as it can.
void placeGroom(Draft& draft) {
  sim::HairMeshShape& shape = draft.fit.shape;
  sim::HairMeshShape grown = shape;
  aim(GrowthMap(grown), kFitStrands, draft);
  constexpr FitRounds kWithout{.count = 0, .anew = true};
  slideAndFit(0, {kWithout, kWithout}, draft, grown);
  for (std::size_t v = 0; v < shape.positions.size(); ++v)
    shape.groom_offsets.push_back(grown.positions[v] - shape.positions[v]);
}

// Where along the curve its length is `length`, in layers.
float endOf(std::span<const Vector3f> layers, double length) {
  double passed = 0;
  Vector3f last = layers[0];
  const int steps = (static_cast<int>(layers.size()) - 1) * kPerLayer;
  for (int k = 1; k <= steps; ++k) {
    const Vector3f here = curveAt(layers, static_cast<float>(k) / kPerLayer);
    const double step = (here - last).norm();
    if (passed + step >= length)
      return static_cast<float>((k - 1 + (length - passed) / std::max(step, 1e-12)) / kPerLayer);
    passed += step;
    last = here;
  }
  return static_cast<float>(layers.size() - 1);
}

void layerPoints(const HairFit& fit, const GrowthRow& row, std::vector<Vector3f>& layers) {
  layers.assign(fit.knots.size(), Vector3f::Zero());
  for (std::size_t k = 0; k < row.columns.size(); ++k) {
    const std::size_t first = static_cast<std::size_t>(fit.shape.column_first[row.columns[k]]);
    for (std::size_t l = 0; l < layers.size(); ++l)
      layers[l] += row.weights[k] * (fit.shape.positions[first + l] + fit.shape.groom_offsets[first + l]).cast<float>();
  }
}

void drawCurve(std::span<const Vector3f> layers, float end, std::vector<Vector3f>& line) {
  line.clear();
  for (int k = 0; static_cast<float>(k) / kPerLayer < end; ++k)
    line.push_back(curveAt(layers, static_cast<float>(k) / kPerLayer));
  line.push_back(curveAt(layers, end));
}

// Compares strands with those that grow in their place.
void measure(std::size_t most, Draft& draft) {
  HairFit& fit = draft.fit;
  const GrowthMap growth(fit.shape);
  FitError& error = fit.error;
  error = {};
  fit.strands.clear();
  std::vector<float> gaps;
  std::vector<Vector3f> layers, line, even(static_cast<std::size_t>(draft.strands.count));
  const std::vector<std::size_t> some = someOf(draft.strands.strandCount(), most);
  for (std::size_t s : some) {
    const auto strand = draft.strands.strand(s);
    StrandFit placed = placeStrand(draft, growth, s);
    layerPoints(fit, growth.row(placed.root), layers);
    placed.end = endOf(layers, lineLength(strand));
    drawCurve(layers, placed.end, line);
    resample(line, even);
    double sum = 0;
    for (std::size_t k = 0; k < even.size(); ++k) {
      const float gap = (even[k] - strand[k]).norm();
      gaps.push_back(gap);
      sum += gap;
    }
    error.root_mean += gaps[gaps.size() - even.size()];
    error.of_strand.push_back(static_cast<float>(sum / static_cast<double>(even.size())));
    fit.strands.push_back(placed);
  }
  error.strand_length = quantile(draft.strands.length, 0.5);
  error.mean = std::accumulate(gaps.begin(), gaps.end(), 0.0) / static_cast<double>(gaps.size());
  error.root_mean /= static_cast<double>(some.size());
  error.largest = *std::max_element(gaps.begin(), gaps.end());
  error.share95 = quantile(std::move(gaps), 0.95);
}

// The share of the strands that do not fit, that of the faces left bare, and how far of their length the strands grow
// from the mesh: rounding that opens one face more or less changes it little.
double costOf(const HairFit& fit) {
  const auto off = std::ranges::count_if(fit.error.of_strand,
                                         [&](float one) { return one > kShareBound * fit.error.strand_length; });
  const double bare = fit.dropped_faces / static_cast<double>(fit.dropped_faces + fit.shape.root_faces.size());
  double beside = 0;
  for (const sim::Vec3& offset : fit.shape.groom_offsets)
    beside += offset.norm() / static_cast<double>(fit.shape.groom_offsets.size());
  return static_cast<double>(off) / static_cast<double>(fit.error.of_strand.size()) + bare +
         beside / fit.error.strand_length;
}

// `share`: of the larger one's cost and mean error that is counted.
bool better(const HairFit& larger, const HairFit& smaller, double share = 1) {
  const double cost = share * costOf(larger), other = costOf(smaller);
  return cost < kBetter * other || (cost <= other && share * larger.error.mean < kBetter * smaller.error.mean);
}

// Layers about as far apart as columns: prisms long for their width are inverted by the head's curvature.
int usualLayers(const RootRaster& raster, double length, int vertices) {
  const auto full =
      std::count_if(raster.cells.begin(), raster.cells.end(), [](const RootCell& cell) { return cell.region >= 0; });
  const double area = static_cast<double>(full) * raster.size * raster.size;
  int layers = std::clamp(1 + static_cast<int>(length / kShortestLayer), 2, kMinLayers);
  while (layers < kMaxLayers && layers >= kMinLayers && length / layers > kShortestLayer &&
         layers * (layers - 1.0) * (layers - 1.0) < kSquareness * length * length * vertices / area)
    ++layers;
  return layers;
}

// How many times a fit is off its bounds.
double lackingOf(const HairFit& fit) {
  return std::max(fit.error.mean / kMeanBound, fit.error.share95 / kShareBound) / fit.error.strand_length;
}

// The raster torn in every way that there is; those that come out alike once.
std::vector<RootRaster> tornRasters(const RootRaster& whole) {
  std::vector<RootRaster> all;
  for (const double tears : kTears) {
    RootRaster raster = whole;
    tearApart(tears, raster);
    const auto alike = [&](const RootRaster& other) {
      return raster.split == other.split &&
             std::ranges::equal(raster.cells, other.cells, {}, &RootCell::region, &RootCell::region);
    };
    if (std::ranges::none_of(all, alike)) all.push_back(std::move(raster));
  }
  return all;
}

// Whether a fit may be worth to be kept, of which no more is known than before its prisms are opened. That takes
// strands further from the mesh and leaves faces out: cost and mean error grow, or fall by less than kUnopened tells.
using Worth = std::function<bool(const HairFit& unopened)>;

bool isWorth(const Worth& worth, Draft draft) {
  placeGroom(draft);
  measure(kTrialStrands, draft);
  return worth(draft.fit);
}

// Fits, and opens what still lacks. Empty where it is not worth that.
std::unique_ptr<Draft> makeDraft(const StrandSamples& strands, const RootRaster& raster, int layers, int vertices,
                                 const Worth& worth) {
  std::unique_ptr<Draft> draft(new Draft{strands, raster, meshRoots(raster, vertices / layers), {}, {}});
  if (draft->roots.triangles.empty())
    throw std::runtime_error("the roots span no face; a hair mesh grows from an area of scalp");
  draft->fit.map = raster.map;
  draft->fit.regions = raster.regions;
  draft->fit.knots = layerKnots(raster, layers);
  standUp(*draft);
  aim(GrowthMap(draft->fit.shape), kFitStrands, *draft);
  constexpr std::array<FitRounds, kSlides> kSettling{FitRounds{.count = kRounds, .anew = true},
                                                     FitRounds{.count = 2 * kRounds}};
  draft->fit.flattest = slideAndFit(kFatness, kSettling, *draft, draft->fit.shape);
  if (draft->fit.flattest < kMinFatness) {
    if (!isWorth(worth, *draft)) return nullptr;
    openFlat(*draft);
  }
  if (draft->fit.shape.root_faces.empty())
    throw std::runtime_error("no bundle of it can be made into prisms; its strands go through each other everywhere");
  placeGroom(*draft);
  measure(kTrialStrands, *draft);
  return draft;
}

}  // namespace

void growStrand(const HairFit& fit, const GrowthMap& growth, const StrandFit& strand, std::span<Vector3f> even) {
  std::vector<Vector3f> layers, line;
  layerPoints(fit, growth.row(strand.root), layers);
  drawCurve(layers, strand.end, line);
  resample(line, even);
}

HairFit fitGroom(const StrandSamples& strands, const FitOptions& options) {
  constexpr int kVerticesAStrand = 8;
  if (strands.strandCount() < kMinGroomStrands)
    throw std::runtime_error(countOf(strands.strandCount(), "strand") + " can be used, finite and of a length; " +
                             "a hair mesh takes at least " + std::to_string(kMinGroomStrands));
  const std::vector<RootRaster> torn = tornRasters(rasterRoots(strands));
  const double length = quantile(strands.length, 0.5);
  std::vector<int> budgets{400, 800, 1600, 2400};
  // More vertices than strands can tell of take minutes and bring nothing.
  const int most = std::max(budgets.front(), kVerticesAStrand * static_cast<int>(strands.strandCount()));
  if (options.vertices > 0) budgets = {options.vertices};
  for (int& budget : budgets) budget = std::min(budget, most);
  budgets.erase(std::ranges::unique(budgets).begin(), budgets.end());
  const auto draftOf = [&](const RootRaster& raster, int vertices, const Worth& worth) {
    return makeDraft(strands, raster, options.layers > 0 ? options.layers : usualLayers(raster, length, vertices),
                     vertices, worth);
  };
  std::unique_ptr<Draft> best;
  for (const RootRaster& raster : torn) {
    std::unique_ptr<Draft> draft = draftOf(raster, budgets.front(), [&](const HairFit& unopened) {
      return !best || kUnopened * costOf(unopened) < costOf(best->fit);
    });
    if (draft && (!best || costOf(draft->fit) < costOf(best->fit))) best = std::move(draft);
  }
  const RootRaster& raster = best->raster;
  for (const int vertices : std::span(budgets).subspan(1)) {
    const double off = lackingOf(best->fit);
    if (off <= 1 && best->fit.dropped_faces == 0) break;
    // The error falls about as the columns' number grows.
    if (vertices != budgets.back() && best->fit.shape.vertexCount() * off > 1.3 * vertices) continue;
    std::unique_ptr<Draft> draft =
        draftOf(raster, vertices, [&](const HairFit& unopened) { return better(unopened, best->fit, kUnopened); });
    if (draft && better(draft->fit, best->fit)) best = std::move(draft);
  }
  measure(strands.strandCount(), *best);
  return std::move(best->fit);
}

}  // namespace app

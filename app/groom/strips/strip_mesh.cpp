#include "app/groom/strips/strip_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "app/files/median.h"
#include "app/styles/style_untangle.h"

namespace app {

namespace {

using sim::Vec3;
using Row = std::vector<Vec3>;

constexpr double kThinnestStrip = 0.002, kThickestStrip = 0.008, kOfWidth = 0.35;  // m, m, of a quad's width
constexpr double kAtTip = 0.5;                                                     // of the thickness at the root
constexpr std::size_t kFewestLayers = 4, kFewSides = 4, kTubeSides = 8, kFewAcross = 2;
constexpr double kCornerFatness = 0.05;  // of untangled corners

double ringArea(const Row& ring) {
  const Vec3 middle = middleOf(ring);
  Vec3 area = Vec3::Zero();
  for (std::size_t k = 0; k < ring.size(); ++k)
    area += (ring[k] - middle).cross(ring[(k + 1) % ring.size()] - middle) / 2;
  return area.norm();
}

// Fewer points round every ring, of the same area within.
void reduceSides(std::size_t sides, StripRows& strip) {
  for (Row& ring : strip.rows) {
    if (ring.size() <= sides) continue;
    Row less;
    for (std::size_t k = 0; k < sides; ++k) {
      const double at = static_cast<double>(k * ring.size()) / static_cast<double>(sides);
      const auto before = static_cast<std::size_t>(at);
      const double share = at - static_cast<double>(before);
      less.push_back((1 - share) * ring[before] + share * ring[(before + 1) % ring.size()]);
    }
    const double area = ringArea(less);
    const double grown = area > 0 ? std::clamp(std::sqrt(ringArea(ring) / area), 1.0, 1.5) : 1;
    const Vec3 middle = middleOf(less);
    for (Vec3& p : less) p = middle + grown * (p - middle);
    ring = std::move(less);
  }
}

// `count` rows at even steps of the rows' number.
void setLayers(std::size_t count, StripRows& strip) {
  if (strip.rows.size() == count) return;
  std::vector<Row> rows;
  for (std::size_t l = 0; l < count; ++l) {
    const double at = static_cast<double>(l * (strip.rows.size() - 1)) / static_cast<double>(count - 1);
    const std::size_t before = std::min(strip.rows.size() - 2, static_cast<std::size_t>(at));
    const double share = at - static_cast<double>(before);
    Row& row = rows.emplace_back();
    for (std::size_t k = 0; k < strip.rows[0].size(); ++k)
      row.push_back((1 - share) * strip.rows[before][k] + share * strip.rows[before + 1][k]);
  }
  strip.rows = std::move(rows);
}

std::size_t columnsOf(const StripRows& strip) {
  return strip.rows[0].size() * (strip.tube ? 1 : 2);
}

std::size_t verticesOf(const std::vector<StripRows>& strips) {
  std::size_t sum = 0;
  for (const StripRows& strip : strips) sum += columnsOf(strip) * strip.rows.size();
  return sum;
}

// Fewer points across a strip, at even steps of their number.
void reduceAcross(std::size_t points, StripRows& strip) {
  for (Row& row : strip.rows) {
    if (row.size() <= points) continue;
    Row less;
    for (std::size_t k = 0; k < points; ++k) {
      const double at = static_cast<double>(k * (row.size() - 1)) / static_cast<double>(points - 1);
      const std::size_t before = std::min(row.size() - 2, static_cast<std::size_t>(at));
      const double share = at - static_cast<double>(before);
      less.push_back((1 - share) * row[before] + share * row[before + 1]);
    }
    row = std::move(less);
  }
}

// Layers as asked, and no more vertices than asked where that can be had: first by sides of tubes, then by layers, at
// last by quads across.
bool fitBudget(const StripMeshOptions& options, std::vector<StripRows>& strips) {
  for (StripRows& strip : strips) {
    if (strip.tube) reduceSides(kTubeSides, strip);
    setLayers(
        options.layers > 1 ? static_cast<std::size_t>(options.layers) : std::max(kFewestLayers, strip.rows.size()),
        strip);
  }
  const auto most = static_cast<std::size_t>(options.vertices > 0 ? options.vertices : kStripVertices);
  if (verticesOf(strips) <= most) return false;
  for (StripRows& strip : strips) {
    if (strip.tube) reduceSides(kFewSides, strip);
  }
  std::size_t longest = 0;
  for (const StripRows& strip : strips) longest = std::max(longest, strip.rows.size());
  for (std::size_t cap = longest; options.layers < 2 && cap > kFewestLayers && verticesOf(strips) > most; --cap) {
    for (StripRows& strip : strips) {
      if (strip.rows.size() >= cap) setLayers(std::max(kFewestLayers, cap - 1), strip);
    }
  }
  std::size_t widest = kFewAcross;
  for (const StripRows& strip : strips) widest = std::max(widest, strip.tube ? 0 : strip.rows[0].size());
  for (std::size_t cap = widest; cap > kFewAcross && verticesOf(strips) > most; --cap) {
    for (StripRows& strip : strips) {
      if (!strip.tube) reduceAcross(cap - 1, strip);
    }
  }
  return true;
}

double meanQuadWidth(const StripRows& strip) {
  double sum = 0, count = 0;
  for (const Row& row : strip.rows) {
    for (std::size_t k = 1; k < row.size(); ++k, ++count) sum += (row[k] - row[k - 1]).norm();
  }
  return sum / count;
}

// Unit, across the strip's surface.
Vec3 normalAt(const StripRows& strip, std::size_t r, std::size_t k) {
  const auto& rows = strip.rows;
  const Vec3 across = rows[r][std::min(k + 1, rows[r].size() - 1)] - rows[r][k > 0 ? k - 1 : 0];
  const Vec3 along = rows[std::min(r + 1, rows.size() - 1)][k] - rows[r > 0 ? r - 1 : 0][k];
  return across.cross(along).stableNormalized();
}

using Faces = std::vector<std::vector<int>>;

// Columns of a strip: those of one side, then those of the other.
std::vector<Row> stripColumns(const StripRows& strip, double thickness, Faces& faces) {
  const std::size_t across = strip.rows[0].size(), layers = strip.rows.size();
  std::vector<Row> columns(2 * across);
  for (std::size_t k = 0; k < across; ++k) {
    Vec3 before = Vec3::Zero();
    for (std::size_t r = 0; r < layers; ++r) {
      Vec3 normal = normalAt(strip, r, k);
      if (normal.norm() < 0.5) normal = before;
      before = normal;
      const double share = static_cast<double>(r) / static_cast<double>(layers - 1);
      const Vec3 off = 0.5 * thickness * (1 - (1 - kAtTip) * share) * normal;
      columns[k].push_back(strip.rows[r][k] + off);
      columns[across + k].push_back(strip.rows[r][k] - off);
    }
  }
  const auto at = [](std::size_t c) { return static_cast<int>(c); };
  for (std::size_t k = 0; k + 1 < across; ++k) faces.push_back({at(k), at(k + 1), at(across + k + 1), at(across + k)});
  return columns;
}

// Columns of a tube. Its root faces go across the rings from the pair of points where they are narrowest.
std::vector<Row> tubeColumns(const StripRows& strip, Faces& faces) {
  const std::size_t sides = strip.rows[0].size();
  const Row& ring = strip.rows[strip.rows.size() / 2];
  std::size_t start = 0;
  double least = -1;
  for (std::size_t s = 0; s < sides; ++s) {
    double rungs = 0;
    for (std::size_t k = 0; 2 * k + 1 < sides; ++k)
      rungs += (ring[(s + k) % sides] - ring[(s + sides - 1 - k) % sides]).norm();
    if (least < 0 || rungs < 0.999 * least) {
      least = rungs;
      start = s;
    }
  }
  std::vector<Row> columns(sides);
  for (std::size_t k = 0; k < sides; ++k) {
    for (const Row& row : strip.rows) columns[k].push_back(row[(start + k) % sides]);
  }
  const auto at = [](std::size_t c) { return static_cast<int>(c); };
  for (std::size_t k = 0; 2 * k + 3 < sides; ++k)
    faces.push_back({at(k), at(k + 1), at(sides - 2 - k), at(sides - 1 - k)});
  if (sides % 2 == 1) faces.push_back({at(sides / 2 - 1), at(sides / 2), at(sides / 2 + 1)});
  return columns;
}

// Signed volume over a root face between the first two layers.
double volumeOver(const std::vector<Row>& columns, const std::vector<int>& face) {
  double sum = 0;
  for (std::size_t k = 1; k + 1 < face.size(); ++k) {
    const auto root = [&](std::size_t i) -> const Vec3& { return columns[static_cast<std::size_t>(face[i])][0]; };
    const Vec3 up = columns[static_cast<std::size_t>(face[0])][1] - root(0);
    sum += (root(k) - root(0)).cross(root(k + 1) - root(0)).dot(up);
  }
  return sum;
}

void append(const std::vector<Row>& columns, const Faces& faces, sim::HairMeshShape& shape) {
  const int base = shape.columnCount();
  double volume = 0;
  for (const std::vector<int>& face : faces) volume += volumeOver(columns, face);
  for (const Row& column : columns) {
    shape.positions.insert(shape.positions.end(), column.begin(), column.end());
    shape.column_first.push_back(static_cast<int>(shape.positions.size()));
  }
  for (std::vector<int> face : faces) {
    if (volume < 0) std::reverse(face.begin(), face.end());
    sim::RootFace root{static_cast<int>(face.size()), {-1, -1, -1, -1}};
    for (std::size_t k = 0; k < face.size(); ++k) root.columns[k] = base + face[k];
    shape.root_faces.push_back(root);
  }
}

bool valid(const sim::HairMeshShape& shape) {
  try {
    sim::buildHairMesh(shape);
  } catch (const sim::MeshError&) {
    return false;
  }
  return true;
}

// A strip by itself; its thickness is less where it is bent more sharply, and corners are opened at last.
std::optional<sim::HairMeshShape> shapeOf(const StripRows& strip, double& thickness) {
  for (int attempt = 0; attempt < (strip.tube ? 2 : 4); ++attempt) {
    Faces faces;
    sim::HairMeshShape shape;
    const std::vector<Row> columns = strip.tube ? tubeColumns(strip, faces) : stripColumns(strip, thickness, faces);
    append(columns, faces, shape);
    if (valid(shape)) return shape;
    if (attempt + 1 == (strip.tube ? 2 : 4)) {
      untangle([](const Vec3&) { return 1.0; }, kCornerFatness, 0, shape);
      if (valid(shape)) return shape;
    }
    thickness /= 2;
  }
  return std::nullopt;
}

}  // namespace

int fewestVertices(const std::vector<StripRows>& strips, const StripMeshOptions& options) {
  const std::size_t layers = options.layers > 1 ? static_cast<std::size_t>(options.layers) : kFewestLayers;
  std::size_t sum = 0;
  for (const StripRows& strip : strips)
    sum += layers * (strip.tube ? std::min(kFewSides, strip.rows[0].size()) : 2 * kFewAcross);
  return static_cast<int>(std::min<std::size_t>(sum, std::numeric_limits<int>::max()));
}

StripMesh meshOfStrips(const std::vector<StripRows>& given, const StripMeshOptions& options) {
  std::vector<StripRows> strips = given;
  StripMesh out;
  out.thinned = fitBudget(options, strips);
  if (verticesOf(strips) > kMaxStripVertices)
    throw std::runtime_error("its strips would have " + std::to_string(verticesOf(strips)) + " vertices, more than " +
                             std::to_string(kMaxStripVertices));
  std::vector<double> thick;
  for (std::size_t s = 0; s < strips.size(); ++s) {
    const StripRows& strip = strips[s];
    double thickness = 0;
    if (!strip.tube)
      thickness = options.thickness > 0 ? options.thickness
                                        : std::clamp(kOfWidth * meanQuadWidth(strip), kThinnestStrip, kThickestStrip);
    const std::optional<sim::HairMeshShape> one = shapeOf(strip, thickness);
    if (!one) {
      out.left_out.push_back(static_cast<int>(s));
      continue;
    }
    if (!strip.tube) thick.push_back(thickness);
    const int layers = static_cast<int>(strip.rows.size()), base = out.shape.columnCount();
    out.most_layers = std::max(out.most_layers, layers);
    out.least_layers = out.least_layers == 0 ? layers : std::min(out.least_layers, layers);
    for (sim::RootFace face : one->root_faces) {
      for (int k = 0; k < face.corner_count; ++k) face.columns[static_cast<std::size_t>(k)] += base;
      out.shape.root_faces.push_back(face);
    }
    const int first = out.shape.vertexCount();
    for (std::size_t c = 1; c < one->column_first.size(); ++c)
      out.shape.column_first.push_back(first + one->column_first[c]);
    out.shape.positions.insert(out.shape.positions.end(), one->positions.begin(), one->positions.end());
  }
  if (out.shape.root_faces.empty()) throw std::runtime_error("every strip folds over itself");
  if (!thick.empty()) out.thickness = median(std::move(thick));
  sim::buildHairMesh(out.shape);
  return out;
}

}  // namespace app

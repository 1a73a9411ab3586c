#include "app/groom/fit/column_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "app/styles/style_untangle.h"

namespace app {
namespace {

using Eigen::Vector3f;

constexpr int kMaxIterations = 800;
constexpr double kTolerance = 1e-6;                     // of the right-hand side
constexpr float kStraight = 2e-3f;                      // weight of a strand's second differences beside its samples
constexpr float kBeyond = 0.02f;                        // weight of a layer that a strand does not reach
constexpr double kAlong = 0.1;                          // weight of a layer's way along its strand, over that across
constexpr float kSlope = 0.05f, kFarthestSlide = 0.5f;  // layers
constexpr double kFatnessMargin = 1.3;                  // of the fatness that is aimed for
constexpr double kLargestMove = 0.01;                   // m a round
constexpr double kShortestEdge = 0.0035;                // m
constexpr double kAlike = 0.01;                         // weight of neighbours' difference beside a column's strands

// All columns have as many layers.
int layersOf(const sim::HairMeshShape& shape) {
  return shape.columnLength(0);
}

std::set<std::pair<int, int>> rootEdges(const sim::HairMeshShape& shape) {
  std::set<std::pair<int, int>> edges;
  for (const sim::RootFace& face : shape.root_faces) {
    for (int k = 0; k < face.corner_count; ++k) {
      const int a = face.columns[k], b = face.columns[(k + 1) % face.corner_count];
      edges.insert({std::min(a, b), std::max(a, b)});
    }
  }
  return edges;
}

}  // namespace

double layerOf(const std::vector<double>& knots, double share) {
  const auto above = std::upper_bound(knots.begin() + 1, knots.end() - 1, share);
  const auto layer = above - knots.begin() - 1;
  const double low = knots[static_cast<std::size_t>(layer)], high = knots[static_cast<std::size_t>(layer + 1)];
  return static_cast<double>(layer) + std::clamp((share - low) / (high - low), 0.0, 1.0);
}

void layerTargets(std::span<const Vector3f> samples, double strand_length, double length,
                  const std::vector<double>& knots, StrandTarget& target) {
  const int layers = static_cast<int>(knots.size());
  Eigen::MatrixXf normal = Eigen::MatrixXf::Zero(layers, layers);
  Eigen::MatrixX3f right = Eigen::MatrixX3f::Zero(layers, 3);
  target.weight.assign(static_cast<std::size_t>(layers), kBeyond);
  // Catmull-Rom weights of the four layers around s; beyond an end the mirrored point's weight goes to the two at it.
  for (std::size_t j = 0; j < samples.size(); ++j) {
    const double share = strand_length / length * static_cast<double>(j) / static_cast<double>(samples.size() - 1);
    const double s = layerOf(knots, std::min(share, 1.0));
    const int layer = std::min(static_cast<int>(s), layers - 2);
    const float f = static_cast<float>(s) - static_cast<float>(layer);
    float w[4] = {f * (-0.5f + f * (1 - 0.5f * f)), 1 + f * f * (-2.5f + 1.5f * f), f * (0.5f + f * (2 - 1.5f * f)),
                  f * f * (-0.5f + 0.5f * f)};
    if (layer == 0) {
      w[1] += 2 * w[0];
      w[2] -= w[0];
      w[0] = 0;
    }
    if (layer + 2 >= layers) {
      w[2] += 2 * w[3];
      w[1] -= w[3];
      w[3] = 0;
    }
    for (int a = 0; a < 4; ++a) {
      if (w[a] == 0) continue;
      right.row(layer - 1 + a) += w[a] * samples[j].transpose();
      for (int b = 0; b < 4; ++b)
        if (w[b] != 0) normal(layer - 1 + a, layer - 1 + b) += w[a] * w[b];
    }
    target.weight[static_cast<std::size_t>(layer)] = 1;
    if (f > 0.5f) target.weight[static_cast<std::size_t>(layer + 1)] = 1;
  }
  for (int l = 1; l + 1 < layers; ++l) {
    for (int a = -1; a <= 1; ++a)
      for (int b = -1; b <= 1; ++b)
        normal(l + a, l + b) += kStraight * (a == 0 ? -2.0f : 1.0f) * (b == 0 ? -2.0f : 1.0f);
  }
  constexpr float kRoot = 100;  // the root is where it is
  normal(0, 0) += kRoot;
  right.row(0) += kRoot * samples[0].transpose();
  const Eigen::MatrixX3f solved = normal.llt().solve(right);
  target.layers.resize(static_cast<std::size_t>(layers));
  for (int l = 0; l < layers; ++l) target.layers[static_cast<std::size_t>(l)] = solved.row(l).transpose();
}

void slideTargets(const sim::HairMeshShape& shape, std::vector<StrandTarget>& targets) {
  const int layers = layersOf(shape);
  for (StrandTarget& target : targets) {
    const auto point = [&](float s) { return curveAt(target.layers, s); };
    for (int l = 0; l < layers; ++l) {
      const std::size_t at = static_cast<std::size_t>(l);
      const bool first = target.slid.size() <= at;
      if (first) {
        target.slid.push_back(static_cast<float>(l));
        target.at.push_back(target.layers[at]);
        target.along.push_back(Vector3f::Zero());
      } else if (l > 0 && l + 1 < layers) {
        Vector3f grown = Vector3f::Zero();
        for (std::size_t k = 0; k < target.row.columns.size(); ++k)
          grown +=
              target.row.weights[k] *
              shape.positions[static_cast<std::size_t>(shape.column_first[target.row.columns[k]] + l)].cast<float>();
        float& s = target.slid[at];
        for (int step = 0; step < 3; ++step) {
          const Vector3f slope =
              (point(std::min(s + kSlope, static_cast<float>(layers - 1))) - point(s - kSlope)) / (2 * kSlope);
          s += std::clamp(slope.dot(grown - point(s)) / std::max(slope.squaredNorm(), 1e-12f), -0.5f, 0.5f);
          s = std::clamp(s, static_cast<float>(l) - kFarthestSlide, static_cast<float>(l) + kFarthestSlide);
        }
        target.at[at] = point(s);
      }
      if (l > 0 && l + 1 < layers) {
        const float s = target.slid[at];
        target.along[at] = (point(s + kSlope) - point(s - kSlope)).stableNormalized();
      }
    }
  }
}

namespace {

// A layer's part of the normal matrix: columns x columns blocks of 3 x 3.
struct LayerBlocks {
  int columns;
  std::vector<Eigen::Matrix3d> blocks;
  explicit LayerBlocks(int count)
      : columns(count),
        blocks(static_cast<std::size_t>(count) * static_cast<std::size_t>(count), Eigen::Matrix3d::Zero()) {}
  Eigen::Matrix3d& at(int row, int column) { return blocks[static_cast<std::size_t>(row * columns + column)]; }
};

void addTarget(const StrandTarget& target, int layer, LayerBlocks& blocks, ColumnSystem& system) {
  const std::size_t l = static_cast<std::size_t>(layer);
  const Eigen::Vector3d along = target.along[l].cast<double>(), wanted = target.at[l].cast<double>();
  const Eigen::Matrix3d weigh =
      target.weight[l] * (Eigen::Matrix3d::Identity() - (1 - kAlong) * along * along.transpose());
  const std::size_t count = target.row.columns.size();
  for (std::size_t a = 0; a < count; ++a) {
    const Eigen::Matrix3d one = target.row.weights[a] * weigh;
    const int row = target.row.columns[a];
    system.right.segment<3>(3 * system.unknown(row, layer)) += one * wanted;
    for (std::size_t b = 0; b < count; ++b) {
      if (target.row.columns[b] <= row) blocks.at(row, target.row.columns[b]) += target.row.weights[b] * one;
    }
  }
}

}  // namespace

ColumnSystem columnSystem(const std::vector<StrandTarget>& targets, const sim::HairMeshShape& shape,
                          const ColumnHold& hold) {
  ColumnSystem system;
  const int columns = system.columns = shape.columnCount(), layers = system.layers = layersOf(shape);
  system.right = Eigen::VectorXd::Zero(3 * system.unknowns());
  const std::set<std::pair<int, int>> edges = rootEdges(shape);
  const auto root = [&](int column) -> const sim::Vec3& { return shape.positions[shape.column_first[column]]; };
  double trace = 0;
  for (int l = 1; l < layers; ++l) {
    LayerBlocks blocks(columns);
    for (const StrandTarget& target : targets) addTarget(target, l, blocks, system);
    double usual = 0;
    for (int c = 0; c < columns; ++c) usual += blocks.at(c, c).trace() / (3 * columns);
    trace += usual;
    for (int c = 0; c < columns && !hold.toward.empty(); ++c) {
      const double weight = hold.weights[static_cast<std::size_t>(c)] * usual;
      blocks.at(c, c) += weight * Eigen::Matrix3d::Identity();
      system.right.segment<3>(3 * system.unknown(c, l)) +=
          weight * hold.toward[static_cast<std::size_t>(shape.column_first[c] + l)];
    }
    for (const auto& [a, b] : edges) {
      const double share = hold.alike.empty() ? 1
                                              : std::max(hold.alike[static_cast<std::size_t>(a)],
                                                         hold.alike[static_cast<std::size_t>(b)]);
      const Eigen::Matrix3d alike = share * kAlike * usual * Eigen::Matrix3d::Identity();
      blocks.at(a, a) += alike;
      blocks.at(b, b) += alike;
      blocks.at(b, a) -= alike;
      const sim::Vec3 gap = alike * (root(a) - root(b));
      system.right.segment<3>(3 * system.unknown(a, l)) += gap;
      system.right.segment<3>(3 * system.unknown(b, l)) -= gap;
    }
    for (int a = 0; a < columns; ++a) {
      for (int b = 0; b <= a; ++b) {
        const Eigen::Matrix3d& block = blocks.at(a, b);
        if (block.isZero(0)) continue;
        system.blocks.push_back({system.unknown(a, l), system.unknown(b, l), block});
      }
    }
  }
  system.usual = trace / (layers - 1);
  return system;
}

namespace {

using Corner = std::array<int, 4>;  // vertices, as sim::CornerTet::v

std::vector<Corner> cornersOf(const sim::HairMeshShape& shape) {
  std::vector<Corner> all;
  for (const sim::RootFace& face : shape.root_faces) {
    const int n = face.corner_count;
    for (int l = 0; l + 1 < shape.bundleLayers(face); ++l) {
      for (int k = 0; k < 2 * n; ++k) {
        Corner& corner = all.emplace_back(sim::cornerTetOf(k, n));
        for (int& v : corner) v = shape.column_first[face.columns[static_cast<std::size_t>(v % n)]] + l + v / n;
      }
    }
  }
  return all;
}

double fatnessOf(const sim::HairMeshShape& shape, const Corner& corner) {
  const auto at = [&](std::size_t k) -> const sim::Vec3& {
    return shape.positions[static_cast<std::size_t>(corner[k])];
  };
  return cornerFatness(at(0), at(1), at(2), at(3));
}

// A linear constraint on up to four vertices: the sum of slope . move is to reach `lacking` (m); the slopes that count
// have a square sum of 1.
struct Constraint {
  std::array<int, 4> v{-1, -1, -1, -1};
  std::array<sim::Vec3, 4> slope;
  double lacking = 0;
};

// What a corner lacks of its fatness; nothing where it is well above.
bool cornerConstraint(const sim::HairMeshShape& shape, const std::vector<int>& unknown, const Corner& corner,
                      double fatness, Constraint& out) {
  const auto at = [&](std::size_t k) -> const sim::Vec3& {
    return shape.positions[static_cast<std::size_t>(corner[k])];
  };
  const sim::Vec3 a = at(1) - at(0), b = at(2) - at(0), c = at(3) - at(0);
  const double box = a.norm() * b.norm() * c.norm(), lacking = kFatnessMargin * fatness * box - a.cross(b).dot(c);
  if (lacking <= 0) return false;
  out.v = corner;
  out.slope = {sim::Vec3::Zero(), b.cross(c), c.cross(a), a.cross(b)};
  out.slope[0] = -out.slope[1] - out.slope[2] - out.slope[3];
  double square = 0;
  for (std::size_t k = 0; k < 4; ++k)
    if (unknown[static_cast<std::size_t>(corner[k])] >= 0) square += out.slope[k].squaredNorm();
  if (square < 1e-24) return false;
  out.lacking = lacking / std::sqrt(square);
  for (sim::Vec3& slope : out.slope) slope /= std::sqrt(square);
  return true;
}

// An edge that is too short.
bool edgeConstraint(const sim::HairMeshShape& shape, int a, int b, Constraint& out) {
  const sim::Vec3 edge = shape.positions[static_cast<std::size_t>(b)] - shape.positions[static_cast<std::size_t>(a)];
  const double length = edge.norm();
  if (length >= kShortestEdge || length < 1e-9) return false;
  out.v = {a, b, -1, -1};
  out.slope = {-edge / length * std::numbers::sqrt2 / 2, edge / length * std::numbers::sqrt2 / 2, sim::Vec3::Zero(),
               sim::Vec3::Zero()};
  out.lacking = (kShortestEdge - length) * std::numbers::sqrt2 / 2;
  return true;
}

std::vector<Constraint> broken(const sim::HairMeshShape& shape, const std::vector<int>& unknown,
                               const std::vector<Corner>& corners, double fatness) {
  std::vector<Constraint> all;
  Constraint one;
  for (const Corner& corner : corners) {
    if (cornerConstraint(shape, unknown, corner, fatness, one)) all.push_back(one);
    for (std::size_t k = 1; k < 4; ++k)
      if (corner[0] < corner[k] && edgeConstraint(shape, corner[0], corner[k], one)) all.push_back(one);
  }
  return all;
}

// Of every vertex: its unknown, or -1 for a root.
std::vector<int> unknownsOf(const ColumnSystem& system, const sim::HairMeshShape& shape) {
  std::vector<int> of(shape.positions.size(), -1);
  for (int c = 0; c < system.columns; ++c)
    for (int l = 1; l < system.layers; ++l)
      of[static_cast<std::size_t>(shape.column_first[c] + l)] = system.unknown(c, l);
  return of;
}

// Unknowns that a constraint may couple: those of a prism's corner.
std::vector<std::array<int, 2>> coupled(const std::vector<int>& unknown, const std::vector<Corner>& corners) {
  std::vector<std::array<int, 2>> pairs;
  for (const Corner& corner : corners) {
    for (const int v : corner) {
      for (const int w : corner) {
        const int row = unknown[static_cast<std::size_t>(v)], column = unknown[static_cast<std::size_t>(w)];
        if (column >= 0 && column < row) pairs.push_back({row, column});
      }
    }
  }
  return pairs;
}

// Adds the broken constraints as penalties.
void addPenalties(const std::vector<int>& unknown, const std::vector<Constraint>& constraints, double penalty,
                  BlockMatrix& matrix) {
  for (const Constraint& one : constraints) {
    for (std::size_t i = 0; i < 4; ++i) {
      const int row = one.v[i] < 0 ? -1 : unknown[static_cast<std::size_t>(one.v[i])];
      for (std::size_t j = 0; j < 4 && row >= 0; ++j) {
        const int column = one.v[j] < 0 ? -1 : unknown[static_cast<std::size_t>(one.v[j])];
        if (column < 0 || column > row) continue;
        matrix.at(row, column) += penalty * one.slope[i] * one.slope[j].transpose();
      }
    }
  }
}

// The system's right-hand side with the constraints' linear parts about the present positions.
Eigen::VectorXd penalizedRight(const ColumnSystem& system, const std::vector<int>& unknown,
                               const std::vector<Constraint>& constraints, double penalty,
                               const sim::HairMeshShape& shape) {
  Eigen::VectorXd right = system.right;
  for (const Constraint& one : constraints) {
    double wanted = one.lacking;
    for (std::size_t i = 0; i < 4; ++i) {
      if (one.v[i] >= 0 && unknown[static_cast<std::size_t>(one.v[i])] >= 0)
        wanted += one.slope[i].dot(shape.positions[static_cast<std::size_t>(one.v[i])]);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      if (one.v[i] >= 0 && unknown[static_cast<std::size_t>(one.v[i])] >= 0)
        right.segment<3>(3 * unknown[static_cast<std::size_t>(one.v[i])]) += penalty * wanted * one.slope[i];
    }
  }
  return right;
}

}  // namespace

double fitColumns(const ColumnSystem& system, double fatness, const FitRounds& rounds, sim::HairMeshShape& shape) {
  const std::vector<int> unknown = unknownsOf(system, shape);
  const std::vector<Corner> corners = cornersOf(shape);
  BlockMatrix strands(system.unknowns(), system.blocks, coupled(unknown, corners));
  for (int u = 0; u < system.unknowns(); ++u) strands.diagonal(u) += 1e-6 * system.usual * Eigen::Matrix3d::Identity();
  Eigen::VectorXd solved(3 * system.unknowns());
  for (int round = rounds.anew ? 0 : 1; round <= rounds.count; ++round) {
    const std::vector<Constraint> constraints =
        round > 0 ? broken(shape, unknown, corners, fatness) : std::vector<Constraint>();
    const double penalty = system.usual * rounds.first *
                           std::pow(rounds.last / rounds.first, round / static_cast<double>(std::max(rounds.count, 1)));
    BlockMatrix matrix = strands;
    addPenalties(unknown, constraints, penalty, matrix);
    const Eigen::VectorXd right = penalizedRight(system, unknown, constraints, penalty, shape);
    for (std::size_t v = 0; v < unknown.size(); ++v)
      if (unknown[v] >= 0) solved.segment<3>(3 * unknown[v]) = shape.positions[v];
    if (round == 0 || !matrix.solveFrom(right, kTolerance, kMaxIterations, solved))
      solved = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix.sparse()).solve(right);
    for (std::size_t v = 0; v < unknown.size(); ++v) {
      if (unknown[v] < 0) continue;
      sim::Vec3 move = solved.segment<3>(3 * unknown[v]) - shape.positions[v];
      if (round > 0) move *= std::min(1.0, kLargestMove / std::max(move.norm(), 1e-12));
      shape.positions[v] += move;
    }
  }
  double least = 1;
  for (const Corner& corner : corners) least = std::min(least, fatnessOf(shape, corner));
  return least;
}

}  // namespace app

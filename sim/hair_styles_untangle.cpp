#include "sim/hair_styles_untangle.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/hair_styles_comb.h"

namespace sim {
namespace {

constexpr int kSweeps = 240;
constexpr double kShortestEdge = 0.0032;  // m: shorter ones ruin the conditioning of the simulator's systems
constexpr double kLargestMove = 0.004;    // m a sweep: large steps would throw neighbours over each other

// Corner, its two neighbours in the layer and the one along the hair, in the order that makes the volume positive.
using Corner = std::array<int, 4>;

std::vector<Corner> corners(const HairMeshShape& shape) {
  std::vector<Corner> out;
  for (const RootFace& face : shape.root_faces) {
    int layers = shape.columnLength(face.columns[0]);
    for (int k = 1; k < face.corner_count; ++k) layers = std::min(layers, shape.columnLength(face.columns[k]));
    const int n = face.corner_count;
    for (int l = 0; l + 1 < layers; ++l) {
      for (int k = 0; k < n; ++k) {
        const int here = shape.column_first[face.columns[k]] + l;
        const int next = shape.column_first[face.columns[(k + 1) % n]] + l;
        const int previous = shape.column_first[face.columns[(k + n - 1) % n]] + l;
        out.push_back({here, next, previous, here + 1});
        out.push_back({here + 1, previous + 1, next + 1, here});
      }
    }
  }
  return out;
}

struct Neighbours {
  std::vector<int> first{0}, list;
};

// Every vertex's neighbours along its column and in its layer.
Neighbours neighbours(const HairMeshShape& shape, const std::vector<Corner>& all) {
  std::vector<std::array<int, 2>> pairs;
  for (const Corner& c : all)
    for (int k = 1; k < 4; ++k) pairs.push_back({c[0], c[k]});
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  Neighbours out;
  std::size_t i = 0;
  for (int v = 0; v < shape.vertexCount(); ++v) {
    for (; i < pairs.size() && pairs[i][0] == v; ++i) out.list.push_back(pairs[i][1]);
    out.first.push_back(static_cast<int>(out.list.size()));
  }
  return out;
}

}  // namespace

double cornerFatness(const Vec3& corner, const Vec3& next, const Vec3& previous, const Vec3& along) {
  const Vec3 a = next - corner, b = previous - corner, c = along - corner;
  return a.cross(b).dot(c) / std::max(a.norm() * b.norm() * c.norm(), 1e-30);
}

double untangle(const BodyDistance& body, double fatness, double gap, HairMeshShape& shape) {
  const std::vector<Corner> all = corners(shape);
  const Neighbours near = neighbours(shape, all);
  std::vector<bool> root(shape.positions.size(), false);
  for (int c = 0; c < shape.columnCount(); ++c) root[shape.column_first[c]] = true;
  std::vector<Vec3>& x = shape.positions;
  const std::vector<Vec3> combed = x;
  std::vector<Vec3> moved(x.size()), asked_at = x;
  std::vector<double> clearance(x.size(), -1e9);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    bool bad = false;
    for (const Corner& t : all) {
      const Vec3 a = x[t[1]] - x[t[0]], b = x[t[2]] - x[t[0]], c = x[t[3]] - x[t[0]];
      const double box = a.norm() * b.norm() * c.norm();
      const double lacking = 1.15 * fatness * box - a.cross(b).dot(c);
      if (lacking <= 0) continue;
      bad = bad || lacking > 0.15 * fatness * box;
      std::array<Vec3, 4> slope{Vec3::Zero(), b.cross(c), c.cross(a), a.cross(b)};
      slope[0] = -slope[1] - slope[2] - slope[3];
      double sum = 0;
      for (int k = 0; k < 4; ++k) sum += root[t[k]] ? 0.0 : slope[k].squaredNorm();
      if (sum < 1e-24) continue;
      for (int k = 0; k < 4; ++k) {
        if (root[t[k]]) continue;
        Vec3 move = 0.8 * lacking / sum * slope[k];
        move *= std::min(1.0, kLargestMove / std::max(move.norm(), 1e-12));
        x[t[k]] += move;
      }
    }
    for (std::size_t v = 0; v < x.size(); ++v) {
      for (int i = near.first[v]; i < near.first[v + 1]; ++i) {
        const std::size_t w = near.list[i];
        if (w < v || (root[v] && root[w])) continue;
        const Vec3 edge = x[w] - x[v];
        const double length = edge.norm();
        if (length >= kShortestEdge) continue;
        bad = bad || length < 0.95 * kShortestEdge;
        const Vec3 way = length > 1e-6 ? Vec3(edge / length) : Vec3((combed[w] - combed[v]).normalized());
        const double share = root[v] || root[w] ? 1.0 : 0.5;
        if (!root[v]) x[v] -= share * (kShortestEdge - length) * way;
        if (!root[w]) x[w] += share * (kShortestEdge - length) * way;
      }
    }
    if (!bad) break;
    // Spread what was moved over the neighbourhood, so that the combed shape stays smooth; less and less, so that it
    // ends.
    const double spread = 0.2 * (1 - static_cast<double>(sweep) / kSweeps);
    for (std::size_t v = 0; v < x.size(); ++v) {
      moved[v] = x[v] - combed[v];
      if (root[v]) continue;
      Vec3 sum = Vec3::Zero();
      for (int i = near.first[v]; i < near.first[v + 1]; ++i) sum += x[near.list[i]] - combed[near.list[i]];
      const int count = near.first[v + 1] - near.first[v];
      if (count > 0) moved[v] = (1 - spread) * moved[v] + spread / count * sum;
    }
    for (std::size_t v = 0; v < x.size(); ++v) {
      if (root[v]) continue;
      x[v] = combed[v] + moved[v];
      // The distance is the dear part: a vertex that stands clear of the body is asked again only when it may have come
      // near.
      if (clearance[v] - (x[v] - asked_at[v]).norm() >= gap) continue;
      clearance[v] = body(x[v]);
      asked_at[v] = x[v];
      if (clearance[v] < gap) x[v] += (gap - clearance[v]) * bodyNormal(body, x[v]);
    }
  }
  double worst = 1;
  for (const Corner& t : all) worst = std::min(worst, cornerFatness(x[t[0]], x[t[1]], x[t[2]], x[t[3]]));
  return worst;
}

}  // namespace sim

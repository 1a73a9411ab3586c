// Edits of which columns bundles share, and new bundles at the border.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include "app/files/errors.h"
#include "app/groom/edit/mesh_edit.h"
#include "app/groom/edit/shape_brush.h"
#include "app/styles/style_untangle.h"

namespace app {

namespace {

constexpr double kSameRoot = 0.001;                           // m, between columns that are welded
constexpr double kNarrowestRoot = 0.006, kWidestRoot = 0.03;  // m, of a bundle at its root
constexpr double kTooNear = 0.5;                              // of that: roots of other hair within it
constexpr double kPartedFatness = 0.03, kGapToBody = 0.0025;  // see untangle; m
constexpr int kMaxUntanglings = 8;

using RootEdgeKey = std::pair<int, int>;  // columns, the lower one first

RootEdgeKey keyOf(int a, int b) {
  return {std::min(a, b), std::max(a, b)};
}

// The faces at each root edge.
std::map<RootEdgeKey, std::vector<int>> facesAtEdges(const sim::HairMeshShape& shape) {
  std::map<RootEdgeKey, std::vector<int>> faces;
  for (std::size_t f = 0; f < shape.root_faces.size(); ++f) {
    const sim::RootFace& face = shape.root_faces[f];
    for (int k = 0; k < face.corner_count; ++k)
      faces[keyOf(face.columns[static_cast<std::size_t>(k)],
                  face.columns[static_cast<std::size_t>((k + 1) % face.corner_count)])]
          .push_back(static_cast<int>(f));
  }
  return faces;
}

int firstVertex(const sim::HairMeshShape& shape, int column) {
  return shape.column_first[static_cast<std::size_t>(column)];
}

const Vec3& rootOf(const sim::HairMeshShape& shape, int column) {
  return shape.positions[static_cast<std::size_t>(firstVertex(shape, column))];
}

// Adds the first `length` vertices of an old column as a new one.
void copyColumn(const sim::HairMeshShape& shape, int column, int length, EditedMesh& edited) {
  const int first = firstVertex(shape, column);
  for (int v = first; v < first + length; ++v) {
    edited.shape.positions.push_back(shape.positions[static_cast<std::size_t>(v)]);
    edited.sources.push_back({v, v, 0});
  }
  edited.shape.column_first.push_back(static_cast<int>(edited.shape.positions.size()));
}

void requireValid(const sim::HairMeshShape& shape, const char* what, const char* mend) {
  try {
    sim::buildHairMesh(shape);
  } catch (const sim::MeshError& error) {
    throw InputError("", what, "would spoil " + error.place + ", where " + error.fault, mend);
  }
}

// The faces about a column in groups that hang together by edges at it which are not cut.
std::vector<std::vector<int>> fansAbout(int column, const std::vector<int>& faces, const sim::HairMeshShape& shape,
                                        const std::map<RootEdgeKey, std::vector<int>>& at_edges,
                                        const std::set<RootEdgeKey>& cut) {
  std::vector<std::vector<int>> fans;
  std::set<int> left(faces.begin(), faces.end());
  while (!left.empty()) {
    std::vector<int> fan{*left.begin()};
    left.erase(left.begin());
    for (std::size_t next = 0; next < fan.size(); ++next) {
      const sim::RootFace& face = shape.root_faces[static_cast<std::size_t>(fan[next])];
      for (int k = 0; k < face.corner_count; ++k) {
        const RootEdgeKey edge = keyOf(face.columns[static_cast<std::size_t>(k)],
                                       face.columns[static_cast<std::size_t>((k + 1) % face.corner_count)]);
        if ((edge.first != column && edge.second != column) || cut.contains(edge)) continue;
        for (const int other : at_edges.at(edge)) {
          if (left.erase(other)) fan.push_back(other);
        }
      }
    }
    std::ranges::sort(fan);
    fans.push_back(std::move(fan));
  }
  return fans;
}

int reachOf(const std::vector<int>& faces, const sim::HairMeshShape& shape) {
  int layers = 0;
  for (const int f : faces)
    layers = std::max(layers, shape.bundleLayers(shape.root_faces[static_cast<std::size_t>(f)]));
  return layers;
}

void requireColumn(const sim::HairMeshShape& shape, int column) {
  if (column < 0 || column >= shape.columnCount())
    throw InputError("", "column " + std::to_string(column), "is not there",
                     "name columns from 0 to " + std::to_string(shape.columnCount() - 1));
}

// Root edges as neighbours of columns, and which columns are the likes of others on the other side of a plane.
class Mirror {
 public:
  Mirror(const sim::HairMeshShape& shape, double middle) : shape_(shape), middle_(middle) {
    for (const auto& [edge, faces] : facesAtEdges(shape)) {
      beside_[edge.first].insert(edge.second);
      beside_[edge.second].insert(edge.first);
    }
  }

  // The nearest column to the mirrored root, and those that root where it does.
  std::vector<int> likesOf(int column) const {
    requireColumn(shape_, column);
    const Vec3 place = mirrored(rootOf(shape_, column), middle_);
    double nearest = INFINITY, longest = 0;
    for (int c = 0; c < shape_.columnCount(); ++c) nearest = std::min(nearest, (rootOf(shape_, c) - place).norm());
    for (const int c : besides(column))
      longest = std::max(longest, (rootOf(shape_, c) - rootOf(shape_, column)).norm());
    if (nearest > longest)
      throw InputError("", "column " + std::to_string(column), "has no like on the other side of the head",
                       "turn the mirror off, or choose where hair is on both sides");
    std::vector<int> likes;
    for (int c = 0; c < shape_.columnCount(); ++c) {
      if ((rootOf(shape_, c) - place).norm() < nearest + kSameRoot) likes.push_back(c);
    }
    return likes;
  }

  // Edges from one's likes to the other's, the fewest that join them; none where they share one.
  std::vector<ColumnPair> edgesBetween(int one, int other) const {
    const std::vector<int> from = likesOf(one), to = likesOf(other);
    std::map<int, int> came;  // from where each was reached first
    std::vector<int> reached(from);
    for (const int c : from) came[c] = c;
    for (std::size_t next = 0; next < reached.size(); ++next) {
      const int c = reached[next];
      if (std::ranges::count(to, c)) {
        std::vector<ColumnPair> way;
        for (int at = c; came[at] != at; at = came[at]) way.push_back({came[at], at});
        return way;
      }
      for (const int d : besides(c)) {
        if (came.emplace(d, c).second) reached.push_back(d);
      }
    }
    return {};
  }

  const std::set<int>& besides(int column) const {
    static const std::set<int> kNone;
    const auto at = beside_.find(column);
    return at == beside_.end() ? kNone : at->second;
  }

 private:
  const sim::HairMeshShape& shape_;
  double middle_;
  std::map<int, std::set<int>> beside_;
};

}  // namespace

std::vector<ColumnPair> withMirrored(const sim::HairMeshShape& shape, std::span<const ColumnPair> edges,
                                     double middle) {
  const Mirror mirror(shape, middle);
  std::vector<ColumnPair> both(edges.begin(), edges.end());
  for (const ColumnPair& edge : edges) {
    const std::vector<ColumnPair> more = mirror.edgesBetween(edge.a, edge.b);
    both.insert(both.end(), more.begin(), more.end());
  }
  return both;
}

std::vector<int> withMirrored(const sim::HairMeshShape& shape, std::span<const int> columns, double middle) {
  const Mirror mirror(shape, middle);
  std::set<int> both(columns.begin(), columns.end());
  for (const int c : columns) {
    for (const int like : mirror.likesOf(c)) both.insert(like);
    for (const int other : columns) {
      if (!mirror.besides(c).contains(other)) continue;
      for (const ColumnPair& edge : mirror.edgesBetween(c, other)) both.insert({edge.a, edge.b});
    }
  }
  return {both.begin(), both.end()};
}

EditedMesh splitColumns(const sim::HairMeshShape& shape, std::span<const ColumnPair> edges) {
  const std::map<RootEdgeKey, std::vector<int>> at_edges = facesAtEdges(shape);
  std::set<RootEdgeKey> cut;
  std::map<int, std::vector<int>> touched;  // columns of the cut, with their faces
  for (const ColumnPair& edge : edges) {
    const auto at = at_edges.find(keyOf(edge.a, edge.b));
    if (at == at_edges.end())
      throw InputError("", "columns " + std::to_string(edge.a) + " and " + std::to_string(edge.b), "share no edge",
                       "choose neighbouring columns");
    if (at->second.size() < 2) continue;
    cut.insert(at->first);
    touched[edge.a], touched[edge.b];
  }
  for (std::size_t f = 0; f < shape.root_faces.size(); ++f) {
    const sim::RootFace& face = shape.root_faces[f];
    for (int k = 0; k < face.corner_count; ++k) {
      const auto at = touched.find(face.columns[static_cast<std::size_t>(k)]);
      if (at != touched.end()) at->second.push_back(static_cast<int>(f));
    }
  }
  std::map<int, std::vector<std::vector<int>>> fans;
  bool parts = false;
  for (const auto& [column, faces] : touched) {
    fans[column] = fansAbout(column, faces, shape, at_edges, cut);
    parts = parts || fans[column].size() > 1;
  }
  if (!parts)
    throw InputError("", "the parting", "parts nothing", "draw it over two edges in a row, or out to the border");
  EditedMesh edited;
  edited.shape.root_faces = shape.root_faces;
  for (int c = 0; c < shape.columnCount(); ++c) {
    const auto at = fans.find(c);
    copyColumn(shape, c, at == fans.end() ? shape.columnLength(c) : reachOf(at->second.front(), shape), edited);
  }
  for (const auto& [column, groups] : fans) {
    for (std::size_t g = 1; g < groups.size(); ++g) {
      const int copy = edited.shape.columnCount();
      copyColumn(shape, column, reachOf(groups[g], shape), edited);
      for (const int f : groups[g])
        std::ranges::replace(edited.shape.root_faces[static_cast<std::size_t>(f)].columns, column, copy);
    }
  }
  requireValid(edited.shape, "the parting", "draw it elsewhere");
  return edited;
}

EditedMesh mergeColumns(const sim::HairMeshShape& shape, std::span<const int> columns) {
  std::vector<int> weld(static_cast<std::size_t>(shape.columnCount()));
  std::iota(weld.begin(), weld.end(), 0);
  bool any = false;
  for (const int c : columns) {
    requireColumn(shape, c);
    for (int other = 0; other < shape.columnCount(); ++other) {
      if (other == c || (rootOf(shape, other) - rootOf(shape, c)).norm() > kSameRoot) continue;
      const int low = std::min(weld[static_cast<std::size_t>(c)], weld[static_cast<std::size_t>(other)]);
      weld[static_cast<std::size_t>(c)] = weld[static_cast<std::size_t>(other)] = low;
      any = true;
    }
  }
  if (!any) throw InputError("", "the chosen columns", "root beside no other", "choose columns along a parting");
  std::map<int, std::vector<int>> members;
  for (int c = 0; c < shape.columnCount(); ++c) members[weld[static_cast<std::size_t>(c)]].push_back(c);
  EditedMesh edited;
  std::vector<int> number(weld.size(), -1);
  for (const auto& [low, of] : members) {
    number[static_cast<std::size_t>(low)] = edited.shape.columnCount();
    int length = 0;
    for (const int c : of) length = std::max(length, shape.columnLength(c));
    for (int l = 0; l < length; ++l) {
      std::vector<int> at;
      Vec3 mean = Vec3::Zero();
      for (const int c : of) {
        if (l < shape.columnLength(c)) at.push_back(firstVertex(shape, c) + l);
      }
      for (const int v : at) mean += shape.positions[static_cast<std::size_t>(v)] / static_cast<double>(at.size());
      for (const int v : at)
        edited.moved = std::max(edited.moved, (shape.positions[static_cast<std::size_t>(v)] - mean).norm());
      edited.shape.positions.push_back(at.size() == 1 ? shape.positions[static_cast<std::size_t>(at[0])] : mean);
      edited.sources.push_back({at.front(), at.back(), at.size() == 1 ? 0 : 0.5});
    }
    edited.shape.column_first.push_back(static_cast<int>(edited.shape.positions.size()));
  }
  edited.shape.root_faces = shape.root_faces;
  for (sim::RootFace& face : edited.shape.root_faces) {
    for (int k = 0; k < face.corner_count; ++k) {
      int& c = face.columns[static_cast<std::size_t>(k)];
      c = number[static_cast<std::size_t>(weld[static_cast<std::size_t>(c)])];
    }
  }
  requireValid(edited.shape, "the weld", "comb the two sides together first");
  return edited;
}

namespace {

// A border edge of the scalp layer, as its face winds it.
std::vector<ColumnPair> borderEdges(const sim::HairMeshShape& shape, std::span<const ColumnPair> edges) {
  const std::map<RootEdgeKey, std::vector<int>> at_edges = facesAtEdges(shape);
  std::vector<ColumnPair> border;
  std::set<RootEdgeKey> seen;
  for (const ColumnPair& edge : edges) {
    const auto at = at_edges.find(keyOf(edge.a, edge.b));
    if (at == at_edges.end() || at->second.size() != 1 || !seen.insert(at->first).second) continue;
    const sim::RootFace& face = shape.root_faces[static_cast<std::size_t>(at->second.front())];
    for (int k = 0; k < face.corner_count; ++k) {
      const int a = face.columns[static_cast<std::size_t>(k)],
                b = face.columns[static_cast<std::size_t>((k + 1) % face.corner_count)];
      if (keyOf(a, b) == at->first) border.push_back({a, b});
    }
  }
  if (border.empty())
    throw InputError("", "the chosen edges", "have hair on both sides", "choose edges of the hair mesh's border");
  return border;
}

// A column over bare scalp, beside an old one or half-way between two.
struct NewColumn {
  int a = 0, b = 0;
  Vec3 away = Vec3::Zero();  // from the border
  double edges = 0;          // m, the length of the border's edges there
  int edge_count = 0, layers = 0;
};

// New bundles end in points: a chain of edges has new columns beside those columns that two of its edges share, and one
// edge alone has a column before its middle. By the columns that they stand beside.
std::map<RootEdgeKey, NewColumn> newColumns(const sim::HairMeshShape& shape, const std::vector<ColumnPair>& border,
                                            const Scalp& scalp) {
  std::map<int, int> edges;
  for (const ColumnPair& edge : border) ++edges[edge.a], ++edges[edge.b];
  std::map<RootEdgeKey, NewColumn> columns;
  for (const ColumnPair& edge : border) {
    const Vec3 &a = rootOf(shape, edge.a), &b = rootOf(shape, edge.b);
    const Vec3 normal = (0.5 * (a + b) - scalp.center).normalized();
    const auto add = [&](int one, int other) {
      NewColumn& column = columns[{one, other}];
      column.a = one, column.b = other;
      column.away += (b - a).cross(normal).normalized();
      column.edges += (b - a).norm(), ++column.edge_count;
      const int layers = std::min(shape.columnLength(edge.a), shape.columnLength(edge.b));
      column.layers = std::max(column.layers, layers);
    };
    for (const int c : {edge.a, edge.b}) {
      if (edges[c] > 1) add(c, c);
    }
    if (edges[edge.a] == 1 && edges[edge.b] == 1) add(edge.a, edge.b);
  }
  return columns;
}

// As far out as the edges are long.
Vec3 rootBeside(const NewColumn& column, const sim::HairMeshShape& shape, const Scalp& scalp) {
  const Vec3 here = 0.5 * (rootOf(shape, column.a) + rootOf(shape, column.b)) - scalp.center;
  const double wide = std::clamp(column.edges / column.edge_count, kNarrowestRoot, kWidestRoot);
  const Vec3 way = here + wide * column.away.normalized();
  const Vec3 root = scalp.center + (scalp.radiusAt(way) + here.norm() - scalp.radiusAt(here)) * way.normalized();
  for (int other = 0; other < shape.columnCount(); ++other) {
    if ((rootOf(shape, other) - root).norm() < kTooNear * wide)
      throw InputError("", "beside column " + std::to_string(column.a), "there is hair already",
                       "choose edges that border on bare scalp");
  }
  return root;
}

// In the shape of the hair beside it.
void addColumn(const NewColumn& column, const Vec3& root, const sim::HairMeshShape& shape, EditedMesh& edited) {
  const Vec3 way = root - 0.5 * (rootOf(shape, column.a) + rootOf(shape, column.b));
  for (int l = 0; l < column.layers; ++l) {
    const VertexSource source{firstVertex(shape, column.a) + l, firstVertex(shape, column.b) + l, 0.5};
    const auto at = [&](int v) { return shape.positions[static_cast<std::size_t>(v)]; };
    edited.shape.positions.push_back(0.5 * (at(source.from) + at(source.to)) + way);
    edited.sources.push_back(source);
  }
  edited.shape.column_first.push_back(static_cast<int>(edited.shape.positions.size()));
}

}  // namespace

EditedMesh extrudeColumns(const sim::HairMeshShape& shape, std::span<const ColumnPair> edges, const Scalp& scalp,
                          const BodyDistance& body) {
  const std::vector<ColumnPair> border = borderEdges(shape, edges);
  EditedMesh edited;
  edited.shape.root_faces = shape.root_faces;
  for (int c = 0; c < shape.columnCount(); ++c) copyColumn(shape, c, shape.columnLength(c), edited);
  std::map<RootEdgeKey, int> fresh;
  for (const auto& [beside, column] : newColumns(shape, border, scalp)) {
    fresh[beside] = edited.shape.columnCount();
    addColumn(column, rootBeside(column, shape, scalp), shape, edited);
  }
  for (const ColumnPair& edge : border) {
    sim::RootFace face{2, {edge.b, edge.a, -1, -1}};
    for (const RootEdgeKey& beside : {RootEdgeKey{edge.a, edge.a}, {edge.a, edge.b}, {edge.b, edge.b}}) {
      if (fresh.contains(beside)) face.columns[static_cast<std::size_t>(face.corner_count++)] = fresh[beside];
    }
    edited.shape.root_faces.push_back(face);
  }
  const BodyDistance around = body ? body : [](const Vec3&) { return 1.0; };
  for (int round = 0; round < kMaxUntanglings && untangle(around, kPartedFatness, kGapToBody, edited.shape) <= 0;
       ++round) {
  }
  for (std::size_t v = 0; v < shape.positions.size(); ++v)
    edited.moved = std::max(edited.moved, (edited.shape.positions[v] - shape.positions[v]).norm());
  requireValid(edited.shape, "the new bundle", "choose other edges, or lift the hair beside it off the head first");
  return edited;
}

}  // namespace app

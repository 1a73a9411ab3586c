#include "sim/mesh/hair_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "sim/mesh/rest_measures.h"

namespace sim {

MeshError::MeshError(std::string place_, std::string fault_, std::string mend_)
    : std::runtime_error(place_ + ": " + fault_ + "; " + mend_),
      place(std::move(place_)),
      fault(std::move(fault_)),
      mend(std::move(mend_)) {}

namespace {

constexpr double kLargestCoordinate = 1e3;

std::string faceName(int f) {
  return "root face " + std::to_string(f);
}
std::string vertexName(int column, int layer) {
  return "column " + std::to_string(column) + ", layer " + std::to_string(layer);
}

void checkShape(const HairMeshShape& shape) {
  if (shape.root_faces.empty())
    throw MeshError("hair mesh", "it has no root face", "add at least one triangle or quad");
  if (shape.column_first.empty() || shape.column_first.front() != 0 ||
      static_cast<int>(shape.positions.size()) != shape.vertexCount()) {
    throw MeshError("hair mesh", "columns and positions do not agree in number", "give one position per vertex");
  }
  for (int c = 0; c < shape.columnCount(); ++c) {
    if (shape.columnLength(c) < 2) {
      throw MeshError("column " + std::to_string(c), "it has fewer than two layers", "extrude it at least once");
    }
  }
  for (int c = 0; c < shape.columnCount(); ++c) {
    for (int l = 0; l < shape.columnLength(c); ++l) {
      const Vec3& p = shape.positions[shape.column_first[c] + l];
      if (!p.allFinite() || p.cwiseAbs().maxCoeff() > kLargestCoordinate) {
        throw MeshError(vertexName(c, l), "its position is not finite or beyond 1000 m", "give metres near the head");
      }
    }
  }
}

// Checks the root faces and returns how often each column is used.
void checkRootFaces(const HairMeshShape& shape) {
  std::vector<int> uses(shape.columnCount(), 0);
  std::set<std::vector<int>> seen;
  std::map<std::pair<int, int>, int> directed;
  for (int f = 0; f < static_cast<int>(shape.root_faces.size()); ++f) {
    const RootFace& face = shape.root_faces[f];
    if (face.corner_count != 3 && face.corner_count != 4) {
      throw MeshError(faceName(f), "it has " + std::to_string(face.corner_count) + " corners",
                      "use triangles and quads");
    }
    std::vector<int> sorted(face.columns.begin(), face.columns.begin() + face.corner_count);
    for (int c : sorted) {
      if (c < 0 || c >= shape.columnCount()) {
        throw MeshError(faceName(f), "it names column " + std::to_string(c) + ", which does not exist",
                        "name columns 0 to " + std::to_string(shape.columnCount() - 1));
      }
      ++uses[c];
    }
    for (int k = 0; k < face.corner_count; ++k) {
      const std::pair<int, int> edge{face.columns[k], face.columns[(k + 1) % face.corner_count]};
      if (++directed[edge] > 1) {
        throw MeshError(faceName(f),
                        "its edge from column " + std::to_string(edge.first) + " to " + std::to_string(edge.second) +
                            " is wound the same way as a neighbour's, or shared by more than two faces",
                        "wind neighbouring faces alike and let at most two faces share an edge");
      }
    }
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
      throw MeshError(faceName(f), "it uses a column twice", "give it distinct corners");
    }
    if (!seen.insert(sorted).second) throw MeshError(faceName(f), "it duplicates another face", "remove one of them");
    const auto root = [&](int k) -> const Vec3& { return shape.positions[shape.column_first[face.columns[k]]]; };
    Vec3 area = (root(1) - root(0)).cross(root(2) - root(0));
    if (face.corner_count == 4) area += (root(2) - root(0)).cross(root(3) - root(0));
    if (area.norm() / 2 < 1e-9) throw MeshError(faceName(f), "its area is zero", "move its corners apart");
  }
  for (int c = 0; c < shape.columnCount(); ++c) {
    if (uses[c] == 0) throw MeshError("column " + std::to_string(c), "no root face uses it", "remove it or add a face");
  }
}

std::vector<int> bundleLayers(const HairMeshShape& shape) {
  std::vector<int> layers;
  std::vector<int> reached(shape.columnCount(), 0);
  for (const RootFace& face : shape.root_faces) {
    layers.push_back(shape.bundleLayers(face));
    for (int k = 0; k < face.corner_count; ++k)
      reached[face.columns[k]] = std::max(reached[face.columns[k]], layers.back());
  }
  for (int c = 0; c < shape.columnCount(); ++c) {
    if (reached[c] < shape.columnLength(c)) {
      throw MeshError(vertexName(c, reached[c]), "it dangles: no bundle reaches that layer",
                      "shorten the column or lengthen its neighbours");
    }
  }
  return layers;
}

void addPrisms(HairMesh& mesh) {
  const HairMeshShape& shape = mesh.shape;
  for (int f = 0; f < static_cast<int>(shape.root_faces.size()); ++f) {
    const RootFace& face = shape.root_faces[f];
    const int n = face.corner_count;
    for (int l = 0; l + 1 < mesh.bundle_layers[f]; ++l) {
      Prism prism{f, l, n, {-1, -1, -1, -1, -1, -1, -1, -1}, 0};
      for (int k = 0; k < n; ++k) {
        prism.v[k] = shape.column_first[face.columns[k]] + l;
        prism.v[n + k] = prism.v[k] + 1;
      }
      std::array<CornerTet, 8> tets;
      double sum = 0;
      for (int k = 0; k < 2 * n; ++k) {
        CornerTet& tet = tets[k];
        const std::array<int, 4> corners = cornerTetOf(k, n);
        for (int i = 0; i < 4; ++i) tet.v[i] = prism.v[corners[i]];
        tet.rest_volume = cornerVolume(tet.v, shape.positions);
        if (!(tet.rest_volume > kSmallestCornerVolume)) {
          throw MeshError(faceName(f) + ", layer " + std::to_string(l) + ", corner " + std::to_string(k),
                          "the prism is flat or inverted there", "move its corners so that the layers do not cross");
        }
        sum += tet.rest_volume;
      }
      prism.volume = prismVolume(sum, n);
      for (int k = 0; k < 2 * n; ++k) {
        tets[k].volume = prism.volume / (2 * n);
        mesh.tets.push_back(tets[k]);
        mesh.vertex_volume[prism.v[k]] += prism.volume / (2 * n);
      }
      mesh.prisms.push_back(prism);
      mesh.total_volume += prism.volume;
    }
  }
}

// What is known of a root edge while walls are collected: columns a -> b as its first face winds it, its walls.
struct RootEdge {
  int a, b;
  std::vector<Wall> walls;  // by layer
  std::vector<int> users;   // prisms that see the wall
};

std::vector<RootEdge> collectRootEdges(HairMesh& mesh) {
  const HairMeshShape& shape = mesh.shape;
  std::map<std::pair<int, int>, int> number;
  std::vector<RootEdge> edges;
  std::size_t next_prism = 0;
  for (int f = 0; f < static_cast<int>(shape.root_faces.size()); ++f) {
    const RootFace& face = shape.root_faces[f];
    const int layers = mesh.bundle_layers[f];
    for (int k = 0; k < face.corner_count; ++k) {
      const int a = face.columns[k], b = face.columns[(k + 1) % face.corner_count];
      const auto [it, is_new] = number.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<int>(edges.size()));
      if (is_new) edges.push_back({a, b, {}, {}});
      RootEdge& edge = edges[it->second];
      for (int l = 0; l + 1 < layers; ++l) {
        if (l >= static_cast<int>(edge.walls.size())) {
          const int va = shape.column_first[a] + l, vb = shape.column_first[b] + l;
          edge.walls.push_back({{va, vb, vb + 1, va + 1}, 0, true});
          edge.users.push_back(0);
        }
        ++edge.users[l];
        edge.walls[l].volume += mesh.prisms[next_prism + l].volume / face.corner_count;
      }
    }
    next_prism += layers - 1;
  }
  return edges;
}

double checkedLength(const HairMesh& mesh, int a, int b) {
  const double length = (mesh.shape.positions[a] - mesh.shape.positions[b]).norm();
  if (length < kShortestRestEdge) {
    throw MeshError(
        vertexName(mesh.column_of[a], mesh.layer_of[a]) + " to " + vertexName(mesh.column_of[b], mesh.layer_of[b]),
        "the edge is shorter than 0.01 mm", "move the vertices apart or merge the columns");
  }
  return length;
}

void addWallsAndEdges(HairMesh& mesh) {
  std::vector<double> vertical_volume(mesh.vertexCount(), 0);  // by the edge's lower vertex
  for (const Prism& prism : mesh.prisms) {
    for (int k = 0; k < prism.corner_count; ++k) vertical_volume[prism.v[k]] += prism.volume / prism.corner_count;
  }
  for (int c = 0; c < mesh.columnCount(); ++c) {
    for (int v = mesh.shape.column_first[c]; v + 1 < mesh.shape.column_first[c + 1]; ++v) {
      mesh.vertical_edges.push_back({v, v + 1, checkedLength(mesh, v, v + 1), vertical_volume[v]});
    }
  }
  for (RootEdge& edge : collectRootEdges(mesh)) {
    const int count = static_cast<int>(edge.walls.size());
    checkedLength(mesh, edge.walls[0].v[0], edge.walls[0].v[1]);  // the scalp's own edge
    for (int l = 0; l < count; ++l) {
      edge.walls[l].external = edge.users[l] == 1;
      mesh.walls.push_back(edge.walls[l]);
      // Each wall lends half its volume to its lower and to its upper edge.
      const double above = l + 1 < count ? edge.walls[l + 1].volume / 2 : 0;
      const int a = edge.walls[l].v[3], b = edge.walls[l].v[2];
      mesh.horizontal_edges.push_back({a, b, checkedLength(mesh, a, b), edge.walls[l].volume / 2 + above});
      if (edge.users[l] == 1) mesh.external_faces.push_back({4, edge.walls[l].v});
    }
    for (int l = 1; l < count; ++l) {
      // Corners by column, since a wall may be wound either way once its first face has ended.
      const int a = mesh.shape.column_first[edge.a] + l, b = mesh.shape.column_first[edge.b] + l;
      Hinge hinge{{a - 1, b - 1, a, b, a + 1, b + 1}, 0, 0, (edge.walls[l - 1].volume + edge.walls[l].volume) / 2};
      measureHinge(mesh.shape.positions, hinge);
      mesh.hinges.push_back(hinge);
    }
  }
}

void addExternal(HairMesh& mesh) {
  for (int f = 0; f < static_cast<int>(mesh.shape.root_faces.size()); ++f) {
    const RootFace& face = mesh.shape.root_faces[f];
    ExternalFace cap{face.corner_count, {-1, -1, -1, -1}};
    for (int k = 0; k < face.corner_count; ++k) {
      cap.v[k] = mesh.shape.column_first[face.columns[k]] + mesh.bundle_layers[f] - 1;
    }
    mesh.external_faces.push_back(cap);
  }
  std::set<int> external;
  for (const ExternalFace& face : mesh.external_faces) {
    for (int k = 0; k < face.corner_count; ++k) {
      if (!mesh.isRoot(face.v[k])) external.insert(face.v[k]);
    }
  }
  mesh.external_vertices.assign(external.begin(), external.end());
}

}  // namespace

HairMesh buildHairMesh(HairMeshShape shape) {
  checkShape(shape);
  checkRootFaces(shape);
  HairMesh mesh;
  mesh.bundle_layers = bundleLayers(shape);
  mesh.shape = std::move(shape);
  mesh.column_of.resize(mesh.vertexCount());
  mesh.layer_of.resize(mesh.vertexCount());
  mesh.vertex_volume.assign(mesh.vertexCount(), 0.0);
  for (int c = 0; c < mesh.columnCount(); ++c) {
    for (int l = 0; l < mesh.shape.columnLength(c); ++l) {
      const int v = mesh.shape.column_first[c] + l;
      mesh.column_of[v] = c;
      mesh.layer_of[v] = l;
    }
  }
  mesh.hair_length = hairLength(mesh.shape);
  addPrisms(mesh);
  addWallsAndEdges(mesh);
  addExternal(mesh);
  return mesh;
}

}  // namespace sim

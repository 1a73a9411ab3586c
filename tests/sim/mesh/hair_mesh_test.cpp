// The hair mesh: its counts, its closed surface, its volumes, and a message for every fault.
#include "sim/mesh/hair_mesh.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <map>
#include <set>

#include "tests/test_meshes.h"

namespace hair_mesh_test {

using sim::HairMesh;
using sim::HairMeshShape;
using sim::Vec3;
using test::PatchOptions;

std::vector<PatchOptions> patches() {
  std::vector<PatchOptions> all;
  for (const Vec3& direction : {Vec3(0, -1, 0), Vec3(0, 1, 0)}) {
    for (int kind = 0; kind < 4; ++kind) {
      PatchOptions o;
      o.nx = 3, o.nz = 2, o.direction = direction;
      o.mixed = kind & 1, o.uneven = kind & 2;
      all.push_back(o);
    }
  }
  all.push_back({1, 1, 2});
  return all;
}

// What the mesh must contain, counted in another way than it is built: root edges as sets, a wall wherever a bundle
// that has the edge reaches.
struct Counts {
  int columns = 0, faces = 0, edges = 0, prisms = 0, tets = 0, walls = 0, external_walls = 0, hinges = 0;
};

Counts countByHand(const HairMesh& mesh) {
  Counts n;
  n.columns = mesh.columnCount();
  n.faces = static_cast<int>(mesh.shape.root_faces.size());
  std::map<std::set<int>, std::map<int, int>> users;  // root edge -> layer -> bundles with a wall there
  for (const sim::RootFace& face : mesh.shape.root_faces) {
    int layers = 1 << 20;
    for (int k = 0; k < face.corner_count; ++k) layers = std::min(layers, mesh.shape.columnLength(face.columns[k]));
    n.prisms += layers - 1;
    n.tets += (layers - 1) * 2 * face.corner_count;
    for (int k = 0; k < face.corner_count; ++k) {
      for (int l = 0; l + 1 < layers; ++l) {
        ++users[{face.columns[k], face.columns[(k + 1) % face.corner_count]}][l];
      }
    }
  }
  n.edges = static_cast<int>(users.size());
  for (const auto& [edge, layers] : users) {
    n.walls += static_cast<int>(layers.size());
    n.hinges += static_cast<int>(layers.size()) - 1;
    for (const auto& [layer, count] : layers) n.external_walls += count == 1;
  }
  return n;
}

// The faces of the whole boundary: the external ones and the scalp layer, wound to face out of the hair.
std::vector<std::vector<int>> boundary(const HairMesh& mesh) {
  std::vector<std::vector<int>> faces;
  for (const sim::ExternalFace& face : mesh.external_faces)
    faces.emplace_back(face.v.begin(), face.v.begin() + face.corner_count);
  for (const sim::RootFace& root : mesh.shape.root_faces) {
    std::vector<int> face;
    for (int k = root.corner_count - 1; k >= 0; --k) face.push_back(mesh.shape.column_first[root.columns[k]]);
    faces.push_back(face);
  }
  return faces;
}

TEST(HairMesh, CountsFollowFromRootFacesAndColumnLengths) {
  for (const PatchOptions& o : patches()) {
    const HairMesh mesh = sim::buildHairMesh(test::patchShape(o));
    const Counts n = countByHand(mesh);
    EXPECT_EQ(n.columns - n.edges + n.faces, 1) << "the scalp patch is a disc";
    EXPECT_EQ(static_cast<int>(mesh.prisms.size()), n.prisms);
    EXPECT_EQ(static_cast<int>(mesh.tets.size()), n.tets) << "six a triangular prism, eight a quadrilateral one";
    EXPECT_EQ(static_cast<int>(mesh.walls.size()), n.walls);
    EXPECT_EQ(static_cast<int>(mesh.horizontal_edges.size()), n.walls) << "each wall brings its upper edge";
    EXPECT_EQ(static_cast<int>(mesh.vertical_edges.size()), mesh.vertexCount() - n.columns);
    EXPECT_EQ(static_cast<int>(mesh.hinges.size()), n.hinges);
    EXPECT_EQ(static_cast<int>(mesh.external_faces.size()), n.external_walls + n.faces);
    int external_walls = 0;
    for (const sim::Wall& wall : mesh.walls) external_walls += wall.external;
    EXPECT_EQ(external_walls, n.external_walls);
  }
}

TEST(HairMesh, ScalpAndExternalFacesCloseToASphereWoundOutwards) {
  for (const PatchOptions& o : patches()) {
    const HairMesh mesh = sim::buildHairMesh(test::patchShape(o));
    std::map<std::pair<int, int>, int> directed;
    std::set<std::set<int>> edges;
    std::set<int> vertices;
    double enclosed = 0;
    const auto faces = boundary(mesh);
    for (const std::vector<int>& face : faces) {
      for (std::size_t k = 0; k < face.size(); ++k) {
        const int a = face[k], b = face[(k + 1) % face.size()];
        ++directed[{a, b}];
        edges.insert({a, b});
        vertices.insert(a);
      }
      const auto& x = mesh.shape.positions;
      for (std::size_t k = 2; k < face.size(); ++k) enclosed += x[face[0]].dot(x[face[k - 1]].cross(x[face[k]])) / 6;
    }
    for (const auto& [edge, count] : directed) {
      EXPECT_EQ(count, directed.count({edge.second, edge.first}) ? directed.at({edge.second, edge.first}) : 0)
          << "edge " << edge.first << " to " << edge.second << (o.uneven ? ", uneven" : "");
    }
    EXPECT_EQ(static_cast<int>(vertices.size()) - static_cast<int>(edges.size()) + static_cast<int>(faces.size()), 2);
    EXPECT_NEAR(enclosed, mesh.total_volume, 1e-12 * mesh.total_volume + 1e-15) << "divergence theorem; flat faces";
    // External vertices are the surface's, roots left out.
    std::vector<int> expected;
    for (int v : vertices) {
      if (!mesh.isRoot(v)) expected.push_back(v);
    }
    EXPECT_EQ(mesh.external_vertices, expected);
  }
}

TEST(HairMesh, AColumnInsideTheHairIsExternalAtItsTipOnly) {
  const HairMesh mesh = sim::buildHairMesh(test::patchShape({2, 2, 5}));
  const int middle = 4;  // of 3 x 3 columns
  for (int v = mesh.shape.column_first[middle]; v < mesh.shape.column_first[middle + 1]; ++v) {
    const bool external = std::count(mesh.external_vertices.begin(), mesh.external_vertices.end(), v) > 0;
    EXPECT_EQ(external, mesh.layer_of[v] == 4);
  }
  EXPECT_EQ(mesh.external_vertices.size(), 8u * 4 + 1);
}

TEST(HairMesh, VolumesArePositiveAndEveryShareSumsToTheWhole) {
  for (PatchOptions o : patches()) {
    for (const bool guided : {false, true}) {
      const HairMesh mesh = sim::buildHairMesh(guided ? test::combedShape(o) : test::patchShape(o));
      double prisms = 0, tets = 0, vertices = 0, walls = 0, vertical = 0, horizontal = 0;
      for (const sim::Prism& prism : mesh.prisms) {
        EXPECT_GT(prism.volume, 0);
        prisms += prism.volume;
      }
      for (const sim::CornerTet& tet : mesh.tets) {
        EXPECT_GT(tet.rest_volume, 0);
        EXPECT_DOUBLE_EQ(tet.rest_volume, test::tetVolume(tet, mesh.shape.positions));
        tets += tet.volume;
      }
      for (double share : mesh.vertex_volume) {
        EXPECT_GT(share, 0);
        vertices += share;
      }
      for (const sim::Wall& wall : mesh.walls) walls += wall.volume;
      for (const sim::Edge& edge : mesh.vertical_edges) vertical += edge.volume;
      for (const sim::Edge& edge : mesh.horizontal_edges) horizontal += edge.volume;
      const double total = mesh.total_volume, small = 1e-12 * total;
      EXPECT_NEAR(prisms, total, small);
      EXPECT_NEAR(tets, total, small);
      EXPECT_NEAR(vertices, total, small);
      EXPECT_NEAR(walls, total, small);
      EXPECT_NEAR(vertical, total, small);
      // Half of the lowest walls' share belongs to the scalp's edges, which are prescribed and left out.
      double lowest = 0;
      for (const sim::Wall& wall : mesh.walls) lowest += mesh.layer_of[wall.v[0]] == 0 ? wall.volume / 2 : 0;
      EXPECT_NEAR(horizontal, total - lowest, small);
      if (!guided) {
        int cells = o.nx * o.nz * (o.layers - 1) - (o.uneven ? o.nx : 0);
        EXPECT_NEAR(total, cells * o.spacing * o.spacing * o.length / (o.layers - 1), small) << "straight prisms";
      }
    }
  }
}

TEST(HairMesh, RestQuantitiesAreThoseOfTheShape) {
  PatchOptions o;
  o.mixed = o.uneven = true;
  const HairMesh mesh = sim::buildHairMesh(test::combedShape(o));
  const auto& x = mesh.shape.positions;
  double longest = 0;
  for (int c = 0; c < mesh.columnCount(); ++c) {
    double length = 0;
    for (int v = mesh.shape.column_first[c]; v < mesh.shape.column_first[c + 1]; ++v) {
      EXPECT_EQ(mesh.column_of[v], c);
      EXPECT_EQ(mesh.layer_of[v], v - mesh.shape.column_first[c]);
      if (mesh.layer_of[v] > 0) length += (x[v] - x[v - 1]).norm();
    }
    longest = std::max(longest, length);
  }
  EXPECT_DOUBLE_EQ(mesh.hair_length, longest);
  for (const auto* edges : {&mesh.horizontal_edges, &mesh.vertical_edges}) {
    for (const sim::Edge& edge : *edges) EXPECT_DOUBLE_EQ(edge.rest_length, (x[edge.a] - x[edge.b]).norm());
  }
  for (const sim::Edge& edge : mesh.horizontal_edges) {
    EXPECT_EQ(mesh.layer_of[edge.a], mesh.layer_of[edge.b]);
    EXPECT_FALSE(mesh.isRoot(edge.a));
  }
  for (const sim::Hinge& hinge : mesh.hinges) {
    EXPECT_GT(hinge.length, 0);
    EXPECT_GT(hinge.volume, 0);
    for (int k = 0; k < 6; k += 2) {
      EXPECT_EQ(mesh.column_of[hinge.v[k]], mesh.column_of[hinge.v[0]]);
      EXPECT_EQ(mesh.layer_of[hinge.v[k]], mesh.layer_of[hinge.v[0]] + k / 2);
      EXPECT_EQ(hinge.v[k + 1] - mesh.shape.column_first[mesh.column_of[hinge.v[k + 1]]], mesh.layer_of[hinge.v[k]]);
    }
  }
}

struct FaultCase {
  const char* name;
  std::function<void(HairMeshShape&)> spoil;
  const char* place;  // what the message must name
};

// 3 x 3 columns of five layers, four quads, columns 5 i to 5 i + 4.
std::vector<FaultCase> faults() {
  const auto at = [](HairMeshShape& s, int column, int layer) -> Vec3& {
    return s.positions[s.column_first[column] + layer];
  };
  const auto dropTip = [](HairMeshShape& s, int column, int count) {
    for (int k = 0; k < count; ++k) s.positions.erase(s.positions.begin() + s.column_first[column + 1] - 1 - k);
    for (std::size_t c = column + 1; c < s.column_first.size(); ++c) s.column_first[c] -= count;
  };
  return {
      {"no face", [](auto& s) { s.root_faces.clear(); }, "hair mesh"},
      {"nothing at all", [](auto& s) { s = HairMeshShape{}; }, "hair mesh"},
      {"too few positions", [](auto& s) { s.positions.pop_back(); }, "hair mesh"},
      {"a pentagon", [](auto& s) { s.root_faces[1].corner_count = 5; }, "root face 1"},
      {"an edge as a face", [](auto& s) { s.root_faces[1].corner_count = 2; }, "root face 1"},
      {"a repeated column", [](auto& s) { s.root_faces[2].columns[1] = s.root_faces[2].columns[0]; }, "root face 2"},
      {"a column that does not exist", [](auto& s) { s.root_faces[3].columns[2] = 9; }, "root face 3"},
      {"a negative column", [](auto& s) { s.root_faces[3].columns[2] = -7; }, "root face 3"},
      {"a duplicate, wound alike", [](auto& s) { s.root_faces.push_back(s.root_faces[0]); }, "root face 4"},
      {"a duplicate, wound the other way",
       [](auto& s) {
         auto face = s.root_faces[0];
         std::swap(face.columns[1], face.columns[3]);
         s.root_faces = {s.root_faces[0], face, s.root_faces[1]};
       },
       "root face 1"},
      {"a neighbour wound the other way",
       [](auto& s) { std::swap(s.root_faces[1].columns[1], s.root_faces[1].columns[3]); }, "root face 1"},
      {"a column of one layer", [&](auto& s) { dropTip(s, 4, 4); }, "column 4"},
      {"a column that runs backwards", [](auto& s) { s.column_first[3] = 0; }, "column 2"},
      {"a column of no face",
       [](auto& s) {
         for (int l = 0; l < 3; ++l) s.positions.push_back(Vec3(1, -0.1 * l, 1));
         s.column_first.push_back(static_cast<int>(s.positions.size()));
       },
       "column 9"},
      {"a dangling layer",
       [&](auto& s) {
         for (int c : {0, 1, 2, 3, 5, 6, 7, 8}) dropTip(s, c, 1);
       },
       "column 4, layer 4"},
      {"not a number", [at](auto& s) { at(s, 5, 3).y() = std::numeric_limits<double>::quiet_NaN(); },
       "column 5, layer 3"},
      {"infinity", [at](auto& s) { at(s, 5, 3).x() = std::numeric_limits<double>::infinity(); }, "column 5, layer 3"},
      {"1e30", [at](auto& s) { at(s, 7, 1).z() = 1e30; }, "column 7, layer 1"},
      {"a root face without area",
       [at](auto& s) {
         for (int k = 0; k < 4; ++k) at(s, s.root_faces[1].columns[k], 0) = Vec3(0.03, 0, 0.01 * k);
       },
       "root face"},
      {"an inverted prism", [at](auto& s) { at(s, 8, 3) = at(s, 8, 1); }, "root face 3, layer "},
      {"a flat prism",
       [at](auto& s) {
         for (int c = 0; c < 9; ++c) at(s, c, 2) = at(s, c, 1);
       },
       "root face 0, layer 1"},
      {"a short edge along the hair",
       [at](auto& s) {
         for (int c = 0; c < 9; ++c) at(s, c, 2) = at(s, c, 1) + Vec3(0, -5e-6, 0);
       },
       "column 0, layer 1 to column 0, layer 2"},
      {"a short edge across the hair", [at](auto& s) { at(s, 1, 2) = at(s, 0, 2) + Vec3(5e-6, 0, 0); },
       "column 0, layer 2"},
      {"a short edge on the scalp", [at](auto& s) { at(s, 1, 0) = at(s, 0, 0) + Vec3(5e-6, 0, 0); }, "layer 0"},
  };
}

TEST(HairMesh, EveryFaultIsRefusedWithItsPlaceAndMend) {
  for (const FaultCase& fault : faults()) {
    HairMeshShape shape = test::patchShape({2, 2, 5});
    fault.spoil(shape);
    try {
      sim::buildHairMesh(shape);
      ADD_FAILURE() << fault.name << " was accepted";
    } catch (const sim::MeshError& error) {
      EXPECT_NE(error.place.find(fault.place), std::string::npos) << fault.name << ": " << error.what();
      EXPECT_FALSE(error.fault.empty()) << fault.name;
      EXPECT_FALSE(error.mend.empty()) << fault.name;
      EXPECT_NE(std::string(error.what()).find(error.mend), std::string::npos);
    } catch (const std::exception& error) {
      ADD_FAILURE() << fault.name << " came as another exception: " << error.what();
    }
  }
}

}  // namespace hair_mesh_test

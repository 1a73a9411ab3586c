#include "app/groom/strips/strip_patch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <unordered_map>
#include <utility>

namespace app {

namespace {

using Eigen::Vector3d;

constexpr double kSamePlace = 1e-6;  // of the extent

using CornerCell = std::array<long long, 3>;

struct CellHash {
  std::size_t operator()(const CornerCell& cell) const {
    std::size_t hash = 0;
    for (const long long k : cell) hash = hash * 1000003u + static_cast<std::size_t>(k);
    return hash;
  }
};

CornerCell cellOf(const Vector3d& p, double size) {
  return {std::llround(p.x() / size), std::llround(p.y() / size), std::llround(p.z() / size)};
}

struct Sets {
  std::vector<int> parent;
  explicit Sets(std::size_t count) : parent(count) { std::iota(parent.begin(), parent.end(), 0); }
  int find(int i) {
    while (parent[static_cast<std::size_t>(i)] != i) {
      int& up = parent[static_cast<std::size_t>(i)];
      up = parent[static_cast<std::size_t>(up)];
      i = up;
    }
    return i;
  }
  void join(int a, int b) { parent[static_cast<std::size_t>(find(b))] = find(a); }
};

using Edge = std::pair<int, int>;
Edge edgeOf(int a, int b) {
  return {std::min(a, b), std::max(a, b)};
}

// Faces with vertices that stand for a place each.
struct Welded {
  std::vector<Vector3d> at;
  std::vector<std::vector<int>> faces;
  std::vector<int> object;
  std::map<Edge, std::vector<int>> faces_of;  // per edge
};

double extentOf(const PolygonMesh& mesh) {
  if (mesh.positions.empty()) return 1;
  Vector3d low = mesh.positions.front(), high = low;
  for (const Vector3d& p : mesh.positions) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return std::max(1e-12, (high - low).maxCoeff());
}

void addFace(std::vector<int> face, int object, std::set<std::vector<int>>& seen, Welded& out) {
  // Corners that fell together.
  std::vector<int> kept;
  for (std::size_t k = 0; k < face.size(); ++k) {
    if (face[k] != face[(k + 1) % face.size()]) kept.push_back(face[k]);
  }
  std::vector<int> sorted = kept;
  std::sort(sorted.begin(), sorted.end());
  if (kept.size() < 3 || std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) return;
  if (!seen.insert(sorted).second) return;
  out.faces.push_back(std::move(kept));
  out.object.push_back(object);
}

Welded weld(const PolygonMesh& mesh, const std::vector<bool>& taken) {
  Welded out;
  const double size = kSamePlace * extentOf(mesh);
  std::unordered_map<CornerCell, int, CellHash> places;
  std::set<std::vector<int>> seen;
  for (std::size_t f = 0; f < mesh.faceCount(); ++f) {
    if (!taken[static_cast<std::size_t>(mesh.face_object[f])]) continue;
    std::vector<int> face;
    for (const int corner : mesh.face(f)) {
      const Vector3d& p = mesh.positions[static_cast<std::size_t>(corner)];
      const auto [entry, added] = places.try_emplace(cellOf(p, size), static_cast<int>(out.at.size()));
      if (added) out.at.push_back(p);
      face.push_back(entry->second);
    }
    addFace(std::move(face), mesh.face_object[f], seen, out);
  }
  return out;
}

void findEdges(Welded& mesh) {
  mesh.faces_of.clear();
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const std::vector<int>& face = mesh.faces[f];
    for (std::size_t k = 0; k < face.size(); ++k)
      mesh.faces_of[edgeOf(face[k], face[(k + 1) % face.size()])].push_back(static_cast<int>(f));
  }
}

Sets pieces(const Welded& mesh) {
  Sets sets(mesh.faces.size());
  for (const auto& [edge, faces] : mesh.faces_of) {
    if (faces.size() == 2) sets.join(faces[0], faces[1]);
  }
  return sets;
}

// Vertices of different pieces that are near each other become one, at the middle.
void joinNear(double join, Welded& mesh) {
  Sets sets = pieces(mesh);
  std::vector<int> piece(mesh.at.size(), -1);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (const int v : mesh.faces[f]) piece[static_cast<std::size_t>(v)] = sets.find(static_cast<int>(f));
  }
  std::unordered_map<CornerCell, std::vector<int>, CellHash> cells;
  for (std::size_t v = 0; v < mesh.at.size(); ++v) cells[cellOf(mesh.at[v], join)].push_back(static_cast<int>(v));
  std::vector<int> stands_for(mesh.at.size());
  std::iota(stands_for.begin(), stands_for.end(), 0);
  for (std::size_t v = 0; v < mesh.at.size(); ++v) {
    if (stands_for[v] != static_cast<int>(v)) continue;
    const CornerCell middle = cellOf(mesh.at[v], join);
    for (long long n = 0; n < 27; ++n) {
      const auto cell = cells.find({middle[0] + n % 3 - 1, middle[1] + n / 3 % 3 - 1, middle[2] + n / 9 - 1});
      if (cell == cells.end()) continue;
      for (const int w : cell->second) {
        const auto other = static_cast<std::size_t>(w);
        if (w <= static_cast<int>(v) || stands_for[other] != w || piece[other] == piece[v]) continue;
        if ((mesh.at[other] - mesh.at[v]).norm() < join) stands_for[other] = static_cast<int>(v);
      }
    }
  }
  Welded joined;
  joined.at = mesh.at;
  std::set<std::vector<int>> seen;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    std::vector<int> face;
    for (const int v : mesh.faces[f]) face.push_back(stands_for[static_cast<std::size_t>(v)]);
    addFace(std::move(face), mesh.object[f], seen, joined);
  }
  mesh = std::move(joined);
}

void measureAngles(StripPatch& patch) {
  patch.angle.assign(patch.at.size(), 0);
  patch.face_count.assign(patch.at.size(), 0);
  for (const std::vector<int>& face : patch.faces) {
    const std::size_t n = face.size();
    for (std::size_t k = 0; k < n; ++k) {
      const auto at = [&](std::size_t i) -> const Vector3d& { return patch.at[static_cast<std::size_t>(face[i % n])]; };
      const Vector3d a = at(k + 1) - at(k), b = at(k + n - 1) - at(k);
      const double lengths = a.norm() * b.norm();
      const auto v = static_cast<std::size_t>(face[k]);
      ++patch.face_count[v];
      if (lengths > 0) patch.angle[v] += std::acos(std::clamp(a.dot(b) / lengths, -1.0, 1.0));
    }
  }
}

// Chains of edges that have one face each.
void findLoops(const std::map<Edge, int>& faces_of, StripPatch& patch) {
  std::vector<std::vector<int>> along(patch.at.size());
  for (const auto& [edge, count] : faces_of) {
    if (count > 2) patch.simple = false;
    if (count != 1) continue;
    along[static_cast<std::size_t>(edge.first)].push_back(edge.second);
    along[static_cast<std::size_t>(edge.second)].push_back(edge.first);
  }
  for (const std::vector<int>& ends : along) patch.simple = patch.simple && (ends.empty() || ends.size() == 2);
  if (!patch.simple) return;
  std::vector<bool> passed(patch.at.size(), false);
  for (std::size_t v = 0; v < along.size(); ++v) {
    if (along[v].empty() || passed[v]) continue;
    std::vector<int>& loop = patch.loops.emplace_back();
    int before = -1, here = static_cast<int>(v);
    while (!passed[static_cast<std::size_t>(here)]) {
      passed[static_cast<std::size_t>(here)] = true;
      loop.push_back(here);
      const std::vector<int>& ends = along[static_cast<std::size_t>(here)];
      const int next = ends[0] == before ? ends[1] : ends[0];
      before = here;
      here = next;
    }
  }
}

StripPatch patchOf(const Welded& mesh, const std::vector<int>& faces) {
  StripPatch patch;
  patch.object = mesh.object[static_cast<std::size_t>(faces.front())];
  std::unordered_map<int, int> local;
  std::map<Edge, int> faces_of;
  for (const int f : faces) {
    std::vector<int>& face = patch.faces.emplace_back();
    for (const int v : mesh.faces[static_cast<std::size_t>(f)]) {
      const auto [entry, added] = local.try_emplace(v, static_cast<int>(patch.at.size()));
      if (added) patch.at.push_back(mesh.at[static_cast<std::size_t>(v)]);
      face.push_back(entry->second);
    }
    for (std::size_t k = 0; k < face.size(); ++k) ++faces_of[edgeOf(face[k], face[(k + 1) % face.size()])];
  }
  patch.neighbours.resize(patch.at.size());
  for (const auto& [edge, count] : faces_of) {
    patch.neighbours[static_cast<std::size_t>(edge.first)].push_back(edge.second);
    patch.neighbours[static_cast<std::size_t>(edge.second)].push_back(edge.first);
  }
  findLoops(faces_of, patch);
  measureAngles(patch);
  return patch;
}

}  // namespace

std::vector<StripPatch> stripPatches(const PolygonMesh& mesh, const std::vector<bool>& object_taken, double join) {
  Welded welded = weld(mesh, object_taken);
  findEdges(welded);
  if (join > 0) {
    joinNear(join, welded);
    findEdges(welded);
  }
  Sets sets = pieces(welded);
  std::map<int, std::vector<int>> members;  // by their first face
  std::unordered_map<int, int> first;
  for (std::size_t f = 0; f < welded.faces.size(); ++f) {
    const int root = sets.find(static_cast<int>(f));
    const int start = first.try_emplace(root, static_cast<int>(f)).first->second;
    members[start].push_back(static_cast<int>(f));
  }
  std::vector<StripPatch> patches;
  for (const auto& [start, faces] : members) patches.push_back(patchOf(welded, faces));
  return patches;
}

}  // namespace app

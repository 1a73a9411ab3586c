#include <algorithm>
#include <map>
#include <utility>

#include "sim/forces/kernels.h"
#include "sim/forces/prism_shares.h"

namespace sim {
namespace {

int roundedUp(int count) {
  return (std::max(count, 0) + kLanes - 1) / kLanes * kLanes;
}

using EdgeNumber = std::map<std::pair<int, int>, int>;

// Root edges by their columns, in the direction of their first wall.
EdgeNumber numberEdges(const HairMesh& mesh) {
  EdgeNumber number;
  for (const Wall& wall : mesh.walls) {
    const int a = mesh.column_of[wall.v[0]], b = mesh.column_of[wall.v[1]];
    if (number.contains({a, b}) || number.contains({b, a})) continue;
    const int next = static_cast<int>(number.size());
    number[{a, b}] = next;
  }
  return number;
}

template <int N>
void placePairs(const ColumnPattern& pattern, const RootFace& face, std::span<BlockPlace> places) {
  for (std::size_t k = 0; k < kPrismShares<N>.pairs.size(); ++k) {
    const int u = kPrismShares<N>.pairs[k].u, v = kPrismShares<N>.pairs[k].v;
    places[k] = pattern.place(face.columns[u % N], u / N, face.columns[v % N], v / N);
  }
}

}  // namespace

template <class T>
ColumnModel<T>::ColumnModel(const HairMesh& mesh, const ColumnLayout& layout, const ColumnPattern& pattern) {
  const std::size_t stride = layout.stride;
  for (int c = 0; c < layout.columns; ++c) {
    diagonal.push_back(static_cast<int>(pattern.diagonals[c].values));
    vertical_pairs.push_back(pattern.place(c, 0, c, 1));
    column_lanes.push_back(roundedUp(layout.length[c]));
  }
  const EdgeNumber number = numberEdges(mesh);
  edges.resize(number.size());
  std::vector<int> wall_count(number.size(), 0);
  for (const Wall& wall : mesh.walls) {
    const int p = mesh.column_of[wall.v[0]], q = mesh.column_of[wall.v[1]];
    const auto it = number.contains({p, q}) ? number.find({p, q}) : number.find({q, p});
    wall_count[it->second] = std::max(wall_count[it->second], mesh.layer_of[wall.v[0]] + 1);
  }
  for (const auto& [columns, e] : number) {
    RootEdge& edge = edges[e];
    const auto [a, b] = columns;
    edge.a = a, edge.b = b;
    edge.walls = roundedUp(wall_count[e]);
    edge.sides = roundedUp(wall_count[e] + 1);
    edge.first = e * stride;
    const std::array<int, 6> column{a, b, a, b, a, b};
    for (int v = 0; v < 6; ++v) edge.own[v] = diagonal[column[v]] + v / 2;
    for (std::size_t pair = 0; pair < kJointPairs.size(); ++pair) {
      const auto [u, v] = kJointPairs[pair];
      edge.pairs[pair] = pattern.place(column[u], u / 2, column[v], v / 2);
    }
  }
  std::size_t at = 0;
  for (std::size_t f = 0; f < mesh.shape.root_faces.size(); ++f) {
    const RootFace& root = mesh.shape.root_faces[f];
    const int n = root.corner_count;
    Face face{};
    face.corner_count = n;
    face.columns = root.columns;
    face.prisms = roundedUp(mesh.bundle_layers[f] - 1);
    face.first = at;
    at += 2 * n * stride;
    if (n == 4)
      placePairs<4>(pattern, root, face.pairs);
    else
      placePairs<3>(pattern, root, face.pairs);
    faces.push_back(face);
  }
  const std::size_t column_entries = layout.columns * stride, edge_entries = edges.size() * stride;
  for (auto* array : {&vertical.stiffness, &vertical.inverse_length, &vertical.shift}) array->resize(column_entries);
  for (auto* array : {&horizontal.stiffness, &horizontal.inverse_length, &horizontal.shift, &shear_stiffness,
                      &shear_shift, &inverse_along, &inverse_across, &bend_stiffness, &bend_rest_angle,
                      &bend_inverse_length, &bend_smallest_square}) {
    array->resize(edge_entries);
  }
  for (auto* array : {&volume_stiffness, &volume_rest}) array->resize(at);
}

template <class T>
void ColumnModel<T>::locate(const HairMesh& mesh, const ColumnLayout& layout, const ForceModel<double>& model) {
  const auto& stretch = model.of<Stretch>().vertices;
  const auto& shear = model.of<Shear>().vertices;
  const auto& bend = model.of<Bend>().vertices;
  const auto first = stretch.empty() ? std::array<int, 2>{-1, -1} : stretch.front();
  if (first == located_.first_stretch && located_.stretch.size() == stretch.size() &&
      located_.shear.size() == shear.size() && located_.bend.size() == bend.size()) {
    return;
  }
  const std::size_t stride = layout.stride;
  const EdgeNumber number = numberEdges(mesh);
  const auto edgeEntry = [&](int va, int vb) {
    const int p = mesh.column_of[va], q = mesh.column_of[vb];
    const auto it = number.find({p, q});
    const bool against = it == number.end();
    return Entry{static_cast<std::size_t>(against ? number.at({q, p}) : it->second) * stride + mesh.layer_of[va],
                 against};
  };
  located_ = {};
  located_.first_stretch = first;
  for (const auto& [a, b] : stretch) {
    const bool is_vertical = mesh.column_of[a] == mesh.column_of[b];
    located_.stretch.push_back(is_vertical ? Entry{mesh.column_of[a] * stride + mesh.layer_of[a], false}
                                           : edgeEntry(a, b));
  }
  for (const auto& v : shear) located_.shear.push_back(edgeEntry(v[0], v[1]));
  for (const auto& v : bend) located_.bend.push_back(edgeEntry(v[0], v[1]));
}

template <class T>
void ColumnModel<T>::setStretch(const HairMesh& mesh, const Elements<Stretch, double>& stretch) {
  for (std::size_t e = 0; e < stretch.size(); ++e) {
    const auto [a, b] = stretch.vertices[e];
    StretchArrays& to = mesh.column_of[a] == mesh.column_of[b] ? vertical : horizontal;
    const std::size_t at = located_.stretch[e].at;
    to.stiffness[at] = static_cast<T>(stretch.stiffness[e]);
    to.inverse_length[at] = static_cast<T>(stretch.rest[e][0]);
    to.shift[at] = static_cast<T>(stretch.shift[e]);
  }
}

// A wall or hinge that is wound against its root edge has a condition of the opposite sign.
template <class T>
void ColumnModel<T>::setWalls(const Elements<Shear, double>& shear, const Elements<Bend, double>& bend) {
  for (std::size_t e = 0; e < shear.size(); ++e) {
    const auto [at, against] = located_.shear[e];
    shear_stiffness[at] = static_cast<T>(shear.stiffness[e]);
    inverse_along[at] = static_cast<T>(shear.rest[e][0]);
    inverse_across[at] = static_cast<T>(shear.rest[e][1]);
    shear_shift[at] = static_cast<T>(against ? -shear.shift[e] : shear.shift[e]);
  }
  for (std::size_t e = 0; e < bend.size(); ++e) {
    const auto [at, against] = located_.bend[e];
    const double rest = Bend::restAngle(bend.rest[e], bend.shift[e]);
    bend_stiffness[at] = static_cast<T>(bend.stiffness[e]);
    bend_rest_angle[at] = static_cast<T>(against ? -rest : rest);
    bend_inverse_length[at] = static_cast<T>(bend.rest[e][1]);
    bend_smallest_square[at] = static_cast<T>(bend.rest[e][2]);
  }
}

// The mesh's corner tetrahedra come by face, then layer, then corner.
template <class T>
void ColumnModel<T>::setVolume(const HairMesh& mesh, std::size_t stride, const Elements<Volume, double>& volume) {
  if (volume.size() == 0) return;
  std::size_t tet = 0;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (int l = 0; l + 1 < mesh.bundle_layers[f]; ++l) {
      for (int k = 0; k < 2 * faces[f].corner_count; ++k, ++tet) {
        const std::size_t at = faces[f].first + k * stride + l;
        volume_stiffness[at] = static_cast<T>(volume.stiffness[tet]);
        volume_rest[at] = static_cast<T>(volume.rest[tet][0] + volume.shift[tet]);
      }
    }
  }
}

template <class T>
void ColumnModel<T>::setElements(const HairMesh& mesh, const ColumnLayout& layout, const ForceModel<double>& model) {
  model.forEach([&]<class Kind>(const Elements<Kind, double>& elements) {
    if constexpr (!KernelKinds::contains<Kind>() && !MovingKind<Kind>)
      convertElements(elements, plain.template of<Kind>());
  });
  locate(mesh, layout, model);
  // Entries without an element: no stiffness, and no wall that counts as collapsed.
  for (auto* array : {&vertical.stiffness, &horizontal.stiffness, &shear_stiffness, &bend_stiffness, &volume_stiffness,
                      &bend_smallest_square}) {
    std::fill(array->begin(), array->end(), T(0));
  }
  setStretch(mesh, model.of<Stretch>());
  setWalls(model.of<Shear>(), model.of<Bend>());
  setVolume(mesh, layout.stride, model.of<Volume>());
  const auto any = [](const std::vector<T>& stiffness) {
    return std::any_of(stiffness.begin(), stiffness.end(), [](T k) { return k != 0; });
  };
  has_vertical = any(vertical.stiffness);
  has_horizontal = any(horizontal.stiffness);
  has_shear = any(shear_stiffness);
  has_bend = any(bend_stiffness);
  has_volume = model.of<Volume>().size() > 0;
}

template <class T>
void ColumnModel<T>::setMoving(const ForceModel<double>& model, const Vec3& origin) {
  model.forEach([&]<class Kind>(const Elements<Kind, double>& elements) {
    if constexpr (MovingKind<Kind>) {
      static_assert(!KernelKinds::contains<Kind>());
      Elements<Kind, T>& to = plain.template of<Kind>();
      convertElements(elements, to);
      for (std::size_t e = 0; e < elements.size(); ++e) {
        const auto rest = Kind::relativeTo(origin, elements.rest[e]);
        std::copy(rest.begin(), rest.end(), to.rest[e].begin());
      }
    }
  });
}

template struct ColumnModel<float>;
template struct ColumnModel<double>;

}  // namespace sim

#include "app/scene/edit/painted_fields.h"

#include <algorithm>
#include <array>

#include "app/styles/style_shorten.h"

namespace app {

using sim::Vec3;

namespace {

constexpr double kFatness = 0.05;                                                       // see shortenColumns
constexpr double kMinBendShare = 0.02, kMinWidthShare = 0.1, kMinRoughnessShare = 0.2;  // that black leaves

double atRoot(const FieldMap& map, const Scalp& scalp, const sim::HairMeshShape& shape, int column) {
  return map.at(shape.positions[static_cast<std::size_t>(shape.column_first[static_cast<std::size_t>(column)])] -
                scalp.center);
}

}  // namespace

double paintLength(const FieldMap& map, const Scalp& scalp, const BodyDistance& body, sim::HairMeshShape& shape) {
  std::vector<double> shares;
  for (int c = 0; c < shape.columnCount(); ++c)
    shares.push_back(kMinLength + (1 - kMinLength) * atRoot(map, scalp, shape, c));
  const std::vector<double> asked = shares;
  shortenColumns(body, kFatness, shares, shape);
  double more = 0;
  for (std::size_t c = 0; c < shares.size(); ++c) more += (shares[c] - asked[c]) / static_cast<double>(shares.size());
  return more;
}

namespace {

// One a vertex; empty where all are 1.
std::vector<float> sharesOf(const std::string& picture, const std::vector<double>& curve, double least,
                            const Scalp& scalp, const sim::HairMeshShape& shape) {
  if (picture.empty() && curve.empty()) return {};
  const FieldMap map = picture.empty() ? FieldMap{1, 1, {1}, {}} : readFieldMap(picture);
  std::vector<float> shares(shape.positions.size(), 1);
  for (int c = 0; c < shape.columnCount(); ++c) {
    const double whole = least + (1 - least) * atRoot(map, scalp, shape, c);
    const int length = shape.columnLength(c);
    for (int k = 0; k < length; ++k) {
      const auto v = static_cast<std::size_t>(shape.column_first[static_cast<std::size_t>(c)] + k);
      shares[v] = static_cast<float>(whole * curveAt(curve, k / std::max(1.0, length - 1.0)));
    }
  }
  if (std::ranges::all_of(shares, [](float share) { return share == 1; })) return {};
  return shares;
}

}  // namespace

PaintedShares paintedShares(const FieldFiles& maps, const FieldCurves& curves, const Scalp& scalp,
                            const sim::HairMeshShape& shape) {
  return {sharesOf(maps.stiffness, curves.stiffness, kMinStiffness, scalp, shape),
          sharesOf(maps.mass, curves.mass, kMinMass, scalp, shape),
          sharesOf(maps.bend, curves.bend, kMinBendShare, scalp, shape),
          sharesOf(maps.damping, curves.damping, 0, scalp, shape)};
}

void applyShares(const PaintedShares& shares, sim::HairMesh& mesh) {
  mesh.damping_share.assign(shares.damping.begin(), shares.damping.end());
  for (std::size_t v = 0; v < shares.mass.size(); ++v) mesh.vertex_volume[v] *= static_cast<double>(shares.mass[v]);
  const auto scale = [](const std::vector<float>& by, const auto& vertices, double& volume) {
    if (by.empty()) return;
    double sum = 0;
    for (const int v : vertices) sum += static_cast<double>(by[static_cast<std::size_t>(v)]);
    volume *= sum / static_cast<double>(std::size(vertices));
  };
  for (sim::Hinge& hinge : mesh.hinges) {
    scale(shares.stiffness, hinge.v, hinge.volume);
    scale(shares.bend, hinge.v, hinge.volume);
  }
  if (shares.stiffness.empty()) return;
  for (auto* edges : {&mesh.horizontal_edges, &mesh.vertical_edges}) {
    for (sim::Edge& edge : *edges) scale(shares.stiffness, std::array{edge.a, edge.b}, edge.volume);
  }
  for (sim::Wall& wall : mesh.walls) scale(shares.stiffness, wall.v, wall.volume);
  for (sim::CornerTet& tet : mesh.tets) scale(shares.stiffness, tet.v, tet.volume);
}

namespace {

constexpr int kAlongPieces = 60;  // of a curve from root to tip: exact for curves of 2 to 7, 11, 13, 16, 21, 31 points

// Of the look, those with one channel.
struct ShareField {
  std::string_view name;
  float render::LookShare::*share;
  double least;
};
constexpr std::array kShareFields{
    ShareField{"width", &render::LookShare::width, kMinWidthShare}, ShareField{"clump", &render::LookShare::clump, 0},
    ShareField{"curl", &render::LookShare::curl, 0}, ShareField{"frizz", &render::LookShare::frizz, 0},
    ShareField{"roughness", &render::LookShare::roughness, kMinRoughnessShare}};

// Calls set(share, root) for the share of every root, root: from the head's middle.
void atRoots(const Scalp& scalp, const sim::HairMeshShape& shape, std::vector<render::LookShare>& roots,
             const auto& set) {
  roots.resize(shape.positions.size());
  for (int c = 0; c < shape.columnCount(); ++c) {
    const auto v = static_cast<std::size_t>(shape.column_first[static_cast<std::size_t>(c)]);
    set(roots[v], Vec3(shape.positions[v] - scalp.center));
  }
}

void dropOnes(std::vector<render::LookShare>& shares) {
  if (std::ranges::all_of(shares, [](const render::LookShare& share) { return share == render::LookShare{}; }))
    shares.clear();
}

}  // namespace

bool isOfLook(std::string_view name) {
  return name == "color" ||
         std::ranges::any_of(kShareFields, [&](const ShareField& field) { return field.name == name; });
}

PaintedLook paintedLook(const FieldFiles& maps, const FieldCurves& curves, const Scalp& scalp,
                        const sim::HairMeshShape& shape) {
  PaintedLook look;
  look.along.resize(kAlongPieces + 1);
  const auto place = [](std::size_t k) { return static_cast<double>(k) / kAlongPieces; };
  for (const ShareField& field : kShareFields) {
    for (std::size_t k = 0; k < look.along.size(); ++k)
      look.along[k].*field.share = static_cast<float>(curveAt(curveOf(field.name, curves), place(k)));
    if (mapOf(field.name, maps).empty()) continue;
    const FieldMap map = readFieldMap(mapOf(field.name, maps));
    atRoots(scalp, shape, look.roots, [&](render::LookShare& share, const Vec3& root) {
      share.*field.share = static_cast<float>(field.least + (1 - field.least) * map.at(root));
    });
  }
  for (std::size_t k = 0; k < look.along.size(); ++k) {
    const std::array<double, 3> color = colorAt(curves.color, place(k));
    for (std::size_t c = 0; c < 3; ++c) look.along[k].color[c] = static_cast<float>(color[c]);
  }
  if (!maps.color.empty()) {
    ColorMap map = readColorMap(maps.color);
    for (FieldMap& channel : map)
      for (float& value : channel.value) value = static_cast<float>(linearShare(static_cast<double>(value)));
    atRoots(scalp, shape, look.roots, [&](render::LookShare& share, const Vec3& root) {
      for (std::size_t c = 0; c < 3; ++c) share.color[c] = static_cast<float>(map[c].at(root));
    });
  }
  dropOnes(look.roots);
  dropOnes(look.along);
  return look;
}

void paintDensity(const FieldMap& map, const Scalp& scalp, const sim::HairMesh& mesh,
                  std::vector<render::HairFace>& faces) {
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const sim::RootFace& face = mesh.shape.root_faces[f];
    double sum = 0;
    for (int k = 0; k < face.corner_count; ++k)
      sum += atRoot(map, scalp, mesh.shape, face.columns[static_cast<std::size_t>(k)]);
    faces[f].area *= static_cast<float>(sum / face.corner_count);
  }
}

}  // namespace app

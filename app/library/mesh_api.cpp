// Hair meshes of the C interface.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "app/files/hair_file.h"
#include "app/library/convert.h"
#include "app/library/log.h"
#include "app/library/objects.h"
#include "app/styles/hair_styles.h"
#include "sim/field_text.h"

namespace app::library {
namespace {

constexpr std::size_t kMaxElements = std::size_t{1} << 28;  // of an array: more does not fit an int's bytes

// Reads the columns' lengths; returns the number of vertices.
std::size_t readColumns(const hm_mesh_settings& settings, sim::HairMeshShape& shape) {
  std::size_t vertices = 0;
  for (std::size_t c = 0; c < settings.column_count; ++c) {
    const int length = settings.column_lengths[c];
    const std::string column = "column " + std::to_string(c);
    if (length < 2)
      throw Fault{HM_ERROR_MESH,
                  column + " has " + std::to_string(length) + " vertices; give it at least 2, root first"};
    if (vertices + static_cast<std::size_t>(length) > kMaxElements)
      throw Fault{HM_ERROR_MESH, column + " ends beyond 2^28 vertices; check column_lengths, or split the hair"};
    vertices += static_cast<std::size_t>(length);
    shape.column_first.push_back(static_cast<int>(vertices));
  }
  return vertices;
}

void readFaces(const hm_mesh_settings& settings, sim::HairMeshShape& shape) {
  const auto columns = static_cast<std::int64_t>(settings.column_count);
  for (std::size_t f = 0; f < settings.face_count; ++f) {
    sim::RootFace face;
    const std::int32_t* corners = settings.faces + 4 * f;
    face.corner_count = corners[3] < 0 ? 3 : 4;
    for (int k = 0; k < face.corner_count; ++k) {
      if (corners[k] < 0 || corners[k] >= columns)
        throw Fault{HM_ERROR_MESH, "root face " + std::to_string(f) + " names column " + std::to_string(corners[k]) +
                                       "; there are columns 0 to " + std::to_string(columns - 1)};
      face.columns[static_cast<std::size_t>(k)] = corners[k];
    }
    if (settings.reverse_faces) std::reverse(face.columns.begin(), face.columns.begin() + face.corner_count);
    shape.root_faces.push_back(face);
  }
}

sim::HairMeshShape shapeOf(const hm_mesh_settings& settings) {
  needs(settings.column_lengths, "column_lengths");
  needs(settings.faces, "faces");
  if (settings.column_count > kMaxElements || settings.face_count > kMaxElements)
    throw Fault{HM_ERROR_ARGUMENT, "column_count or face_count is beyond 2^28; split the hair"};
  sim::HairMeshShape shape;
  const std::size_t vertices = readColumns(settings, shape);
  checkArray(settings.positions, vertices, "positions");
  shape.positions.reserve(vertices);
  for (std::size_t v = 0; v < vertices; ++v) shape.positions.push_back(pointOf(settings.positions, v, "positions"));
  readFaces(settings, shape);
  return shape;
}

bool buildsReversed(sim::HairMeshShape shape) {
  for (sim::RootFace& face : shape.root_faces)
    std::reverse(face.columns.begin(), face.columns.begin() + face.corner_count);
  try {
    sim::buildHairMesh(std::move(shape));
  } catch (const sim::MeshError&) {
    return false;
  }
  return true;
}

sim::HairMesh builtMesh(const sim::HairMeshShape& shape) {
  try {
    return sim::buildHairMesh(shape);
  } catch (const sim::MeshError&) {
    if (!buildsReversed(shape)) throw;
  }
  throw Fault{HM_ERROR_MESH, "all faces are wound the other way; change reverse_faces"};
}

// Hair in another unit than metres is simulated as it stands: all its times and weights are off.
void warnOfLength(double length) {
  constexpr double kShort = 0.004, kLong = 3;  // m
  if (length >= kShort && length <= kLong) return;
  const std::string text = "the hair is " + sim::numberText(length) + " m long; positions are in metres, scale them";
  writeLog(HM_LOG_WARNING, text.c_str());
}

hm_mesh addMesh(const sim::HairMeshShape& shape) {
  auto mesh = std::make_unique<Mesh>();
  mesh->mesh = builtMesh(shape);
  warnOfLength(mesh->mesh.hair_length);
  const sim::HairMeshShape& built = mesh->mesh.shape;
  for (const sim::RootFace& face : built.root_faces) {
    for (int k = 0; k < 4; ++k)
      mesh->faces.push_back(k < face.corner_count ? face.columns[static_cast<std::size_t>(k)] : -1);
  }
  for (int c = 0; c < built.columnCount(); ++c) mesh->layers = std::max(mesh->layers, built.columnLength(c));
  return {meshes().add(MeshRef(std::move(mesh)))};
}

// One of the names that `name_of` gives to `choices`.
template <class Choice>
Choice chosen(const char* given, const char* what, std::initializer_list<Choice> choices,
              std::string_view (*name_of)(Choice)) {
  needs(given, what);
  std::string names;
  std::vector<std::string_view> candidates;
  for (const Choice choice : choices) {
    if (name_of(choice) == given) return choice;
    candidates.push_back(name_of(choice));
    names.append(names.empty() ? "" : ", ").append(name_of(choice));
  }
  const std::string_view near = sim::nearestName(given, candidates);
  throw Fault{HM_ERROR_ARGUMENT,
              std::string(what) + " '" + std::string(given).substr(0, 40) + "' is not built in; " +
                  (near.empty() ? "choose one of " : "did you mean '" + std::string(near) + "'? Choose one of ") +
                  names};
}

sim::HairMeshShape styleOnPlainHead(Style style, Resolution resolution, double height) {
  const Vec3 radii = height * Vec3(0.34, 0.5, 0.42);
  Scalp scalp;
  scalp.head_height = height;
  scalp.rows = 65, scalp.columns = 128;
  for (int row = 0; row < scalp.rows; ++row) {
    for (int column = 0; column < scalp.columns; ++column) {
      const double polar = row * std::numbers::pi / (scalp.rows - 1);
      const double azimuth = column * 2 * std::numbers::pi / scalp.columns;
      const Vec3 way(std::sin(polar) * std::sin(azimuth), std::cos(polar), std::sin(polar) * std::cos(azimuth));
      scalp.radius.push_back(1 / way.cwiseQuotient(radii).norm());
    }
  }
  // To the first order: exact on the surface.
  const auto distance = [&](const Vec3& p) {
    const Vec3 q = p.cwiseQuotient(radii);
    const double value = q.norm(), slope = q.cwiseQuotient(radii).norm();
    return slope > 1e-12 ? value * (value - 1) / slope : -radii.minCoeff();
  };
  return makeStyle(style, resolution, scalp, distance);
}

}  // namespace
}  // namespace app::library

using namespace app::library;

void hm_default_mesh_settings(hm_mesh_settings* settings) {
  if (settings) *settings = {};
}

hm_result hm_mesh_create(const hm_mesh_settings* settings, hm_mesh* mesh) {
  return guarded("hm_mesh_create", [&] {
    needs(settings, "settings");
    needs(mesh, "mesh");
    *mesh = addMesh(shapeOf(*settings));
  });
}

hm_result hm_mesh_create_from_text(const char* text, size_t length, const char* name, int32_t reverse_faces,
                                   hm_mesh* mesh) {
  return guarded("hm_mesh_create_from_text", [&] {
    needs(text, "text");
    needs(mesh, "mesh");
    *mesh = addMesh(app::readHairMesh(std::string_view(text, length), name ? name : "hair mesh", reverse_faces != 0,
                                      "reverse_faces"));
  });
}

hm_result hm_mesh_create_style(const char* style, const char* resolution, double head_height, hm_mesh* mesh) {
  return guarded("hm_mesh_create_style", [&] {
    using app::Resolution;
    using app::Style;
    needs(mesh, "mesh");
    const Style which = chosen(
        style, "style", {Style::kShort, Style::kShoulder, Style::kLong, Style::kBob, Style::kPixie, Style::kShaved},
        app::styleName);
    const Resolution fine =
        chosen(resolution, "resolution", {Resolution::kLow, Resolution::kMedium, Resolution::kHigh, Resolution::kUltra},
               app::resolutionName);
    if (!(head_height >= 0.05 && head_height <= 2))
      throw Fault{HM_ERROR_VALUE, "head_height is not within 0.05 and 2; give it in metres, 0.23 for a person"};
    *mesh = addMesh(styleOnPlainHead(which, fine, head_height));
  });
}

hm_result hm_mesh_destroy(hm_mesh mesh) {
  return guarded("hm_mesh_destroy", [&] { meshes().remove(mesh.id, [](const MeshRef&) {}); });
}

hm_result hm_mesh_describe(hm_mesh mesh, hm_mesh_info* info) {
  return guarded("hm_mesh_describe", [&] {
    needs(info, "info");
    const MeshRef ref = meshOf(mesh);
    const sim::HairMesh& of = ref->mesh;
    info->vertex_count = of.vertexCount();
    info->column_count = of.columnCount();
    info->face_count = static_cast<int32_t>(of.shape.root_faces.size());
    info->layer_count = ref->layers;
    info->hair_length = of.hair_length;
    info->volume = of.total_volume;
    info->column_first = of.shape.column_first.data();
    info->faces = ref->faces.data();
    info->rest = {of.shape.positions.data()->data(), sizeof(Vec3), of.shape.positions.size()};
  });
}

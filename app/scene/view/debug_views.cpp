#include "app/scene/view/debug_views.h"

#include <algorithm>
#include <cmath>

namespace app {

namespace {

using Color = std::array<float, 4>;
using render::LineVertex;

constexpr Color kExternalColor{0.98f, 0.82f, 0.25f, 1}, kEllipsoidColor{0.35f, 0.75f, 0.95f, 0.55f};
constexpr Color kSlideColor{0.35f, 0.95f, 0.5f, 1}, kStickColor{1.0f, 0.3f, 0.25f, 1};
constexpr Color kVelocityColor{0.65f, 0.85f, 1.0f, 0.9f};
constexpr Color kPinColor{1.0f, 0.55f, 0.9f, 1};
constexpr double kNormalLength = 0.025;     // m
constexpr double kVelocityTime = 1.0 / 30;  // s
constexpr double kTetShrink = 0.8;          // drawn about its middle, so that neighbours stay apart

LineVertex vertex(const sim::Vec3& p, const Color& color) {
  return {{static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())}, color};
}

// The shown moment's position, which is not the simulator's last one.
sim::Vec3 shown(const Actor& actor, int v) {
  const float* p = &actor.shown_positions[3 * static_cast<std::size_t>(v)];
  return {p[0], p[1], p[2]};
}

void addLine(const LineVertex& a, const LineVertex& b, DebugGeometry& geometry) {
  geometry.lines.push_back(a);
  geometry.lines.push_back(b);
}

Color layerColor(double share) {
  const auto channel = [&](double middle) {
    return static_cast<float>(std::clamp(1.4 - 2.8 * std::abs(share - middle), 0.12, 1.0));
  };
  return {channel(0.95), channel(0.5), channel(0.05), 0.9f};
}

Color volumeColor(double ratio) {
  if (ratio <= 0) return {1, 0.1f, 0.8f, 0.85f};
  const double octaves = std::clamp(std::log2(ratio) / 1.0, -1.0, 1.0);
  const auto mix = [&](double rest, double end) { return static_cast<float>(rest + std::abs(octaves) * (end - rest)); };
  const float alpha = mix(0.18, 0.8);
  return octaves < 0 ? Color{mix(0.75, 0.1), mix(0.75, 0.35), mix(0.75, 1), alpha}
                     : Color{mix(0.75, 1), mix(0.75, 0.5), mix(0.75, 0.05), alpha};
}

void addMesh(const Actor& actor, DebugGeometry& geometry) {
  const sim::HairMesh& mesh = actor.haircut->mesh;
  int deepest = 1;
  for (const int layer : mesh.layer_of) deepest = std::max(deepest, layer);
  const auto colored = [&](int v) {
    return vertex(shown(actor, v), layerColor(static_cast<double>(mesh.layer_of[v]) / deepest));
  };
  for (const auto* edges : {&mesh.horizontal_edges, &mesh.vertical_edges}) {
    for (const sim::Edge& edge : *edges) addLine(colored(edge.a), colored(edge.b), geometry);
  }
  for (const sim::RootFace& face : mesh.shape.root_faces) {
    for (int c = 0; c < face.corner_count; ++c) {
      const int next = (c + 1) % face.corner_count;
      addLine(colored(mesh.shape.column_first[face.columns[c]]), colored(mesh.shape.column_first[face.columns[next]]),
              geometry);
    }
  }
}

void addTets(const Actor& actor, DebugGeometry& geometry) {
  constexpr int kFaces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  for (const sim::CornerTet& tet : actor.haircut->mesh.tets) {
    std::array<sim::Vec3, 4> p;
    for (int k = 0; k < 4; ++k) p[k] = shown(actor, tet.v[k]);
    const double volume = (p[1] - p[0]).dot((p[2] - p[0]).cross(p[3] - p[0])) / 6;
    const Color color = volumeColor(volume / tet.rest_volume);
    const sim::Vec3 middle = 0.25 * (p[0] + p[1] + p[2] + p[3]);
    for (const auto& face : kFaces) {
      for (const int k : face) geometry.triangles.push_back(vertex(middle + kTetShrink * (p[k] - middle), color));
    }
  }
}

void addEllipsoids(const Actor& actor, DebugGeometry& geometry) {
  constexpr int kMeridians = 12, kParallels = 7, kArcs = 32;
  constexpr double kPi = 3.14159265358979323846;
  for (const sim::Ellipsoid& e : actor.ellipsoids) {
    const auto at = [&](double polar, double azimuth) {
      const sim::Vec3 unit(std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth));
      return vertex(e.center + e.rotation * e.radii.cwiseProduct(unit), kEllipsoidColor);
    };
    for (int piece = 0; piece < kArcs; ++piece) {
      const double a = kPi * piece / kArcs, b = kPi * (piece + 1) / kArcs;
      for (int m = 0; m < kMeridians; ++m) {
        const double azimuth = 2 * kPi * m / kMeridians;
        addLine(at(a, azimuth), at(b, azimuth), geometry);
      }
      for (int k = 1; k <= kParallels; ++k) {
        const double polar = kPi * k / (kParallels + 1);
        addLine(at(polar, 2 * a), at(polar, 2 * b), geometry);
      }
    }
  }
}

}  // namespace

void addDebugViews(const DebugViews& views, const Actor& actor, DebugGeometry& geometry) {
  if (views.mesh) addMesh(actor, geometry);
  if (views.tets) addTets(actor, geometry);
  if (views.ellipsoids) addEllipsoids(actor, geometry);
  if (views.external) {
    for (const int v : actor.haircut->mesh.external_vertices) {
      geometry.points.push_back(vertex(shown(actor, v), kExternalColor));
    }
  }
  if (views.contacts) {
    for (const sim::Contact& contact : actor.hair.contacts) {
      const sim::Vec3 p = shown(actor, contact.vertex);
      const Color& color = contact.sticks ? kStickColor : kSlideColor;
      geometry.points.push_back(vertex(p, color));
      addLine(vertex(p, color), vertex(p + kNormalLength * contact.normal, color), geometry);
    }
  }
  if (views.pins) {
    for (const sim::PinnedVertex& pin : actor.pinned) {
      geometry.points.push_back(vertex(pin.target, kPinColor));
      addLine(vertex(shown(actor, pin.vertex), kPinColor), vertex(pin.target, kPinColor), geometry);
    }
  }
  if (views.velocities) {
    for (int v = 0; v < actor.haircut->mesh.vertexCount(); ++v) {
      const sim::Vec3 p = shown(actor, v);
      addLine(vertex(p, kVelocityColor), vertex(p + kVelocityTime * actor.hair.velocities[v], kVelocityColor),
              geometry);
    }
  }
}

}  // namespace app

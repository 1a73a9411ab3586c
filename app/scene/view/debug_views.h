// Debug views: the hair mesh, its parts and the contacts, as lines, triangles and points for the renderer.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "app/scene/actor.h"
#include "render/frame_input.h"

namespace app {

// Which views are on.
struct DebugViews {
  bool mesh = false;        // edges of the hair mesh, coloured by layer
  bool external = false;    // external vertices
  bool tets = false;        // corner tetrahedra, coloured by volume over rest volume
  bool ellipsoids = false;  // collision ellipsoids
  bool contacts = false;    // contacts and their normals
  bool velocities = false;  // vertex velocities over 1/30 s
  bool pins = false;        // pins, from the vertex to its target

  bool any() const { return mesh || external || tets || ellipsoids || contacts || velocities || pins; }
};

// One view by name, for keys, options and check boxes.
struct DebugView {
  std::string_view name, label, help;
  bool DebugViews::*on;
};
inline constexpr std::array<DebugView, 7> kDebugViews{{
    {"mesh", "Hair mesh", "Edges of the hair mesh, root to tip from blue to red", &DebugViews::mesh},
    {"external", "External vertices", "Vertices that collide with the body", &DebugViews::external},
    {"tets", "Tetrahedra", "Corner tetrahedra by volume: blue squeezed, grey at rest, orange swollen, magenta inverted",
     &DebugViews::tets},
    {"ellipsoids", "Ellipsoids", "The body as collisions see it", &DebugViews::ellipsoids},
    {"contacts", "Contacts", "Contact points with their normals; red where the hair sticks", &DebugViews::contacts},
    {"velocities", "Velocities", "Where each vertex goes within a thirtieth of a second", &DebugViews::velocities},
    {"pins", "Pins", "Vertices that are pinned, each with a line to where it is drawn", &DebugViews::pins},
}};

// What the renderer is handed; kept from frame to frame so that it stops allocating.
struct DebugGeometry {
  std::vector<render::LineVertex> lines, triangles, points;
};

// Adds an actor's views.
void addDebugViews(const DebugViews& views, const Actor& actor, DebugGeometry& geometry);

}  // namespace app

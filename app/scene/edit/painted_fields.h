// Fields painted over the scalp and what they do to a hair mesh. A field of white everywhere changes no bit.
#pragma once

#include <string_view>
#include <vector>

#include "app/files/field_map.h"
#include "app/styles/hair_styles.h"
#include "render/frame_input.h"

namespace app {

// Share that black leaves.
inline constexpr double kMinLength = 0.12, kMinStiffness = 0.02, kMinMass = 0.1;

// Ends each column sooner along its own curve. Where the field falls faster from column to column than prisms can bear
// the shorter column keeps more. Returns by how much of their length columns are longer than was asked, in the mean.
double paintLength(const FieldMap& map, const Scalp& scalp, const BodyDistance& body, sim::HairMeshShape& shape);

// Shares of the parameters' values, one a vertex; empty: 1 everywhere.
struct PaintedShares {
  std::vector<float> stiffness, mass, bend, damping;
  bool operator==(const PaintedShares&) const = default;
};

// Of pictures and curves.
PaintedShares paintedShares(const FieldFiles& maps, const FieldCurves& curves, const Scalp& scalp,
                            const sim::HairMeshShape& shape);
// Scales the volumes that elements stand for, and with them their stiffnesses, and those that masses are made of; gives
// the mesh its damping. After every change of the rest shape anew.
void applyShares(const PaintedShares& shares, sim::HairMesh& mesh);

// Shares of the look, by roots (one a vertex) and along strands; empty: 1 everywhere.
struct PaintedLook {
  std::vector<render::LookShare> roots, along;
  render::LookShares shares() const { return {roots, along}; }
};

PaintedLook paintedLook(const FieldFiles& maps, const FieldCurves& curves, const Scalp& scalp,
                        const sim::HairMeshShape& shape);
// Whether a field or a curve acts on what is drawn alone.
bool isOfLook(std::string_view name);

// Deals strands out by the field as well.
void paintDensity(const FieldMap& map, const Scalp& scalp, const sim::HairMesh& mesh,
                  std::vector<render::HairFace>& faces);

}  // namespace app

// Fields painted over the scalp and what they do to a hair mesh. A field of white everywhere changes no bit.
#pragma once

#include <span>
#include <vector>

#include "app/files/field_map.h"
#include "render/frame_input.h"
#include "app/styles/hair_styles.h"

namespace app {

inline constexpr double kLeastLength = 0.12, kLeastStiffness = 0.02;  // share that black leaves

// Ends each column sooner along its own curve. Where the field falls faster from column to column than prisms can bear
// the shorter column keeps more.
void paintLength(const FieldMap& map, const Scalp& scalp, const BodyDistance& body, sim::HairMeshShape& shape);

// The share of each column's stiffness.
std::vector<float> paintedStiffness(const FieldMap& map, const Scalp& scalp, const sim::HairMeshShape& shape);
// Scales the volumes that elements stand for, and with them their stiffnesses; masses stay. After every change of the
// rest shape anew. `shares`: one a column, or none at all.
void applyStiffness(std::span<const float> shares, sim::HairMesh& mesh);

// Deals strands out by the field as well.
void paintDensity(const FieldMap& map, const Scalp& scalp, const sim::HairMesh& mesh,
                  std::vector<render::HairFace>& faces);

}  // namespace app

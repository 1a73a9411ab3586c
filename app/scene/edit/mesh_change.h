// The hair mesh in a hand: its vertices, edges, columns and layers moved, its structure changed, while the hair moves.
// Asked for as text, so that recordings keep it.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/groom/edit/mesh_edit.h"
#include "app/scene/actor.h"
#include "sim/linear/vector3.h"

namespace app {

struct Demo;

enum class MeshElement { kVertex, kEdge, kColumn, kLayer };
inline constexpr std::array<std::string_view, 4> kElementNames{"vertex", "edge", "column", "layer"};

// One sample of a drag. Chosen: numbers of vertices, columns or layers; of edges both vertices, one after the other.
struct MoveSample {
  MeshElement element = MeshElement::kVertex;
  std::vector<int> chosen;
  Vec3 along = Vec3::Zero();          // m, scalp frame
  double radius = 0.04, falloff = 1;  // of the hair around, as a brush has them
  bool mirror = false;
};

// "x y z  radius falloff mirror  number ..."; parseMove reads the same bits back.
std::string moveText(const MoveSample& sample);
// `element`: as kElementNames. Throws InputError.
MoveSample parseMove(const std::string& element, const std::string& text);

// The vertices of chosen elements, each once, roots too. Throws InputError where there is no such element.
std::vector<int> verticesOf(MeshElement element, std::span<const int> chosen, const sim::HairMesh& mesh);

// ": it is frozen" and the like; empty of nothing.
const char* heldText(HeldBy by);

// Changes the rest shape of the actor's hair; the demo's message says why where nothing moves. Throws InputError where
// nothing is chosen that can move; then nothing has changed.
void applyMove(const MoveSample& sample, int actor, Demo& demo);

// What changes the structure, see mesh_edit.h. Their texts: a layer's number; pairs of columns; columns; pairs. Before
// pairs and columns kMirrorText: on the other side of the head as well.
enum class MeshChange { kAddLayer, kRemoveLayer, kSplit, kMerge, kExtrude };
inline constexpr std::array<std::string_view, 5> kMeshChangeNames{"add-layer", "remove-layer", "split", "merge",
                                                                  "extrude"};

inline constexpr std::string_view kMirrorText = "mirror ";

// Throws InputError where the mesh would not be valid, and of hair that is tied or under an attachment; then nothing
// has changed. The demo's message says how far strands have moved.
void applyMeshChange(const std::string& name, const std::string& text, int actor, Demo& demo);

// Gives the actor's hair another mesh. What moves goes on moving, by the sources of the new vertices; without sources
// it is put to rest. Its pins go to the nearest vertices. Throws InputError as above.
void remeshHair(sim::HairMeshShape shape, std::span<const VertexSource> sources, int actor, Demo& demo);

// Gives the actor's hair a shape that it or another had: its positions, and its structure where that differs. `sag`:
// Material::sag, then.
void bringBackShape(const sim::HairMeshShape& shape, const std::vector<sim::V3<double>>& sag, int actor, Demo& demo);

}  // namespace app

// The mesh of a body on the GPU: vertices, triangles sorted by joint, and coarser triangles for when it is small.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/body/body_detail.h"
#include "render/frame_input.h"
#include "render/gl/gl_object.h"
#include "render/view_math.h"

namespace render {

inline constexpr GLuint kPlaceAttribute = 6;  // of a material, from a buffer of its own; as in skinning.glsl
inline constexpr GLuint kCoverAttribute = 4;  // root cover, from a buffer of its own; as in skinning.glsl

// Triangles whose first corner hangs mostly on one joint.
struct JointTriangles {
  int first_index = 0, index_count = 0;
  std::vector<int> joints;    // that move any of its vertices
  std::vector<Bounds> boxes;  // of the vertices that each moves, rest pose
};

struct IndexRange {
  int first = 0, count = 0;
};

struct BodyMesh {
  std::uint64_t id = 0;
  bool seen = false;  // shown by the present frame
  std::vector<JointTriangles> by_joint;
  Buffer vertices, indices;
  VertexArray attributes;
  Buffer material_places;
  Texture materials;                                     // none: the mesh brings no sound colours of its own
  float spacing = 0;                                     // root mean square length of the edges, rest pose
  int index_count = 0, joint_count = 0;                  // index_count 0: the input was unsound, nothing is drawn
  std::array<IndexRange, kBodyCells.size() + 1> levels;  // full, then ever coarser
  std::vector<Bounds> joint_boxes;                       // rest pose
};

// Uploads the mesh of a body and adds its bytes to `uploaded`. Empty where spans disagree in length, an index points
// outside, or a position is not finite.
BodyMesh makeBodyMesh(const BodyInput& input, long& uploaded);

}  // namespace render

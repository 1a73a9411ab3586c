// A mesh that moves, as binary glTF (`.glb`): the first moment's vertices and normals, one morph target a moment, and
// an animation of their weights. glTF has no curves; what draws cards or drives its own hair by a cage takes this.
//
// 12 bytes of header ("glTF", version 2, length), a chunk of JSON and one of bytes, each padded to 4. A target holds
// what places and normals differ from the first moment's by. Source: the glTF 2.0 specification of the Khronos Group,
// sections 3.7.2 (morph targets), 3.11 (animations), 4 (GLB).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "app/groom/clip_settings.h"

namespace app {

inline constexpr std::size_t kMaxGlbMoments = 1000;  // weights take a float for every pair of them

struct GlbMesh {
  std::string name;
  std::vector<std::uint32_t> triangles;      // three numbers of vertices each, counter-clockwise from outside
  std::vector<Eigen::Vector2f> coordinates;  // of a texture, per vertex; or none
  Eigen::Vector3f color = Eigen::Vector3f::Constant(0.5f);  // linear, of its material
  bool both_sides = false;                                  // cards: seen from both
};

// Keeps all moments in memory, 12 bytes a vertex each, and writes the file when it is finished.
class GlbWriter {
 public:
  GlbWriter(std::string file, ClipSettings settings, GlbMesh mesh);

  // Throws OutputError for another number of vertices than at first, and beyond kMaxGlbMoments.
  void add(const std::vector<Eigen::Vector3f>& vertices);
  // Throws OutputError when the file could not be written.
  void finish();

 private:
  std::string file_;
  ClipSettings settings_;
  GlbMesh mesh_;
  std::vector<std::vector<Eigen::Vector3f>> moments_;
};

}  // namespace app

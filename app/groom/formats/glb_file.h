// A mesh that moves, as binary glTF (`.glb`): the first moment's vertices, one morph target a moment, and an animation
// of their weights. glTF has no curves; what draws cards or drives its own hair by a cage takes this.
//
// 12 bytes of header ("glTF", version 2, length), a chunk of JSON and one of bytes, each padded to 4. A target holds
// displacements from the first moment. Source: the glTF 2.0 specification of the Khronos Group, sections 3.7.2 (morph
// targets), 3.11 (animations), 4 (GLB).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "app/groom/clip_settings.h"

namespace app {

inline constexpr std::size_t kMaxGlbMoments = 1000;  // weights take a float for every pair of them

// Keeps all moments in memory, 12 bytes a vertex each, and writes the file when it is finished.
class GlbWriter {
 public:
  // triangles: three numbers of vertices each, counter-clockwise from outside.
  GlbWriter(std::string file, ClipSettings settings, std::vector<std::uint32_t> triangles);

  // Throws OutputError for another number of vertices than at first, and beyond kMaxGlbMoments.
  void add(const std::vector<Eigen::Vector3f>& vertices);
  // Throws OutputError when the file could not be written.
  void finish();

 private:
  std::string file_;
  ClipSettings settings_;
  std::vector<std::uint32_t> triangles_;
  std::vector<std::vector<Eigen::Vector3f>> moments_;
};

}  // namespace app

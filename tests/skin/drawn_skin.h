// The skin as it is drawn, asked for how deep a point lies under it.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "render/frame_input.h"

namespace skin {

using Eigen::Vector3f;

// Bodies' positions in the world (three floats a vertex), as the shaders skin them.
std::vector<Vector3f> skinned(const render::BodyInput& body);

// A body's skin of one frame: the triangles that are drawn, by Embree. A body may be of several closed pieces that lie
// in one another, as the paper's mannequin is: a point is inside it if it is inside a piece.
class DrawnSkin {
 public:
  explicit DrawnSkin(const render::BodyInput& body);
  ~DrawnSkin();
  DrawnSkin(DrawnSkin&&) noexcept;

  // m under the skin; 0 outside. Of a point in several pieces, the largest of the depths. A piece holds the point if
  // it goes round it in more than half of all directions, so that holes do no harm; rays sort
  // out what is outside, and tell of what is 0.5 mm or less inside. Error:
  // single precision, 1e-6 m for coordinates of a few metres.
  float depth(const Vector3f& p) const;
  const std::vector<Vector3f>& vertices() const { return vertices_; }

 private:
  struct Tree;
  std::vector<Vector3f> vertices_;
  std::unique_ptr<Tree> tree_;
};

}  // namespace skin

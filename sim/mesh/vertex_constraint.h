// A vertex that is held in some directions during a solve: by contacts, or by a firm pin.
#pragma once

#include <array>

#include "sim/mesh/fields.h"
#include "sim/mesh/hair_mesh.h"

namespace sim {

// The constraint of one vertex: velocity = keep * (free velocity) + prescribed.
struct VertexConstraint {
  int vertex = 0;
  Eigen::Matrix3d keep = Eigen::Matrix3d::Identity();                        // projector onto the free directions
  Vec3 prescribed = Vec3::Zero();                                            // m/s, within the removed directions
  int removed = 0;                                                           // number of removed directions
  std::array<Vec3, 3> directions{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};  // orthonormal basis of them
  HAIRMESH_FIELDS(vertex, keep, prescribed, removed, directions)
};

}  // namespace sim

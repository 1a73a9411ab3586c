// A body without a skeleton: what its outline tells.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/figure/character.h"
#include "app/groom/strips/polygon_mesh.h"

namespace app {

// Where a still body's head is. Places are in metres, y up, facing +z.
struct StillBody {
  Eigen::Matrix4d to_metres = Eigen::Matrix4d::Identity();  // from the file's unit and axes
  Eigen::Vector3d neck = Eigen::Vector3d::Zero();           // the middle of the narrowest level under the head
  double head_height = 0;                                   // m, from there to the crown
  bool whole = false;                                       // at least four heads tall: no bust, no head alone
  std::vector<std::string> notes;                           // axis, unit, neck and facing, and what told them
};

// Up is the axis, y before z, along which there is a neck: the narrowest level between a head and shoulders, or the end
// of an open neck. The unit is the one of metres, centimetres, inches and millimetres that makes a whole figure 1.2 to
// 2.2 m tall, or a head alone 0.2 to 0.4 m. The face lies ahead of the neck. Empty: there is no neck.
std::optional<StillBody> measureStillBody(std::span<const Eigen::Vector3f> positions,
                                          std::span<const std::uint32_t> triangles);

// Turns faces, and normals that follow them, round where they enclose a negative volume. Returns whether they did.
bool turnFacesOutwards(SkinnedMesh& mesh);

// Whether polygons are a body from head to feet.
bool isWholeBody(const PolygonMesh& mesh);

}  // namespace app

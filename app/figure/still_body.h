// A body without a skeleton: what its outline tells.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/figure/character.h"
#include "app/files/told_body.h"
#include "app/groom/strips/polygon_mesh.h"

namespace app {

// Where a still body's head is. Places are in metres with y up; the body stays where its file has it, but is raised out
// of the ground.
struct StillBody {
  Eigen::Matrix4d to_metres = Eigen::Matrix4d::Identity();  // from the file's unit and axes
  Eigen::Vector3d neck = Eigen::Vector3d::Zero();           // the middle of the narrowest level under the head
  Eigen::Vector3d forward = Eigen::Vector3d::UnitZ();       // where the face looks, horizontal
  double height = 0, head_height = 0;                       // m, of all; from the neck to the crown
  std::vector<std::string> notes;                           // axis, unit, neck and facing, and what told them
};

// Up is the axis, y before z, along which there is a neck: the narrowest level between a head and shoulders, or the end
// of an open neck. The unit is the one of metres, inches, centimetres and millimetres that makes the head with
// its neck 0.17 to 0.40 m tall; where none does, the one that makes the body 1.2 to 2.2 m tall. The face lies ahead of
// the neck. What is told counts in their place. Empty: there is no neck.
std::optional<StillBody> measureStillBody(std::span<const Eigen::Vector3f> positions,
                                          std::span<const std::uint32_t> triangles, const ToldBody& told = {});

// Turns all faces, and normals that follow them, round where the head's, those of `head_joint`, enclose a negative
// volume. Returns whether they did.
bool turnFacesOutwards(int head_joint, SkinnedMesh& mesh);

// The body, bust or head that polygons are: they have a neck, and are at least four heads tall, or half of their
// faces are one piece. Empty: something else.
std::optional<StillBody> stillBodyOf(const PolygonMesh& mesh);
inline bool looksLikeBody(const PolygonMesh& mesh) {
  return stillBodyOf(mesh).has_value();
}

}  // namespace app

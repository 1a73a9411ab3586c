// A mesh that a figure wears: closed, in the frame of the joint that carries it, with signed distances of its surface.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/figure/body_sdf.h"
#include "app/figure/character.h"
#include "app/files/attachment_spec.h"
#include "app/groom/strips/polygon_mesh.h"

namespace app {

struct Attachment {
  std::string key;
  std::uint64_t id = 0;
  std::string note;                                  // what was inferred; empty: nothing
  std::optional<std::array<float, 3>> color;         // of its largest material, linear; none: the file has none
  std::vector<Eigen::Vector3f> positions, normals;   // m, joint frame; a vertex a smooth side of an edge
  std::vector<std::uint32_t> triangles;              // counter-clockwise from outside
  std::vector<std::array<std::uint16_t, 4>> joints;  // the one joint there is
  std::vector<std::array<float, 4>> weights;
  Vec3 turn = Vec3::Zero(), at = Vec3::Zero();  // degrees, m, as AttachmentSpec: given or inferred
  PartDistance part;
  Rigid to_scalp = Rigid::Identity();  // joint frame to the scalp's, rest pose
};

// Reads the file and fixes it to the joint. Faces wound inwards are turned round. Throws InputError: no mesh, open,
// an unknown joint, no unit or place that is certain.
Attachment loadAttachment(const AttachmentSpec& spec, const Character& character);

// The turn about x, then y, then z, of AttachmentSpec::turn.
Eigen::Matrix3d turnOf(const Vec3& degrees);

// Whether polygons are a thing that is worn rather than hair: at most eight pieces, all closed, not long and thin.
bool looksWorn(const PolygonMesh& mesh);

// m, joint frame: where a ray from the head's middle first meets the attachment, between the scalp and `most` off it;
// infinite where it does not. Directions are the scalp frame's.
double meetsAlong(const Attachment& attachment, const Scalp& scalp, const Vec3& direction, double most);

}  // namespace app

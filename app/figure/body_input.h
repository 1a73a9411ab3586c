// A skinned mesh as the renderer takes it.
#pragma once

#include "render/frame_input.h"

namespace app {

// The body's input points to the mesh's arrays; the mesh must outlive it. Mesh: SkinnedMesh, Attachment.
template <class Mesh>
void pointTo(const Mesh& mesh, render::BodyInput& body) {
  body.positions = {mesh.positions.data()->data(), 3 * mesh.positions.size()};
  body.normals = {mesh.normals.data()->data(), 3 * mesh.normals.size()};
  body.triangles = mesh.triangles;
  body.joints = {mesh.joints.data()->data(), 4 * mesh.joints.size()};
  body.weights = {mesh.weights.data()->data(), 4 * mesh.weights.size()};
}

}  // namespace app

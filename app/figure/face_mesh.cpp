#include "app/figure/face_mesh.h"

#include <vector>

#include "app/figure/fine_mesh.h"
#include "app/figure/mannequin_mesh.h"

namespace app {

namespace {

constexpr double kFaceStep = 0.002;  // m: the farthest that a vertex in the middle of an edge is moved

bool inFace(const BodyField& body, const Eigen::Vector3f& p) {
  const Vec3 q = body.toHead(p.cast<double>());
  return q.z() > 0.17 && q.y() > -0.02 && q.y() < 0.66;
}

}  // namespace

SkinnedMesh withFineFace(const SkinnedMesh& mesh, const BodyField& body) {
  SkinnedMesh fine = mesh;
  std::vector<bool> inside;
  for (const Eigen::Vector3f& p : mesh.positions) inside.push_back(inFace(body, p));
  halveEdges(inside, fine);
  const auto field = [&](const Vec3& p) { return body.value(p); };
  for (std::size_t v = mesh.positions.size(); v < fine.positions.size(); ++v) {
    Vec3 at = fine.positions[v].cast<double>(), normal = Vec3::Zero();
    projectToSurface(field, kFaceStep, at, normal);
    fine.positions[v] = at.cast<float>(), fine.normals[v] = normal.cast<float>();
  }
  return fine;
}

}  // namespace app

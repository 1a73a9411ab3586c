#include "app/figure/face_mesh.h"

#include <cmath>
#include <vector>

#include "app/figure/fine_mesh.h"
#include "app/figure/mannequin_mesh.h"

namespace app {

namespace {

constexpr double kFaceStep = 0.002;  // m, of each of the two steps that bring a new vertex to the surface

bool inFace(const Vec3& q) {
  return q.z() > 0.17 && q.y() > -0.02 && q.y() < 0.66;
}

// Lips and the wings of the nose: folds of 2 mm.
bool inFolds(const Vec3& q) {
  return q.z() > 0.24 && q.y() > 0.14 && q.y() < 0.38 && std::abs(q.x()) < 0.13;
}

void refine(bool (*inside)(const Vec3&), const BodyField& body, SkinnedMesh& mesh) {
  std::vector<bool> chosen;
  for (const Eigen::Vector3f& p : mesh.positions) chosen.push_back(inside(body.toHead(p.cast<double>())));
  const std::size_t first = mesh.positions.size();
  halveEdges(chosen, mesh);
  const auto field = [&](const Vec3& p) { return body.value(p); };
  for (std::size_t v = first; v < mesh.positions.size(); ++v) {
    Vec3 at = mesh.positions[v].cast<double>(), normal = Vec3::Zero();
    projectToSurface(field, kFaceStep, at, normal);
    mesh.positions[v] = at.cast<float>(), mesh.normals[v] = normal.cast<float>();
  }
}

}  // namespace

SkinnedMesh withFineFace(const SkinnedMesh& mesh, const BodyField& body) {
  SkinnedMesh fine = mesh;
  refine(inFace, body, fine);
  refine(inFolds, body, fine);
  return fine;
}

}  // namespace app

#include "tests/bench/skin_distance.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/figure/body_input.h"
#include "render/body/skinning.h"

namespace bench {
namespace {

using app::Vec3;

double segmentDistance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double t = std::clamp((p - a).dot(d) / std::max(d.squaredNorm(), 1e-18), 0.0, 1.0);
  return (p - a - t * d).norm();
}

double triangleDistance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = (b - a).cross(c - a);
  const double size = n.squaredNorm();
  if (size > 0) {
    const Vec3 w = p - a;
    const double second = w.cross(c - a).dot(n) / size, third = (b - a).cross(w).dot(n) / size;
    if (second >= 0 && third >= 0 && second + third <= 1) return std::abs(w.dot(n)) / std::sqrt(size);
  }
  return std::min({segmentDistance(p, a, b), segmentDistance(p, b, c), segmentDistance(p, c, a)});
}

}  // namespace

SkinDistance::SkinDistance(const app::Character& character, const app::Pose& pose) {
  const app::SkinnedMesh& mesh = character.mesh;
  std::vector<render::Mat4> carried(pose.world.size());
  for (std::size_t j = 0; j < pose.world.size(); ++j) {
    Eigen::Map<Eigen::Matrix4f>(carried[j].data()) =
        (pose.world[j] * character.skeleton.joints[j].rest_world.inverse()).matrix().cast<float>();
  }
  render::BodyInput body;
  app::pointTo(mesh, body);
  body.joint_matrices = carried;
  std::vector<Vec3> points;
  for (const Eigen::Vector3f& p : render::skinnedPositions(body)) points.push_back(p.cast<double>());
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
    Face face{points[mesh.triangles[t]], points[mesh.triangles[t + 1]], points[mesh.triangles[t + 2]], {}, 0};
    face.middle = (face.a + face.b + face.c) / 3;
    face.radius =
        std::max({(face.a - face.middle).norm(), (face.b - face.middle).norm(), (face.c - face.middle).norm()});
    faces_.push_back(face);
  }
}

double SkinDistance::at(const Vec3& p, double reach) const {
  double best = reach;
  for (const Face& f : faces_) {
    const double far = best + f.radius;
    if ((p - f.middle).squaredNorm() < far * far) best = std::min(best, triangleDistance(p, f.a, f.b, f.c));
  }
  if (best >= reach) return reach;
  // Solid angles (van Oosterom and Strackee 1983).
  double angle = 0;
  for (const Face& f : faces_) {
    const Vec3 a = f.a - p, b = f.b - p, c = f.c - p;
    const double x = a.norm(), y = b.norm(), z = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)), x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y);
  }
  return std::abs(angle) > 2 * std::numbers::pi ? -best : best;
}

}  // namespace bench

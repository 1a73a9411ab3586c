#include "app/scene/edit/picking.h"

#include <algorithm>
#include <cmath>

namespace app {

namespace {

constexpr double kBehindSkin = 0.015;  // m below the ellipsoids: hair that is seen lies no deeper

struct Eye {
  Vec3 at, forward, right, up;
  double slope;
  Eye(const Camera& camera, const Picture& picture) : slope(pictureSlope(camera, picture.place)) {
    const Vec3 back = viewBack(camera);
    at = camera.anchor + camera.target + camera.distance * back;
    forward = -back;
    right = Vec3::UnitY().cross(back).normalized();
    up = back.cross(right);
  }
};

// Pixels from the picture's top left corner of what the camera looks at.
std::array<double, 2> middleOf(const Picture& picture) {
  return {0.5 * (1 + picture.place.shift) * picture.width, 0.5 * (1 - picture.place.rise) * picture.height};
}

// Distance along the ray to a triangle (Moeller and Trumbore 1997); negative: it is missed.
double meet(const Ray& ray, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, p = ray.along.cross(ac);
  const double det = ab.dot(p);
  if (std::abs(det) < 1e-18) return -1;
  const Vec3 from = ray.from - a, q = from.cross(ab);
  const double u = from.dot(p) / det, v = ray.along.dot(q) / det;
  return u < 0 || v < 0 || u + v > 1 ? -1 : ac.dot(q) / det;
}

// Whether the ray passes through the body before it has come so far (m).
bool behindBody(const Ray& ray, double far, const Actor& actor) {
  return std::ranges::any_of(actor.ellipsoids, [&](const sim::Ellipsoid& body) {
    const Vec3 scale = body.radii.cwiseInverse();
    const Vec3 from = scale.cwiseProduct(body.rotation.conjugate() * (ray.from - body.center)),
               along = scale.cwiseProduct(body.rotation.conjugate() * ray.along);
    const double deepest = std::clamp(-from.dot(along) / along.squaredNorm(), 0.0, far);
    if ((from + deepest * along).squaredNorm() >= 1) return false;
    return sim::closestPoint(body, ray.from + deepest * ray.along).distance < -kBehindSkin;
  });
}

}  // namespace

Ray rayThrough(double x, double y, const Picture& picture, const Camera& camera) {
  const Eye eye(camera, picture);
  const double scale = 2 * eye.slope / picture.height;
  const auto [middle_x, middle_y] = middleOf(picture);
  const Vec3 way = eye.forward + scale * ((x - middle_x) * eye.right - (y - middle_y) * eye.up);
  return {eye.at, way.normalized()};
}

std::optional<std::array<double, 2>> pixelOf(const Vec3& point, const Picture& picture, const Camera& camera) {
  const Eye eye(camera, picture);
  const Vec3 way = point - eye.at;
  const double depth = way.dot(eye.forward);
  if (depth < 1e-3) return {};
  const double scale = picture.height / (2 * eye.slope * depth);
  const auto [middle_x, middle_y] = middleOf(picture);
  return std::array{middle_x + scale * way.dot(eye.right), middle_y - scale * way.dot(eye.up)};
}

Vec3 pointInPlane(const Ray& ray, const Vec3& place, const Vec3& facing) {
  const double slope = ray.along.dot(facing);
  return std::abs(slope) < 1e-6 ? place : Vec3(ray.from + (place - ray.from).dot(facing) / slope * ray.along);
}

std::optional<HairHit> pickHairFace(const Ray& ray, const Actor& actor) {
  const std::vector<Vec3>& x = actor.hair.positions;
  const std::vector<sim::ExternalFace>& faces = actor.haircut->mesh.external_faces;
  double nearest = INFINITY;
  int met = 0;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const sim::ExternalFace& face = faces[f];
    for (int k = 2; k < face.corner_count; ++k) {
      const double distance = meet(ray, x[face.v[0]], x[face.v[k - 1]], x[face.v[k]]);
      if (distance > 0 && distance < nearest) nearest = distance, met = static_cast<int>(f);
    }
  }
  if (!std::isfinite(nearest) || behindBody(ray, nearest, actor)) return {};
  return HairHit{ray.from + nearest * ray.along, met};
}

std::optional<Vec3> pickHair(const Ray& ray, const Actor& actor) {
  const std::optional<HairHit> hit = pickHairFace(ray, actor);
  return hit ? std::optional<Vec3>(hit->at) : std::nullopt;
}

}  // namespace app

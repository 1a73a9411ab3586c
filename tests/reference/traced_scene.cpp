#include "tests/reference/traced_scene.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "tests/skin/drawn_skin.h"

namespace reference {
namespace {

constexpr unsigned kHairGeometry = 0;

RTCRay rayFrom(const Vector3f& from, const Vector3f& direction, float nearest) {
  RTCRay ray{};
  ray.org_x = from.x(), ray.org_y = from.y(), ray.org_z = from.z();
  ray.dir_x = direction.x(), ray.dir_y = direction.y(), ray.dir_z = direction.z();
  ray.tnear = nearest;
  ray.tfar = std::numeric_limits<float>::infinity();
  ray.mask = ~0u;
  return ray;
}

}  // namespace

TracedScene::TracedScene(const std::vector<strand_capture::Polyline>& strands, float radius, float taper,
                         std::span<const render::BodyInput> bodies)
    : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_.get())) {
  addStrands(strands, radius, taper);
  for (const render::BodyInput& body : bodies) addBody(body);
  rtcCommitScene(scene_.get());
}

void TracedScene::addStrands(const std::vector<strand_capture::Polyline>& strands, float radius, float taper) {
  for (const strand_capture::Polyline& strand : strands) {
    for (std::size_t i = 0; i < strand.size(); ++i) {
      const float along = static_cast<float>(i) / static_cast<float>(std::max<std::size_t>(strand.size() - 1, 1));
      if (i + 1 < strand.size()) segments_.push_back(static_cast<unsigned>(points_.size()));
      points_.emplace_back(strand[i].x(), strand[i].y(), strand[i].z(), radius * (1 + (taper - 1) * along * along));
    }
  }
  points_.emplace_back(0, 0, 0, 0);  // Embree reads a little past the last one
  const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_FLAT_LINEAR_CURVE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, points_.data(), 0, 16,
                             points_.size() - 1);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, segments_.data(), 0, 4,
                             segments_.size());
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene_.get(), geometry, kHairGeometry);
  rtcReleaseGeometry(geometry);
}

void TracedScene::addBody(const render::BodyInput& body) {
  const std::vector<Vector3f> world = skin::skinned(body);
  const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, world.size());
  std::memcpy(vertices, world.data(), world.size() * 12);
  void* triangles =
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, body.triangles.size() / 3);
  std::memcpy(triangles, body.triangles.data(), body.triangles.size() * 4);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_.get(), geometry);
  rtcReleaseGeometry(geometry);
}

std::optional<Hit> TracedScene::first(const Vector3f& from, const Vector3f& direction, float nearest) const {
  RTCRayHit ray{};
  ray.ray = rayFrom(from, direction, nearest);
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene_.get(), &context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  Hit hit;
  hit.at = from + ray.ray.tfar * direction;
  hit.hair = ray.hit.geomID == kHairGeometry;
  hit.normal = Vector3f(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z).normalized();
  if (!hit.hair) return hit;
  const Eigen::Vector4f &a = points_[segments_[ray.hit.primID]], &b = points_[segments_[ray.hit.primID] + 1];
  hit.tangent = (b - a).head<3>().normalized();
  hit.radius = a.w();
  return hit;
}

bool TracedScene::lit(const Vector3f& from, const Vector3f& to_light, float nearest) const {
  RTCRay ray = rayFrom(from, to_light, nearest);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene_.get(), &context, &ray);
  return ray.tfar >= 0;
}

}  // namespace reference

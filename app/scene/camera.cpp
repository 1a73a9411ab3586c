#include "app/scene/camera.h"

#include <algorithm>
#include <cmath>

#include "app/scene/sim_to_render.h"

namespace app {

namespace {

constexpr double kHighestPitch = 1.5, kNearest = 0.15, kFarthest = 50;
constexpr double kFollowLag = 0.25;  // s
constexpr double kOrbitSpeed = 3.2;  // rad per picture height
constexpr double kZoomStep = 0.9;    // per notch
constexpr double kFullAspect = 1.0;  // narrower pictures step back

struct Framing {
  double top, bottom;  // m, heights of the picture's edges about the middle of the cranium
};

// Crown and chin are about half a head height above and 0.6 below the middle of the cranium; a figure is about 7.5
// heads tall. A bust holds the whole hair, however long it hangs.
Framing framing(const std::string& name, const Actor& actor, double middle) {
  const double head = actor.body->character.scalp.head_height;
  if (name == "head") return {0.8 * head, -1.15 * head};
  if (name == "figure") return {1.1 * head, -8.2 * head};
  double lowest = middle;
  for (const sim::Vec3& p : actor.hair.positions) lowest = std::min(lowest, p.y());
  return {0.85 * head, std::min(-1.6 * head, lowest - middle - 0.35 * head)};
}

struct Angles {
  double yaw, pitch;
};

Angles viewAngles(const std::string& view) {
  if (view == "front") return {0, 0.04};
  if (view == "side") return {1.5708, 0.04};
  if (view == "back") return {3.14159265, 0.08};
  if (view == "top") return {0.35, 1.15};
  return {0.62, 0.1};
}

// Which way the actor's head faces, about y.
double facing(const Actor& actor, const Pose& pose) {
  const Vec3 forward = scalpToWorld(actor.body->character, pose).linear() * Vec3::UnitZ();
  return std::hypot(forward.x(), forward.z()) > 1e-6 ? std::atan2(forward.x(), forward.z()) : 0;
}

Vec3 headOf(const Actor& actor, const Pose& pose) {
  return scalpToWorld(actor.body->character, pose) * actor.body->character.scalp.center;
}

}  // namespace

Vec3 viewBack(const Camera& camera) {
  return {std::cos(camera.pitch) * std::sin(camera.yaw), std::sin(camera.pitch),
          std::cos(camera.pitch) * std::cos(camera.yaw)};
}

Camera makeCamera(const CameraSpec& spec, const Actor& actor, double aspect) {
  Camera camera;
  camera.fov = spec.fov;
  camera.follow = spec.follow;
  camera.anchor = headOf(actor, actor.pose);
  if (spec.eye && spec.target) {
    const Vec3 back = *spec.eye - *spec.target;
    camera.target = *spec.target - camera.anchor;
    camera.distance = back.norm();
    camera.yaw = std::atan2(back.x(), back.z());
    camera.pitch = std::asin(std::clamp(back.y() / camera.distance, -0.99999, 0.99999));
    return camera;
  }
  const Framing frame = framing(spec.framing, actor, camera.anchor.y());
  const Angles angles = viewAngles(spec.view);
  camera.target = Vec3(0, 0.5 * (frame.top + frame.bottom), 0);
  camera.yaw = facing(actor, actor.pose) + angles.yaw;
  camera.pitch = angles.pitch;
  camera.distance = 0.5 * (frame.top - frame.bottom) / std::tan(0.5 * spec.fov) * std::max(1.0, kFullAspect / aspect);
  return camera;
}

void orbit(double dx, double dy, double height, Camera& camera) {
  camera.yaw = std::remainder(camera.yaw - kOrbitSpeed * dx / height, 2 * 3.14159265358979323846);
  camera.pitch = std::clamp(camera.pitch + kOrbitSpeed * dy / height, -kHighestPitch, kHighestPitch);
}

void pan(double dx, double dy, double height, Camera& camera) {
  const Vec3 back = viewBack(camera);
  const Vec3 right = Vec3::UnitY().cross(back).normalized();
  const double metres = 2 * camera.distance * std::tan(0.5 * camera.fov) / height;
  camera.target += metres * (-dx * right + dy * back.cross(right));
}

void zoom(double notches, Camera& camera) {
  camera.distance = std::clamp(camera.distance * std::pow(kZoomStep, notches), kNearest, kFarthest);
}

void turnTo(const std::string& view, const Actor& actor, Camera& camera) {
  const Angles angles = viewAngles(view);
  camera.yaw = facing(actor, actor.shown_pose) + angles.yaw;
  camera.pitch = angles.pitch;
}

void follow(const Actor& actor, double seconds, Camera& camera) {
  if (!camera.follow) return;
  const Vec3 head = headOf(actor, actor.shown_pose);
  camera.anchor += (1 - std::exp(-std::max(0.0, seconds) / kFollowLag)) * (head - camera.anchor);
}

render::CameraInput cameraInput(const Camera& camera) {
  const Vec3 target = camera.anchor + camera.target;
  render::CameraInput input;
  input.eye = toFloat3(target + camera.distance * viewBack(camera));
  input.target = toFloat3(target);
  input.fov_y = static_cast<float>(camera.fov);
  input.near_plane = static_cast<float>(std::min(0.05, 0.2 * camera.distance));
  return input;
}

}  // namespace app

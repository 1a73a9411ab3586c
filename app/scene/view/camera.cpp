#include "app/scene/view/camera.h"

#include <algorithm>
#include <cmath>

#include "app/scene/sim_to_render.h"

namespace app {

namespace {

constexpr double kHighestPitch = 1.5, kNearest = 0.15, kFarthestEye = 50;
constexpr double kFollowLag = 0.25;    // s
constexpr double kOrbitSpeed = 3.2;    // rad per picture height
constexpr double kZoomStep = 0.9;      // per notch
constexpr double kStray = 0.15;        // of half the picture: how far the head may leave its place in it
constexpr double kNearer = 0.1;        // of the distance: and how much nearer or farther it may come
constexpr double kFrameMargin = 1.06;  // around a whole figure
constexpr double kFullAspect = 1.0;    // narrower pictures step back
constexpr double kFigureWidth = 0.8;   // of a view that is as wide as high: what hair and shoulders ask for
constexpr double kMinZoom = 0.6;       // a smaller view would show a face too small to work on
constexpr double kMinFree = 0.1;       // of the picture's sides: less is no room

// m, heights of the picture's edges about the middle of the cranium.
struct Framing {
  double top, bottom;
};

// Crown and chin are about half a head height above and 0.6 below the middle of the cranium. A bust holds the whole
// hair, however long it hangs.
Framing framing(const std::string& name, const Actor& actor, double middle) {
  const double head = actor.body->character.scalp.head_height;
  if (name == "head") return {0.8 * head, -1.15 * head};
  double lowest = middle;
  for (const sim::Vec3& p : actor.hair.positions) lowest = std::min(lowest, p.y());
  return {0.85 * head, std::min(-1.6 * head, lowest - middle - 0.35 * head)};
}

// Around skin and hair, m, relative to `origin`.
Eigen::AlignedBox3d figureBox(const Actor& actor, const Vec3& origin) {
  const Character& character = actor.body->character;
  std::vector<Rigid> moves;
  for (std::size_t j = 0; j < actor.pose.world.size(); ++j)
    moves.push_back(actor.pose.world[j] * character.skeleton.joints[j].rest_world.inverse());
  Eigen::AlignedBox3d box;
  for (std::size_t v = 0; v < character.mesh.positions.size(); ++v) {
    Vec3 skinned = Vec3::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
      const double weight = character.mesh.weights[v][k];
      if (weight > 0)
        skinned += weight * (moves[character.mesh.joints[v][k]] * character.mesh.positions[v].cast<double>());
    }
    box.extend(skinned - origin);
  }
  for (const sim::Vec3& p : actor.hair.positions) box.extend(p - origin);
  return box;
}

// The view's axes.
struct View {
  Vec3 back, right, up;
  explicit View(const Camera& camera)
      : back(viewBack(camera)), right(Vec3::UnitY().cross(back).normalized()), up(back.cross(right)) {}
};

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

ViewPlace placeIn(const PicturePart& free, double aspect, double most) {
  const double width = free.right - free.left, height = free.bottom - free.top;
  if (width < kMinFree || height < kMinFree) return {};
  // A picture that is higher than wide has stepped back: the figure fills its width.
  const double side = std::min(1.0, aspect / kFullAspect);
  const double fits = std::min({most, height / side, width * aspect / (kFigureWidth * side)});
  ViewPlace place;
  place.zoom = std::max(fits, kMinZoom);
  place.shift = free.left + free.right - 1;
  place.rise = 1 - (free.top + free.bottom);
  // What is too high for the part is cut off below: the head stays.
  place.rise -= std::max(0.0, place.zoom * side - height);
  return place;
}

double pictureSlope(const Camera& camera, const ViewPlace& place) {
  return std::tan(0.5 * camera.fov) / place.zoom;
}

Vec3 viewBack(const Camera& camera) {
  return {std::cos(camera.pitch) * std::sin(camera.yaw), std::sin(camera.pitch),
          std::cos(camera.pitch) * std::cos(camera.yaw)};
}

void lookAtHead(const Actor& actor, Camera& camera) {
  camera.anchor = headOf(actor, actor.pose);
  camera.jumped = actor.jumped;
}

void frameFigure(const std::string& name, const Actor& actor, double aspect, Camera& camera) {
  lookAtHead(actor, camera);
  const double slope = std::tan(0.5 * camera.fov);
  if (name != "figure") {
    const Framing frame = framing(name, actor, camera.anchor.y());
    camera.target = Vec3(0, 0.5 * (frame.top + frame.bottom), 0);
    camera.distance = 0.5 * (frame.top - frame.bottom) / slope * std::max(1.0, kFullAspect / aspect);
    return;
  }
  const Eigen::AlignedBox3d box = figureBox(actor, camera.anchor);
  camera.target = box.center();
  const View view(camera);
  camera.distance = kNearest;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)) - camera.target;
    const double half = std::max(std::abs(p.dot(view.up)), std::abs(p.dot(view.right)) / aspect);
    camera.distance = std::max(camera.distance, kFrameMargin * half / slope + p.dot(view.back));
  }
}

Camera makeCamera(const CameraSpec& spec, const Actor& actor, double aspect) {
  Camera camera;
  camera.fov = spec.fov;
  camera.follow = spec.follow;
  lookAtHead(actor, camera);
  if (spec.eye && spec.target) {
    const Vec3 back = *spec.eye - *spec.target;
    camera.target = spec.of_head ? *spec.target : Vec3(*spec.target - camera.anchor);
    camera.distance = back.norm();
    camera.yaw = std::atan2(back.x(), back.z());
    camera.pitch = std::asin(std::clamp(back.y() / camera.distance, -0.99999, 0.99999));
    return camera;
  }
  const Angles angles = viewAngles(spec.view);
  camera.yaw = facing(actor, actor.pose) + angles.yaw;
  camera.pitch = angles.pitch;
  frameFigure(spec.framing, actor, aspect, camera);
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
  camera.distance = std::clamp(camera.distance * std::pow(kZoomStep, notches), kNearest, kFarthestEye);
}

void turnTo(const std::string& view, const Actor& actor, Camera& camera) {
  const Angles angles = viewAngles(view);
  camera.yaw = facing(actor, actor.shown_pose) + angles.yaw;
  camera.pitch = angles.pitch;
}

void follow(const Actor& actor, double seconds, double aspect, Camera& camera) {
  const Vec3 jump = actor.jumped - camera.jumped;
  camera.jumped = actor.jumped;
  if (!camera.follow) return;
  camera.anchor += jump;
  const Vec3 head = headOf(actor, actor.shown_pose);
  camera.anchor += (1 - std::exp(-std::max(0.0, seconds) / kFollowLag)) * (head - camera.anchor);
  // Seen from the target: the head where it belongs in the picture, and where it is.
  const View view(camera);
  const Vec3 place = -camera.target, now = head - camera.anchor - camera.target;
  const double slope = std::tan(0.5 * camera.fov);
  const double depth = camera.distance - place.dot(view.back);
  const double near = std::clamp(camera.distance - now.dot(view.back), (1 - kNearer) * depth, (1 + kNearer) * depth);
  const auto held = [&](const Vec3& axis, double half) {
    const double middle = place.dot(axis) / depth;
    return near * std::clamp(now.dot(axis) / near, middle - kStray * half, middle + kStray * half);
  };
  const Vec3 kept = (camera.distance - near) * view.back + held(view.up, slope) * view.up +
                    held(view.right, slope * aspect) * view.right;
  camera.anchor += now - kept;
}

render::CameraInput cameraInput(const Camera& camera, const ViewPlace& place, const Vec3& origin) {
  const Vec3 target = camera.anchor + camera.target - origin;
  render::CameraInput input;
  input.eye = toFloat3(target + camera.distance * viewBack(camera));
  input.target = toFloat3(target);
  // Without a zoom the bits of the angle stay.
  input.fov_y = static_cast<float>(place.zoom == 1 ? camera.fov : 2 * std::atan(pictureSlope(camera, place)));
  input.shift = static_cast<float>(place.shift), input.rise = static_cast<float>(place.rise);
  input.near_plane = static_cast<float>(std::min(0.05, 0.2 * camera.distance));
  return input;
}

}  // namespace app

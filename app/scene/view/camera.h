// The camera: orbit, pan and zoom about a target that goes along with a character.
#pragma once

#include "app/files/scene_file.h"
#include "app/scene/actor.h"
#include "render/frame_input.h"

namespace app {

struct Camera {
  Vec3 anchor = Vec3::Zero();  // m, world: the smoothed head of the followed character; fixed when not following
  Vec3 target = Vec3::Zero();  // m, relative to the anchor
  Vec3 jumped = Vec3::Zero();  // m, the followed actor's sum of jumps that the anchor has made
  double yaw = 0, pitch = 0;   // rad: yaw 0 looks at the figure's front from +z, positive towards its left
  double distance = 2;         // m
  double fov = 0.5;            // rad, vertical
  bool follow = true;
};

// A part of a picture, in shares of its width from the left and of its height from the top.
struct PicturePart {
  double left = 0, right = 1, top = 0, bottom = 1;
  bool operator==(const PicturePart&) const = default;
};

// Where the camera's view stands in a picture. Without panels it fills the picture.
struct ViewPlace {
  double shift = 0, rise = 0;  // of its middle, see render::CameraInput
  double zoom = 1;             // its height, a share of the picture's
  bool operator==(const ViewPlace&) const = default;
};

// What puts the view into the middle of the part that is left free, smaller where it has no room there. Below 0.6 of
// its size it is cut off at the bottom instead. A part without room changes nothing. `aspect` is the picture's; the
// zoom is at most `most`.
ViewPlace placeIn(const PicturePart& free, double aspect, double most = 1);

// Tangent of half the angle that the whole height of the picture spans.
double pictureSlope(const Camera& camera, const ViewPlace& place);

// The camera that a scene asks for, framing an actor as it stands. `aspect` is width over height: narrow pictures step
// back so that the figure keeps its room.
Camera makeCamera(const CameraSpec& spec, const Actor& actor, double aspect);

// Puts the anchor on the actor's head at once.
void lookAtHead(const Actor& actor, Camera& camera);

// Puts a part of the figure ("head", "bust", "figure": skin and hair) into the picture, whatever its size and shape.
// Yaw and pitch stay.
void frameFigure(const std::string& name, const Actor& actor, double aspect, Camera& camera);

// Mouse moves in pixels; `height` is the view's, see ViewPlace. Pitch stays short of the poles, distance between 0.15
// and 50 m.
void orbit(double dx, double dy, double height, Camera& camera);
void pan(double dx, double dy, double height, Camera& camera);
void zoom(double notches, Camera& camera);

// Turns to a named view ("front", ...) of the way the actor faces, keeping target and distance.
void turnTo(const std::string& view, const Actor& actor, Camera& camera);

// Moves the anchor after the actor's shown head, with a lag that takes the shake out of a walk. However fast it moves,
// the head stays within 15 % of half the picture of its place in it. The anchor goes along with jumps of the head.
void follow(const Actor& actor, double seconds, double aspect, Camera& camera);

// Unit vector from the target to the eye.
Vec3 viewBack(const Camera& camera);

// Relative to `origin` (m).
render::CameraInput cameraInput(const Camera& camera, const ViewPlace& place, const Vec3& origin);

}  // namespace app

// What lies under a pixel, and where in the picture a point is.
#pragma once

#include <array>
#include <optional>

#include "app/scene/actor.h"
#include "app/scene/view/camera.h"

namespace app {

struct Ray {
  Vec3 from = Vec3::Zero(), along = -Vec3::UnitZ();  // m, world; unit
};

struct Picture {
  double width = 1, height = 1;  // pixels
  ViewPlace place;               // of the camera's view in it
};

// Through a pixel, counted from the picture's top left corner.
Ray rayThrough(double x, double y, const Picture& picture, const Camera& camera);

// The pixel of a point (m, world); nothing behind the eye.
std::optional<std::array<double, 2>> pixelOf(const Vec3& point, const Picture& picture, const Camera& camera);

// The ray's point in the plane through `place` that faces the camera; `place` where there is none.
Vec3 pointInPlane(const Ray& ray, const Vec3& place, const Vec3& facing);

// Where a ray meets the outside of the actor's hair first, and which external face is there. Nothing behind the body.
struct HairHit {
  Vec3 at = Vec3::Zero();
  int face = 0;
};
std::optional<HairHit> pickHairFace(const Ray& ray, const Actor& actor);
std::optional<Vec3> pickHair(const Ray& ray, const Actor& actor);

}  // namespace app

// Where the camera's view stands in a picture: one place for the renderer, for picking and for level of detail.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "app/scene/edit/picking.h"
#include "app/scene/view/camera.h"
#include "render/view_math.h"

namespace view_place_test {

using app::PicturePart;
using app::Vec3;
using app::ViewPlace;

app::Camera someCamera() {
  app::Camera camera;
  camera.anchor = Vec3(0.2, 1.6, -0.3), camera.target = Vec3(0, -0.1, 0.02);
  camera.yaw = 0.6, camera.pitch = 0.1, camera.distance = 1.9, camera.fov = 0.5;
  return camera;
}

// Shares of the picture from its top left corner, as the renderer shows a point.
std::array<double, 2> drawnAt(const Vec3& point, const app::Camera& camera, const ViewPlace& place, double aspect) {
  const render::CameraInput input = app::cameraInput(camera, place, Vec3::Zero());
  const Eigen::Vector4f clip =
      render::cameraMatrix(input, static_cast<float>(aspect)) *
      Eigen::Vector4f(static_cast<float>(point.x()), static_cast<float>(point.y()), static_cast<float>(point.z()), 1);
  return {0.5 + 0.5 * static_cast<double>(clip.x() / clip.w()), 0.5 - 0.5 * static_cast<double>(clip.y() / clip.w())};
}

struct Ends {
  Vec3 middle, top, bottom, left, right;
};

// Of what frameFigure has put into the view: a square, as wide as the picture at most.
Ends endsOf(const app::Camera& camera, double aspect) {
  const Vec3 back = app::viewBack(camera), right = Vec3::UnitY().cross(back).normalized(), up = back.cross(right);
  const double half = std::min(1.0, aspect) * camera.distance * std::tan(0.5 * camera.fov);
  const Vec3 middle = camera.anchor + camera.target;
  return {middle, middle + half * up, middle - half * up, middle - 0.8 * half * right, middle + 0.8 * half * right};
}

TEST(ViewPlace, WithoutPanelsNoBitChanges) {
  for (const double aspect : {16.0 / 9, 1.0, 0.5}) {
    EXPECT_EQ(app::placeIn({}, aspect), ViewPlace{});
    const app::Camera camera = someCamera();
    const render::CameraInput input = app::cameraInput(camera, app::placeIn({}, aspect), Vec3::Zero());
    EXPECT_EQ(input.fov_y, static_cast<float>(camera.fov));
    EXPECT_EQ(input.shift, 0);
    EXPECT_EQ(input.rise, 0);
  }
  EXPECT_EQ(app::placeIn({0.3, 0.35, 0, 1}, 1.5), ViewPlace{}) << "no room at all";
}

TEST(ViewPlace, WhatIsFramedStandsInTheMiddleOfThePartAndFitsIntoIt) {
  constexpr double kRounding = 1e-4;
  const app::Camera camera = someCamera();
  for (const double aspect : {16.0 / 9, 4.0 / 3, 0.6}) {
    const Ends ends = endsOf(camera, aspect);
    for (const PicturePart& free : {PicturePart{0.28, 0.76, 0, 0.91}, PicturePart{0, 0.7, 0, 0.8},
                                    PicturePart{0.4, 1, 0.1, 1}, PicturePart{0, 1, 0, 0.65}}) {
      const ViewPlace place = app::placeIn(free, aspect);
      const auto at = [&](const Vec3& point) { return drawnAt(point, camera, place, aspect); };
      EXPECT_NEAR(at(ends.middle)[0], 0.5 * (free.left + free.right), kRounding);
      EXPECT_NEAR(at(ends.middle)[1], 0.5 * (free.top + free.bottom), kRounding);
      EXPECT_GE(at(ends.top)[1], free.top - kRounding);
      EXPECT_LE(at(ends.bottom)[1], free.bottom + kRounding);
      EXPECT_GE(at(ends.left)[0], free.left - kRounding);
      EXPECT_LE(at(ends.right)[0], free.right + kRounding);
      EXPECT_LE(place.zoom, 1);
    }
  }
}

TEST(ViewPlace, IsAsLargeAsThePartAllows) {
  EXPECT_EQ(app::placeIn({0, 1, 0, 0.75}, 1.5).zoom, 0.75);
  EXPECT_EQ(app::placeIn({0.25, 0.75, 0, 1}, 1).zoom, 0.5 / 0.8);
  EXPECT_EQ(app::placeIn({0.25, 0.75, 0, 1}, 2).zoom, 1) << "wide pictures have room beside the figure";
  EXPECT_EQ(app::placeIn({0, 1, 0, 0.75}, 1.5, 0.7).zoom, 0.7);
}

TEST(ViewPlace, InAVeryLowPartTheHeadStays) {
  const app::Camera camera = someCamera();
  const PicturePart free{0, 1, 0.02, 0.42};
  const ViewPlace place = app::placeIn(free, 1.5);
  EXPECT_EQ(place.zoom, 0.6);
  EXPECT_NEAR(drawnAt(endsOf(camera, 1.5).top, camera, place, 1.5)[1], free.top, 1e-4);
}

TEST(ViewPlace, PickingSeesWhatIsDrawn) {
  const app::Camera camera = someCamera();
  const double width = 900, height = 600;
  const std::vector<ViewPlace> places{{}, {0.3, 0, 1}, {0, -0.4, 1}, {-0.2, 0.25, 0.7}};
  for (const ViewPlace& place : places) {
    const app::Picture picture{width, height, place};
    for (const Vec3& point : {Vec3(0.2, 1.6, -0.3), Vec3(0.35, 1.42, -0.1), Vec3(0, 1.8, -0.6)}) {
      const auto pixel = app::pixelOf(point, picture, camera);
      const std::array<double, 2> drawn = drawnAt(point, camera, place, width / height);
      ASSERT_TRUE(pixel);
      EXPECT_NEAR((*pixel)[0], drawn[0] * width, 0.02);
      EXPECT_NEAR((*pixel)[1], drawn[1] * height, 0.02);
      const app::Ray ray = app::rayThrough((*pixel)[0], (*pixel)[1], picture, camera);
      EXPECT_NEAR((point - ray.from).cross(ray.along).norm(), 0, 1e-9);
    }
  }
}

}  // namespace view_place_test

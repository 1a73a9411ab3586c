// The strands and the bodies of a frame as a scene of Embree's.
#pragma once

#include <embree3/rtcore.h>

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "render/frame_input.h"
#include "tests/strand_capture.h"

namespace reference {

using Eigen::Vector3f;

struct Hit {
  bool hair = false;  // else a body
  Vector3f at = Vector3f::Zero(), tangent = Vector3f::UnitY();
  float radius = 0;                     // m, of the strand there
  Vector3f normal = Vector3f::UnitY();  // of a body's triangle, unit
};

class TracedScene {
 public:
  // strands: as captured; radius: of a strand at its root, m; taper: of the tip over that.
  TracedScene(const std::vector<strand_capture::Polyline>& strands, float radius, float taper,
              std::span<const render::BodyInput> bodies);

  std::optional<Hit> first(const Vector3f& from, const Vector3f& direction, float nearest) const;
  bool lit(const Vector3f& from, const Vector3f& to_light, float nearest) const;

 private:
  void addStrands(const std::vector<strand_capture::Polyline>& strands, float radius, float taper);
  void addBody(const render::BodyInput& body);

  struct Release {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  };
  std::unique_ptr<RTCDeviceTy, Release> device_;
  std::unique_ptr<RTCSceneTy, Release> scene_;
  std::vector<Eigen::Vector4f> points_;  // of all strands, w: radius
  std::vector<unsigned> segments_;       // first point of each
};

}  // namespace reference

// The mannequin as an implicit function: negative inside, near a distance close to the surface.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "app/figure/mannequin_figure.h"

namespace app {

// Smooth minimum with continuous second derivative: blends two distances over width `k` (m).
double smoothMin(double a, double b, double k);
double smoothMax(double a, double b, double k);

// A tube of elliptical sections along a straight axis, closed by half-ellipsoid caps. Sections: half width across, half
// depth to the front and to the back, shift to the front; interpolated with continuous slope.
struct Section {
  double t;                         // 0..1 along the axis
  double side, front, back, shift;  // m
};

struct Loft {
  Vec3 a = Vec3::Zero(), axis = Vec3::UnitY(), side = Vec3::UnitX(), front = Vec3::UnitZ();
  double length = 1, cap_a = 0, cap_b = 0;
  double widest = 0;  // m: no point of the tube lies farther from its axis
  std::vector<Section> sections, slopes;

  double value(const Vec3& p) const;
  double lowerBound(const Vec3& p) const;                                 // cheap, never above the distance to the tube
  double along(const Vec3& p) const { return axis.dot(p - a) / length; }  // 0 at a, 1 at b, unclamped
};

// `front`: roughly the front direction, made perpendicular to the axis from a to b. Caps: m, axial half lengths.
Loft makeLoft(const Vec3& a, const Vec3& b, const Vec3& front, std::vector<Section> sections,
              std::array<double, 2> caps);

// An ellipsoid with axes turned by `axes` (columns) and different half lengths towards + and - of the third axis.
struct Egg {
  Vec3 center = Vec3::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Vec3 radii = Vec3::Ones();
  double value(const Vec3& p) const;
  double lowerBound(const Vec3& p) const { return (p - center).norm() - radii.maxCoeff(); }
};

// A cone with spherical ends of different radii.
struct RoundCone {
  Vec3 a = Vec3::Zero(), b = Vec3::UnitY();
  double ra = 1, rb = 1;
  double value(const Vec3& p) const;
  double lowerBound(const Vec3& p) const { return value(p); }
};

// The head in its own units: origin at the chin's level under the skull base, y = 0 chin, y = 1 crown, z forward.
double headValue(const Vec3& q);
double headWithoutEars(const Vec3& q);

// An ellipsoid of the head's: head heights, and rad that its axes are turned about x.
struct HeadEllipsoid {
  Vec3 center, radii;
  double turn;
};

// Bridge and base of the nose. Its skin sticks out of both by 0.0079 at most, 0.0019 for 19 in 20 points of it.
const std::array<HeadEllipsoid, 2>& noseEllipsoids();

// Distances to the body's regions before they are blended, for skinning.
struct RegionValues {
  double head, neck, trunk;
  std::array<double, 2> arms, legs;
  std::vector<double> appendages;
};

struct BodyField {
  Figure figure;
  Vec3 head_origin = Vec3::Zero();  // m
  double head_scale = 0.23;         // m per head unit
  Loft neck, trunk;
  std::vector<Egg> masses;       // bust, shoulder blades, buttocks, blended into the trunk
  std::vector<RoundCone> yokes;  // neck to shoulder
  struct ArmShape {
    bool present = false;
    Loft upper, fore, palm, fingers;
    RoundCone thumb;
    std::array<RoundCone, 4> digits;  // in place of the mitten `fingers`, see hand_mesh.h
    Vec3 knuckle, bend_axis;          // where fingers begin to bend, and about what they close
    Egg deltoid;
  };
  struct LegShape {
    bool present = false;
    Loft thigh, shin, foot;
    Egg heel, knee;
    double sole = 0;
  };
  std::array<ArmShape, 2> arms;
  std::array<LegShape, 2> legs;
  std::vector<std::vector<RoundCone>> appendages;

  double value(const Vec3& p) const;
  RegionValues regions(const Vec3& p) const;
  Vec3 toHead(const Vec3& p) const { return (p - head_origin) / head_scale; }
};

BodyField shapeBody(const Figure& figure);

// Palm, closed fingers and thumb of an arm.
double mittenValue(const BodyField::ArmShape& arm, const Vec3& p);

}  // namespace app

// The body of the mannequin below the chin. Sections are those of a slim standing woman 1.70 m tall, in metres, scaled
// by the figure's height and by its joint distances.
#include <algorithm>
#include <cmath>

#include "app/figure/mannequin_field.h"
#include "app/motion/least_rotation.h"

namespace app {

namespace {

std::vector<Section> scaled(std::vector<Section> sections, double s) {
  for (Section& x : sections) {
    x.side *= s;
    x.front *= s;
    x.back *= s;
    x.shift *= s;
  }
  return sections;
}

// The trunk, from under the crotch to the neck's root. Widths swell or slim with the joints' distances.
Loft shapeTrunk(const Figure& f, double s) {
  const double hips = std::clamp(0.5 + 0.5 * f.hip_half / (0.086 * s), 0.85, 1.25);
  const double chest = std::clamp(0.5 + 0.5 * f.shoulder_half / (0.155 * s), 0.85, 1.2);
  // Levels as shares of hip joint (0) to shoulder joint (1).
  struct Level {
    double t, side, front, back, shift;
  };
  const std::array<Level, 13> levels{{{-0.10, 0.105, 0.066, 0.080, -0.006},
                                      {-0.04, 0.140, 0.084, 0.098, -0.008},
                                      {0.05, 0.158, 0.093, 0.106, -0.009},
                                      {0.15, 0.155, 0.094, 0.099, -0.006},
                                      {0.26, 0.138, 0.090, 0.080, 0.002},
                                      {0.38, 0.113, 0.081, 0.070, 0.006},
                                      {0.50, 0.114, 0.082, 0.074, 0.002},
                                      {0.62, 0.126, 0.089, 0.084, -0.004},
                                      {0.74, 0.136, 0.094, 0.092, -0.010},
                                      {0.86, 0.138, 0.084, 0.092, -0.012},
                                      {0.95, 0.128, 0.068, 0.080, -0.010},
                                      {1.02, 0.104, 0.052, 0.064, -0.006},
                                      {1.06, 0.090, 0.046, 0.055, -0.002}}};
  const double span = std::max(f.shoulder_level - f.pelvis.y(), 0.15 * s);
  const auto spot = [&](double t) {
    const double u = std::clamp(t, 0.0, 1.0);
    return Vec3((1 - u) * f.pelvis.x() + u * f.neck_base.x(), f.pelvis.y() + t * span,
                (1 - u) * f.pelvis.z() + u * f.neck_base.z());
  };
  const double lo = levels.front().t, hi = levels.back().t;
  std::vector<Section> sections;
  for (const Level& l : levels) {
    const double upper = std::clamp((l.t - 0.35) / 0.4, 0.0, 1.0);
    const double w = s * (hips + (chest - hips) * upper);
    sections.push_back({(l.t - lo) / (hi - lo), l.side * w, l.front * s, l.back * s, l.shift * s});
  }
  return makeLoft(spot(lo), spot(hi), Vec3::UnitZ(), std::move(sections), {0.055 * s, 0.06 * s});
}

void addMasses(const Figure& f, double s, BodyField& body) {
  const double span = std::max(f.shoulder_level - f.pelvis.y(), 0.15 * s);
  const auto centre = [&](double t) {
    return Vec3((1 - t) * f.pelvis.x() + t * f.neck_base.x(), f.pelvis.y() + t * span,
                (1 - t) * f.pelvis.z() + t * f.neck_base.z());
  };
  for (const double side : {1.0, -1.0}) {
    const Eigen::Matrix3d turned = Eigen::AngleAxisd(side * 0.28, Vec3::UnitY()).toRotationMatrix();
    const auto place = [&](double t, double x, double z) { return Vec3(centre(t) + s * Vec3(side * x, 0, z)); };
    body.masses.push_back({place(0.735, 0.066, 0.046), turned, s * Vec3(0.055, 0.058, 0.056)});
    body.masses.push_back({place(0.80, 0.060, -0.060), turned.transpose(), s * Vec3(0.055, 0.085, 0.038)});
    body.masses.push_back({place(0.0, 0.070, -0.060), turned.transpose(), s * Vec3(0.072, 0.080, 0.064)});
    // The yoke falls from the neck to the point of the shoulder.
    const Vec3 shoulder(f.neck_base.x() + side * f.shoulder_half, f.shoulder_level, centre(1.0).z());
    const Vec3 neck = f.neck_base + s * Vec3(side * 0.030, -0.030, -0.006);
    body.yokes.push_back({neck, Vec3(neck + 0.94 * (shoulder - neck) + s * Vec3(0, -0.006, 0)), 0.044 * s, 0.036 * s});
  }
}

Loft shapeNeck(const Figure& f, double s) {
  const Vec3 base = f.neck_base + s * Vec3(0, -0.055, -0.004);
  const Vec3 top = f.skull_base + s * Vec3(0, 0.030, -0.006);
  return makeLoft(base, top, Vec3::UnitZ(),
                  scaled({{0.0, 0.070, 0.056, 0.060, 0.0},
                          {0.25, 0.058, 0.052, 0.055, 0.0},
                          {0.5, 0.0515, 0.051, 0.053, 0.0},
                          {0.75, 0.050, 0.052, 0.054, 0.002},
                          {1.0, 0.051, 0.054, 0.058, 0.004}},
                         s),
                  {0.03 * s, 0.03 * s});
}

// Closed fingers, the first one ahead, from `root` inside the palm to their tips beyond the knuckles.
std::array<RoundCone, 4> shapeDigits(const Vec3& root, const Vec3& knuckle, const Vec3& finger, double s) {
  struct Digit {
    double ahead, length, base, tip;  // m
  };
  constexpr std::array<Digit, 4> digits{{{0.0262, 0.077, 0.0124, 0.0076},
                                         {0.0086, 0.082, 0.0126, 0.0078},
                                         {-0.0088, 0.078, 0.0122, 0.0075},
                                         {-0.0262, 0.066, 0.0112, 0.0068}}};
  const Vec3 ahead = Vec3::UnitZ(), across = (ahead - finger * finger.dot(ahead)).normalized();
  std::array<RoundCone, 4> cones;
  for (std::size_t k = 0; k < digits.size(); ++k) {
    const Digit& d = digits[k];
    cones[k] = {root + across * d.ahead * s, knuckle + finger * d.length * s + across * 0.72 * d.ahead * s, d.base * s,
                d.tip * s};
  }
  return cones;
}

// At elbow and knee two lofts meet, and their blend adds a sixth of its width (smoothMin): each is slimmer there by
// that.
BodyField::ArmShape shapeArm(const Figure::Arm& a, double s) {
  BodyField::ArmShape arm;
  arm.present = true;
  const Vec3 ahead = Vec3::UnitZ();
  arm.upper = makeLoft(a.shoulder, a.elbow, ahead,
                       scaled({{0.0, 0.034, 0.041, 0.041, 0.0},
                               {0.10, 0.0395, 0.044, 0.044, 0.0},
                               {0.24, 0.0415, 0.045, 0.044, 0.0},
                               {0.5, 0.0375, 0.041, 0.040, 0.0},
                               {0.8, 0.033, 0.035, 0.035, 0.0},
                               {1.0, 0.0295, 0.030, 0.031, 0.0}},
                              s),
                       {0.024 * s, 0.03 * s});
  // Flesh begins outside the joint where a skeleton's shoulders are narrow.
  arm.deltoid = {a.shoulder + (a.elbow - a.shoulder).normalized() * 0.045 * s + s * Vec3(a.side * 0.002, -0.006, 0),
                 leastRotation(Vec3::UnitY(), a.elbow - a.shoulder).toRotationMatrix(), s * Vec3(0.040, 0.066, 0.045)};
  arm.fore = makeLoft(a.elbow, a.wrist, ahead,
                      scaled({{0.0, 0.0290, 0.030, 0.030, 0.0},
                              {0.22, 0.0335, 0.037, 0.036, 0.0},
                              {0.5, 0.029, 0.033, 0.032, 0.0},
                              {0.8, 0.0215, 0.026, 0.026, 0.0},
                              {1.0, 0.019, 0.025, 0.025, 0.0}},
                             s),
                      {0.03 * s, 0.02 * s});
  // Mitten: the palm goes on along the forearm, the fingers curl towards the thigh, the thumb lies ahead.
  Vec3 along = a.tip - a.wrist;
  if (along.norm() < 0.02 * s) along = a.wrist - a.elbow;
  along.normalize();
  const Vec3 inward = (Vec3(-a.side, 0, 0) - along * along.dot(Vec3(-a.side, 0, 0))).normalized();
  const Vec3 knuckle = a.wrist + along * 0.092 * s;
  const Vec3 finger = (along + 0.30 * inward + 0.05 * ahead).normalized();
  arm.palm = makeLoft(a.wrist, knuckle, ahead,
                      scaled({{0.0, 0.018, 0.024, 0.024, 0.0},
                              {0.35, 0.0175, 0.031, 0.031, 0.001},
                              {0.75, 0.0165, 0.037, 0.037, 0.001},
                              {1.0, 0.0145, 0.036, 0.037, 0.0}},
                             s),
                      {0.018 * s, 0.015 * s});
  arm.fingers = makeLoft(knuckle - along * 0.010 * s, knuckle + finger * 0.080 * s, ahead,
                         scaled({{0.0, 0.0145, 0.036, 0.037, 0.0},
                                 {0.4, 0.0125, 0.034, 0.035, 0.0},
                                 {0.75, 0.0105, 0.028, 0.028, 0.0},
                                 {1.0, 0.0085, 0.017, 0.018, 0.0}},
                                s),
                         {0.012 * s, 0.014 * s});
  const Vec3 root = a.wrist + along * 0.024 * s + ahead * 0.014 * s + inward * 0.006 * s;
  arm.thumb = {root, Vec3(root + (along * 0.70 + ahead * 0.52 + inward * 0.28).normalized() * 0.066 * s), 0.0165 * s,
               0.0095 * s};
  arm.digits = shapeDigits(knuckle - along * 0.020 * s, knuckle, finger, s);
  arm.knuckle = knuckle;
  arm.bend_axis = finger.cross(inward).normalized();
  return arm;
}

BodyField::LegShape shapeLeg(const Figure::Leg& l, double s, double sole) {
  BodyField::LegShape leg;
  leg.present = true;
  leg.sole = sole;
  const Vec3 ahead = Vec3::UnitZ();
  leg.thigh = makeLoft(l.hip, l.knee, ahead,
                       scaled({{0.0, 0.080, 0.082, 0.086, -0.004},
                               {0.2, 0.079, 0.084, 0.082, 0.000},
                               {0.45, 0.069, 0.075, 0.071, 0.004},
                               {0.7, 0.057, 0.062, 0.058, 0.004},
                               {0.9, 0.0490, 0.0515, 0.0495, 0.002},
                               {1.0, 0.0430, 0.0450, 0.0440, 0.001}},
                              s),
                       {0.06 * s, 0.04 * s});
  leg.shin = makeLoft(l.knee, l.ankle, ahead,
                      scaled({{0.0, 0.0420, 0.0430, 0.0445, 0.0},
                              {0.12, 0.0455, 0.0425, 0.0535, -0.002},
                              {0.30, 0.0485, 0.040, 0.063, -0.005},
                              {0.50, 0.043, 0.037, 0.052, -0.004},
                              {0.75, 0.032, 0.032, 0.036, -0.002},
                              {0.92, 0.0275, 0.031, 0.033, 0.0},
                              {1.0, 0.028, 0.033, 0.034, 0.0}},
                             s),
                      {0.04 * s, 0.03 * s});
  leg.knee = {l.knee + s * Vec3(0, 0.008, 0.012), Eigen::Matrix3d::Identity(), s * Vec3(0.030, 0.046, 0.034)};

  Vec3 way = l.toe - l.ankle;
  way.y() = 0;
  way = way.norm() > 0.03 * s ? Vec3(way.normalized()) : Vec3(l.side * 0.12, 0, 0.99);
  const Vec3 under(l.ankle.x(), sole, l.ankle.z());
  const double rise = std::max(l.ankle.y() - sole, 0.04 * s);
  leg.heel = {under + way * (-0.018 * s) + Vec3(0, 0.030 * s, 0), Eigen::Matrix3d::Identity(),
              s * Vec3(0.032, 0.036, 0.036)};
  // Front of a foot's section is up: the axis lies along the foot, a little above the sole.
  const double u = rise / s;
  leg.foot = makeLoft(under + way * (-0.020 * s) + Vec3(0, 0.018 * s, 0),
                      under + way * (0.158 * s) + Vec3(0, 0.014 * s, 0), Vec3::UnitY(),
                      scaled({{0.0, 0.029, 0.9 * u, 0.022, 0.0},
                              {0.22, 0.031, 0.82 * u, 0.021, 0.0},
                              {0.45, 0.035, 0.042, 0.020, 0.0},
                              {0.70, 0.042, 0.026, 0.019, 0.0},
                              {0.88, 0.041, 0.018, 0.018, 0.0},
                              {1.0, 0.034, 0.014, 0.016, 0.0}},
                             s),
                      {0.02 * s, 0.038 * s});
  return leg;
}

void addAppendages(const Figure& f, double s, BodyField& body) {
  for (const Figure::Appendage& appendage : f.appendages) {
    std::vector<RoundCone> cones;
    const double count = static_cast<double>(appendage.points.size() - 1);
    for (std::size_t i = 0; i + 1 < appendage.points.size(); ++i) {
      const auto radius = [&](double k) { return s * (0.045 - 0.030 * k / count); };
      cones.push_back({appendage.points[i], appendage.points[i + 1], radius(i), radius(i + 1.0)});
    }
    body.appendages.push_back(std::move(cones));
  }
}

}  // namespace

BodyField shapeBody(const Figure& figure) {
  const double s = figure.height / 1.70;
  BodyField body;
  body.figure = figure;
  body.head_scale = figure.head_height;
  body.head_origin = figure.skull_base - figure.head_height * Vec3(0, 0.30, -0.03);
  body.trunk = shapeTrunk(figure, s);
  addMasses(figure, s, body);
  body.neck = shapeNeck(figure, s);
  for (int side = 0; side < 2; ++side) {
    if (figure.arms[side].present) body.arms[side] = shapeArm(figure.arms[side], s);
    if (figure.legs[side].present) body.legs[side] = shapeLeg(figure.legs[side], s, figure.sole);
  }
  addAppendages(figure, s, body);
  return body;
}

}  // namespace app

#include "app/figure/character_build.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace app {

namespace {

constexpr std::size_t kMaxFitPoints = 500;

std::vector<FitPoint> thinned(const std::vector<FitPoint>& points) {
  if (points.size() <= kMaxFitPoints) return points;
  std::vector<FitPoint> some;
  const double step = static_cast<double>(points.size()) / kMaxFitPoints;
  for (std::size_t i = 0; i < kMaxFitPoints; ++i) some.push_back(points[static_cast<std::size_t>(i * step)]);
  return some;
}

// Joints below the head (eyes, jaw) count as head.
bool hangsOn(const Skeleton& skeleton, int joint, int ancestor) {
  for (; joint >= 0; joint = skeleton.joints[joint].parent)
    if (joint == ancestor) return true;
  return false;
}

std::string roleName(const Skeleton& skeleton, const BodyRoles& roles, int joint) {
  for (int s = 0; s < 2; ++s) {
    const std::string side = s == 0 ? "left_" : "right_";
    const ArmRoles& a = roles.arms[s];
    const LegRoles& l = roles.legs[s];
    if (joint == a.clavicle) return side + "shoulder";
    if (joint == a.upper) return side + "upper_arm";
    if (joint == a.fore) return side + "forearm";
    if (joint == a.hand) return side + "hand";
    if (joint == l.upper) return side + "thigh";
    if (joint == l.lower) return side + "shin";
    if (joint == l.foot) return side + "foot";
  }
  if (joint == roles.chest) return "chest";
  if (joint == roles.spine.front()) return "pelvis";
  if (roles.spine.size() > 1 && joint == roles.spine[roles.spine.size() - 2]) return "neck";
  return plainName(skeleton.joints[joint].name);
}

}  // namespace

std::vector<FitPoint> surfacePoints(const SkinnedMesh& mesh) {
  std::vector<FitPoint> points;
  for (const auto& p : mesh.positions) points.push_back({p.cast<double>(), 0});
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
    const Vec3 a = points[mesh.triangles[t]].position, b = points[mesh.triangles[t + 1]].position,
               c = points[mesh.triangles[t + 2]].position;
    const double third = (b - a).cross(c - a).norm() / 6;
    for (int k = 0; k < 3; ++k) points[mesh.triangles[t + k]].weight += third;
  }
  return points;
}

std::vector<int> dominantJoints(const SkinnedMesh& mesh) {
  std::vector<int> joints;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const auto& w = mesh.weights[v];
    joints.push_back(mesh.joints[v][std::max_element(w.begin(), w.end()) - w.begin()]);
  }
  return joints;
}

void fitParts(std::vector<BodyPart> parts, Character& character) {
  double mean = 0, worst = 0, area = 0;
  std::string worst_name;
  for (BodyPart& part : parts) {
    if (part.points.size() < 8) continue;
    const std::vector<FitPoint> points = thinned(part.points);
    BodyEllipsoid start = part.given_start ? part.start : principalEllipsoid(points);
    start.name = part.name;
    start.joint = part.joint;
    BodyEllipsoid fitted = fitEllipsoid(points, start, part.hold, part.outside);
    const FitReport report = reportFit(points, fitted);
    double part_area = 0;
    for (const FitPoint& p : points) part_area += p.weight;
    mean += part_area * report.mean_gap;
    area += part_area;
    if (report.max_gap > worst) {
      worst = report.max_gap;
      worst_name = part.name;
    }
    const Rigid to_joint = character.skeleton.joints[part.joint].rest_world.inverse();
    fitted.center = to_joint * fitted.center;
    fitted.rotation = (Eigen::Quaterniond(to_joint.linear()) * fitted.rotation).normalized();
    character.ellipsoids.push_back(std::move(fitted));
  }
  char text[160];
  std::snprintf(text, sizeof text, "ellipsoids: %zu, mean signed gap %.1f mm, largest %.0f mm (%s)",
                character.ellipsoids.size(), 1000 * mean / std::max(area, 1e-9), 1000 * worst, worst_name.c_str());
  character.notes.push_back(text);
}

namespace {

struct SurfaceSample {
  FitPoint point;
  std::uint32_t vertex;  // the triangle's corner that it is nearest to
};

// Points spread over the triangles, at least one each, so that a low-poly surface counts between its vertices too.
std::vector<SurfaceSample> sampleSurface(const SkinnedMesh& mesh) {
  double total = 0;
  const auto corners = [&](std::size_t t) {
    return std::array<Vec3, 3>{mesh.positions[mesh.triangles[t]].cast<double>(),
                               mesh.positions[mesh.triangles[t + 1]].cast<double>(),
                               mesh.positions[mesh.triangles[t + 2]].cast<double>()};
  };
  const auto areaOf = [](const std::array<Vec3, 3>& c) { return 0.5 * (c[1] - c[0]).cross(c[2] - c[0]).norm(); };
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) total += areaOf(corners(t));
  std::vector<SurfaceSample> samples;
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
    const auto c = corners(t);
    const double area = areaOf(c);
    // n rows a side give n^2 small triangles, one sample in the middle of each.
    const int n = std::clamp(static_cast<int>(std::ceil(std::sqrt(area * 10000 / std::max(total, 1e-12)))), 1, 40);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < 2 * (n - i) - 1; ++j) {
        const double v = (i + (j % 2 ? 2.0 : 1.0) / 3) / n, w = (j / 2 + (j % 2 ? 2.0 : 1.0) / 3) / n, u = 1 - v - w;
        const int nearest = u >= v && u >= w ? 0 : (v >= w ? 1 : 2);
        samples.push_back({{u * c[0] + v * c[1] + w * c[2], area / (n * n)}, mesh.triangles[t + nearest]});
      }
    }
  }
  return samples;
}

// A part of the skull with a start read off the scalp: the middle of the skin on a level (share of head height above
// the chin), as wide and deep as the skin is there.
BodyPart skullPart(const std::string& name, double level, const Character& character) {
  const Scalp& scalp = character.scalp;
  const Rigid from_scalp = character.skeleton.joints[character.head_joint].rest_world * character.head_frame;
  const auto radius = [&](int row, int quarter) {
    return scalp.radius[row * scalp.columns + quarter * scalp.columns / 4];
  };
  const int row = level > 0.5 ? scalp.rows / 2 : 5 * scalp.rows / 8;
  const double drop = level > 0.5 ? 0 : -(0.585 - level) * scalp.head_height;
  const double front = radius(row, 0), back = level > 0.5 ? radius(row, 2) : 0.1 * front;
  BodyPart part;
  part.name = name;
  part.joint = character.head_joint;
  part.given_start = true;
  part.hold = 0.05 * scalp.head_height / 0.23;
  part.start.center = from_scalp * Vec3(scalp.center + Vec3(0, drop, 0.5 * (front - back)));
  part.start.rotation = Eigen::Quaterniond(from_scalp.linear());
  part.start.radii = Vec3(0.5 * (radius(row, 1) + radius(row, 3)), 0.40 * scalp.head_height, 0.5 * (front + back));
  return part;
}

}  // namespace

std::vector<BodyPart> partsByJoint(const Character& character, const BodyRoles& roles) {
  const Skeleton& skeleton = character.skeleton;
  const std::vector<FitPoint> points = surfacePoints(character.mesh);
  const std::vector<int> dominant = dominantJoints(character.mesh);
  const std::size_t joints = skeleton.joints.size();
  std::vector<double> area(joints, 0);
  double total = 0;
  for (std::size_t v = 0; v < points.size(); ++v) {
    area[dominant[v]] += points[v].weight;
    total += points[v].weight;
  }
  // A joint with little skin gives it to its parent, from the leaves up; everything from the head on is head.
  std::vector<int> owner(joints);
  for (std::size_t j = 0; j < joints; ++j) owner[j] = static_cast<int>(j);
  for (int j = static_cast<int>(joints) - 1; j > 0; --j) {
    const int parent = skeleton.joints[j].parent;
    const bool small = area[j] < 0.006 * total && area[j] > 0;
    if (parent < 0 || j == character.head_joint || !(small || hangsOn(skeleton, parent, character.head_joint)))
      continue;
    if (small && area[parent] == 0 && skeleton.joints[parent].parent < 0) continue;
    owner[j] = parent;
    area[parent] += area[j];
  }
  const auto ownerOf = [&](int joint) {
    while (owner[joint] != joint) joint = owner[joint];
    return joint;
  };

  const Rigid from_scalp = skeleton.joints[character.head_joint].rest_world * character.head_frame;
  const Rigid to_scalp = from_scalp.inverse();
  const double size = character.scalp.head_height, chin = character.scalp.center.y() - 0.585 * size;
  std::map<int, BodyPart> by_joint;
  BodyPart jaw = skullPart("jaw", 0.30, character);
  for (const SurfaceSample& sample : sampleSurface(character.mesh)) {
    const int joint = ownerOf(dominant[sample.vertex]);
    const Vec3 place = to_scalp * sample.point.position;
    const double level = (place.y() - chin) / size;
    if (joint != character.head_joint)
      by_joint[joint].points.push_back(sample.point);
    else if (level > 0.42)
      by_joint[joint].points.push_back(sample.point);
    else if (level > 0 && place.z() > character.scalp.center.z())
      jaw.points.push_back(sample.point);
  }
  std::vector<BodyPart> parts;
  for (auto& [joint, part] : by_joint) {
    if (area[joint] < 0.004 * total) continue;
    if (joint == character.head_joint) {
      std::vector<FitPoint> skull = std::move(part.points);
      part = skullPart("head", 0.60, character);
      part.points = std::move(skull);
    } else {
      part.name = roleName(skeleton, roles, joint);
    }
    part.joint = joint;
    parts.push_back(std::move(part));
  }
  parts.push_back(std::move(jaw));
  return parts;
}

void sampleHead(const HeadMeasure* measure, Character& character) {
  const Skeleton& skeleton = character.skeleton;
  const Rigid to_scalp = (skeleton.joints[character.head_joint].rest_world * character.head_frame).inverse();
  std::vector<bool> is_head_joint(skeleton.joints.size());
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j)
    is_head_joint[j] = hangsOn(skeleton, static_cast<int>(j), character.head_joint);
  const std::vector<int> dominant = dominantJoints(character.mesh);
  std::vector<Vec3> vertices, head_vertices;
  for (std::size_t v = 0; v < character.mesh.positions.size(); ++v) {
    vertices.push_back(to_scalp * character.mesh.positions[v].cast<double>());
    if (is_head_joint[dominant[v]]) head_vertices.push_back(vertices.back());
  }
  const HeadMeasure found = measure ? *measure : measureHead(head_vertices);
  // Around the nape the skin is the neck's: it counts as far as the skull's own width; shoulders do not.
  const double floor = found.chin - 0.12 * (found.crown - found.chin), reach = 0.48 * (found.crown - found.chin);
  const auto counts = [&](std::uint32_t v) {
    const Vec3 p = vertices[v] - found.center;
    return vertices[v].y() > floor && (is_head_joint[dominant[v]] || std::hypot(p.x(), p.z()) < reach);
  };
  std::vector<std::uint32_t> triangles;
  const auto& index = character.mesh.triangles;
  for (std::size_t t = 0; t + 2 < index.size(); t += 3) {
    if (counts(index[t]) && counts(index[t + 1]) && counts(index[t + 2]))
      triangles.insert(triangles.end(), {index[t], index[t + 1], index[t + 2]});
  }
  character.scalp = sampleScalp(vertices, triangles, found);
}

}  // namespace app

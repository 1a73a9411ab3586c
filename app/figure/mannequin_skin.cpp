#include "app/figure/mannequin_skin.h"

#include <algorithm>
#include <cmath>

#include "app/figure/smoothstep.h"

namespace app {

namespace {

// Weights over all joints, sparse.
struct Weights {
  std::vector<std::pair<int, double>> entries;
  void add(int joint, double w) {
    if (w <= 0) return;
    for (auto& e : entries) {
      if (e.first == joint) {
        e.second += w;
        return;
      }
    }
    entries.emplace_back(joint, w);
  }
};

// Joints along a chain with the position (m) at which each takes over from the one before, and how softly.
struct Handover {
  int joint;
  double at, softness;
};

void addChain(const std::vector<Handover>& chain, double position, double weight, Weights& out) {
  double left = weight;
  for (std::size_t i = chain.size(); i-- > 1;) {
    const double taken = smoothstep(chain[i].at - chain[i].softness, chain[i].at + chain[i].softness, position) * left;
    out.add(chain[i].joint, taken);
    left -= taken;
  }
  out.add(chain.front().joint, left);
}

struct Skinner {
  const BodyField& body;
  const Skeleton& skeleton;
  const BodyRoles& roles;
  double s;                     // size against a 1.70 m figure
  std::vector<Handover> spine;  // root to head, over y

  Skinner(const BodyField& b, const Skeleton& k, const BodyRoles& r)
      : body(b), skeleton(k), roles(r), s(b.figure.height / 1.70) {
    double before = -1e9;
    for (std::size_t i = 0; i < roles.spine.size(); ++i) {
      const int j = roles.spine[i];
      double at = skeleton.joints[j].rest_world.translation().y();
      if (j == roles.head) at = roles.head_is_neck ? body.figure.neck_base.y() : body.figure.skull_base.y() - 0.010 * s;
      at = std::max(at, before + 1e-3);
      const double gap = i == 0 ? 0.1 : at - before;
      spine.push_back({j, at, std::clamp(0.75 * gap, 0.012 * s, j == roles.head ? 0.030 * s : 0.07 * s)});
      before = at;
    }
    // Only the part of the pelvis joint's range below the first bend belongs to the root.
    spine.front().at = -1e9;
  }

  void addTrunk(const Vec3& p, double weight, Weights& out) const {
    double left = weight;
    for (int side = 0; side < 2; ++side) {
      const int clavicle = roles.arms[side].clavicle;
      if (clavicle < 0) continue;
      const double sign = side == 0 ? 1 : -1;
      const double x = sign * (p.x() - body.figure.neck_base.x()) / body.figure.shoulder_half;
      const double y = (p.y() - body.figure.shoulder_level) / s;
      const double taken = left * smoothstep(0.25, 1.0, x) * smoothstep(-0.11, -0.02, y);
      out.add(clavicle, taken);
      left -= taken;
    }
    addChain(spine, std::min(p.y(), body.figure.neck_base.y()), left, out);
  }

  void addArm(int side, const Vec3& p, double weight, Weights& out) const {
    const ArmRoles& a = roles.arms[side];
    const auto& shape = body.arms[side];
    // One coordinate along the arm: metres from the shoulder, past the elbow along the forearm.
    const Vec3 bend = (shape.upper.axis + shape.fore.axis).normalized();
    const double past = bend.dot(p - shape.fore.a);
    const double position = shape.upper.length + (past < 0 ? std::min(past, shape.upper.axis.dot(p - shape.fore.a))
                                                           : std::max(past, shape.fore.axis.dot(p - shape.fore.a)));
    std::vector<Handover> chain{{a.upper, -1e9, 0}, {a.fore, shape.upper.length, 0.045 * s}};
    if (a.hand >= 0) chain.push_back({a.hand, shape.upper.length + shape.fore.length, 0.030 * s});
    addChain(chain, position, weight, out);
  }

  void addLeg(int side, const Vec3& p, double weight, Weights& out) const {
    const LegRoles& l = roles.legs[side];
    const auto& shape = body.legs[side];
    const double knee = shape.thigh.axis.dot(p - shape.shin.a);
    std::vector<Handover> chain{{l.upper, -1e9, 0}, {l.lower, 0.0, 0.060 * s}};
    Weights leg;
    addChain(chain, knee, weight, leg);
    if (l.foot < 0) {
      for (const auto& e : leg.entries) out.add(e.first, e.second);
      return;
    }
    const Vec3 ankle = shape.shin.a + shape.shin.axis * shape.shin.length;
    const Vec3 q = p - ankle;
    // The foot begins below the ankle and in front of it.
    const double down = -q.y() + 0.45 * shape.foot.axis.dot(q);
    const double foot = smoothstep(-0.030 * s, 0.030 * s, down) * smoothstep(-0.12 * s, -0.04 * s, -q.y());
    for (const auto& e : leg.entries) out.add(e.first, e.second * (1 - foot));
    double rest = weight * foot;
    if (l.toe >= 0) {
      const Vec3 toe = skeleton.joints[l.toe].rest_world.translation();
      const double taken = rest * smoothstep(-0.022 * s, 0.022 * s, shape.foot.axis.dot(p - toe));
      out.add(l.toe, taken);
      rest -= taken;
    }
    out.add(l.foot, rest);
  }

  void addAppendage(std::size_t index, const Vec3& p, double weight, Weights& out) const {
    const Figure::Appendage& appendage = body.figure.appendages[index];
    std::vector<Handover> chain;
    double position = 0, best = 1e9, at = 0;
    for (std::size_t i = 0; i + 1 < appendage.points.size(); ++i) {
      const Vec3 a = appendage.points[i], ab = appendage.points[i + 1] - a;
      const double length = std::max(ab.norm(), 1e-9), t = std::clamp((p - a).dot(ab) / (length * length), 0.0, 1.0);
      if (const double d = (p - a - t * ab).norm(); d < best) {
        best = d;
        position = at + t * length;
      }
      if (i < appendage.joints.size()) chain.push_back({appendage.joints[i], at, 0.03 * s});
      at += length;
    }
    addChain(chain, position, weight, out);
  }

  Weights weigh(const Vec3& p) const {
    Weights out;
    const RegionValues r = body.regions(p);
    // Shares of the regions: the nearer surface wins, softly where two meet.
    double nearest = std::min({r.head, r.neck, r.trunk});
    for (int side = 0; side < 2; ++side) nearest = std::min({nearest, r.arms[side], r.legs[side]});
    for (double a : r.appendages) nearest = std::min(nearest, a);
    const auto share = [&](double d, double width) {
      return std::pow(1 - smoothstep(0, 1, (d - nearest) / (width * s)), 2);
    };
    const double head = share(r.head, 0.022), neck = share(r.neck, 0.022), trunk = share(r.trunk, 0.035);
    double total = head + neck + trunk;
    std::array<double, 2> arms, legs;
    for (int side = 0; side < 2; ++side) {
      arms[side] = share(r.arms[side], 0.035);
      legs[side] = share(r.legs[side], 0.040);
      total += arms[side] + legs[side];
    }
    std::vector<double> tails;
    for (double a : r.appendages) total += tails.emplace_back(share(a, 0.03));

    // The skull and the face are one bone; only the jaw's underside and the nape give way to the neck.
    const Vec3 q = body.toHead(p);
    const double skull =
        r.head < r.neck + 0.004 ? std::max(smoothstep(0.22, 0.34, q.y()), smoothstep(0.10, 0.22, q.z())) : 0;
    const double rigid = std::max(skull * head, 0.0);
    out.add(roles.head, rigid / total);
    addChain(spine, p.y(), (head - rigid + neck) / total, out);
    addTrunk(p, trunk / total, out);
    for (int side = 0; side < 2; ++side) {
      if (arms[side] > 0) addArm(side, p, arms[side] / total, out);
      if (legs[side] > 0) addLeg(side, p, legs[side] / total, out);
    }
    for (std::size_t i = 0; i < tails.size(); ++i) addAppendage(i, p, tails[i] / total, out);
    return out;
  }
};

// Distance to the edge of a suit without sleeves, m, negative under it: trunk and legs down to the ankles, cut out
// around neck and shoulders.
double garment(const BodyField& body, const Vec3& p) {
  const RegionValues r = body.regions(p);
  const Figure& f = body.figure;
  const double s = f.height / 1.70, across = std::abs(p.x() - f.neck_base.x()) / s;
  const double dip = p.z() > f.neck_base.z() ? 0.085 : 0.055;
  const double neckline =
      f.shoulder_level + s * (0.055 - (dip + 0.055) * (1 - std::pow(std::min(across / 0.105, 1.0), 3)));
  const double covered = std::min({r.trunk, r.legs[0], r.legs[1]});
  const double bare = std::min({r.arms[0], r.arms[1], r.neck, r.head});
  return std::max({covered - bare, p.y() - neckline, f.sole + 0.095 * s - p.y()});
}

void store(Weights weights, SkinnedMesh& mesh) {
  auto& e = weights.entries;
  std::sort(e.begin(), e.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  if (e.size() > 4) e.resize(4);
  double total = 0;
  for (const auto& x : e) total += x.second;
  std::array<std::uint16_t, 4> joints{};
  std::array<float, 4> values{};
  for (std::size_t i = 0; i < e.size(); ++i) {
    joints[i] = static_cast<std::uint16_t>(e[i].first);
    values[i] = static_cast<float>(e[i].second / total);
  }
  mesh.joints.push_back(joints);
  mesh.weights.push_back(values);
}

}  // namespace

SkinnedMesh skinMannequin(const Surface& surface, const BodyField& body, const Skeleton& skeleton,
                          const BodyRoles& roles) {
  SkinnedMesh mesh;
  mesh.triangles = surface.triangles;
  const Skinner skinner(body, skeleton, roles);
  for (std::size_t v = 0; v < surface.positions.size(); ++v) {
    mesh.positions.push_back(surface.positions[v].cast<float>());
    mesh.normals.push_back(surface.normals[v].cast<float>());
    store(skinner.weigh(surface.positions[v]), mesh);
    mesh.cloth.push_back(static_cast<float>(garment(body, surface.positions[v])));
  }
  return mesh;
}

}  // namespace app

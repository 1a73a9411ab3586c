#include "app/styles/style_comb.h"

#include <algorithm>
#include <cmath>

#include "app/styles/style_cut.h"

namespace app {
namespace {

constexpr double kRowStep = 0.006;         // m, below the hairline
constexpr double kInnerGap = 0.006;        // m, between the body and the underside of the hair
constexpr double kTautnessInFront = 0.25;  // below the jaw: hair lies on the chest
constexpr double kCloseBeside = 0.9;       // of the way from one flow line to the next, at either side of the divide
constexpr double kDivide = 0.35;           // hair rooted in front of this backness falls in front of the shoulders
constexpr double kFringe = 0.22, kBesideFringe = 0.32;  // backness where the fringe ends and the hair beside it begins
constexpr double kSweptBehind = 0.33;                   // backness from which on no hair is swept forward

constexpr double kHugged = 0.03;  // m off the body from which on hair hangs free of it

// Hair leaves the scalp at about 25 degrees until it lies on the hair below, a little higher at the crown.
constexpr double kLift = 0.0035, kLiftAtCrown = 0.0065;          // m
constexpr double kLiftReach = 0.009, kLiftReachAtCrown = 0.016;  // m
constexpr double kThinnestInFront = 0.42;  // thickness of the coat at the forehead's hairline over that at the sides

// Height of the shoulders' tops beside the neck, where hair comes to rest.
double shoulderHeight(const Scalp& scalp, const BodyDistance& body) {
  const double unit = scalp.head_height;
  double sum = 0;
  for (const double side : {1.0, -1.0}) {
    double y = -0.45 * unit;
    while (y > -1.3 * unit && body(scalp.center + Vec3(side * 0.47 * unit, y, -0.1 * unit)) > 0) y -= 0.004;
    sum += y;
  }
  return std::clamp(sum / 2, -1.15 * unit, -0.65 * unit);
}

// First place off the body on the way in from far behind (toward = 1) or before (toward = -1) at a height.
double surfaceDepth(const Scalp& scalp, const BodyDistance& body, const Vec3& at, double toward) {
  const double start = -toward * 1.6 * scalp.head_height;
  double z = start;
  for (int i = 0; i < 200; ++i) {
    const double d = body(scalp.center + Vec3(at.x(), at.y(), z));
    if (d < 0.004 || z * toward > 0) break;
    z += toward * std::max(0.6 * d, 0.002);
  }
  return z;
}

struct Comber {
  Style style;
  const Scalp& scalp;
  const BodyDistance& body;
  const FlowLines& lines;
  Cut cut;
  double shoulders;  // m, height above the scalp's centre
  Coat coat;
  std::vector<double> ends = {};  // m, per sheet: height of the cut

  double backness(int sheet) const { return lines.backness(sheet); }
  double sideOf(int sheet) const { return 2 * sheet < coat.sheets ? 1.0 : -1.0; }
  bool inFront(int sheet) const { return coat.inFront(sheet); }

  // Whether two neighbouring sheets have gone separate ways at a row: one before, one behind the shoulder.
  bool parted(int sheet, int other, int row) const;
  double cutHeight(int sheet) const;
  double freeBelow(int sheet) const { return ends[sheet] - 0.01; }
  Vec3 aim(int sheet) const;
  Vec3 keepOff(int sheet, Vec3 p, double gap) const;
  double tautnessAt(int sheet, double height, double tautness) const;
  void sweepFront();
  bool fall(int sheet);
  void cutAboveShoulders();
  void fallAll();
  void hangTaut(std::vector<Vec3>& guide, int sheet, int first, int last, double tautness) const;
  void hangInner(int sheet);
  void hangOuter(int sheet);
  void relaxInner();
  void raiseOuter();
  double rowAtHeight(int sheet, double height) const;
  void measureWays();
  void measureCut();
};

bool Comber::parted(int sheet, int other, int row) const {
  if (inFront(sheet) == inFront(other)) return false;
  const double height = coat.inner[coat.index(sheet, row)].y() - scalp.center.y();
  return height < shoulders + 0.18 * scalp.head_height;
}

double Comber::cutHeight(int sheet) const {
  const double q = backness(sheet), unit = scalp.head_height;
  double height = 0;
  if (cut.divides && q < kDivide) {
    height = cut.front - 0.08 * smoothstep(0.0, kDivide, q);
  } else if (cut.divides) {
    height = cut.side + (cut.back - cut.side) * smoothstep(kDivide, 1.0, q);
  } else {
    height = q < 0.4 ? cut.front + (cut.side - cut.front) * smoothstep(0.0, 0.4, q)
                     : cut.side + (cut.back - cut.side) * smoothstep(0.4, 1.0, q);
  }
  if (cut.fringe) height = *cut.fringe + (height - *cut.fringe) * smoothstep(kFringe, kBesideFringe, q);
  return height * unit + (cut.from_shoulders ? shoulders : 0.0);
}

// Where a sheet passes the height of the shoulders: in front of them, or behind.
Vec3 Comber::aim(int sheet) const {
  const double q = backness(sheet), unit = scalp.head_height;
  Vec3 p(0, shoulders - 0.06 * unit, 0);
  if (inFront(sheet)) {
    p.x() = sideOf(sheet) * (0.28 + 0.26 * q / kDivide) * unit;
    p.z() = surfaceDepth(scalp, body, p, -1) + 2 * kInnerGap;
  } else {
    const double r = (q - kDivide) / (1 - kDivide);
    p.x() = sideOf(sheet) * 0.52 * unit * (1 - std::pow(r, 1.15));
    p.z() = surfaceDepth(scalp, body, p, 1) - 2 * kInnerGap;
  }
  return scalp.center + p;
}

// Moves a point out of the body until it keeps `gap`. Hair that divides over the shoulders is moved straight forwards
// or straight backwards below the jaw: sliding along a breast or a shoulder blade would gather it into a rope.
Vec3 Comber::keepOff(int sheet, Vec3 p, double gap) const {
  const double below_jaw = smoothstep(0.30, 0.55, (scalp.center.y() - p.y()) / scalp.head_height);
  const Vec3 straight(0, 0, inFront(sheet) ? 1 : -1);
  for (int i = 0; i < 8; ++i) {
    const double d = body(p);
    if (d >= gap) break;
    Vec3 n = bodyNormal(body, p);
    if (cut.divides) n = (n + 4 * below_jaw * straight).normalized();
    p += (gap - d) * n;
  }
  return p;
}

// Over the shoulders hair spans hollows, before them it lies on the chest.
double Comber::tautnessAt(int sheet, double height, double tautness) const {
  if (!inFront(sheet)) return tautness;
  const double below_jaw = smoothstep(0.30, 0.55, (scalp.center.y() - height) / scalp.head_height);
  return tautness + below_jaw * (std::min(tautness, kTautnessInFront) - tautness);
}

// Follows gravity from the hairline: stiff enough to turn gently, sliding over what is in the way. Hair that is to end
// at the shoulders does not slide down their slope; where it comes to lie on them its end is lifted, and false is
// returned.
bool Comber::fall(int sheet) {
  const int last_skin = coat.scalp_rows - 1;
  Vec3 p = coat.inner[coat.index(sheet, last_skin)];
  Vec3 heading = (p - coat.inner[coat.index(sheet, last_skin - 2)]).normalized();
  const double lowest = freeBelow(sheet);
  const Vec3 goal = cut.divides ? aim(sheet) : Vec3(Vec3::Zero());
  for (int row = coat.scalp_rows; row < coat.rows; ++row) {
    Vec3 wish(0, -1, 0);
    const double above = p.y() - goal.y();
    if (cut.divides && above > 0.01) {
      Vec3 slope = (goal - p) / above;
      slope.y() = 0;
      wish += slope * std::min(1.0, 1.2 / std::max(slope.norm(), 1e-9));
    }
    heading = (cut.inertia * heading + (1 - cut.inertia) * wish.normalized()).normalized();
    p += kRowStep * heading;
    const double gap = kInnerGap * smoothstep(0, 5, row - last_skin);
    // What is below the cut hangs free: shoulders that the hair never reaches must not bend its ends outwards.
    if (p.y() > lowest && body(p) < gap) {
      const Vec3 n = bodyNormal(body, p);
      if (cut.from_shoulders && !cut.divides && n.y() > 0.62 && std::abs(n.x()) > 0.9 * std::abs(n.z()) &&
          p.y() > ends[sheet] && row > coat.scalp_rows + 6) {
        ends[sheet] = p.y() + 0.01;
        return false;
      }
      p = keepOff(sheet, p, gap);
      heading = (heading - std::min(0.0, heading.dot(n)) * n).normalized();
    }
    if (cut.hug > 0 && p.y() > lowest) {
      const double far = body(p) - gap;
      if (far > 0 && far < kHugged) p -= cut.hug * far * bodyNormal(body, p);
    }
    coat.inner[coat.index(sheet, row)] = p;
  }
  return true;
}

// The front hair leaves its flow line for the forehead and the temple, the foremost by most, and frames the face.
void Comber::sweepFront() {
  coat.swept.assign(coat.inner.size(), Vec3::Zero());
  for (int s = 0; s < coat.sheets; ++s) {
    const double share = 1 - smoothstep(0.0, kSweptBehind, backness(s));
    const int foremost = 2 * s < coat.sheets ? 0 : coat.sheets - 1, inward = foremost == 0 ? 4 : coat.sheets - 5;
    for (int r = 0; r < coat.rows && share > 0; ++r) {
      const int row = std::min(r, coat.scalp_rows - 1);
      const Vec3& root = lines.at(s, row);
      const double far = cut.sweep * share * smoothstep(0.0, 0.6, row / (coat.scalp_rows - 1.0));
      const Vec3 forward = (lines.at(foremost, row) - lines.at(inward, row)).normalized();
      coat.swept[coat.index(s, r)] = skinPoint(scalp, root + far * forward - scalp.center) - root;
    }
  }
}

// Lifts the cut of the sheets beside those that lie on the shoulders, so that it stays one smooth line.
void Comber::cutAboveShoulders() {
  constexpr double kSteepest = 0.002;  // m from one sheet to the next
  for (int s = 1; s < coat.sheets; ++s) ends[s] = std::max(ends[s], ends[s - 1] - kSteepest);
  for (int s = coat.sheets - 2; s >= 0; --s) ends[s] = std::max(ends[s], ends[s + 1] - kSteepest);
  for (int sweep = 0; sweep < 30; ++sweep)
    for (int s = 1; s + 1 < coat.sheets; ++s) ends[s] = std::max(ends[s], 0.5 * (ends[s - 1] + ends[s + 1]));
}

void Comber::fallAll() {
  double lowest = 1e9;
  for (int s = 0; s < coat.sheets; ++s) {
    lowest = std::min(lowest, cutHeight(s));
    ends.push_back(scalp.center.y() + cutHeight(s));
  }
  const int below = static_cast<int>(1.25 * (0.35 * scalp.head_height - lowest) / kRowStep) + 8;
  coat.rows = coat.scalp_rows + below;
  coat.inner.resize(static_cast<std::size_t>(coat.sheets) * coat.rows);
  sweepFront();
  for (int s = 0; s < coat.sheets; ++s) {
    for (int r = 0; r < coat.scalp_rows; ++r)
      coat.inner[coat.index(s, r)] = lines.at(s, r) + coat.swept[coat.index(s, r)];
    while (!fall(s)) continue;
  }
  if (!cut.divides && cut.from_shoulders) cutAboveShoulders();
  for (int s = 0; s < coat.sheets; ++s) {
    fall(s);
    hangInner(s);
  }
}

// Hair under its own weight spans hollows (the nape above the shoulders, the small of the back) instead of lining them:
// over rows `first` to `last` of a guide, the distance from the head's vertical axis nears the least concave curve over
// it.
void Comber::hangTaut(std::vector<Vec3>& guide, int sheet, int first, int last, double tautness) const {
  const Vec3 axis = scalp.center - Vec3(0, 0, 0.06 * scalp.head_height);
  const auto outwards = [&](int r) {
    const Vec3& p = guide[coat.index(sheet, r)];
    return Vec3(p.x() - axis.x(), 0, p.z() - axis.z());
  };
  struct Knot {
    double height, radius;
  };
  std::vector<Knot> hull;
  for (int r = first; r <= last; ++r) {
    const Knot c{guide[coat.index(sheet, r)].y(), outwards(r).norm()};
    const auto below = [&](const Knot& a, const Knot& b) {
      return (b.radius - a.radius) * (a.height - c.height) <= (c.radius - a.radius) * (a.height - b.height);
    };
    while (hull.size() >= 2 && below(hull[hull.size() - 2], hull.back())) hull.pop_back();
    hull.push_back(c);
  }
  std::size_t k = 1;
  for (int r = first + 1; r <= last; ++r) {
    Vec3& p = guide[coat.index(sheet, r)];
    while (k + 1 < hull.size() && hull[k].height > p.y()) ++k;
    const Knot &a = hull[k - 1], &b = hull[k];
    const double t = std::clamp((a.height - p.y()) / std::max(a.height - b.height, 1e-9), 0.0, 1.0);
    const Vec3 out = outwards(r);
    const double lacking = a.radius + t * (b.radius - a.radius) - out.norm();
    if (lacking > 0) p += out.normalized() * tautnessAt(sheet, p.y(), tautness) * lacking;
  }
}

// The inner guide, from the hairline to the cut; what is below the cut goes on straight.
void Comber::hangInner(int sheet) {
  const int first = coat.scalp_rows - 1;
  int last = first + 2;
  while (last + 1 < coat.rows && coat.inner[coat.index(sheet, last)].y() > freeBelow(sheet)) ++last;
  hangTaut(coat.inner, sheet, first, last, cut.inner_tautness);
  for (int r = last + 1; r < coat.rows; ++r) {
    const Vec3& above = coat.inner[coat.index(sheet, r - 1)];
    const Vec3 heading = (above - coat.inner[coat.index(sheet, r - 2)]).normalized();
    coat.inner[coat.index(sheet, r)] = above + heading * kRowStep;
  }
}

// The outer guide hangs from where the head is widest.
void Comber::hangOuter(int sheet) {
  const Vec3 axis = scalp.center - Vec3(0, 0, 0.06 * scalp.head_height);
  int widest = 0;
  double widest_radius = 0;
  for (int r = 0; r < coat.scalp_rows + 8; ++r) {
    const Vec3 p = coat.outer[coat.index(sheet, r)] - axis;
    const double radius = std::hypot(p.x(), p.z());
    if (radius > widest_radius) widest = r, widest_radius = radius;
  }
  hangTaut(coat.outer, sheet, widest, coat.rows - 1, cut.tautness);
  // Rounds the bend where the hair leaves the head.
  for (int sweep = 0; sweep < 12; ++sweep) {
    for (int r = std::max(1, widest - 6); r + 1 < coat.rows; ++r) {
      Vec3& p = coat.outer[coat.index(sheet, r)];
      p = 0.5 * p + 0.25 * (coat.outer[coat.index(sheet, r - 1)] + coat.outer[coat.index(sheet, r + 1)]);
    }
  }
}

// Smooths the part below the hairline along and across the sheets, and puts it back off the body. Two opposite
// strengths in turn (Taubin 1995) smooth without pulling the curtain in around the neck.
void Comber::relaxInner() {
  std::vector<Vec3> next = coat.inner;
  const int first = coat.scalp_rows;
  for (int sweep = 0; sweep < 60; ++sweep) {
    const double strength = sweep % 2 == 0 ? 0.5 : -0.47;
    for (int s = 0; s < coat.sheets; ++s) {
      for (int r = first; r < coat.rows; ++r) {
        const Vec3& p = coat.inner[coat.index(s, r)];
        Vec3 sum = Vec3::Zero();
        double weight = 0;
        if (r + 1 < coat.rows) {
          sum += coat.inner[coat.index(s, r - 1)] + coat.inner[coat.index(s, r + 1)];
          weight += 2;
        }
        if (s > 0 && s + 1 < coat.sheets && !parted(s, s - 1, r) && !parted(s, s + 1, r)) {
          sum += coat.inner[coat.index(s - 1, r)] + coat.inner[coat.index(s + 1, r)];
          weight += 2;
        }
        next[coat.index(s, r)] = weight > 0 ? Vec3(p + strength * (sum / weight - p)) : p;
      }
    }
    if (sweep % 6 == 5) {
      for (int s = 0; s < coat.sheets; ++s)
        for (int r = first; r < coat.rows; ++r) {
          Vec3& p = next[coat.index(s, r)];
          if (p.y() > freeBelow(s)) p = keepOff(s, p, kInnerGap * smoothstep(0, 5, r - first + 1));
        }
    }
    std::swap(coat.inner, next);
  }
}

void Comber::raiseOuter() {
  std::vector<Vec3> normal(coat.inner.size());
  for (int s = 0; s < coat.sheets; ++s) {
    for (int r = 0; r < coat.rows; ++r) {
      int before = std::max(s - 1, 0), after = std::min(s + 1, coat.sheets - 1);
      if (parted(s, before, r)) before = s;
      if (parted(s, after, r)) after = s;
      const Vec3 across = coat.inner[coat.index(after, r)] - coat.inner[coat.index(before, r)];
      const Vec3 down =
          coat.inner[coat.index(s, std::min(r + 1, coat.rows - 1))] - coat.inner[coat.index(s, std::max(r - 1, 0))];
      normal[coat.index(s, r)] = down.cross(across).normalized();
    }
  }
  coat.outer = normal;
  for (int sweep = 0; sweep < 40; ++sweep) {
    for (int s = 0; s < coat.sheets; ++s) {
      for (int r = 0; r < coat.rows; ++r) {
        Vec3 sum = 2 * normal[coat.index(s, r)];
        for (const int other : {s - 1, s + 1}) {
          if (other >= 0 && other < coat.sheets && !parted(s, other, r)) sum += normal[coat.index(other, r)];
        }
        if (r > 0) sum += normal[coat.index(s, r - 1)];
        if (r + 1 < coat.rows) sum += normal[coat.index(s, r + 1)];
        coat.outer[coat.index(s, r)] = sum.normalized();
      }
    }
    std::swap(normal, coat.outer);
  }
  for (int s = 0; s < coat.sheets; ++s) {
    for (int r = 0; r < coat.rows; ++r) {
      const double height = coat.rise[s].height(1, coat.travelled[coat.index(s, r)]);
      coat.outer[coat.index(s, r)] = coat.inner[coat.index(s, r)] + height * normal[coat.index(s, r)];
    }
    hangOuter(s);
  }
  coat.up = normal;
  for (std::size_t i = 0; i < coat.up.size(); ++i) {
    const Vec3 off = coat.outer[i] - coat.inner[i];
    if (off.norm() > 0.002) coat.up[i] = off.normalized();
  }
}

// The row at which a sheet's inner guide first falls to a height, below the hairline; the last row if it does not.
double Comber::rowAtHeight(int sheet, double height) const {
  for (int r = coat.scalp_rows + 2; r < coat.rows; ++r) {
    const double above = coat.inner[coat.index(sheet, r - 1)].y(), here = coat.inner[coat.index(sheet, r)].y();
    if (here <= height) return r - 1 + std::clamp((above - height) / std::max(above - here, 1e-9), 0.0, 1.0);
  }
  return coat.rows - 1.0;
}

void Comber::measureWays() {
  coat.travelled.assign(coat.inner.size(), 0.0);
  for (int s = 0; s < coat.sheets; ++s) {
    for (int r = 1; r < coat.rows; ++r) {
      const double way = (coat.inner[coat.index(s, r)] - coat.inner[coat.index(s, r - 1)]).norm();
      coat.travelled[coat.index(s, r)] = coat.travelled[coat.index(s, r - 1)] + way;
    }
    const double q = backness(s), crown = smoothstep(0.6, 1.0, q);
    Rise rise;
    rise.lift = kLift + (kLiftAtCrown - kLift) * crown;
    rise.reach = kLiftReach + (kLiftReachAtCrown - kLiftReach) * crown;
    rise.hairline = coat.travelled[coat.index(s, coat.scalp_rows - 1)];
    const double thickness = cut.thickness * (kThinnestInFront + (1 - kThinnestInFront) * smoothstep(0.0, 0.4, q));
    rise.slope = std::max(0.0, thickness - rise.lift) / rise.hairline;
    coat.rise.push_back(rise);
    // A thin coat's layers lie no flatter along the hair than those of a thick one.
    coat.slant.push_back(cut.slant * thickness / cut.thickness);
  }
}

void Comber::measureCut() {
  for (int s = 0; s < coat.sheets; ++s) coat.cut_row.push_back(rowAtHeight(s, ends[s]));
}

// Hair divides between two flow lines. The front one is moved next to the back one, so that no bare scalp shows
// between.
FlowLines dividedLines(const Scalp& scalp, FlowLines lines, int front_sheets) {
  for (const int side : {0, 1}) {
    const auto at = [&](int sheet) { return side ? lines.sheets - 1 - sheet : sheet; };
    for (int r = 0; r < lines.rows; ++r) {
      Vec3& front = lines.points[static_cast<std::size_t>(at(front_sheets - 1)) * lines.rows + r];
      const Vec3& back = lines.at(at(front_sheets), r);
      front = skinPoint(scalp, front + kCloseBeside * (back - front) - scalp.center);
    }
  }
  return lines;
}

}  // namespace

Vec3 bodyNormal(const BodyDistance& body, const Vec3& p) {
  constexpr double kStep = 0.002;  // m: wide enough to look over the cells of a sampled distance
  const Vec3 gradient(body(p + Vec3(kStep, 0, 0)) - body(p - Vec3(kStep, 0, 0)),
                      body(p + Vec3(0, kStep, 0)) - body(p - Vec3(0, kStep, 0)),
                      body(p + Vec3(0, 0, kStep)) - body(p - Vec3(0, 0, kStep)));
  const double size = gradient.norm();
  return size > 1e-12 ? Vec3(gradient / size) : Vec3::UnitY();
}

Coat combCoat(Style style, const Scalp& scalp, const BodyDistance& body, const FlowLines& lines) {
  const Cut& cut = kCuts[static_cast<std::size_t>(style)];
  const int front = cut.divides ? static_cast<int>(std::lround(kDivide * (lines.sheets / 2))) : 0;
  const FlowLines combed = cut.divides ? dividedLines(scalp, lines, front) : lines;
  Comber comber{style, scalp, body, combed, cut, shoulderHeight(scalp, body), {}};
  comber.coat.sheets = lines.sheets;
  comber.coat.scalp_rows = lines.rows;
  comber.coat.front_sheets = front;
  comber.coat.fringe = hasFringe(style);
  comber.fallAll();
  comber.relaxInner();
  comber.measureWays();
  comber.raiseOuter();
  comber.measureCut();
  return comber.coat;
}

}  // namespace app

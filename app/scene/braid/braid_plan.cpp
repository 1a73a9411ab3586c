#include "app/scene/braid/braid_plan.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>

#include "app/motion/least_rotation.h"
#include "app/scene/braid/braid_draw.h"
#include "app/scene/braid/braid_steps.h"
#include "app/scene/braid/bun.h"

namespace app {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kMaxFiner = 8;
constexpr double kBunPlait = 0.4;  // radius of the tie that a bun's plait is laid for, over that of its own
constexpr double kFlat = 1e-4;     // m: a strand's section that is thinner is none

// The simulated hair as a plan reads it.
struct Hair {
  std::span<const render::HairFace> faces;
  std::span<const int> column_first;
  std::span<const float> rest;

  Vector3d at(int vertex) const {
    return Eigen::Map<const Eigen::Vector3f>(&rest[3 * static_cast<std::size_t>(vertex)]).cast<double>();
  }
  std::size_t columnOf(int vertex) const {
    return static_cast<std::size_t>(std::ranges::upper_bound(column_first, vertex) - column_first.begin()) - 1;
  }
  int layers(std::size_t column) const { return column_first[column + 1] - column_first[column]; }
};

// Which strand of which braid a face's hair is in.
struct FaceStrand {
  int braid = -1, strand = 0;
};

int corners(const render::HairFace& face) {
  return face.first_vertex[3] < 0 ? 3 : 4;
}

// Where each column of a tail lies in its ring, from the ring's middle: across and outwards. By first vertex.
using RingPlaces = std::map<int, Vector2d>;

RingPlaces ringPlacesOf(const Hair& hair, const BraidTie& tie, const Braid& braid) {
  Vector3d middle = Vector3d::Zero();
  for (const int v : tie.ring) middle += hair.at(v) / static_cast<double>(tie.ring.size());
  const Vector3d up = braid.axis.cross(braid.across);
  RingPlaces places;
  for (const int v : tie.ring) {
    const Vector3d off = hair.at(v) - middle;
    places[hair.column_first[hair.columnOf(v)]] = {(braid.mirrored ? -1 : 1) * braid.across.dot(off), up.dot(off)};
  }
  return places;
}

void layTail(const Hair& hair, const BraidTie& tie, Braid& braid) {
  std::map<int, BraidLayers> by_layers;
  double length = 0;
  for (const int v : tie.ring) {
    const std::size_t c = hair.columnOf(v);
    braid.ring_layer = v - hair.column_first[c];
    BraidLayers& equal = by_layers[hair.layers(c)];
    equal.layers = hair.layers(c);
    equal.first_vertex.push_back(hair.column_first[c]);
    for (int l = v; l + 1 < hair.column_first[c + 1]; ++l)
      length += (hair.at(l + 1) - hair.at(l)).norm() / static_cast<double>(tie.ring.size());
  }
  for (auto& [layers, equal] : by_layers) braid.tail.push_back(std::move(equal));
  braid.length = tie.wound > 0 ? tie.wound : length;
  braid.axis = tie.axis;
  // What hangs straight down turns its faces to the front and to the back of the head.
  const auto hanging = leastRotation(tie.axis, -Vector3d::UnitY());
  braid.across = hanging.inverse() * -Vector3d::UnitX();
  braid.mirrored = tie.mirrored;
}

// Weights by which the roots and the ring tell the turn of the head, which they move as one with. What is in the ring
// is narrower than at rest: a bun hangs on what is held beyond it.
void anchor(const Hair& hair, const BraidTie& tie, Braid& braid) {
  std::vector<int> held;
  for (const int v : tie.ring) {
    const std::size_t c = hair.columnOf(v);
    held.push_back(hair.column_first[c]);
    held.push_back(tie.wound > 0 ? hair.column_first[c + 1] - 1 : v);
  }
  Vector3d& middle = braid.held;
  for (const int v : held) middle += hair.at(v) / static_cast<double>(held.size());
  Matrix3d spread = 1e-12 * Matrix3d::Identity();
  for (const int v : held) spread += (hair.at(v) - middle) * (hair.at(v) - middle).transpose();
  const Matrix3d inverse = spread.inverse();
  for (const int v : held) braid.anchors.push_back({v, inverse * (hair.at(v) - middle)});
}

// Deals the faces of a tail out by their angle about its middle, so that the strands hold equal hair. Strand j begins
// the plait at 300, 60 and 180 degrees, see braid_steps.cpp. Returns false where a strand goes empty.
bool dealFaces(const Hair& hair, const RingPlaces& places, int number, Braid& braid, std::vector<FaceStrand>& of) {
  std::vector<std::pair<double, std::size_t>> around;
  double all = 0;
  for (std::size_t f = 0; f < hair.faces.size(); ++f) {
    const render::HairFace& face = hair.faces[f];
    Vector2d middle = Vector2d::Zero();
    bool taken = of[f].braid < 0;
    for (int k = 0; k < corners(face) && taken; ++k) {
      const auto place = places.find(face.first_vertex[static_cast<std::size_t>(k)]);
      taken = place != places.end();
      if (taken) middle += place->second;
    }
    if (!taken) continue;
    const double angle = std::atan2(middle.y(), middle.x());
    around.emplace_back(angle < 0 ? angle + 2 * std::numbers::pi : angle, f);
    all += static_cast<double>(face.area);
  }
  std::ranges::sort(around);
  constexpr std::array<int, kBraidStrands> kStrandOfThird{1, 2, 0};
  double passed = 0;
  for (const auto& [angle, f] : around) {
    const double area = static_cast<double>(hair.faces[f].area);
    const int third = all > 0 ? std::min(static_cast<int>(kBraidStrands * (passed + 0.5 * area) / all), 2) : 0;
    of[f] = {number, kStrandOfThird[static_cast<std::size_t>(third)]};
    braid.hair[static_cast<std::size_t>(of[f].strand)] += area / all;
    passed += area;
  }
  if (std::ranges::all_of(braid.hair, [](double share) { return share > 0; })) return true;
  for (FaceStrand& face : of)
    if (face.braid == number) face = {};
  return false;
}

double crossed(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

std::vector<Vector2d> hullOf(std::vector<Vector2d> points) {
  std::ranges::sort(
      points, [](const Vector2d& a, const Vector2d& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  std::vector<Vector2d> hull;
  const auto chain = [&](const auto& some) {
    const std::size_t start = hull.size();
    for (const Vector2d& p : some) {
      while (hull.size() >= start + 2 && crossed(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
  };
  chain(points);
  std::ranges::reverse(points);
  chain(points);
  return hull;
}

// A strand takes a sector of the ring; its outline, as seen from its middle, becomes the rim of the strand's section.
void placeInSection(const std::vector<Vector2d>& sector, const std::vector<DrawnColumn*>& columns) {
  const std::vector<Vector2d> hull = hullOf(sector);
  Vector2d middle = Vector2d::Zero();
  for (const Vector2d& p : hull) middle += p / static_cast<double>(hull.size());
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const Vector2d off = sector[c] - middle;
    double reach = kFlat;
    for (std::size_t k = 0; k < hull.size(); ++k) {
      const Vector2d a = hull[k] - middle, side = hull[(k + 1) % hull.size()] - hull[k];
      const double across = crossed(off, side), along = crossed(a, side);
      if (across <= 0 || along <= 0) continue;
      const double times = along / across;  // of `off`, to the side's line
      const double on_side = crossed(a, off) / across;
      if (on_side >= -1e-9 && on_side <= 1 + 1e-9) reach = std::max(reach, times * off.norm());
    }
    columns[c]->place = (off / std::max(reach, off.norm())).cast<float>();
  }
}

struct Planned {
  BraidPlan plan;
  std::vector<FaceStrand> of;  // faces
};

int drawnLayers(const BraidPlan& plan, const FaceStrand& of, int layers) {
  if (of.braid < 0) return (layers - 1) * plan.finer + 1;
  const Braid& braid = plan.braids[static_cast<std::size_t>(of.braid)];
  return braid.ring_layer * plan.finer + static_cast<int>(braid.steps.size());
}

// Columns where strands meet, and beside the tail, are drawn once for each.
void drawColumns(const Hair& hair, std::span<const render::LookShare> shares, Planned& planned) {
  BraidPlan& plan = planned.plan;
  std::map<std::array<int, 3>, int> drawn;
  int vertices = 0;
  for (std::size_t f = 0; f < hair.faces.size(); ++f) {
    const FaceStrand of = planned.of[f];
    render::HairFace face = hair.faces[f];
    face.layers = drawnLayers(plan, of, face.layers);
    for (int k = 0; k < corners(face); ++k) {
      int& first = face.first_vertex[static_cast<std::size_t>(k)];
      const auto [entry, fresh] = drawn.try_emplace({first, of.braid, of.strand}, vertices);
      if (fresh) {
        const int layers = hair.layers(hair.columnOf(first));
        plan.columns.push_back({first, layers, vertices, of.braid, of.strand, Eigen::Vector2f::Zero()});
        vertices += drawnLayers(plan, of, layers);
        if (!shares.empty())
          plan.root_shares.resize(static_cast<std::size_t>(vertices), shares[static_cast<std::size_t>(first)]);
      }
      first = entry->second;
    }
    plan.faces.push_back(face);
  }
}

// As fine beside the ring as the plait begins.
int finerLayers(const Hair& hair, const std::vector<Braid>& braids) {
  double most = 1;
  for (const Braid& braid : braids) {
    double length = 0;
    int count = 0;
    for (const BraidLayers& equal : braid.tail)
      for (const int first : equal.first_vertex)
        for (int l = 0; l < braid.ring_layer; ++l, ++count)
          length += (hair.at(first + l + 1) - hair.at(first + l)).norm();
    const double step = static_cast<double>(braid.steps[1].share) * braid.length;
    most = std::max(most, length / count / step);
  }
  return std::min(static_cast<int>(std::lround(most)), kMaxFiner);
}

std::string shortNote(const std::string& name, const Braid& braid, double radius) {
  char text[160];
  std::snprintf(text, sizeof text, "%s: %.0f cm of hair below the ring are too short for a plait (%.0f cm): a tail",
                name.c_str(), 100 * braid.length, 100 * shortestBraid(radius));
  return text;
}

}  // namespace

BraidPlan planBraids(std::span<const render::HairFace> faces, std::span<const int> column_first,
                     std::span<const float> rest, std::span<const render::LookShare> shares,
                     std::span<const BraidTie> ties, std::span<const std::string> names) {
  const Hair hair{faces, column_first, rest};
  Planned planned;
  planned.of.resize(faces.size());
  BraidPlan& plan = planned.plan;
  std::vector<RingPlaces> rings;
  const auto note = [&](const std::string& text) { plan.note += (plan.note.empty() ? "" : "\n") + text; };
  for (std::size_t t = 0; t < ties.size(); ++t) {
    BraidTie tie = ties[t];
    Braid braid;
    if (tie.ring.empty()) continue;
    layTail(hair, tie, braid);
    RingPlaces places = ringPlacesOf(hair, tie, braid);
    bool laid = tie.braided && layBraid(tie.wound > 0 ? kBunPlait * tie.radius : tie.radius, braid);
    if (!laid && tie.wound > 0) tie.braided = false, laid = layRope(tie.radius, braid);
    if (laid && tie.wound > 0) layBun(tie, braid);
    if (!laid) {
      note(shortNote(names[t], braid, tie.radius));
    } else if (!dealFaces(hair, places, static_cast<int>(plan.braids.size()), braid, planned.of)) {
      note(names[t] + ": three strands need three bundles of hair at least: a tail");
    } else {
      anchor(hair, tie, braid);
      plan.braids.push_back(std::move(braid));
      rings.push_back(std::move(places));
    }
  }
  if (plan.braids.empty()) return std::move(plan);
  plan.finer = finerLayers(hair, plan.braids);
  drawColumns(hair, shares, planned);
  for (std::size_t b = 0; b < plan.braids.size(); ++b) {
    for (int strand = 0; strand < kBraidStrands; ++strand) {
      std::vector<Vector2d> sector;
      std::vector<DrawnColumn*> columns;
      for (DrawnColumn& column : plan.columns) {
        if (column.braid != static_cast<int>(b) || column.strand != strand) continue;
        sector.push_back(rings[b].at(column.first_vertex));
        columns.push_back(&column);
      }
      placeInSection(sector, columns);
    }
  }
  drawBraids(plan, rest, plan.rest);
  return std::move(plan);
}

int braidSegments(const BraidPlan& plan, int asked) {
  return plan.empty() ? asked : std::max(1, (asked + plan.finer - 1) / plan.finer);
}

}  // namespace app

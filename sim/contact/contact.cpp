#include "sim/contact/contact.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>

#include "sim/contact/passage.h"

namespace sim {
namespace {

constexpr int kProjections = 6;      // alternating projections between overlapping colliders
constexpr int kBriefly = 2;          // of them, beyond ContactSearch::max_points
constexpr double kSlackShare = 0.2;  // of the contact offset
constexpr double kReach = 0.01;  // m off the surface at which a contact is dropped; less may be a slide over an edge
constexpr double kCreep = 1e-3, kNoSlip = 1e-9;  // m/s
constexpr double kLeaving = 1;                   // m/s away from the body at which a contact is dropped
constexpr double kMet = 1e-5;                    // m, on a path past a collider
constexpr int kMaxClustered = 16;                // vertices of a cluster
constexpr double kRounding = 1e-6;               // m, above the rounding of the tests that the bounds stand for
constexpr double kNeighbour = 0.005;             // m; bodies so near to a vertex count as around it
constexpr double kStride = 1e-5;                 // m, from one body to the next
constexpr int kMaxLeaves = 32;

// Bounds of all the vertices that are searched, and of each cluster of them.
SweptBox boundPaths(const ContactSearch& search, std::span<const Vec3> positions, ContactScratch& scratch) {
  const Vec3 far = Vec3::Constant(INFINITY);
  const SweptBox none{0, {far, far}, {-far, -far}};
  const std::span<const Vec3> start = search.start.empty() ? positions : search.start;
  const auto add = [&](int v, SweptBox& box) {
    ++box.vertices;
    box.low[0] = box.low[0].cwiseMin(start[v]), box.high[0] = box.high[0].cwiseMax(start[v]);
    box.low[1] = box.low[1].cwiseMin(positions[v]), box.high[1] = box.high[1].cwiseMax(positions[v]);
  };
  SweptBox whole = none;
  if (scratch.cluster_of.empty()) {
    for (const int v : search.vertices) add(v, whole);
    return whole;
  }
  std::fill(scratch.boxes.begin(), scratch.boxes.end(), none);
  for (const int v : search.vertices) add(v, scratch.boxes[scratch.cluster_of[v]]);
  for (const SweptBox& box : scratch.boxes) {
    whole.vertices += box.vertices;
    for (const int end : {0, 1}) {
      whole.low[end] = whole.low[end].cwiseMin(box.low[end]);
      whole.high[end] = whole.high[end].cwiseMax(box.high[end]);
    }
  }
  return whole;
}

// Colliders whose surroundings, over the whole step, overlap the box of the vertices' paths.
void collectNear(const ContactSearch& search, const SweptBox& whole, std::vector<NearCollider>& near) {
  near.clear();
  near.reserve(search.colliders.count());
  const Vec3 low = whole.low[0].cwiseMin(whole.low[1]), high = whole.high[0].cwiseMax(whole.high[1]);
  for (int k = 0; k < search.colliders.count(); ++k) {
    const Ellipsoid& e = search.colliders.body(k);
    const double reach = e.radii.maxCoeff() + search.margins.offset;
    const Vec3 before = e.center - search.dt * e.velocity;
    const Vec3 least = e.center.cwiseMin(before).array() - reach, most = e.center.cwiseMax(before).array() + reach;
    if (!((least.array() < high.array()).all() && (most.array() > low.array()).all())) continue;
    near.emplace_back(k, e, search.colliders.thickness(k), search.margins.offset, search.dt);
  }
}

// Where some vertices are at the step's end, and how far off that they have been within it: by their motion, that of
// the whole hair (`shift`, m) left out.
struct SweptBall {
  Vec3 center;
  double swept;  // m

  SweptBall(const SweptBox& box, const Vec3& shift) : center(0.5 * (box.low[1] + box.high[1])) {
    const Vec3 way = center - 0.5 * (box.low[0] + box.high[0]) - shift;
    const double radius = 0.5 * std::max((box.high[0] - box.low[0]).norm(), (box.high[1] - box.low[1]).norm());
    swept = radius + way.norm();
  }
  SweptBall(const Vec3& start, const Vec3& end, const Vec3& shift) : center(end), swept((end - start - shift).norm()) {}
};

bool outOfReach(const SweptBall& ball, const NearCollider& near) {
  const double far = near.margin + ball.swept;
  return (ball.center - near.after).squaredNorm() > far * far;
}

// What of `near` each cluster can reach.
void collectReached(const ContactSearch& search, const Vec3& shift, ContactScratch& scratch) {
  std::size_t end = 0;
  const std::size_t count = scratch.near.size(), all = search.colliders.count(), clusters = scratch.boxes.size();
  scratch.tests.of += static_cast<long>(search.vertices.size() * all);
  scratch.tests.skipped += static_cast<long>(search.vertices.size() * (all - count));
  if (scratch.reached.size() < all * clusters) scratch.reached.resize(all * clusters);  // once, whatever comes near
  if (count == 0) return;
  for (std::size_t c = 0; c < clusters; ++c) {
    const SweptBox& box = scratch.boxes[c];
    const std::size_t first = end;
    if (box.vertices > 0) {
      const SweptBall ball(box, shift);
      for (std::size_t n = 0; n < count; ++n) {
        scratch.reached[end] = static_cast<int>(n);
        end += !outOfReach(ball, scratch.near[n]);
      }
    }
    scratch.reached_end[c] = static_cast<int>(end);
    scratch.tests.skipped += box.vertices * static_cast<long>(count - (end - first));
  }
}

// Continuous test. A vertex that went through the collider, or so deep that the nearest way out lies on the far side,
// is put back where it came from: to its point of entry, moved on by the tangential part of the rest of its way.
void sweep(const ContactSearch& search, const NearCollider& near, const Vec3& start, const Vec3& end,
           Penetration& touch) {
  const double offset = search.margins.offset;
  const Vec3 from = start - near.before, way = end - near.after - from;
  const double nearest = way.isZero(0) ? 0 : std::clamp(-from.dot(way) / way.squaredNorm(), 0.0, 1.0);
  if ((from + nearest * way).squaredNorm() >= near.reach * near.reach) return;
  // How far it goes in the collider's frame: its motion there, and the height of the arc that a turn makes of a line.
  const double strays = (from + way - near.turn * from).norm() + from.norm() * near.turned * near.turned / 8;
  if (strays < 0.5 * near.thin) return;
  const std::optional<Vec3> entry = entryOf(search.colliders, near, offset, start, end);
  if (!entry) return;
  const Ellipsoid& body = search.colliders.body(near.index);
  const Vec3 met = body.center + body.rotation * *entry;
  const Vec3 normal = search.colliders.sdf(near.index)
                          ? search.colliders.closest(near.index, met).normal
                          : Vec3(body.rotation * entry->cwiseProduct(near.outer.cwiseAbs2()).normalized());
  if (touch.depth > 0 && touch.normal.dot(normal) >= 0) return;  // the nearest way out is on that side
  const Vec3 rest = end - met;
  const SurfacePoint slid = search.colliders.closest(near.index, met + rest - rest.dot(normal) * normal);
  touch.target = slid.point + offset * slid.normal;
  touch.normal = slid.normal;
  touch.depth = std::max(touch.depth, (end - touch.target).norm());
}

// The contact of a vertex at p with one collider; a depth of at most zero: none.
Penetration touchOf(const ContactSearch& search, const NearCollider& near, int vertex, const Vec3& p, bool swept) {
  Penetration touch{vertex, near.index, Vec3::Zero(), Vec3::UnitY(), 0, false, 0};
  const int k = near.index;
  const double offset = search.margins.offset;
  if (near.mayTouch(p)) {
    const SurfacePoint s = search.colliders.closest(k, p);
    touch.depth = offset - s.distance;
    touch.normal = s.normal;
    touch.target = s.point + offset * s.normal;
    const Vec3 carried = search.start.empty() ? p : near.carried(search.start[vertex]);
    if (touch.depth > 0 && !search.start.empty() && near.mayTouch(carried)) {
      const double before = offset - search.colliders.closest(k, carried).distance;
      if (before > search.margins.slack + kMet) {
        // An initial overlap: resolved by no more than the escape, and no deeper than it was.
        touch.initial_overlap = true;
        touch.left = std::max(0.0, before - search.margins.escape);
        const double level = offset - touch.left;
        touch.target = s.point + level * s.normal;
        touch.depth = level - s.distance;
        return touch;
      }
    }
  }
  if (swept && !search.start.empty()) sweep(search, near, search.start[vertex], p, touch);
  return touch;
}

}  // namespace

ContactMargins contactMargins(const SimParams& params, double dt) {
  return {params.contact_offset, kSlackShare * params.contact_offset, params.max_depenetration * dt};
}

void carryContacts(const Colliders& colliders, const SimParams& params, double dt, HairState& state) {
  const ContactMargins margins = contactMargins(params, dt);
  std::erase_if(state.contacts, [&](Contact& contact) {
    if (!params.collide || contact.collider < 0 || contact.collider >= colliders.count()) return true;
    const Vec3& x = state.positions[contact.vertex];
    const Vec3 carried = carriedAlong(colliders.body(contact.collider), x, dt);
    const SurfacePoint surface = colliders.closest(contact.collider, carried);
    const double depth = margins.offset - surface.distance;
    // Above the offset the vertex may be sliding over a rounded body: the solve brings it back unless it has to pull.
    const double back = std::clamp(depth, -margins.escape, 0.0);
    contact.normal = surface.normal;
    contact.velocity = (carried - x + back * surface.normal) / dt;
    // The solve lets go of a vertex that a body leaves behind only to its tolerance of the body's speed.
    const double leaving = surface.normal.dot(state.velocities[contact.vertex] - (carried - x) / dt);
    return -depth > kReach || leaving > kLeaving;
  });
}

namespace {

// The share of `direction` (m, world) after which a line from p, inside or outside, has left the ellipsoid that holds
// all points nearer to the collider than the offset; 0 where it does not meet it.
double leavesAt(const NearCollider& near, const Vec3& p, const Vec3& direction) {
  const Vec3 from = near.local(p - near.after).cwiseProduct(near.around);
  const Vec3 along = near.local(direction).cwiseProduct(near.around);
  const double a = along.squaredNorm(), b = from.dot(along), c = from.squaredNorm() - 1;
  const double discriminant = b * b - a * c;
  return discriminant <= 0 ? 0 : std::max(0.0, (std::sqrt(discriminant) - b) / a);
}

// m along `direction` (unit) after which p has left the collider, or nearly so of signed distances; 0 outside.
double wayOut(const ContactSearch& search, const NearCollider& near, const Vec3& p, const Vec3& direction) {
  if (!near.mayTouch(p)) return 0;
  if (!search.colliders.sdf(near.index)) return leavesAt(near, p, direction);
  return std::max(0.0, 2 * (search.margins.offset - search.colliders.closest(near.index, p).distance));
}

// Where projections alternate between overlapping bodies: goes straight away from the mean centre of the bodies around
// the vertex until it is outside all of them. Leaves `hit` as it is where none is around.
void leaveAll(const ContactSearch& search, const ContactScratch& scratch, Penetration& hit) {
  Vec3 centers = Vec3::Zero();
  int count = 0;
  for (const NearCollider& near : scratch.near) {
    if (!near.mayTouch(hit.target, kNeighbour)) continue;
    centers += near.after;
    ++count;
  }
  if (count == 0) return;
  const Vec3 away = hit.target - centers / count;
  const Vec3 direction = away.norm() > 1e-9 ? Vec3(away.normalized()) : Vec3(Vec3::UnitY());
  double way = 0;
  bool inside = true;
  for (int round = 0; inside && round < kMaxLeaves; ++round) {
    inside = false;
    for (const NearCollider& near : scratch.near) {
      const double further = wayOut(search, near, hit.target + (way + kStride) * direction, direction);
      if (further <= 0) continue;
      way += kStride + further;
      hit.collider = near.index;
      inside = true;
    }
  }
  hit.target += (way + kStride) * direction;
  hit.normal = search.colliders.closest(hit.collider, hit.target).normal;
}

// Places in `near` of the colliders that the vertex's cluster reaches.
std::span<const int> reachedBy(const ContactScratch& scratch, int vertex) {
  const int cluster = scratch.cluster_of[vertex];
  const int first = cluster > 0 ? scratch.reached_end[cluster - 1] : 0;
  return {scratch.reached.data() + first, scratch.reached.data() + scratch.reached_end[cluster]};
}

}  // namespace

void clusterVertices(const HairMesh& mesh, ContactScratch& scratch) {
  std::vector<int> vertices(static_cast<std::size_t>(mesh.vertexCount()));
  std::iota(vertices.begin(), vertices.end(), 0);
  scratch.cluster_of.assign(vertices.size(), 0);
  int count = 0;
  // Halves of boxes across their longest side, down to clusters.
  const std::function<void(std::span<int>)> split = [&](std::span<int> some) {
    if (some.size() <= kMaxClustered) {
      for (const int v : some) scratch.cluster_of[v] = count;
      ++count;
      return;
    }
    Eigen::AlignedBox3d box;
    for (const int v : some) box.extend(mesh.shape.positions[v]);
    int axis = 0;
    box.sizes().maxCoeff(&axis);
    const std::size_t half = some.size() / 2;
    std::nth_element(some.begin(), some.begin() + static_cast<std::ptrdiff_t>(half), some.end(), [&](int a, int b) {
      const double x = mesh.shape.positions[a][axis], y = mesh.shape.positions[b][axis];
      return x != y ? x < y : a < b;
    });
    split(some.first(half));
    split(some.subspan(half));
  };
  split(vertices);
  scratch.boxes.resize(count);
  scratch.reached_end.resize(count);
}

void findPenetrations(const ContactSearch& search, std::span<const Vec3> positions, ContactScratch& scratch,
                      std::vector<Penetration>& found) {
  found.clear();
  const SweptBox whole = boundPaths(search, positions, scratch);
  const Vec3 shift = 0.5 * (whole.low[1] + whole.high[1] - whole.low[0] - whole.high[0]);
  collectNear(search, whole, scratch.near);
  const bool clustered = !scratch.cluster_of.empty();
  // How far a vertex is from a collider's centre does not depend on the collider's turn.
  for (NearCollider& near : scratch.near)
    near.margin = near.reach + (near.after - near.before - shift).norm() + kRounding;
  collectReached(search, shift, scratch);
  if (scratch.near.empty()) return;
  for (const int v : search.vertices) {
    const std::span<const int> reached = clustered ? reachedBy(scratch, v) : std::span<const int>();
    if (clustered && reached.empty()) continue;
    Vec3 p = positions[v];
    Penetration hit{v, -1, p, Vec3::UnitY(), 0, false, 0};
    bool out = false;
    const bool brief = search.colliders.counted && *search.colliders.counted > search.max_points;
    for (int round = 0; round < (brief ? kBriefly : kProjections) && !out; ++round) {
      Penetration deepest{v, -1, p, Vec3::UnitY(), round == 0 ? 1e-9 : kMet, false, 0};
      const auto test = [&](const NearCollider& near) {
        if (near.index == hit.collider && !search.colliders.sdf(near.index)) return;  // p was brought to its surface
        const bool swept = round == 0 && (!brief || deepest.collider < 0);
        const Penetration touch = touchOf(search, near, v, p, swept);
        if (touch.depth > deepest.depth) deepest = touch;
      };
      // The bounds hold for the path of the step, not for a projected position.
      if (round == 0 && clustered) {
        const SweptBall path(search.start.empty() ? p : search.start[v], p, shift);
        for (const int n : reached) {
          if (!outOfReach(path, scratch.near[n])) test(scratch.near[n]);
        }
      } else {
        for (const NearCollider& near : scratch.near) test(near);
      }
      if ((out = deepest.collider < 0)) break;
      if (hit.collider >= 0) deepest.depth = hit.depth;  // that of the first projection
      deepest.initial_overlap = deepest.initial_overlap || hit.initial_overlap;
      deepest.left = std::max(deepest.left, hit.left);
      hit = deepest;
      p = hit.target;
    }
    if (hit.collider < 0) continue;
    if (!out && !hit.initial_overlap) leaveAll(search, scratch, hit);
    found.push_back(hit);
  }
}

void chooseSticking(double friction, double mobility, const Vec3& velocity, Contact& contact) {
  Vec3 slip = velocity - contact.velocity;
  slip -= slip.dot(contact.normal) * contact.normal;
  const double speed = slip.norm();
  const bool slid = !contact.sticks && !contact.friction_direction.isZero();
  contact.sticks = contact.pressure > 0 &&
                   (slid ? slip.dot(contact.friction_direction) >= 0 : speed <= friction * contact.pressure * mobility);
  if (contact.sticks || contact.pressure <= 0) contact.friction_direction.setZero();
  if (contact.sticks) return;
  // The direction of a creep is noise: friction against it would make the vertex oscillate.
  const double least = contact.friction_direction.isZero() ? kNoSlip : kCreep;
  if (speed > least) contact.friction_direction = -slip / speed;
  contact.friction_direction -= contact.friction_direction.dot(contact.normal) * contact.normal;
  contact.friction_direction.normalize();
}

bool updateSticking(const FrictionLaw& law, const Vec3& reaction, const Vec3& velocity, Contact& contact) {
  const double pressed = contact.pressure;  // what the friction of this solve was made of
  contact.pressure = contact.normal.dot(reaction);
  if (!contact.sticks) {
    const double back = contact.friction_direction.dot(velocity - contact.velocity);
    contact.sticks = pressed > 0 && contact.pressure >= 0 && law.h * law.coefficient * pressed * back > law.most_work;
    return contact.sticks;
  }
  if (contact.pressure < 0) {
    contact.sticks = false;
    contact.pressure = 0;
    return true;
  }
  // Within a solve, a contact that sticks with a friction direction has been thrown back by friction.
  const Vec3 tangential = reaction - contact.pressure * contact.normal;
  if (!contact.friction_direction.isZero() || tangential.norm() <= law.coefficient * contact.pressure) return false;
  contact.sticks = false;
  contact.pressure = std::min(contact.pressure, pressed);
  contact.friction_direction = tangential.normalized();
  return true;
}

void constrainContacts(std::span<const Contact> contacts, std::vector<VertexConstraint>& constraints) {
  for (std::size_t first = 0; first < contacts.size();) {
    std::size_t last = first;
    VertexConstraint constraint{contacts[first].vertex, Eigen::Matrix3d::Identity(), Vec3::Zero(), 0, {}};
    bool sticks = false;
    for (; last < contacts.size() && contacts[last].vertex == constraint.vertex; ++last) {
      const Contact& contact = contacts[last];
      if (contact.sticks && !sticks) {
        sticks = true;
        constraint.keep.setZero();
        constraint.prescribed = contact.velocity;
        constraint.removed = 3;
        const Vec3 tangent = contact.normal.unitOrthogonal();
        constraint.directions = {contact.normal, tangent, contact.normal.cross(tangent)};
      }
      if (sticks) continue;
      // The part of this normal within the directions that are still free.
      const Vec3 rest = constraint.keep * contact.normal;
      const double size = rest.norm();
      if (size < 0.05) continue;
      const Vec3 direction = rest / size;
      const double wanted = contact.normal.dot(contact.velocity - constraint.prescribed) / size;
      constraint.prescribed += wanted * direction;
      constraint.keep -= direction * direction.transpose();
      constraint.directions[constraint.removed++] = direction;
    }
    constraints.push_back(constraint);
    first = last;
  }
}

}  // namespace sim

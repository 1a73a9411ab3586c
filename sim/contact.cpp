#include "sim/contact.h"

#include <algorithm>
#include <cmath>

namespace sim {
namespace {

constexpr int kProjections = 8;  // alternating projections between overlapping ellipsoids

// Where the collider's rigid motion over the step carries a point of its start pose.
Vec3 carriedAlong(const Ellipsoid& e, const Vec3& p, double dt) {
  const Vec3 start_center = e.center - dt * e.velocity;
  const double angle = e.angular_velocity.norm() * dt;
  const Vec3 arm = p - start_center;
  if (angle < 1e-12) return e.center + arm;
  return e.center + Eigen::AngleAxisd(angle, e.angular_velocity.normalized()) * arm;
}

bool mayTouch(const Ellipsoid& e, double offset, const Vec3& p) {
  const double reach = e.radii.maxCoeff() + offset;
  const Vec3 d = p - e.center;
  if (d.squaredNorm() >= reach * reach) return false;
  // The offset surface lies within the ellipsoid whose radii are longer by offset times the aspect ratio.
  const Vec3 local = e.rotation.conjugate() * d;
  const double grow = offset * e.radii.maxCoeff() / e.radii.minCoeff();
  return local.cwiseQuotient(e.radii + Vec3::Constant(grow)).squaredNorm() < 1;
}

}  // namespace

void carryContacts(std::span<const Ellipsoid> ellipsoids, const SimParams& params, double dt, HairState& state) {
  std::erase_if(state.contacts, [&](const Contact& c) {
    return !params.collide || c.collider < 0 || c.collider >= static_cast<int>(ellipsoids.size());
  });
  for (Contact& contact : state.contacts) {
    const Vec3& x = state.positions[contact.vertex];
    const Ellipsoid& e = ellipsoids[contact.collider];
    const Vec3 carried = carriedAlong(e, x, dt);
    const SurfacePoint surface = closestPoint(e, carried);
    contact.normal = surface.normal;
    const double gap = params.contact_offset - surface.distance;  // positive: to be pushed out
    const double most = params.max_depenetration * dt;
    contact.velocity = (carried - x + std::clamp(gap, -most, most) * surface.normal) / dt;
  }
}

void findPenetrations(const HairMesh& mesh, std::span<const Ellipsoid> ellipsoids, double offset,
                      std::span<const Vec3> positions, std::vector<Penetration>& found) {
  found.clear();
  for (int v : mesh.external_vertices) {
    Vec3 p = positions[v];
    Penetration hit{v, -1, p, Vec3::UnitY(), 0};
    for (int round = 0; round < kProjections; ++round) {
      double deepest = 1e-9;
      SurfacePoint nearest;
      int collider = -1;
      for (int k = 0; k < static_cast<int>(ellipsoids.size()); ++k) {
        if (!mayTouch(ellipsoids[k], offset, p)) continue;
        const SurfacePoint s = closestPoint(ellipsoids[k], p);
        if (offset - s.distance > deepest) {
          deepest = offset - s.distance;
          nearest = s;
          collider = k;
        }
      }
      if (collider < 0) break;
      if (hit.collider < 0) hit.depth = deepest;
      p = nearest.point + offset * nearest.normal;
      hit.collider = collider;
      hit.target = p;
      hit.normal = nearest.normal;
    }
    if (hit.collider >= 0) found.push_back(hit);
  }
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
      // Remove this normal's part that earlier normals of the vertex have left free.
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

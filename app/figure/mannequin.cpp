#include "app/figure/mannequin.h"

#include <algorithm>

#include "app/figure/mannequin_mesh.h"
#include "app/figure/mannequin_skin.h"

namespace app {

namespace {

// Fine cells for face and neck, growing down to the waist.
MeshGrid gridFor(const BodyField& body) {
  const Figure& f = body.figure;
  const double s = f.height / 1.70, chin = body.head_origin.y();
  MeshGrid grid;
  grid.fine = 0.0195 * f.head_height;
  grid.coarse = 0.0135 * s;
  grid.fine_from = chin + 0.02 * f.head_height;
  grid.coarse_from = chin - 0.36 * s;
  grid.center_z = body.head_origin.z();
  const auto hold = [&](const Vec3& p, double radius) { grid.holds.push_back({p, radius * s}); };
  grid.holds.push_back({body.head_origin + Vec3(0, 0.5 * f.head_height, 0), 0.66 * f.head_height});
  hold(f.neck_base, 0.15);
  hold(f.pelvis, 0.24);
  hold(Vec3(f.pelvis.x(), 0.5 * (f.pelvis.y() + f.shoulder_level), f.pelvis.z()), 0.22);
  for (const double side : {-1.0, 1.0})
    hold(Vec3(f.neck_base.x() + side * f.shoulder_half, f.shoulder_level, f.neck_base.z()), 0.10);
  for (const Figure::Arm& arm : f.arms) {
    if (!arm.present) continue;
    for (const Vec3& p : {arm.shoulder, arm.elbow, arm.wrist}) hold(p, 0.10);
    hold(arm.wrist + (arm.wrist - arm.elbow).normalized() * 0.12 * s, 0.15);
  }
  for (const Figure::Leg& leg : f.legs) {
    if (!leg.present) continue;
    for (const Vec3& p : {leg.hip, leg.knee}) hold(p, 0.14);
    hold(Vec3(leg.ankle.x(), f.sole + 0.05 * s, leg.ankle.z()), 0.25);
  }
  for (const Figure::Appendage& appendage : f.appendages)
    for (const Vec3& p : appendage.points) hold(p, 0.08);
  return grid;
}

}  // namespace

Mannequin growMannequin(const BvhMotion& motion, const std::string& file) {
  StoodSkeleton stood = standSkeleton(motion, file);
  Mannequin mannequin;
  mannequin.field = shapeBody(stood.figure);
  const BodyField& field = mannequin.field;
  const Surface surface = meshSurface([&](const Vec3& p) { return field.value(p); }, gridFor(field));
  mannequin.mesh = skinMannequin(surface, field, stood.skeleton, stood.roles);

  // The rest pose faces +z: the scalp frame has the world's axes and the head joint's origin.
  const Rigid& head = stood.skeleton.joints[stood.roles.head].rest_world;
  Rigid scalp = Rigid::Identity();
  scalp.translation() = head.translation();
  mannequin.head_frame = head.inverse() * scalp;

  mannequin.skeleton = std::move(stood.skeleton);
  mannequin.roles = std::move(stood.roles);
  mannequin.notes = std::move(stood.notes);
  mannequin.notes.push_back("mannequin: " + std::to_string(surface.positions.size()) + " vertices, " +
                            std::to_string(surface.triangles.size() / 3) + " triangles");
  return mannequin;
}

}  // namespace app

#include "sim/stabilization/reference_hair.h"

#include <algorithm>
#include <cmath>

#include "sim/stabilization/state_validation.h"

namespace sim {
namespace {

// Speeds under another pull are to one another as its root (Froude 1872).
constexpr double kWeight = 9.81;          // m/s^2
constexpr double kStill = 0.02;           // m/s: slower hair hangs still, unless it
constexpr double kOnItsWay = 1;           // s, would in so long go as far as the twin is off
constexpr double kStillFor = 0.5;         // s
constexpr double kReferenceStill = 5e-3;  // m/s
constexpr double kMaxSettling = 60;       // s, after which a twin that goes on swinging is taken as it is
constexpr double kElsewhere = 0.006;      // of the hair's length: what is nearer to its twin is at home
constexpr double kAtHome = 0.003;         // of the hair's length, from the rest shape itself
constexpr double kHigher = 5e-5;          // of the hair's weight times its length
constexpr double kMoving = 3 * kStill;    // m/s: hair so fast is on its way to another rest

constexpr double kFirstBackoff = 1, kMaxBackoff = 60;  // s between one time that the hair is led and the next
constexpr double kBackoffGrowth = 2;

double fastest(const HairState& state) {
  double most = 0;
  for (const Vec3& v : state.velocities) most = std::max(most, v.squaredNorm());
  return std::sqrt(most);
}

double largestDistance(const HairState& a, const HairState& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.positions.size(); ++i)
    most = std::max(most, (a.positions[i] - b.positions[i]).squaredNorm());
  return std::sqrt(most);
}

void beginReference(const HairMesh& mesh, const HairState& state, const InversionRecovery& recovery, RestCheck& check) {
  for (int c = 0; c < mesh.columnCount(); ++c) check.roots[c] = state.positions[mesh.shape.column_first[c]];
  const Eigen::Isometry3d head = rigidMotion(recovery.rest_roots, check.roots);
  for (int i = 0; i < mesh.vertexCount(); ++i) {
    check.reference.positions[i] = mesh.isRoot(i) ? state.positions[i] : Vec3(head * mesh.shape.positions[i]);
    check.reference.velocities[i].setZero();
  }
  check.reference.previous_dt = 0;
  check.settling = 0;
}

}  // namespace

RestCheck::RestCheck(const HairMesh& mesh) {
  for (auto* array :
       {&reference.positions, &reference.velocities, &reference.previous_positions, &reference.previous_velocities})
    array->resize(mesh.vertexCount());
  roots.resize(mesh.columnCount());
}

bool watchRest(const HairMesh& mesh, const HairState& state, double pull, double dt, const InversionRecovery& recovery,
               RestCheck& check) {
  check.stir = std::sqrt(std::max(1.0, pull / kWeight));
  const double speed = fastest(state) / check.stir;
  check.wait = std::max(0.0, check.wait - dt);
  if (speed > kMoving) check.judged = check.kept_apart = false;
  if (check.judged || check.wait > 0) return false;
  if (!(speed < kStill) || !state.contacts.empty() || recovery.guided_columns > 0) {
    check.still = 0;
    check.settling = -1;
    return false;
  }
  check.still += dt;
  if (check.settling < 0) {
    beginReference(mesh, state, recovery, check);
    // Nobody need find out where the rest shape would come to while the hair is in it and hardly moves.
    if (largestDistance(state, check.reference) < kAtHome * mesh.hair_length) {
      check.settling = -1;
      return false;
    }
  }
  check.settling += dt;
  return true;
}

void judgeRest(const HairMesh& mesh, const HairState& state, double scale,
               const std::function<double(const HairState&)>& energy, InversionRecovery& recovery, RestCheck& check) {
  const double stirring = fastest(check.reference);
  if (check.still < kStillFor || !(stirring < kReferenceStill * check.stir || check.settling > kMaxSettling)) return;
  const double off = largestDistance(state, check.reference);
  if (off > kElsewhere * mesh.hair_length && kOnItsWay * fastest(state) > off) return;
  const bool higher = energy(state) - energy(check.reference) > kHigher * scale;
  // A twin on its way down may yet come to rest below the hair.
  check.judged = higher || stirring < kReferenceStill || check.settling > kMaxSettling;
  if (off <= kElsewhere * mesh.hair_length || !higher) {
    if (check.judged && check.self_contact && !check.kept_apart) {
      check.judged = false, check.kept_apart = true;
      check.settling = -1;
    }
    return;
  }
  guideTo(mesh, check.reference, recovery);
  check.kept_apart = false;
  check.backoff = std::min(kMaxBackoff, std::max(kFirstBackoff, kBackoffGrowth * check.backoff));
  check.wait = check.backoff;
}

}  // namespace sim

#include "sim/stabilization/reference_hair.h"

#include <algorithm>
#include <cmath>

#include "sim/mesh/rigid_motion.h"

namespace sim {
namespace {

// Speeds under another pull are to one another as its root (Froude 1872).
constexpr double kWeight = 9.81;            // m/s^2
constexpr double kStillHair = 0.02;         // m/s: slower hair hangs still, unless it
constexpr double kOnItsWay = 1;             // s, would in so long go as far as the reference is off
constexpr double kStillFor = 0.5;           // s, of the hair and of its reference: what falls is slow where it turns
constexpr double kReferenceStill = 5e-3;    // m/s
constexpr double kAtRest = 1e-4;            // m/s: a reference so slow finds nothing lower any more
constexpr double kMaxSettling = 60;         // s, after which a reference that goes on swinging is taken as it is
constexpr double kElsewhere = 0.006;        // of the hair's length: what is nearer to its reference is at home
constexpr double kAtHome = 0.003;           // of the hair's length, from the rest shape itself
constexpr double kHigher = 5e-5;            // of the hair's weight times its length
constexpr double kMoving = 3 * kStillHair;  // m/s: hair so fast is on its way to another rest
constexpr double kFirstBackoff = 1, kMaxBackoff = 60;  // s between one time that the hair is guided and the next
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

// How fast hair moves that is pulled so hard (m/s^2), as a multiple of hair that its weight alone pulls.
double stirOf(double pull) {
  return std::sqrt(std::max(1.0, pull / kWeight));
}

void beginReference(const HairMesh& mesh, HairState& state) {
  HairState& reference = state.memory.rest.reference.front();
  const Eigen::Isometry3d head = rootMotion(mesh, mesh.shape.positions, state.positions);
  for (int i = 0; i < mesh.vertexCount(); ++i) {
    reference.positions[i] = mesh.isRoot(i) ? state.positions[i] : Vec3(head * mesh.shape.positions[i]);
    reference.velocities[i].setZero();
  }
  reference.previous_dt = reference.memory.rest.still = 0;
  state.memory.rest.settling = 0;
}

}  // namespace

bool watchRest(const RestStep& step, HairState& state) {
  RestMemory& rest = state.memory.rest;
  const double speed = fastest(state) / stirOf(step.pull);
  rest.wait = std::max(0.0, rest.wait - step.dt);
  if (speed > kMoving) rest.judged = rest.kept_apart = false;
  if (rest.judged || rest.wait > 0) return false;
  if (!(speed < kStillHair) || !state.contacts.empty() || state.memory.recovery.guided_columns > 0) {
    rest.still = 0;
    rest.settling = -1;
    return false;
  }
  rest.still += step.dt;
  if (rest.settling < 0) {
    beginReference(step.mesh, state);
    // Nobody need find out where the rest shape would come to while the hair is in it and hardly moves.
    if (largestDistance(state, rest.reference.front()) < kAtHome * step.mesh.hair_length) {
      rest.settling = -1;
      return false;
    }
  }
  rest.settling += step.dt;
  return true;
}

void judgeRest(const RestStep& step, const std::function<double(const HairState&)>& energy, HairState& state) {
  RestMemory& rest = state.memory.rest;
  HairState& reference = rest.reference.front();
  const double stirring = fastest(reference);
  double& rested = reference.memory.rest.still;
  rested = stirring < kReferenceStill * stirOf(step.pull) ? rested + step.dt : 0;
  if (rest.still < kStillFor || (rested < kStillFor && rest.settling <= kMaxSettling)) return;
  const double off = largestDistance(state, reference);
  if (off > kElsewhere * step.mesh.hair_length && kOnItsWay * fastest(state) > off) return;
  const bool higher = energy(state) - energy(reference) > kHigher * step.scale;
  // A reference on its way down may yet come to rest below the hair.
  rest.judged = higher || stirring < kAtRest || rest.settling > kMaxSettling;
  if (off <= kElsewhere * step.mesh.hair_length || !higher) {
    if (rest.judged && step.self_contact && !rest.kept_apart) {
      rest.judged = false, rest.kept_apart = true;
      rest.settling = -1;
    }
    return;
  }
  guideTo(step.mesh, reference, state.memory.recovery);
  rest.kept_apart = false;
  rest.backoff = std::min(kMaxBackoff, std::max(kFirstBackoff, kBackoffGrowth * rest.backoff));
  rest.wait = rest.backoff;
}

}  // namespace sim

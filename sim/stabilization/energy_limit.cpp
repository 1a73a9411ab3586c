#include "sim/stabilization/energy_limit.h"

#include <algorithm>
#include <cmath>

#include "sim/mesh/rigid_motion.h"

namespace sim {
namespace {

// Of the hair's length: a step in which no vertex moves farther against its root is as good as linear, and costs
// nothing more. In long steps less: under the first bound softened hair gained energy in steps of 1/20 s and more.
constexpr double kGentle = 0.1, kGentleLong = 0.05;
constexpr double kLongStep = 1.0 / 50;  // s
// No step is near to linear of hair whose load strains its walls by more than this: what curvature the Hessian leaves
// out grows with the strain.
constexpr double kLimp = 0.2;
constexpr int kTries = 5;            // of a shorter way
constexpr double kWithin = 0.95;     // of the energy allowed and of the way, that a try aims at
constexpr double kMinWay = 0.5;      // of the way, that the first try leaves: energies of stretched hair rise faster
constexpr double kMinSecond = 0.1;   // that the second leaves: hair at rest has no energy to spend, and two energies
                                     // do not tell a way that first leads down from one that does not
constexpr double kStillBody = 1e-3;  // m/s of a body's surface against the roots

enum class Motion { kCalm, kViolent, kNotFinite };

void forEachModulus(const auto& f) {
  ForceKinds::forEach([&]<class Kind>() {
    for (const Modulus& modulus : Kind::kModuli) f(modulus);
  });
}

Motion judge(const TakenStep& step, const HairState& state) {
  const SimParams& params = step.params;
  // A step is gentle over so much less as the forces that are least linear are stiffer: volume's, and the walls', for
  // what turns is also stretched, to second order.
  double soft = 1;
  forEachModulus([&](const Modulus& modulus) { soft = std::min(soft, modulus.gentle / (params.*modulus.param)); });
  const double most = (step.dt > kLongStep ? kGentleLong : kGentle) * std::sqrt(soft) * step.mesh.hair_length;
  Motion motion = Motion::kCalm;
  for (int i = 0; i < step.mesh.vertexCount(); ++i) {
    const int root = step.mesh.shape.column_first[step.mesh.column_of[i]];
    const Vec3 carried = state.positions[root] - step.positions[root];
    const double way = (state.positions[i] - step.positions[i] - carried).squaredNorm();
    if (!std::isfinite(way) || !state.velocities[i].allFinite()) return Motion::kNotFinite;
    if (way > most * most) motion = Motion::kViolent;
  }
  return motion;
}

// Nor of hair that is stiffer one way by such a ratio than another (Modulus::uneven): it buckles.
bool neverLinear(const TakenStep& step) {
  const SimParams& params = step.params;
  const double pull = (params.air_drag * step.wind - Vec3(0, params.gravity, 0)).norm();
  const double segment = step.mesh.vertical_edges.front().rest_length;
  double softest = INFINITY;  // of those that there are
  forEachModulus([&](const Modulus& modulus) {
    const double value = params.*modulus.param;
    if (modulus.yields && value > 0) softest = std::min(softest, value);
  });
  bool uneven = false;
  forEachModulus([&](const Modulus& modulus) {
    const double value = params.*modulus.param / (modulus.over_length ? segment * segment : 1);
    uneven = uneven || value > modulus.uneven * softest;
  });
  return params.density * pull * step.mesh.hair_length > kLimp * softest || uneven;
}

// Where the roots carry every vertex that does not move against them.
void carry(const TakenStep& step, const HairState& state, EnergyLimit& scratch) {
  const HairMesh& mesh = step.mesh;
  const Eigen::Isometry3d motion = rootMotion(mesh, step.positions, state.positions);
  for (int i = 0; i < mesh.vertexCount(); ++i)
    scratch.carried[i] = mesh.isRoot(i) ? state.positions[i] : Vec3(motion * step.positions[i]);
  for (const PinnedVertex& pin : step.pins) {
    if (pin.firm()) scratch.carried[pin.vertex] = pin.target;
  }
}

// m/s at which the roots carry a vertex.
Vec3 carrying(const TakenStep& step, const EnergyLimit& scratch, int i) {
  return (scratch.carried[i] - step.positions[i]) / step.dt;
}

// Elastic energy, that of gravity, and that of the air as it blows against what the roots carry (J): drag beyond that
// only takes. Hair that goes to and fro gives back to the wind what it was given.
double potential(const TakenStep& step, std::span<const Vec3> x, EnergyLimit& scratch) {
  ++scratch.energies;
  double energy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3 drag = step.params.air_drag * (step.wind - carrying(step, scratch, static_cast<int>(i)));
    const double specific = step.params.gravity * x[i].y() - drag.dot(x[i] - scratch.carried[i]);
    energy += step.params.density * step.mesh.vertex_volume[i] * specific;
  }
  return energy + scratch.stored.at(step.model, x);
}

// J, of a step whose carried positions are known, seen from the roots.
struct Account {
  double carried = 0;  // potential, of the hair as the roots carry it
  double bound = 0;    // of what it may end with
  double kinetic = 0;  // that it ends with
};

double kineticOf(const TakenStep& step, const EnergyLimit& scratch, const Vec3& velocity, int i) {
  const double mass = step.params.density * step.mesh.vertex_volume[i];
  return 0.5 * mass * (velocity - carrying(step, scratch, i)).squaredNorm();
}

// Most that the dampers of elements which the step's input moves can do (J): with r the rate of the condition where the
// vertices are carried along and s what they add to it, their power -d k (r + s) s is at most d k r^2 / 4.
double dampersWork(const TakenStep& step, const EnergyLimit& scratch) {
  double work = 0;
  step.model.forEach([&]<class Kind>(const Elements<Kind, double>& elements) {
    if constexpr (MovingKind<Kind>) {
      for (std::size_t e = 0; e < elements.size(); ++e) {
        V3<double> x[Kind::kVertices];
        for (int p = 0; p < Kind::kVertices; ++p) {
          const Vec3& at = scratch.carried[elements.vertices[e][p]];
          x[p] = {at.x(), at.y(), at.z()};
        }
        const auto c = Kind::condition(x, elements.rest[e], elements.shift[e]);
        double rate = Kind::drift(elements.rest[e]);
        const double damping = step.mesh.dampingShare(elements.vertices[e]) * step.params.damping;
        for (int p = 0; p < Kind::kVertices; ++p) {
          const Vec3 speed = carrying(step, scratch, elements.vertices[e][p]);
          rate += c.g[p].x * speed.x() + c.g[p].y * speed.y() + c.g[p].z * speed.z();
        }
        work += step.dt * damping * elements.stiffness[e] * rate * rate / 4;
      }
    }
  });
  return work;
}

Account accountFor(const TakenStep& step, EnergyLimit& scratch, const HairState& state) {
  Account account;
  if (!scratch.carried_energy) scratch.carried_energy = potential(step, scratch.carried, scratch);
  account.carried = *scratch.carried_energy;
  account.bound = account.carried + dampersWork(step, scratch);
  for (int i = 0; i < step.mesh.vertexCount(); ++i) {
    if (step.mesh.isRoot(i)) continue;
    account.bound += kineticOf(step, scratch, step.velocities[i], i);
    account.kinetic += kineticOf(step, scratch, state.velocities[i], i);
  }
  // What bodies push: their pressure along its normal, and friction of at most its share.
  for (const Contact& contact : state.contacts) {
    const Vec3 pushed = step.dt * (contact.velocity - carrying(step, scratch, contact.vertex));
    const double along = contact.normal.dot(pushed);
    const double work = std::max(0.0, along) + step.params.friction * (pushed - along * contact.normal).norm();
    account.bound += std::max(0.0, contact.pressure) * work;
  }
  return account;
}

// Slows what moves against the roots to a share of its speed.
void slowDown(const TakenStep& step, const EnergyLimit& scratch, double share, HairState& state) {
  for (int i = 0; i < step.mesh.vertexCount(); ++i) {
    if (step.mesh.isRoot(i)) continue;
    const Vec3 carried = carrying(step, scratch, i);
    state.velocities[i] = carried + share * (state.velocities[i] - carried);
  }
  state.previous_dt = 0;  // what came before says nothing any more about how it goes on
}

// The share of a way at which an energy is `most`, where it is `end` at the way's end and, unless that is 1, `beyond`
// at `past` times the way; all above what it is at the begin, J. It is taken for a quadratic of the way or, where it
// rises faster, for a power of it halfway between that rise and a square.
double shareWithin(double most, double end, double past, double beyond) {
  if (!(most > 0)) return kMinWay;
  const double curved = past > 1 ? (beyond / past - end) / (past - 1) : end, slope = end - curved;
  if (slope < 0) return std::pow(most / end, 1 / (1 + 0.5 * std::log(beyond / end) / std::log(past)));
  return 2 * most / (slope + std::sqrt(std::max(0.0, slope * slope + 4 * curved * most)));
}

// Shortens the way of every vertex from `back`, whose potential energy is `least` (J), until its own is `most`, tried
// so many times before giving the way up. Returns the share of it that was kept and sets the energy stored there.
double shorten(const TakenStep& step, std::span<const Vec3> back, double least, double most, int tries, double& stored,
               EnergyLimit& scratch, HairState& state) {
  double kept = 1, past = 1, beyond = 0;
  for (int k = 0; !(stored <= most) && kept > 0; ++k) {
    const double end = stored - least, shortest = k == 0 ? kMinWay : k == 1 ? kMinSecond : 0;
    const double fits = shareWithin(kWithin * (most - least), end, past, beyond);
    const double share = k >= tries ? 0 : std::isfinite(end) ? std::clamp(fits, shortest, kWithin) : kMinWay;
    for (std::size_t i = 0; i < back.size(); ++i) state.positions[i] = back[i] + share * (state.positions[i] - back[i]);
    kept *= share;
    stored = share > 0 ? potential(step, state.positions, scratch) : least;
    past = std::isfinite(end) && share > 0 ? 1 / share : 1, beyond = end;
  }
  return kept;
}

// Brings a step below its bound, by at most so many tries of a shorter way. Returns the share of the motion kept.
double bringBelowBound(const TakenStep& step, int tries, EnergyLimit& scratch, HairState& state) {
  const Account account = accountFor(step, scratch, state);
  if (!std::isfinite(account.bound)) return 1;
  double stored = potential(step, state.positions, scratch);
  if (stored + account.kinetic <= account.bound) return 1;
  const double kept = shorten(step, scratch.carried, account.carried, account.bound, tries, stored, scratch, state);
  const double kinetic = kept * kept * account.kinetic, left = std::max(0.0, account.bound - stored);
  const double slowed = kept * (kinetic > left ? std::sqrt(left / kinetic) : 1);
  slowDown(step, scratch, slowed, state);
  return kept;
}

// Whether every body that the hair touches moves as the roots carry it: seen from them it does no work.
bool bodiesStandStill(const TakenStep& step, const Colliders& colliders, const EnergyLimit& scratch,
                      const HairState& state) {
  return std::all_of(state.contacts.begin(), state.contacts.end(), [&](const Contact& contact) {
    const Vec3 surface = surfaceVelocity(colliders.body(contact.collider), scratch.carried[contact.vertex]);
    return (surface - carrying(step, scratch, contact.vertex)).norm() < kStillBody;
  });
}

}  // namespace

EnergyLimit::EnergyLimit(const HairMesh& mesh) : carried(mesh.vertexCount()), stored(mesh) {}

double limitEnergy(const TakenStep& step, bool solved, EnergyLimit& scratch, HairState& state) {
  scratch.carried_energy.reset();
  const Motion motion = judge(step, state);
  const bool gentle = motion == Motion::kCalm && solved && !step.restarted && !neverLinear(step);
  if (gentle || motion == Motion::kNotFinite) return 1;
  carry(step, state, scratch);
  return bringBelowBound(step, kTries, scratch, state);
}

double limitCorrections(const TakenStep& step, const Colliders& colliders, EnergyLimit& scratch, HairState& state) {
  carry(step, state, scratch);
  if (!bodiesStandStill(step, colliders, scratch, state)) return 1;
  // Halfway between two distant places outside of a body may lie its inside.
  return bringBelowBound(step, judge(step, state) == Motion::kCalm ? kTries : 0, scratch, state);
}

}  // namespace sim

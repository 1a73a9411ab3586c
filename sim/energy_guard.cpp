#include "sim/energy_guard.h"

#include <algorithm>
#include <cmath>

#include "sim/watchdog.h"

namespace sim {
namespace {

// Of the hair's length: a step in which no vertex moves farther against its root is as good as linear, and costs
// nothing more. In long steps less: under the first bound softened hair gained energy in steps of 1/20 s and more.
constexpr double kGentle = 0.1, kGentleLong = 0.05;
constexpr double kLongStep = 1.0 / 50;  // s
// Pa; a step is gentle over so much less as the forces that are least linear are stiffer: volume's, and the walls'
// along the hair, for what turns is also stretched, to second order.
constexpr double kSoftVolume = 1e4, kSoftStretch = 4e5;
constexpr int kHalvings = 12;
constexpr double kStill = 1e-3;  // m/s of a body's surface against the roots

enum class Motion { kCalm, kViolent, kNotFinite };

Motion judge(const TakenStep& step, const HairState& state) {
  const double soft =
      std::sqrt(std::min({1.0, kSoftVolume / step.params.volume, kSoftStretch / step.params.stretch_along}));
  const double most = (step.dt > kLongStep ? kGentleLong : kGentle) * soft * step.mesh.hair_length;
  Motion motion = Motion::kCalm;
  for (int c = 0; c < step.mesh.columnCount(); ++c) {
    const int root = step.mesh.shape.column_first[c];
    const Vec3 carried = state.positions[root] - step.positions[root];
    for (int i = root + 1; i < step.mesh.shape.column_first[c + 1]; ++i) {
      const double way = (state.positions[i] - step.positions[i] - carried).squaredNorm();
      if (!std::isfinite(way) || !state.velocities[i].allFinite()) return Motion::kNotFinite;
      if (way > most * most) motion = Motion::kViolent;
    }
  }
  return motion;
}

// Elastic energy and that of gravity, J.
double potential(const TakenStep& step, std::span<const Vec3> x, EnergyGuard& scratch) {
  double energy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    scratch.plain[i] = {x[i].x(), x[i].y(), x[i].z()};
    energy += step.params.density * step.mesh.vertex_volume[i] * step.params.gravity * x[i].y();
  }
  return energy + evaluate<double>(step.model, scratch.plain, {});
}

// Where the roots carry every vertex that does not move against them.
void carry(const TakenStep& step, const HairState& state, EnergyGuard& scratch) {
  const HairMesh& mesh = step.mesh;
  scratch.roots_before.clear(), scratch.roots_after.clear();
  for (int c = 0; c < mesh.columnCount(); ++c) {
    const int root = mesh.shape.column_first[c];
    scratch.roots_before.push_back(step.positions[root]);
    scratch.roots_after.push_back(state.positions[root]);
  }
  const Eigen::Isometry3d motion = rigidMotion(scratch.roots_before, scratch.roots_after);
  scratch.carried.resize(state.positions.size());
  scratch.plain.resize(state.positions.size());
  for (std::size_t i = 0; i < state.positions.size(); ++i) scratch.carried[i] = motion * step.positions[i];
  for (int c = 0; c < mesh.columnCount(); ++c) scratch.carried[mesh.shape.column_first[c]] = scratch.roots_after[c];
}

// Brings a step whose carried positions are known below its bound, halving its motion so many times before giving it
// up. Returns the share of the motion that was kept.
double bringBelowBound(const TakenStep& step, int halvings, EnergyGuard& scratch, HairState& state) {
  const std::vector<Vec3>& carried = scratch.carried;
  const int n = step.mesh.vertexCount();
  const auto carrying = [&](int i) { return Vec3((carried[i] - step.positions[i]) / step.dt); };
  const auto massOf = [&](int i) { return step.params.density * step.mesh.vertex_volume[i]; };

  double bound = potential(step, carried, scratch), kinetic = 0;
  for (int i = 0; i < n; ++i) {
    if (step.mesh.isRoot(i)) continue;
    const Vec3 drag = massOf(i) * step.params.air_drag * (step.wind - state.velocities[i]);
    bound += std::max(0.0, drag.dot(state.positions[i] - carried[i]));
    bound += 0.5 * massOf(i) * (step.velocities[i] - carrying(i)).squaredNorm();
    kinetic += 0.5 * massOf(i) * (state.velocities[i] - carrying(i)).squaredNorm();
  }
  // What bodies push: their pressure along its normal, and friction of at most its share.
  for (const Contact& contact : state.contacts) {
    const Vec3 pushed = step.dt * (contact.velocity - carrying(contact.vertex));
    const double along = contact.normal.dot(pushed);
    const double work = std::max(0.0, along) + step.params.friction * (pushed - along * contact.normal).norm();
    bound += std::max(0.0, contact.pressure) * work;
  }
  if (!std::isfinite(bound)) return 1;

  double kept = 1, stored = potential(step, state.positions, scratch);
  if (stored + kinetic <= bound) return 1;
  for (int halving = 0; !(stored <= bound); ++halving) {
    const double share = halving < halvings ? 0.5 : 0;
    for (int i = 0; i < n; ++i) state.positions[i] = carried[i] + share * (state.positions[i] - carried[i]);
    kept *= share;
    kinetic *= share * share;
    if (share == 0) break;
    stored = potential(step, state.positions, scratch);
  }
  const double left = std::max(0.0, bound - stored);
  const double slowed = kept * (kinetic > left ? std::sqrt(left / kinetic) : 1);
  for (int i = 0; i < n; ++i) {
    if (!step.mesh.isRoot(i)) state.velocities[i] = carrying(i) + slowed * (state.velocities[i] - carrying(i));
  }
  state.previous_dt = 0;  // what came before says nothing any more about how it goes on
  return kept;
}

// Whether every body that the hair touches moves as the roots carry it: seen from them it stands still and does no
// work.
bool bodiesStandStill(const TakenStep& step, const Colliders& colliders, const EnergyGuard& scratch,
                      const HairState& state) {
  return std::all_of(state.contacts.begin(), state.contacts.end(), [&](const Contact& contact) {
    const Vec3& x = scratch.carried[contact.vertex];
    const Vec3 carrying = (x - step.positions[contact.vertex]) / step.dt;
    return (surfaceVelocity(colliders.body(contact.collider), x) - carrying).norm() < kStill;
  });
}

}  // namespace

double limitEnergy(const TakenStep& step, bool solved, EnergyGuard& scratch, HairState& state) {
  const Motion motion = judge(step, state);
  if (motion == Motion::kNotFinite || (motion == Motion::kCalm && solved)) return 1;
  carry(step, state, scratch);
  return bringBelowBound(step, kHalvings, scratch, state);
}

double limitCorrections(const TakenStep& step, const Colliders& colliders, EnergyGuard& scratch, HairState& state) {
  carry(step, state, scratch);
  if (!bodiesStandStill(step, colliders, scratch, state)) return 1;
  // Halfway between two distant places outside of a body may lie its inside.
  return bringBelowBound(step, judge(step, state) == Motion::kCalm ? kHalvings : 0, scratch, state);
}

}  // namespace sim

#include "tests/stress/case_run.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sim/contact/contact.h"
#include "sim/stabilization/parameter_limits.h"
#include "tests/bench/measured_part.h"
#include "tests/sim_probes.h"
#include "tests/stress/matrix.h"
#include "tests/stress/start_states.h"

namespace stress {
namespace {

constexpr double kShortestStep = 1e-3, kLongestStep = 0.5;  // s, of random paces
constexpr double kFaultEvery = 0.1;                         // s
constexpr int kFramesALook = 6;                             // at the skin
constexpr double kIntruderThere = 0.3;                      // s, when a body that appears has done so

// m that a vertex lies inside the colliders in use; zero outside.
double depthOf(const Run& run, int vertex) {
  const sim::Colliders colliders{run.around.ellipsoids(), run.around.parts()};
  const sim::Vec3& p = run.hair.state.positions[vertex];
  double depth = 0;
  for (int k = 0; k < colliders.count(); ++k) {
    if (colliders.parts.empty() && test::implicitValue(colliders.ellipsoids[k], p) >= 0) continue;
    depth = std::max(depth, -colliders.closest(k, p).distance);
  }
  return depth;
}

// Contacts with the body that the case adds.
void countMeetings(Run& run) {
  for (const sim::Contact& contact : run.hair.state.contacts) run.met += contact.collider == run.around.intruderIndex();
}

}  // namespace

Run::Run(const StressCase& c, std::uint64_t seed, Stage& s)
    : one(c),
      stage(s),
      random(seed, c.name),
      around(c, colliderOf(c) == sim::ColliderKind::kSdf, s, random),
      hair(s.mesh()) {
  for (const auto& [name, value] : c.params) sim::findParam(name)->set(params, value);
  params.time_step = c.step;
  params.collide = params.collide && c.collide;  // a row may turn it off too
  next_fault = kFaultEvery;
  hair.context.safetyNets() = c.nets;
  hair.state = s.settled;
  hair.state.memory = {};
  applyStart(c, hair.mesh, random, hair.state);
  if (c.sees_skin) skin.emplace(s);
}

sim::Vec3 windOf(const Run& run) {
  const sim::SimParams params = sim::limitedParameters(run.hair.mesh, run.params);
  return {params.wind_x, params.wind_y, params.wind_z};
}

double energyOf(const Run& run, Hair& hair) {
  double energy = test::mechanicalEnergy(run.hair.mesh, run.params, hair.context, hair.state);
  const sim::Vec3 wind = windOf(run);
  for (int i = 0; i < run.hair.mesh.vertexCount(); ++i) {
    const double mass = run.params.density * run.hair.mesh.vertex_volume[i];
    energy -= mass * run.params.air_drag * wind.dot(hair.state.positions[i]);
  }
  return energy;
}

void traceStep(const Run& run, double dt, const sim::StepReport& report, Hair& hair) {
  double fastest = 0;
  for (const sim::Vec3& v : hair.state.velocities) fastest = std::max(fastest, v.norm());
  std::printf(
      "%9.4f s  step %6.1f ms  energy %12.5e J  fastest %9.3e m/s  contacts %3d  corrected %3d  standing %3d  self %3d "
      " "
      "iterations %4d  combed %d%s%s\n",
      run.around.time(), 1e3 * dt, energyOf(run, hair), fastest, report.contacts, report.corrected,
      report.initial_overlap, report.self_contacts, report.solver_iterations, report.guided,
      report.converged ? "" : " (not converged)", report.carried ? " carried" : "");
}

sim::StepReport stepHair(const sim::SimParams& params, const Run& run, double dt, Hair& hair) {
  const Surroundings& around = run.around;
  const sim::StepInput input{around.roots(), around.ellipsoids(), around.time(), around.parts()};
  return sim::advance(hair.mesh, params, input, dt, hair.context, hair.state);
}

void checkFinite(Run& run) {
  for (int i = 0; i < run.hair.mesh.vertexCount(); ++i) {
    if (run.hair.state.positions[i].allFinite() && run.hair.state.velocities[i].allFinite()) continue;
    return run.fail(bench::formatted("vertex %d is not finite", i));
  }
}

// Vertices that are held outside and lie inside a collider at a frame's end.
void checkOutside(Run& run) {
  // What lies within a body comes out no faster than the parameter says; the stated time is that of its default.
  const double gentle = std::max(1.0, sim::SimParams{}.max_depenetration / run.params.max_depenetration);
  if (!run.params.collide || run.around.time() < run.last_intrusion + gentle * run.one.grace) return;
  const sim::HairMesh& mesh = run.hair.mesh;
  const auto check = [&](int v) {
    const double depth = depthOf(run, v);
    run.outcome.deepest = std::max(run.outcome.deepest, depth);
    if (depth <= kDeepest) return;
    ++run.outcome.inside;
    const auto& contacts = run.hair.state.contacts;
    run.outcome.unconstrained +=
        std::none_of(contacts.begin(), contacts.end(), [&](const sim::Contact& c) { return c.vertex == v; });
    run.fail(bench::formatted("vertex %d is %.2f mm inside a collider", v, 1e3 * depth));
  };
  if (!run.params.collide_inner) {
    for (const int v : mesh.external_vertices) check(v);
    return;
  }
  for (int v = 0; v < mesh.vertexCount(); ++v) {
    if (!mesh.isRoot(v)) check(v);
  }
}

void countWork(const sim::StepReport& report, Run& run) {
  ++run.outcome.steps;
  run.outcome.guided = std::max(run.outcome.guided, report.guided);
  run.iterations += report.solver_iterations;
  run.unsolved += !report.converged;
}

void step(double dt, Run& run) {
  const Eigen::Isometry3d head = run.around.head();
  run.around.move(dt);
  if (run.around.carries()) sim::carryAlong(head, run.around.head(), run.hair.state);
  if (run.around.intrudes() || run.one.switches) run.last_intrusion = run.around.time();
  if (run.one.redraws_parameters) {
    for (const sim::ParamField& field : sim::paramFields()) {
      // Of signed distances the surroundings have none, unless the case began with them.
      const std::string_view name = field.name;
      if (std::string_view(field.group) == "Time" || name == "collider") continue;
      if (!run.one.switches && (name == "collide" || name == "collide_inner")) continue;
      if (!run.random.chance(0.3)) continue;
      const double drawn = draw(field, run.random);
      if (hasNets(field, drawn)) field.set(run.params, drawn);
    }
  }
  if (run.one.upset == Upset::kFault && run.around.time() >= run.next_fault) {
    injectFault(run.hair.mesh, run.random, run.hair.state);
    run.next_fault += kFaultEvery;
  }
  const sim::StepReport report = run.waits ? sim::StepReport{} : stepHair(run.params, run, dt, run.hair);
  run.outcome.recoveries += report.recoveries;
  run.outcome.carried += report.carried;
  countWork(report, run);
  run.outcome.dearest = std::max(run.outcome.dearest, report.work_units / run.hair.mesh.vertexCount());
  if (run.one.meets) countMeetings(run);
  if (run.bodyWithin() && run.around.time() > kIntruderThere)
    run.raised = std::max(run.raised, energyOf(run, run.hair));
  if (run.trace) traceStep(run, dt, report, run.hair);
  if (report.recoveries > 0 && !run.one.recovers) run.fail("state fault: " + sim::faultText(report.fault_report));
  checkFinite(run);
}

void frame(Run& run) {
  switch (run.one.pace) {
    case Pace::kFixed:
      step(run.one.step, run);
      break;
    case Pace::kRandomSteps:
      step(run.random.logarithmic(kShortestStep, kLongestStep), run);
      break;
    case Pace::kRandomFrames: {
      const double seconds = run.random.logarithmic(kShortestStep, kLongestStep);
      const int steps = app::tick(seconds, run.one.step, run.params.max_steps_per_frame, run.clock);
      for (int i = 0; i < steps; ++i) step(run.one.step, run);
      break;
    }
  }
  checkOutside(run);
  // Not within the grace of a jump, as vertices are not.
  if (!run.skin || run.frames++ % kFramesALook != 0 || run.around.time() < run.last_intrusion + run.one.grace) return;
  run.skin->look(run.stage.actor, run.hair.state.positions, run.skin_seen);
  run.outcome.skin_share = run.skin_seen.share();
  run.outcome.skin_deepest = run.skin_seen.deepest;
}

}  // namespace stress

// One step of a hair, of the C interface: the caller's numbers in, sim::advance, the report out.
#include <cmath>
#include <limits>

#include "app/library/convert.h"
#include "app/library/log.h"
#include "app/library/objects.h"
#include "sim/stabilization/state_validation.h"

namespace app::library {
namespace {

constexpr double kShortestStep = 1e-6;  // s: velocities of shorter ones are rounding
constexpr double kLongestStep = 0.1;    // s, as the parameter time_step allows

void readRoots(const hm_step_input& input, Hair& hair) {
  const sim::HairMesh& mesh = hair.mesh();
  if (input.roots.data) {
    checkArray(input.roots, hair.roots.size(), "roots");
    for (std::size_t c = 0; c < hair.roots.size(); ++c) hair.roots[c] = pointOf(input.roots, c, "roots");
    return;
  }
  if (input.roots.count != 0) checkArray(input.roots, hair.roots.size(), "roots");
  const Eigen::Isometry3d head = poseOf(input.head, {"head"});
  for (std::size_t c = 0; c < hair.roots.size(); ++c)
    hair.roots[c] = head * mesh.shape.positions[static_cast<std::size_t>(mesh.shape.column_first[c])];
}

void readColliders(const hm_step_input& input, Hair& hair) {
  if (input.ellipsoid_count > 0) needs(input.ellipsoids, "ellipsoids");
  hair.ellipsoids.clear();
  for (std::size_t i = 0; i < input.ellipsoid_count; ++i)
    hair.ellipsoids.push_back(ellipsoidOf(input.ellipsoids[i], {"ellipsoids", static_cast<std::ptrdiff_t>(i)}));
}

void readPins(const hm_step_input& input, Hair& hair) {
  if (input.pin_count > 0) needs(input.pins, "pins");
  hair.pins.clear();
  for (std::size_t i = 0; i < input.pin_count; ++i) {
    hair.pins.push_back(pinOf(input.pins[i], hair.mesh().vertexCount(), {"pins", static_cast<std::ptrdiff_t>(i)}));
    if (hair.mesh().isRoot(hair.pins.back().vertex))
      throw Fault{HM_ERROR_VALUE,
                  "pins[" + std::to_string(i) + "].vertex is a root, which the head carries; pin one below it"};
  }
}

void checkScalars(const hm_step_input& input) {
  if (!(input.dt >= kShortestStep)) throw Fault{HM_ERROR_VALUE, "dt is below 1e-6 s; give seconds, 1/60 for instance"};
  if (input.dt > kLongestStep) throw Fault{HM_ERROR_VALUE, "dt is above 0.1 s; take several steps"};
  if (!std::isfinite(input.time)) throw Fault{HM_ERROR_VALUE, "time is not finite; give seconds"};
  if (!(input.max_work > 0)) throw Fault{HM_ERROR_VALUE, "max_work is not above 0; INFINITY stands for no budget"};
}

void fillReport(const sim::StepReport& from, hm_report& to) {
  to.solver_iterations = from.solver_iterations;
  to.solves = from.solves;
  to.residual = from.residual;
  to.converged = from.converged;
  to.contacts = from.contacts;
  to.corrected = from.corrected;
  to.max_penetration = from.max_penetration;
  to.self_contacts = from.self_contacts;
  to.guided = from.guided;
  to.repaired = from.recoveries;
  to.carried = from.carried;
  to.pins = from.pins;
  to.pins_out_of_reach = from.pins_out_of_reach;
  to.work = from.work_units;
  to.solve_cut = from.solve_cut;
  to.corrections_cut = from.corrections_cut;
  static_assert(sizeof to.seconds / sizeof *to.seconds == sim::kStageCount);
  for (std::size_t stage = 0; stage < from.seconds.size(); ++stage) to.seconds[stage] = from.seconds[stage];
}

}  // namespace
}  // namespace app::library

using namespace app::library;

void hm_default_ellipsoid(hm_ellipsoid* ellipsoid) {
  if (ellipsoid) *ellipsoid = {kNoPose, {1, 1, 1}, {0, 0, 0}, {0, 0, 0}};
}

hm_result hm_ellipsoid_moved(hm_ellipsoid* ellipsoid, const hm_pose* before, double seconds) {
  return guarded("hm_ellipsoid_moved", [&] {
    needs(ellipsoid, "ellipsoid");
    needs(before, "before");
    if (!(seconds > 0 && std::isfinite(seconds))) throw Fault{HM_ERROR_VALUE, "seconds is not above 0"};
    const Eigen::Isometry3d from = poseOf(*before, {"before"}), to = poseOf(ellipsoid->pose, {"ellipsoid"});
    const Eigen::AngleAxisd turn(to.linear() * from.linear().transpose());
    const Vec3 velocity = (to.translation() - from.translation()) / seconds;
    const Vec3 angular = turn.angle() * turn.axis() / seconds;
    for (int k = 0; k < 3; ++k) {
      ellipsoid->velocity[k] = velocity[k];
      ellipsoid->angular_velocity[k] = angular[k];
    }
  });
}

void hm_default_step_input(hm_step_input* input) {
  if (!input) return;
  *input = {};
  input->dt = 1.0 / 60;
  input->head = kNoPose;
  input->max_work = std::numeric_limits<double>::infinity();
}

hm_result hm_hair_step(hm_hair hair, const hm_step_input* input, hm_report* report) {
  return guarded("hm_hair_step", [&] {
    const HairUse use(hair);
    needs(input, "input");
    checkScalars(*input);
    readRoots(*input, *use);
    readColliders(*input, *use);
    readPins(*input, *use);
    sim::StepInput step{use->roots, use->ellipsoids, input->time};
    step.pins = use->pins;
    step.max_work = input->max_work;
    const sim::StepReport done = sim::advance(use->mesh(), use->params, step, input->dt, use->context, use->state);
    if (report) fillReport(done, *report);
    if (done.recoveries > 0) writeLog(HM_LOG_WARNING, sim::faultText(done.fault_report).c_str());
  });
}

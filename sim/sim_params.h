// Every number that a person may turn, in one table: sliders, presets, --set, the README's table and the stress run's
// random draws all read it. A second copy of a parameter is a defect.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace sim {

// How a step is integrated in time.
enum class Integrator {
  kLinearizedEuler,  // the paper: one linearized implicit Euler step (Baraff and Witkin 1998)
  kBdf2,             // second order, two-step
  kCount
};

// How the linear systems are solved, by Modified PCG.
enum class Solver {
  kDefault,  // two-level preconditioner (linear/two_level.h), begun from earlier solutions
  kPaper,    // as published: block-diagonal preconditioner, and no safety nets (stabilization/safety_nets.h)
  kCount
};

// Arithmetic of the linear solver.
enum class Precision { kFloat, kDouble, kCount };

// What the hair collides with.
enum class ColliderKind {
  kEllipsoids,  // the paper's: ellipsoids fitted to the body
  kSdf,         // signed distance grids of the body's parts, where the scene has them
  kCount
};

// Units are SI. Stiffnesses are moduli (per volume of hair), so that a value means the same at every resolution;
// damping is a relaxation time (per second), so that it means the same at every time step.
struct SimParams {
  // Material
  double density = 60;            // kg/m^3 of the hair mesh's volume (hair and the air in it)
  double stretch_along = 4.0e5;   // Pa, walls along the hair
  double stretch_across = 6.0e3;  // Pa, walls across the hair
  double stretch_edge = 2.0e3;    // Pa, horizontal edges
  double shear = 2.5e3;           // Pa, walls
  double bend = 0.6;              // Pa m^2, hinge between consecutive walls
  double volume = 8.0e3;          // Pa, corner tetrahedra
  double damping = 0.02;          // s, stiffness-proportional, through the condition functions' rates
  double air_drag = 0.6;          // 1/s, velocity relative to the air lost per second
  // World
  double gravity = 9.81;                      // m/s^2, down
  double wind_x = 0, wind_y = 0, wind_z = 0;  // m/s
  double gust = 0;                            // share of the wind that comes and goes
  // Contact
  double friction = 0.3;           // Coulomb coefficient
  double contact_offset = 0.002;   // m, contacts are held this far off the colliders
  double max_depenetration = 2.0;  // m/s, speed at which overlaps found at spawn are resolved
  bool collide = true;
  bool collide_inner = false;  // the vertices inside the hair as well
  bool self_collide = false;   // bundles with one another
  ColliderKind collider = ColliderKind::kEllipsoids;
  bool minimize_deformation = true;
  // Rest shape
  bool sag_free = true;  // rest quantities balance gravity in the styled pose
  // Time
  double time_step = 1.0 / 60;  // s
  int max_steps_per_frame = 8;  // beyond it time slows down instead of spiralling
  double teleport_speed = 150;  // m/s, mean of the roots: beyond it the hair is carried along, for no motion made it
  // Numerics
  Integrator integrator = Integrator::kLinearizedEuler;
  Solver solver = Solver::kDefault;
  Precision precision = Precision::kFloat;
  double tolerance = 1e-2;               // relative residual of the linear solve; docs/accuracy.md shows why
  double acceleration_tolerance = 0.01;  // m/s^2, a solve also stops when no vertex's residual exceeds it
  // m, and when it estimates that no vertex would end up farther off than this, in steps shorter than 1/60 s less by
  // the square of their length
  double displacement_tolerance = 1e-6;
  int max_iterations = 40;  // of the linear solver, in a step; docs/performance.md
};

enum class FieldKind { kReal, kInteger, kSwitch, kChoice };

// One field of the table. get/set convert to and from double (a switch is 0 or 1, a choice its index).
struct ParamField {
  const char* name;
  const char* group;  // panel heading
  const char* unit;
  FieldKind kind;
  double minimum, maximum, default_value;
  bool logarithmic;  // slider and random draws in log scale
  const char* help;
  double (*get)(const SimParams&);
  void (*set)(SimParams&, double);
  std::span<const char* const> choices;  // for kChoice
};

// The table, in panel order.
std::span<const ParamField> paramFields();

// The field of that name, or nullptr.
const ParamField* findParam(std::string_view name);

// Sets a field from text (a number, "on"/"off", or a choice's name). Out-of-range and non-finite values are refused and
// change nothing. `fault` says what is wrong and what would mend it; it is empty when ok.
struct ParamText {
  bool ok = true;
  std::string fault;
};
ParamText setParam(SimParams& params, std::string_view name, std::string_view text);

// Writes a field so that setParam reads the same value back: a number's shortest exact form, "on"/"off", a choice.
std::string paramText(const ParamField& field, const SimParams& params);

}  // namespace sim

#include "sim/sim_params.h"

#include <array>
#include <cmath>
#include <vector>

#include "sim/field_text.h"

namespace sim {

namespace {

constexpr std::array<const char*, 2> kIntegrators{"linearized-euler", "bdf2"};
constexpr std::array<const char*, 2> kSolvers{"default", "paper"};
constexpr std::array<const char*, 2> kPrecisions{"float", "double"};
constexpr std::array<const char*, 2> kColliders{"ellipsoids", "sdf"};
static_assert(kIntegrators.size() == static_cast<int>(Integrator::kCount));
static_assert(kSolvers.size() == static_cast<int>(Solver::kCount));
static_assert(kPrecisions.size() == static_cast<int>(Precision::kCount));
static_assert(kColliders.size() == static_cast<int>(ColliderKind::kCount));

struct Range {
  double minimum, maximum;
  bool logarithmic = false;
};

// Builds a row from a pointer to the member, so that the default is read from SimParams{} and written nowhere twice.
template <auto Member>
ParamField field(const char* name, const char* group, const char* unit, Range range, const char* help) {
  using Value = std::remove_reference_t<decltype(SimParams{}.*Member)>;
  ParamField row{};
  row.name = name;
  row.group = group;
  row.unit = unit;
  row.kind = std::is_same_v<Value, bool> ? FieldKind::kSwitch
             : std::is_enum_v<Value>     ? FieldKind::kChoice
             : std::is_integral_v<Value> ? FieldKind::kInteger
                                         : FieldKind::kReal;
  row.minimum = range.minimum;
  row.maximum = range.maximum;
  row.logarithmic = range.logarithmic;
  row.help = help;
  row.get = [](const SimParams& params) { return static_cast<double>(params.*Member); };
  row.set = [](SimParams& params, double value) {
    if constexpr (std::is_same_v<Value, bool>) {
      params.*Member = value != 0;
    } else if constexpr (std::is_floating_point_v<Value>) {
      params.*Member = value;
    } else {
      params.*Member = static_cast<Value>(std::lround(value));
    }
  };
  row.default_value = row.get(SimParams{});
  return row;
}

template <auto Member>
ParamField toggle(const char* name, const char* group, const char* help) {
  return field<Member>(name, group, "", {0, 1}, help);
}

template <auto Member>
ParamField choice(const char* name, const char* group, std::span<const char* const> choices, const char* help) {
  ParamField row = field<Member>(name, group, "", {0, static_cast<double>(choices.size() - 1)}, help);
  row.choices = choices;
  return row;
}

std::vector<ParamField> makeTable() {
  using P = SimParams;
  constexpr bool kLog = true;
  return {
      field<&P::density>(
          "density", "Material", "kg/m^3", {5, 2000, kLog},
          "Mass per volume of the hair mesh, hair and the air in it. Heavier hair follows the head later."),
      field<&P::stretch_along>(
          "stretch_along", "Material", "Pa", {1e2, 1e8, kLog},
          "Resistance of the walls to stretching along the hair. High: strands keep their length. Never less "
          "than bears the hair's weight and the wind."),
      field<&P::stretch_across>("stretch_across", "Material", "Pa", {1, 1e6, kLog},
                                "Resistance of the walls to stretching across the hair. Low: the hair fans out."),
      field<&P::stretch_edge>("stretch_edge", "Material", "Pa", {1, 1e6, kLog},
                              "Resistance of the edges between neighbouring columns to a change of length."),
      field<&P::shear>("shear", "Material", "Pa", {1, 1e6, kLog},
                       "Resistance of the walls to shearing: one column sliding along its neighbour."),
      field<&P::bend>("bend", "Material", "Pa m^2", {1e-4, 1e3, kLog},
                      "Resistance to bending away from the style's own shape. High: the style holds."),
      field<&P::volume>(
          "volume", "Material", "Pa", {1, 1e7, kLog},
          "Resistance of the prisms to a change of volume; keeps the coat full and turns inverted prisms back."),
      field<&P::damping>("damping", "Material", "s", {0, 1},
                         "Relaxation time of internal motion. Higher: stretching and bending die out sooner."),
      field<&P::air_drag>("air_drag", "Material", "1/s", {0, 50},
                          "Share of the velocity against the air that is lost per second."),
      field<&P::gravity>("gravity", "World", "m/s^2", {0, 100}, "Downward acceleration."),
      field<&P::wind_x>("wind_x", "World", "m/s", {-40, 40}, "Wind towards the figure's left."),
      field<&P::wind_y>("wind_y", "World", "m/s", {-40, 40}, "Wind upwards."),
      field<&P::wind_z>("wind_z", "World", "m/s", {-40, 40}, "Wind towards the viewer of the front."),
      field<&P::gust>("gust", "World", "", {0, 1}, "Share of the wind that comes and goes."),
      toggle<&P::collide>("collide", "Contact", "Contacts between hair and body ellipsoids."),
      toggle<&P::collide_inner>("collide_inner", "Contact",
                                "Contacts of the vertices inside the hair as well, not only of the outer ones."),
      toggle<&P::self_collide>("self_collide", "Contact", "Contacts of the hair's bundles with one another."),
      choice<&P::collider>("collider", "Contact", kColliders,
                           "What the hair collides with: the paper's ellipsoids, or signed distances of the skin."),
      toggle<&P::minimize_deformation>(
          "minimize_deformation", "Contact",
          "After contacts are corrected, carries the other vertices along so that edges keep "
          "their shape (figure 9 of the paper shows the difference)."),
      field<&P::friction>("friction", "Contact", "", {0, 2}, "Coulomb friction coefficient of hair on the body."),
      field<&P::contact_offset>("contact_offset", "Contact", "m", {0, 0.02},
                                "Distance that contacts are held off the ellipsoids."),
      field<&P::max_depenetration>("max_depenetration", "Contact", "m/s", {0.05, 20, kLog},
                                   "Speed limit at which overlaps found at the start are resolved."),
      toggle<&P::sag_free>("sag_free", "Rest shape",
                           "Solves for rest lengths, angles and volumes that balance gravity in the styled pose."),
      field<&P::time_step>("time_step", "Time", "s", {1.0 / 1000, 1.0 / 10, kLog},
                           "Length of one simulation step. The frame rate does not matter to the motion; this does."),
      field<&P::max_steps_per_frame>("max_steps_per_frame", "Time", "", {1, 64},
                                     "More steps than this are not taken in one frame: time slows down instead."),
      field<&P::teleport_speed>("teleport_speed", "Time", "m/s", {1, 1e5, kLog},
                                "Roots that move faster within a step were teleported: the hair is carried along."),
      choice<&P::integrator>("integrator", "Numerics", kIntegrators,
                             "How a step is integrated in time; linearized-euler is the paper's."),
      choice<&P::solver>("solver", "Numerics", kSolvers,
                         "How the linear systems are solved; paper is the published step: block-diagonal "
                         "preconditioner and no safety nets."),
      choice<&P::precision>("precision", "Numerics", kPrecisions, "Arithmetic of the linear solver."),
      // What a solve may leave undone comes again every step, as jitter: the upper ends are where that begins to show
      // (0.01 mm a step, 0.1 m/s^2, 1 cm/s). Beyond them hair never came to rest.
      field<&P::tolerance>("tolerance", "Numerics", "", {1e-12, 0.1, kLog},
                           "Relative residual at which the linear solver stops."),
      field<&P::max_iterations>("max_iterations", "Numerics", "", {10, 5000, kLog},
                                "Iterations of the linear solver after which a step ends in any case."),
      field<&P::acceleration_tolerance>(
          "acceleration_tolerance", "Numerics", "m/s^2", {1e-9, 0.1, kLog},
          "A linear solve also stops when no vertex's residual, as an acceleration, exceeds this."),
      field<&P::displacement_tolerance>("displacement_tolerance", "Numerics", "m", {1e-9, 1e-5, kLog},
                                        "The default solver also stops when the preconditioner estimates that no "
                                        "vertex would end farther off than this; in steps below 1/60 s, less by the "
                                        "square of their length."),
  };
}

std::string rangeText(const ParamField& row) {
  std::string text = numberText(row.minimum) + " to " + numberText(row.maximum);
  if (*row.unit) text += std::string(" ") + row.unit;
  return text;
}

std::string choiceText(const ParamField& row) {
  std::string text;
  for (const char* name : row.choices) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

// Choices that are no more, and what takes their place.
struct Retired {
  std::string_view field, choice, now;
};
constexpr Retired kRetired[] = {
    {"solver", "warped", "default"},       {"solver", "two-level", "default"},
    {"solver", "direct", "default"},       {"solver", "diagonal", "paper"},
    {"solver", "block-jacobi", "default"}, {"solver", "column", "default"},
    {"solver", "incomplete", "default"},   {"integrator", "implicit-euler", "linearized-euler"},
    {"precision", "mixed", "float"}};

ParamText refuse(const ParamField& row, std::string_view text, const std::string& mend) {
  return {false, std::string(row.name) + " cannot be '" + std::string(text.substr(0, 40)) + "'; " + mend};
}

std::string choiceHint(const ParamField& row, std::string_view text) {
  std::string hint = "choose one of " + choiceText(row);
  for (const Retired& retired : kRetired) {
    if (retired.field == row.name && retired.choice == text)
      hint += "; it is no more, " + std::string(retired.now) + " takes its place";
  }
  return hint;
}

}  // namespace

std::span<const ParamField> paramFields() {
  static const std::vector<ParamField> table = makeTable();
  return table;
}

const ParamField* findParam(std::string_view name) {
  for (const ParamField& row : paramFields()) {
    if (name == row.name) return &row;
  }
  return nullptr;
}

ParamText setParam(SimParams& params, std::string_view name, std::string_view text) {
  const ParamField* row = findParam(name);
  if (!row) {
    std::vector<std::string_view> names;
    for (const ParamField& known : paramFields()) names.emplace_back(known.name);
    return {false,
            "no simulation parameter is called '" + std::string(name.substr(0, 40)) + "'; " + nameHint(name, names)};
  }
  double value = 0;
  switch (row->kind) {
    case FieldKind::kSwitch: {
      bool on = false;
      if (!parseSwitch(text, on)) return refuse(*row, text, "write on or off");
      value = on;
      break;
    }
    case FieldKind::kChoice: {
      std::size_t index = 0;
      while (index < row->choices.size() && text != row->choices[index]) ++index;
      if (index == row->choices.size()) return refuse(*row, text, choiceHint(*row, text));
      value = static_cast<double>(index);
      break;
    }
    case FieldKind::kInteger:
    case FieldKind::kReal: {
      const bool whole = row->kind == FieldKind::kInteger;
      if (!parseNumber(text, value) || (whole && value != std::floor(value))) {
        return refuse(*row, text,
                      std::string("write a ") + (whole ? "whole number" : "number") + " from " + rangeText(*row));
      }
      if (value < row->minimum || value > row->maximum) return refuse(*row, text, "the range is " + rangeText(*row));
      break;
    }
  }
  row->set(params, value);
  return {};
}

std::string paramText(const ParamField& row, const SimParams& params) {
  const double value = row.get(params);
  switch (row.kind) {
    case FieldKind::kSwitch:
      return value != 0 ? "on" : "off";
    case FieldKind::kChoice:
      return row.choices[static_cast<std::size_t>(value)];
    case FieldKind::kInteger:
    case FieldKind::kReal:
      break;
  }
  return numberText(value);
}

}  // namespace sim

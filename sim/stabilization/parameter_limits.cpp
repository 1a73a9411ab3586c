#include "sim/stabilization/parameter_limits.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace sim {

double windLoad(const SimParams& params) {
  // Gusts come on top of the wind, by as much as it is.
  return params.air_drag * (1 + params.gust) * std::hypot(params.wind_x, params.wind_y, params.wind_z);
}

SimParams limitedParameters(const HairMesh& mesh, SimParams params) {
  if (params.solver == Solver::kPaper) return params;
  if (params.volume <= 0 && params.stretch_along <= 0) return params;
  double load = windLoad(params);
  if (load > kMaxWindLoad) {
    for (double* wind : {&params.wind_x, &params.wind_y, &params.wind_z}) *wind *= kMaxWindLoad / load;
    load = kMaxWindLoad;
  }
  const double stress = params.density * (params.gravity + load) * mesh.hair_length;
  params.stretch_along = std::max(params.stretch_along, stress / kMaxLoadStrain);
  return params;
}

std::vector<LimitedValue> limitedValues(const HairMesh& mesh, const SimParams& params) {
  const SimParams limited = limitedParameters(mesh, params);
  std::vector<LimitedValue> values;
  for (const ParamField& field : paramFields()) {
    const double used = field.get(limited);
    if (used == field.get(params)) continue;
    const bool stiffness = std::string_view(field.name) == "stretch_along";
    values.push_back({&field, used,
                      !stiffness              ? "with this air drag and gust, more would only crush the hair"
                      : windLoad(limited) > 0 ? "to bear the hair's weight and the wind"
                                              : "to bear the hair's weight"});
  }
  return values;
}

}  // namespace sim

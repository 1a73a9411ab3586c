#include "sim/stabilization/parameter_limits.h"

#include <algorithm>
#include <cmath>

namespace sim {

double windLoad(const SimParams& params) {
  // Gusts come on top of the wind, by as much as it is.
  return params.air_drag * (1 + params.gust) * std::hypot(params.wind_x, params.wind_y, params.wind_z);
}

SimParams limitedParameters(const HairMesh& mesh, SimParams params) {
  if (params.volume <= 0 && params.stretch_along <= 0) return params;
  double blow = windLoad(params);
  if (blow > kMaxWindLoad) {
    for (double* wind : {&params.wind_x, &params.wind_y, &params.wind_z}) *wind *= kMaxWindLoad / blow;
    blow = kMaxWindLoad;
  }
  const double stress = params.density * (params.gravity + blow) * mesh.hair_length;
  params.stretch_along = std::max(params.stretch_along, stress / kMaxLoadStrain);
  return params;
}

}  // namespace sim

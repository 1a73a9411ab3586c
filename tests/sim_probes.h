// What tests and benchmarks ask of the simulator's values beyond what the simulator itself does.
#pragma once

#include <utility>
#include <vector>

#include "sim/contact/colliders.h"
#include "sim/forces/rest_balance.h"
#include "sim/mesh/field_bytes.h"
#include "sim/mesh/hair_state.h"
#include "sim/stabilization/parameter_limits.h"
#include "sim/step.h"

namespace test {

// (p/r)^2 - 1 in the local frame: negative inside. Not a distance.
inline double implicitValue(const sim::Ellipsoid& e, const sim::Vec3& p) {
  const sim::Vec3 local = (e.rotation.conjugate() * (p - e.center)).cwiseQuotient(e.radii);
  return local.squaredNorm() - 1;
}

// The force model of these parameters, as Material::set makes it.
inline sim::ForceModel<double> makeForceModel(const sim::HairMesh& mesh, const sim::BlockPattern& pattern,
                                              const sim::SimParams& params) {
  sim::Material material(mesh, pattern);
  material.set(params);
  return std::move(material.model);
}

// A force model in another precision.
template <class T>
sim::ForceModel<T> convertModel(const sim::ForceModel<double>& model) {
  sim::ForceModel<T> out;
  model.forEach([&]<class Kind>(const sim::Elements<Kind, double>& from) {
    sim::convertElements(from, out.template of<Kind>());
  });
  return out;
}

// Every field of two states, memory included, by its bits: NaN is itself, and 0 is not -0.
inline bool sameBits(const sim::HairState& a, const sim::HairState& b) {
  sim::Bytes one, other;
  sim::writeBytes(a, one);
  sim::writeBytes(b, other);
  return one == other;
}

// Kinetic, elastic and gravitational energy of a state (J); gravity's zero is at y = 0. `context` keeps what is derived
// from the parameters.
inline double mechanicalEnergy(const sim::HairMesh& mesh, const sim::SimParams& asked, sim::StepContext& context,
                               const sim::HairState& state) {
  const sim::SimParams params = context.safetyNets().parameter_limits ? sim::limitedParameters(mesh, asked) : asked;
  sim::Material& material = context.material();
  if (!material.memory().known || !sim::sameMaterial(params, material.memory().params)) material.set(params);
  std::vector<sim::V3<double>> x;
  for (const sim::Vec3& p : state.positions) x.push_back({p.x(), p.y(), p.z()});
  double energy = sim::evaluate<double>(material.model, x, {});
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    const double specific = 0.5 * state.velocities[i].squaredNorm() + params.gravity * state.positions[i].y();
    energy += params.density * mesh.vertex_volume[i] * specific;
  }
  return energy;
}

}  // namespace test

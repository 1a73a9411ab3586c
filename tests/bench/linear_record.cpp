#include "tests/bench/linear_record.h"

#include <algorithm>

#include "app/files/errors.h"
#include "sim/implicit_solve.h"
#include "tests/bench/preconditioners/preconditioner.h"
#include "tests/block_product.h"
#include "tests/sim_probes.h"

namespace bench {
namespace {

Vector3 plain(const sim::Vec3& p) {
  return {p.x(), p.y(), p.z()};
}
Vector3 times(const Eigen::Matrix3d& m, const Vector3& p) {
  return plain(m * sim::Vec3(p.x, p.y, p.z));
}

// The exact solution: conjugate gradients with the factor of the matrix itself, until rounding stops them.
void solveExactly(const RecordedMesh& shared, LinearRecord& record) {
  Preconditioner<double> factor(shared.mesh, shared.pattern, Kind::kDirect);
  factor.update(record.matrix, record.positions, record.constraints);
  sim::Filter<double> filter;
  for (int i = 0; i < shared.mesh.vertexCount(); ++i) {
    if (record.keep[i].isIdentity(0)) continue;
    filter.vertices.push_back(i);
    sim::M3<double> keep;
    for (int k = 0; k < 9; ++k) keep.m[k] = record.keep[i](k / 3, k % 3);
    filter.keep.push_back(keep);
  }
  sim::SolverScratch<double> scratch;
  scratch.resize(shared.mesh.vertexCount());
  sim::StopRule<double> stop;
  stop.relative = 1e-14;
  stop.max_iterations = 200;
  record.solution = record.guess;
  const auto a = [&](std::span<const Vector3> d, std::span<Vector3> q) { sim::multiply<double>(record.matrix, d, q); };
  sim::solveModifiedPcg<double>(a, record.rhs, filter, factor, stop, scratch, record.solution);
}

LinearRecord recordStep(const RecordedMesh& shared, sim::ImplicitSolver<double>& solver, const sim::SimParams& params,
                        const sim::StepInput& input, sim::HairState state) {
  const sim::HairMesh& mesh = shared.mesh;
  sim::carryContacts({input.ellipsoids}, params, shared.h, state);
  for (int c = 0; c < mesh.columnCount(); ++c) {
    const int root = mesh.shape.column_first[c];
    state.velocities[root] = (input.roots[c] - state.positions[root]) / shared.h;
  }
  LinearRecord record;
  for (const sim::Vec3& p : state.positions) record.positions.push_back(plain(p - state.positions[0]));
  for (const sim::Vec3& v : state.velocities) record.guess.push_back(plain(v));
  sim::StepReport report;
  sim::StageClock no_clock;
  solver.solve(mesh, params, {state.positions, state.velocities, shared.h}, no_clock, state.contacts,
               state.memory.solve, state.velocities, report);
  record.column_values = solver.matrix.values;
  record.matrix = sim::BlockMatrix<double>(&shared.pattern);
  toBlocks(mesh, solver.matrix, record.matrix);
  record.rhs = solver.trial;
  record.constraints = solver.constraints;
  record.keep.assign(mesh.vertexCount(), Eigen::Matrix3d::Identity());
  for (int c = 0; c < mesh.columnCount(); ++c) record.keep[mesh.shape.column_first[c]].setZero();
  for (const sim::VertexConstraint& constraint : record.constraints) {
    record.keep[constraint.vertex] = constraint.keep;
    Vector3& v = record.guess[constraint.vertex];
    v = times(constraint.keep, v) + plain(constraint.prescribed);
  }
  solveExactly(shared, record);
  return record;
}

}  // namespace

RecordedMesh::RecordedMesh(const sim::HairMesh& m, const sim::SimParams& params)
    : mesh(m), pattern(sim::systemPattern(m)), layout(m), columns(m, layout), h(params.time_step) {
  for (const double volume : m.vertex_volume) mass.push_back(params.density * volume);
}

RecordedSystems recordSystems(const std::string& scene, const std::vector<int>& steps) {
  const auto scenes = trajectoryScenes();
  const auto found = std::find_if(scenes.begin(), scenes.end(), [&](const auto& s) { return s.name == scene; });
  if (found == scenes.end()) throw app::InputError(scene, "", "is no scene of the benchmark", "choose another");
  RecordedSystems systems;
  systems.scene = scene;
  systems.stage = std::make_unique<TrajectoryStage>(*found);
  const sim::SimParams params;
  systems.shared = std::make_unique<RecordedMesh>(systems.stage->mesh(), params);
  sim::SimParams exact = params;
  exact.precision = sim::Precision::kDouble;
  exact.tolerance = 1e-10;
  exact.acceleration_tolerance = exact.displacement_tolerance = 0;
  const RecordedMesh& shared = *systems.shared;
  sim::ImplicitSolver<double> solver(shared.mesh);
  solver.setModel(shared.mesh, test::makeForceModel(shared.mesh, shared.pattern, params), params.density);
  systems.stage->visitSteps(params, [&](int step, const sim::StepInput& input, const sim::HairState& state) {
    if (!std::count(steps.begin(), steps.end(), step)) return;
    systems.records.push_back(recordStep(shared, solver, exact, input, state));
    systems.records.back().name = scene + " step " + std::to_string(step);
  });
  return systems;
}

std::vector<Vector3> residualOf(const LinearRecord& record, const std::vector<Vector3>& x) {
  std::vector<Vector3> r(x.size());
  sim::multiply<double>(record.matrix, x, r);
  for (std::size_t i = 0; i < x.size(); ++i) r[i] = times(record.keep[i], record.rhs[i] - r[i]);
  return r;
}

}  // namespace bench

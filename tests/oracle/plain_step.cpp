// x: positions, v: velocities, A v = b: the system of Baraff and Witkin (1998), equation 6 written for v at the step's
// end; see sim/implicit_solve.h for A and b.
#include "tests/oracle/plain_step.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>

#include "sim/contact/contact.h"
#include "tests/block_product.h"
#include "tests/oracle/plain_contact.h"
#include "tests/sim_probes.h"

namespace oracle {
namespace {

using sim::Contact;
using sim::HairMesh;
using sim::HairState;
using sim::SimParams;
using sim::StepInput;
using sim::Vec3;
using Vectors = std::vector<sim::V3<double>>;
using Triplets = std::vector<Eigen::Triplet<double>>;

constexpr int kContactRounds = 4;
constexpr double kCreep = 1e-3, kNoSlip = 1e-9;  // m/s, slip that says nothing of its direction
constexpr double kThrownBack = 0.5;              // m/s

Vectors toPlain(const std::vector<Vec3>& from) {
  Vectors to;
  for (const Vec3& p : from) to.push_back({p.x(), p.y(), p.z()});
  return to;
}
Vec3 toEigen(const sim::V3<double>& p) {
  return {p.x, p.y, p.z};
}
Eigen::Matrix3d toEigen(const sim::M3<double>& m) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(m.m);
}

Vec3 windAt(const SimParams& params, double time) {
  const double gust = params.gust * (0.6 * std::sin(2.1 * time) + 0.4 * std::sin(5.3 * time + 1.7));
  return (1 + gust) * Vec3(params.wind_x, params.wind_y, params.wind_z);
}

// A v = b without constraints; A into context.matrix.
std::vector<Vec3> assemble(const HairMesh& mesh, const SimParams& params, const StepInput& input, double h,
                           PlainContext& context, const HairState& state) {
  const Vectors x = toPlain(state.positions);
  Vectors force(x.size(), {0, 0, 0});
  context.matrix.setZero();
  sim::Evaluation<double> out;
  out.force = force;
  out.matrix = &context.matrix;
  out.matrix_scale = h * (h + params.damping);
  out.tension_scale = h * h;
  sim::evaluate<double>(context.model, x, out);
  const Vec3 wind = windAt(params, input.time), gravity(0, -params.gravity, 0);
  std::vector<Vec3> b(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double m = params.density * mesh.vertex_volume[i];
    b[i] = m * state.velocities[i] + h * (toEigen(force[i]) + m * (gravity + params.air_drag * wind));
    for (int k = 0; k < 9; k += 4) context.matrix.diagonal[i].m[k] += (1 + h * params.air_drag) * m;
  }
  return b;
}

// The free directions of each vertex: v = prescribed + basis y, with the unknowns y of all vertices stacked.
struct FreeDirections {
  struct Vertex {
    Eigen::Matrix3d basis = Eigen::Matrix3d::Identity();  // columns; zero from `count` on
    Vec3 prescribed = Vec3::Zero();
    int count = 3, first = 0;  // of its unknowns
  };
  std::vector<Vertex> vertices;
  int unknowns = 0;
};

FreeDirections freeDirections(const HairMesh& mesh, const std::vector<Contact>& contacts,
                              const std::vector<Vec3>& velocities) {
  FreeDirections free;
  free.vertices.resize(mesh.vertexCount());
  for (int i = 0; i < mesh.vertexCount(); ++i) {
    if (mesh.isRoot(i)) free.vertices[i] = {Eigen::Matrix3d::Zero(), velocities[i], 0};
  }
  std::vector<sim::VertexConstraint> constraints;
  sim::constrainContacts(contacts, constraints);
  for (const sim::VertexConstraint& constraint : constraints) {
    const Vec3 &a = constraint.directions[0], &b = constraint.directions[1];
    Eigen::Matrix3d basis = Eigen::Matrix3d::Zero();
    if (constraint.removed == 1) {
      basis.col(0) = a.unitOrthogonal();
      basis.col(1) = a.cross(Vec3(basis.col(0)));
    } else if (constraint.removed == 2) {
      basis.col(0) = a.cross(b).normalized();
    }
    free.vertices[constraint.vertex] = {basis, constraint.prescribed, 3 - constraint.removed};
  }
  for (FreeDirections::Vertex& vertex : free.vertices) {
    vertex.first = free.unknowns;
    free.unknowns += vertex.count;
  }
  return free;
}

void addTriplets(const FreeDirections::Vertex& i, const FreeDirections::Vertex& j, const sim::M3<double>& block,
                 Triplets& triplets) {
  const Eigen::Matrix3d reduced = i.basis.transpose() * toEigen(block) * j.basis;
  for (int row = 0; row < i.count; ++row) {
    for (int column = 0; column < j.count; ++column) {
      triplets.emplace_back(i.first + row, j.first + column, reduced(row, column));
    }
  }
}

// The matrix over the free directions, its lower triangle, which is what Eigen's ConjugateGradient reads.
Eigen::SparseMatrix<double> eliminated(const sim::BlockMatrix<double>& matrix, const FreeDirections& free) {
  const sim::BlockPattern& pattern = *matrix.pattern;
  Triplets triplets;
  triplets.reserve(9 * (matrix.diagonal.size() + matrix.lower.size()));
  for (int i = 0; i < pattern.size; ++i) {
    for (int k = pattern.row_first[i]; k < pattern.row_first[i + 1]; ++k) {
      addTriplets(free.vertices[i], free.vertices[pattern.columns[k]], matrix.lower[k], triplets);
    }
    addTriplets(free.vertices[i], free.vertices[i], matrix.diagonal[i], triplets);
  }
  Eigen::SparseMatrix<double> a(free.unknowns, free.unknowns);
  a.setFromTriplets(triplets.begin(), triplets.end());
  return a;
}

std::vector<Vec3> residual(const sim::BlockMatrix<double>& matrix, const std::vector<Vec3>& b,
                           const std::vector<Vec3>& v) {
  Vectors product(v.size());
  sim::multiply<double>(matrix, toPlain(v), product);
  std::vector<Vec3> r(v.size());
  for (std::size_t i = 0; i < v.size(); ++i) r[i] = b[i] - toEigen(product[i]);
  return r;
}

// What slid goes on sliding until its slip has turned; any other contact sticks when its friction could stop it within
// the step.
void chooseSticking(const HairMesh& mesh, const SimParams& params, double h, HairState& state) {
  for (Contact& contact : state.contacts) {
    Vec3 slip = state.velocities[contact.vertex] - contact.velocity;
    slip -= slip.dot(contact.normal) * contact.normal;
    const bool slid = !contact.sticks && contact.friction_direction.norm() > 0;
    const double mass = params.density * mesh.vertex_volume[contact.vertex];
    contact.sticks =
        slid ? slip.dot(contact.friction_direction) >= 0 : slip.norm() <= params.friction * contact.pressure * h / mass;
    contact.sticks = contact.sticks && contact.pressure > 0;
    if (contact.sticks || contact.pressure <= 0) contact.friction_direction.setZero();
    if (contact.sticks) continue;
    const double least = contact.friction_direction.norm() > 0 ? kCreep : kNoSlip;
    if (slip.norm() > least) contact.friction_direction = -slip.normalized();
    contact.friction_direction -= contact.friction_direction.dot(contact.normal) * contact.normal;
    if (contact.friction_direction.norm() > 0) contact.friction_direction.normalize();
  }
}

// Friction of the sliding contacts by the pressure of the last solve.
void addKineticFriction(const SimParams& params, double h, const HairState& state, std::vector<Vec3>& b) {
  for (const Contact& contact : state.contacts) {
    if (!contact.sticks && contact.pressure > 0)
      b[contact.vertex] += h * params.friction * contact.pressure * contact.friction_direction;
  }
}

// Lets those slide that friction cannot hold or that pull while they stick, and lets go of those that pull while they
// slide. Friction that throws a vertex back faster than kThrownBack holds it for the rest of the step. Returns whether
// any changed.
bool updateContacts(const HairMesh& mesh, const SimParams& params, double h, const std::vector<Vec3>& r,
                    const std::vector<Vec3>& v, std::vector<Contact>& contacts) {
  bool changed = false;
  for (Contact& contact : contacts) {
    const Vec3 reaction = -r[contact.vertex] / h;
    const double pressed = contact.pressure;
    contact.pressure = contact.normal.dot(reaction);
    const Vec3 along = reaction - contact.pressure * contact.normal;
    const bool pulls = contact.pressure < 0;
    const bool beyond = along.norm() > params.friction * contact.pressure;
    if (!contact.sticks) {
      const double work =
          h * params.friction * pressed * contact.friction_direction.dot(v[contact.vertex] - contact.velocity);
      const double mass = params.density * mesh.vertex_volume[contact.vertex];
      if (pressed <= 0 || pulls || work <= 0.5 * mass * kThrownBack * kThrownBack) continue;
      contact.sticks = true;
    } else if (pulls) {
      contact.pressure = 0;
      contact.sticks = false;
    } else if (beyond && contact.friction_direction.norm() == 0) {
      contact.pressure = std::min(contact.pressure, pressed);
      contact.friction_direction = along.normalized();
      contact.sticks = false;
    } else {
      continue;
    }
    changed = true;
  }
  return std::erase_if(contacts, [](const Contact& c) { return c.pressure < 0; }) > 0 || changed;
}

// Solves for the velocities at the step's end, in rounds while contacts release or start to slide. Each round solves
// for the change of velocity, so that the tolerance refers to what was wrong at first.
void solveVelocities(const HairMesh& mesh, const SimParams& params, double h, const std::vector<Vec3>& b,
                     PlainContext& context, HairState& state, sim::StepReport& report) {
  chooseSticking(mesh, params, h, state);
  std::vector<Vec3> v = state.velocities;
  double first_norm = 0;
  for (int round = 0; round < kContactRounds; ++round) {
    std::vector<Vec3> pushed = b;
    addKineticFriction(params, h, state, pushed);
    const FreeDirections free = freeDirections(mesh, state.contacts, state.velocities);
    for (std::size_t i = 0; i < v.size(); ++i) {
      const FreeDirections::Vertex& at = free.vertices[i];
      v[i] = at.prescribed + at.basis * Vec3(at.basis.transpose() * v[i]);
    }
    const std::vector<Vec3> r = residual(context.matrix, pushed, v);
    Eigen::VectorXd rhs(free.unknowns);
    for (std::size_t i = 0; i < v.size(); ++i) {
      const FreeDirections::Vertex& at = free.vertices[i];
      rhs.segment(at.first, at.count) = Vec3(at.basis.transpose() * r[i]).head(at.count);
    }
    if (round == 0) first_norm = rhs.norm();
    const Eigen::SparseMatrix<double> a = eliminated(context.matrix, free);
    Eigen::ConjugateGradient<Eigen::SparseMatrix<double>> solver;
    solver.setTolerance(rhs.norm() > 0 ? params.tolerance * first_norm / rhs.norm() : params.tolerance);
    const Eigen::VectorXd change = solver.compute(a).solve(rhs);
    report.solver_iterations += static_cast<int>(solver.iterations());
    report.residual = solver.error() * rhs.norm() / std::max(first_norm, 1e-300);
    report.converged = solver.info() == Eigen::Success;
    for (std::size_t i = 0; i < v.size(); ++i) {
      const FreeDirections::Vertex& at = free.vertices[i];
      v[i] += at.basis.leftCols(at.count) * change.segment(at.first, at.count);
    }
    if (state.contacts.empty()) break;
    const std::vector<Vec3> left = residual(context.matrix, b, v);
    if (!updateContacts(mesh, params, h, left, v, state.contacts)) break;
  }
  state.velocities = v;
}

}  // namespace

PlainContext::PlainContext(const HairMesh& mesh, double (*c)())
    : clock(c), pattern(sim::systemPattern(mesh)), matrix(&pattern) {}

sim::StepReport plainAdvance(const HairMesh& mesh, const SimParams& params, const StepInput& input, double dt,
                             PlainContext& context, HairState& state) {
  sim::StepReport report;
  double started = context.clock ? context.clock() : 0;
  const auto spent = [&](sim::Stage stage) {
    if (!context.clock) return;
    const double now = context.clock();
    report.seconds[stage] += now - started;
    started = now;
  };
  if (!context.made_for || !sim::sameMaterial(params, *context.made_for)) {
    context.model = test::makeForceModel(mesh, context.pattern, params);
    context.made_for = params;
  }
  const std::vector<Vec3> start = state.positions;
  sim::carryContacts({input.ellipsoids}, params, dt, state);
  std::vector<Vec3> b = assemble(mesh, params, input, dt, context, state);
  for (int c = 0; c < mesh.columnCount(); ++c) {
    const int root = mesh.shape.column_first[c];
    state.velocities[root] = (input.roots[c] - state.positions[root]) / dt;
  }
  spent(sim::kStageForces);
  solveVelocities(mesh, params, dt, b, context, state, report);
  spent(sim::kStageSolve);
  for (std::size_t i = 0; i < state.positions.size(); ++i) state.positions[i] += dt * state.velocities[i];
  for (int c = 0; c < mesh.columnCount(); ++c) state.positions[mesh.shape.column_first[c]] = input.roots[c];
  spent(sim::kStageOther);
  if (params.collide) resolvePenetrations(mesh, params, input, dt, start, state, report);
  spent(sim::kStageCollision);
  report.contacts = static_cast<int>(state.contacts.size());
  return report;
}

}  // namespace oracle

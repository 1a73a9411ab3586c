#include "tests/oracle/plain_contact.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>

#include "sim/contact/contact.h"

namespace oracle {
namespace {

using sim::Contact;
using sim::HairMesh;
using sim::HairState;
using sim::Penetration;
using sim::SimParams;
using sim::StepInput;
using sim::Vec3;

constexpr double kFastestFollower = 10;  // m/s that a vertex takes from following a corrected one
constexpr int kCorrectionRounds = 4;
constexpr double kMinimizationTolerance = 1e-3;

// Every edge of the hair mesh once.
std::vector<std::pair<int, int>> edgesOf(const HairMesh& mesh) {
  std::vector<std::pair<int, int>> edges;
  const auto add = [&](int a, int b) { edges.emplace_back(std::min(a, b), std::max(a, b)); };
  for (const sim::Prism& prism : mesh.prisms) {
    const int n = prism.corner_count;
    for (int k = 0; k < n; ++k) {
      add(prism.v[k], prism.v[(k + 1) % n]);
      add(prism.v[n + k], prism.v[n + (k + 1) % n]);
      add(prism.v[k], prism.v[n + k]);
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

// Moves the vertices that are not held so that edge vectors change least: Laplace's equation for the displacements.
int minimizeDeformation(const HairMesh& mesh, const std::vector<char>& held, const std::vector<Vec3>& displacement,
                        std::vector<Vec3>& positions) {
  std::vector<int> unknown(held.size(), -1);
  int count = 0;
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (!held[i]) unknown[i] = count++;
  }
  std::vector<Eigen::Triplet<double>> triplets;
  Eigen::MatrixX3d rhs = Eigen::MatrixX3d::Zero(count, 3);
  const auto addRow = [&](int i, int j) {
    if (held[i]) return;
    triplets.emplace_back(unknown[i], unknown[i], 1.0);
    if (held[j])
      rhs.row(unknown[i]) += displacement[j].transpose();
    else
      triplets.emplace_back(unknown[i], unknown[j], -1.0);
  };
  for (const auto& [a, b] : edgesOf(mesh)) addRow(a, b), addRow(b, a);
  if (rhs.isZero(0)) return 0;
  Eigen::SparseMatrix<double> laplacian(count, count);
  laplacian.setFromTriplets(triplets.begin(), triplets.end());
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>> solver;
  solver.setTolerance(kMinimizationTolerance);
  const Eigen::MatrixX3d moved = solver.compute(laplacian).solve(rhs);
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (!held[i]) positions[i] += moved.row(unknown[i]).transpose();
  }
  return static_cast<int>(solver.iterations());
}

// A corrected vertex keeps the collider's normal velocity and loses tangential speed to friction; the new contact
// constrains the next solve.
void enterContact(const SimParams& params, const StepInput& input, const Penetration& hit, HairState& state) {
  Vec3& v = state.velocities[hit.vertex];
  const Vec3 relative = v - sim::surfaceVelocity(input.ellipsoids[hit.collider], hit.target);
  const double approach = -relative.dot(hit.normal);
  if (approach > 0) {
    const Vec3 slip = relative + approach * hit.normal;
    const double speed = slip.norm();
    v += approach * hit.normal;
    if (speed > 0) v -= slip * std::min(1.0, params.friction * approach / speed);
  }
  const bool known = std::any_of(state.contacts.begin(), state.contacts.end(), [&](const Contact& c) {
    return c.vertex == hit.vertex && c.collider == hit.collider;
  });
  if (known) return;
  Contact contact;
  contact.vertex = hit.vertex;
  contact.collider = hit.collider;
  contact.normal = hit.normal;
  state.contacts.push_back(contact);
}

}  // namespace

void resolvePenetrations(const HairMesh& mesh, const SimParams& params, const StepInput& input, double dt,
                         const std::vector<Vec3>& start, HairState& state, sim::StepReport& report) {
  const sim::ContactSearch search{
      mesh.external_vertices, {input.ellipsoids}, start, dt, sim::contactMargins(params, dt)};
  std::vector<Penetration> found;
  sim::ContactScratch scratch;
  const auto find = [&] { sim::findPenetrations(search, state.positions, scratch, found); };
  find();
  if (found.empty()) return;
  for (const Penetration& hit : found) report.max_penetration = std::max(report.max_penetration, hit.depth);
  std::vector<char> held(mesh.vertexCount(), 0);
  for (int i = 0; i < mesh.vertexCount(); ++i) held[i] = mesh.isRoot(i);
  for (const Contact& contact : state.contacts) held[contact.vertex] = 1;
  const std::vector<Vec3> uncorrected = state.positions;
  double follow_speed = 0;
  for (int round = 0; round <= kCorrectionRounds; ++round) {
    std::vector<Vec3> displacement(mesh.vertexCount(), Vec3::Zero());
    int corrected = 0;
    for (const Penetration& hit : found) {
      if (!hit.initial_overlap) follow_speed = std::max(follow_speed, std::min(hit.depth / dt, kFastestFollower));
      if (hit.depth > search.margins.slack || hit.initial_overlap) {
        displacement[hit.vertex] = hit.target - state.positions[hit.vertex];
        held[hit.vertex] = 1;
        state.positions[hit.vertex] = hit.target;
        ++corrected;
      }
      enterContact(params, input, hit, state);
    }
    report.corrected += corrected;
    if (corrected == 0 || round == kCorrectionRounds) break;
    if (params.minimize_deformation) {
      report.minimization_iterations += minimizeDeformation(mesh, held, displacement, state.positions);
    }
    find();
  }
  for (int i = 0; i < mesh.vertexCount(); ++i) {
    const Vec3 moved = state.positions[i] - uncorrected[i];
    const double speed = moved.norm() / dt;
    if (held[i] || speed <= 0) continue;
    state.velocities[i] += moved / dt * std::min(1.0, follow_speed / speed);
  }
  std::sort(state.contacts.begin(), state.contacts.end(), [](const Contact& a, const Contact& b) {
    return a.vertex != b.vertex ? a.vertex < b.vertex : a.collider < b.collider;
  });
}

}  // namespace oracle

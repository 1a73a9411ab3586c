// Real system matrices of a combed hair mesh, constrained problems on them and their dense solutions.
#pragma once

#include <gtest/gtest.h>

#include "sim/forces/model.h"
#include "sim/linear/modified_pcg.h"
#include "tests/bench/preconditioners/preconditioner.h"
#include "tests/block_product.h"
#include "tests/sim_probes.h"
#include "tests/test_meshes.h"

namespace tests {

using bench::Kind;
using sim::BlockMatrix;
using sim::Filter;
using sim::M3;
using sim::V3;
using sim::Vec3;

constexpr double kStep = 1.0 / 60, kDamping = 0.02;

template <class T>
M3<T> plainMatrix(const Eigen::Matrix3d& m) {
  M3<T> out;
  for (int k = 0; k < 9; ++k) out.m[k] = static_cast<T>(m(k / 3, k % 3));
  return out;
}

// A real system matrix, M + h (h + tau) K + h^2 T, of a combed hair mesh.
struct System {
  sim::HairMesh mesh;
  sim::BlockPattern pattern;
  sim::ForceModel<double> model;
  std::vector<Vec3> positions;  // where the matrix was taken

  explicit System(double noise, const Eigen::Quaterniond& turn = Eigen::Quaterniond::Identity()) {
    test::PatchOptions o;
    o.mixed = o.uneven = true;
    mesh = sim::buildHairMesh(test::combedShape(o));
    pattern = sim::systemPattern(mesh);
    sim::SimParams params = test::tautHair();
    params.sag_free = false;
    model = test::makeForceModel(mesh, pattern, params);
    test::Random random(11);
    for (const Vec3& p : mesh.shape.positions) positions.push_back(turn * Vec3(p + random.vector(noise)));
  }

  template <class T>
  BlockMatrix<T> matrixAt(const std::vector<Vec3>& x) const {
    BlockMatrix<T> a(&pattern);
    a.setZero();
    sim::Evaluation<T> out;
    out.matrix = &a;
    out.matrix_scale = static_cast<T>(kStep * (kStep + kDamping));
    out.tension_scale = static_cast<T>(kStep * kStep);
    const auto points = test::plain<T>(x);
    sim::evaluate<T>(test::convertModel<T>(model), points, out);
    for (int i = 0; i < mesh.vertexCount(); ++i) {
      for (int k = 0; k < 9; k += 4) a.diagonal[i].m[k] += static_cast<T>(60 * mesh.vertex_volume[i]);
    }
    return a;
  }
  template <class T>
  bench::Preconditioner<T> preconditioner(const BlockMatrix<T>& a, Kind kind,
                                          std::span<const sim::VertexConstraint> constraints = {}) const {
    bench::Preconditioner<T> p(mesh, pattern, kind);
    EXPECT_TRUE(p.update(a, test::plain<T>(positions), constraints)) << "the factorization failed";
    return p;
  }
};

// What is asked of one solve: right-hand side, first guess (its removed part is the prescribed value), projectors.
struct Problem {
  std::vector<Vec3> rhs, guess;
  std::vector<Eigen::Matrix3d> keep;               // per vertex
  std::vector<sim::VertexConstraint> constraints;  // the same of the vertices that are not roots
};

// Roots are pinned; every other vertex has `removed` directions taken, or a random number of them when it is -1.
inline Problem makeProblem(const System& system, int removed, test::Random& random) {
  Problem p;
  for (int i = 0; i < system.mesh.vertexCount(); ++i) {
    p.rhs.push_back(random.vector(1e-3));
    p.guess.push_back(random.vector(0.1));
    int count = removed >= 0 ? removed : static_cast<int>(random(0, 3.999));
    if (removed > 0 && random(0, 1) < 0.5) count = 0;  // constrained vertices among free ones
    const Vec3 n = random.direction();
    Eigen::Matrix3d keep = Eigen::Matrix3d::Identity();
    if (count == 1) keep -= n * n.transpose();
    if (count == 2) keep = n * n.transpose();
    if (count == 3 || system.mesh.isRoot(i)) keep.setZero();
    p.keep.push_back(keep);
    if (count == 0 || system.mesh.isRoot(i)) continue;
    const Vec3 side = n.unitOrthogonal();
    sim::VertexConstraint constraint{i, keep, Vec3::Zero(), count, {n, side, n.cross(side)}};
    if (count == 2) constraint.directions = {side, n.cross(side), n};
    p.constraints.push_back(constraint);
  }
  return p;
}

inline Eigen::VectorXd stackedPoints(const std::vector<Vec3>& points) {
  return test::stacked<double>(test::plain<double>(points));
}

inline Eigen::MatrixXd filterMatrix(const std::vector<Eigen::Matrix3d>& keep) {
  Eigen::MatrixXd s = Eigen::MatrixXd::Zero(3 * keep.size(), 3 * keep.size());
  for (std::size_t i = 0; i < keep.size(); ++i) s.block<3, 3>(3 * i, 3 * i) = keep[i];
  return s;
}

// x = y + S z with y the prescribed part of the guess and S A S z = S (b - A y), by a dense factorization.
inline Eigen::VectorXd denseSolution(const Eigen::MatrixXd& a, const Problem& p) {
  const Eigen::MatrixXd s = filterMatrix(p.keep);
  const Eigen::MatrixXd removed = Eigen::MatrixXd::Identity(s.rows(), s.cols()) - s;
  const Eigen::VectorXd y = removed * stackedPoints(p.guess);
  const Eigen::MatrixXd reduced = s * a * s + a.norm() * removed;
  return y + s * reduced.ldlt().solve(s * (stackedPoints(p.rhs) - a * y));
}

template <class T>
Filter<T> filterOf(const Problem& p) {
  Filter<T> filter;
  for (std::size_t i = 0; i < p.keep.size(); ++i) {
    if (p.keep[i].isIdentity(0)) continue;
    filter.vertices.push_back(static_cast<int>(i));
    filter.keep.push_back(plainMatrix<T>(p.keep[i]));
  }
  return filter;
}

// y = A x.
template <class T>
auto productWith(const BlockMatrix<T>& a) {
  return [&a](std::span<const V3<T>> x, std::span<V3<T>> y) { sim::multiply<T>(a, x, y); };
}

// `known`: the preconditioner is told of the constraints.
template <class T>
sim::SolveReport solve(const System& system, const BlockMatrix<T>& a, const Problem& p, Kind kind,
                       const sim::StopRule<T>& stop, Eigen::VectorXd& x, bool known = false) {
  auto preconditioner = system.preconditioner(a, kind, known ? p.constraints : std::vector<sim::VertexConstraint>());
  sim::SolverScratch<T> scratch;
  scratch.resize(static_cast<int>(p.rhs.size()));
  auto values = test::plain<T>(p.guess);
  const auto rhs = test::plain<T>(p.rhs);
  const auto report =
      sim::solveModifiedPcg<T>(productWith<T>(a), rhs, filterOf<T>(p), preconditioner, stop, scratch, values);
  x = test::stacked<T>(values);
  return report;
}

inline double energyNorm(const Eigen::MatrixXd& a, const Eigen::VectorXd& x) {
  return std::sqrt(x.dot(a * x));
}

}  // namespace tests

// Small hair meshes for tests, and what the simulator's tests share: random numbers, a hair with its step context,
// dense matrices.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "sim/linear/block_matrix.h"
#include "sim/mesh/hair_mesh.h"
#include "sim/step.h"

namespace test {

// A patch of nx x nz root faces, `spacing` apart in x and z, whose columns of `layers` vertices run along `direction`
// (up or down) over `length` metres. With `mixed`, every third face is split into two triangles; with `uneven`, the
// columns of the first row end one layer early.
struct PatchOptions {
  int nx = 2, nz = 2, layers = 5;
  double spacing = 0.02, length = 0.2;
  sim::Vec3 direction{0, -1, 0};
  bool mixed = false, uneven = false;
};

// Triangles and quadrilaterals, wide enough for columns that no edge bounds.
inline PatchOptions mixedPatch(int layers, double length) {
  PatchOptions o;
  o.nx = 4, o.nz = 3, o.layers = layers, o.length = length, o.mixed = true;
  return o;
}

inline sim::HairMeshShape patchShape(const PatchOptions& o) {
  sim::HairMeshShape shape;
  const auto column = [&](int i, int k) { return k * (o.nx + 1) + i; };
  for (int k = 0; k <= o.nz; ++k) {
    for (int i = 0; i <= o.nx; ++i) {
      const int count = o.uneven && k == 0 ? o.layers - 1 : o.layers;
      for (int l = 0; l < count; ++l) {
        shape.positions.push_back(sim::Vec3(i * o.spacing, 0, k * o.spacing) +
                                  o.direction * (o.length * l / (o.layers - 1)));
      }
      shape.column_first.push_back(static_cast<int>(shape.positions.size()));
    }
  }
  for (int k = 0; k < o.nz; ++k) {
    for (int i = 0; i < o.nx; ++i) {
      // Counter-clockwise seen from the side that the columns grow to.
      std::array<int, 4> c{column(i, k), column(i, k + 1), column(i + 1, k + 1), column(i + 1, k)};
      if (o.direction.y() < 0) std::swap(c[1], c[3]);
      if (o.mixed && (i + k) % 3 == 0) {
        shape.root_faces.push_back({3, {c[0], c[1], c[2], -1}});
        shape.root_faces.push_back({3, {c[0], c[2], c[3], -1}});
      } else {
        shape.root_faces.push_back({4, c});
      }
    }
  }
  return shape;
}

inline std::vector<sim::Vec3> rootsOf(const sim::HairMesh& mesh, const std::vector<sim::Vec3>& positions) {
  std::vector<sim::Vec3> roots;
  for (int c = 0; c < mesh.columnCount(); ++c) roots.push_back(positions[mesh.shape.column_first[c]]);
  return roots;
}

// The patch combed: columns bend and flare smoothly with their height, so that rest angles, rest shears and volumes
// differ from element to element.
inline sim::HairMeshShape combedShape(const PatchOptions& o) {
  sim::HairMeshShape shape = patchShape(o);
  for (sim::Vec3& p : shape.positions) {
    const double s = std::abs(p.y()) / o.length;
    const double bend = 0.5 * s * s, twist = 0.3 * s * (1 + 5 * p.x());
    p = Eigen::AngleAxisd(twist, sim::Vec3::UnitY()) * p;
    p = Eigen::AngleAxisd(bend, sim::Vec3::UnitX()) * sim::Vec3(p.x() * (1 + 0.2 * s), p.y(), p.z() * (1 + 0.3 * s));
  }
  return shape;
}

// splitmix64: the same numbers on every platform and library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double operator()(double low, double high) {
    state_ += 0x9e3779b97f4a7c15ull;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return low + (high - low) * static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }
  sim::Vec3 vector(double size) {
    const double x = (*this)(-size, size), y = (*this)(-size, size), z = (*this)(-size, size);
    return {x, y, z};
  }
  sim::Vec3 direction() {
    for (;;) {
      const sim::Vec3 v = vector(1);
      if (v.norm() > 0.1 && v.norm() < 1) return v.normalized();
    }
  }
  Eigen::Quaterniond rotation() { return Eigen::Quaterniond(Eigen::AngleAxisd((*this)(-3, 3), direction())); }

 private:
  std::uint64_t state_;
};

// Material and numerics that the laws rely on, every field set here: defaults may change without touching a law.
inline sim::SimParams tautHair() {
  sim::SimParams p;
  p.density = 60, p.stretch_along = 4e5, p.stretch_across = 6e3, p.stretch_edge = 2e3, p.shear = 2.5e3;
  p.bend = 0.6, p.volume = 8e3, p.damping = 0.02, p.air_drag = 0.6;
  p.gravity = 9.81, p.wind_x = p.wind_y = p.wind_z = p.gust = 0;
  p.friction = 0.3, p.contact_offset = 0.002, p.max_depenetration = 2, p.collide = true;
  p.minimize_deformation = true, p.sag_free = true;
  p.time_step = 1.0 / 60;
  p.integrator = sim::Integrator::kLinearizedEuler, p.solver = sim::Solver::kDefault;
  p.precision = sim::Precision::kDouble;
  p.tolerance = 1e-8, p.acceleration_tolerance = 1e-9, p.displacement_tolerance = 1e-9, p.max_iterations = 2000;
  return p;
}

// Springs on some vertices, at rest in the styled pose.
inline std::vector<sim::PinnedVertex> pinnedWhereTheyAre(const sim::HairMesh& mesh) {
  std::vector<sim::PinnedVertex> pins;
  for (int i = 0; i < mesh.vertexCount(); i += 3) {
    if (!mesh.isRoot(i)) pins.push_back({i, mesh.shape.positions[i], sim::Vec3::Zero(), 20});
  }
  return pins;
}

// Hair without any stiffness: every vertex is a particle of its own.
inline sim::SimParams looseParticles() {
  sim::SimParams p = tautHair();
  p.stretch_along = p.stretch_across = p.stretch_edge = p.shear = p.bend = p.volume = 0;
  p.damping = p.air_drag = 0;
  p.sag_free = false;
  return p;
}

// A hair with all that a step needs. The roots stay where the rest shape has them unless a test moves them.
struct Hair {
  sim::HairMesh mesh;
  sim::SimParams params;
  sim::StepContext context;
  sim::HairState state;
  std::vector<sim::Vec3> roots;
  std::vector<sim::Ellipsoid> bodies;
  std::vector<sim::PinnedVertex> pins;
  double time = 0;

  Hair(sim::HairMeshShape shape, const sim::SimParams& p)
      : mesh(sim::buildHairMesh(std::move(shape))),
        params(p),
        context(mesh),
        state(sim::restState(mesh, Eigen::Isometry3d::Identity())),
        roots(rootsOf(mesh, state.positions)) {}
  Hair(const Hair&) = delete;
  Hair& operator=(const Hair&) = delete;

  sim::StepReport step(double dt) {
    time += dt;
    return sim::advance(mesh, params, {roots, bodies, time, {}, pins}, dt, context, state);
  }
};

// A hair shaken through some steps with a body in the way.
inline void shake(Hair& hair, int steps) {
  constexpr double kFrame = 1.0 / 60;
  const auto rest = hair.roots;
  hair.bodies.resize(1);
  for (int n = 1; n <= steps; ++n) {
    const Eigen::AngleAxisd turn(0.5 * std::sin(0.3 * n), sim::Vec3(0.3, 1, 0.2).normalized());
    for (std::size_t c = 0; c < rest.size(); ++c) hair.roots[c] = turn * rest[c];
    sim::Ellipsoid& body = hair.bodies[0];
    body.radii = sim::Vec3(0.05, 0.08, 0.06);
    body.velocity = sim::Vec3(0.3, 0, 0);
    body.center = sim::Vec3(-0.1 + 0.3 * n * kFrame, -0.12, 0.02);
    hair.step(kFrame);
  }
}

inline double largestDistance(const std::vector<sim::Vec3>& a, const std::vector<sim::Vec3>& b) {
  double largest = a.size() == b.size() ? 0 : INFINITY;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    const double d = (a[i] - b[i]).norm();
    if (!(d <= largest)) largest = d;  // a value that is not finite wins
  }
  return largest;
}

inline double tetVolume(const sim::CornerTet& tet, const std::vector<sim::Vec3>& x) {
  const sim::Vec3& o = x[tet.v[0]];
  return (x[tet.v[1]] - o).dot((x[tet.v[2]] - o).cross(x[tet.v[3]] - o)) / 6;
}

template <class T>
sim::V3<T> plain(const sim::Vec3& p) {
  return {static_cast<T>(p.x()), static_cast<T>(p.y()), static_cast<T>(p.z())};
}
template <class T>
std::vector<sim::V3<T>> plain(const std::vector<sim::Vec3>& points) {
  std::vector<sim::V3<T>> out;
  for (const sim::Vec3& p : points) out.push_back(plain<T>(p));
  return out;
}
template <class T>
sim::Vec3 eigen(const sim::V3<T>& p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}
template <class T>
Eigen::VectorXd stacked(std::span<const sim::V3<T>> points) {
  Eigen::VectorXd out(3 * points.size());
  for (std::size_t i = 0; i < points.size(); ++i) out.segment<3>(3 * i) = eigen(points[i]);
  return out;
}
template <class T>
Eigen::Matrix3d eigen(const sim::M3<T>& a) {
  Eigen::Matrix3d out;
  for (int k = 0; k < 9; ++k) out(k / 3, k % 3) = static_cast<double>(a.m[k]);
  return out;
}
template <class T>
Eigen::MatrixXd dense(const sim::BlockMatrix<T>& a) {
  const int n = a.pattern->size;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  for (int i = 0; i < n; ++i) {
    out.block<3, 3>(3 * i, 3 * i) = eigen(a.diagonal[i]);
    for (int k = a.pattern->row_first[i]; k < a.pattern->row_first[i + 1]; ++k) {
      const int j = a.pattern->columns[k];
      out.block<3, 3>(3 * i, 3 * j) = eigen(a.lower[k]);
      out.block<3, 3>(3 * j, 3 * i) = eigen(a.lower[k]).transpose();
    }
  }
  return out;
}

// Observed order of convergence: the slope of log(error) over log(step), by least squares.
inline double observedOrder(const std::vector<double>& steps, const std::vector<double>& errors) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const double n = static_cast<double>(steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double x = std::log(steps[i]), y = std::log(errors[i]);
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

}  // namespace test

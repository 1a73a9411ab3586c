// The condition functions and what evaluate() adds up of them, against finite differences, the paper's printed formulas
// and the invariances of elastic forces.
#include <gtest/gtest.h>

#include <functional>

#include "sim/forces/model.h"
#include "tests/sim_probes.h"
#include "tests/test_meshes.h"

namespace forces_test {

using sim::BlockMatrix;
using sim::BlockPattern;
using sim::ForceKinds;
using sim::ForceModel;
using sim::V3;
using sim::Vec3;
using Points = std::vector<V3<double>>;

constexpr std::size_t kElementsOfAKind = 12;

BlockPattern fullPattern(int n) {
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < i; ++j) pairs.emplace_back(i, j);
  }
  return sim::makePattern(n, pairs);
}

sim::HairMesh combedMesh(bool uneven = true) {
  test::PatchOptions o;
  o.layers = 4, o.length = 0.12, o.mixed = true, o.uneven = uneven;
  return sim::buildHairMesh(test::combedShape(o));
}

sim::SimParams withoutSagFree() {
  sim::SimParams p = test::tautHair();
  p.sag_free = false;
  return p;
}

// One element as a force model of its own, at rest at `rest`.
struct Element {
  ForceModel<double> model;
  std::vector<Vec3> rest;
};

template <class Kind>
constexpr bool kOneSided = requires {
  Kind::kOneSided;
};

// Some elements of the kind, from all over a mesh; one-sided ones where they act, folded back by some two right angles.
// Their vertices are numbered from the last to the first, so that blocks are turned.
template <class Kind>
std::vector<Element> elementsOf() {
  const sim::HairMesh mesh = combedMesh();
  std::vector<sim::ElementOf<Kind>> all;
  const std::vector<sim::PinnedVertex> pins = test::pinnedWhereTheyAre(mesh);
  Kind::collect(sim::ForceSource{mesh, withoutSagFree(), pins},
                [&](const sim::ElementOf<Kind>& e) { all.push_back(e); });
  EXPECT_FALSE(all.empty()) << Kind::kName << ": collect() makes no element of this mesh; give the mesh what it needs";
  std::vector<Element> some;
  const std::size_t count = std::min(all.size(), kElementsOfAKind);
  for (std::size_t k = 0; k < count; ++k) {
    const sim::ElementOf<Kind>& one = all[all.size() * k / count];
    Element& e = some.emplace_back();
    auto& table = e.model.template of<Kind>();
    auto& vertices = table.vertices.emplace_back();
    for (int p = 0; p < Kind::kVertices; ++p) vertices[p] = Kind::kVertices - 1 - p;
    for (int p = Kind::kVertices - 1; p >= 0; --p) e.rest.push_back(mesh.shape.positions[one.vertices[p]]);
    if constexpr (kOneSided<Kind>) {
      const Vec3 u = e.rest[1] - e.rest[2];
      e.rest[0] = e.rest[1] - 0.8 * u + 0.3 * u.norm() * u.unitOrthogonal();
    }
    table.stiffness.push_back(one.stiffness), table.rest.push_back(one.rest), table.shift.push_back(one.shift);
    auto& slots = table.slots.emplace_back();
    const BlockPattern pattern = fullPattern(Kind::kVertices);
    int pair = 0;
    for (int p = 0; p < Kind::kVertices; ++p) {
      for (int q = p + 1; q < Kind::kVertices; ++q) slots[pair++] = pattern.find(vertices[p], vertices[q]);
    }
  }
  return some;
}

template <class Kind>
auto conditionAt(const Element& e, const Points& x) {
  const Points turned(x.rbegin(), x.rend());
  const auto& table = e.model.template of<Kind>();
  return Kind::condition(turned.data(), table.rest[0], table.shift[0]);
}

template <class Kind>
Points gradientAt(const Element& e, const Points& x) {
  const auto c = conditionAt<Kind>(e, x);
  return Points(std::make_reverse_iterator(c.g + Kind::kVertices), std::make_reverse_iterator(c.g + 0));
}

Points moved(const std::vector<Vec3>& rest, double size, test::Random& random) {
  Points out;
  for (const Vec3& p : rest) out.push_back(test::plain<double>(Vec3(p + random.vector(size))));
  return out;
}

Points along(const Points& x, double step, const Points& direction) {
  Points out = x;
  for (std::size_t i = 0; i < x.size(); ++i) out[i] += step * direction[i];
  return out;
}

double dotAll(const Points& a, const Points& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += sim::dot(a[i], b[i]);
  return sum;
}

double energyAt(const ForceModel<double>& model, const Points& x) {
  return sim::evaluate<double>(model, x, {});
}

Points forceAt(const ForceModel<double>& model, const Points& x) {
  Points force(x.size(), V3<double>{0, 0, 0});
  sim::Evaluation<double> out;
  out.force = force;
  sim::evaluate<double>(model, x, out);
  return force;
}

Eigen::MatrixXd matrixAt(const ForceModel<double>& model, const BlockPattern& pattern, const Points& x,
                         double tension) {
  BlockMatrix<double> matrix(&pattern);
  sim::Evaluation<double> out;
  out.matrix = &matrix;
  out.matrix_scale = 1;
  out.tension_scale = tension;
  sim::evaluate<double>(model, x, out);
  return test::dense(matrix);
}

// Central differences converge at second order over these steps (m, for elements of some centimetres).
const std::vector<double> kSteps{4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4};

template <class Kind>
void expectGradientsOfOrderTwo(test::Random& random) {
  double worst = 0, lowest = 9, highest = 0;
  for (const Element& e : elementsOf<Kind>()) {
    const Points x = moved(e.rest, 0.003, random);
    Points direction;
    for (int i = 0; i < Kind::kVertices; ++i) direction.push_back(test::plain<double>(random.vector(1)));
    const Points gradient = gradientAt<Kind>(e, x);
    const double exact = dotAll(gradient, direction);
    double scale = 0;
    for (const V3<double>& g : gradient) scale += std::sqrt(sim::dot(g, g));
    EXPECT_GT(scale, 0) << Kind::kName;
    std::vector<double> errors;
    for (double h : kSteps) {
      const double fore = conditionAt<Kind>(e, along(x, h, direction)).value,
                   back = conditionAt<Kind>(e, along(x, -h, direction)).value;
      errors.push_back(std::abs((fore - back) / (2 * h) - exact) / scale);
    }
    worst = std::max(worst, errors.back());
    if (errors.front() < 1e-11) continue;  // at most quadratic in x: central differences are exact
    const double order = test::observedOrder(kSteps, errors);
    lowest = std::min(lowest, order), highest = std::max(highest, order);
  }
  std::printf("%-8s worst relative error %.1e at 0.25 mm, order %.3f to %.3f\n", Kind::kName, worst, lowest, highest);
  EXPECT_LT(worst, 1e-2) << Kind::kName;
  if (highest == 0) return;
  EXPECT_GT(lowest, 1.8) << Kind::kName;
  EXPECT_LT(highest, 2.4) << Kind::kName;
}

TEST(Forces, GradientsMatchCentralDifferencesWithTheirOrder) {
  test::Random random(1);
  ForceKinds::forEach([&]<class Kind>() { expectGradientsOfOrderTwo<Kind>(random); });
}

TEST(Forces, ForcesAreMinusTheEnergysGradient) {
  test::Random random(2);
  const auto check = [&](const char* name, const ForceModel<double>& model, const std::vector<Vec3>& rest,
                         double size) {
    const Points x = moved(rest, size, random), force = forceAt(model, x);
    Points direction;
    for (std::size_t i = 0; i < rest.size(); ++i) direction.push_back(test::plain<double>(random.vector(1)));
    std::vector<double> steps, errors;
    for (double h = 4e-4; h > 2e-5; h /= 2) {
      const double slope =
          (energyAt(model, along(x, h, direction)) - energyAt(model, along(x, -h, direction))) / (2 * h);
      steps.push_back(h);
      errors.push_back(std::abs(slope + dotAll(force, direction)) / std::sqrt(dotAll(force, force)));
    }
    const double order = test::observedOrder(steps, errors);
    EXPECT_LT(errors.back(), 1e-3) << name;
    if (errors.front() < 1e-7) return;  // rounding
    EXPECT_NEAR(order, 2, 0.2) << name;
  };
  ForceKinds::forEach([&]<class Kind>() {
    for (const Element& e : elementsOf<Kind>()) check(Kind::kName, e.model, e.rest, 0.003);
  });
  const sim::HairMesh mesh = combedMesh();
  const BlockPattern pattern = sim::systemPattern(mesh);
  check("whole model", test::makeForceModel(mesh, pattern, withoutSagFree()), mesh.shape.positions, 0.001);
  check("sag-free", test::makeForceModel(mesh, pattern, test::tautHair()), mesh.shape.positions, 0.001);
}

template <class Kind>
void expectGaussNewton(const Element& e, double size, test::Random& random) {
  const BlockPattern pattern = fullPattern(Kind::kVertices);
  const double stiffness = e.model.template of<Kind>().stiffness[0], h = 1e-6;
  const Points x = moved(e.rest, size, random);
  const auto unit = [](int i) {
    Points direction(Kind::kVertices, V3<double>{0, 0, 0});
    (&direction[i / 3].x)[i % 3] = 1;
    return direction;
  };
  Eigen::VectorXd g(3 * Kind::kVertices);  // of C, differenced
  for (int i = 0; i < g.size(); ++i) {
    const double fore = conditionAt<Kind>(e, along(x, h, unit(i))).value,
                 back = conditionAt<Kind>(e, along(x, -h, unit(i))).value;
    g[i] = (fore - back) / (2 * h);
  }
  const Eigen::MatrixXd expected = stiffness * g * g.transpose();
  const Eigen::MatrixXd matrix = matrixAt(e.model, pattern, x, 0);
  EXPECT_LT((matrix - expected).norm(), 1e-6 * expected.norm()) << Kind::kName;
  if (size > 0 || kOneSided<Kind>) return;
  for (int i = 0; i < g.size(); ++i) {
    const Points fore = forceAt(e.model, along(x, h, unit(i))), back = forceAt(e.model, along(x, -h, unit(i)));
    const Eigen::VectorXd column = (test::stacked<double>(back) - test::stacked<double>(fore)) / (2 * h);
    EXPECT_LT((matrix.col(i) - column).norm(), 1e-5 * matrix.norm()) << Kind::kName << " at rest, column " << i;
  }
}

TEST(Forces, HessianIsExactWhereTheConditionIsZeroAndGaussNewtonElsewhere) {
  test::Random random(3);
  ForceKinds::forEach([&]<class Kind>() {
    for (const Element& e : elementsOf<Kind>()) {
      for (const double size : {0.0, 0.004}) expectGaussNewton<Kind>(e, size, random);
    }
  });
}

TEST(Forces, TensionPartMakesTheStretchedEdgesHessianExactAndIsAbsentUnderCompression) {
  const Element e = elementsOf<sim::Stretch>()[0];
  const BlockPattern pattern = fullPattern(2);
  for (const double stretch : {1.4, 1.01, 0.8}) {
    const Points x = test::plain<double>(std::vector<Vec3>{e.rest[0], e.rest[0] + stretch * (e.rest[1] - e.rest[0])});
    Eigen::MatrixXd differenced(6, 6);
    for (int i = 0; i < 6; ++i) {
      Points direction(2, V3<double>{0, 0, 0});
      (&direction[i / 3].x)[i % 3] = 1;
      differenced.col(i) = (test::stacked<double>(forceAt(e.model, along(x, -1e-6, direction))) -
                            test::stacked<double>(forceAt(e.model, along(x, 1e-6, direction)))) /
                           2e-6;
    }
    const Eigen::MatrixXd with = matrixAt(e.model, pattern, x, 1), without = matrixAt(e.model, pattern, x, 0);
    if (stretch > 1) {
      EXPECT_LT((with - differenced).norm(), 1e-6 * differenced.norm());
      EXPECT_GT((without - differenced).norm(), 1e-3 * differenced.norm());
    } else {
      EXPECT_EQ((with - without).norm(), 0);
    }
  }
}

TEST(Forces, WholeModelsHessianAtRestIsTheForcesDerivative) {
  const sim::HairMesh mesh = combedMesh();
  const BlockPattern pattern = sim::systemPattern(mesh);
  const ForceModel<double> model = test::makeForceModel(mesh, pattern, withoutSagFree());
  const Points x = test::plain<double>(mesh.shape.positions);
  const Eigen::MatrixXd matrix = matrixAt(model, pattern, x, 1);
  test::Random random(4);
  for (int trial = 0; trial < 10; ++trial) {
    Points direction;
    for (std::size_t i = 0; i < x.size(); ++i) direction.push_back(test::plain<double>(random.vector(1)));
    const double h = 1e-7;
    const Eigen::VectorXd differenced = (test::stacked<double>(forceAt(model, along(x, -h, direction))) -
                                         test::stacked<double>(forceAt(model, along(x, h, direction)))) /
                                        (2 * h);
    const Eigen::VectorXd product = matrix * test::stacked<double>(direction);
    EXPECT_LT((product - differenced).norm(), 1e-6 * product.norm());
  }
}

TEST(Forces, DampingForceIsTheDissipationsDerivativeAndDampsNothingRigid) {
  const sim::HairMesh mesh = combedMesh();
  const BlockPattern pattern = sim::systemPattern(mesh);
  const ForceModel<double> model = test::makeForceModel(mesh, pattern, withoutSagFree());
  test::Random random(5);
  const Points x = moved(mesh.shape.positions, 0.003, random);
  const auto potential = [&](const Points& v, Points* force) {
    sim::Evaluation<double> out;
    Points sum(x.size(), V3<double>{0, 0, 0});
    if (force) out.force = sum;
    out.velocities = v;
    out.damping = 0.03;
    const double value = sim::evaluate<double>(model, x, out);
    if (force) {
      const Points elastic = forceAt(model, x);
      for (std::size_t i = 0; i < x.size(); ++i) sum[i] -= elastic[i];
      *force = sum;
    }
    return value;
  };
  Points v, direction, force;
  for (std::size_t i = 0; i < x.size(); ++i) v.push_back(test::plain<double>(random.vector(1)));
  for (std::size_t i = 0; i < x.size(); ++i) direction.push_back(test::plain<double>(random.vector(1)));
  potential(v, &force);
  const double slope = (potential(along(v, 1, direction), nullptr) - potential(along(v, -1, direction), nullptr)) / 2;
  EXPECT_NEAR(slope, -dotAll(force, direction), 1e-9 * std::abs(slope)) << "quadratic in v: exact at any step";
  EXPECT_LT(dotAll(force, v), 0) << "it takes energy";

  const Vec3 spin(3, -2, 1), drift(4, 5, -6);
  Points rigid, rigid_force;
  for (const V3<double>& p : x) rigid.push_back(test::plain<double>(Vec3(drift + spin.cross(test::eigen(p)))));
  potential(rigid, &rigid_force);
  EXPECT_LT(test::stacked<double>(rigid_force).norm(), 1e-10 * test::stacked<double>(force).norm());
}

}  // namespace forces_test

// The condition functions and what evaluate() adds up of them, against finite differences, the paper's printed formulas
// and the invariances of elastic forces.
#include <gtest/gtest.h>

#include <functional>

#include "sim/forces/force_model.h"
#include "tests/test_meshes.h"

namespace {

using sim::BlockMatrix;
using sim::BlockPattern;
using sim::ForceModel;
using sim::V3;
using sim::Vec3;
using Points = std::vector<V3<double>>;

// One element of each kind as a force model of its own, with a state around which it is smooth.
struct Element {
  const char* name;
  int vertices;
  ForceModel<double> model;
  std::vector<Vec3> rest;
  std::function<double(const Points&)> condition;
  std::function<Points(const Points&)> gradient;
};

constexpr double kStiffness = 7.0;

template <class Table, std::size_t N>
void addOnly(Table& table, const std::array<int, N>& vertices, const BlockPattern& pattern) {
  table.vertices.push_back(vertices);
  table.stiffness.push_back(kStiffness);
  table.shift.push_back(0);
  auto& slots = table.slots.emplace_back();
  int pair = 0;
  for (std::size_t p = 0; p < N; ++p) {
    for (std::size_t q = p + 1; q < N; ++q)
      slots[pair++] = pattern.find(std::max(vertices[p], vertices[q]), std::min(vertices[p], vertices[q]));
  }
}

BlockPattern fullPattern(int n) {
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < i; ++j) pairs.emplace_back(i, j);
  }
  return sim::makePattern(n, pairs);
}

template <int N>
Points gradientOf(const sim::Condition<double, N>& c) {
  return Points(c.g, c.g + N);
}

std::vector<Element> elements() {
  std::vector<Element> all;
  {
    Element e{"stretch", 2, {}, {{0.1, 0.2, 0.3}, {0.12, 0.17, 0.31}}, {}, {}};
    const double inverse = 1 / (e.rest[1] - e.rest[0]).norm();
    addOnly(e.model.stretch, std::array{1, 0}, fullPattern(2));  // the larger vertex first: its block is turned
    e.model.stretch.inverse_length = {inverse};
    e.condition = [=](const Points& x) { return sim::stretchCondition(x[1], x[0], inverse).value; };
    e.gradient = [=](const Points& x) {
      const auto s = sim::stretchCondition(x[1], x[0], inverse);
      return Points{s.inverse_length * s.direction, (-s.inverse_length) * s.direction};
    };
    all.push_back(e);
  }
  {
    Element e{"shear", 4, {}, {{0, 0, 0}, {0.02, 0.001, 0}, {0.021, -0.05, 0.002}, {-0.001, -0.048, 0}}, {}, {}};
    addOnly(e.model.shear, std::array{0, 1, 2, 3}, fullPattern(4));
    e.model.shear.inverse_along = {20}, e.model.shear.inverse_across = {50};
    e.condition = [](const Points& x) { return sim::shearCondition(x.data(), 20.0, 50.0).value; };
    e.gradient = [](const Points& x) { return gradientOf(sim::shearCondition(x.data(), 20.0, 50.0)); };
    const Points at = test::plain<double>(e.rest);
    e.model.shear.shift[0] = e.condition(at);
    all.push_back(e);
  }
  {
    Element e{"bend",
              6,
              {},
              {{0, 0, 0}, {0.02, 0, 0}, {0, -0.05, 0.01}, {0.021, -0.049, 0.012}, {0, -0.1, 0.03}, {0.02, -0.09, 0.04}},
              {},
              {}};
    addOnly(e.model.bend, std::array{0, 1, 2, 3, 4, 5}, fullPattern(6));
    const auto bend = [](const Points& x, double rest) { return sim::bendCondition(x.data(), rest, 20.0, 1e-10); };
    const double angle = bend(test::plain<double>(e.rest), 0).value / 20;
    e.model.bend.rest_angle = {angle}, e.model.bend.inverse_length = {20}, e.model.bend.smallest_square = {1e-10};
    e.condition = [=](const Points& x) { return bend(x, angle).value; };
    e.gradient = [=](const Points& x) { return gradientOf(bend(x, angle)); };
    all.push_back(e);
  }
  {
    Element e{"volume", 4, {}, {{0, 0, 0}, {0.02, 0.001, 0}, {0.002, 0.001, 0.03}, {0.001, 0.05, 0.003}}, {}, {}};
    addOnly(e.model.volume, std::array{0, 1, 2, 3}, fullPattern(4));
    const double rest = sim::volumeCondition(test::plain<double>(e.rest).data(), 0.0).value;
    e.model.volume.rest_volume = {rest};
    e.model.volume.stiffness = {kStiffness / (rest * rest)};
    e.condition = [=](const Points& x) { return sim::volumeCondition(x.data(), rest).value; };
    e.gradient = [=](const Points& x) { return gradientOf(sim::volumeCondition(x.data(), rest)); };
    all.push_back(e);
  }
  return all;
}

double stiffnessOf(const Element& e) {
  for (const auto& k :
       {e.model.stretch.stiffness, e.model.shear.stiffness, e.model.bend.stiffness, e.model.volume.stiffness}) {
    if (!k.empty()) return k[0];
  }
  return 0;
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

// Central differences converge at second order over these steps (m, for elements of some centimetres).
const std::vector<double> kSteps{4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4};

TEST(Forces, GradientsMatchCentralDifferencesWithTheirOrder) {
  test::Random random(1);
  for (const Element& e : elements()) {
    double worst = 0, lowest = 9, highest = 0;
    for (int trial = 0; trial < 20; ++trial) {
      const Points x = moved(e.rest, 0.003, random);
      Points direction;
      for (int i = 0; i < e.vertices; ++i) direction.push_back(test::plain<double>(random.vector(1)));
      const double exact = dotAll(e.gradient(x), direction);
      double scale = 0;
      for (const V3<double>& g : e.gradient(x)) scale += std::sqrt(sim::dot(g, g));
      std::vector<double> errors;
      for (double h : kSteps) {
        const double difference =
            (e.condition(along(x, h, direction)) - e.condition(along(x, -h, direction))) / (2 * h);
        errors.push_back(std::abs(difference - exact) / scale);
      }
      worst = std::max(worst, errors.back());
      if (std::string(e.name) == "shear") {
        EXPECT_LT(errors.front(), 1e-11) << "quadratic in x: central differences are exact";
        continue;
      }
      const double order = test::observedOrder(kSteps, errors);
      lowest = std::min(lowest, order), highest = std::max(highest, order);
    }
    std::printf("%-8s worst relative error %.1e at 0.25 mm, order %.3f to %.3f\n", e.name, worst, lowest, highest);
    EXPECT_LT(worst, 1e-2) << e.name;
    if (std::string(e.name) == "shear") continue;
    EXPECT_GT(lowest, 1.8) << e.name;
    EXPECT_LT(highest, 2.4) << e.name;
  }
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
    std::printf("%-11s error %.1e, order %.3f\n", name, errors.back(), order);
    EXPECT_LT(errors.back(), 1e-3) << name;
    EXPECT_NEAR(order, 2, 0.2) << name;
  };
  for (const Element& e : elements()) check(e.name, e.model, e.rest, 0.003);
  const sim::HairMesh mesh = combedMesh();
  const BlockPattern pattern = sim::systemPattern(mesh);
  check("whole model", sim::makeForceModel(mesh, pattern, withoutSagFree()), mesh.shape.positions, 0.001);
  check("sag-free", sim::makeForceModel(mesh, pattern, test::tautHair()), mesh.shape.positions, 0.001);
}

TEST(Forces, HessianIsExactWhereTheConditionIsZeroAndGaussNewtonElsewhere) {
  test::Random random(3);
  for (const Element& e : elements()) {
    const BlockPattern pattern = fullPattern(e.vertices);
    for (const double size : {0.0, 0.004}) {
      const Points x = moved(e.rest, size, random);
      Eigen::VectorXd g(3 * e.vertices);  // of C, differenced
      const double h = 1e-6;
      for (int i = 0; i < 3 * e.vertices; ++i) {
        Points direction(e.vertices, V3<double>{0, 0, 0});
        (&direction[i / 3].x)[i % 3] = 1;
        g[i] = (e.condition(along(x, h, direction)) - e.condition(along(x, -h, direction))) / (2 * h);
      }
      const Eigen::MatrixXd expected = stiffnessOf(e) * g * g.transpose();
      const Eigen::MatrixXd matrix = matrixAt(e.model, pattern, x, 0);
      EXPECT_LT((matrix - expected).norm(), 1e-6 * expected.norm()) << e.name;
      if (size == 0) {
        for (int i = 0; i < 3 * e.vertices; ++i) {
          Points direction(e.vertices, V3<double>{0, 0, 0});
          (&direction[i / 3].x)[i % 3] = 1;
          const Points fore = forceAt(e.model, along(x, h, direction)),
                       back = forceAt(e.model, along(x, -h, direction));
          const Eigen::VectorXd column = (test::stacked<double>(back) - test::stacked<double>(fore)) / (2 * h);
          EXPECT_LT((matrix.col(i) - column).norm(), 1e-5 * matrix.norm()) << e.name << " at rest, column " << i;
        }
      }
    }
  }
}

TEST(Forces, TensionPartMakesTheStretchedEdgesHessianExactAndIsAbsentUnderCompression) {
  const Element e = elements()[0];
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
  const ForceModel<double> model = sim::makeForceModel(mesh, pattern, withoutSagFree());
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
  const ForceModel<double> model = sim::makeForceModel(mesh, pattern, withoutSagFree());
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

}  // namespace

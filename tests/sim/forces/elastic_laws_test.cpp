// What every elastic model must obey in every state: semi-definite Hessians, no force from rigid motion, no net force
// or torque, the paper's volume force to the letter, and gravity carried by the styled pose.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <limits>

#include "sim/forces/model.h"
#include "sim/forces/rest_balance.h"
#include "tests/sim_probes.h"
#include "tests/test_meshes.h"

namespace elastic_laws_test {

using sim::BlockMatrix;
using sim::BlockPattern;
using sim::ForceModel;
using sim::V3;
using sim::Vec3;

struct State {
  const char* name;
  std::vector<Vec3> x;
};

// The hard states: random, flattened into a plane and onto a line, inverted, collapsed, scaled.
std::vector<State> hardStates(const sim::HairMesh& mesh, test::Random& random) {
  const std::vector<Vec3>& rest = mesh.shape.positions;
  std::vector<State> states;
  const auto add = [&](const char* name, const auto& move) {
    State state{name, rest};
    for (int i = 0; i < mesh.vertexCount(); ++i) state.x[i] = move(i, rest[i]);
    states.push_back(state);
  };
  add("at rest", [](int, const Vec3& p) { return p; });
  add("noise of 5 mm", [&](int, const Vec3& p) { return Vec3(p + random.vector(0.005)); });
  add("random", [&](int, const Vec3&) { return random.vector(0.2); });
  add("flattened", [](int, const Vec3& p) { return Vec3(p.x(), 0, p.z()); });
  add("flattened upright", [](int, const Vec3& p) { return Vec3(p.x(), p.y(), 0); });
  add("on a line", [](int, const Vec3& p) { return Vec3(0, p.y(), 0); });
  add("inverted", [](int, const Vec3& p) { return Vec3(p.x(), -p.y(), p.z()); });
  add("inside out", [](int, const Vec3& p) { return Vec3(-p); });
  add("onto its roots", [&](int i, const Vec3&) { return rest[mesh.shape.column_first[mesh.column_of[i]]]; });
  add("in one point", [](int, const Vec3&) { return Vec3(0.1, 0.2, 0.3); });
  add("a millionth", [](int, const Vec3& p) { return Vec3(1e-6 * p); });
  add("threefold", [](int, const Vec3& p) { return Vec3(3 * p); });
  add("a thousandfold", [](int, const Vec3& p) { return Vec3(1000 * p); });
  return states;
}

sim::HairMesh combedMesh() {
  test::PatchOptions o;
  o.layers = 4, o.length = 0.12, o.mixed = true, o.uneven = true;
  return sim::buildHairMesh(test::combedShape(o));
}

sim::SimParams withoutSagFree() {
  sim::SimParams p = test::tautHair();
  p.sag_free = false;
  return p;
}

template <class T>
double smallestShare(const ForceModel<double>& source, const BlockPattern& pattern, const std::vector<Vec3>& x) {
  const ForceModel<T> model = test::convertModel<T>(source);
  BlockMatrix<T> matrix(&pattern);
  sim::Evaluation<T> out;
  out.matrix = &matrix;
  out.matrix_scale = out.tension_scale = 1;
  const auto points = test::plain<T>(x);
  sim::evaluate<T>(model, points, out);
  const Eigen::MatrixXd a = test::dense(matrix);
  EXPECT_TRUE(a.allFinite());
  EXPECT_LE((a - a.transpose()).norm(), 4 * std::numeric_limits<T>::epsilon() * a.norm()) << "symmetric";
  const Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a, Eigen::EigenvaluesOnly).eigenvalues();
  return values.maxCoeff() > 0 ? values.minCoeff() / values.maxCoeff() : 0;
}

TEST(ElasticLaws, HessiansArePositiveSemiDefiniteInEveryState) {
  const sim::HairMesh mesh = combedMesh();
  const BlockPattern pattern = sim::systemPattern(mesh);
  const ForceModel<double> model = test::makeForceModel(mesh, pattern, test::tautHair());
  test::Random random(6);
  for (const State& state : hardStates(mesh, random)) {
    EXPECT_GE(smallestShare<double>(model, pattern, state.x), -1e-12) << state.name;
    EXPECT_GE(smallestShare<float>(model, pattern, state.x), -2e-6) << state.name << ", single precision";
  }
}

std::vector<V3<double>> forceAt(const ForceModel<double>& model, const std::vector<Vec3>& x, double* energy = nullptr) {
  std::vector<V3<double>> force(x.size(), V3<double>{0, 0, 0});
  sim::Evaluation<double> out;
  out.force = force;
  const double e = sim::evaluate<double>(model, test::plain<double>(x), out);
  if (energy) *energy = e;
  return force;
}

double largest(const std::vector<V3<double>>& force) {
  double most = 0;
  for (const V3<double>& f : force) most = std::max(most, test::eigen(f).norm());
  return most;
}

TEST(ElasticLaws, RigidMotionMakesNoForceAndNoEnergy) {
  const sim::HairMesh mesh = combedMesh();
  const ForceModel<double> model = test::makeForceModel(mesh, sim::systemPattern(mesh), withoutSagFree());
  test::Random random(7);
  std::vector<Vec3> stretched = mesh.shape.positions;
  for (Vec3& p : stretched) p *= 1.01;
  double reference_energy = 0;
  const double reference = largest(forceAt(model, stretched, &reference_energy));
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Quaterniond rotation = random.rotation();
    const Vec3 shift = random.vector(2);
    std::vector<Vec3> x;
    for (const Vec3& p : mesh.shape.positions) x.push_back(rotation * p + shift);
    double energy = 0;
    EXPECT_LT(largest(forceAt(model, x, &energy)), 1e-10 * reference);
    EXPECT_LT(energy, 1e-20 * reference_energy + 1e-22);
  }
}

TEST(ElasticLaws, ForcesTurnWithTheHair) {
  const sim::HairMesh mesh = combedMesh();
  const ForceModel<double> model = test::makeForceModel(mesh, sim::systemPattern(mesh), test::tautHair());
  test::Random random(8);
  for (const char* name : {"noise of 5 mm", "random", "inverted"}) {
    for (const State& state : hardStates(mesh, random)) {
      if (std::string(state.name) != name) continue;
      const Eigen::Quaterniond rotation = random.rotation();
      std::vector<Vec3> turned;
      for (const Vec3& p : state.x) turned.push_back(rotation * p + Vec3(1, 2, 3));
      const auto before = forceAt(model, state.x), after = forceAt(model, turned);
      for (std::size_t i = 0; i < before.size(); ++i) {
        EXPECT_LT((rotation * test::eigen(before[i]) - test::eigen(after[i])).norm(), 1e-8 * largest(before)) << name;
      }
    }
  }
}

TEST(ElasticLaws, InternalForcesSumToNothingAndTurnNothing) {
  const sim::HairMesh mesh = combedMesh();
  const ForceModel<double> model = test::makeForceModel(mesh, sim::systemPattern(mesh), test::tautHair());
  test::Random random(9);
  for (const State& state : hardStates(mesh, random)) {
    for (const bool damped : {false, true}) {
      std::vector<V3<double>> force(state.x.size(), V3<double>{0, 0, 0}), v;
      for (std::size_t i = 0; i < state.x.size(); ++i) v.push_back(test::plain<double>(random.vector(2)));
      sim::Evaluation<double> out;
      out.force = force;
      if (damped) out.velocities = v, out.damping = 0.05;
      sim::evaluate<double>(model, test::plain<double>(state.x), out);
      Vec3 sum = Vec3::Zero(), torque = Vec3::Zero();
      double forces = 0, torques = 0;
      for (std::size_t i = 0; i < force.size(); ++i) {
        const Vec3 f = test::eigen(force[i]);
        ASSERT_TRUE(f.allFinite()) << state.name;
        sum += f, forces += f.norm();
        torque += state.x[i].cross(f), torques += state.x[i].norm() * f.norm();
      }
      EXPECT_LE(sum.norm(), 1e-12 * forces) << state.name << ": linear momentum";
      EXPECT_LE(torque.norm(), 1e-10 * torques) << state.name << ": angular momentum";
    }
  }
}

// The sum of forces and the sum of torques of one hinge, its walls whole, collapsed to any degree, or without area.
TEST(BendForce, OfOneHingeSumsToNothingAndTurnsNothingInEveryState) {
  test::Random random(12);
  constexpr double kSide = 0.02, kSmallest = 0.1 * kSide * kSide;
  double largest_pull = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<Vec3> x;
    for (int i = 0; i < 6; ++i) x.push_back(random.vector(kSide));
    // Each wall's far side nears the hinge to a share of its distance, down to none at all.
    const Vec3 middle = (x[2] + x[3]) / 2, along = x[3] - x[2];
    for (const int far : {0, 4}) {
      const double share = trial % 5 == far / 2 ? 0 : std::pow(10, random(-12, 0));
      const Vec3 slide = random(-0.5, 0.5) * along;
      for (const int i : {far, far + 1}) x[i] = middle + slide + share * (x[i] - middle);
    }
    const auto c = sim::bendCondition(test::plain<double>(x).data(), 0.3, 1 / kSide, kSmallest * kSmallest);
    Vec3 sum = Vec3::Zero(), torque = Vec3::Zero();
    double forces = 0, torques = 0;
    for (int i = 0; i < 6; ++i) {
      const Vec3 g = test::eigen(c.g[i]);
      ASSERT_TRUE(g.allFinite());
      sum += g, forces += g.norm();
      torque += (x[i] - middle).cross(g), torques += (x[i] - middle).norm() * g.norm();
    }
    EXPECT_LE(sum.norm(), 1e-12 * forces);
    EXPECT_LE(torque.norm(), 1e-11 * torques);
    largest_pull = std::max(largest_pull, forces);
  }
  EXPECT_GT(largest_pull, 1 / (kSide * kSide)) << "there is a force to balance";
  // Pull over angle: bounded, however far a wall has collapsed.
  EXPECT_LT(largest_pull, 1000 / (kSide * kSide));
}

// Walls that have collapsed to any degree: the condition is that of an energy, continuous where the angle jumps, and
// its gradient is the force; what jumped or pulled beside it would feed crushed hair for ever.
TEST(BendForce, IsTheGradientOfItsEnergyAlsoWhereAWallHasCollapsed) {
  test::Random random(13);
  constexpr double kSide = 0.02, kSmallest = 0.3 * kSide * kSide, kStep = 1e-8;
  const auto conditionAt = [&](const std::vector<Vec3>& x) {
    return sim::bendCondition(test::plain<double>(x).data(), 0.3, 1 / kSide, kSmallest * kSmallest);
  };
  int crushed = 0;
  for (int trial = 0; trial < 500; ++trial) {
    std::vector<Vec3> x{{0, -1, 0}, {1, -1, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    const int far = trial % 2 ? 4 : 0;
    const double height = random(0.05, 0.5);  // of its rest height
    for (Vec3& p : x) p = kSide * (p + random.vector(0.2));
    for (const int i : {far, far + 1}) x[i] = x[i - far + 2] + height * (x[i] - x[i - far + 2]);
    const auto c = conditionAt(x);
    crushed += c.crush > 0;
    std::vector<Vec3> way;
    double rate = 0, size = 0;
    for (int i = 0; i < 6; ++i) {
      way.push_back(random.vector(1));
      rate += way[i].dot(test::eigen(c.g[i]));
      size += way[i].norm() * test::eigen(c.g[i]).norm();
    }
    double value[2];
    for (const int side : {0, 1}) {
      std::vector<Vec3> there = x;
      for (int i = 0; i < 6; ++i) there[i] += (side ? kStep : -kStep) * way[i];
      value[side] = conditionAt(there).value;
    }
    if (std::abs(value[1] - value[0]) > 1 / kSide) continue;  // a full turn between the two
    EXPECT_NEAR((value[1] - value[0]) / (2 * kStep), rate, 1e-4 * size) << "trial " << trial;
  }
  EXPECT_GT(crushed, 100);
}

TEST(BendForce, LosesNoEnergyWhereTheAngleOfACollapsedWallJumps) {
  constexpr double kSide = 0.02, kSmallest = 0.3 * kSide * kSide;
  double before = 0, largest = 0, jump = 0, crush = 0;
  // The lower far side goes through the hinge, from one side of it to the other.
  for (int n = 0; n <= 2000; ++n) {
    const double z = kSide * (n / 1000.0 - 1);
    const std::vector<Vec3> x{{0, -1e-6, z}, {kSide, -1e-6, z}, {0, 0, 0},
                              {kSide, 0, 0}, {0, kSide, 0},     {kSide, kSide, 0}};
    const auto c = sim::bendCondition(test::plain<double>(x).data(), 0.3, 1 / kSide, kSmallest * kSmallest);
    const double energy = c.value * c.value;
    if (n > 0) jump = std::max(jump, std::abs(energy - before));
    largest = std::max(largest, energy);
    // Only crushed walls are held by more than the condition's own stiffness, and not against common motion.
    EXPECT_EQ(c.crush > 0, std::abs(z) < 0.3 * kSide && std::abs(c.value) > 0) << "at " << z;
    crush = std::max(crush, c.crush);
    before = energy;
  }
  EXPECT_LT(jump, 0.02 * largest);
  EXPECT_GT(crush, 0);
  for (int u = 0; u < 6; ++u) {
    double sum = 0;
    for (int v = 0; v < 6; ++v) sum += sim::crushWeight(u, v);
    EXPECT_EQ(sum, 0);
  }
}

TEST(VolumeForce, IsThePapersEquationsToTheLetter) {
  test::Random random(10);
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<Vec3> x;
    for (int i = 0; i < 4; ++i) x.push_back(random.vector(1));
    const double rest = random(-1, 1), k = random(0.1, 10);
    const Vec3 e1 = x[1] - x[0], e2 = x[2] - x[0], e3 = x[3] - x[0];
    const double c = e1.dot(e2.cross(e3)) / 6 - rest;  // (1)
    const auto condition = sim::volumeCondition(test::plain<double>(x).data(), rest);
    EXPECT_NEAR(condition.value, c, 1e-14);
    // The forces printed below (2), whose k holds the sixth of dC/dx.
    const double printed_k = k / 6;
    const Vec3 f[4] = {printed_k * (e2 - e1).cross(e3 - e1) * c, printed_k * e3.cross(e2) * c,
                       printed_k * e1.cross(e3) * c, printed_k * e2.cross(e1) * c};
    for (int i = 0; i < 4; ++i) EXPECT_LT((-k * c * test::eigen(condition.g[i]) - f[i]).norm(), 1e-13);
  }
}

// Figure 2: a tetrahedron on the ground, its apex above (rest), lowered, on the ground, below it.
TEST(VolumeForce, PushesTowardsTheRestVolumeWhenCompressedFlattenedAndInverted) {
  const std::vector<Vec3> rest{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0.3, 1, 0.3}};
  const double rest_volume = sim::volumeCondition(test::plain<double>(rest).data(), 0.0).value;
  ASSERT_GT(rest_volume, 0);
  for (const double height : {2.0, 1.2, 0.5, 0.1, 0.0, -0.1, -1.0}) {
    std::vector<Vec3> x = rest;
    x[3].y() = height;
    const auto c = sim::volumeCondition(test::plain<double>(x).data(), rest_volume);
    const double wanted = height < 1 ? 1 : -1;
    const Vec3 apex = -c.value * test::eigen(c.g[3]);
    EXPECT_GT(wanted * apex.y(), 0) << "apex force at height " << height;
    EXPECT_LT(Vec3(apex.x(), 0, apex.z()).norm(), 1e-12);
    for (int i = 0; i < 3; ++i) EXPECT_LT(wanted * -c.value * c.g[i].y, 1e-12) << "the base goes the other way";
    // Following the forces a little brings the volume nearer.
    double rate = 0;
    for (int i = 0; i < 4; ++i) rate += -c.value * sim::dot(c.g[i], c.g[i]);
    EXPECT_GT(wanted * rate, 0);
  }
}

TEST(VolumeForce, AFlattenedOrInvertedTetrahedronFlowsBackToItsVolume) {
  for (const double height : {0.0, -0.4, -1.0}) {
    std::vector<Vec3> x{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0.3, height, 0.3}};
    const double rest_volume = 1.0 / 6;
    for (int step = 0; step < 400; ++step) {
      const auto c = sim::volumeCondition(test::plain<double>(x).data(), rest_volume);
      for (int i = 0; i < 4; ++i) x[i] -= 2 * c.value * test::eigen(c.g[i]);
    }
    EXPECT_NEAR(sim::volumeCondition(test::plain<double>(x).data(), 0.0).value, rest_volume, 1e-6);
  }
}

// Forces at the styled pose against the weight there, as a share of it.
double imbalance(const sim::HairMesh& mesh, const ForceModel<double>& model, const sim::SimParams& params) {
  const auto force = forceAt(model, mesh.shape.positions);
  double residual = 0, weight = 0;
  for (int i = 0; i < mesh.vertexCount(); ++i) {
    if (mesh.isRoot(i)) continue;
    const Vec3 gravity(0, -params.density * mesh.vertex_volume[i] * params.gravity, 0);
    residual += (test::eigen(force[i]) + gravity).squaredNorm();
    weight += gravity.squaredNorm();
  }
  return std::sqrt(residual / weight);
}

TEST(SagFree, TheStyledPoseCarriesItsWeight) {
  test::PatchOptions hanging, initial_overlap;
  hanging.mixed = hanging.uneven = true;
  initial_overlap.direction = Vec3(0, 1, 0);
  initial_overlap.length = 0.1;
  for (const test::PatchOptions& o : {hanging, initial_overlap}) {
    const sim::HairMesh mesh = sim::buildHairMesh(test::combedShape(o));
    const sim::SimParams params = test::tautHair();
    const ForceModel<double> model = test::makeForceModel(mesh, sim::systemPattern(mesh), params);
    const double residual = imbalance(mesh, model, params);
    std::printf("relative residual of the balance: %.1e\n", residual);
    EXPECT_LT(residual, 1e-9);
    const ForceModel<double> slack = test::makeForceModel(mesh, sim::systemPattern(mesh), withoutSagFree());
    EXPECT_LT(largest(forceAt(slack, mesh.shape.positions)), 1e-9) << "without it the styled pose is free of force";
  }
}

// While a slider is dragged the balance follows by products: stiffness times shift, and load, keep it exact.
TEST(SagFree, TheStyledPoseCarriesItsWeightWhileStiffnessAndWeightFollow) {
  const sim::HairMesh mesh = combedMesh();
  const BlockPattern pattern = sim::systemPattern(mesh);
  sim::SimParams params = test::tautHair();
  sim::Material material(mesh, pattern);
  material.set(params);
  EXPECT_LT(imbalance(mesh, material.model, params), 1e-9);
  params.bend *= 1.7, params.stretch_along *= 0.6, params.volume *= 1.3, params.shear *= 2;
  material.follow(params);
  EXPECT_LT(imbalance(mesh, material.model, params), 1e-9) << "other stiffnesses";
  params.density *= 1.2, params.gravity *= 0.5;
  material.follow(params);
  EXPECT_LT(imbalance(mesh, material.model, params), 1e-9) << "another weight";
}

}  // namespace elastic_laws_test

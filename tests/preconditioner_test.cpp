// The preconditioners and what they are made of: factors, rotations, the matrix.
#include "sim/preconditioner.h"

#include "sim/preconditioner_choice.h"
#include "sim/rotation.h"
#include "sim/vector_kernels.h"
#include "tests/linear_systems.h"

namespace tests {
namespace {

TEST(Preconditioners, DirectFactorSolvesAtOnceAndWarpedFactorFollowsARigidTurn) {
  sim::StopRule<double> stop;
  stop.relative = 1e-10;
  const auto iterations = [&](const System& system, Solver solver) {
    test::Random random(51);
    const Problem p = makeProblem(system, 0, random);
    Eigen::VectorXd x;
    return solve<double>(system, system.matrixAt<double>(system.positions), p, solver, stop, x).iterations;
  };
  EXPECT_LE(iterations(System(0.004), Solver::kDirect), 2);
  EXPECT_LE(iterations(System(0), Solver::kWarped), 2);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(1.2, Vec3(1, 2, 3).normalized()));
  EXPECT_LE(iterations(System(0, turn), Solver::kWarped), 4) << "the rest matrix turned is the matrix";
  EXPECT_LT(iterations(System(0.001, turn), Solver::kWarped),
            iterations(System(0.001, turn), Solver::kBlockJacobi) / 2);
}

// Symmetric to rounding, whatever 16 bits have done to the entries, and close enough to cost no iteration.
TEST(Preconditioners, TheFactorInSixteenBitsServesAsTheFullOneDoes) {
  const System system(0.0);
  const BlockMatrix<float> a = system.matrixAt<float>(system.positions);
  std::vector<unsigned char> keep(system.mesh.vertexCount());
  for (int i = 0; i < system.mesh.vertexCount(); ++i) keep[i] = !system.mesh.isRoot(i);
  sim::BlockCholesky<float> factor;
  factor.analyze(system.mesh, system.pattern, keep);
  ASSERT_TRUE(factor.factor(a));
  sim::CompactFactor compact;
  compact.assign(factor);
  EXPECT_LT(compact.bytes(), 0.75 * sizeof(float) * factor.values.size());
  const std::size_t n = keep.size();
  test::Random random(51);
  std::vector<V3<float>> r[2], z[2], exact(n);
  for (int side = 0; side < 2; ++side) {
    std::vector<Vec3> values(n);
    for (std::size_t i = 0; i < n; ++i) values[i] = keep[i] ? random.vector(1) : Vec3(Vec3::Zero());
    r[side] = test::plain<float>(values);
    z[side].resize(n);
    compact.solve(factor, r[side], z[side]);
  }
  const auto inner = [&](const std::vector<V3<float>>& u, const std::vector<V3<float>>& v) {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += static_cast<double>(dot(u[i], v[i]));
    return sum;
  };
  const double scale = std::sqrt(inner(r[0], z[0]) * inner(r[1], z[1]));
  EXPECT_NEAR(inner(r[0], z[1]), inner(r[1], z[0]), 1e-4 * scale);
  factor.solve(r[0], exact);
  for (std::size_t i = 0; i < n; ++i) exact[i] -= z[0][i];
  const double wrong = std::sqrt(inner(exact, exact) / inner(z[0], z[0]));
  std::printf("solutions differ by %.1e\n", wrong);
  EXPECT_LT(wrong, 0.05);
  EXPECT_GT(wrong, 1e-6) << "sixteen bits leave a trace: is it the compact factor that was run?";
  // What a panel left behind must not reach the next solve.
  std::vector<V3<float>> broken = r[0], again(n);
  broken[n - 1].x = std::numeric_limits<float>::quiet_NaN();
  compact.solve(factor, broken, again);
  compact.solve(factor, r[0], again);
  for (std::size_t i = 0; i < n; ++i) EXPECT_EQ(again[i].x, z[0][i].x);

  const System bent(0.004);
  const BlockMatrix<float> b = bent.matrixAt<float>(bent.positions);
  const Problem p = makeProblem(bent, 0, random);
  int iterations[2];
  for (const bool small : {false, true}) {
    sim::Preconditioner<float> preconditioner = bent.preconditioner(b, Solver::kWarped);
    ASSERT_TRUE(preconditioner.setRestMatrix(bent.matrixAt<float>(bent.mesh.shape.positions), small));
    sim::SolverScratch<float> scratch;
    scratch.resize(static_cast<int>(n));
    auto x = test::plain<float>(p.guess);
    const auto rhs = test::plain<float>(p.rhs);
    const Filter<float> filter = filterOf<float>(p);
    sim::StopRule<float> stop;
    iterations[small] = sim::solveModifiedPcg<float>(b, rhs, filter, preconditioner, stop, scratch, x).iterations;
  }
  EXPECT_LE(iterations[1], iterations[0] + 1);
}

template <class T>
void batchIsManySolves(double bound) {
  const System system(0.004);
  const BlockMatrix<T> a = system.matrixAt<T>(system.positions);
  std::vector<unsigned char> free_vertex;
  for (int i = 0; i < system.mesh.vertexCount(); ++i) free_vertex.push_back(!system.mesh.isRoot(i));
  sim::BlockCholesky<T> factor;
  factor.analyze(system.mesh, system.pattern, free_vertex);
  ASSERT_TRUE(factor.factor(a));
  constexpr int kSides = sim::BlockCholesky<T>::kBatch;
  test::Random random(81);
  std::vector<T> batch(3 * factor.order.size() * kSides, T(0));
  std::vector<std::vector<V3<T>>> sides(kSides, std::vector<V3<T>>(system.mesh.vertexCount(), V3<T>{0, 0, 0}));
  std::vector<int> touched;
  for (int k = 0; k < kSides; ++k) {
    const int position = static_cast<int>(random(0, static_cast<double>(factor.order.size()) - 1e-6));
    touched.push_back(position);
    const Vec3 f = random.vector(1);
    sides[k][factor.order[position]] = {static_cast<T>(f.x()), static_cast<T>(f.y()), static_cast<T>(f.z())};
    for (int axis = 0; axis < 3; ++axis) batch[(3 * position + axis) * kSides + k] = static_cast<T>(f[axis]);
  }
  factor.solveBatch(batch, touched);
  for (int k = 0; k < kSides; ++k) {
    std::vector<V3<T>> z(system.mesh.vertexCount());
    factor.solve(sides[k], z);
    double largest = 0, difference = 0;
    for (std::size_t position = 0; position < factor.order.size(); ++position) {
      const V3<T>& one = z[factor.order[position]];
      const T* many = batch.data() + 3 * position * kSides + k;
      const V3<T> gap = one - V3<T>{many[0], many[kSides], many[2 * kSides]};
      largest = std::max(largest, std::sqrt(static_cast<double>(dot(one, one))));
      difference = std::max(difference, std::sqrt(static_cast<double>(dot(gap, gap))));
    }
    EXPECT_GT(largest, 0);
    EXPECT_LT(difference, bound * largest) << k;
  }
}

TEST(Preconditioners, ABatchOfRightHandSidesIsAsManySolves) {
  batchIsManySolves<float>(1e-4);
  batchIsManySolves<double>(1e-12);
}

// More contacts than are answered for: the rest is left to the filter, and the solution stays right.
TEST(Preconditioners, ContactsBeyondTheCorrectedOnesAreLeftToTheFilter) {
  const System system(0.004);
  const BlockMatrix<double> a = system.matrixAt<double>(system.positions);
  const Eigen::MatrixXd dense = test::dense(a);
  sim::Preconditioner<double> preconditioner = system.preconditioner(a, Solver::kWarped);
  sim::SolverScratch<double> scratch;
  scratch.resize(system.mesh.vertexCount());
  for (const int seed : {61, 62}) {  // the second set takes the places of the first
    test::Random random(seed);
    const Problem p = makeProblem(system, -1, random);
    std::vector<sim::VertexConstraint> many = p.constraints;
    EXPECT_FALSE(preconditioner.setConstraints(many, 1)) << "one batch is not enough";
    preconditioner.setConstraints(many);
    auto x = test::plain<double>(p.guess);
    sim::StopRule<double> stop;
    stop.relative = 1e-12;
    stop.max_iterations = 5000;
    const auto rhs = test::plain<double>(p.rhs);
    const Filter<double> filter = filterOf<double>(p);
    const auto report = sim::solveModifiedPcg<double>(a, rhs, filter, preconditioner, stop, scratch, x);
    EXPECT_TRUE(report.converged);
    std::vector<Vec3> points(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) points[i] = Vec3(x[i].x, x[i].y, x[i].z);
    const Eigen::VectorXd exact = denseSolution(dense, p);
    EXPECT_LT(energyNorm(dense, stackedPoints(points) - exact) / energyNorm(dense, exact), 1e-8);
  }
}

// The layers' factor is the direct solve of the matrix without the couplings between layers, in both layouts.
template <class T>
void layersAreSolvedOneByOne(double bound) {
  test::PatchOptions o;
  o.nx = 4, o.nz = 3, o.layers = 11, o.mixed = true;
  sim::HairMeshShape shape = test::combedShape(o);
  const sim::HairMesh mesh = sim::buildHairMesh(shape);
  const sim::BlockPattern pattern = sim::systemPattern(mesh);
  const sim::ColumnLayout layout(mesh);
  const sim::ColumnPattern columns(mesh, layout);
  test::Random random(91);
  sim::ColumnMatrix<T> packed(layout, columns);
  // Any symmetric matrix with a heavy diagonal; what lies in the padding must not matter.
  for (T& value : packed.values) value = static_cast<T>(random(-1, 1));
  packed.addMass(T(40), std::vector<T>(mesh.vertexCount(), T(1)));
  BlockMatrix<T> a(&pattern);
  packed.toBlocks(mesh, a);
  const int n = mesh.vertexCount();
  BlockMatrix<T> within = a;
  for (int i = 0; i < n; ++i) {
    for (int k = pattern.row_first[i]; k < pattern.row_first[i + 1]; ++k) {
      if (mesh.layer_of[i] != mesh.layer_of[pattern.columns[k]]) within.lower[k] = {};
    }
  }
  std::vector<V3<T>> x(n), r(n), z(n);
  for (V3<T>& p : x) p = {static_cast<T>(random(-1, 1)), static_cast<T>(random(-1, 1)), static_cast<T>(random(-1, 1))};
  sim::multiply<T>(within, x, r);
  sim::LayerFactor<T> factor(mesh, layout, columns);
  for (const bool by_blocks : {false, true}) {
    if (by_blocks) {
      factor.factor(a);
    } else {
      factor.factor(packed);
    }
    sim::ColumnField<T> field(layout);
    field.pack(layout, r);
    factor.solve(field);
    field.unpack(layout, z);
    double worst = 0;
    for (int i = 0; i < n; ++i) worst = std::max(worst, std::sqrt(static_cast<double>(dot(z[i] - x[i], z[i] - x[i]))));
    EXPECT_LT(worst, bound) << by_blocks;
  }
}

TEST(TwoLevel, LayersAreSolvedOneByOne) {
  layersAreSolvedOneByOne<float>(1e-4);
  layersAreSolvedOneByOne<double>(1e-12);
}

// The answer of the patches is the best of all their rigid motions: against a dense projection made by hand. They move
// neither roots nor held vertices, and know which they held.
template <class T>
void patchesAnswerBest(double bound) {
  test::PatchOptions o;
  o.nx = 9, o.nz = 8, o.layers = 20, o.mixed = o.uneven = true;  // padding everywhere: values there are arbitrary here
  const sim::HairMesh mesh = sim::buildHairMesh(test::combedShape(o));
  const sim::BlockPattern pattern = sim::systemPattern(mesh);
  const sim::ColumnLayout layout(mesh);
  const sim::ColumnPattern columns(mesh, layout);
  const int n = mesh.vertexCount();
  test::Random random(97);
  sim::ColumnMatrix<T> packed(layout, columns);
  for (T& value : packed.values) value = static_cast<T>(random(-1, 1));
  packed.addMass(T(200), std::vector<T>(n, T(1)));
  BlockMatrix<T> a(&pattern);
  // What no element couples, at uneven tips, is zero in a true matrix.
  for (const sim::BlockDiagonal& d : columns.diagonals) {
    for (int l = 0; !d.symmetric() && l < columns.stride; ++l) {
      const int m = l + d.offset;
      const bool both = m >= 0 && l < layout.length[d.a] && m < layout.length[d.b];
      const int i = mesh.shape.column_first[d.a] + l, j = mesh.shape.column_first[d.b] + m;
      if (both && pattern.find(std::max(i, j), std::min(i, j)) >= 0) continue;
      for (int k = 0; both && k < 9; ++k) packed.values[d.values + k * columns.stride + l] = 0;
    }
  }
  packed.toBlocks(mesh, a);
  std::vector<sim::VertexConstraint> constraints;
  for (int i = 0; i < n; i += 7) {
    if (!mesh.isRoot(i)) constraints.push_back({i, Eigen::Matrix3d::Zero(), Vec3::Zero(), 3, {}});
  }
  const std::vector<V3<T>> x = test::plain<T>(mesh.shape.positions);
  sim::PatchSpace<T> patches(mesh, layout, columns);
  EXPECT_GT(patches.patches(), 2);
  EXPECT_LT(patches.patches(), n / 12);
  std::vector<V3<T>> r(n), z[2] = {std::vector<V3<T>>(n), std::vector<V3<T>>(n)};
  for (V3<T>& p : r) p = {static_cast<T>(random(-1, 1)), static_cast<T>(random(-1, 1)), static_cast<T>(random(-1, 1))};
  for (const bool by_blocks : {false, true}) {
    ASSERT_TRUE(by_blocks ? patches.make(a, x, constraints) : patches.make(packed, x, constraints));
    sim::ColumnField<T> field(layout);
    field.pack(layout, r);
    patches.solve(field);
    field.setZero();
    patches.add(field);
    field.unpack(layout, z[by_blocks]);
  }
  EXPECT_EQ(patches.unknown(constraints), 0);
  std::vector<sim::VertexConstraint> more = constraints;
  more.push_back({mesh.shape.column_first[1] + 3, Eigen::Matrix3d::Zero(), Vec3::Zero(), 3, {}});
  EXPECT_EQ(patches.unknown(more), (mesh.shape.column_first[1] + 3) % 7 == 0 ? 0 : 1);
  for (int i = 0; i < n; ++i) {
    EXPECT_NEAR(static_cast<double>(z[0][i].x), static_cast<double>(z[1][i].x), bound);
    if (mesh.isRoot(i) || i % 7 == 0) {
      EXPECT_EQ(dot(z[0][i], z[0][i]), T(0)) << i;
    }
  }
  // P r of a projection: z . A z = z . r, and z moves each patch rigidly: vertices of one column keep their distances
  // to first order.
  std::vector<V3<T>> az(n);
  sim::multiply<T>(a, z[0], az);
  const double along = sim::innerProduct<T>(z[0], r), energy = sim::innerProduct<T>(z[0], az);
  EXPECT_GT(along, 0);
  EXPECT_NEAR(energy / along, 1, 1e-3) << "the raised diagonal takes a little";
  int kept = 0;
  for (int i = 0; i + 1 < n; ++i) {
    const bool one_patch = mesh.column_of[i] == mesh.column_of[i + 1] && !mesh.isRoot(i) &&
                           mesh.layer_of[i] % sim::PatchSpace<T>::kLayers != 0 && i % 7 != 0 && (i + 1) % 7 != 0;
    if (!one_patch) continue;
    EXPECT_NEAR(static_cast<double>(dot(z[0][i + 1] - z[0][i], x[i + 1] - x[i])), 0, bound) << i;
    ++kept;
  }
  EXPECT_GT(kept, n / 3);
}

TEST(TwoLevel, PatchesAnswerBest) {
  patchesAnswerBest<float>(1e-5);
  patchesAnswerBest<double>(1e-12);
}

// P is symmetric and positive, and beats the 3x3 blocks by more the longer the hair.
TEST(TwoLevel, IsSymmetricAndNeedsFewerIterationsThanBlocks) {
  const System system(0.002);
  const BlockMatrix<double> a = system.matrixAt<double>(system.positions);
  auto preconditioner = system.preconditioner(a, Solver::kTwoLevel);
  const std::size_t n = system.positions.size();
  test::Random random(95);
  std::vector<V3<double>> r[2], z[2];
  for (int side = 0; side < 2; ++side) {
    std::vector<Vec3> values(n);
    for (std::size_t i = 0; i < n; ++i)
      values[i] = system.mesh.isRoot(static_cast<int>(i)) ? Vec3(0, 0, 0) : random.vector(1);
    r[side] = test::plain<double>(values);
    z[side].resize(n);
    preconditioner.apply(r[side], z[side]);
  }
  double across[2] = {0, 0}, along = 0;
  for (std::size_t i = 0; i < n; ++i) {
    across[0] += dot(r[0][i], z[1][i]);
    across[1] += dot(r[1][i], z[0][i]);
    along += dot(r[0][i], z[0][i]);
  }
  EXPECT_GT(along, 0);
  EXPECT_NEAR(across[0], across[1], 1e-9 * along);
  const Problem p = makeProblem(system, 0, random);
  sim::StopRule<double> stop;
  stop.relative = 1e-4;
  Eigen::VectorXd x;
  const int blocks = solve<double>(system, a, p, Solver::kBlockJacobi, stop, x).iterations;
  const int levels = solve<double>(system, a, p, Solver::kTwoLevel, stop, x).iterations;
  std::printf("iterations: 3x3 blocks %d, two levels %d\n", blocks, levels);
  EXPECT_LT(3 * levels, 2 * blocks);
}

// The factors of layers and of columns are direct solves of the matrix without the couplings between them and without
// the directions that constraints remove, in both layouts.
template <class T>
void partsAreSolvedWithoutRemovedDirections(double bound) {
  test::PatchOptions o;
  o.nx = 4, o.nz = 3, o.layers = 11, o.mixed = o.uneven = true;
  const sim::HairMesh mesh = sim::buildHairMesh(test::combedShape(o));
  const sim::BlockPattern pattern = sim::systemPattern(mesh);
  const sim::ColumnLayout layout(mesh);
  const sim::ColumnPattern columns(mesh, layout);
  const int n = mesh.vertexCount();
  test::Random random(92);
  sim::ColumnMatrix<T> packed(layout, columns);
  for (T& value : packed.values) value = static_cast<T>(random(-1, 1));
  packed.addMass(T(40), std::vector<T>(n, T(1)));
  BlockMatrix<T> a(&pattern);
  packed.toBlocks(mesh, a);
  std::vector<sim::VertexConstraint> constraints;
  std::vector<Eigen::Matrix3d> keep(n, Eigen::Matrix3d::Identity());
  for (int i = 0; i < n; ++i) {
    const int count = mesh.isRoot(i) ? 0 : static_cast<int>(random(0, 3.999));
    const Vec3 d = random.direction();
    if (count == 1) keep[i] -= d * d.transpose();
    if (count == 2) keep[i] = d * d.transpose();
    if (count == 3) keep[i].setZero();
    if (count > 0) constraints.push_back({i, keep[i], Vec3::Zero(), count, {d, d, d}});
  }
  const Eigen::MatrixXd whole = test::dense(a), s = filterMatrix(keep);
  sim::LayerFactor<T> layers(mesh, layout, columns);
  sim::StrandFactor<T> strands(mesh, layout, columns);
  for (const bool by_strands : {false, true}) {
    const auto apart = [&](int i, int j) {
      if (i == j) return false;
      if (!by_strands) return mesh.layer_of[i] != mesh.layer_of[j];
      return mesh.column_of[i] != mesh.column_of[j] || mesh.isRoot(i) || mesh.isRoot(j);
    };
    Eigen::MatrixXd part = whole;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        if (apart(i, j)) part.block<3, 3>(3 * i, 3 * j).setZero();
      }
    }
    part = (s * part * s).eval();
    for (int i = 0; i < n; ++i) {
      const double trace = whole.block<3, 3>(3 * i, 3 * i).trace();
      part.block<3, 3>(3 * i, 3 * i) += trace * (Eigen::Matrix3d::Identity() - keep[i]);
    }
    std::vector<Vec3> wanted(n);
    for (int i = 0; i < n; ++i) wanted[i] = by_strands && mesh.isRoot(i) ? Vec3(Vec3::Zero()) : random.vector(1);
    const Eigen::VectorXd product = part * stackedPoints(wanted);
    std::vector<Vec3> forces(n);
    for (int i = 0; i < n; ++i) forces[i] = product.segment<3>(3 * i);
    const std::vector<V3<T>> r = test::plain<T>(forces);
    for (const bool by_blocks : {false, true}) {
      std::vector<V3<T>> z(n, V3<T>{0, 0, 0});
      const auto factor = [&](auto& parts) {
        if (by_blocks) {
          parts.factor(a, constraints);
        } else {
          parts.factor(packed, constraints);
        }
      };
      if (by_strands) {
        factor(strands);
        strands.addSolution(r, T(1), z);
      } else {
        factor(layers);
        sim::ColumnField<T> field(layout);
        field.pack(layout, r);
        layers.solve(field);
        field.unpack(layout, z);
      }
      EXPECT_LT((test::stacked<T>(z) - stackedPoints(wanted)).cwiseAbs().maxCoeff(), bound) << by_strands << by_blocks;
    }
  }
}

TEST(TwoLevel, PartsAreSolvedWithoutRemovedDirections) {
  partsAreSolvedWithoutRemovedDirections<float>(1e-4);
  partsAreSolvedWithoutRemovedDirections<double>(1e-12);
}

// Contacts that P knows of leave it symmetric and positive, and cost hardly an iteration; those that it does not know
// of cost about one each.
TEST(TwoLevel, ContactsItKnowsOfCostFewIterations) {
  const System system(0.002);
  const BlockMatrix<double> a = system.matrixAt<double>(system.positions);
  sim::StopRule<double> stop;
  stop.relative = 1e-4;
  sim::SolverScratch<double> scratch;
  scratch.resize(system.mesh.vertexCount());
  const auto iterations = [&](int removed, bool known) {
    test::Random random(96);
    const Problem p = makeProblem(system, removed, random);
    auto preconditioner = system.preconditioner(a, Solver::kTwoLevel);
    if (known) preconditioner.update(a, Solver::kTwoLevel, p.constraints);
    const Filter<double> filter = filterOf<double>(p);
    std::vector<V3<double>> r[2], z[2];
    for (int side = 0; side < 2; ++side) {
      std::vector<Vec3> values(system.positions.size());
      for (Vec3& value : values) value = random.vector(1);
      r[side] = test::plain<double>(values);
      filter.apply(r[side]);
      z[side].resize(values.size());
      preconditioner.apply(r[side], z[side]);
    }
    const double along = sim::innerProduct<double>(r[0], z[0]);
    EXPECT_GT(along, 0);
    EXPECT_NEAR(sim::innerProduct<double>(r[0], z[1]), sim::innerProduct<double>(r[1], z[0]), 1e-9 * along);
    auto x = test::plain<double>(p.guess);
    const auto rhs = test::plain<double>(p.rhs);
    const auto report = sim::solveModifiedPcg<double>(a, rhs, filter, preconditioner, stop, scratch, x);
    EXPECT_TRUE(report.converged);
    return report.iterations;
  };
  const int none = iterations(0, false);
  for (const int removed : {1, 2, 3}) {
    const int known = iterations(removed, true), unknown = iterations(removed, false);
    std::printf("%d directions removed of every other vertex: %d iterations, unknown %d; without contacts %d\n",
                removed, known, unknown, none);
    EXPECT_LE(known, none + 2);
    EXPECT_LT(known, unknown);
  }
}

// Total cost over solves of which the two kinds cost `factor` and `blocks`.
double costOfSolves(sim::PreconditionerChoice& choice, int solves, double factor, double blocks) {
  double total = 0;
  for (int k = 0; k < solves; ++k) {
    const auto plan = choice.begin();
    const double wanted = plan.cheap ? blocks : factor;
    const bool overrun = wanted > plan.budget;
    const double cost = overrun ? plan.budget + (plan.cheap ? factor : blocks) : wanted;
    choice.end(plan, cost, overrun);
    total += cost;
  }
  return total;
}

TEST(PreconditionerChoice, IsNeverMuchDearerThanTheBetterOfTheTwo) {
  for (const auto& [factor, blocks] : {std::pair{10.0, 100.0},
                                       {60.0, 100.0},
                                       {100.0, 60.0},
                                       {400.0, 50.0},
                                       {100.0, 1000.0},
                                       {50.0, 400.0},
                                       {500.0, 500.0}}) {
    sim::PreconditionerChoice choice;
    costOfSolves(choice, 50, factor, blocks);
    EXPECT_LT(costOfSolves(choice, 500, factor, blocks), 1.15 * 500 * std::min(factor, blocks))
        << factor << " " << blocks;
  }
}

TEST(PreconditionerChoice, FollowsTheMotionAndTriesNothingWhereSolvesAreCheap) {
  sim::PreconditionerChoice choice;
  EXPECT_EQ(costOfSolves(choice, 100, 10, 5), 1000) << "the factor serves, and nothing else is tried";
  costOfSolves(choice, 100, 500, 50);
  EXPECT_TRUE(choice.cheap);
  costOfSolves(choice, 200, 20, 50);
  EXPECT_FALSE(choice.cheap);
}

TEST(BlockMatrix, ProductIsTheDenseOne) {
  const System system(0.004);
  const BlockMatrix<double> a = system.matrixAt<double>(system.positions);
  test::Random random(61);
  std::vector<Vec3> x;
  for (int i = 0; i < system.mesh.vertexCount(); ++i) x.push_back(random.vector(1));
  const auto points = test::plain<double>(x);
  std::vector<V3<double>> y(points.size());
  sim::multiply<double>(a, points, y);
  const Eigen::VectorXd expected = test::dense(a) * stackedPoints(x);
  EXPECT_LT((test::stacked<double>(y) - expected).norm(), 1e-13 * expected.norm());
  EXPECT_EQ(system.pattern.find(1, 0) >= 0, true);
  EXPECT_EQ(system.pattern.find(system.pattern.size - 1, 0), -1);
}

TEST(VertexRotations, AreTheTurnOfARigidMotionAndStayRotationsInEveryState) {
  const System system(0);
  test::Random random(71);
  for (int trial = 0; trial < 10; ++trial) {
    const Eigen::Quaterniond turn = random.rotation();
    std::vector<Vec3> x;
    for (const Vec3& p : system.mesh.shape.positions) x.push_back(turn * p + Vec3(1, 2, 3));
    sim::VertexRotations<double> rotations(system.mesh);
    for (int k = 0; k < 60; ++k) rotations.update(test::plain<double>(x));
    for (const auto& r : rotations.matrices) {
      EXPECT_LT((test::eigen(r) - turn.toRotationMatrix()).norm(), 1e-6);
    }
    for (const double scale : {0.0, 1e-9, 0.3}) {  // collapsed, nearly so, random
      for (Vec3& p : x) p = random.vector(scale);
      rotations.update(test::plain<double>(x));
      for (const auto& r : rotations.matrices) {
        EXPECT_LT((test::eigen(r) * test::eigen(r).transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
        EXPECT_GT(test::eigen(r).determinant(), 0);
      }
    }
  }
}

}  // namespace
}  // namespace tests

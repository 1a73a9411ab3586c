// The two levels: factors of layers and columns, rigid motions of patches, and what they are together.
#include "sim/linear/two_level.h"

#include "sim/linear/coarse_space.h"
#include "sim/linear/vector_kernels.h"
#include "tests/block_product.h"
#include "tests/linear_systems.h"

namespace tests {
namespace two_level_test {

// Any symmetric matrix with a heavy diagonal, in both layouts; what lies in the padding must not matter.
template <class T>
struct RandomSystem {
  sim::HairMesh mesh;
  sim::BlockPattern pattern = sim::systemPattern(mesh);
  sim::ColumnLayout layout{mesh};
  sim::ColumnPattern columns{mesh, layout};
  test::Random random;
  sim::ColumnMatrix<T> packed{layout, columns};
  BlockMatrix<T> a{&pattern};

  RandomSystem(const test::PatchOptions& o, int seed, double diagonal)
      : mesh(sim::buildHairMesh(test::combedShape(o))), random(seed) {
    for (T& value : packed.values) value = static_cast<T>(random(-1, 1));
    packed.addMass(static_cast<T>(diagonal), std::vector<T>(mesh.vertexCount(), T(1)));
    bench::toBlocks(mesh, packed, a);
  }
  RandomSystem(const RandomSystem&) = delete;
  RandomSystem& operator=(const RandomSystem&) = delete;

  std::vector<V3<T>> vectors() {
    const auto draw = [&] { return static_cast<T>(random(-1, 1)); };
    std::vector<V3<T>> values(mesh.vertexCount());
    for (V3<T>& p : values) p.x = draw(), p.y = draw(), p.z = draw();
    return values;
  }
};

// The layers' factor is the direct solve of the matrix without the couplings between layers.
template <class T>
void layersAreSolvedOneByOne(double bound) {
  test::PatchOptions o;
  o.nx = 4, o.nz = 3, o.layers = 11, o.mixed = true;
  RandomSystem<T> system(o, 91, 40);
  const auto& [mesh, pattern, layout, columns, random, packed, a] = system;
  const int n = mesh.vertexCount();
  BlockMatrix<T> within = a;
  for (int i = 0; i < n; ++i) {
    for (int k = pattern.row_first[i]; k < pattern.row_first[i + 1]; ++k) {
      if (mesh.layer_of[i] != mesh.layer_of[pattern.columns[k]]) within.lower[k] = {};
    }
  }
  const std::vector<V3<T>> x = system.vectors();
  std::vector<V3<T>> r(n), z(n);
  sim::multiply<T>(within, x, r);
  sim::LayerFactor<T> factor(mesh, layout, columns);
  factor.factor(packed);
  sim::ColumnField<T> field(layout);
  field.pack(layout, r);
  factor.solve(field);
  field.unpack(layout, z);
  double worst = 0;
  for (int i = 0; i < n; ++i) worst = std::max(worst, std::sqrt(static_cast<double>(dot(z[i] - x[i], z[i] - x[i]))));
  EXPECT_LT(worst, bound);
}

TEST(TwoLevel, LayersAreSolvedOneByOne) {
  layersAreSolvedOneByOne<float>(1e-4);
  layersAreSolvedOneByOne<double>(1e-12);
}

// What no element couples, at uneven tips, is zero in a true matrix.
template <class T>
void clearUncoupled(RandomSystem<T>& system) {
  auto& [mesh, pattern, layout, columns, random, packed, a] = system;
  for (const sim::BlockDiagonal& d : columns.diagonals) {
    for (int l = 0; !d.symmetric() && l < columns.stride; ++l) {
      const int m = l + d.offset;
      const bool both = m >= 0 && l < layout.length[d.a] && m < layout.length[d.b];
      const int i = mesh.shape.column_first[d.a] + l, j = mesh.shape.column_first[d.b] + m;
      if (both && pattern.find(std::max(i, j), std::min(i, j)) >= 0) continue;
      for (int k = 0; both && k < 9; ++k) packed.values[d.values + k * columns.stride + l] = 0;
    }
  }
  bench::toBlocks(mesh, packed, a);
}

// P r of a projection: z . A z = z . r, and z moves each patch rigidly: vertices of one column keep their distances to
// first order. Every seventh vertex is held.
template <class T>
void expectRigidProjection(const RandomSystem<T>& system, const std::vector<V3<T>>& r, const std::vector<V3<T>>& z,
                           double bound) {
  const auto& mesh = system.mesh;
  const int n = mesh.vertexCount();
  const std::vector<V3<T>> x = test::plain<T>(mesh.shape.positions);
  std::vector<V3<T>> az(n);
  sim::multiply<T>(system.a, z, az);
  const double along = sim::innerProduct<T>(z, r), energy = sim::innerProduct<T>(z, az);
  EXPECT_GT(along, 0);
  EXPECT_NEAR(energy / along, 1, 1e-3) << "the raised diagonal takes a little";
  int kept = 0;
  for (int i = 0; i + 1 < n; ++i) {
    const bool one_patch = mesh.column_of[i] == mesh.column_of[i + 1] && !mesh.isRoot(i) &&
                           mesh.layer_of[i] % sim::CoarseSpace<T>::kLayers != 0 && i % 7 != 0 && (i + 1) % 7 != 0;
    if (!one_patch) continue;
    EXPECT_NEAR(static_cast<double>(dot(z[i + 1] - z[i], x[i + 1] - x[i])), 0, bound) << i;
    ++kept;
  }
  EXPECT_GT(kept, n / 3);
}

// The answer of the patches is the best of all their rigid motions: against a dense projection made by hand. They move
// neither roots nor held vertices, and know which they held.
template <class T>
void patchesAnswerBest(double bound) {
  test::PatchOptions o;
  o.nx = 9, o.nz = 8, o.layers = 20, o.mixed = o.uneven = true;  // padding everywhere: values there are arbitrary here
  RandomSystem<T> system(o, 97, 200);
  auto& [mesh, pattern, layout, columns, random, packed, a] = system;
  const int n = mesh.vertexCount();
  clearUncoupled(system);
  std::vector<sim::VertexConstraint> constraints;
  for (int i = 0; i < n; i += 7) {
    if (!mesh.isRoot(i)) constraints.push_back({i, Eigen::Matrix3d::Zero(), Vec3::Zero(), 3, {}});
  }
  const std::vector<V3<T>> x = test::plain<T>(mesh.shape.positions);
  sim::CoarseSpace<T> patches(mesh, layout, columns);
  EXPECT_GT(patches.patches(), 2);
  EXPECT_LT(patches.patches(), n / 12);
  const std::vector<V3<T>> r = system.vectors();
  std::vector<V3<T>> z(n);
  ASSERT_TRUE(patches.make(packed, x, constraints));
  sim::ColumnField<T> field(layout);
  field.pack(layout, r);
  patches.solve(field);
  field.setZero();
  patches.add(field);
  field.unpack(layout, z);
  EXPECT_EQ(patches.unknown(constraints), 0);
  std::vector<sim::VertexConstraint> more = constraints;
  more.push_back({mesh.shape.column_first[1] + 3, Eigen::Matrix3d::Zero(), Vec3::Zero(), 3, {}});
  EXPECT_EQ(patches.unknown(more), (mesh.shape.column_first[1] + 3) % 7 == 0 ? 0 : 1);
  for (int i = 0; i < n; ++i) {
    if (mesh.isRoot(i) || i % 7 == 0) {
      EXPECT_EQ(dot(z[i], z[i]), T(0)) << i;
    }
  }
  expectRigidProjection(system, r, z, bound);
}

TEST(TwoLevel, PatchesAnswerBest) {
  patchesAnswerBest<float>(1e-5);
  patchesAnswerBest<double>(1e-12);
}

// P is symmetric and positive, and beats the 3x3 blocks by more the longer the hair.
TEST(TwoLevel, IsSymmetricAndNeedsFewerIterationsThanBlocks) {
  const System system(0.002);
  const BlockMatrix<double> a = system.matrixAt<double>(system.positions);
  auto preconditioner = system.preconditioner(a, Kind::kTwoLevel);
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
  const int blocks = solve<double>(system, a, p, Kind::kBlockJacobi, stop, x).iterations;
  const int levels = solve<double>(system, a, p, Kind::kTwoLevel, stop, x).iterations;
  std::printf("iterations: 3x3 blocks %d, two levels %d\n", blocks, levels);
  EXPECT_LT(3 * levels, 2 * blocks);
}

// The matrix that a part solves: without couplings between layers (or columns) and without removed directions, whose
// diagonal is the trace of the whole block.
template <class T>
Eigen::MatrixXd filteredPart(const sim::HairMesh& mesh, const sim::BlockMatrix<T>& a,
                             const std::vector<Eigen::Matrix3d>& keep, bool by_columns) {
  const Eigen::MatrixXd whole = test::dense(a), s = filterMatrix(keep);
  const int n = mesh.vertexCount();
  const auto apart = [&](int i, int j) {
    if (i == j) return false;
    if (!by_columns) return mesh.layer_of[i] != mesh.layer_of[j];
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
  return part;
}

// The factors of layers and of columns are direct solves of the matrix without the couplings between them and without
// the directions that constraints remove.
template <class T>
void partsAreSolvedWithoutRemovedDirections(double bound) {
  test::PatchOptions o;
  o.nx = 4, o.nz = 3, o.layers = 11, o.mixed = o.uneven = true;
  RandomSystem<T> system(o, 92, 40);
  auto& [mesh, pattern, layout, columns, random, packed, a] = system;
  const int n = mesh.vertexCount();
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
  sim::LayerFactor<T> layers(mesh, layout, columns);
  sim::ColumnFactor<T> of_columns(mesh, layout, columns);
  for (const bool by_columns : {false, true}) {
    const Eigen::MatrixXd part = filteredPart(mesh, a, keep, by_columns);
    std::vector<Vec3> wanted(n);
    for (int i = 0; i < n; ++i) wanted[i] = by_columns && mesh.isRoot(i) ? Vec3(Vec3::Zero()) : random.vector(1);
    const Eigen::VectorXd product = part * stackedPoints(wanted);
    std::vector<Vec3> forces(n);
    for (int i = 0; i < n; ++i) forces[i] = product.segment<3>(3 * i);
    const std::vector<V3<T>> r = test::plain<T>(forces);
    std::vector<V3<T>> z(n, V3<T>{0, 0, 0});
    if (by_columns) {
      of_columns.factor(packed, constraints);
      of_columns.addSolution(r, T(1), z);
    } else {
      layers.factor(packed, constraints);
      sim::ColumnField<T> field(layout);
      field.pack(layout, r);
      layers.solve(field);
      field.unpack(layout, z);
    }
    EXPECT_LT((test::stacked<T>(z) - stackedPoints(wanted)).cwiseAbs().maxCoeff(), bound) << by_columns;
  }
}

TEST(TwoLevel, PartsAreSolvedWithoutRemovedDirections) {
  partsAreSolvedWithoutRemovedDirections<float>(1e-4);
  partsAreSolvedWithoutRemovedDirections<double>(1e-12);
}

// A matrix of other terms, of another time step for one, is another matrix: nothing of the last one's answers it.
TEST(TwoLevel, OtherTermsMakeAllPartsAnew) {
  test::PatchOptions o;
  o.nx = 4, o.nz = 3, o.layers = 11, o.mixed = true;
  RandomSystem<double> system(o, 93, 200);
  const std::vector<V3<double>> x = test::plain<double>(system.mesh.shape.positions), r = system.vectors();
  sim::TwoLevel<double> used(system.mesh);
  using Terms = sim::MatrixTerms;
  used.update(system.packed, x, {}, Terms{.h = 1.0 / 60, .damping = 0.02, .drag = 1, .pins = {}});
  for (double& value : system.packed.values) value *= 0.3;
  system.packed.addMass(200, std::vector<double>(system.mesh.vertexCount(), 1));
  for (const Terms& terms : {Terms{.h = 1.0 / 120, .damping = 0.02, .drag = 1, .pins = {}},
                             Terms{.h = 1.0 / 120, .damping = 0.05, .drag = 1, .pins = {}},
                             Terms{.h = 1.0 / 120, .damping = 0.05, .drag = 1, .pins = {{3, 20}}}}) {
    system.packed.addMass(10, std::vector<double>(system.mesh.vertexCount(), 1));
    used.update(system.packed, x, {}, terms);
    sim::TwoLevel<double> fresh(system.mesh);
    fresh.update(system.packed, x, {}, terms);
    std::vector<V3<double>> one(r.size()), other(r.size());
    used.apply(r, one);
    fresh.apply(r, other);
    EXPECT_EQ((test::stacked<double>(one) - test::stacked<double>(other)).norm(), 0);
  }
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
    auto preconditioner =
        system.preconditioner(a, Kind::kTwoLevel, known ? p.constraints : std::vector<sim::VertexConstraint>());
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
    const auto report =
        sim::solveModifiedPcg<double>(productWith<double>(a), rhs, filter, preconditioner, stop, scratch, x);
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

}  // namespace two_level_test
}  // namespace tests

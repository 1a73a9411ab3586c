// The column layout that the simulator runs on against the plain elements and block matrix by vertex.
#include <gtest/gtest.h>

#include "sim/forces/kernels.h"
#include "tests/bench/preconditioners/preconditioner.h"
#include "tests/block_product.h"
#include "tests/sim_probes.h"
#include "tests/test_meshes.h"

namespace column_layout_test {

using sim::V3;
using sim::Vec3;

// Columns shorter and longer than a vector, mixed faces, uneven ends.
std::vector<sim::HairMesh> meshes() {
  std::vector<sim::HairMesh> all;
  for (const int layers : {2, 3, 9, 18}) {
    for (const bool uneven : {false, true}) {
      if (uneven && layers < 3) continue;
      test::PatchOptions o;
      o.nx = 3, o.nz = 2, o.layers = layers, o.length = 0.02 * layers, o.mixed = layers % 2 == 0, o.uneven = uneven;
      all.push_back(sim::buildHairMesh(test::combedShape(o)));
    }
  }
  return all;
}

std::vector<Vec3> stateOf(const sim::HairMesh& mesh, int kind, test::Random& random) {
  std::vector<Vec3> x = mesh.shape.positions;
  for (int i = 0; i < mesh.vertexCount(); ++i) {
    if (kind == 1) x[i] += random.vector(0.005);
    if (kind == 2) x[i] = random.vector(0.2);
    if (kind == 3) x[i].y() *= -1;
    if (kind == 4) x[i].z() = 0;
    if (kind == 5) x[i] = mesh.shape.positions[mesh.shape.column_first[mesh.column_of[i]]];
  }
  return x;
}

// Mass, diagonal blocks and product: of the packed matrix as of the plain one.
template <class T>
void expectSameMatrix(const sim::HairMesh& mesh, const sim::ColumnLayout& layout, double bound, test::Random& random,
                      sim::ColumnMatrix<T>& columns, sim::BlockMatrix<T>& matrix) {
  const std::size_t n = mesh.shape.positions.size();
  std::vector<V3<T>> w, product(n), column_product(n);
  for (std::size_t i = 0; i < n; ++i) w.push_back(test::plain<T>(random.vector(1)));
  const double norm = test::dense(matrix).norm();
  std::vector<T> mass;
  for (double volume : mesh.vertex_volume) mass.push_back(static_cast<T>(60 * volume));
  columns.addMass(T(2), mass);
  for (std::size_t i = 0; i < n; ++i) {
    for (int k = 0; k < 9; k += 4) matrix.diagonal[i].m[k] += T(2) * mass[i];
    const Eigen::Matrix3d block = test::eigen(columns.diagonalBlock(static_cast<int>(i)));
    EXPECT_LE((block - test::eigen(matrix.diagonal[i])).norm(), bound * norm);
  }
  sim::ColumnProduct<T> scratch(layout);
  sim::multiply<T>(columns, scratch, w, column_product);
  sim::multiply<T>(matrix, w, product);
  const Eigen::VectorXd y = test::stacked<T>(product), cy = test::stacked<T>(column_product);
  EXPECT_LE((cy - y).norm(), bound * norm * test::stacked<T>(w).norm());
}

// Shares of damping, one a vertex and the same by entry of the columns.
template <class T>
struct Shares {
  std::vector<T> of_vertex, of_entry;
  Shares(const sim::ColumnLayout& layout, test::Random& random) : of_entry(static_cast<std::size_t>(layout.size())) {
    for (const int slot : layout.slot) {
      of_vertex.push_back(static_cast<T>(random(0, 2)));
      of_entry[static_cast<std::size_t>(slot)] = of_vertex.back();
    }
  }
};

// `painted`: with damping of its own at every vertex.
template <class T>
void expectSameEvaluation(const sim::HairMesh& mesh, double bound, bool painted) {
  const sim::BlockPattern pattern = sim::systemPattern(mesh);
  const sim::ColumnLayout layout(mesh);
  const sim::ColumnPattern column_pattern(mesh, layout);
  sim::ColumnModel<T> column_model(mesh, layout, column_pattern);
  test::Random random(5);
  const Shares<T> shares(layout, random);
  const std::size_t n = mesh.shape.positions.size();
  for (int kind = 0; kind < 6; ++kind) {
    // The columns take a hinge's rest shift into its rest angle, before the angle wraps at half a turn; random hinges
    // come near enough to it to tell, so they go without shifts.
    sim::SimParams params = test::tautHair();
    params.sag_free = kind != 2;
    const sim::ForceModel<double> source = test::makeForceModel(mesh, pattern, params);
    const sim::ForceModel<T> plain_model = test::convertModel<T>(source);
    column_model.setElements(mesh, layout, source);
    const auto x = test::plain<T>(stateOf(mesh, kind, random));
    std::vector<V3<T>> v, force(n, V3<T>{0, 0, 0}), column_force(n);
    for (std::size_t i = 0; i < n; ++i) v.push_back(test::plain<T>(random.vector(1)));

    sim::BlockMatrix<T> matrix(&pattern), column_blocks(&pattern);
    matrix.setZero();
    sim::Evaluation<T> out;
    out.force = force;
    out.matrix = &matrix;
    out.matrix_scale = T(0.7), out.tension_scale = T(0.3);
    out.velocities = v;
    out.damping = T(0.05);
    if (painted) out.damping_share = shares.of_vertex;
    const double energy = sim::evaluate<T>(plain_model, x, out);

    sim::ColumnField<T> packed_x(layout), packed_v(layout), packed_force(layout);
    packed_x.pack(layout, x);
    packed_v.pack(layout, v);
    packed_force.setZero();
    sim::ColumnMatrix<T> columns(layout, column_pattern);
    columns.setZero();
    sim::ColumnEvaluation<T> column_out{&packed_force, &columns, T(0.7), T(0.3), &packed_v, T(0.05)};
    if (painted) column_out.damping_share = shares.of_entry;
    const double column_energy = sim::evaluate<T>(column_model, layout, packed_x, column_out);
    packed_force.unpack(layout, column_force);
    bench::toBlocks(mesh, columns, column_blocks);

    EXPECT_NEAR(column_energy, energy, bound * std::abs(energy)) << "state " << kind;
    const Eigen::VectorXd f = test::stacked<T>(force), cf = test::stacked<T>(column_force);
    EXPECT_LE((cf - f).norm(), bound * f.norm()) << "state " << kind;
    const Eigen::MatrixXd a = test::dense(matrix), ca = test::dense(column_blocks);
    EXPECT_LE((ca - a).norm(), bound * a.norm()) << "state " << kind;
    expectSameMatrix<T>(mesh, layout, bound, random, columns, matrix);
  }
}

TEST(ColumnLayout, EvaluatesAndMultipliesAsThePlainModelInDouble) {
  for (const sim::HairMesh& mesh : meshes()) expectSameEvaluation<double>(mesh, 1e-12, false);
}

TEST(ColumnLayout, EvaluatesAndMultipliesAsThePlainModelInFloat) {
  for (const sim::HairMesh& mesh : meshes()) expectSameEvaluation<float>(mesh, 2e-4, false);
}

TEST(ColumnLayout, EvaluatesPaintedDampingAsThePlainModel) {
  for (const sim::HairMesh& mesh : meshes()) {
    expectSameEvaluation<double>(mesh, 1e-12, true);
    expectSameEvaluation<float>(mesh, 2e-4, true);
  }
}

// Shares of one value everywhere: as the same evaluation with so many times the damping.
TEST(ColumnLayout, ShareOfDampingThatIsTheSameEverywhereScalesTheDamping) {
  constexpr double kShare = 0.375, kStep = 0.01, kDamping = 0.05;
  const sim::HairMesh mesh = meshes().front();
  const sim::BlockPattern pattern = sim::systemPattern(mesh);
  const sim::ForceModel<double> model = test::makeForceModel(mesh, pattern, test::tautHair());
  test::Random random(11);
  const std::size_t n = mesh.shape.positions.size();
  const auto x = test::plain<double>(stateOf(mesh, 1, random)), v = test::plain<double>(stateOf(mesh, 2, random));
  const std::vector<double> shares(n, kShare);
  std::vector<V3<double>> force(n, V3<double>{0, 0, 0}), scaled_force(n, V3<double>{0, 0, 0});
  sim::BlockMatrix<double> matrix(&pattern), scaled(&pattern);
  matrix.setZero();
  scaled.setZero();
  const double square = kStep * kStep;
  sim::Evaluation<double> out{force, &matrix, square + kStep * kDamping, square, v, kDamping, shares};
  const double energy = sim::evaluate<double>(model, x, out);
  out = {scaled_force, &scaled, square + kStep * kShare * kDamping, square, v, kShare * kDamping, {}};
  EXPECT_NEAR(sim::evaluate<double>(model, x, out), energy, 1e-12 * energy);
  const Eigen::VectorXd f = test::stacked<double>(force), g = test::stacked<double>(scaled_force);
  EXPECT_LE((f - g).norm(), 1e-12 * g.norm());
  const Eigen::MatrixXd a = test::dense(matrix), b = test::dense(scaled);
  EXPECT_LE((a - b).norm(), 1e-12 * b.norm());
}

// As every kind runs that has no kernel.
TEST(ColumnLayout, PlainElementsOfAnyKindAddUpInColumnsAsByVertex) {
  test::Random random(7);
  for (const sim::HairMesh& mesh : meshes()) {
    const sim::BlockPattern pattern = sim::systemPattern(mesh);
    const sim::ColumnLayout layout(mesh);
    const sim::ColumnPattern column_pattern(mesh, layout);
    const sim::ForceModel<double> model =
        sim::makeElements({mesh, test::tautHair(), test::pinnedWhereTheyAre(mesh)}, pattern);
    const std::size_t n = mesh.shape.positions.size();
    const auto x = test::plain<double>(stateOf(mesh, 1, random)), v = test::plain<double>(stateOf(mesh, 2, random));
    sim::ColumnField<double> packed_x(layout), packed_v(layout), packed_force(layout);
    packed_x.pack(layout, x);
    packed_v.pack(layout, v);
    model.forEach([&]<class Kind>(const sim::Elements<Kind, double>& elements) {
      std::vector<V3<double>> force(n, V3<double>{0, 0, 0}), column_force(n);
      sim::BlockMatrix<double> matrix(&pattern), column_blocks(&pattern);
      matrix.setZero();
      const sim::Evaluation<double> out{force, &matrix, 0.7, 0.3, v, 0.05};
      double energy = 0, column_energy = 0;
      sim::evaluateElements(elements, sim::BlockSums<double>{x, out}, energy);

      sim::ColumnMatrix<double> columns(layout, column_pattern);
      columns.setZero();
      packed_force.setZero();
      const sim::ColumnEvaluation<double> column_out{&packed_force, &columns, 0.7, 0.3, &packed_v, 0.05};
      sim::evaluateElements(elements, sim::ColumnSums<double>{layout, packed_x, column_out}, column_energy);
      packed_force.unpack(layout, column_force);
      bench::toBlocks(mesh, columns, column_blocks);
      EXPECT_EQ(column_energy, energy) << Kind::kName;
      EXPECT_EQ(test::stacked<double>(column_force), test::stacked<double>(force)) << Kind::kName;
      const Eigen::MatrixXd sum = test::dense(matrix), column_sum = test::dense(column_blocks);
      EXPECT_LE((column_sum - sum).norm(), 1e-14 * sum.norm()) << Kind::kName;  // rounding of mirrored blocks
    });
  }
}

TEST(ColumnLayout, PackingKeepsEveryVertexAndLeavesThePaddingZero) {
  test::Random random(6);
  for (const sim::HairMesh& mesh : meshes()) {
    const sim::ColumnLayout layout(mesh);
    std::vector<V3<double>> x, back(mesh.vertexCount());
    double sum = 0, packed = 0;
    for (int i = 0; i < mesh.vertexCount(); ++i) {
      x.push_back(test::plain<double>(Vec3(random.vector(1) + Vec3(2, 2, 2))));
      sum += x.back().x;
    }
    sim::ColumnField<double> field(layout);
    field.pack(layout, x);
    field.unpack(layout, back);
    for (int i = 0; i < mesh.vertexCount(); ++i) EXPECT_EQ(test::eigen(x[i]), test::eigen(back[i]));
    for (double value : field.x) packed += value;
    EXPECT_NEAR(packed, sum, 1e-12 * sum);
  }
}

}  // namespace column_layout_test

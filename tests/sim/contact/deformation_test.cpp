// Deformation minimization against a dense least-squares solve over the edges.
#include "sim/contact/deformation.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/test_meshes.h"

namespace deformation_test {

using sim::Vec3;

// Edges of the hair mesh, the scalp's included, listed from root faces and columns.
std::vector<std::pair<int, int>> edgesOf(const sim::HairMesh& mesh) {
  std::set<std::pair<int, int>> edges;
  for (std::size_t f = 0; f < mesh.shape.root_faces.size(); ++f) {
    const sim::RootFace& face = mesh.shape.root_faces[f];
    for (int k = 0; k < face.corner_count; ++k) {
      const int a = mesh.shape.column_first[face.columns[k]];
      const int b = mesh.shape.column_first[face.columns[(k + 1) % face.corner_count]];
      for (int l = 0; l < mesh.bundle_layers[f]; ++l) edges.insert({std::min(a, b) + l, std::max(a, b) + l});
    }
  }
  for (int v = 0; v + 1 < mesh.vertexCount(); ++v) {
    if (mesh.column_of[v] == mesh.column_of[v + 1]) edges.insert({v, v + 1});
  }
  return {edges.begin(), edges.end()};
}

struct Case {
  sim::HairMesh mesh;
  std::vector<unsigned char> held;
  std::vector<Vec3> moved;  // u' = x' - x
};

// Roots held in place and some external vertices moved.
Case makeCase(int corrected, test::Random& random, int cells = 2) {
  test::PatchOptions o;
  o.nx = o.nz = cells;
  o.mixed = o.uneven = true;
  Case c{sim::buildHairMesh(test::combedShape(o)), {}, {}};
  c.held.assign(c.mesh.vertexCount(), 0);
  c.moved.assign(c.mesh.vertexCount(), Vec3::Zero());
  for (int v = 0; v < c.mesh.vertexCount(); ++v) c.held[v] = c.mesh.isRoot(v);
  for (int k = 0; k < corrected; ++k) {
    const auto& external = c.mesh.external_vertices;
    const int v = external[static_cast<std::size_t>(random(0, static_cast<double>(external.size()) - 0.001))];
    c.held[v] = 1;
    c.moved[v] = random.vector(0.02);
  }
  return c;
}

double objective(const sim::HairMesh& mesh, const std::vector<Vec3>& u) {
  double sum = 0;
  for (const auto& [a, b] : edgesOf(mesh)) sum += (u[a] - u[b]).squaredNorm();
  return sum;
}

// Least squares by QR: a row per edge, unknowns the free vertices; no normal equations, unlike the code under test.
std::vector<Vec3> denseMinimizer(const Case& c) {
  std::vector<int> number(c.mesh.vertexCount(), -1);
  int unknowns = 0;
  for (int v = 0; v < c.mesh.vertexCount(); ++v) {
    if (!c.held[v]) number[v] = unknowns++;
  }
  const auto edges = edgesOf(c.mesh);
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(edges.size(), unknowns);
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(edges.size(), 3);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto [i, j] = edges[e];
    if (number[i] >= 0)
      a(e, number[i]) += 1;
    else
      b.row(e) -= c.moved[i].transpose();
    if (number[j] >= 0)
      a(e, number[j]) -= 1;
    else
      b.row(e) += c.moved[j].transpose();
  }
  const Eigen::MatrixXd solution = a.colPivHouseholderQr().solve(b);
  std::vector<Vec3> u = c.moved;
  for (int v = 0; v < c.mesh.vertexCount(); ++v) {
    if (number[v] >= 0) u[v] = solution.row(number[v]).transpose();
  }
  return u;
}

TEST(DeformationMinimization, LaplacianIsThatOfTheMeshsEdges) {
  test::Random random(1);
  const Case c = makeCase(0, random);
  const sim::EdgeLaplacian laplacian = sim::makeEdgeLaplacian(c.mesh);
  std::set<std::pair<int, int>> found;
  for (int i = 0; i < laplacian.size(); ++i) {
    for (int k = laplacian.row_first[i]; k < laplacian.row_first[i + 1]; ++k) {
      EXPECT_TRUE(found.insert({i, laplacian.neighbours[k]}).second);
    }
  }
  std::set<std::pair<int, int>> expected;
  for (const auto& [a, b] : edgesOf(c.mesh)) expected.insert({a, b}), expected.insert({b, a});
  EXPECT_EQ(found, expected);
}

TEST(DeformationMinimization, AgreesWithDenseLeastSquares) {
  test::Random random(2);
  sim::MinimizationScratch scratch;
  for (const int corrected : {1, 2, 5, 12, 30}) {
    const Case c = makeCase(corrected, random);
    const sim::EdgeLaplacian laplacian = sim::makeEdgeLaplacian(c.mesh);
    const std::vector<Vec3> exact = denseMinimizer(c);
    std::vector<Vec3> u = c.moved;
    EXPECT_GT(sim::minimizeDeformation(laplacian, c.held, 1e-13, scratch, u), 0);
    EXPECT_LT(test::largestDistance(u, exact), 1e-11) << corrected << " corrected";
    // From another start the same minimum: the constraints fix it.
    std::vector<Vec3> other = c.moved;
    for (int v = 0; v < c.mesh.vertexCount(); ++v) {
      if (!c.held[v]) other[v] = random.vector(0.05);
    }
    sim::minimizeDeformation(laplacian, c.held, 1e-13, scratch, other);
    EXPECT_LT(test::largestDistance(other, exact), 1e-11);
    for (int v = 0; v < c.mesh.vertexCount(); ++v) {
      if (!c.held[v]) continue;
      EXPECT_EQ(u[v], c.moved[v]) << "held vertices stay to the bit";
    }
    const double least = objective(c.mesh, u);
    EXPECT_LT(least, objective(c.mesh, c.moved)) << "better than correction alone";
    for (int trial = 0; trial < 20; ++trial) {
      std::vector<Vec3> nudged = u;
      for (int v = 0; v < c.mesh.vertexCount(); ++v) {
        if (!c.held[v]) nudged[v] += random.vector(1e-4);
      }
      EXPECT_GT(objective(c.mesh, nudged), least);
    }
  }
}

// By kept answers it is the minimum as well, whichever vertices were held before, and where they are too many.
TEST(DeformationMinimization, KeptAnswersGiveTheMinimumWhateverWasHeldBefore) {
  test::Random random(8);
  const Case first = makeCase(1, random, 7);
  sim::DeformationMinimizer minimizer(first.mesh);
  int most_held = 0;
  for (const int corrected : {1, 5, 30, 12, 2, 60, 400, 60, 5}) {
    const Case c = makeCase(corrected, random, 7);
    std::vector<Vec3> u = c.moved;
    for (int v = 0; v < c.mesh.vertexCount(); ++v) {
      if (!c.held[v]) u[v] = random.vector(0.05);  // what stands there does not matter
    }
    EXPECT_GT(minimizer.minimize(c.held, 1e-13, u), 0);
    EXPECT_LT(test::largestDistance(u, denseMinimizer(c)), 1e-11) << corrected << " corrected";
    int held = 0;
    for (int v = 0; v < c.mesh.vertexCount(); ++v) {
      held += c.held[v] && !c.mesh.isRoot(v);
      if (c.held[v]) {
        EXPECT_EQ(u[v], c.moved[v]) << "held vertices stay to the bit";
      }
    }
    most_held = std::max(most_held, held);
    if (held <= sim::DeformationMinimizer::kMaxHeld) {
      EXPECT_EQ(minimizer.minimize(c.held, 1e-13, u), 1) << "nothing is computed twice";
    }
  }
  EXPECT_GT(most_held, sim::DeformationMinimizer::kMaxHeld);
  std::vector<Vec3> still(first.moved.size(), Vec3::Zero());
  EXPECT_EQ(minimizer.minimize(first.held, 1e-3, still), 0) << "nothing has moved";
}

TEST(DeformationMinimization, ALooseToleranceStaysNearTheMinimum) {
  test::Random random(3);
  sim::MinimizationScratch scratch;
  const Case c = makeCase(8, random);
  const sim::EdgeLaplacian laplacian = sim::makeEdgeLaplacian(c.mesh);
  const std::vector<Vec3> exact = denseMinimizer(c);
  double previous = INFINITY;
  for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-5}) {
    std::vector<Vec3> u = c.moved;
    sim::minimizeDeformation(laplacian, c.held, tolerance, scratch, u);
    const double error = test::largestDistance(u, exact);
    EXPECT_LT(error, 0.1 * tolerance) << "of corrections of 20 mm";
    EXPECT_LE(error, previous);
    previous = error;
  }
}

TEST(DeformationMinimization, MovesAllAlikeWhenAllThatIsHeldMovesAlike) {
  test::Random random(4);
  sim::MinimizationScratch scratch;
  Case c = makeCase(3, random);
  const Vec3 shift(0.01, -0.02, 0.03);
  for (int v = 0; v < c.mesh.vertexCount(); ++v) c.moved[v] = c.held[v] ? shift : Vec3::Zero();
  sim::minimizeDeformation(sim::makeEdgeLaplacian(c.mesh), c.held, 1e-13, scratch, c.moved);
  EXPECT_LT(test::largestDistance(c.moved, std::vector<Vec3>(c.moved.size(), shift)), 1e-12);
}

TEST(DeformationMinimization, DoesNoWorkWhenNothingTouches) {
  test::Random random(5);
  sim::MinimizationScratch scratch;
  Case c = makeCase(0, random);
  EXPECT_EQ(sim::minimizeDeformation(sim::makeEdgeLaplacian(c.mesh), c.held, 1e-3, scratch, c.moved), 0);
  for (const Vec3& u : c.moved) EXPECT_EQ(u, Vec3::Zero());
  EXPECT_TRUE(scratch.r.empty()) << "not even its scratch is sized";

  // In a step: a body far away costs nothing and changes nothing, to the bit.
  sim::HairState states[2];
  for (const bool with_body : {false, true}) {
    test::Hair hair(test::combedShape({}), test::tautHair());
    if (with_body) hair.bodies.push_back({Vec3(3, 0, 0), Eigen::Quaterniond::Identity(), Vec3(0.5, 0.5, 0.5)});
    for (Vec3& root : hair.roots) root.x() += 0.01;
    for (int k = 0; k < 10; ++k) {
      const sim::StepReport report = hair.step(1.0 / 60);
      EXPECT_EQ(report.minimization_iterations, 0);
      EXPECT_EQ(report.corrected, 0);
      EXPECT_EQ(report.contacts, 0);
    }
    states[with_body] = hair.state;
  }
  EXPECT_EQ(test::largestDistance(states[0].positions, states[1].positions), 0);
}

}  // namespace deformation_test

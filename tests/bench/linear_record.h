// Linear systems as the simulator meets them, recorded so that every solver can be given the same ones.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/contact/contact.h"
#include "sim/linear/block_matrix.h"
#include "sim/linear/column_matrix.h"
#include "tests/bench/trajectory.h"

namespace bench {

using Vector3 = sim::V3<double>;
inline constexpr double kEnough = 1e-13;  // relative residual at which a system counts as solved

// What the systems of one hair mesh share.
struct RecordedMesh {
  const sim::HairMesh& mesh;
  sim::BlockPattern pattern;
  sim::ColumnLayout layout;
  sim::ColumnPattern columns;
  std::vector<double> mass;  // kg
  double h = 0;              // s

  RecordedMesh(const sim::HairMesh& m, const sim::SimParams& params);
};

// A x = b for the directions that `constraints` and the roots leave free; x in m/s, b in kg m/s.
struct LinearRecord {
  std::string name;  // scene and step
  sim::BlockMatrix<double> matrix;
  sim::LineVector<double> column_values;  // the same in column layout
  std::vector<Vector3> rhs;
  std::vector<Vector3> guess;      // the velocities before the step, with the constraints met: the warm start
  std::vector<Vector3> positions;  // m, relative to a root: where the matrix was taken
  std::vector<sim::VertexConstraint> constraints;
  std::vector<Eigen::Matrix3d> keep;  // per vertex: projector onto its free directions
  std::vector<Vector3> solution;      // to rounding
};

struct RecordedSystems {
  std::string scene;
  std::unique_ptr<TrajectoryStage> stage;  // owns the mesh
  std::unique_ptr<RecordedMesh> shared;
  std::vector<LinearRecord> records;
};

// Runs a scene of that name with the default parameters and records the last system of each of the steps listed (the
// contacts have then been sorted into sticking, sliding and let go).
RecordedSystems recordSystems(const std::string& scene, const std::vector<int>& steps);

// r = b - A x within the free directions.
std::vector<Vector3> residualOf(const LinearRecord& record, const std::vector<Vector3>& x);

}  // namespace bench

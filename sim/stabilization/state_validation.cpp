#include "sim/stabilization/state_validation.h"

#include <algorithm>
#include <cmath>

#include "sim/mesh/rigid_motion.h"

namespace sim {
namespace {

constexpr double kFastest = 500;  // m/s against the root; beyond it a velocity is absurd
// m/s of one root against the others: a head turned round within a thousandth of a second has them 300 apart.
constexpr double kFastestRoot = 5000;
// Beyond both together a position is absurd: no hand or foot that hair could be dragged along by is two metres from the
// head. (A backflip at twenty times its speed takes short hair a metre and a half.)
constexpr double kLengths = 4;  // hair lengths from the root
constexpr double kFarther = 2;  // m
constexpr double kKeptVelocity = 0.5;

const char* faultName(StateFault fault) {
  constexpr const char* kNames[] = {"well", "not finite", "absurdly far from its root", "absurdly fast",
                                    "a root absurdly far from the others or fast against them"};
  return kNames[static_cast<int>(fault)];
}

// m from a root, beyond which nothing of the hair can be.
double reachOf(const HairMesh& mesh) {
  return kLengths * mesh.hair_length + kFarther;
}

int rootOf(const HairMesh& mesh, int vertex) {
  return mesh.shape.column_first[mesh.column_of[vertex]];
}

// The middle one of each coordinate, of the finite ones; what a few absurd values cannot move. Zero of none.
Vec3 middleOf(std::vector<Vec3> values) {
  std::erase_if(values, [](const Vec3& v) { return !v.allFinite(); });
  Vec3 middle = Vec3::Zero();
  if (values.empty()) return middle;
  const auto half = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  for (int axis = 0; axis < 3; ++axis) {
    std::nth_element(values.begin(), half, values.end(),
                     [axis](const Vec3& a, const Vec3& b) { return a[axis] < b[axis]; });
    middle[axis] = (*half)[axis];
  }
  return middle;
}

// Extent of a value over the roots, in its widest coordinate; NaN where one is not finite.
template <class Value>
double extentOf(const HairMesh& mesh, const Value& value) {
  Vec3 low = value(0), high = low;
  for (int c = 1; c < mesh.columnCount(); ++c) {
    const Vec3 at = value(c);
    if (!at.allFinite()) return NAN;
    low = low.cwiseMin(at), high = high.cwiseMax(at);
  }
  return low.allFinite() ? (high - low).maxCoeff() : NAN;
}

// A value that is not finite is the largest of all.
bool larger(double a, double b) {
  return std::isfinite(b) && !(a <= b);
}

}  // namespace

std::string faultText(const FaultReport& fault_report) {
  if (fault_report.fault == StateFault::kNone) return "";
  std::string text = "vertex " + std::to_string(fault_report.vertex) + " (column " +
                     std::to_string(fault_report.column) + ", layer " + std::to_string(fault_report.layer) + ") was " +
                     faultName(fault_report.fault) + (fault_report.given ? " before the step" : " after the step");
  if (*fault_report.force)
    text += ", largest force there: " + std::string(fault_report.force) + " element " +
            std::to_string(fault_report.element);
  return text + "; last good state put back at " + std::to_string(fault_report.vertices) +
         (fault_report.vertices == 1 ? " vertex" : " vertices");
}

StateFault examine(const HairMesh& mesh, const HairState& state, int vertex) {
  const int root = rootOf(mesh, vertex);
  const Vec3 arm = state.positions[vertex] - state.positions[root];
  const Vec3 speed = state.velocities[vertex] - state.velocities[root];
  if (!arm.allFinite() || !speed.allFinite()) return StateFault::kNotFinite;
  const double reach = reachOf(mesh);
  if (arm.squaredNorm() > reach * reach) return StateFault::kFarAway;
  return speed.squaredNorm() > kFastest * kFastest ? StateFault::kTooFast : StateFault::kNone;
}

// The scalp has them all about as far from where they are going: a root that is not is brought to where the others say.
void repairRoots(const HairMesh& mesh, std::span<const Vec3> roots, HairState& state, FaultReport& fault_report) {
  const auto rootAt = [&](int c) { return mesh.shape.column_first[c]; };
  const auto wayOf = [&](int c) { return Vec3(state.positions[rootAt(c)] - roots[c]); };
  const auto speedOf = [&](int c) { return state.velocities[rootAt(c)]; };
  const double reach = reachOf(mesh);
  if (extentOf(mesh, wayOf) <= reach && extentOf(mesh, speedOf) <= kFastestRoot) return;
  std::vector<Vec3> ways, speeds;
  for (int c = 0; c < mesh.columnCount(); ++c) ways.push_back(wayOf(c)), speeds.push_back(speedOf(c));
  const Vec3 way = middleOf(ways), speed = middleOf(speeds);
  for (int c = 0; c < mesh.columnCount(); ++c) {
    const double off = (ways[c] - way).cwiseAbs().maxCoeff(), fast = (speeds[c] - speed).cwiseAbs().maxCoeff();
    const bool finite = ways[c].allFinite() && speeds[c].allFinite();
    if (finite && off <= reach && fast <= kFastestRoot) continue;
    const int root = rootAt(c);
    state.positions[root] = roots[c] + way;
    state.velocities[root] = speed;
    ++fault_report.vertices;
    if (fault_report.fault != StateFault::kNone) continue;
    fault_report.fault = finite ? StateFault::kOffScalp : StateFault::kNotFinite;
    fault_report.vertex = root, fault_report.column = c, fault_report.layer = 0;
  }
}

void repair(const HairMesh& mesh, std::span<const Vec3> roots, const KeptState& good, HairState& state,
            FaultReport& fault_report) {
  // Roots first: all else is measured against them.
  repairRoots(mesh, roots, state, fault_report);
  std::vector<int> faulty;
  for (int i = 0; i < mesh.vertexCount(); ++i) {
    const StateFault fault = examine(mesh, state, i);
    if (fault == StateFault::kNone) continue;
    faulty.push_back(i);
    if (fault_report.fault != StateFault::kNone) continue;
    fault_report.fault = fault;
    fault_report.vertex = i, fault_report.column = mesh.column_of[i], fault_report.layer = mesh.layer_of[i];
  }
  if (faulty.empty()) return;
  fault_report.vertices += static_cast<int>(faulty.size());

  const bool known = good.positions.size() == state.positions.size();
  const std::span<const Vec3> kept = known ? good.positions : mesh.shape.positions;
  const Eigen::Isometry3d motion = rootMotion(mesh, kept, state.positions);
  for (const int i : faulty) {
    const int root = rootOf(mesh, i);
    state.positions[i] = motion * kept[i];
    state.velocities[i] = state.velocities[root];
    if (known) state.velocities[i] += kKeptVelocity * (motion.linear() * (good.velocities[i] - good.velocities[root]));
    if (state.previous_dt <= 0) continue;
    state.previous_velocities[i] = state.velocities[i];
    state.previous_positions[i] = state.positions[i] - state.previous_dt * state.velocities[i];
  }
  std::erase_if(state.contacts,
                [&](const Contact& c) { return std::binary_search(faulty.begin(), faulty.end(), c.vertex); });
}

void nameForce(const ForceModel<double>& model, std::span<const V3<double>> x, FaultReport& fault_report) {
  double largest_force = -1;  // N
  model.forEach([&]<class Kind>(const Elements<Kind, double>& elements) {
    for (std::size_t e = 0; e < elements.size(); ++e) {
      const auto& v = elements.vertices[e];
      const auto at = std::find(v.begin(), v.end(), fault_report.vertex);
      if (at == v.end()) continue;
      V3<double> p[Kind::kVertices];
      for (int k = 0; k < Kind::kVertices; ++k) p[k] = x[v[k]];
      const auto c = Kind::condition(p, elements.rest[e], elements.shift[e]);
      const V3<double>& g = c.g[at - v.begin()];
      const double force = std::abs(elements.stiffness[e] * c.value) * std::sqrt(dot(g, g));
      if (largest_force >= 0 && !larger(force, largest_force)) continue;
      largest_force = force;
      fault_report.force = Kind::kName, fault_report.element = static_cast<int>(e);
    }
  });
}

double rootSpeed(const HairMesh& mesh, std::span<const Vec3> roots, double dt, const HairState& state) {
  double sum = 0;
  for (int c = 0; c < mesh.columnCount(); ++c) sum += (roots[c] - state.positions[mesh.shape.column_first[c]]).norm();
  return sum / (mesh.columnCount() * dt);
}

}  // namespace sim

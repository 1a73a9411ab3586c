#include "sim/watchdog.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "sim/forces/conditions.h"

namespace sim {
namespace {

constexpr double kFastest = 500;        // m/s against the root; beyond it a velocity is absurd
constexpr double kFastestPushed = 100;  // m/s against the root
// m/s of one root against the others: a head turned round within a thousandth of a second has them 300 apart.
constexpr double kFastestRoot = 5000;
// Beyond both together a position is absurd: no hand or foot that hair could be dragged along by is two metres from the
// head. (A backflip at twenty times its speed takes short hair a metre and a half.)
constexpr double kLengths = 4;  // hair lengths from the root
constexpr double kFarther = 2;  // m
constexpr double kKeptVelocity = 0.5;

const char* ailmentName(Ailment ailment) {
  constexpr const char* kNames[] = {"well", "not finite", "absurdly far from its root", "absurdly fast",
                                    "a root absurdly far from the others or fast against them"};
  return kNames[static_cast<int>(ailment)];
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

struct LargestForce {
  double size = -1;
  const char* kind = "";
  int element = -1;

  template <int N, class Gradient>
  void look(const char* name, const Elements<double, N>& elements, int vertex, Gradient&& conditionAt) {
    for (std::size_t e = 0; e < elements.size(); ++e) {
      for (int p = 0; p < N; ++p) {
        if (elements.vertices[e][p] != vertex) continue;
        const Condition<double, N> condition = conditionAt(e);
        const double pull = elements.stiffness[e] * (condition.value - elements.shift[e]);
        const double force = std::abs(pull) * std::sqrt(dot(condition.g[p], condition.g[p]));
        if (size >= 0 && !larger(force, size)) continue;
        size = force, kind = name, element = static_cast<int>(e);
      }
    }
  }
};

template <int N>
void gather(std::span<const V3<double>> x, const std::array<int, N>& v, V3<double>* out) {
  for (int p = 0; p < N; ++p) out[p] = x[v[p]];
}

}  // namespace

std::string troubleText(const Trouble& trouble) {
  if (trouble.ailment == Ailment::kNone) return "";
  std::string text = "vertex " + std::to_string(trouble.vertex) + " (column " + std::to_string(trouble.column) +
                     ", layer " + std::to_string(trouble.layer) + ") was " + ailmentName(trouble.ailment) +
                     (trouble.given ? " before the step" : " after the step");
  if (*trouble.force)
    text += ", largest force there: " + std::string(trouble.force) + " element " + std::to_string(trouble.element);
  return text + "; last good state put back at " + std::to_string(trouble.vertices) +
         (trouble.vertices == 1 ? " vertex" : " vertices");
}

Ailment examine(const HairMesh& mesh, const HairState& state, int vertex) {
  const int root = rootOf(mesh, vertex);
  const Vec3 arm = state.positions[vertex] - state.positions[root];
  const Vec3 speed = state.velocities[vertex] - state.velocities[root];
  if (!arm.allFinite() || !speed.allFinite()) return Ailment::kNotFinite;
  const double reach = reachOf(mesh);
  if (arm.squaredNorm() > reach * reach) return Ailment::kFarAway;
  return speed.squaredNorm() > kFastest * kFastest ? Ailment::kTooFast : Ailment::kNone;
}

void limitSpeed(const HairMesh& mesh, HairState& state) {
  for (int i = 0; i < mesh.vertexCount(); ++i) {
    const Vec3& root = state.velocities[rootOf(mesh, i)];
    const Vec3 speed = state.velocities[i] - root;
    const double square = speed.squaredNorm();
    if (square > kFastestPushed * kFastestPushed)
      state.velocities[i] = root + kFastestPushed / std::sqrt(square) * speed;
  }
}

Eigen::Isometry3d rigidMotion(std::span<const Vec3> from, std::span<const Vec3> to) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  Vec3 from_center = Vec3::Zero(), to_center = Vec3::Zero();
  const double n = static_cast<double>(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) from_center += from[i] / n, to_center += to[i] / n;
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) moment += (to[i] - to_center) * (from[i] - from_center).transpose();
  if (!moment.allFinite()) return motion;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(moment, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d turn = svd.matrixU() * svd.matrixV().transpose();
  if (turn.determinant() < 0) turn = svd.matrixU() * Vec3(1, 1, -1).asDiagonal() * svd.matrixV().transpose();
  motion.linear() = turn;
  motion.translation() = to_center - turn * from_center;
  return motion;
}

// The scalp has them all about as far from where they are going: a root that is not is brought to where the others say.
void healRoots(const HairMesh& mesh, std::span<const Vec3> roots, HairState& state, Trouble& trouble) {
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
    ++trouble.vertices;
    if (trouble.ailment != Ailment::kNone) continue;
    trouble.ailment = finite ? Ailment::kOffScalp : Ailment::kNotFinite;
    trouble.vertex = root, trouble.column = c, trouble.layer = 0;
  }
}

void heal(const HairMesh& mesh, std::span<const Vec3> roots, const GoodState& good, HairState& state,
          Trouble& trouble) {
  // Roots first: all else is measured against them.
  healRoots(mesh, roots, state, trouble);
  std::vector<int> ill;
  for (int i = 0; i < mesh.vertexCount(); ++i) {
    const Ailment ailment = examine(mesh, state, i);
    if (ailment == Ailment::kNone) continue;
    ill.push_back(i);
    if (trouble.ailment != Ailment::kNone) continue;
    trouble.ailment = ailment;
    trouble.vertex = i, trouble.column = mesh.column_of[i], trouble.layer = mesh.layer_of[i];
  }
  if (ill.empty()) return;
  trouble.vertices += static_cast<int>(ill.size());

  const bool known = good.positions.size() == state.positions.size();
  const std::vector<Vec3>& kept = known ? good.positions : mesh.shape.positions;
  std::vector<Vec3> then, now;
  for (int c = 0; c < mesh.columnCount(); ++c) {
    then.push_back(kept[mesh.shape.column_first[c]]);
    now.push_back(state.positions[mesh.shape.column_first[c]]);
  }
  // Where the roots have not moved the state is put back to the bit.
  const Eigen::Isometry3d motion = then == now ? Eigen::Isometry3d::Identity() : rigidMotion(then, now);
  for (const int i : ill) {
    const int root = rootOf(mesh, i);
    state.positions[i] = motion * kept[i];
    state.velocities[i] = state.velocities[root];
    if (known) state.velocities[i] += kKeptVelocity * (motion.linear() * (good.velocities[i] - good.velocities[root]));
    if (state.previous_dt <= 0) continue;
    state.previous_velocities[i] = state.velocities[i];
    state.previous_positions[i] = state.positions[i] - state.previous_dt * state.velocities[i];
  }
  std::erase_if(state.contacts, [&](const Contact& c) { return std::binary_search(ill.begin(), ill.end(), c.vertex); });
}

void nameForce(const ForceModel<double>& model, std::span<const V3<double>> x, Trouble& trouble) {
  LargestForce largest;
  largest.look<2>("stretch", model.stretch, trouble.vertex, [&](std::size_t e) {
    const auto [a, b] = model.stretch.vertices[e];
    const StretchCondition<double> s = stretchCondition(x[a], x[b], model.stretch.inverse_length[e]);
    const V3<double> g = s.inverse_length * s.direction;
    return Condition<double, 2>{s.value, {-1.0 * g, g}};
  });
  largest.look<4>("shear", model.shear, trouble.vertex, [&](std::size_t e) {
    V3<double> p[4];
    gather<4>(x, model.shear.vertices[e], p);
    return shearCondition(p, model.shear.inverse_along[e], model.shear.inverse_across[e]);
  });
  largest.look<6>("bend", model.bend, trouble.vertex, [&](std::size_t e) {
    V3<double> p[6];
    gather<6>(x, model.bend.vertices[e], p);
    return bendCondition(p, model.bend.rest_angle[e], model.bend.inverse_length[e], model.bend.smallest_square[e]);
  });
  largest.look<4>("volume", model.volume, trouble.vertex, [&](std::size_t e) {
    V3<double> p[4];
    gather<4>(x, model.volume.vertices[e], p);
    return volumeCondition(p, model.volume.rest_volume[e]);
  });
  trouble.force = largest.kind;
  trouble.element = largest.element;
}

double rootSpeed(const HairMesh& mesh, std::span<const Vec3> roots, double dt, const HairState& state) {
  double sum = 0;
  for (int c = 0; c < mesh.columnCount(); ++c) sum += (roots[c] - state.positions[mesh.shape.column_first[c]]).norm();
  return sum / (mesh.columnCount() * dt);
}

}  // namespace sim

#include "tests/bench/peers.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tests/bench/bullet_peer.h"
#include "tests/bench/cpu_clock.h"
#include "tests/bench/scene_times.h"
#include "tests/bench/trajectory.h"
#include "tests/bench/written_files.h"

namespace bench {
namespace {

constexpr int kMaxOfImplicit = 1000;  // vertices

constexpr int kRecoveryFrames = 180;  // frames in which to recover

using Positions = std::vector<sim::Vec3>;

// Where the roots are in each frame of a scene.
using RootMotion = std::vector<Positions>;

RootMotion rootMotion(TrajectoryStage& stage) {
  RootMotion motion;
  sim::SimParams params;
  params.time_step = kFrame;
  stage.visitSteps(params, [&](int, const sim::StepInput& input, const sim::HairState&) {
    motion.emplace_back(input.roots.begin(), input.roots.end());
  });
  return motion;
}

// The rest shape where the roots have carried it.
Positions restAt(const sim::HairMesh& mesh, const Positions& roots) {
  Eigen::Matrix3Xd from(3, mesh.columnCount()), to(3, mesh.columnCount());
  for (int c = 0; c < mesh.columnCount(); ++c) {
    from.col(c) = mesh.shape.positions[mesh.shape.column_first[c]];
    to.col(c) = roots[c];
  }
  const Eigen::Matrix4d move = Eigen::umeyama(from, to, false);
  Positions positions;
  for (const sim::Vec3& p : mesh.shape.positions) positions.push_back((move * p.homogeneous()).head<3>());
  return positions;
}

// Ours, with Bullet's interface.
class OwnHair {
 public:
  OwnHair(const sim::HairMesh& mesh, const sim::SimParams& params)
      : mesh_(mesh), params_(params), context_(mesh), state_(sim::restState(mesh, Eigen::Isometry3d::Identity())) {}
  void place(std::span<const sim::Vec3> positions) {
    state_.positions.assign(positions.begin(), positions.end());
    state_.velocities.assign(positions.size(), sim::Vec3::Zero());
    state_.previous_dt = 0;
  }
  void step(std::span<const sim::Vec3> roots, double dt) {
    sim::advance(mesh_, params_, {roots, {}, 0}, dt, context_, state_);
  }
  void readPositions(Positions& positions) const { positions = state_.positions; }

 private:
  const sim::HairMesh& mesh_;
  sim::SimParams params_;
  sim::StepContext context_;
  sim::HairState state_;
};

struct PeerFigures {
  std::string who;
  double ms_a_frame = 0;
  double along_mean = 0, along_max = 0, across_mean = 0, across_max = 0;  // |l / l0 - 1| over edges and frames
  double volume_error_mean = 0, volume_error_max = 0;  // |V / V0 - 1| over corner tetrahedra and frames
  double inverted = 0;                                 // corner tetrahedra, in the worst frame
  double after_collapse = 0, after_motion = 0;         // RMS distance to the undisturbed rest over hair length
};

// Adds |l / l0 - 1| of the edges.
void measureEdges(const std::vector<sim::Edge>& edges, const Positions& x, int frames, double& mean, double& most) {
  for (const sim::Edge& edge : edges) {
    const double error = std::abs((x[edge.a] - x[edge.b]).norm() / edge.rest_length - 1);
    mean += error / (static_cast<double>(edges.size()) * frames);
    most = std::max(most, error);
  }
}

void measureShape(const sim::HairMesh& mesh, const Positions& x, int frames, PeerFigures& figures) {
  measureEdges(mesh.vertical_edges, x, frames, figures.along_mean, figures.along_max);
  measureEdges(mesh.horizontal_edges, x, frames, figures.across_mean, figures.across_max);
  double volumes = 0, inverted = 0;
  for (const sim::CornerTet& tet : mesh.tets) {
    const sim::Vec3 e1 = x[tet.v[1]] - x[tet.v[0]], e2 = x[tet.v[2]] - x[tet.v[0]], e3 = x[tet.v[3]] - x[tet.v[0]];
    const double ratio = e1.dot(e2.cross(e3)) / 6 / tet.rest_volume;
    volumes += std::abs(ratio - 1);
    figures.volume_error_max = std::max(figures.volume_error_max, std::abs(ratio - 1));
    inverted += ratio <= 0;
  }
  figures.volume_error_mean += volumes / static_cast<double>(mesh.tets.size()) / frames;
  figures.inverted = std::max(figures.inverted, inverted);
}

template <class Hair>
Positions stillFor(int frames, const Positions& roots, Hair& hair) {
  for (int n = 0; n < frames; ++n) hair.step(roots, kFrame);
  Positions positions;
  hair.readPositions(positions);
  return positions;
}

struct PeerScenes {
  const sim::HairMesh& mesh;
  RootMotion shake, violent;
};

// RMS distance over hair length between two shapes on their roots. A shape that is not finite is infinitely far.
double distance(const sim::HairMesh& mesh, const Positions& a, const Positions& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
  const double rms = std::sqrt(sum / static_cast<double>(a.size())) / mesh.hair_length;
  return std::isfinite(rms) ? rms : 1e9;
}

template <class Hair>
PeerFigures measurePeer(const std::string& who, const PeerScenes& scenes, Hair hair) {
  const sim::HairMesh& mesh = scenes.mesh;
  PeerFigures figures;
  figures.who = who;
  // A head shake from where it hangs at rest.
  const Positions& first = scenes.shake.front();
  hair.place(restAt(mesh, first));
  const Positions hanging = stillFor(kRecoveryFrames, first, hair);
  std::vector<double> times;
  const int frames = static_cast<int>(scenes.shake.size());
  Positions x;
  for (const Positions& roots : scenes.shake) {
    const double started = cpuSeconds();
    hair.step(roots, kFrame);
    times.push_back(1e3 * (cpuSeconds() - started));
    hair.readPositions(x);
    measureShape(mesh, x, frames, figures);
  }
  figures.ms_a_frame = medianOf(times);
  // From all vertices on their roots, against where it hung undisturbed.
  Positions collapsed(mesh.vertexCount());
  for (int i = 0; i < mesh.vertexCount(); ++i) collapsed[i] = first[mesh.column_of[i]];
  hair.place(collapsed);
  figures.after_collapse = distance(mesh, stillFor(kRecoveryFrames, first, hair), hanging);
  // After violent motion, against the same stillness without it.
  const Positions& last = scenes.violent.back();
  hair.place(restAt(mesh, scenes.violent.front()));
  for (const Positions& roots : scenes.violent) hair.step(roots, kFrame);
  const Positions after = stillFor(kRecoveryFrames, last, hair);
  hair.place(restAt(mesh, last));
  figures.after_motion = distance(mesh, after, stillFor(kRecoveryFrames, last, hair));
  return figures;
}

nlohmann::json toJson(const std::string& scene, const sim::HairMesh& mesh, const PeerFigures& f) {
  return {{"scene", scene},
          {"vertices", mesh.vertexCount()},
          {"who", f.who},
          {"ms_a_frame", f.ms_a_frame},
          {"along_mean", f.along_mean},
          {"along_max", f.along_max},
          {"across_mean", f.across_mean},
          {"across_max", f.across_max},
          {"volume_error_mean", f.volume_error_mean},
          {"volume_error_max", f.volume_error_max},
          {"inverted", f.inverted},
          {"after_collapse", f.after_collapse},
          {"after_motion", f.after_motion}};
}

std::vector<PeerFigures> measureAll(const PeerScenes& scenes) {
  const sim::SimParams standard;
  sim::SimParams paper;
  paper.solver = sim::Solver::kPaper, paper.max_iterations = 400;
  sim::SimParams second_order;
  second_order.integrator = sim::Integrator::kBdf2;
  std::vector<PeerFigures> all;
  const auto add = [&](const std::string& who, auto hair) {
    all.push_back(measurePeer(who, scenes, std::move(hair)));
    const PeerFigures& f = all.back();
    std::printf(
        "  %-42s %7.3f ms  along %.4f %.3f  across %.4f %.3f  volumes %.4f %.2f  inverted %4.0f  collapse %.2e  motion "
        "%.2e\n",
        f.who.c_str(), f.ms_a_frame, f.along_mean, f.along_max, f.across_mean, f.across_max, f.volume_error_mean,
        f.volume_error_max, f.inverted, f.after_collapse, f.after_motion);
    std::fflush(stdout);
  };
  add("hairmesh, default", OwnHair(scenes.mesh, standard));
  add("hairmesh, BDF2", OwnHair(scenes.mesh, second_order));
  add("hairmesh, the paper's setting", OwnHair(scenes.mesh, paper));
#ifdef HAIRMESH_BULLET
  const Positions rest = restAt(scenes.mesh, scenes.shake.front());
  for (const BulletMethod method : {BulletMethod::kPositions10, BulletMethod::kPositions50, BulletMethod::kImplicit}) {
    // On the large mesh the implicit body, which comes apart on the small one, would take most of an hour.
    if (method == BulletMethod::kImplicit && scenes.mesh.vertexCount() > kMaxOfImplicit) continue;
    add(bulletMethodName(method), BulletHair(scenes.mesh, standard, rest, method));
  }
#endif
  return all;
}

}  // namespace

void runPeers(const PeersOptions& options) {
  makeFolder(options.folder, "choose another with --out");
  nlohmann::json rows = nlohmann::json::array();
  for (const app::Resolution resolution : {app::Resolution::kLow, app::Resolution::kHigh}) {
    const char* name = resolution == app::Resolution::kLow ? "long_low" : "long_high";
    TrajectoryStage shake({name, "head_shake.bvh", app::Style::kLong, resolution, 1, false, false, 2});
    TrajectoryStage violent({name, "jump_spin.bvh", app::Style::kLong, resolution, 10, false, false, 1});
    const PeerScenes scenes{shake.mesh(), rootMotion(shake), rootMotion(violent)};
    std::printf("\n%s: %d vertices, 1/60 s\n", name, scenes.mesh.vertexCount());
    for (const PeerFigures& figures : measureAll(scenes)) rows.push_back(toJson(name, scenes.mesh, figures));
  }
  app::writeFile(options.folder + "/peers.json", rows.dump(1) + "\n");
}

}  // namespace bench

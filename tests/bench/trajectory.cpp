#include "tests/bench/trajectory.h"

#include <algorithm>
#include <cmath>

#include "app/files/data_path.h"
#include "tests/bench/cpu_clock.h"
#include "tests/bench/scene_times.h"
#include "tests/sim_probes.h"

namespace bench {
namespace {

constexpr double kSameSample = 1e-6;  // of a step

}  // namespace

std::vector<TrajectoryScene> trajectoryScenes() {
  using app::Resolution;
  using app::Style;
  return {
      {"head_shake", "head_shake.bvh", Style::kLong, Resolution::kLow, 1, false, false, 1},
      {"walk_contact", "walk.bvh", Style::kLong, Resolution::kLow, 1, true, false, 1},
      {"walk_short", "walk.bvh", Style::kShort, Resolution::kLow, 1, true, false, 1},
      {"walk_shoulder", "walk.bvh", Style::kShoulder, Resolution::kLow, 1, true, false, 1},
      {"jump_1x", "jump_spin.bvh", Style::kLong, Resolution::kLow, 1, false, false, 1},
      {"jump_4x", "jump_spin.bvh", Style::kLong, Resolution::kLow, 4, false, false, 0.5},
      {"jump_10x", "jump_spin.bvh", Style::kLong, Resolution::kLow, 10, false, false, 0.3},
      {"collapse", "idle_turns.bvh", Style::kLong, Resolution::kLow, 1, false, true, 1},
      {"walk_high", "walk.bvh", Style::kLong, Resolution::kHigh, 1, true, false, 0.3},
  };
}

TrajectoryStage::TrajectoryStage(const TrajectoryScene& scene) : scene_(scene) {
  app::CharacterSpec spec;
  spec.motion = app::findFile(scene.motion, "", "clips");
  spec.style = scene.style;
  spec.resolution = scene.resolution;
  app::PlaybackSpec playback;
  playback.speed = scene.speed;
  actor_ = app::makeActor(spec, playback, asset_cache_);
  sim::SimParams params;
  params.collide = scene.collide;
  app::settleActor(params, kSettle, actor_);
  if (scene.collapsed) sim::collapseOntoRoots(mesh(), actor_.hair);
  start_ = actor_.hair;
  playback_ = actor_.playback;
  model_ = test::makeForceModel(mesh(), sim::systemPattern(mesh()), params);
}

int TrajectoryStage::sampleCount() const {
  return static_cast<int>(std::lround(scene_.seconds * kSamplesPerSecond));
}

void TrajectoryStage::restart() {
  actor_.playback = playback_;
  app::placeActor(actor_, true);
  actor_.hair = start_;
}

void TrajectoryStage::visitSteps(sim::SimParams params, const Visit& visit) {
  params.collide = scene_.collide;
  restart();
  const int steps = static_cast<int>(std::lround(scene_.seconds / params.time_step));
  for (int step = 0; step < steps; ++step) {
    app::moveActor(params.time_step, actor_);
    visit(step, {actor_.roots, actor_.ellipsoids, (step + 1) * params.time_step}, actor_.hair);
    app::simulateActor(params, params.time_step, (step + 1) * params.time_step, actor_);
  }
}

RunResult TrajectoryStage::run(sim::SimParams params, int samples) {
  params.collide = scene_.collide;
  // Factors and tables follow the parameters in the first step: once more, so that this is not timed.
  restart();
  app::moveActor(params.time_step, actor_);
  app::simulateActor(params, params.time_step, params.time_step, actor_);
  restart();
  RunResult result;
  const double dt = params.time_step;
  int steps = 0;
  std::vector<sim::Vec3> before;
  double energy_before = energy();
  while (static_cast<int>(result.trajectory.size()) < samples) {
    before = actor_.hair.positions;
    app::moveActor(dt, actor_);
    const double started = cpuSeconds();
    const sim::StepReport report = app::simulateActor(params, dt, ++steps * dt, actor_);
    result.seconds += cpuSeconds() - started;
    result.iterations += report.solver_iterations;
    result.recoveries += report.recoveries;
    const auto fractionOfNext = [&] {
      return (static_cast<double>(result.trajectory.size() + 1) / kSamplesPerSecond - (steps - 1) * dt) / dt;
    };
    if (fractionOfNext() > 1 + kSameSample) continue;
    const double energy_after = energy();
    measure(result);
    for (double f; (f = fractionOfNext()) <= 1 + kSameSample && static_cast<int>(result.trajectory.size()) < samples;) {
      if (f > 1 - kSameSample) f = 1;
      auto& sample = result.trajectory.emplace_back(actor_.hair.positions);
      for (std::size_t i = 0; f < 1 && i < sample.size(); ++i) sample[i] = (1 - f) * before[i] + f * sample[i];
      result.energy.push_back((1 - f) * energy_before + f * energy_after);
    }
    energy_before = energy_after;
  }
  result.iterations /= std::max(steps, 1);
  result.volume_error /= std::max(result.measured, 1);
  return result;
}

double TrajectoryStage::energy() const {
  const sim::SimParams params;
  std::vector<sim::V3<double>> x;
  for (const sim::Vec3& p : actor_.hair.positions) x.push_back({p.x(), p.y(), p.z()});
  double sum = sim::evaluate<double>(model_, x, {});
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double mass = params.density * mesh().vertex_volume[i];
    sum += mass * (0.5 * actor_.hair.velocities[i].squaredNorm() + params.gravity * x[i].y);
  }
  return sum;
}

void TrajectoryStage::measure(RunResult& result) const {
  const std::vector<sim::Vec3>& x = actor_.hair.positions;
  for (const sim::Edge& edge : mesh().vertical_edges) {
    const double strain = (x[edge.a] - x[edge.b]).norm() / edge.rest_length - 1;
    result.worst_stretch = std::max(result.worst_stretch, std::abs(strain));
  }
  ++result.measured;
  double sum = 0;
  for (const sim::CornerTet& tet : mesh().tets) {
    const sim::Vec3 e1 = x[tet.v[1]] - x[tet.v[0]], e2 = x[tet.v[2]] - x[tet.v[0]], e3 = x[tet.v[3]] - x[tet.v[0]];
    sum += std::abs(e1.dot(e2.cross(e3)) / 6 / tet.rest_volume - 1);
  }
  result.volume_error += sum / static_cast<double>(mesh().tets.size());
  if (!scene_.collide) return;
  for (const int v : mesh().external_vertices) {
    for (const sim::Ellipsoid& e : actor_.ellipsoids) {
      if (test::implicitValue(e, x[v]) >= 0) continue;
      result.worst_penetration = std::max(result.worst_penetration, -sim::closestPoint(e, x[v]).distance);
    }
  }
}

TrajectoryError difference(const Trajectory& a, const Trajectory& b, double hair_length, int samples) {
  TrajectoryError error;
  double sum = 0, count = 0;
  for (int s = 0; s < samples; ++s) {
    for (std::size_t i = 0; i < a[s].size(); ++i) {
      const double d = (a[s][i] - b[s][i]).squaredNorm();
      sum += d, count += 1;
      error.most = std::max(error.most, d);
    }
  }
  error.rms = std::sqrt(sum / std::max(count, 1.0)) / hair_length;
  error.most = std::sqrt(error.most) / hair_length;
  return error;
}

}  // namespace bench

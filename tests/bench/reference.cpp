#include "tests/bench/reference.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "tests/bench/written_files.h"

namespace bench {
namespace {

constexpr double kToldApart = 0.1;  // share of an error that the reference's own may have

struct Run {
  Trajectory trajectory;
  std::vector<double> energy;
};

sim::SimParams referenceParams(double step) {
  sim::SimParams params;
  params.integrator = sim::Integrator::kBdf2;
  params.time_step = step;
  params.precision = sim::Precision::kDouble;
  params.tolerance = 1e-11;
  params.acceleration_tolerance = params.displacement_tolerance = 0;
  return params;
}

// What a cached run must have been made from: every parameter, and the state that it started from.
std::string keyOf(const TrajectoryStage& stage, const sim::SimParams& params) {
  std::ostringstream key;
  key.precision(17);
  const TrajectoryScene& scene = stage.scene();
  key << scene.name << " " << scene.motion << " " << scene.speed << " " << scene.seconds << " " << scene.collide << " "
      << kSamplesPerSecond;
  for (const sim::ParamField& field : sim::paramFields()) key << " " << field.name << "=" << paramText(field, params);
  for (const sim::Vec3& p : stage.start().positions) key << " " << p.x() << " " << p.y() << " " << p.z();
  return key.str();
}

bool readRun(const std::string& file, const std::string& key, Run& run) {
  std::ifstream stream(file, std::ios::binary);
  std::string stored(key.size(), 0);
  std::size_t samples = 0, vertices = 0;
  if (!stream.read(stored.data(), static_cast<std::streamsize>(key.size())) || stored != key) return false;
  const auto get = [&](void* to, std::size_t bytes) {
    return static_cast<bool>(stream.read(static_cast<char*>(to), static_cast<std::streamsize>(bytes)));
  };
  if (!get(&samples, sizeof samples) || !get(&vertices, sizeof vertices) || samples > 10000 || vertices > 1000000) {
    return false;
  }
  run.energy.resize(samples);
  if (!get(run.energy.data(), samples * sizeof(double))) return false;
  run.trajectory.assign(samples, std::vector<sim::Vec3>(vertices));
  for (auto& positions : run.trajectory) {
    if (!get(positions.data(), vertices * sizeof(sim::Vec3))) return false;
  }
  return true;
}

void writeRun(const std::string& file, const std::string& key, const Run& run) {
  app::OutputFile output(file);
  const auto put = [&](const void* from, std::size_t bytes) { output.write({static_cast<const char*>(from), bytes}); };
  const std::size_t samples = run.trajectory.size(), vertices = run.trajectory.front().size();
  put(key.data(), key.size());
  put(&samples, sizeof samples), put(&vertices, sizeof vertices);
  put(run.energy.data(), samples * sizeof(double));
  for (const auto& positions : run.trajectory) put(positions.data(), vertices * sizeof(sim::Vec3));
  output.commit();
}

Run runOrRead(TrajectoryStage& stage, double step, const std::string& cache) {
  const sim::SimParams params = referenceParams(step);
  Run run;
  std::string file, key;
  if (!cache.empty()) {
    makeFolder(cache, "choose another with --references");
    file = cache + "/" + stage.scene().name + "_" + std::to_string(std::lround(1 / step)) + ".bin";
    key = keyOf(stage, params);
    if (readRun(file, key, run) && stage.run(params, 1).trajectory.front() == run.trajectory.front()) return run;
  }
  RunResult result = stage.run(params);
  run = {std::move(result.trajectory), std::move(result.energy)};
  if (!cache.empty()) writeRun(file, key, run);
  return run;
}

}  // namespace

Reference referenceOf(TrajectoryStage& stage, int steps_a_second, const std::string& cache) {
  Reference reference;
  // The steps of the larger meshes cost ten times as much.
  reference.step = (stage.scene().resolution == app::Resolution::kLow ? 1.0 : 4.0) / steps_a_second;
  const Run coarse = runOrRead(stage, 2 * reference.step, cache);
  Run fine = runOrRead(stage, reference.step, cache);
  reference.trajectory = std::move(fine.trajectory);
  reference.energy = std::move(fine.energy);
  for (int samples = 1; samples <= stage.sampleCount(); ++samples) {
    reference.own_error.push_back(
        difference(coarse.trajectory, reference.trajectory, stage.mesh().hair_length, samples).rms);
  }
  return reference;
}

int comparableSamples(const Reference& reference, const Trajectory& trajectory, double hair_length) {
  int comparable = 1;
  for (int samples = 1; samples <= static_cast<int>(reference.trajectory.size()); ++samples) {
    const double error = difference(trajectory, reference.trajectory, hair_length, samples).rms;
    if (reference.ownErrorOver(samples) <= kToldApart * error) comparable = samples;
  }
  return comparable;
}

}  // namespace bench

// A crowd: 100 hairs of one mesh on all cores, in C++17 over the C interface. One thread at a time works on a hair.
// crowd HAIR.obj [SECONDS]
#include <hairmesh.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace {

constexpr int kHairs = 100;

void must(hm_result result) {
  if (result != HM_OK) throw std::runtime_error(hm_error_message());
}

// Every head turns at its own pace; a skull moves with it.
void stepOne(hm_hair hair, int number, double time) {
  const double rate = 4 + 0.05 * number, angle = std::sin(rate * time), speed = rate * std::cos(rate * time);
  hm_step_input step;
  hm_ellipsoid skull;
  hm_default_step_input(&step);
  hm_default_ellipsoid(&skull);
  step.time = time;
  step.head.rotation[1] = std::sin(angle / 2);
  step.head.rotation[3] = std::cos(angle / 2);
  skull.pose = step.head;
  skull.pose.position[1] = 0.085;
  skull.radii[0] = 0.072, skull.radii[1] = 0.1, skull.radii[2] = 0.09;
  skull.angular_velocity[1] = speed;
  step.ellipsoids = &skull;
  step.ellipsoid_count = 1;
  must(hm_hair_step(hair, &step, nullptr));
}

// One frame: threads take the next hair until none is left.
void stepAll(const std::vector<hm_hair>& hairs, double time, unsigned workers) {
  std::atomic<int> next{0};
  const auto work = [&] {
    for (int i = next++; i < kHairs; i = next++) stepOne(hairs[i], i, time);
  };
  std::vector<std::thread> threads;
  for (unsigned t = 1; t < workers; ++t) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
}

double secondsNow() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

int main(int count, char** arguments) try {
  if (count < 2) throw std::runtime_error("crowd HAIR.obj [SECONDS]");
  std::ifstream stream(arguments[1], std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const int frames = static_cast<int>(60 * (count > 2 ? std::atof(arguments[2]) : 2));
  hm_mesh mesh{};
  must(hm_mesh_create_from_text(text.data(), text.size(), arguments[1], 0, &mesh));
  std::vector<hm_hair> hairs(kHairs);
  for (hm_hair& hair : hairs) must(hm_hair_create(mesh, nullptr, &hair));
  must(hm_mesh_destroy(mesh));  // its hairs keep it

  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  const double start = secondsNow();
  for (int frame = 1; frame <= frames; ++frame) stepAll(hairs, frame / 60.0, cores);
  const double took = secondsNow() - start;
  double lowest = 0;
  for (const hm_hair hair : hairs) {
    hm_view view{};
    must(hm_hair_positions(hair, &view));
    for (std::size_t i = 0; i < view.count; ++i) lowest = std::min(lowest, view.data[3 * i + 1]);
    must(hm_hair_destroy(hair));
  }
  std::printf("%d hairs, %d frames, %u threads: %.2f ms a frame, %.3f ms a hair; lowest tip %.3f m\n", kHairs, frames,
              cores, 1e3 * took / frames, 1e3 * took * cores / frames / kHairs, lowest);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}

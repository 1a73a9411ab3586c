// The kernels are compiled for several instruction sets, and the processor picks: the same steps on each.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include "sim/sim_params.h"

namespace kernel_sets_test {

struct Line {
  std::array<int, 3> way;  // solver, precision, integrator
  std::array<double, 3> x;
};

// What the probe writes; empty where the processor does not have its instructions.
std::vector<Line> run(const std::string& program) {
  std::vector<Line> lines;
  FILE* pipe = popen(('"' + program + '"').c_str(), "r");
  EXPECT_NE(pipe, nullptr);
  if (!pipe) return lines;
  Line line;
  while (std::fscanf(pipe, "%d %d %d %lg %lg %lg", &line.way[0], &line.way[1], &line.way[2], &line.x[0], &line.x[1],
                     &line.x[2]) == 6)
    lines.push_back(line);
  const int status = pclose(pipe);
  EXPECT_TRUE(WIFEXITED(status) && (WEXITSTATUS(status) == 0 || WEXITSTATUS(status) == 77)) << program;
  return lines;
}

TEST(KernelSets, TakeTheSameStepsWithinRounding) {
  std::istringstream programs(HAIRMESH_KERNEL_PROBES);
  std::string program;
  if (!(programs >> program)) GTEST_SKIP() << "one instruction set only: not x86-64, or not built by GCC";
  const std::vector<Line> plain = run(program);
  ASSERT_FALSE(plain.empty());
  int compared = 0;
  while (programs >> program) {
    const std::vector<Line> other = run(program);
    if (other.empty()) {
      std::printf("%s: not on this processor\n", program.c_str());
      continue;
    }
    ASSERT_EQ(other.size(), plain.size());
    std::array<double, 2> worst{};  // m, by precision
    bool same_bits = true;
    for (std::size_t i = 0; i < plain.size(); ++i) {
      ASSERT_EQ(other[i].way, plain[i].way);
      for (int k = 0; k < 3; ++k) {
        const double off = std::abs(other[i].x[k] - plain[i].x[k]);
        double& most = worst[plain[i].way[1]];
        most = std::max(most, off);
        same_bits &= off == 0;
      }
    }
    std::printf("%s: float %.1e m, double %.1e\n", program.c_str(), worst[0], worst[1]);
    // Hair of 20 cm: rounding of single precision, times what three stiff steps make of it.
    EXPECT_LT(worst[static_cast<int>(sim::Precision::kFloat)], 1e-5);
    EXPECT_LT(worst[static_cast<int>(sim::Precision::kDouble)], 1e-9);
    EXPECT_FALSE(same_bits) << "products fused with sums round differently: were other kernels run at all?";
    ++compared;
  }
  if (compared == 0) GTEST_SKIP() << "this processor has the plain set only";
}

}  // namespace kernel_sets_test

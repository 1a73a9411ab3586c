// hairmesh-stress as a person runs it: what it says and how it ends.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "tests/run_program.h"

namespace stress_run_test {

// Every test's binary lies beside it.
const std::string kStress = std::string(HAIRMESH_TEST_OUT) + "/../hairmesh-stress";
const std::string kCheap = "state/collapsed/1-60s/short-low/free/0";

test::Outcome runStress(const std::vector<std::string>& arguments) {
  std::filesystem::create_directories(HAIRMESH_TEST_OUT);
  const std::string base = std::string(HAIRMESH_TEST_OUT) + "/stress_" + std::to_string(::getpid());
  std::string command = "timeout 400 " + test::shellQuoted(kStress);
  for (const std::string& argument : arguments) command.append(" ").append(test::shellQuoted(argument));
  const int status = std::system(
      (command + " >" + test::shellQuoted(base + ".out") + " 2>" + test::shellQuoted(base + ".err")).c_str());
  test::Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, test::readAll(base + ".out"),
                        test::readAll(base + ".err")};
  std::filesystem::remove(base + ".out");
  std::filesystem::remove(base + ".err");
  return outcome;
}

class StressRun : public testing::Test {
  void SetUp() override { ASSERT_TRUE(std::filesystem::exists(kStress)) << "build the target hairmesh-stress too"; }
};

TEST_F(StressRun, ACaseThatPassesIsCountedAndExitsWithZero) {
  const test::Outcome outcome = runStress({"--case", kCheap});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(outcome.out.ends_with("\n1 passed, 0 failed\n")) << outcome.out;
}

// Heavy, slack and dull hair in thick air is nowhere near its shape in the time that it has.
TEST_F(StressRun, AFailureExitsWithOneAndPrintsACommandThatFailsAgain) {
  std::vector<std::string> arguments{"--case", kCheap, "--seed", "3"};
  std::string replay = "hairmesh-stress --case '" + kCheap + "' --seed 3";
  for (const char* set : {"damping=1", "air_drag=50", "density=2000", "stretch_along=100", "volume=1", "bend=0.0001"}) {
    arguments.insert(arguments.end(), {"--set", set});
    replay.append(" --set ").append(set);
  }
  const test::Outcome outcome = runStress(arguments);
  EXPECT_EQ(outcome.exit_code, 1) << outcome.out;
  EXPECT_NE(outcome.out.find("FAILED   " + kCheap), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("  " + replay + "\n"), std::string::npos) << outcome.out;
  EXPECT_TRUE(outcome.out.ends_with("\n0 passed, 1 failed\n")) << outcome.out;
}

// In a storm, and with ten iterations a solve, a hair, its reference and a reference of finished solves come to three
// rests. Each is one. Hair that hangs higher than finished solves would have it still fails.
TEST_F(StressRun, HairPassesAtAStableRestOfItsOwnAndFailsAtAHigherOne) {
  EXPECT_EQ(runStress({"--case", "random-params/134"}).exit_code, 0);
  const test::Outcome left = runStress({"--case", "random-params/206", "--ablate", "reference-hair"});
  EXPECT_NE(left.out.find("reference-hair lost random-params/206: still "), std::string::npos) << left.out;
}

// Long hair that nothing holds out is lifted out of the shoulders, but a storm from behind blows it into head and neck.
TEST_F(StressRun, StrandsUnderTheDrawnSkinFailACapture) {
#ifndef HAIRMESH_EMBREE
  GTEST_SKIP() << "strands are looked at where Embree is installed";
#endif
  if (!std::filesystem::exists(std::filesystem::path(HAIRMESH_SOURCE_DIR) / ".." / "shared" / "mocap"))
    GTEST_SKIP() << "no captures are here";
  const std::vector<std::string> walk{"--case", "capture/cmu_02_01_walk/go-on/1x/long-low"};
  EXPECT_EQ(runStress(walk).exit_code, 0);
  std::vector<std::string> sunk = walk;
  sunk.insert(sunk.end(), {"--set", "collide=0", "--set", "wind_y=40", "--set", "wind_z=30", "--set", "air_drag=3"});
  const test::Outcome outcome = runStress(sunk);
  EXPECT_EQ(outcome.exit_code, 1) << outcome.out;
  EXPECT_NE(outcome.out.find("under the drawn skin"), std::string::npos) << outcome.out;
}

TEST_F(StressRun, WhatIsNotDeclaredOrNoParameterIsRefused) {
  const test::Outcome nothing = runStress({"--case", "state/nowhere"});
  EXPECT_EQ(nothing.exit_code, 2);
  EXPECT_NE(nothing.err.find("state/nowhere"), std::string::npos) << nothing.err;
  EXPECT_EQ(runStress({"--case", kCheap, "--set", "no_such=1"}).exit_code, 2);
}

// The rows of a --csv without the time that the cases took.
std::vector<std::string> rowsOf(const std::string& file) {
  std::vector<std::string> rows;
  std::stringstream text(test::readAll(file));
  std::size_t timed = 0;
  for (std::string line; std::getline(text, line);) {
    std::vector<std::string> fields;
    std::stringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) fields.push_back(cell);
    if (rows.empty())
      timed = static_cast<std::size_t>(std::find(fields.begin(), fields.end(), "cpu_s") - fields.begin());
    std::string row;
    for (std::size_t k = 0; k < fields.size(); ++k) row += k == timed ? "" : fields[k] + ",";
    rows.push_back(row);
  }
  return rows;
}

TEST_F(StressRun, TheSameSeedGivesTheSameTable) {
  const std::string folder = test::freshFolder("stress_run");
  const std::string drawn = "state/noise-1cm/1-60s/short-low/*";
  const auto table = [&](const std::string& name, const std::string& seed) {
    runStress({"--case", drawn, "--seed", seed, "--csv", folder + "/" + name});
    return rowsOf(folder + "/" + name);
  };
  const auto first = table("first.csv", "5"), again = table("again.csv", "5"), other = table("other.csv", "6");
  EXPECT_EQ(first.size(), 5u) << "a head and two draws with and without the body";
  EXPECT_EQ(first, again);
  EXPECT_NE(first, other);
}

// A share of the cases, of all families: what outlives a step is in the state, and nowhere else.
TEST_F(StressRun, CasesSavedMidwayGoOnInAnotherProcessAndEndInTheSameBits) {
  const std::string folder = test::freshFolder("stress_states");
  const std::vector<std::string> share{"--short", "--parts", "18", "--part", "3"};
  const auto run = [&](const char* what) {
    std::vector<std::string> arguments = share;
    arguments.insert(arguments.end(), {what, folder});
    return runStress(arguments);
  };
  const test::Outcome saved = run("--save"), resumed = run("--resume");
  EXPECT_EQ(saved.exit_code, 0) << saved.err;
  EXPECT_EQ(resumed.exit_code, 0) << resumed.out << resumed.err;
  EXPECT_TRUE(resumed.out.ends_with(" resumed to the same bits, 0 failed\n")) << resumed.out;
  EXPECT_GE(std::stoi(resumed.out), 15) << resumed.out;
  std::vector<std::string> seeded = share;
  seeded.insert(seeded.end(), {"--resume", folder, "--seed", "2"});
  const test::Outcome other_seed = runStress(seeded);
  EXPECT_EQ(other_seed.exit_code, 4);
  EXPECT_NE(other_seed.err.find("was saved with --seed 1, not 2; give --seed 1"), std::string::npos) << other_seed.err;
  // A state that is not the one that was saved, or none, is told.
  std::filesystem::remove_all(folder);
  EXPECT_EQ(run("--resume").exit_code, 4);
}

TEST_F(StressRun, WhatChoosesNothingIsToldAndPartsChooseAmongNamedCases) {
  const auto linesOf = [&](const std::vector<std::string>& arguments) {
    const test::Outcome outcome = runStress(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return std::count(outcome.out.begin(), outcome.out.end(), '\n');
  };
  const auto all = linesOf({"--list", "--case", "mixed/1*"});
  long dealt = 0;
  for (const char* part : {"0", "1", "2", "3"})
    dealt += linesOf({"--list", "--case", "mixed/1*", "--parts", "4", "--part", part});
  EXPECT_EQ(dealt, all);
  EXPECT_LT(linesOf({"--list", "--case", "mixed/1*", "--parts", "4", "--part", "1"}), all / 3);
  const std::string folder = test::freshFolder("stress_none");
  for (const std::vector<std::string>& unknown :
       {std::vector<std::string>{"--case", "nix"}, {"--save", folder, "--case", "nix"}, {"--list", "--case", "nix"}}) {
    const test::Outcome outcome = runStress(unknown);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_NE(outcome.err.find("case 'nix': is not declared"), std::string::npos) << outcome.err;
  }
  const test::Outcome beyond = runStress({"--short", "--part", "9", "--parts", "4"});
  EXPECT_EQ(beyond.exit_code, 2);
  EXPECT_NE(beyond.err.find("from 0 to 3"), std::string::npos) << beyond.err;
}

}  // namespace stress_run_test

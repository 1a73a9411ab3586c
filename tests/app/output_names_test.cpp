// What a command line would write over, or write nothing to, is refused; what is there stays.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "app/files/errors.h"
#include "tests/run_program.h"

namespace output_names_test {

using Words = std::vector<std::string>;

TEST(OutputNames, AnOutputDoesNotGoOverWhatIsRead) {
  const std::string folder = test::freshFolder("output_names"), file = folder + "/mine.bin";
  const std::string beside = folder + "/./mine.bin";
  for (const Words& words :
       {Words{"--motion", file, "--report", beside}, Words{file, "--record", beside}, Words{file, "--cache", file},
        Words{"--map", "length=" + file, "--report", beside}, Words{"--attach", file + "@Head", "--save-state", beside},
        Words{"--replay", file, "--record", file}, Words{"--load-state", file, "--report", beside}}) {
    std::ofstream(file) << "what a person made";
    const test::Outcome outcome = test::runProgram(words);
    EXPECT_EQ(outcome.exit_code, app::kExitUsage) << words[1] << " " << words.back() << ": " << outcome.err;
    std::ifstream in(file);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), "what a person made") << words.front();
  }
}

TEST(OutputNames, WhatWouldDoNothingBesideAnotherIsRefused) {
  for (const Words& words :
       {Words{"--report", "a.json", "--save-state", "./a.json"}, Words{"--write-hair", "a.obj", "--export", "a.abc"},
        Words{"--no-images", "--turntable", "30"}, Words{"--load-state", "s.state", "--start", "1"},
        Words{"--export", "a.abc", "--export-frames", "1.5"},
        Words{"--export", "a.abc", "--export-what", "guides", "--export-points", "7"}}) {
    const test::Outcome outcome = test::runProgram(words);
    EXPECT_EQ(outcome.exit_code, app::kExitUsage) << words.front() << " " << words[2] << ": " << outcome.err;
    EXPECT_NE(outcome.err.find(words[words.size() - 2]), std::string::npos) << outcome.err;
  }
}

}  // namespace output_names_test

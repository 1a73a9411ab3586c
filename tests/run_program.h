// Runs the built program as a person does: arguments in, exit code and words out.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace test {

struct Outcome {
  int exit_code = -1;  // -1: ended by a signal
  std::string out, err;
};

inline std::string readAll(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

// A fresh folder of the tests' output, of this process alone.
inline std::string freshFolder(const std::string& name) {
  const auto folder = std::filesystem::path(HAIRMESH_TEST_OUT) / (name + "_" + std::to_string(::getpid()));
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder.string();
}

inline std::string shellQuoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

// `environment`: NAME=VALUE words put before the command. Ends a run after two minutes with exit code 124.
inline Outcome runProgram(const std::vector<std::string>& arguments, const std::string& environment = "") {
  static int number = 0;
  std::filesystem::create_directories(HAIRMESH_TEST_OUT);
  const std::string base =
      std::string(HAIRMESH_TEST_OUT) + "/run_" + std::to_string(::getpid()) + "_" + std::to_string(number++);
  std::string command = "env " + environment + " timeout 120 " + shellQuoted(HAIRMESH_BINARY);
  for (const std::string& argument : arguments) command.append(" ").append(shellQuoted(argument));
  command += " >" + shellQuoted(base + ".out") + " 2>" + shellQuoted(base + ".err") + " </dev/null";
  const int status = std::system(command.c_str());
  Outcome outcome;
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  // The shell reports a signal as 128 and its number.
  if (outcome.exit_code > 128) outcome.exit_code = -1;
  outcome.out = readAll(base + ".out");
  outcome.err = readAll(base + ".err");
  std::filesystem::remove(base + ".out");
  std::filesystem::remove(base + ".err");
  return outcome;
}

}  // namespace test

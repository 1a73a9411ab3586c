// Tier 2 errors: what a person did, said in one message that names the file, the place, the fault and the mend.
#pragma once

#include <stdexcept>
#include <string>

namespace app {

// Exit codes of the executables.
enum ExitCode {
  kExitFine = 0,
  kExitFault = 1,
  kExitUsage = 2,
  kExitNoContext = 3,
  kExitBadInput = 4,
  kExitInterrupted = 130  // as shells have it: 128 and the number of SIGINT
};

// A file or value that cannot be used. what() is the whole message: "FILE: PLACE: FAULT; MEND".
struct InputError : std::runtime_error {
  InputError(const std::string& file, const std::string& place, const std::string& fault, const std::string& mend);
  bool of_file;  // a file is named; else the fault is in a value that was typed
};

// A file that cannot be written. Exit code kExitFault.
struct OutputError : std::runtime_error {
  OutputError(const std::string& file, const std::string& fault, const std::string& mend);
};

// No OpenGL context could be made, or a shader or framebuffer failed; what() says what was tried and what would mend
// it.
struct ContextError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace app

// How a program ends: what it throws is told in one line, and has an exit code.
#pragma once

#include <exception>
#include <iostream>

#include "app/files/errors.h"
#include "app/options.h"

namespace app {

// The exit code of run(), or that of the fault that it throws. What it has told must have arrived.
template <class Run>
int runMain(const char* program, Run&& run) {
  const auto fail = [&](const std::exception& fault, ExitCode code) -> int {
    std::cerr << program << ": " << fault.what() << "\n";
    return code;
  };
  try {
    const int code = run();
    std::cout.flush();
    if (!std::cout) throw OutputError("standard output", "cannot be written", "check where it is led to");
    return code;
  } catch (const UsageError& fault) {
    return fail(fault, kExitUsage);
  } catch (const InputError& fault) {
    return fail(fault, kExitBadInput);
  } catch (const ContextError& fault) {
    return fail(fault, kExitNoContext);
  } catch (const std::exception& fault) {
    return fail(fault, kExitFault);
  }
}

}  // namespace app

#include "app/platform/interrupt.h"

#include <signal.h>

#include <iostream>
#include <limits>

namespace app {

namespace {

volatile sig_atomic_t came = 0;

void note(int) {
  came = 1;
}

}  // namespace

void noteInterrupts() {
  struct sigaction action {};
  action.sa_handler = note;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction before {};
  sigaction(SIGHUP, nullptr, &before);
  if (before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);  // nohup has it ignored
}

bool interrupted() {
  return came != 0;
}

bool endedEarly(int frames, int asked) {
  if (!interrupted() || frames >= asked) return false;
  std::cout << "interrupted after " << frames;
  if (asked < std::numeric_limits<int>::max()) std::cout << " of " << asked;
  std::cout << " frames\n";
  return true;
}

}  // namespace app

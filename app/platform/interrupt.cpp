#include "app/platform/interrupt.h"

#include <signal.h>
#include <time.h>

#include <iostream>
#include <limits>

#include "app/files/report_line.h"

namespace app {

namespace {

constexpr double kTogether = 0.5;  // s, within which several are one

volatile sig_atomic_t came = 0;
double came_at = 0;  // s; the handler's alone, which blocks the other signals

void note(int signal) {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  const double at = static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  if (came == 0) came_at = at;
  came = 1;
  if (at - came_at < kTogether) return;
  struct sigaction action {};
  action.sa_handler = SIG_DFL;
  sigaction(signal, &action, nullptr);
  raise(signal);  // comes when this returns
}

}  // namespace

void noteInterrupts() {
  struct sigaction action {};
  action.sa_handler = note;
  for (const int other : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&action.sa_mask, other);
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
  const bool endless = asked == std::numeric_limits<int>::max();
  std::cout << "interrupted after ";
  if (!endless) std::cout << frames << " of ";
  std::cout << countOf(endless ? frames : asked, "frame") << "\n";
  return true;
}

}  // namespace app

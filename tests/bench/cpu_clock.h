// Processor time, so that other work on the machine does not count.
#pragma once

#include <time.h>

#include <algorithm>
#include <vector>

namespace bench {

inline double secondsOf(clockid_t clock) {
  timespec t;
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// Of this thread.
inline double cpuSeconds() {
  return secondsOf(CLOCK_THREAD_CPUTIME_ID);
}

inline double medianOf(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

// Microseconds of one call of `work`: median over calls for about `seconds`, at least three, the first excluded.
// `prepare` runs before each and is not timed.
template <class Prepare, class Work>
double medianMicroseconds(double seconds, const Prepare& prepare, const Work& work) {
  std::vector<double> times;
  double spent = 0;
  for (int k = 0; k < 4 || (spent < seconds && k < 200); ++k) {
    prepare();
    const double started = cpuSeconds();
    work();
    const double took = cpuSeconds() - started;
    spent += took;
    if (k > 0) times.push_back(1e6 * took);
  }
  return medianOf(times);
}

}  // namespace bench

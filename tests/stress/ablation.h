// Ablation: the matrix run without one safety net after the other, to measure what each saves.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tests/stress/stress_case.h"

namespace stress {

// The names of "all", or the one asked for; the first is "none", the run that the others are compared with. Throws
// app::UsageError for a name that is none.
std::vector<std::string> ablationsOf(const std::string& asked);

// Takes the net of that name out of every case; "none" takes none. Cases of a peer's setting have no nets and go.
std::vector<StressCase> without(const std::string& net, std::span<const StressCase> cases);

// What the matrix came to without one net.
struct Ablation {
  std::string net;
  long cases = 0, failed = 0;
  long lost = 0, gained = 0;  // failed here and passed with all nets; the other way round
  long guided = 0;            // cases in which columns were guided to rest
  double seconds = 0;         // of CPU
};

// One line a net: net,cases,failed,lost,gained,guided,cpu_s,cpu_ratio. The first is "none".
std::string ablationTable(std::span<const Ablation> rows);

}  // namespace stress

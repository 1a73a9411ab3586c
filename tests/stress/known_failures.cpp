#include "tests/stress/known_failures.h"

#include <algorithm>
#include <array>

namespace stress {
namespace {

struct KnownFailure {
  const char* name;
  const char* why;
};

constexpr std::uint64_t kSeed = 1;
constexpr const char* kBdf2 =
    "bdf2 in single precision gains energy in rubbing contacts; without friction, or in double, it was not seen to";
constexpr const char* kBdf2Short = "bdf2 in steps this short is off in double and without friction too; not understood";
constexpr const char* kBdf2Jitter =
    "bdf2 in steps this short goes on at 0.1 m/s: its solves stop after one iteration or none";
constexpr const char* kChatter =
    "its contacts chatter: energy goes up and down by 4 % from step to step; another rounding passes";
constexpr const char* kStiff =
    "by some roundings a solve in single precision raises the energy; in double, or to 1e-3, none was seen to";
constexpr const char* kLimp =
    "a thousandth as stiff for its weight, by some roundings it rests in another shape for good";
constexpr const char* kStrayed = "the watchdog steps in once, at a stretch element; another rounding passes";
constexpr std::array<KnownFailure, 9> kKnown{{
    {"ladder/bdf2-1-120s/dance/long-low", kBdf2},
    {"ladder/bdf2-1-240s/dance/long-low", kBdf2},
    {"ladder/bdf2-1-480s/dance/long-low", kBdf2Short},
    {"ladder/bdf2-1-480s/turn/long-low", kBdf2Jitter},
    {"paper/stiff-1e3/ours/long-low", kStiff},
    {"pace/frames/jump_spin/long-low/0", kChatter},
    {"stiffness/all-1e-3/dance/short-low", kLimp},
    {"stiffness/density-1e3/dance/short-low", kLimp},
    {"restless/2", kStrayed},
}};

}  // namespace

const char* knownFailure(const std::string& name, std::uint64_t seed) {
  if (seed != kSeed) return nullptr;
  const auto row =
      std::find_if(kKnown.begin(), kKnown.end(), [&](const KnownFailure& one) { return name == one.name; });
  return row == kKnown.end() ? nullptr : row->why;
}

}  // namespace stress

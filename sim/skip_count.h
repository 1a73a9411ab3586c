// Counts of work left out.
#pragma once

namespace sim {

// How much of one kind of work was left out, of how much.
struct SkipCount {
  long skipped = 0, of = 0;
  SkipCount& operator+=(const SkipCount& more) {
    skipped += more.skipped, of += more.of;
    return *this;
  }
};

}  // namespace sim

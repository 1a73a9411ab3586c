// Which of two preconditioners serves a solve best: the warped rest factor, few and dear iterations, or the two levels,
// more and cheaper ones. Where hair is thrown about, the rest shape says little about the matrix and the second is
// faster; on large meshes it often is.
#pragma once

#include <algorithm>
#include <limits>

namespace sim {

// `warped` makes the whole rest factor for meshes of up to so many vertices; larger ones have the two levels alone,
// whose memory and work grow with the mesh.
inline constexpr int kMaxFactored = 2000;

// Decides by counted work, in products with the matrix, so that the same inputs always decide alike. The other is
// tried now and then where a solve costs more than a little, for not much more than what the one in use takes.
struct PreconditionerChoice {
  static constexpr double kLittle = 15;  // the cheap one would hardly take less
  static constexpr double kOverrun = 1.5, kOutburst = 2;
  static constexpr double kGain = 0.75;                 // of the cost, for which the cheap one comes into use
  static constexpr double kMemory = 0.8;                // of earlier solves in the mean
  static constexpr int kBackoff = 4, kMaxBackoff = 16;  // solves from one trial to the next; failing ones double it

  bool cheap = false;    // the two levels are in use
  double mean_cost = 0;  // of a solve by the one in use
  int wait = kBackoff, backoff = kBackoff;

  struct Plan {
    bool cheap, trial;
    double budget;  // beyond it the other one takes over within the solve
  };
  Plan begin() {
    const bool trial = (cheap || mean_cost > kLittle) && --wait <= 0;
    if (trial) return {!cheap, true, (cheap ? 1 : kOverrun) * mean_cost};
    // The cheap one in use may take what it takes: nothing better is at hand.
    return {cheap, false, cheap ? std::numeric_limits<double>::infinity() : kOutburst * std::max(kLittle, mean_cost)};
  }
  // `cost`: of the whole solve; `overrun`: the budget did not suffice.
  void end(const Plan& plan, double cost, bool overrun) {
    if (!plan.trial && !overrun) {
      mean_cost = mean_cost > 0 ? kMemory * mean_cost + (1 - kMemory) * cost : cost;
    } else if (!plan.trial || (!overrun && cost < (cheap ? 1 : kGain) * mean_cost)) {
      cheap = !cheap;
      mean_cost = cost;
      wait = backoff = kBackoff;
    } else {
      wait = backoff = std::min(2 * backoff, kMaxBackoff);
    }
  }
};

// How long what the two levels made serves: hair changes little from one step to the next, and a factor of the layers
// costs as much as one or two iterations, the patches' as much as five.
struct FactorAge {
  // With a factor of the layers two steps old a walk takes no more iterations and a head shake 2 % more; four, 0 % and
  // 35 %. With patches four to six steps old a walk takes 5 % more.
  static constexpr int kLayers = 2, kPatches = 6;
  static constexpr double kRise = 1.2;  // of the iterations since it was fresh

  int oldest;        // solves that it serves at most
  int age = oldest;  // since it was made
  int fresh = 0, last = 0;
  bool serves() const { return age < oldest && last <= kRise * fresh + 1; }
  void forget() { age = oldest; }
  // A solve with the factor (made for it, or kept) took so many iterations.
  void count(bool kept, int iterations) {
    age = kept ? age + 1 : 1;
    if (!kept) fresh = iterations;
    last = iterations;
  }
};

}  // namespace sim

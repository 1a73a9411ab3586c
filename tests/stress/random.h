// splitmix64 (Steele, Lea, Flood 2014): the same numbers on every platform and library.
#pragma once

#include <cmath>
#include <cstdint>
#include <string_view>

#include "sim/mesh/hair_mesh.h"

namespace stress {

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  // One stream per case: the seed of the run and the case's name (FNV-1a).
  Random(std::uint64_t seed, std::string_view name) : state_(seed ^ 0xcbf29ce484222325ull) {
    for (const char c : name) state_ = (state_ ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  }
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(next() >> 11) * 0x1p-53;
  }
  double logarithmic(double low, double high) { return std::exp((*this)(std::log(low), std::log(high))); }
  // 0 .. count - 1.
  int below(int count) { return static_cast<int>(next() % static_cast<std::uint64_t>(count)); }
  bool chance(double share) { return (*this)(0, 1) < share; }
  sim::Vec3 box(double size) {
    const double x = (*this)(-size, size), y = (*this)(-size, size), z = (*this)(-size, size);
    return {x, y, z};
  }
  sim::Vec3 direction() {
    for (;;) {
      const sim::Vec3 v = box(1);
      if (v.norm() > 0.1 && v.norm() < 1) return v.normalized();
    }
  }

 private:
  std::uint64_t state_;
  std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15ull;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }
};

}  // namespace stress

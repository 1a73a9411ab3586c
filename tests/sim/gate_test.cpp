// What the gate calls held: a bound that lets everything through is no bound.
#include "tests/bench/gate.h"

#include <gtest/gtest.h>

#include <limits>

namespace gate_test {

using bench::allHold;
using bench::exitCodeOf;
using bench::Figure;

Figure figure(double value, double bound, bool at_least) {
  return {"a figure", value, bound, at_least, "ms", ""};
}

TEST(Gate, AFigureHoldsOnItsSideOfTheBoundAndAtIt) {
  EXPECT_TRUE(figure(20, 20, true).holds());
  EXPECT_TRUE(figure(21, 20, true).holds());
  EXPECT_FALSE(figure(19.99, 20, true).holds());
  EXPECT_TRUE(figure(0.3, 0.3, false).holds());
  EXPECT_TRUE(figure(0.2, 0.3, false).holds());
  EXPECT_FALSE(figure(0.301, 0.3, false).holds());
}

TEST(Gate, WhatIsNoNumberFallsShort) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const bool at_least : {false, true}) {
    EXPECT_FALSE(figure(nan, 1, at_least).holds());
    EXPECT_FALSE(figure(1, nan, at_least).holds());
  }
  EXPECT_FALSE(figure(infinity, 1, false).holds());
  EXPECT_FALSE(figure(-infinity, 1, true).holds());
}

TEST(Gate, OneFigureThatFallsShortMakesTheExitCodeOne) {
  const Figure held = figure(1, 2, false), at_bound = figure(2, 2, true), missed = figure(3, 2, false),
               no_number = figure(std::numeric_limits<double>::quiet_NaN(), 2, true);
  EXPECT_EQ(exitCodeOf(allHold({held, at_bound})), 0);
  for (const Figure& one : {missed, no_number}) {
    EXPECT_EQ(exitCodeOf(allHold({one, held, at_bound})), 1);
    EXPECT_EQ(exitCodeOf(allHold({held, one, at_bound})), 1);
    EXPECT_EQ(exitCodeOf(allHold({held, at_bound, one})), 1);
  }
}

}  // namespace gate_test

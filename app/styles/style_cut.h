// What makes one built-in style differ from another: where hair is cut, how thick it lies and how it falls.
#pragma once

#include <array>
#include <optional>

namespace app {

// What one style wants. Heights are in head heights above the scalp's centre.
struct Cut {
  double thickness = 0.019;              // m, of the coat at the sides and the back, over its underside
  double front = 0, side = 0, back = 0;  // height of the ends; relative to the shoulders where `from_shoulders`
  bool from_shoulders = false;
  bool divides = false;         // over the shoulders
  double tautness = 0.6;        // how nearly the outer guide hangs straight from the widest part of the head
  double inner_tautness = 0.9;  // how nearly the inner one spans hollows as a taut string would
  double inertia = 0.88;        // share of its heading that hair keeps in kRowStep of falling
  double hug = 0;               // share of its distance from the body that hair loses in kRowStep of falling
  double slant = 0.03;          // m that what is rooted at the hairline ends below what is rooted at the parting
  double sweep = 0;             // m that the front hair falls over the forehead and the temple before its hairline
  std::optional<double> fringe = {};  // height of the ends of the hair over the forehead
};

inline constexpr std::array kCuts{// by Style, but for shaved
                                  Cut{.thickness = 0.017,
                                      .front = -0.20,
                                      .side = -0.25,
                                      .back = -0.40,
                                      .tautness = 0.35,
                                      .slant = 0.020,
                                      .sweep = 0.009},
                                  Cut{.front = 0.05, .side = 0.05, .from_shoulders = true, .sweep = 0.009},
                                  Cut{.thickness = 0.020,
                                      .front = -0.50,
                                      .side = -0.90,
                                      .back = -1.08,
                                      .from_shoulders = true,
                                      .divides = true,
                                      .tautness = 0.8,
                                      .slant = 0.045},
                                  Cut{.thickness = 0.017,
                                      .front = -0.48,
                                      .side = -0.52,
                                      .back = -0.47,
                                      .tautness = 0.2,
                                      .inner_tautness = 0.3,
                                      .hug = 0.03,
                                      .fringe = -0.05},
                                  Cut{.thickness = 0.011,
                                      .front = -0.12,
                                      .side = -0.06,
                                      .back = -0.44,
                                      .tautness = 0,
                                      .inner_tautness = 0,
                                      .inertia = 0.75,
                                      .hug = 0.25,
                                      .slant = 0.035,
                                      .fringe = -0.01}};

}  // namespace app

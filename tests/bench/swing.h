// Whether hair moves as hair does: how fast free hair swings and how soon it stops, and how far it goes on after the
// head has turned.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sim/sim_params.h"
#include "app/styles/hair_styles.h"

namespace bench {

// Of hair that hangs behind a still head, let go from beside its rest.
struct Swing {
  double length = 0;     // m, that hangs free
  double frequency = 0;  // rad/s, over that of a hanging chain of the length, 1.2024 sqrt(g / length)
  double damping = 0;    // ratio, from successive extremes
};

// Of a head that turns by 60 degrees within 0.3 s and stops.
struct FollowThrough {
  double lag = 0;        // rad, by which the tips are behind as the head stops
  double overshoot = 0;  // rad, that they go beyond
  double settling = 0;   // s after the stop until they stay within 2 degrees
};

Swing measureSwing(app::Style style, app::Resolution resolution, const sim::SimParams& params);
FollowThrough measureFollowThrough(app::Style style, app::Resolution resolution, const sim::SimParams& params);

struct SwingOptions {
  std::vector<std::pair<std::string, std::string>> sets;  // name and value of parameters, on top of every preset
};

// Prints a table over the presets of hair; returns false where long natural hair leaves its bounds: frequency 1 to 1.6,
// damping ratio 0.1 to 0.25.
bool runSwing(const SwingOptions& options);

}  // namespace bench

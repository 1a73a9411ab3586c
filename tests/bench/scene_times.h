// Times that all measured scenes share.
#pragma once

namespace bench {

inline constexpr double kFrame = 1.0 / 60;  // s, of the window
inline constexpr double kSettle = 2;        // s of hanging before a scene is measured

}  // namespace bench

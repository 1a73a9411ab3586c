// Faults of a capture that no motion made: dropped frames, pops and jumps.
#pragma once

#include <string>
#include <vector>

#include "app/figure/character.h"

namespace app {

// Mends a clip in place and returns a line for each kind of fault found:
// - dropped frames: up to three that repeat the one before them and are followed by a step that catches up become even
//   steps;
// - pops: a joint that leaves its path for up to three frames and returns, by steps over four times those around them
//   and over 0.15 rad (root joints: or 0.05 m), is put back on it;
// - jumps: the root leaps over the ground and does not return, by a step over four times those around it, over 0.25 m
//   and over 15 m/s; all that follows is carried to where it leapt from.
std::vector<std::string> repairClip(const Skeleton& skeleton, Clip& clip);

}  // namespace app

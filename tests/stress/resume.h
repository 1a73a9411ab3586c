// Cases saved midway and gone on with in another process: a state holds all that outlives a step, so that both end in
// the same bits. Nothing is judged by the way.
#pragma once

#include <cstdint>
#include <string>

#include "tests/stress/stage.h"
#include "tests/stress/stress_case.h"

namespace stress {

// The seed of all cases of a folder: written before they are saved; another one than `seed` throws InputError.
void saveSeed(std::uint64_t seed, const std::string& folder);
void checkSeed(std::uint64_t seed, const std::string& folder);

// Plays the case's motion and some seconds of rest, and writes the hair's state at a moment drawn by the case's name,
// and at the end, into `folder`. Throws InputError when they cannot be written.
void saveMidway(const StressCase& one, std::uint64_t seed, StageStore& stages, const std::string& folder);

// Goes on from there. Returns "" when that ends in the same bits, or what is wrong.
std::string resumeFrom(const std::string& folder, const StressCase& one, std::uint64_t seed, StageStore& stages);

}  // namespace stress

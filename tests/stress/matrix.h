// The pieces of the matrix of cases: one function a family, each adding its cases. The families' axes are issue-like
// sentences in docs/stability.md, written from familyText.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tests/stress/stress_case.h"

namespace stress {

using Cases = std::vector<StressCase>;

// Own clips, then those of the motion capture collection.
std::span<const char* const> ownClips();
std::span<const char* const> capturedClips();
// All of the collection, the paper's figure included.
std::span<const char* const> allCaptures();
// The three styles in low resolution: what most cases run on.
std::span<const HairChoice> lowStyles();

// matrix_time.cpp
void addSteps(Cases& cases);
void addLadder(Cases& cases);
void addPaces(Cases& cases);
void addSpeeds(Cases& cases);
void addScrubs(Cases& cases);
void addStyles(Cases& cases);
void addEndurance(Cases& cases);
void addCaptures(Cases& cases);
// matrix_params.cpp
void addParameters(Cases& cases);
void addStiffness(Cases& cases);
void addPresets(Cases& cases);
void addRandomParameters(std::uint64_t seed, Cases& cases);
void addRedrawnParameters(Cases& cases);
void addPaper(Cases& cases);
// Any value that the parameter may have.
double draw(const sim::ParamField& field, class Random& random);

// Not so of the published step (Solver::kPaper), which random cases therefore leave out: the family `paper` compares it.
bool hasNets(const sim::ParamField& field, double drawn);
// matrix_states.cpp
void addStates(Cases& cases);
void addUpsets(Cases& cases);
void addDistances(Cases& cases);
void addFaults(Cases& cases);
// matrix_mixed.cpp
void addMixed(std::uint64_t seed, Cases& cases);

// "1/60", "0.25": a step or a number in a case's name.
std::string stepName(double step);
std::string plain(double value);

}  // namespace stress

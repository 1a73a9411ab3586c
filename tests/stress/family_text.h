// What a family of cases varies, in words.
#pragma once

#include <span>
#include <string>

#include "tests/stress/stress_case.h"

namespace stress {

// In one sentence, true of the cases given (all of one family): a page may show a part of a family.
std::string familyText(std::span<const StressCase* const> cases);

// The hair meshes that they run on.
std::string hairText(std::span<const StressCase* const> cases);

}  // namespace stress

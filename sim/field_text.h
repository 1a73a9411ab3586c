// Text forms of table fields: exact numbers, switches and choices, and the nearest name to a misspelt one.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace sim {

// Reads the whole of `text` as a finite number in C locale. Returns false otherwise and leaves `value`.
bool parseNumber(std::string_view text, double& value);

// Reads on/off, true/false, yes/no, 1/0.
bool parseSwitch(std::string_view text, bool& value);

// The shortest decimal that reads back as the same double.
std::string numberText(double value);

// The candidate that begins so, else that with the smallest edit distance, or an empty view when none is close enough to be what was meant.
std::string_view nearestName(std::string_view name, std::span<const std::string_view> candidates);

// "did you mean NAME?", or the list of all when nothing is near (of a short list; a long one is only pointed at).
std::string nameHint(std::string_view name, std::span<const std::string_view> candidates);

}  // namespace sim

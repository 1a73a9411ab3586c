// Hairdos that the program comes with: the hair of the first character of a scene in assets/scenes, for any figure.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "app/files/scene_file.h"

namespace app {

inline constexpr std::array<std::string_view, 7> kHairdoNames{
    "bob_fringe", "shoulder_layers", "long_straight", "long_wavy", "curly", "pony_tail", "plaits"};

// The styles and the hairdos.
std::vector<std::string> styleChoices();

// Puts a style on, which leaves the look and ties as they are, or a hairdo with its style, look, ties, maps and curves.
// Resolution, figure and motion stay. Throws InputError where there is none of that name, or its file cannot be read.
void chooseStyle(const std::string& name, CharacterSpec& spec);

}  // namespace app

// What a JSON file is by its keys: a scene, a preset or a project; and where a key belongs that stands in the wrong
// place.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include "app/files/json_reader.h"

namespace app {

enum class JsonKind { kScene, kPreset, kProject };

inline constexpr std::string_view kProjectKey = "hairmesh-project";
inline constexpr std::array<std::string_view, 9> kSceneKeys{"name", "characters", "camera",   "bookmarks", "light",
                                                            "view", "sim",        "playback", "preset"};
inline constexpr std::array<std::string_view, 20> kCharacterKeys{
    "motion",   "parts",   "body",        "clip", "style", "resolution", "hair", "reverse_faces", "fit",  "mends",
    "position", "heading", "clip_offset", "loop", "look",  "pins",       "ties", "attachments",   "maps", "curves"};
inline constexpr std::array<std::string_view, 7> kCameraKeys{"view", "framing", "eye",    "target",
                                                             "fov",  "follow",  "of_head"};
inline constexpr std::array<std::string_view, 6> kPlaybackKeys{"speed",     "fps",         "settle",
                                                               "budget_ms", "deadline_ms", "draw_budget_ms"};
inline constexpr std::string_view kAutosaveKey = "autosave_of";  // of projects that were kept by themselves alone
inline constexpr std::array<std::string_view, 5> kProjectKeys{kProjectKey, "scene", "binary", "checksum", kAutosaveKey};
inline constexpr std::array<std::string_view, 5> kPresetKeys{"name", "sim", "hair", "light", "view"};

// By the keys at its top, misspelt ones too; a file that says nothing is a preset. Throws InputError for what is none
// of the three.
JsonKind jsonKind(const JsonPlace& top);

// Refuses keys at the top of a file that its kind does not have: says where they belong, or what the file is.
void expectTopKeys(const JsonPlace& top, JsonKind kind);

// Refuses keys that an object within a scene or preset does not have: says where in the file they belong.
void expectKeys(const JsonPlace& place, std::span<const std::string_view> known);

}  // namespace app

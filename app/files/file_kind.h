// What a file is that a person named without saying so: on the command line or by dropping it on the window.
#pragma once

#include <string>
#include <string_view>
#include <utility>

namespace app {

enum class FileKind {
  kScene,
  kPreset,
  kMotion,
  kRigidMotion,
  kHairMesh,
  kState,
  kCache,
  kProject,
  kAttachment,
  kEnvironment
};

// By its ending; scenes and presets, both JSON, by their content, and so are saved states, grooms of any name, and what
// glTF and FBX hold: without bones and animation it is a body (app/figure/still_body.h, told as a motion), what looks
// worn (app/figure/attachment.h), or hair. Throws
// InputError for any other file.
FileKind fileKind(const std::string& file);

// Whether a file's first line is that of a recording, see recording.h.
bool isRecording(std::string_view text);

// What a file is that was given to an option for another kind, and what takes it: "is a motion", "give it to --motion".
// Empty for what nothing takes. `of_tool`: said by another program than hairmesh, whose options these are.
std::pair<std::string, std::string> kindAndUse(const std::string& file, bool of_tool = false);

// Throws InputError for a file of another kind than a recording, with what takes it.
void requireRecording(const std::string& file);

// The folder of body parts that ARCSim's data keeps beside a .mot motion.
std::string partsBeside(const std::string& motion_file);

// Throws InputError for a moving hair mesh that this program has exported (.glb).
void refuseOwnExport(std::string_view bytes, const std::string& file);

// Throws InputError: what the file is instead, and what it is good for, as kindAndUse says.
[[noreturn]] void refuseNoHair(const std::string& file, bool of_tool = false);

}  // namespace app

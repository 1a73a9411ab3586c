// Attachments as a scene file has them: hats, glasses, collars; meshes fixed to a joint, drawn and collided with.
//
//   "attachments": [{ "file": "beanie.obj", "joint": "head", "at": [x, y, z], "turn": [x, y, z], "scale": 0.01,
//                     "size": 1.1, "color": [r, g, b], "roughness": 0.8 }]
// The mesh lies in the joint's frame at rest: origin at the joint, x to the figure's left, y up, z forward. "at" (m)
// and "turn" (degrees about x, then y, then z) are added. "scale" is metres per unit of the file; left out, unit and
// origin are inferred where they are certain, and so is z up where no "turn" is given; and a hat that would lie in or
// beside the head is set on it where "at", "turn" and "scale" are left out. "size" makes it so many times as large
// about the joint, once it is placed but for "at". "color" left out is that of the file's material. "joint" is a
// joint's name or a body part's ("head", "neck", "chest"). Every key but the file may be left out.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/files/json_reader.h"
#include "sim/mesh/hair_mesh.h"

namespace app {

struct AttachmentSpec {
  std::string file;
  std::string joint = "head";
  sim::Vec3 at = sim::Vec3::Zero();           // m
  sim::Vec3 turn = sim::Vec3::Zero();         // degrees
  double scale = 0;                           // m per unit; 0: inferred
  double size = 1;                            // times, about the joint
  std::optional<std::array<float, 3>> color;  // linear; none: that of the file's material
  float roughness = 0.8f;
};

inline constexpr std::size_t kMaxAttachments = 8;
inline constexpr double kFarthestAttachment = 3, kMaxAttachmentTurn = 180;  // m, degrees
inline constexpr double kSmallestTimes = 0.1, kLargestTimes = 10;           // of "size"

// Throws InputError.
std::vector<AttachmentSpec> readAttachments(const JsonPlace& place);
nlohmann::json writeAttachments(const std::vector<AttachmentSpec>& attachments);

// The same as text without their colours: equal where they need not be made anew.
std::string wornText(std::vector<AttachmentSpec> attachments);

// From the command line or a panel: none, FILE, FILE@JOINT, or JSON as in a scene. A file's name may have an @: the
// last one leads to a joint where all of the text names no file. Throws InputError.
std::vector<AttachmentSpec> attachmentsFromText(std::string_view text);

}  // namespace app

#include "app/files/attachment_spec.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/files/data_path.h"
#include "app/files/errors.h"

namespace app {

namespace {

using nlohmann::json;

constexpr double kMinUnit = 1e-5, kMaxUnit = 100;  // m per unit

sim::Vec3 vectorFrom(const std::array<double, 3>& values) {
  return {values[0], values[1], values[2]};
}

json jsonFrom(const sim::Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

bool isFile(const std::string& file) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(file, ignored);
}

const char* whatInPlace(const std::string& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) return "is a folder";
  return std::filesystem::exists(file, ignored) ? "is no regular file" : "is not there";
}

[[noreturn]] void refuseFile(const std::string& name, const std::string& file) {
  throw InputError(name.substr(0, 200), "", whatInPlace(file),
                   "name a mesh: OBJ, FBX or glTF; it is looked for in the working folder and in assets/attachments");
}

AttachmentSpec readAttachment(const JsonPlace& place) {
  place.expectObject({"file", "joint", "at", "turn", "scale", "size", "color", "roughness"});
  AttachmentSpec one;
  if (!place.has("file")) place.refuse("names no file", "give \"file\" a mesh: OBJ, FBX or glTF");
  const std::string name = place.at("file").text();
  one.file = findFile(name, place.file(), "attachments");
  if (!isFile(one.file) && place.file().empty()) refuseFile(name, one.file);
  if (!isFile(one.file))
    place.at("file").refuse(
        "names '" + name.substr(0, 200) + "', which " + whatInPlace(one.file),
        "name a mesh: OBJ, FBX or glTF; it is looked for beside the scene and in assets/attachments");
  if (place.has("joint")) one.joint = place.at("joint").text();
  if (place.has("at")) one.at = vectorFrom(place.at("at").vector(-kFarthestAttachment, kFarthestAttachment));
  if (place.has("turn")) one.turn = vectorFrom(place.at("turn").vector(-kMaxAttachmentTurn, kMaxAttachmentTurn));
  if (place.has("scale")) one.scale = place.at("scale").number(kMinUnit, kMaxUnit);
  if (place.has("size")) one.size = place.at("size").number(kSmallestTimes, kLargestTimes);
  if (place.has("color")) {
    const std::array<double, 3> color = place.at("color").vector(0, 1);
    one.color = {static_cast<float>(color[0]), static_cast<float>(color[1]), static_cast<float>(color[2])};
  }
  if (place.has("roughness")) one.roughness = static_cast<float>(place.at("roughness").number(0.05, 1));
  return one;
}

// FILE, or FILE@JOINT where all of the text names no file.
AttachmentSpec fileAtJoint(const std::string& text) {
  AttachmentSpec one;
  one.file = findFile(text, "", "attachments");
  const std::size_t at = text.rfind('@');
  if (isFile(one.file) || at == std::string::npos) {
    if (!isFile(one.file)) refuseFile(text, one.file);
    return one;
  }
  one.file = findFile(text.substr(0, at), "", "attachments");
  one.joint = text.substr(at + 1);
  if (!isFile(one.file)) refuseFile(text.substr(0, at), one.file);
  if (one.joint.empty())
    throw InputError("", "'" + text.substr(0, 200) + "'", "names no joint after its @", "write FILE@JOINT, or FILE");
  return one;
}

}  // namespace

std::vector<AttachmentSpec> readAttachments(const JsonPlace& place) {
  std::vector<AttachmentSpec> attachments;
  const std::size_t count = place.arraySize(kMaxAttachments);
  for (std::size_t i = 0; i < count; ++i) attachments.push_back(readAttachment(place.at(i)));
  return attachments;
}

json writeAttachments(const std::vector<AttachmentSpec>& attachments) {
  json all = json::array();
  for (const AttachmentSpec& one : attachments) {
    json written = {{"file", one.file}, {"joint", one.joint}, {"roughness", one.roughness}};
    if (one.color) written["color"] = *one.color;
    if (one.at != sim::Vec3::Zero()) written["at"] = jsonFrom(one.at);
    if (one.turn != sim::Vec3::Zero()) written["turn"] = jsonFrom(one.turn);
    if (one.scale > 0) written["scale"] = one.scale;
    if (one.size != 1) written["size"] = one.size;
    all.push_back(std::move(written));
  }
  return all;
}

std::string wornText(std::vector<AttachmentSpec> attachments) {
  for (AttachmentSpec& one : attachments) one.color = {}, one.roughness = 0;
  return writeAttachments(attachments).dump();
}

std::vector<AttachmentSpec> attachmentsFromText(std::string_view text) {
  if (text == "none") return {};
  if (text.empty()) throw InputError("", "''", "names nothing to wear", "write FILE@JOINT, or none");
  if (!text.starts_with("[") && !text.starts_with("{")) return {fileAtJoint(std::string(text))};
  const json given = parseJson(text, "");
  const JsonPlace place(given, "");
  return given.is_object() ? std::vector{readAttachment(place)} : readAttachments(place);
}

}  // namespace app

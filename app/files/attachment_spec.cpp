#include "app/files/attachment_spec.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/files/data_path.h"
#include "app/files/errors.h"

namespace app {

namespace {

using nlohmann::json;

constexpr double kFarthestPlace = 3, kMaxTurn = 180;  // m, degrees
constexpr double kMinUnit = 1e-5, kMaxUnit = 100;     // m per unit

sim::Vec3 vectorFrom(const std::array<double, 3>& values) {
  return {values[0], values[1], values[2]};
}

json jsonFrom(const sim::Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

AttachmentSpec readAttachment(const JsonPlace& place) {
  place.expectObject({"file", "joint", "at", "turn", "scale", "color", "roughness"});
  AttachmentSpec one;
  if (!place.has("file")) place.refuse("names no file", "give \"file\" a mesh: OBJ, FBX or glTF");
  const std::string name = place.at("file").text();
  one.file = findFile(name, place.file(), "attachments");
  std::error_code ignored;
  if (std::filesystem::is_directory(one.file, ignored))
    place.at("file").refuse("names '" + name.substr(0, 200) + "', which is a folder", "name a mesh: OBJ, FBX or glTF");
  if (!std::filesystem::is_regular_file(one.file, ignored))
    place.at("file").refuse("names '" + name.substr(0, 200) + "', which is not there",
                            "check the path; it is looked for beside the scene and in assets/attachments");
  if (place.has("joint")) one.joint = place.at("joint").text();
  if (place.has("at")) one.at = vectorFrom(place.at("at").vector(-kFarthestPlace, kFarthestPlace));
  if (place.has("turn")) one.turn = vectorFrom(place.at("turn").vector(-kMaxTurn, kMaxTurn));
  if (place.has("scale")) one.scale = place.at("scale").number(kMinUnit, kMaxUnit);
  if (place.has("color")) {
    const std::array<double, 3> color = place.at("color").vector(0, 1);
    for (std::size_t k = 0; k < 3; ++k) one.color[k] = static_cast<float>(color[k]);
  }
  if (place.has("roughness")) one.roughness = static_cast<float>(place.at("roughness").number(0.05, 1));
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
    json written = {{"file", one.file}, {"joint", one.joint}, {"color", one.color}, {"roughness", one.roughness}};
    if (one.at != sim::Vec3::Zero()) written["at"] = jsonFrom(one.at);
    if (one.turn != sim::Vec3::Zero()) written["turn"] = jsonFrom(one.turn);
    if (one.scale > 0) written["scale"] = one.scale;
    all.push_back(std::move(written));
  }
  return all;
}

std::string wornText(std::vector<AttachmentSpec> attachments) {
  for (AttachmentSpec& one : attachments) one.color = {}, one.roughness = 0;
  return writeAttachments(attachments).dump();
}

std::vector<AttachmentSpec> attachmentsFromText(std::string_view text) {
  if (text == "none" || text.empty()) return {};
  json given;
  if (text.starts_with("[") || text.starts_with("{")) {
    given = parseJson(text, "--attach");
  } else {
    const std::size_t at = text.rfind('@');
    given = {{"file", text.substr(0, at)}};
    if (at != std::string_view::npos) given["joint"] = text.substr(at + 1);
  }
  if (given.is_object()) given = json::array({given});
  return readAttachments(JsonPlace(given, "--attach"));
}

}  // namespace app

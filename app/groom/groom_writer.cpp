#include "app/groom/groom_writer.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>

#include "app/files/errors.h"
#include "app/files/file_ending.h"
#include "app/groom/formats/hair_strands_file.h"
#include "app/groom/formats/ply_file.h"
#include "app/groom/formats/tfx_file.h"
#include "app/groom/groom_file.h"

namespace app {

namespace {

void writeFrame(const Groom& groom, const std::string& file, const std::string& mark) {
  OutputFile output(file);
  const std::string ending = endingOf(file);
  if (ending == ".hair") writeHairStrands(groom, file, output, mark);
  if (ending == ".ply") writePlyStrands(groom, false, output, mark);
  if (ending == ".tfx") writeTfx(groom, file, output, mark);
  output.commit();
}

}  // namespace

bool takesClip(const std::string& file) {
  const std::string ending = endingOf(file);
  return ending == ".abc" || ending == ".usda" || ending == ".glb";
}

bool isGroomOutput(const std::string& file) {
  constexpr std::array<std::string_view, 5> kEndings{".abc", ".usda", ".hair", ".ply", ".tfx"};
  return std::ranges::find(kEndings, endingOf(file)) != kEndings.end();
}

std::string numberedName(const std::string& file, long frame) {
  std::array<char, 24> number;
  std::snprintf(number.data(), number.size(), "_%04ld", frame);
  const std::filesystem::path path(file);
  return (path.parent_path() / (path.stem().string() + number.data() + path.extension().string())).string();
}

GroomWriter::GroomWriter(const std::string& file, const ClipSettings& settings, bool numbered)
    : file_(file),
      numbered_(numbered),
      mark_(settings.world_heads > 0 ? worldMark(settings.world_heads, settings.meters_per_unit) : "") {
  const std::string ending = endingOf(file);
  if (!isGroomOutput(file))
    throw OutputError(file, "is no kind of groom that is written", "name it .abc, .usda, .hair, .ply or .tfx");
  if (ending == ".abc") {
    clip_.emplace<AlembicWriter>(file, settings);
  } else if (ending == ".usda") {
    clip_.emplace<UsdaWriter>(file, settings);
  } else {
    checkWritable(numbered ? numberedName(file, 0) : file);
  }
}

void GroomWriter::add(const Groom& groom, long frame) {
  if (auto* alembic = std::get_if<AlembicWriter>(&clip_)) {
    alembic->add(groom);
  } else if (auto* usda = std::get_if<UsdaWriter>(&clip_)) {
    usda->add(groom);
  } else {
    writeFrame(groom, numbered_ ? numberedName(file_, frame) : file_, mark_);
  }
}

void GroomWriter::finish() {
  if (auto* alembic = std::get_if<AlembicWriter>(&clip_)) alembic->finish();
  if (auto* usda = std::get_if<UsdaWriter>(&clip_)) usda->finish();
}

void writeGroom(const Groom& groom, const std::string& file) {
  GroomWriter writer(file, {}, false);
  writer.add(groom, 0);
  writer.finish();
}

}  // namespace app

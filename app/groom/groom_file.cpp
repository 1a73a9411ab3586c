#include "app/groom/groom_file.h"

#include <algorithm>
#include <array>

#include "app/files/errors.h"
#include "app/files/file_ending.h"
#include "app/files/text_file.h"
#include "app/groom/formats/alembic_file.h"
#include "app/groom/formats/groom_bytes.h"
#include "app/groom/formats/hair_strands_file.h"
#include "app/groom/formats/ply_file.h"
#include "app/groom/formats/tfx_file.h"
#include "app/groom/formats/usda_file.h"
#include "sim/field_text.h"

namespace app {

namespace {

constexpr std::string_view kWorldMark = "hairmesh world of ", kAxes = " heads, y up, unit ";
constexpr std::size_t kMarkWithin = 4096;  // bytes of the file's beginning or end

constexpr std::string_view kHdf5("\x89HDF\r\n\x1a\n", 8), kUsdCrate = "PXR-USDC", kZip("PK\x03\x04", 4);

void refuseKnown(std::string_view bytes, const std::string& file) {
  if (bytes.starts_with(kHdf5)) {
    throw InputError(file, "", "is Alembic in its old HDF5 flavour, or other HDF5, which is not read",
                     "export Alembic as Ogawa, the default since 2013");
  }
  if (bytes.starts_with(kUsdCrate) || bytes.starts_with(kZip)) {
    throw InputError(file, "", "is binary or packed USD (.usdc, .usdz), which is not read",
                     "write it as text: usdcat FILE -o FILE.usda");
  }
}

}  // namespace

std::optional<GroomFormat> groomFormat(std::string_view bytes, const std::string& file) {
  if (bytes.starts_with("HAIR")) return GroomFormat::kHair;
  if (bytes.starts_with("Ogawa")) return GroomFormat::kAlembic;
  if (withoutByteOrderMark(bytes).starts_with("#usda")) return GroomFormat::kUsda;
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return GroomFormat::kPly;
  refuseKnown(bytes, file);
  // The only format without a mark of its own: what is called so is, and its reader says what is wrong with it.
  if (looksLikeTfx(bytes) || endingOf(file) == ".tfx") return GroomFormat::kTfx;
  return std::nullopt;
}

std::string beginningOfGroom(const std::string& file) {
  const std::string ending = endingOf(file);
  constexpr std::array<std::array<std::string_view, 2>, 8> kEndings{{{".hair", "HAIR"},
                                                                     {".abc", "Ogawa"},
                                                                     {".usda", "#usda"},
                                                                     {".usd", "#usda"},
                                                                     {".usdc", "PXR-USDC"},
                                                                     {".usdz", "PK"},
                                                                     {".tfx", "a header of TressFX"},
                                                                     {".ply", "ply"}}};
  const auto* const found = std::ranges::find(kEndings, ending, [](const auto& row) { return row[0]; });
  return found == kEndings.end() ? "" : std::string((*found)[1]);
}

bool hasGroomEnding(const std::string& file) {
  return !beginningOfGroom(file).empty();
}

void refuseOtherBeginning(const std::string& file) {
  const std::string beginning = beginningOfGroom(file);
  if (!beginning.empty())
    throw InputError(file, "", "does not begin with " + beginning + ", as its name says",
                     "write it again, or give it the ending of what it is");
}

Groom readGroom(std::string_view bytes, const std::string& file, GroomHints* hints) {
  const std::optional<GroomFormat> format = groomFormat(bytes, file);
  if (!format) {
    refuseOtherBeginning(file);
    throw InputError(file, "", "is no kind of groom that is read", "give strands as .hair, .abc, .usda, .tfx or .ply");
  }
  if (hints) readWorldMark(bytes, *hints);
  switch (*format) {
    case GroomFormat::kHair:
      return readHairStrands(bytes, file);
    case GroomFormat::kAlembic:
      return readAlembic(bytes, file);
    case GroomFormat::kUsda:
      return readUsda(bytes, file, 0, hints);
    case GroomFormat::kPly:
      return readPlyStrands(bytes, file);
    case GroomFormat::kTfx:
      return readTfx(bytes, file);
  }
  return {};
}

Groom readGroom(const std::string& file, GroomHints* hints) {
  return readGroom(readText(file, kMaxGroomFile), file, hints);
}

std::string worldMark(int heads, double meters_per_unit) {
  return std::string(kWorldMark).append(std::to_string(heads)).append(kAxes) + sim::numberText(meters_per_unit) + " m";
}

void readWorldMark(std::string_view bytes, GroomHints& hints) {
  for (const std::string_view part :
       {bytes.substr(0, kMarkWithin), bytes.substr(bytes.size() - std::min(bytes.size(), kMarkWithin))}) {
    const std::size_t at = part.find(kWorldMark);
    if (at == std::string_view::npos) continue;
    const std::string_view rest = part.substr(at + kWorldMark.size());
    const std::size_t axes = rest.find(kAxes);
    if (axes == std::string_view::npos) continue;
    const std::string_view last = rest.substr(axes + kAxes.size());
    double unit = 0, heads = 0;
    if (!sim::parseNumber(rest.substr(0, axes), heads) || !(heads >= 1 && heads <= 1e6)) continue;
    if (!sim::parseNumber(last.substr(0, last.find(' ')), unit) || !(unit > 0)) continue;
    hints.world_heads = static_cast<int>(heads);
    hints.meters_per_unit = unit;
    hints.up = 'Y';
    return;
  }
}

}  // namespace app

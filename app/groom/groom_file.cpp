#include "app/groom/groom_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

#include "app/files/errors.h"
#include "app/files/text_file.h"
#include "app/groom/alembic_file.h"
#include "app/groom/groom_bytes.h"
#include "app/groom/hair_strands_file.h"
#include "app/groom/ply_file.h"
#include "app/groom/tfx_file.h"
#include "app/groom/usda_file.h"

namespace app {

namespace {

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
  if (bytes.starts_with("#usda")) return GroomFormat::kUsda;
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return GroomFormat::kPly;
  refuseKnown(bytes, file);
  if (looksLikeTfx(bytes)) return GroomFormat::kTfx;
  return std::nullopt;
}

bool hasGroomEnding(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  constexpr std::array<std::string_view, 8> kEndings{".hair", ".abc",  ".usda", ".usd",
                                                     ".usdc", ".usdz", ".tfx",  ".ply"};
  return std::ranges::find(kEndings, ending) != kEndings.end();
}

Groom readGroom(std::string_view bytes, const std::string& file, GroomHints* hints) {
  const std::optional<GroomFormat> format = groomFormat(bytes, file);
  if (!format) {
    throw InputError(
        file, "", "is no kind of groom that is read",
        "give strands as .hair, .abc, .usda, .tfx or .ply; strips, cards and tubes are read by hairmesh-convert");
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

}  // namespace app

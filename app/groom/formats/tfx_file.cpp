#include "app/groom/formats/tfx_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "app/files/errors.h"
#include "app/files/median.h"
#include "app/groom/formats/groom_bytes.h"

namespace app {

namespace {

struct TfxHeader {
  float version = 4;
  std::uint32_t strands = 0, points = 0;                                                // points a strand
  std::uint32_t positions = 0, root_uvs = 0, point_uvs = 0, thickness = 0, colors = 0;  // offsets, bytes
  std::array<std::uint32_t, 32> reserved{};
};
static_assert(sizeof(TfxHeader) == 160);

constexpr std::uint32_t kMinPoints = 4, kMaxPoints = 64;

struct Float4 {
  float x, y, z, w;
};

std::string_view zeros(std::size_t bytes) {
  return std::string_view("\0\0\0\0\0\0\0", bytes);
}

}  // namespace

bool isTfxPoints(std::size_t points) {
  return points >= kMinPoints && points <= kMaxPoints && std::has_single_bit(points);
}

namespace {

void checkCounts(const Groom& groom, std::size_t points, const std::string& file) {
  for (std::size_t s = 0; s < groom.strandCount(); ++s) {
    if (groom.pointCount(s) == points) continue;
    throw OutputError(file,
                      "strand " + std::to_string(s) + " has " + std::to_string(groom.pointCount(s)) +
                          " points and the first has " + std::to_string(points) + "; a .tfx file has one number",
                      "export with one number of points, --export-points 16");
  }
  if (isTfxPoints(points)) return;
  throw OutputError(file, "strands of " + std::to_string(points) + " points; a .tfx file holds 4, 8, 16, 32 or 64",
                    "export with such a number, --export-points 16");
}

}  // namespace

bool looksLikeTfx(std::string_view bytes) {
  if (bytes.size() < sizeof(TfxHeader)) return false;
  ByteReader reader{bytes, ""};
  const auto header = reader.number<TfxHeader>("");
  return header.version >= 1 && header.version < 10 && header.points >= 2 && header.points <= 4096 &&
         header.strands > 0 && header.positions >= sizeof(TfxHeader) && header.positions < bytes.size();
}

Groom readTfx(std::string_view bytes, const std::string& file) {
  ByteReader reader{bytes, file};
  const auto header = reader.number<TfxHeader>("the 160 bytes of the header");
  const std::uint64_t points = std::uint64_t{header.strands} * header.points;
  if (!(header.version >= 1 && header.version < 10))
    reader.fail("the header gives no version of TressFX, 1 to 9", "give a .tfx file");
  if (header.points == 0) reader.fail("the header gives strands of no points", "export the file again");
  checkGroomSize(file, "header", header.strands, points);
  Groom groom;
  reader.seek(header.positions, "positions");
  reader.need(points, sizeof(Float4), "positions");
  for (std::uint64_t p = 0; p < points; ++p) {
    const auto position = reader.number<Float4>("positions");
    groom.points.emplace_back(position.x, position.y, position.z);
    if ((p + 1) % header.points == 0) groom.strand_first.push_back(static_cast<std::uint32_t>(p + 1));
  }
  if (header.root_uvs != 0) {
    reader.seek(header.root_uvs, "root UVs");
    reader.array(header.strands, "root UVs", groom.root_uvs);
  }
  if (header.thickness != 0) {
    reader.seek(header.thickness, "thickness of the strands");
    reader.need(header.strands, sizeof(float), "thickness of the strands");
    for (std::uint32_t s = 0; s < header.strands; ++s)
      groom.widths.insert(groom.widths.end(), header.points, reader.number<float>("thickness of the strands"));
  }
  if (header.colors == 0) return groom;
  reader.seek(header.colors, "colours of the points");
  reader.need(points, sizeof(Float4), "colours of the points");
  for (std::uint64_t p = 0; p < points; ++p) {
    const auto color = reader.number<Float4>("colours of the points");
    groom.colors.emplace_back(color.x, color.y, color.z);
  }
  return groom;
}

int nearestTfxPoints(const Groom& groom) {
  std::vector<std::size_t> counts;
  for (std::size_t s = 0; s < groom.strandCount(); ++s) counts.push_back(groom.pointCount(s));
  if (counts.empty()) return static_cast<int>(kMinPoints);
  const double power = std::round(std::log2(static_cast<double>(std::max<std::size_t>(median(std::move(counts)), 1))));
  return std::clamp(1 << static_cast<int>(std::min(power, 6.0)), static_cast<int>(kMinPoints),
                    static_cast<int>(kMaxPoints));
}

void writeTfx(const Groom& groom, const std::string& file, OutputFile& output, std::string_view text) {
  const std::size_t points = groom.strandCount() > 0 ? groom.pointCount(0) : kMinPoints;
  checkCounts(groom, points, file);
  TfxHeader header;
  header.strands = static_cast<std::uint32_t>(groom.strandCount());
  header.points = static_cast<std::uint32_t>(points);
  std::uint64_t end = sizeof(TfxHeader);
  const auto place = [&end](std::uint32_t& offset, bool has, std::uint64_t bytes) {
    if (!has) return;
    offset = static_cast<std::uint32_t>(end);
    end += (bytes + 7) / 8 * 8;
  };
  place(header.positions, true, groom.points.size() * sizeof(Float4));
  place(header.root_uvs, !groom.root_uvs.empty(), groom.strandCount() * sizeof(Eigen::Vector2f));
  place(header.thickness, !groom.widths.empty(), groom.strandCount() * sizeof(float));
  place(header.colors, !groom.colors.empty(), groom.points.size() * sizeof(Float4));
  if (end > UINT32_MAX) throw OutputError(file, "a .tfx file ends at 4 GB", "export fewer strands");
  std::memcpy(header.reserved.data(), text.data(), std::min(text.size(), sizeof header.reserved));
  output.write(bytesOf(header));
  for (const Eigen::Vector3f& p : groom.points) output.write(bytesOf(Float4{p.x(), p.y(), p.z(), 1}));
  output.write(bytesOf(groom.root_uvs));
  if (!groom.widths.empty()) {
    for (std::size_t s = 0; s < groom.strandCount(); ++s) output.write(bytesOf(groom.widths[groom.strand_first[s]]));
    output.write(zeros(groom.strandCount() % 2 * sizeof(float)));
  }
  for (const Eigen::Vector3f& c : groom.colors) output.write(bytesOf(Float4{c.x(), c.y(), c.z(), 1}));
}

}  // namespace app

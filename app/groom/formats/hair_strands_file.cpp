#include "app/groom/formats/hair_strands_file.h"

#include <array>

#include "app/files/errors.h"
#include "app/groom/formats/groom_bytes.h"

namespace app {

namespace {

constexpr std::uint32_t kSegments = 1, kPoints = 2, kThickness = 4, kTransparency = 8, kColors = 16;  // flags

struct HairHeader {
  std::array<char, 4> magic{'H', 'A', 'I', 'R'};
  std::uint32_t strands = 0, points = 0, flags = 0;
  std::uint32_t segments = 0;  // of every strand, where there is no array
  float thickness = 0, transparency = 0;
  std::array<float, 3> color{1, 1, 1};
  std::array<char, 88> text{};
};
static_assert(sizeof(HairHeader) == 128);

constexpr std::size_t kMaxSegments = 65535;

// First point of every strand. The segments of all strands must come to the header's points.
void readSegments(const HairHeader& header, ByteReader& reader, Groom& groom) {
  std::vector<std::uint16_t> segments;
  if (header.flags & kSegments) reader.array(header.strands, "segments of the strands", segments);
  groom.strand_first.reserve(header.strands + std::size_t{1});
  std::uint64_t first = 0;
  for (std::uint32_t s = 0; s < header.strands; ++s) {
    first += (segments.empty() ? header.segments : segments[s]) + std::uint64_t{1};
    if (first > header.points) break;
    groom.strand_first.push_back(static_cast<std::uint32_t>(first));
  }
  if (first == header.points) return;
  reader.fail("strands of the header's segments have " + std::string(first > header.points ? "more" : "fewer") +
                  " points than the " + std::to_string(header.points) + " that the header counts",
              "the file is damaged; export it again");
}

void readArrays(const HairHeader& header, ByteReader& reader, Groom& groom) {
  reader.array(header.points, "points", groom.points);
  if (header.flags & kThickness) {
    reader.array(header.points, "thickness of the points", groom.widths);
  } else if (header.thickness != 0) {
    groom.widths.assign(header.points, header.thickness);
  }
  if (header.flags & kTransparency) {
    reader.need(header.points, sizeof(float), "transparency of the points");
    reader.at += header.points * sizeof(float);
  }
  const Eigen::Vector3f color(header.color[0], header.color[1], header.color[2]);
  if (header.flags & kColors) {
    reader.array(header.points, "colours of the points", groom.colors);
  } else if (color != Eigen::Vector3f::Ones()) {
    groom.colors.assign(header.points, color);
  }
}

// Bytes that header and arrays take.
std::size_t sizeOfFile(const HairHeader& header) {
  const std::size_t point = sizeof(Eigen::Vector3f) + (header.flags & kThickness ? sizeof(float) : 0) +
                            (header.flags & kTransparency ? sizeof(float) : 0) +
                            (header.flags & kColors ? sizeof(Eigen::Vector3f) : 0);
  const std::size_t segments = header.flags & kSegments ? header.strands * sizeof(std::uint16_t) : 0;
  return sizeof header + segments + header.points * point;
}

std::vector<std::uint16_t> segmentsOf(const Groom& groom, const std::string& file) {
  std::vector<std::uint16_t> segments(groom.strandCount());
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const std::size_t points = groom.pointCount(s);
    if (points == 0 || points > kMaxSegments + 1) {
      throw OutputError(file,
                        "strand " + std::to_string(s) + " has " + std::to_string(points) +
                            " points; a .hair file holds 1 to 65536 a strand",
                        points == 0 ? "leave such strands out" : "write fewer points a strand, or another format");
    }
    segments[s] = static_cast<std::uint16_t>(points - 1);
  }
  return segments;
}

}  // namespace

Groom readHairStrands(std::string_view bytes, const std::string& file) {
  ByteReader reader{bytes, file};
  const auto header = reader.number<HairHeader>("the 128 bytes of the header");
  if (header.magic != HairHeader().magic) {
    reader.at = 0;
    reader.fail("the file does not begin with 'HAIR'", "give a .hair file of strands");
  }
  if (!(header.flags & kPoints)) {
    reader.at = 12;
    reader.fail("the header's flags say that there are no points", "export the hair with its points");
  }
  if (header.strands > header.points) {  // every strand has a point
    reader.at = 4;
    reader.fail("the header counts " + std::to_string(header.strands) + " strands but only " +
                    std::to_string(header.points) + " points",
                "the file is damaged; export it again");
  }
  checkGroomSize(file, "header", header.strands, header.points);
  // What was put in before the end shifts all that follows. Nothing in the arrays tells where.
  if (const std::size_t size = sizeOfFile(header); bytes.size() > size) {
    reader.at = size;
    reader.fail("the file goes on for " + std::to_string(bytes.size() - size) +
                    " bytes after what its header counts, so that its arrays may be shifted",
                "the file is damaged, as by a transfer as text; export or copy it again");
  }
  // Before anything is sized by what the header counts.
  const std::size_t segments = header.flags & kSegments ? header.strands * sizeof(std::uint16_t) : 0;
  reader.need(segments + header.points * sizeof(Eigen::Vector3f), 1, "segments and points of the strands");
  Groom groom;
  readSegments(header, reader, groom);
  readArrays(header, reader, groom);
  return groom;
}

void writeHairStrands(const Groom& groom, const std::string& file, OutputFile& output, std::string_view text) {
  const std::vector<std::uint16_t> segments = segmentsOf(groom, file);
  HairHeader header;
  header.strands = static_cast<std::uint32_t>(groom.strandCount());
  header.points = static_cast<std::uint32_t>(groom.points.size());
  header.flags = kSegments | kPoints | (groom.widths.empty() ? 0u : kThickness) | (groom.colors.empty() ? 0u : kColors);
  (text.empty() ? "hairmesh" : text).copy(header.text.data(), header.text.size() - 1);
  output.write(bytesOf(header));
  output.write(bytesOf(segments));
  output.write(bytesOf(groom.points));
  output.write(bytesOf(groom.widths));
  output.write(bytesOf(groom.colors));
}

}  // namespace app

#include "app/groom/formats/ply_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "app/files/errors.h"
#include "app/groom/formats/groom_arrays.h"
#include "app/groom/formats/groom_bytes.h"
#include "app/groom/formats/ply_rows.h"

namespace app {

namespace {

bool isAny(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::ranges::find(names, name) != names.end();
}

// What a file tells about its strands, in the order of the vertices.
struct Told {
  Groom groom;  // its points, and arrays of strands where there is an element of strands
  std::vector<std::uint32_t> counts, lists, strand_of;  // points a strand; vertices of all lists; strand of each vertex
  std::vector<std::uint8_t> linked;                     // per vertex: there is an edge from the one before it
  bool has_counts = false, has_lists = false, has_edges = false;
};

// Where a vertex's number goes: 0-2 position, 3 width, 4-6 colour, 7 strand; -1: nowhere.
struct Target {
  int slot = -1;
  double scale = 1;
};

Target vertexTarget(const PlyProperty& property) {
  constexpr std::array<std::string_view, 3> kPosition{"x", "y", "z"}, kColor{"red", "green", "blue"};
  if (property.count_type >= 0) return {};
  const auto position = std::ranges::find(kPosition, property.name) - kPosition.begin();
  if (position < 3) return {static_cast<int>(position), 1};
  const auto color = std::ranges::find(kColor, property.name) - kColor.begin();
  if (color < 3) return {4 + static_cast<int>(color), PlyRows::isByte(property.type) ? 1.0 / 255 : 1};
  if (isAny(property.name, {"width", "thickness", "diameter"})) return {3, 1};
  if (isAny(property.name, {"radius", "pscale"})) return {3, 2};
  return {isAny(property.name, {"strand", "strand_id", "strand_index"}) ? 7 : -1, 1};
}

void skip(const PlyProperty& property, PlyRows& rows) {
  const std::size_t count = property.count_type < 0 ? 1 : rows.whole(property.count_type);
  for (std::size_t n = 0; n < count; ++n) rows.number(property.type);
}

void readVertices(const PlyElement& element, PlyRows& rows, Told& told) {
  checkGroomSize(rows.file(), "element vertex", element.count, element.count);
  std::vector<Target> targets;
  std::array<bool, 8> has{};
  for (const PlyProperty& property : element.properties) {
    targets.push_back(vertexTarget(property));
    if (targets.back().slot >= 0) has[static_cast<std::size_t>(targets.back().slot)] = true;
  }
  if (!has[0] || !has[1] || !has[2]) rows.fail("vertices lack x, y or z", "export the points with their positions");
  const bool colored = has[4] && has[5] && has[6];
  for (std::size_t row = 0; row < element.count; ++row) {
    std::array<double, 8> values{};
    for (std::size_t n = 0; n < targets.size(); ++n) {
      if (targets[n].slot < 0) {
        skip(element.properties[n], rows);
      } else {
        values[static_cast<std::size_t>(targets[n].slot)] = targets[n].scale * rows.number(element.properties[n].type);
      }
    }
    const auto single = [&values](std::size_t n) { return static_cast<float>(values[n]); };
    told.groom.points.emplace_back(single(0), single(1), single(2));
    if (has[3]) told.groom.widths.push_back(single(3));
    if (colored) told.groom.colors.emplace_back(single(4), single(5), single(6));
    if (!has[7]) continue;
    const bool whole = values[7] >= 0 && values[7] <= std::numeric_limits<std::uint32_t>::max();
    told.strand_of.push_back(whole ? static_cast<std::uint32_t>(values[7]) : 0);
  }
}

std::int32_t wholeOf(double value) {
  return std::abs(value) <= std::numeric_limits<std::int32_t>::max() ? static_cast<std::int32_t>(value) : 0;
}

void readStrandNumber(const PlyProperty& property, std::size_t row, PlyRows& rows, Told& told) {
  Groom& groom = told.groom;
  if (isAny(property.name, {"points", "point_count", "vertex_count", "num_points"})) {
    told.counts.push_back(static_cast<std::uint32_t>(rows.whole(property.type)));
    told.has_counts = true;
    return;
  }
  const double value = rows.number(property.type);
  const auto part = [&](int axis) {
    Eigen::Vector2f uv = row < groom.root_uvs.size() ? groom.root_uvs[row] : Eigen::Vector2f(Eigen::Vector2f::Zero());
    uv[axis] = static_cast<float>(value);
    putAt<Eigen::Vector2f>(groom.root_uvs, row, uv, Eigen::Vector2f::Zero());
  };
  if (property.name == "root_u") part(0);
  if (property.name == "root_v") part(1);
  if (property.name == "id") putAt(groom.ids, row, wholeOf(value), -1);
  if (property.name == "group") putAt(groom.groups, row, wholeOf(value), 0);
  if (property.name == "guide") putAt<std::uint8_t>(groom.guides, row, value != 0, 0);
}

void readStrandRows(const PlyElement& element, PlyRows& rows, Told& told) {
  checkGroomSize(rows.file(), "element " + element.name, element.count, told.groom.points.size());
  for (std::size_t row = 0; row < element.count; ++row) {
    for (const PlyProperty& property : element.properties) {
      if (property.count_type < 0) {
        readStrandNumber(property, row, rows, told);
        continue;
      }
      const std::size_t count = rows.whole(property.count_type);
      for (std::size_t n = 0; n < count; ++n) {
        const std::size_t vertex = rows.whole(property.type);
        if (vertex >= told.groom.points.size()) rows.fail("a strand names a vertex beyond the last", "export it again");
        if (told.lists.size() >= kMaxGroomPoints) checkGroomSize(rows.file(), "lists", row, told.lists.size() + 1);
        told.lists.push_back(static_cast<std::uint32_t>(vertex));
      }
      told.counts.push_back(static_cast<std::uint32_t>(count));
      told.has_lists = true;
    }
  }
}

void readEdges(const PlyElement& element, PlyRows& rows, Told& told) {
  told.has_edges = true;
  told.linked.assign(told.groom.points.size(), 0);
  for (std::size_t row = 0; row < element.count; ++row) {
    std::array<std::size_t, 2> ends{};
    for (const PlyProperty& property : element.properties) {
      if (property.name != "vertex1" && property.name != "vertex2") {
        skip(property, rows);
        continue;
      }
      ends[property.name == "vertex2"] = rows.whole(property.type);
    }
    const auto [low, high] = std::minmax(ends[0], ends[1]);
    if (high >= told.linked.size() || high != low + 1) {
      rows.fail("edge " + std::to_string(row) + " joins vertices " + std::to_string(low) + " and " +
                    std::to_string(high) + ", which do not follow one another",
                "write the vertices strand by strand, root to tip");
    }
    told.linked[high] = 1;
  }
}

// Copies the vertices of the lists, so that the points lie strand by strand.
void unfoldLists(Told& told) {
  const auto unfold = [&told](auto& all) {
    if (all.empty()) return;
    std::remove_reference_t<decltype(all)> unfolded;
    unfolded.reserve(told.lists.size());
    for (const std::uint32_t vertex : told.lists) unfolded.push_back(all[vertex]);
    all = std::move(unfolded);
  };
  unfold(told.groom.widths);
  unfold(told.groom.colors);
  unfold(told.groom.points);
}

void dealCounts(const PlyRows& rows, Told& told) {
  std::uint64_t first = 0;
  for (const std::uint32_t count : told.counts) {
    first += count;
    if (first > told.groom.points.size()) break;
    told.groom.strand_first.push_back(static_cast<std::uint32_t>(first));
  }
  if (first != told.groom.points.size())
    rows.fail("the strands' numbers of points do not come to the number of vertices", "export it again");
}

void dealStrands(const PlyRows& rows, Told& told) {
  if (told.has_counts || told.has_lists) {
    if (told.has_lists) unfoldLists(told);
    return dealCounts(rows, told);
  }
  if (!told.has_edges && told.strand_of.empty()) {
    rows.fail("the file has points but tells no strands",
              "write edges (vertex1, vertex2), an element 'strand' with its points, or a strand number a vertex");
  }
  for (std::uint32_t v = 1; v < told.groom.points.size(); ++v) {
    const bool root = told.has_edges ? !told.linked[v] : told.strand_of[v] != told.strand_of[v - 1];
    if (root) told.groom.strand_first.push_back(v);
  }
  if (!told.groom.points.empty())
    told.groom.strand_first.push_back(static_cast<std::uint32_t>(told.groom.points.size()));
}

// Numbers as text or as bytes; rows end where they are told to.
struct Rows {
  bool text;
  OutputFile& output;
  std::string pending;

  template <class Number>
  void put(Number number) {
    if (!text) {
      pending.append(bytesOf(number));
      return;
    }
    std::array<char, 32> digits;
    const char* end = nullptr;
    if constexpr (sizeof(Number) == 1) {
      end = std::to_chars(digits.data(), digits.data() + digits.size(), static_cast<int>(number)).ptr;
    } else {
      end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    }
    pending.append(digits.data(), static_cast<std::size_t>(end - digits.data())).append(1, ' ');
  }
  void endRow() {
    if (text) pending.back() = '\n';
    if (pending.size() >= std::size_t{1} << 16) flush();
  }
  void flush() {
    output.write(pending);
    pending.clear();
  }
};

std::string headerOf(const Groom& groom, bool text, const std::string& comment) {
  std::size_t edges = 0;
  for (std::size_t s = 0; s < groom.strandCount(); ++s) edges += std::max<std::size_t>(groom.pointCount(s), 1) - 1;
  std::string header = "ply\nformat " + std::string(text ? "ascii" : "binary_little_endian") +
                       " 1.0\ncomment strands by hairmesh, root first\n" +
                       (comment.empty() ? "" : "comment " + comment + "\n") + "element vertex " +
                       std::to_string(groom.points.size()) + "\n";
  const auto add = [&header](bool has, std::initializer_list<const char*> lines) {
    for (const char* line : lines) header += has ? "property " + std::string(line) + "\n" : "";
  };
  add(true, {"float x", "float y", "float z"});
  add(!groom.widths.empty(), {"float width"});
  add(!groom.colors.empty(), {"float red", "float green", "float blue"});
  header += "element strand " + std::to_string(groom.strandCount()) + "\n";
  add(true, {"uint points"});
  add(!groom.root_uvs.empty(), {"float root_u", "float root_v"});
  add(!groom.ids.empty(), {"int id"});
  add(!groom.groups.empty(), {"int group"});
  add(!groom.guides.empty(), {"uchar guide"});
  header += "element edge " + std::to_string(edges) + "\n";
  add(true, {"uint vertex1", "uint vertex2"});
  return header + "end_header\n";
}

}  // namespace

Groom readPlyStrands(std::string_view bytes, const std::string& file) {
  PlyRows rows(bytes, file);
  Told told;
  bool vertices = false;
  for (const PlyElement& element : rows.elements()) {
    const bool strands = isAny(element.name, {"strand", "polyline", "curve", "line"});
    if ((strands || element.name == "edge") && !vertices)
      rows.fail("element " + element.name + " stands before the vertices", "write the vertices first");
    if (element.name == "vertex" && !vertices) {
      readVertices(element, rows, told);
      vertices = true;
    } else if (strands) {
      readStrandRows(element, rows, told);
    } else if (element.name == "edge") {
      readEdges(element, rows, told);
    } else {
      for (std::size_t row = 0; row < element.count; ++row) {
        for (const PlyProperty& property : element.properties) skip(property, rows);
      }
    }
  }
  if (!vertices) rows.fail("there is no element 'vertex'", "export the strands' points");
  dealStrands(rows, told);
  fillArrays(told.groom);
  return std::move(told.groom);
}

void writePlyStrands(const Groom& groom, bool text, OutputFile& output, const std::string& comment) {
  output.write(headerOf(groom, text, comment));
  Rows rows{text, output, {}};
  for (std::size_t p = 0; p < groom.points.size(); ++p) {
    for (const float value : groom.points[p]) rows.put(value);
    if (!groom.widths.empty()) rows.put(groom.widths[p]);
    if (!groom.colors.empty()) {
      for (const float value : groom.colors[p]) rows.put(value);
    }
    rows.endRow();
  }
  for (std::size_t s = 0; s < groom.strandCount(); ++s) {
    rows.put(static_cast<std::uint32_t>(groom.pointCount(s)));
    if (!groom.root_uvs.empty()) {
      for (const float value : groom.root_uvs[s]) rows.put(value);
    }
    if (!groom.ids.empty()) rows.put(groom.ids[s]);
    if (!groom.groups.empty()) rows.put(groom.groups[s]);
    if (!groom.guides.empty()) rows.put(groom.guides[s]);
    rows.endRow();
  }
  for (std::size_t s = 0; s < groom.strandCount(); ++s) {
    for (std::uint32_t p = groom.strand_first[s] + 1; p < groom.strand_first[s + 1]; ++p) {
      rows.put(p - 1);
      rows.put(p);
      rows.endRow();
    }
  }
  rows.flush();
}

}  // namespace app

#include "app/figure/bone_mesh.h"

#include <charconv>
#include <cmath>

#include "app/files/errors.h"
#include "app/files/text_scanner.h"

namespace app {
namespace {

struct LineReader {
  std::string_view line;
  const std::string& file;
  int number;

  [[noreturn]] void fail(const std::string& fault, const std::string& mend) const {
    throw InputError(file, "line " + std::to_string(number), fault, mend);
  }
  std::string_view word() {
    const auto first = line.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    const auto last = std::min(line.find_first_of(" \t\r", first), line.size());
    const std::string_view w = line.substr(first, last - first);
    line.remove_prefix(last);
    return w;
  }
  double coordinate() {
    const std::string_view w = word();
    double value = 0;
    const auto [end, error] = std::from_chars(w.data(), w.data() + w.size(), value);
    if (error != std::errc() || end != w.data() + w.size() || !(std::abs(value) < 1e3))
      fail(quoted(w).append(" is no coordinate below 1000 m"), "write a vertex as three numbers");
    return value;
  }
  // A corner 'v', 'v/t' or 'v/t/n', negative counts from the end.
  std::uint32_t corner(std::string_view w, std::size_t vertices) const {
    long index = 0;
    const auto [end, error] = std::from_chars(w.data(), w.data() + w.size(), index);
    const bool whole = end == w.data() + w.size() || *end == '/';
    if (index < 0) index += static_cast<long>(vertices) + 1;
    if (error != std::errc() || !whole || index < 1 || index > static_cast<long>(vertices))
      fail("face corner " + quoted(w) + " names no vertex above it", "number vertices from 1");
    return static_cast<std::uint32_t>(index - 1);
  }
};

}  // namespace

PartMesh readPart(std::string_view text, const std::string& file) {
  PartMesh mesh;
  int number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    LineReader reader{text.substr(at, end - at), file, ++number};
    at = end + 1;
    const std::string_view kind = reader.word();
    if (kind == "v") {
      const double x = reader.coordinate(), y = reader.coordinate(), z = reader.coordinate();
      mesh.vertices.emplace_back(x, y, z);
    } else if (kind == "f") {
      std::vector<std::uint32_t> corners;
      for (std::string_view w = reader.word(); !w.empty(); w = reader.word())
        corners.push_back(reader.corner(w, mesh.vertices.size()));
      if (corners.size() < 3) reader.fail("a face of fewer than three corners", "remove or complete it");
      for (std::size_t k = 2; k < corners.size(); ++k)
        mesh.triangles.push_back({corners[0], corners[k - 1], corners[k]});
    }
  }
  if (mesh.triangles.empty())
    throw InputError(file, "", "holds no faces", "give one closed mesh a body, in the body's own frame");
  return mesh;
}

}  // namespace app

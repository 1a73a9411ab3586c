#include <algorithm>

#include "app/files/errors.h"
#include "app/groom/formats/groom_arrays.h"
#include "app/groom/formats/groom_bytes.h"
#include "app/groom/formats/usda_file.h"
#include "app/groom/formats/usda_text.h"

namespace app {

namespace {

struct Reader {
  std::string_view text;
  const std::string& file;
  std::size_t moment;
  Groom groom;

  Reader(std::string_view all, const std::string& name, std::size_t number) : text(all), file(name), moment(number) {}
  [[noreturn]] void fail(const UsdaPrim& prim, const std::string& fault, const std::string& mend) const {
    throw InputError(file, usdaLine(text, prim.at), "curves '" + prim.name + "': " + fault, mend);
  }
  template <class Number>
  std::vector<Number> numbers(const UsdaPrim& prim, std::string_view name) const {
    const auto found = prim.attributes.find(name);
    if (found == prim.attributes.end()) return {};
    return usdaNumbers<Number>(found->second.at(moment), text, file);
  }
  template <class Number>
  std::vector<Number> primvar(const UsdaPrim& prim, const std::string& name, std::size_t width) const;
  void addPrim(const UsdaPrim& prim);
  void addPoints(const UsdaPrim& prim, const std::vector<std::int32_t>& counts, const std::vector<float>& points);
  void addArrays(const UsdaPrim& prim);

  // Of the prim that is being read.
  std::size_t first_strand = 0, first_point = 0, control_count = 0;
  std::vector<std::uint32_t> controls;  // of each new point
};

bool isBezier(const UsdaPrim& prim) {
  const auto is = [&prim](std::string_view name, std::string_view value) {
    const auto found = prim.attributes.find(name);
    return found == prim.attributes.end() || found->second.value == value;
  };
  return is("type", "\"cubic\"") && is("basis", "\"bezier\"");  // the schema's defaults
}

// The values of a primvar, `width` numbers each, those that indices refer to put in their places.
template <class Number>
std::vector<Number> Reader::primvar(const UsdaPrim& prim, const std::string& name, std::size_t width) const {
  const std::vector<Number> values = numbers<Number>(prim, name);
  const std::vector<std::int32_t> indices = numbers<std::int32_t>(prim, name + ":indices");
  if (indices.empty()) return values;
  std::vector<Number> placed;
  for (const std::int32_t index : indices) {
    if (index < 0 || (static_cast<std::size_t>(index) + 1) * width > values.size())
      fail(prim, name + " has an index beyond its values", "export the curves again");
    for (std::size_t n = 0; n < width; ++n) placed.push_back(values[static_cast<std::size_t>(index) * width + n]);
  }
  return placed;
}

void Reader::addPoints(const UsdaPrim& prim, const std::vector<std::int32_t>& counts,
                       const std::vector<float>& points) {
  const std::size_t stride = isBezier(prim) ? 3 : 1;
  controls.clear();
  std::size_t first = 0;
  for (const std::int32_t count : counts) {
    if (count < 0 || static_cast<std::size_t>(count) > control_count - first)
      fail(prim, "curveVertexCounts reach beyond the points", "export the curves again");
    for (std::size_t p = 0; p < static_cast<std::size_t>(count); p += stride)
      controls.push_back(static_cast<std::uint32_t>(first + p));
    first += static_cast<std::size_t>(count);
    groom.strand_first.push_back(static_cast<std::uint32_t>(first_point + controls.size()));
  }
  if (first != control_count)
    fail(prim, "curveVertexCounts do not come to the number of points", "export the curves again");
  const bool moved = prim.place.matrix() != Eigen::Matrix4d::Identity();
  for (const std::size_t control : controls) {
    const Eigen::Vector3f at(points[3 * control], points[3 * control + 1], points[3 * control + 2]);
    groom.points.push_back(moved ? (prim.place * at.cast<double>()).cast<float>() : at);
  }
}

// Calls put(point or strand, value) for a primvar of `width` numbers, whatever it has one for: the prim, each strand,
// each control point or each point taken.
template <class Number, class Put>
void spread(const std::vector<Number>& values, std::size_t width, const Reader& reader, bool of_points,
            const UsdaPrim& prim, const std::string& name, Put&& put) {
  const std::size_t count = values.size() / width, strands = reader.groom.strandCount() - reader.first_strand;
  if (count == 0) return;
  const bool by_control = count == reader.control_count, by_point = count == reader.controls.size();
  const bool by_strand = count == strands;
  if (values.size() % width != 0 || (count != 1 && !by_strand && !(of_points && (by_control || by_point)))) {
    reader.fail(prim,
                name + " has " + std::to_string(count) + " values for " + std::to_string(strands) + " curves of " +
                    std::to_string(reader.control_count) + " points",
                "write one value, or one a curve, or one a point (interpolation vertex)");
  }
  if (!of_points) {
    for (std::size_t s = 0; s < strands; ++s) put(reader.first_strand + s, values.data() + (by_strand ? s : 0) * width);
    return;
  }
  std::size_t strand = 0;
  for (std::size_t n = 0; n < reader.controls.size(); ++n) {
    while (reader.groom.strand_first[reader.first_strand + strand + 1] <= reader.first_point + n) ++strand;
    const std::size_t element = by_control ? reader.controls[n] : by_point ? n : by_strand ? strand : 0;
    put(reader.first_point + n, values.data() + element * width);
  }
}

void Reader::addArrays(const UsdaPrim& prim) {
  spread(numbers<float>(prim, "widths"), 1, *this, true, prim, "widths",
         [this](std::size_t at, const float* v) { putAt(groom.widths, at, *v, 0.0f); });
  const std::string color = "primvars:displayColor";
  spread(primvar<float>(prim, color, 3), 3, *this, true, prim, color, [this](std::size_t at, const float* v) {
    putAt<Eigen::Vector3f>(groom.colors, at, Eigen::Vector3f(v[0], v[1], v[2]), Eigen::Vector3f::Zero());
  });
  for (const std::string name : {"primvars:groom_root_uv", "primvars:st", "primvars:uv"}) {
    const std::vector<float> uvs = primvar<float>(prim, name, 2);
    if (uvs.size() != 2 * (groom.strandCount() - first_strand) || uvs.empty()) continue;
    spread(uvs, 2, *this, false, prim, name, [this](std::size_t at, const float* v) {
      putAt<Eigen::Vector2f>(groom.root_uvs, at, Eigen::Vector2f(v[0], v[1]), Eigen::Vector2f::Zero());
    });
    break;
  }
  const auto whole = [&](const std::string& name, auto&& put) {
    spread(primvar<std::int32_t>(prim, name, 1), 1, *this, false, prim, name, put);
  };
  whole("primvars:groom_id", [this](std::size_t at, const std::int32_t* v) { putAt(groom.ids, at, *v, -1); });
  whole("primvars:groom_group_id", [this](std::size_t at, const std::int32_t* v) { putAt(groom.groups, at, *v, 0); });
  whole("primvars:groom_guide",
        [this](std::size_t at, const std::int32_t* v) { putAt<std::uint8_t>(groom.guides, at, *v != 0, 0); });
}

void Reader::addPrim(const UsdaPrim& prim) {
  const std::vector<float> points = numbers<float>(prim, "points");
  const std::vector<std::int32_t> counts = numbers<std::int32_t>(prim, "curveVertexCounts");
  if (points.size() % 3 != 0) fail(prim, "points are not three numbers each", "export the curves again");
  control_count = points.size() / 3;
  first_strand = groom.strandCount();
  first_point = groom.points.size();
  checkGroomSize(file, usdaLine(text, prim.at), first_strand + counts.size(), first_point + control_count);
  addPoints(prim, counts, points);
  addArrays(prim);
}

}  // namespace

Groom readUsda(std::string_view text, const std::string& file, std::size_t moment, GroomHints* hints) {
  const UsdaLayer layer = readUsdaLayer(text, file);
  if (layer.curves.empty() && layer.hidden > 0)
    throw InputError(file, "", "all its BasisCurves are invisible, or of the purpose guide or proxy",
                     "show them in the program that wrote the file, and export them again");
  if (layer.curves.empty())
    throw InputError(file, "", "the layer has no BasisCurves of its own",
                     "flatten it: usdcat --flatten FILE -o FILE.usda");
  Reader reader(text, file, moment);
  std::vector<std::int32_t> prim_of;
  for (const UsdaPrim& prim : layer.curves) {
    reader.addPrim(prim);
    prim_of.resize(reader.groom.strandCount(), static_cast<std::int32_t>(&prim - layer.curves.data()));
  }
  if (reader.groom.groups.empty() && layer.curves.size() > 1) reader.groom.groups = prim_of;
  fillArrays(reader.groom);
  if (hints) hints->hidden = layer.hidden;
  if (hints && layer.tells_unit) hints->meters_per_unit = layer.meters_per_unit;
  if (hints && layer.tells_up) hints->up = layer.up_axis;
  return std::move(reader.groom);
}

std::vector<double> usdaTimes(std::string_view text, const std::string& file) {
  const UsdaLayer layer = readUsdaLayer(text, file);
  std::vector<double> times{0};
  for (const UsdaPrim& prim : layer.curves) {
    const auto points = prim.attributes.find("points");
    if (points == prim.attributes.end() || points->second.samples.size() <= times.size()) continue;
    times.clear();
    for (const UsdaSample& sample : points->second.samples) times.push_back(sample.time / layer.time_codes_per_second);
  }
  return times;
}

}  // namespace app

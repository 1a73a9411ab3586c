#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "app/files/errors.h"
#include "app/files/output_file.h"
#include "app/groom/formats/usda_file.h"
#include "app/groom/groom_file.h"

namespace app {

namespace {

constexpr std::size_t kPiece = std::size_t{1} << 16;  // bytes written at a time
constexpr std::size_t kCodeDigits = 24;               // kept free for the last time code

template <class Number>
void appendNumber(Number number, std::string& text) {
  std::array<char, 32> digits;
  if constexpr (std::is_floating_point_v<Number>) {
    if (std::isnan(number)) {
      text += "nan";
      return;
    }
  }
  const char* end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
  text.append(digits.data(), static_cast<std::size_t>(end - digits.data()));
}

std::string textOf(double number) {
  std::string text;
  appendNumber(number, text);
  return text;
}

}  // namespace

struct UsdaWriter::Impl {
  OutputFile output;
  std::string file;
  ClipSettings settings;
  std::string pending;
  std::vector<std::uint32_t> strand_first;
  std::vector<std::array<Eigen::Vector3f, 2>> boxes;  // of the moments
  std::size_t end_code_at = 0;

  Impl(const std::string& name, const ClipSettings& clip) : output(name), file(name), settings(clip) {}

  void flushPiece() {
    if (pending.size() >= kPiece) flush();
  }
  void flush() {
    output.write(pending);
    pending.clear();
  }
  // "[a, b, c]"; with more numbers an element "[(a, b), (c, d)]".
  template <class Number>
  void list(const Number* numbers, std::size_t elements, std::size_t width);
  template <class Number>
  void array(const char* what, const Number* numbers, std::size_t elements, std::size_t width,
             const char* interpolation);
  void head(const Groom& groom);
  void samples(const char* what);
  double codeOf(std::size_t moment) const { return settings.frameOf(moment); }
  void finish();
};

template <class Number>
void UsdaWriter::Impl::list(const Number* numbers, std::size_t elements, std::size_t width) {
  pending += '[';
  for (std::size_t n = 0; n < elements; ++n) {
    if (n > 0) pending += ", ";
    if (width > 1) pending += '(';
    for (std::size_t k = 0; k < width; ++k) {
      if (k > 0) pending += ", ";
      appendNumber(numbers[n * width + k], pending);
    }
    if (width > 1) pending += ')';
    flushPiece();
  }
  pending += ']';
}

template <class Number>
void UsdaWriter::Impl::array(const char* what, const Number* numbers, std::size_t elements, std::size_t width,
                             const char* interpolation) {
  if (elements == 0) return;
  pending += "        " + std::string(what) + " = ";
  list(numbers, elements, width);
  if (interpolation) pending += " (\n            interpolation = \"" + std::string(interpolation) + "\"\n        )";
  pending += '\n';
}

// Everything but the points, and how these begin.
void UsdaWriter::Impl::head(const Groom& groom) {
  strand_first = groom.strand_first;
  pending = "#usda 1.0\n(\n    defaultPrim = \"hair\"\n    doc = \"\"\"strands by hairmesh, root first" +
            (settings.world_heads > 0 ? "; " + worldMark(settings.world_heads, settings.meters_per_unit) : "") +
            "\"\"\"\n";
  pending += "    metersPerUnit = " + textOf(settings.meters_per_unit) +
             "\n    upAxis = \"Y\"\n    timeCodesPerSecond = " + textOf(settings.fps) +
             "\n    framesPerSecond = " + textOf(settings.fps) + "\n    startTimeCode = " + textOf(codeOf(0)) +
             "\n    endTimeCode = ";
  end_code_at = pending.size();
  pending += std::string(kCodeDigits, ' ') + "\n)\n\ndef Xform \"hair\"\n{\n    def BasisCurves \"strands\"\n    {\n";
  pending += "        uniform token type = \"cubic\"\n        uniform token basis = \"catmullRom\"\n";
  pending += "        uniform token wrap = \"pinned\"\n";
  std::vector<std::int32_t> counts(groom.strandCount());
  for (std::size_t s = 0; s < counts.size(); ++s) counts[s] = static_cast<std::int32_t>(groom.pointCount(s));
  const std::vector<std::int32_t> guides(groom.guides.begin(), groom.guides.end());
  const auto floats = [](const auto& all) { return all.empty() ? nullptr : all[0].data(); };
  array("int[] curveVertexCounts", counts.data(), counts.size(), 1, nullptr);
  array("float[] widths", groom.widths.data(), groom.widths.size(), 1, "vertex");
  array("color3f[] primvars:displayColor", floats(groom.colors), groom.colors.size(), 3, "vertex");
  array("float2[] primvars:groom_root_uv", floats(groom.root_uvs), groom.root_uvs.size(), 2, "uniform");
  array("int[] primvars:groom_id", groom.ids.data(), groom.ids.size(), 1, "uniform");
  array("int[] primvars:groom_group_id", groom.groups.data(), groom.groups.size(), 1, "uniform");
  array("int[] primvars:groom_guide", guides.data(), guides.size(), 1, "uniform");
  pending += "        point3f[] points.timeSamples = {\n";
}

void UsdaWriter::Impl::finish() {
  if (boxes.empty()) head(Groom());
  pending += "        }\n        float3[] extent.timeSamples = {\n";
  for (std::size_t n = 0; n < boxes.size(); ++n) {
    pending += "            " + textOf(codeOf(n)) + ": ";
    list(boxes[n][0].data(), 2, 3);
    pending += ",\n";
  }
  pending += "        }\n    }\n}\n";
  flush();
  const std::string end = textOf(codeOf(boxes.empty() ? 0 : boxes.size() - 1)).substr(0, kCodeDigits);
  output.overwrite(static_cast<long>(end_code_at), end);
  output.commit();
}

UsdaWriter::UsdaWriter(const std::string& file, const ClipSettings& settings)
    : impl_(std::make_unique<Impl>(file, settings)) {}

UsdaWriter::~UsdaWriter() = default;

void UsdaWriter::add(const Groom& groom) {
  if (impl_->boxes.empty()) impl_->head(groom);
  if (groom.strand_first != impl_->strand_first) {
    throw OutputError(impl_->file,
                      "moment " + std::to_string(impl_->boxes.size()) + " has other strands than the first",
                      "export with the same number of strands in every frame");
  }
  constexpr float kHuge = std::numeric_limits<float>::max();
  std::array<Eigen::Vector3f, 2> box{Eigen::Vector3f::Constant(kHuge), Eigen::Vector3f::Constant(-kHuge)};
  for (const Eigen::Vector3f& point : groom.points) box = {box[0].cwiseMin(point), box[1].cwiseMax(point)};
  impl_->pending += "            " + textOf(impl_->codeOf(impl_->boxes.size())) + ": ";
  impl_->list(groom.points.empty() ? nullptr : groom.points[0].data(), groom.points.size(), 3);
  impl_->pending += ",\n";
  impl_->boxes.push_back(box);
}

void UsdaWriter::finish() {
  impl_->finish();
}

}  // namespace app

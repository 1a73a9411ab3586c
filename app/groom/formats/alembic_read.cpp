#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <optional>

#include "app/groom/formats/alembic_file.h"
#include "app/groom/formats/alembic_property.h"
#include "app/groom/formats/groom_arrays.h"
#include "app/groom/formats/groom_bytes.h"

namespace app {

using namespace alembic;

namespace {

constexpr int kDeepest = 64;  // objects below one another

struct TimeSampling {
  double cycle = 1;  // s
  std::vector<double> stored;
};

// The root group: versions, top object, metadata of the archive, time samplings, metadata that headers refer to.
struct Archive {
  OgawaReader ogawa;
  MetadataTable table;
  std::vector<TimeSampling> samplings;
  std::uint64_t top = 0;

  Archive(std::string_view bytes, const std::string& file);
  void readSamplings(std::string_view bytes);
};

Archive::Archive(std::string_view bytes, const std::string& file) : ogawa(bytes, file) {
  const std::vector<std::uint64_t> root = ogawa.children(ogawa.root());
  if (root.size() < 6) ogawa.fail(ogawa.root(), "the root group is not that of an Alembic archive");
  top = root[2];
  readSamplings(ogawa.data(root[4]));
  table.read(ogawa.data(root[5]), ogawa);
}

void Archive::readSamplings(std::string_view bytes) {
  ByteReader reader{bytes, ogawa.file()};
  while (reader.left() > 0) {
    reader.number<std::uint32_t>("a time sampling");
    TimeSampling sampling;
    sampling.cycle = reader.number<double>("a time sampling");
    reader.array(reader.number<std::uint32_t>("a time sampling"), "times of the samples", sampling.stored);
    samplings.push_back(std::move(sampling));
  }
}

const Property* find(const std::vector<Property>& properties, std::string_view name) {
  for (const Property& property : properties) {
    if (property.name == name) return &property;
  }
  return nullptr;
}

// The numbers of a sample, whatever their type.
struct Numbers {
  Pod pod = Pod::kFloat32;
  std::size_t extent = 1;
  std::string_view bytes;
  std::string scope;  // "con", "uni", "var", "vtx"

  std::size_t size() const { return podBytes(pod) == 0 ? 0 : bytes.size() / podBytes(pod); }
  std::size_t elements() const { return size() / extent; }
  double operator[](std::size_t n) const;
};

template <class Number>
Number numberAt(std::string_view bytes, std::size_t n) {
  Number value;
  std::memcpy(&value, bytes.data() + n * sizeof value, sizeof value);
  return value;
}

double halfAt(std::string_view bytes, std::size_t n) {
  const auto bits = numberAt<std::uint16_t>(bytes, n);
  const int exponent = bits >> 10 & 31, fraction = bits & 1023;
  const double size = exponent == 31  ? (fraction ? NAN : HUGE_VAL)
                      : exponent == 0 ? std::ldexp(fraction, -24)
                                      : std::ldexp(fraction + 1024, exponent - 25);
  return bits >> 15 ? -size : size;
}

double Numbers::operator[](std::size_t n) const {
  switch (pod) {
    case Pod::kBool:
    case Pod::kUint8:
      return numberAt<std::uint8_t>(bytes, n);
    case Pod::kInt8:
      return numberAt<std::int8_t>(bytes, n);
    case Pod::kUint16:
      return numberAt<std::uint16_t>(bytes, n);
    case Pod::kInt16:
      return numberAt<std::int16_t>(bytes, n);
    case Pod::kUint32:
      return numberAt<std::uint32_t>(bytes, n);
    case Pod::kInt32:
      return numberAt<std::int32_t>(bytes, n);
    case Pod::kUint64:
      return static_cast<double>(numberAt<std::uint64_t>(bytes, n));
    case Pod::kInt64:
      return static_cast<double>(numberAt<std::int64_t>(bytes, n));
    case Pod::kFloat16:
      return halfAt(bytes, n);
    case Pod::kFloat32:
      return numberAt<float>(bytes, n);
    case Pod::kFloat64:
      return numberAt<double>(bytes, n);
    default:
      return 0;
  }
}

Numbers numbersOf(const Property& property, std::size_t moment, Archive& archive) {
  const auto index = static_cast<std::uint32_t>(std::min<std::size_t>(moment, UINT32_MAX));
  return {property.pod, std::max(property.extent, 1u), readSample(property, index, archive.ogawa),
          metadataValue(property.metadata, "geoScope")};
}

// A geometry parameter: an array, or a compound of values and the indices that elements refer to them by.
struct Param {
  Numbers values;
  std::optional<Numbers> indices;

  std::size_t elements() const { return indices ? indices->elements() : values.elements(); }
  double at(std::size_t element, std::size_t part) const {
    if (indices) element = static_cast<std::size_t>(std::max(0.0, (*indices)[element]));
    return element < values.elements() && part < values.extent ? values[element * values.extent + part] : 0;
  }
};

std::optional<Param> paramOf(const std::vector<Property>& properties, std::string_view name, std::size_t moment,
                             Archive& archive) {
  const Property* property = find(properties, name);
  if (property == nullptr) return std::nullopt;
  if (property->kind != Kind::kCompound) return Param{numbersOf(*property, moment, archive), std::nullopt};
  const std::vector<Property> parts = readProperties(property->group, archive.table, archive.ogawa);
  const Property* values = find(parts, ".vals");
  const Property* indices = find(parts, ".indices");
  if (values == nullptr || indices == nullptr) return std::nullopt;
  Param param{numbersOf(*values, moment, archive), numbersOf(*indices, moment, archive)};
  if (param.values.scope.empty()) param.values.scope = metadataValue(property->metadata, "geoScope");
  return param;
}

// Curves of one object as they stand in the file.
struct Curves {
  std::vector<Property> geom, attributes;
  Numbers points, counts;
  std::array<int, 3> kind{1, 0, 0};  // type (0 cubic, 1 linear), wrap, basis (1 Bezier)
};

bool isBezier(const Curves& curves) {
  return curves.kind[0] == 0 && curves.kind[2] == 1;
}

Curves curvesOf(const std::vector<Property>& geom, std::size_t moment, Archive& archive) {
  Curves curves;
  curves.geom = geom;
  const Property* points = find(geom, "P");
  const Property* counts = find(geom, "nVertices");
  if (points == nullptr || counts == nullptr) archive.ogawa.fail(0, "curves lack P or nVertices");
  curves.points = numbersOf(*points, moment, archive);
  curves.counts = numbersOf(*counts, moment, archive);
  if (curves.points.extent != 3 || podBytes(curves.points.pod) == 0)
    archive.ogawa.fail(0, "P is not three numbers a point");
  if (const Property* kind = find(geom, "curveBasisAndType")) {
    const Numbers numbers = numbersOf(*kind, moment, archive);
    for (std::size_t n = 0; n < 3 && n < numbers.size(); ++n) curves.kind[n] = static_cast<int>(numbers[n]);
  }
  if (const Property* more = find(geom, ".arbGeomParams"))
    curves.attributes = readProperties(more->group, archive.table, archive.ogawa);
  return curves;
}

void addPoints(const Curves& curves, const Eigen::Affine3d& place, const std::vector<std::uint32_t>& controls,
               Groom& groom) {
  const bool moved = place.matrix() != Eigen::Matrix4d::Identity();
  if (!moved && curves.points.pod == Pod::kFloat32 && !isBezier(curves)) {
    const std::size_t before = groom.points.size();
    groom.points.resize(before + controls.size());
    if (!controls.empty())
      std::memcpy(groom.points[before].data(), curves.points.bytes.data(), controls.size() * sizeof(Eigen::Vector3f));
    return;
  }
  for (const std::size_t control : controls) {
    const Eigen::Vector3d at(curves.points[3 * control], curves.points[3 * control + 1],
                             curves.points[3 * control + 2]);
    groom.points.push_back((moved ? place * at : at).cast<float>());
  }
}

// Appends the strands of an object; returns for each new point the number of its control point.
std::vector<std::uint32_t> addStrands(const Curves& curves, const Eigen::Affine3d& place, Archive& archive,
                                      Groom& groom) {
  const std::size_t stride = isBezier(curves) ? 3 : 1;
  checkGroomSize(archive.ogawa.file(), "curves", groom.strandCount() + curves.counts.size(),
                 groom.points.size() + curves.points.elements());
  std::vector<std::uint32_t> controls;
  std::size_t first = 0;
  for (std::size_t c = 0; c < curves.counts.size(); ++c) {
    const double count = curves.counts[c];
    if (!(count >= 0) || count > static_cast<double>(curves.points.elements() - first))
      archive.ogawa.fail(0, "nVertices of curve " + std::to_string(c) + " reaches beyond the points");
    const auto points = static_cast<std::size_t>(count);
    for (std::size_t p = 0; p < points; p += stride) controls.push_back(static_cast<std::uint32_t>(first + p));
    first += points;
    groom.strand_first.push_back(static_cast<std::uint32_t>(groom.points.size() + controls.size()));
  }
  if (first != curves.points.elements()) archive.ogawa.fail(0, "nVertices do not come to the number of points");
  addPoints(curves, place, controls, groom);
  return controls;
}

// Which element of a parameter belongs to a strand or to a control point of it.
std::size_t elementOf(const Param& param, std::size_t strand, std::size_t control) {
  if (param.elements() <= 1 || param.values.scope == "con") return 0;
  return param.values.scope == "uni" ? strand : control;
}

void addPointArrays(const Curves& curves, std::size_t moment, const std::vector<std::uint32_t>& controls,
                    std::size_t first_strand, Archive& archive, Groom& groom) {
  std::optional<Param> width = paramOf(curves.geom, "width", moment, archive);
  if (!width) width = paramOf(curves.attributes, "groom_width", moment, archive);
  const std::optional<Param> color = paramOf(curves.attributes, "groom_color", moment, archive);
  const std::size_t before = groom.points.size() - controls.size();
  std::size_t strand = first_strand;
  for (std::size_t n = 0; n < controls.size(); ++n) {
    while (groom.strand_first[strand + 1] <= before + n) ++strand;
    if (width && width->elements() > 0) {
      const std::size_t element = elementOf(*width, strand - first_strand, controls[n]);
      if (element < width->elements()) putAt(groom.widths, before + n, static_cast<float>(width->at(element, 0)), 0.0f);
    }
    if (!color || color->elements() == 0) continue;
    const std::size_t element = elementOf(*color, strand - first_strand, controls[n]);
    if (element >= color->elements()) continue;
    const Eigen::Vector3d shade(color->at(element, 0), color->at(element, 1), color->at(element, 2));
    putAt<Eigen::Vector3f>(groom.colors, before + n, shade.cast<float>(), Eigen::Vector3f::Zero());
  }
}

std::int32_t whole(double value) {
  return std::isfinite(value) && std::abs(value) <= INT32_MAX ? static_cast<std::int32_t>(value) : 0;
}

void addStrandArrays(const Curves& curves, std::size_t moment, std::size_t first_strand, Archive& archive,
                     Groom& groom) {
  const auto each = [&](std::string_view name, auto&& put) {
    const std::optional<Param> param = paramOf(curves.attributes, name, moment, archive);
    if (!param || param->elements() == 0) return;
    for (std::size_t s = first_strand; s < groom.strandCount(); ++s) {
      const std::size_t element = param->elements() == 1 ? 0 : s - first_strand;
      if (element < param->elements()) put(*param, s, element);
    }
  };
  each("groom_root_uv", [&groom](const Param& param, std::size_t s, std::size_t element) {
    const Eigen::Vector2f uv(static_cast<float>(param.at(element, 0)), static_cast<float>(param.at(element, 1)));
    putAt<Eigen::Vector2f>(groom.root_uvs, s, uv, Eigen::Vector2f::Zero());
  });
  each("groom_id", [&groom](const Param& param, std::size_t s, std::size_t element) {
    putAt(groom.ids, s, whole(param.at(element, 0)), -1);
  });
  each("groom_group_id", [&groom](const Param& param, std::size_t s, std::size_t element) {
    putAt(groom.groups, s, whole(param.at(element, 0)), 0);
  });
  each("groom_guide", [&groom](const Param& param, std::size_t s, std::size_t element) {
    putAt<std::uint8_t>(groom.guides, s, param.at(element, 0) != 0, 0);
  });
}

// One operation of a transform: its number of channels and what it does to points behind it.
struct XformOp {
  std::size_t channels;
  Eigen::Affine3d (*turn)(const double*);
};

Eigen::Affine3d turned(const double degrees, const Eigen::Vector3d& axis) {
  if (!(axis.norm() > 0)) return Eigen::Affine3d::Identity();
  return Eigen::Affine3d(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis.normalized()));
}

// By the upper half of the operation's byte. Matrices are kept for row vectors.
constexpr std::array<XformOp, 7> kXformOps{{
    {3, [](const double* v) { return Eigen::Affine3d(Eigen::Scaling(v[0], v[1], v[2])); }},
    {3, [](const double* v) { return Eigen::Affine3d(Eigen::Translation3d(v[0], v[1], v[2])); }},
    {4,
     [](const double* v) {
       return turned(v[3], {v[0], v[1], v[2]});
     }},
    {16, [](const double* v) { return Eigen::Affine3d(Eigen::Map<const Eigen::Matrix4d>(v)); }},
    {1, [](const double* v) { return turned(v[0], Eigen::Vector3d::UnitX()); }},
    {1, [](const double* v) { return turned(v[0], Eigen::Vector3d::UnitY()); }},
    {1, [](const double* v) { return turned(v[0], Eigen::Vector3d::UnitZ()); }},
}};

Eigen::Affine3d xformOf(const std::vector<Property>& xform, Archive& archive) {
  Eigen::Affine3d place = Eigen::Affine3d::Identity();
  const Property* ops = find(xform, ".ops");
  const Property* values = find(xform, ".vals");
  if (ops == nullptr || values == nullptr) return place;
  const Numbers kinds = numbersOf(*ops, 0, archive), numbers = numbersOf(*values, 0, archive);
  std::size_t at = 0;
  for (std::size_t n = 0; n < kinds.size(); ++n) {
    const auto kind = static_cast<unsigned>(kinds[n]) >> 4;
    if (kind >= kXformOps.size() || at + kXformOps[kind].channels > numbers.size())
      archive.ogawa.fail(0, "a transform's operations do not fit its values");
    std::array<double, 16> channels{};
    for (std::size_t c = 0; c < kXformOps[kind].channels; ++c) channels[c] = numbers[at++];
    place = place * kXformOps[kind].turn(channels.data());
  }
  return place;
}

// Calls `visit(geom, place)` for the curves of an object and of all below it.
template <class Visit>
void visitCurves(const Object& object, const Eigen::Affine3d& above, int depth, Archive& archive, Visit&& visit) {
  if (depth > kDeepest) archive.ogawa.fail(object.group, "objects lie more than 64 deep");
  const std::vector<std::uint64_t> children = archive.ogawa.children(object.group);
  if (children.empty()) return;
  Eigen::Affine3d place = above;
  for (const Property& property : readProperties(children[0], archive.table, archive.ogawa)) {
    if (property.kind != Kind::kCompound) continue;
    const std::string schema = metadataValue(property.metadata, "schema");
    if (schema.starts_with("AbcGeom_Xform"))
      place = above * xformOf(readProperties(property.group, archive.table, archive.ogawa), archive);
    if (schema.starts_with("AbcGeom_Curve")) visit(readProperties(property.group, archive.table, archive.ogawa), place);
  }
  for (const Object& child : readObjects(children, archive.table, archive.ogawa))
    visitCurves(child, place, depth + 1, archive, visit);
}

}  // namespace

Groom readAlembic(std::string_view bytes, const std::string& file, std::size_t moment) {
  Archive archive(bytes, file);
  Groom groom;
  std::vector<std::size_t> firsts;  // first strand of every object
  visitCurves({"ABC", "", archive.top}, Eigen::Affine3d::Identity(), 0, archive,
              [&](const std::vector<Property>& geom, const Eigen::Affine3d& place) {
                const Curves curves = curvesOf(geom, moment, archive);
                firsts.push_back(groom.strandCount());
                const std::vector<std::uint32_t> controls = addStrands(curves, place, archive, groom);
                addPointArrays(curves, moment, controls, firsts.back(), archive, groom);
                addStrandArrays(curves, moment, firsts.back(), archive, groom);
              });
  if (firsts.empty()) archive.ogawa.fail(0, "there are no curves in the archive");
  if (groom.groups.empty() && firsts.size() > 1) {
    for (std::size_t n = 0; n < firsts.size(); ++n) {
      const std::size_t end = n + 1 < firsts.size() ? firsts[n + 1] : groom.strandCount();
      groom.groups.insert(groom.groups.end(), end - firsts[n], static_cast<std::int32_t>(n));
    }
  }
  fillArrays(groom);
  return groom;
}

std::vector<double> alembicTimes(std::string_view bytes, const std::string& file) {
  Archive archive(bytes, file);
  std::vector<double> times{0};
  visitCurves({"ABC", "", archive.top}, Eigen::Affine3d::Identity(), 0, archive,
              [&](const std::vector<Property>& geom, const Eigen::Affine3d&) {
                const Property* points = find(geom, "P");
                if (points == nullptr || points->sample_count <= times.size()) return;
                if (points->sample_count > bytes.size() || points->time_sampling >= archive.samplings.size())
                  archive.ogawa.fail(points->group, "the samples of P do not fit the file");
                const TimeSampling& sampling = archive.samplings[points->time_sampling];
                if (sampling.stored.empty()) return;
                times.clear();
                for (std::size_t n = 0; n < points->sample_count; ++n)
                  times.push_back(sampling.stored[n % sampling.stored.size()] +
                                  static_cast<double>(n / sampling.stored.size()) * sampling.cycle);
              });
  return times;
}

}  // namespace app

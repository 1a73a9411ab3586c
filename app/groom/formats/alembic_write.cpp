#include <array>
#include <limits>

#include "app/files/errors.h"
#include "app/groom/formats/alembic_file.h"
#include "app/groom/formats/alembic_property.h"
#include "app/groom/formats/groom_bytes.h"
#include "app/groom/groom_file.h"

namespace app {

using namespace alembic;

namespace {

constexpr std::int32_t kOgawaVersion = 0, kLibraryVersion = 10806;  // Alembic 1.8.6, whose layout this is
constexpr std::int16_t kGroomMajor = 1, kGroomMinor = 4;
constexpr std::array<std::uint8_t, 4> kLinear{1, 0, 0, 0};  // type, wrap, basis, basis

const std::string kCurves = "schema=AbcGeom_Curve_v2;schemaBaseType=AbcGeom_GeomBase_v1";

std::string geomParam(const char* scope, unsigned extent, const char* pod, const std::string& interpretation) {
  return "arrayExtent=1;geoScope=" + std::string(scope) +
         (interpretation.empty() ? "" : ";interpretation=" + interpretation) +
         ";isGeomParam=true;podExtent=" + std::to_string(extent) + ";podName=" + pod;
}

}  // namespace

struct AlembicWriter::Impl {
  OutputFile output;
  std::string file;
  ClipSettings times;
  OgawaWriter ogawa{output};
  std::vector<std::uint32_t> strand_first;
  std::vector<std::uint64_t> points, bounds;  // offsets of the samples
  std::vector<Property> geom, attributes;     // of the first moment, beside points and bounds
  MetadataTable table;
  std::uint64_t hash = 0;

  Impl(const std::string& name, const ClipSettings& settings) : output(name), file(name), times(settings) {}

  Property constant(const char* name, std::string metadata, Kind kind, Pod pod, unsigned extent,
                    std::string_view bytes);
  template <class Element>
  void attribute(const char* name, const std::string& metadata, Pod pod, unsigned extent,
                 const std::vector<Element>& all);
  void writeFirst(const Groom& groom);
  void addBounds(const Groom& groom);
  Property moving(const char* name, std::string metadata, Kind kind, Pod pod, unsigned extent,
                  const std::vector<std::uint64_t>& samples);
  Property compound(const char* name, std::string metadata, const std::vector<Property>& properties);
  std::uint64_t compoundGroup(const std::vector<Property>& properties);
  std::uint64_t curvesObject();
  std::string timeSamplings() const;
  void finish();
};

// A property of one sample, written at once.
Property AlembicWriter::Impl::constant(const char* name, std::string metadata, Kind kind, Pod pod, unsigned extent,
                                       std::string_view bytes) {
  Property property{name, std::move(metadata), kind, pod, extent, 1};
  std::vector<std::uint64_t> samples{writeSample(bytes, ogawa)};
  if (kind == Kind::kArray) samples.push_back(kOgawaData);
  property.group = ogawa.group(samples);
  hash = contentHash(bytes, hash);
  return property;
}

template <class Element>
void AlembicWriter::Impl::attribute(const char* name, const std::string& metadata, Pod pod, unsigned extent,
                                    const std::vector<Element>& all) {
  if (!all.empty()) attributes.push_back(constant(name, metadata, Kind::kArray, pod, extent, bytesOf(all)));
}

void AlembicWriter::Impl::writeFirst(const Groom& groom) {
  strand_first = groom.strand_first;
  std::vector<std::int32_t> counts(groom.strandCount());
  for (std::size_t s = 0; s < counts.size(); ++s) counts[s] = static_cast<std::int32_t>(groom.pointCount(s));
  geom.push_back(constant("curveBasisAndType", "", Kind::kScalar, Pod::kUint8, 4, bytesOf(kLinear)));
  geom.push_back(constant("nVertices", "", Kind::kArray, Pod::kInt32, 1, bytesOf(counts)));
  const std::string width = geomParam("vtx", 1, "float32_t", "");
  if (!groom.widths.empty()) {
    geom.push_back(constant("width", width, Kind::kArray, Pod::kFloat32, 1, bytesOf(groom.widths)));
    attributes.push_back(geom.back());  // the same samples under Unreal's name
    attributes.back().name = "groom_width";
  }
  const std::string whole = geomParam("uni", 1, "int32_t", "");
  attribute("groom_color", geomParam("vtx", 3, "float32_t", "rgb"), Pod::kFloat32, 3, groom.colors);
  attribute("groom_root_uv", geomParam("uni", 2, "float32_t", "vector"), Pod::kFloat32, 2, groom.root_uvs);
  attribute("groom_id", whole, Pod::kInt32, 1, groom.ids);
  attribute("groom_group_id", whole, Pod::kInt32, 1, groom.groups);
  attribute("groom_guide", geomParam("uni", 1, "int32_t", ""), Pod::kInt32, 1,
            std::vector<std::int32_t>(groom.guides.begin(), groom.guides.end()));
}

void AlembicWriter::Impl::addBounds(const Groom& groom) {
  constexpr double kHuge = std::numeric_limits<double>::max();
  std::array<double, 6> box{kHuge, kHuge, kHuge, -kHuge, -kHuge, -kHuge};
  for (const Eigen::Vector3f& point : groom.points) {
    for (int axis = 0; axis < 3; ++axis) {
      box[axis] = std::min(box[axis], double{point[axis]});
      box[axis + 3] = std::max(box[axis + 3], double{point[axis]});
    }
  }
  bounds.push_back(writeSample(bytesOf(box), ogawa));
}

Property AlembicWriter::Impl::moving(const char* name, std::string metadata, Kind kind, Pod pod, unsigned extent,
                                     const std::vector<std::uint64_t>& samples) {
  const auto count = static_cast<std::uint32_t>(samples.size());
  Property property{name, std::move(metadata), kind, pod, extent, count};
  if (count > 1) {
    property.first_changed = 1;
    property.last_changed = count - 1;
    property.time_sampling = 1;
  }
  std::vector<std::uint64_t> children;
  for (const std::uint64_t sample : samples) {
    children.push_back(sample);
    if (kind == Kind::kArray) children.push_back(kOgawaData);
  }
  property.group = ogawa.group(children);
  return property;
}

std::uint64_t AlembicWriter::Impl::compoundGroup(const std::vector<Property>& properties) {
  std::vector<std::uint64_t> children;
  for (const Property& property : properties) children.push_back(property.group);
  if (!properties.empty()) children.push_back(ogawa.data({propertyHeaders(properties, table)}));
  return ogawa.group(children);
}

Property AlembicWriter::Impl::compound(const char* name, std::string metadata,
                                       const std::vector<Property>& properties) {
  Property property{name, std::move(metadata)};
  property.group = compoundGroup(properties);
  return property;
}

std::uint64_t AlembicWriter::Impl::curvesObject() {
  std::vector<Property> properties{
      moving(".selfBnds", "interpretation=box", Kind::kScalar, Pod::kFloat64, 6, bounds),
      moving("P", "geoScope=vtx;interpretation=point", Kind::kArray, Pod::kFloat32, 3, points)};
  properties.insert(properties.end(), geom.begin(), geom.end());
  if (!attributes.empty()) properties.push_back(compound(".arbGeomParams", "", attributes));
  properties.push_back(
      compound(".userProperties", "",
               {constant("groom_version_major", "", Kind::kScalar, Pod::kInt16, 1, bytesOf(kGroomMajor)),
                constant("groom_version_minor", "", Kind::kScalar, Pod::kInt16, 1, bytesOf(kGroomMinor)),
                constant("groom_tool", "", Kind::kScalar, Pod::kString, 1, std::string_view("hairmesh", 9))}));
  const std::uint64_t top = compoundGroup({compound(".geom", kCurves, properties)});
  return ogawa.group({top, ogawa.data({objectHeaders({}, hash, table)})});
}

// Largest number of samples, seconds a cycle, samples a cycle, their times: the sampling of what does not move first.
std::string AlembicWriter::Impl::timeSamplings() const {
  std::string bytes;
  const auto put = [&bytes](std::uint32_t samples, double cycle, const std::vector<double>& stored) {
    bytes.append(bytesOf(samples)).append(bytesOf(cycle));
    bytes.append(bytesOf(static_cast<std::uint32_t>(stored.size()))).append(bytesOf(stored));
  };
  put(1, 1.0, {0.0});
  if (points.size() < 2) return bytes;
  std::vector<double> stored;
  for (std::size_t n = 0; n < times.offsets.size(); ++n) stored.push_back(times.timeOf(n));
  put(static_cast<std::uint32_t>(points.size()), static_cast<double>(times.every) / times.fps, stored);
  return bytes;
}

void AlembicWriter::Impl::finish() {
  const std::string about =
      "_ai_AlembicVersion=Alembic 1.8.6;_ai_Application=hairmesh" +
      (times.world_heads > 0 ? ";_ai_Description=" + worldMark(times.world_heads, times.meters_per_unit) : "");
  const std::vector<Object> objects{{"groom", kCurves + ";schemaObjTitle=AbcGeom_Curve_v2:.geom", curvesObject()}};
  const std::uint64_t top =
      ogawa.group({compoundGroup({}), objects[0].group, ogawa.data({objectHeaders(objects, hash, table)})});
  const std::uint64_t versions[2] = {ogawa.data({bytesOf(kOgawaVersion)}), ogawa.data({bytesOf(kLibraryVersion)})};
  const std::uint64_t sampling = ogawa.data({timeSamplings()});
  const std::uint64_t metadata = ogawa.data({about}), indexed = ogawa.data({table.bytes()});
  ogawa.finish(ogawa.group({versions[0], versions[1], top, metadata, sampling, indexed}));
  output.commit();
}

AlembicWriter::AlembicWriter(const std::string& file, const ClipSettings& times)
    : impl_(std::make_unique<Impl>(file, times)) {}

AlembicWriter::~AlembicWriter() = default;

void AlembicWriter::add(const Groom& groom) {
  if (impl_->points.empty()) impl_->writeFirst(groom);
  if (groom.strand_first != impl_->strand_first) {
    throw OutputError(impl_->file,
                      "moment " + std::to_string(impl_->points.size()) + " has other strands than the first",
                      "export with the same number of strands in every frame");
  }
  impl_->points.push_back(writeSample(bytesOf(groom.points), impl_->ogawa));
  impl_->hash = contentHash(bytesOf(impl_->points.back()), impl_->hash);
  impl_->addBounds(groom);
}

void AlembicWriter::finish() {
  impl_->finish();
}

}  // namespace app

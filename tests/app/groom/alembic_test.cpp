// Alembic curves: what is written comes back in the same bits, by the program's reader and by one in Python.
#include <gtest/gtest.h>

#include <cstring>

#include "app/files/errors.h"
#include "app/groom/formats/alembic_file.h"
#include "app/groom/formats/alembic_property.h"
#include "app/groom/groom_file.h"
#include "tests/app/groom/groom_samples.h"
#include "tests/app/groom/second_reader.h"

namespace alembic_test {

// A clip of one groom that sways.
std::vector<app::Groom> swaying(app::Groom groom, std::size_t moments) {
  std::vector<app::Groom> clip;
  for (std::size_t n = 0; n < moments; ++n) {
    for (Eigen::Vector3f& point : groom.points) point.x() += 0.001f * point.y();
    clip.push_back(groom);
  }
  return clip;
}

std::string writtenFile(const std::vector<app::Groom>& clip, const app::ClipSettings& times) {
  const std::string file = test::freshFolder("alembic") + "/groom.abc";
  app::AlembicWriter writer(file, times);
  for (const app::Groom& groom : clip) writer.add(groom);
  writer.finish();
  return file;
}

void expectTheSame(const std::vector<app::Groom>& clip, const app::ClipSettings& times) {
  const std::string file = writtenFile(clip, times), bytes = test::readAll(file);
  const std::vector<double> read_times = app::alembicTimes(bytes, file);
  std::vector<double> expected;
  for (std::size_t n = 0; n < clip.size(); ++n) expected.push_back(clip.size() > 1 ? times.timeOf(n) : 0);
  ASSERT_EQ(read_times.size(), expected.size());
  for (std::size_t n = 0; n < clip.size(); ++n) EXPECT_NEAR(read_times[n], expected[n], 1e-12);
  std::vector<app::Groom> read;
  for (std::size_t n = 0; n < clip.size(); ++n) read.push_back(app::readAlembic(bytes, file, n));
  EXPECT_TRUE(test::dumpClip({}, read) == test::dumpClip({}, clip)) << "read back differently";
  const std::string second = test::secondReading(file);
  EXPECT_TRUE(second == test::dumpClip(read_times, clip)) << second.substr(0, 2000);
}

TEST(Alembic, AClipComesBackInTheSameBitsByBothReaders) {
  expectTheSame(swaying(test::sampleGroom(40, 11), 5), {30, 15, {0}});
  expectTheSame(swaying(test::sampleGroom(300, 12), 300), {});
}

TEST(Alembic, MotionBlurSamplesKeepTheirTimes) {
  expectTheSame(swaying(test::sampleGroom(7, 13), 12), {24, 0, {-0.01, 0, 0.01}});
}

TEST(Alembic, OneFrameAndBareStrandsComeBack) {
  expectTheSame({test::sampleGroom(20, 14)}, {});
  app::Groom bare = test::sampleGroom(3, 15);
  bare.widths.clear();
  bare.colors.clear();
  bare.root_uvs.clear();
  bare.ids.clear();
  bare.groups.clear();
  bare.guides.clear();
  expectTheSame({bare}, {});
  EXPECT_EQ(app::readGroom(writtenFile({bare}, {})).points, bare.points);
}

TEST(Alembic, AnUnfinishedClipLeavesNoFile) {
  const std::string file = test::freshFolder("alembic_cut") + "/groom.abc";
  {
    app::AlembicWriter writer(file, {});
    writer.add(test::sampleGroom(5, 16));
    EXPECT_THROW(writer.add(test::sampleGroom(6, 16)), app::OutputError);
  }
  EXPECT_TRUE(std::filesystem::is_empty(std::filesystem::path(file).parent_path()));
}

// Bytes cut off or turned never do more than be refused.
TEST(Alembic, DamagedFilesAreRefusedByName) {
  const std::string whole = test::readAll(writtenFile(swaying(test::sampleGroom(4, 17), 3), {}));
  std::size_t refused = 0;
  const auto read = [&refused](const std::string& bytes) {
    try {
      app::readAlembic(bytes, "groom.abc", 1);
      app::alembicTimes(bytes, "groom.abc");
    } catch (const app::InputError& fault) {
      ++refused;
      EXPECT_TRUE(std::string(fault.what()).starts_with("groom.abc: ")) << fault.what();
    }
  };
  for (std::size_t size = 0; size < whole.size(); size += 7) read(whole.substr(0, size));
  EXPECT_GE(refused, whole.size() / 7);
  std::mt19937 random(18);
  for (int n = 0; n < 4000; ++n) {
    std::string bytes = whole;
    for (int k = 0; k < 3; ++k) bytes[random() % bytes.size()] = static_cast<char>(random());
    read(bytes);
  }
  std::string open = whole;
  open[5] = 0;
  try {
    app::readAlembic(open, "groom.abc");
    FAIL();
  } catch (const app::InputError& fault) {
    EXPECT_NE(std::string(fault.what()).find("not written to its end"), std::string::npos);
  }
}

// An archive as other programs write it, property by property: curves below a transform, values by index, halves.
struct ForeignArchive {
  std::string file = test::freshFolder("alembic_foreign") + "/foreign.abc";
  app::OutputFile output{file};
  app::OgawaWriter ogawa{output};
  app::alembic::MetadataTable table;

  using Kind = app::alembic::Kind;
  using Pod = app::alembic::Pod;
  using Property = app::alembic::Property;

  Property values(const char* name, std::string metadata, Kind kind, Pod pod, unsigned extent, std::string_view bytes) {
    Property property{name, std::move(metadata), kind, pod, extent, 1};
    std::vector<std::uint64_t> samples{app::alembic::writeSample(bytes, ogawa)};
    if (kind == Kind::kArray) samples.push_back(app::kOgawaData);
    property.group = ogawa.group(samples);
    return property;
  }
  Property compound(const char* name, std::string metadata, const std::vector<Property>& properties) {
    Property property{name, std::move(metadata)};
    property.group = group(properties);
    return property;
  }
  std::uint64_t group(const std::vector<Property>& properties) {
    std::vector<std::uint64_t> children;
    for (const Property& property : properties) children.push_back(property.group);
    children.push_back(ogawa.data({app::alembic::propertyHeaders(properties, table)}));
    return ogawa.group(children);
  }
  std::uint64_t object(std::uint64_t properties, const std::vector<app::alembic::Object>& below) {
    std::vector<std::uint64_t> children{properties};
    for (const app::alembic::Object& child : below) children.push_back(child.group);
    children.push_back(ogawa.data({app::alembic::objectHeaders(below, 1, table)}));
    return ogawa.group(children);
  }
  void finish(std::uint64_t top) {
    const std::uint64_t versions = ogawa.data({std::string_view("\0\0\0\0", 4)});
    const std::string sampling(16 + 8, '\0');
    const std::uint64_t times = ogawa.data(
        {std::string_view("\1\0\0\0\0\0\0\0\0\0\xf0\x3f\1\0\0\0", 16), std::string_view(sampling).substr(0, 8)});
    const std::uint64_t indexed = ogawa.data({table.bytes()});
    ogawa.finish(ogawa.group({versions, versions, top, ogawa.data({"a=b"}), times, indexed}));
    output.commit();
  }
};

template <class Number>
std::string bytes(std::initializer_list<Number> numbers) {
  return {reinterpret_cast<const char*>(numbers.begin()), numbers.size() * sizeof(Number)};
}

TEST(Alembic, TransformsIndicesAndOtherTypesAreRead) {
  ForeignArchive foreign;
  using Kind = app::alembic::Kind;
  using Pod = app::alembic::Pod;
  // Two Bezier curves of four control points; a width a curve by index; a colour for all in halves.
  const std::vector<app::alembic::Property> geom{
      foreign.values("P", "geoScope=vtx;interpretation=point", Kind::kArray, Pod::kFloat64, 3,
                     bytes<double>({0, 0, 0, 9, 9, 9, 9, 9, 9, 1, 0, 0, 0, 1, 0, 9, 9, 9, 9, 9, 9, 1, 1, 0})),
      foreign.values("nVertices", "", Kind::kArray, Pod::kInt32, 1, bytes<std::int32_t>({4, 4})),
      foreign.values("curveBasisAndType", "", Kind::kScalar, Pod::kUint8, 4, bytes<std::uint8_t>({0, 0, 1, 1})),
      foreign.compound(
          "width", "geoScope=uni;isGeomParam=true",
          {foreign.values(".vals", "geoScope=uni", Kind::kArray, Pod::kFloat32, 1, bytes<float>({0.5f, 0.25f})),
           foreign.values(".indices", "", Kind::kArray, Pod::kUint32, 1, bytes<std::uint32_t>({1, 0}))}),
      foreign.compound(
          ".arbGeomParams", "",
          {foreign.values("groom_color", "geoScope=con;interpretation=rgb", Kind::kArray, Pod::kFloat16, 3,
                          bytes<std::uint16_t>({0x3c00, 0x3800, 0x0000})),
           foreign.values("groom_guide", "geoScope=con", Kind::kArray, Pod::kInt8, 1, bytes<std::int8_t>({1}))})};
  const std::uint64_t curves =
      foreign.object(foreign.group({foreign.compound(".geom", "schema=AbcGeom_Curve_v2", geom)}), {});
  // Translate, turn about z by 90 degrees, scale: the last is done first.
  const std::vector<app::alembic::Property> xform{
      foreign.values(".ops", "", Kind::kScalar, Pod::kUint8, 3, bytes<std::uint8_t>({0x10, 0x60, 0x00})),
      foreign.values(".vals", "", Kind::kScalar, Pod::kFloat64, 7, bytes<double>({0, 0, 10, 90, 2, 2, 2}))};
  const std::uint64_t placed =
      foreign.object(foreign.group({foreign.compound(".xform", "schema=AbcGeom_Xform_v3", xform)}),
                     {{"strands", "schema=AbcGeom_Curve_v2", curves}});
  foreign.finish(foreign.object(0, {{"placed", "schema=AbcGeom_Xform_v3", placed}}));
  const app::Groom groom = app::readGroom(foreign.file);
  EXPECT_EQ(groom.strand_first, (std::vector<std::uint32_t>{0, 2, 4}));
  EXPECT_LT((groom.points[1] - Eigen::Vector3f(0, 2, 10)).norm(), 1e-6f);
  EXPECT_LT((groom.points[2] - Eigen::Vector3f(-2, 0, 10)).norm(), 1e-6f);
  EXPECT_EQ(groom.widths, (std::vector<float>{0.25f, 0.25f, 0.5f, 0.5f}));
  EXPECT_EQ(groom.colors[3], Eigen::Vector3f(1, 0.5f, 0));
  EXPECT_EQ(groom.guides, (std::vector<std::uint8_t>{1, 1}));
  EXPECT_EQ(app::alembicTimes(test::readAll(foreign.file), foreign.file), std::vector<double>{0});
}

}  // namespace alembic_test

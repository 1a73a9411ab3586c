// `.hair` files: what is written comes back in the same bits, and every fault is named.
#include <gtest/gtest.h>

#include <cstring>

#include "app/files/errors.h"
#include "app/groom/formats/hair_strands_file.h"
#include "app/groom/groom_file.h"
#include "tests/app/groom/groom_samples.h"
#include "tests/app/groom/second_reader.h"

namespace hair_strands_test {

std::string written(const app::Groom& groom) {
  const std::string file = test::freshFolder("hair_strands") + "/groom.hair";
  app::OutputFile output(file);
  app::writeHairStrands(groom, file, output);
  output.commit();
  return test::readAll(file);
}

std::string faultOf(const std::string& bytes) {
  try {
    app::readGroom(bytes, "groom.hair");
  } catch (const app::InputError& fault) {
    return fault.what();
  }
  return "";
}

void put(std::string& bytes, std::size_t at, std::uint32_t value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

TEST(HairStrands, ComesBackInTheSameBits) {
  app::Groom groom = test::sampleGroom(40, 1);
  const app::Groom read = app::readGroom(written(groom), "groom.hair");
  EXPECT_EQ(read.strand_first, groom.strand_first);
  EXPECT_EQ(read.points, groom.points);
  EXPECT_EQ(read.widths, groom.widths);
  EXPECT_EQ(read.colors, groom.colors);
  const std::string file = test::freshFolder("hair_second") + "/groom.hair";
  app::writeFile(file, written(groom));
  const std::string second = test::secondReading(file);
  EXPECT_TRUE(second == test::dumpClip({}, {read})) << second.substr(0, 2000);
  groom.widths.clear();
  groom.colors.clear();
  const app::Groom bare = app::readGroom(written(groom), "groom.hair");
  EXPECT_EQ(bare.points, groom.points);
  EXPECT_TRUE(bare.widths.empty() && bare.colors.empty());
}

TEST(HairStrands, DefaultsOfTheHeaderServeEveryStrand) {
  app::Groom groom = test::sampleGroom(1, 2);
  groom.strand_first = {0, 2};
  groom.points.resize(2);
  groom.widths.clear();
  groom.colors.clear();
  std::string bytes = written(groom);
  bytes.erase(128, 2);  // the one strand's segments
  put(bytes, 12, 2);
  put(bytes, 16, 1);
  const float thickness = 0.25f;
  std::memcpy(bytes.data() + 20, &thickness, sizeof thickness);
  const app::Groom read = app::readGroom(bytes, "groom.hair");
  EXPECT_EQ(read.strand_first, groom.strand_first);
  EXPECT_EQ(read.widths, (std::vector<float>{0.25f, 0.25f}));
}

TEST(HairStrands, FaultsNameFilePlaceAndMend) {
  const std::string whole = written(test::sampleGroom(10, 3));
  EXPECT_EQ(test::lacking(faultOf(whole.substr(0, 100)), "groom.hair: byte 0: the file ends where the 128 bytes"), "");
  EXPECT_EQ(test::lacking(faultOf(whole.substr(0, whole.size() - 1)), "colours of the points"), "");
  std::string bytes = whole;
  const std::string longer = "bytes after what its header counts, so that its arrays may be shifted";
  EXPECT_EQ(test::lacking(faultOf(whole + "x"), "byte " + std::to_string(whole.size()) + ": the file goes on for 1 "),
            "");
  for (const std::size_t at : {std::size_t{128}, std::size_t{150}, whole.size() / 2, whole.size()})
    EXPECT_EQ(test::lacking(faultOf(std::string(whole).insert(at, 4, '\0')), longer), "") << at;
  put(bytes, 4, 11);
  EXPECT_EQ(test::lacking(faultOf(bytes), "export it again"), "");
  bytes = whole;
  put(bytes, 12, 1);
  EXPECT_EQ(test::lacking(faultOf(bytes), "byte 12: the header's flags say that there are no points"), "");
  bytes = whole.substr(0, 128);  // memory is bounded by the file, not by what its header counts
  put(bytes, 4, 30'000'000);
  put(bytes, 8, 30'000'000);
  put(bytes, 12, 2);
  EXPECT_EQ(test::lacking(faultOf(bytes), "the file ends where segments and points of the strands"), "");
  bytes = whole;
  put(bytes, 4, 5'000'000);
  put(bytes, 8, 80'000'000);
  EXPECT_EQ(test::lacking(faultOf(bytes), "2097152 such strands fit"), "");
  bytes = whole;
  put(bytes, 4, 0xffffffff);
  EXPECT_EQ(
      test::lacking(faultOf(bytes), "byte 4: the header counts 4294967295 strands but only "),
      "");
  EXPECT_EQ(test::lacking(faultOf("what is this"), "does not begin with HAIR"), "");
  EXPECT_EQ(test::lacking(faultOf(std::string("\x89HDF\r\n\x1a\n", 8)), "HDF5"), "");
  EXPECT_EQ(test::lacking(faultOf("PXR-USDC0000"), "usdcat"), "");
}

TEST(HairStrands, StrandsThatTheFormatCannotHoldAreNamed) {
  app::Groom groom = test::sampleGroom(3, 4);
  groom.strand_first.push_back(groom.strand_first.back());
  try {
    written(groom);
    FAIL() << "an empty strand was written";
  } catch (const app::OutputError& fault) {
    EXPECT_NE(std::string(fault.what()).find("strand 3 has 0 points"), std::string::npos);
  }
}

}  // namespace hair_strands_test

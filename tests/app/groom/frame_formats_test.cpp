// PLY and TressFX: what is written comes back in the same bits, by the program's readers and by those in Python.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstring>

#include "app/files/errors.h"
#include "app/groom/formats/ply_file.h"
#include "app/groom/formats/tfx_file.h"
#include "app/groom/groom_file.h"
#include "tests/app/groom/groom_samples.h"
#include "tests/app/groom/second_reader.h"

namespace frame_formats_test {

template <class Write>
std::string writtenFile(const std::string& ending, Write&& write) {
  const std::string file = test::freshFolder("frame_formats") + "/groom" + ending;
  app::OutputFile output(file);
  write(output);
  output.commit();
  return file;
}

void expectTheSame(const std::string& file, const app::Groom& groom) {
  const std::string dump = test::dumpClip({}, {groom});
  EXPECT_TRUE(test::dumpClip({}, {app::readGroom(file)}) == dump) << file << " is read back differently";
  const std::string second = test::secondReading(file);
  EXPECT_TRUE(second == dump) << second.substr(0, 2000);
}

std::string faultOf(const std::string& bytes, const std::string& file = "groom.ply") {
  try {
    app::readGroom(bytes, file);
  } catch (const app::InputError& fault) {
    return fault.what();
  }
  return "";
}

app::Groom evenGroom(std::size_t strands, std::size_t points) {
  app::Groom groom = test::sampleGroom(strands * points, 31);
  groom.points.resize(strands * points);
  groom.strand_first = {0};
  groom.colors.resize(strands * points);
  groom.root_uvs.resize(strands);
  groom.widths.clear();
  for (std::size_t s = 0; s < strands; ++s) {
    groom.strand_first.push_back(static_cast<std::uint32_t>((s + 1) * points));
    groom.widths.insert(groom.widths.end(), points, 1e-4f * static_cast<float>(s + 1));
  }
  groom.ids.clear();
  groom.groups.clear();
  groom.guides.clear();
  return groom;
}

TEST(PlyStrands, TextAndBytesComeBackInTheSameBitsByBothReaders) {
  app::Groom groom = test::sampleGroom(50, 21);
  for (const bool text : {false, true}) {
    expectTheSame(writtenFile(".ply", [&](app::OutputFile& output) { app::writePlyStrands(groom, text, output); }),
                  groom);
  }
  groom.strand_first.push_back(groom.strand_first.back());  // a strand without points
  groom.widths.clear();
  groom.colors.clear();
  groom.root_uvs.clear();
  groom.ids.clear();
  groom.groups.clear();
  groom.guides.clear();
  expectTheSame(writtenFile(".ply", [&](app::OutputFile& output) { app::writePlyStrands(groom, true, output); }),
                groom);
}

TEST(PlyStrands, StrandsAreFoundByEdgesListsAndNumbers) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string rows = "0 0 0\n1 0 0\n2 0 0\n0 1 0\n1 1 0\n";
  const std::vector<std::uint32_t> expected{0, 3, 5};
  const app::Groom edges = app::readGroom(
      head + "element edge 3\nproperty int vertex1\nproperty int vertex2\nend_header\n" + rows + "0 1\n2 1\n3 4\n",
      "a.ply");
  EXPECT_EQ(edges.strand_first, expected);
  const app::Groom lists = app::readGroom(
      head + "element polyline 2\nproperty list uchar int vertex_indices\nend_header\n" + rows + "3 2 1 0\n2 3 4\n",
      "a.ply");
  EXPECT_EQ(lists.strand_first, expected);
  EXPECT_EQ(lists.points[0], Eigen::Vector3f(2, 0, 0));
  const app::Groom numbers = app::readGroom(
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
      "property float radius\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
      "property int strand_id\nend_header\n0 0 0 1 255 0 0 7\n1 0 0 1 255 0 0 7\n2 0 0 1 0 0 0 7\n"
      "0 1 0 1 0 0 0 9\n1 1 0 1 0 0 0 9\n",
      "a.ply");
  EXPECT_EQ(numbers.strand_first, expected);
  EXPECT_EQ(numbers.widths[0], 2);
  EXPECT_EQ(numbers.colors[0], Eigen::Vector3f(1, 0, 0));
}

TEST(PlyStrands, FaultsNameTheirPlace) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n";
  EXPECT_NE(faultOf(head + "end_header\n0 0 0\n1 0 0\n").find("tells no strands; write edges"), std::string::npos);
  EXPECT_EQ(test::lacking(
                faultOf(head + "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n0 0 0\n1 0\n"),
                "groom.ply: line 13: the rows end early"),
            "");
  EXPECT_EQ(
      test::lacking(
          faultOf(head + "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n0 0 0\n1 0 0\n0 5\n"),
          "edge 0 joins vertices 0 and 5"),
      "");
  EXPECT_EQ(test::lacking(faultOf("ply\nformat ascii 1.0\nfoo bar\nend_header\n"), "line 3: 'foo'"), "");
  EXPECT_EQ(
      test::lacking(faultOf("ply\nformat ascii 1.0\nelement vertex 99999999999\nproperty float x\nproperty float y\n"
                            "property float z\nend_header\n"),
                    "such strands fit"),
      "");
}

TEST(Tfx, ComesBackInTheSameBitsByBothReaders) {
  for (const std::size_t strands : {1, 6, 33}) {
    app::Groom groom = evenGroom(strands, 16);
    const auto write = [&](app::OutputFile& output) { app::writeTfx(groom, "groom.tfx", output); };
    expectTheSame(writtenFile(".tfx", write), groom);
    groom.colors.clear();
    groom.widths.clear();
    groom.root_uvs.clear();
    expectTheSame(writtenFile(".tfx", write), groom);
  }
}

// What is called .tfx is read as such, for its beginning has no mark: the fault is named.
TEST(Tfx, FaultsOfTheHeaderAreNamed) {
  const std::string whole(160 + 16 * 8, '\0');
  const auto said = [&](std::size_t at, std::uint32_t value) {
    std::string bytes = whole;
    const std::array<std::uint32_t, 4> head{std::bit_cast<std::uint32_t>(4.0f), 2, 4, 160};
    std::memcpy(bytes.data(), head.data(), sizeof head);
    std::memcpy(bytes.data() + at, &value, sizeof value);
    return faultOf(bytes, "hand.tfx");
  };
  EXPECT_EQ(said(0, std::bit_cast<std::uint32_t>(4.0f)), "");
  EXPECT_NE(said(0, 7).find("the header gives no version of TressFX"), std::string::npos) << said(0, 7);
  EXPECT_NE(said(8, 0).find("strands of no points"), std::string::npos) << said(8, 0);
  EXPECT_NE(said(12, 4000).find("positions"), std::string::npos) << said(12, 4000);
}

TEST(Tfx, OtherNumbersOfPointsAreNamed) {
  const auto fault = [](const app::Groom& groom) -> std::string {
    try {
      writtenFile(".tfx", [&](app::OutputFile& output) { app::writeTfx(groom, "groom.tfx", output); });
    } catch (const app::OutputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(test::lacking(fault(evenGroom(3, 12)), "strands of 12 points"), "");
  EXPECT_EQ(test::lacking(fault(test::sampleGroom(9, 5)), "points and the first has"), "");
}

}  // namespace frame_formats_test

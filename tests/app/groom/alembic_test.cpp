// Alembic curves: what is written comes back in the same bits, by the program's reader and by one in Python.
#include <gtest/gtest.h>

#include <cstring>

#include "app/files/errors.h"
#include "app/groom/alembic_file.h"
#include "app/groom/groom_file.h"
#include "tests/app/groom/groom_samples.h"
#include "tests/app/groom/second_reader.h"

namespace {

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
  expectTheSame(swaying(test::sampleGroom(40, 11), 5), {30, 0.5, {0}});
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

}  // namespace

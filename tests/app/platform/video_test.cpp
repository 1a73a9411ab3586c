// Films: written whole where ffmpeg is, refused with the name of the package where it is not.
#include "app/platform/video.h"

#include <gtest/gtest.h>
#include <sys/mount.h>

#include <filesystem>
#include <vector>

#include "app/files/errors.h"
#include "app/files/output_file.h"
#include "tests/run_program.h"

namespace video_test {

TEST(Video, WithoutFfmpegOneMessageNamesThePackage) {
  const std::string file = test::freshFolder("video_without") + "/film.mp4";
  const test::Outcome outcome =
      test::runProgram({"--video", file, "--frames", "1", "--size", "32x32", "--resolution", "low"},
                       "sh -c 'p=$(command -v timeout); shift; PATH=/nowhere; export PATH; exec $p \"$@\"' sh");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  EXPECT_NE(outcome.err.find("apt-get install ffmpeg"), std::string::npos) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(Video, AFilmIsWholeOrNotThere) {
  if (!app::canWriteVideo()) GTEST_SKIP() << "ffmpeg is not installed";
  const std::string folder = test::freshFolder("video"), file = folder + "/film.mp4";
  // An odd size is rounded up.
  const std::vector<unsigned char> grey(4 * 33 * 21, 128);
  {
    app::VideoWriter film(file, 33, 21, 30);
    for (int frame = 0; frame < 12; ++frame) film.add(grey);
    film.finish();
    EXPECT_NE(film.sizeNote().find("34x22, not 33x21"), std::string::npos) << film.sizeNote();
  }
  const std::string bytes = test::readAll(file);
  ASSERT_GT(bytes.size(), 500u);
  EXPECT_EQ(bytes.substr(4, 4), "ftyp");
  {
    app::VideoWriter cut(folder + "/cut.mp4", 33, 21, 30);
    cut.add(grey);
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1) << "a film that was given up is left";
  EXPECT_EQ(app::VideoWriter(folder + "/even.mp4", 32, 22, 30).sizeNote(), "");
  app::VideoWriter odd(folder + "/film.nothing", 33, 21, 30);
  EXPECT_THROW(
      {
        for (int frame = 0; frame < 1000; ++frame) odd.add(grey);
        odd.finish();
      },
      app::OutputError);
}

TEST(Video, ALinkLeadsToTheFilm) {
  if (!app::canWriteVideo()) GTEST_SKIP() << "ffmpeg is not installed";
  const std::string folder = test::freshFolder("video_link");
  std::filesystem::create_directory(folder + "/films");
  std::filesystem::create_symlink("films/kept", folder + "/film.mp4");
  app::VideoWriter film(folder + "/film.mp4", 32, 22, 30);
  for (int frame = 0; frame < 3; ++frame) film.add(std::vector<unsigned char>(4 * 32 * 22, 128));
  film.finish();
  EXPECT_TRUE(std::filesystem::is_symlink(folder + "/film.mp4"));
  EXPECT_EQ(test::readAll(folder + "/films/kept").substr(4, 4), "ftyp");
}

// ffmpeg holds a short film back until its end: only then does the disk turn out to be full.
TEST(Video, AFilmThatTheDiskCannotHoldEndsInAFault) {
  if (!app::canWriteVideo()) GTEST_SKIP() << "ffmpeg is not installed";
  const std::string folder = test::freshFolder("video_full");
  if (::mount("none", folder.c_str(), "tmpfs", 0, "size=4k") != 0) GTEST_SKIP() << "mounting a small disk needs root";
  std::string fault;
  try {
    app::VideoWriter film(folder + "/film.mp4", 320, 240, 30);
    std::vector<unsigned char> noise(4 * 320 * 240);
    for (std::size_t n = 0; n < noise.size(); ++n) noise[n] = static_cast<unsigned char>(n * n / 7);
    film.add(noise);
    film.finish();
  } catch (const app::OutputError& error) {
    fault = error.what();
  }
  EXPECT_NE(fault.find("No space left on device"), std::string::npos) << fault;
  EXPECT_TRUE(std::filesystem::is_empty(folder));
  ::umount2(folder.c_str(), MNT_DETACH);
}

}  // namespace video_test

// The window itself, under a virtual display of the test's own.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "app/files/image_io.h"
#include "tests/run_program.h"

namespace window_test {

// An X server without a screen, on a display number of its own choosing; gone with the test.
class VirtualDisplay {
 public:
  VirtualDisplay() {
    if (std::system("command -v Xvfb >/dev/null 2>&1") != 0) return;
    int ends[2];
    if (pipe(ends) != 0) return;
    process_ = fork();
    if (process_ == 0) {
      const int quiet = open("/dev/null", O_WRONLY);
      dup2(quiet, 2);
      close(ends[0]);
      const std::string descriptor = std::to_string(ends[1]);
      execlp("Xvfb", "Xvfb", "-displayfd", descriptor.c_str(), "-screen", "0", "1600x1000x24", "-nolisten", "tcp",
             nullptr);
      _exit(127);
    }
    close(ends[1]);
    char number[16] = {};
    std::size_t count = 0;
    // The server writes its number when it is ready, or closes the pipe when it could not start.
    while (count + 1 < sizeof number && read(ends[0], number + count, 1) == 1 && number[count] != '\n') ++count;
    number[count] = 0;
    close(ends[0]);
    if (count > 0) name_ = std::string(":") + number;
  }
  ~VirtualDisplay() {
    if (process_ <= 0) return;
    kill(process_, SIGTERM);
    waitpid(process_, nullptr, 0);
  }
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;
  const std::string& name() const { return name_; }

 private:
  pid_t process_ = -1;
  std::string name_;
};

struct Region {
  double mean = 0, deviation = 0;  // of luminance, 0 to 255
};

Region measure(const app::Image& image, int x0, int y0, int x1, int y1) {
  double sum = 0, squares = 0;
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      const unsigned char* p = &image.rgba[4 * (static_cast<std::size_t>(y) * image.width + x)];
      const double value = 0.3 * p[0] + 0.59 * p[1] + 0.11 * p[2];
      sum += value;
      squares += value * value;
    }
  }
  const double count = static_cast<double>(x1 - x0) * (y1 - y0);
  return {sum / count, std::sqrt(std::max(0.0, squares / count - sum / count * (sum / count)))};
}

// Under a sanitizer leaks are left to the headless runs: the drivers of windows keep memory of modules they have
// unloaded.
std::string environmentOf(const VirtualDisplay& display) {
  return "-u WAYLAND_DISPLAY ASAN_OPTIONS=detect_leaks=0 DISPLAY=" + display.name();
}

// Where skin shows between the panels, pixels: its middle across, its highest row.
struct Skin {
  double across = 0, top = 1e9;
};

Skin skinOf(const app::Image& image) {
  Skin skin;
  int count = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 365; x < 970; ++x) {
      const unsigned char* rgba = &image.rgba[4 * (static_cast<std::size_t>(y) * image.width + x)];
      if (rgba[0] <= 110 || rgba[0] <= rgba[2] + 15) continue;
      skin.across += x, skin.top = std::min<double>(skin.top, y), ++count;
    }
  }
  skin.across /= std::max(1, count);
  return skin;
}

TEST(Window, ShowsFigureAndPanels) {
  const VirtualDisplay display;
  if (display.name().empty()) GTEST_SKIP() << "Xvfb is not installed";
  const std::string folder = test::freshFolder("window");
  const std::string with = folder + "/panels.png", without = folder + "/bare.png";
  const std::vector<std::string> common{"--size",    "1280x720", "--frames",     "2",
                                        "--strands", "3000",     "--resolution", "low"};
  for (const bool panels : {true, false}) {
    std::vector<std::string> words = common;
    words.insert(words.end(), {"--screenshot", panels ? with : without});
    if (!panels) words.push_back("--hide-panels");
    const test::Outcome outcome = test::runProgram(words, environmentOf(display));
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  const app::Image shown = app::readPng(with), bare = app::readPng(without);
  ASSERT_EQ(shown.width, 1280);
  ASSERT_EQ(shown.height, 720);
  // The figure: the middle is far from one tone, and panels do not touch it.
  const Region middle = measure(shown, 480, 100, 800, 620);
  EXPECT_GT(middle.deviation, 15);
  // And stands in the middle of what they leave free: sidebar and timings take 360 and 304 pixels, the timeline 75, so
  // the view is moved by 28 and 37, and is 0.9 as high.
  const Skin moved = skinOf(shown), as_it_was = skinOf(bare);
  EXPECT_NEAR(moved.across, 640 + 28 + 0.9 * (as_it_was.across - 640), 4);
  EXPECT_NEAR(moved.top, 360 - 37 + 0.9 * (as_it_was.top - 360), 4);
  // The panels: dark with light text, where the bare picture has its plain backdrop.
  const Region sidebar = measure(shown, 20, 20, 350, 700), timings = measure(shown, 990, 20, 1260, 250);
  EXPECT_LT(sidebar.mean, measure(bare, 20, 20, 350, 700).mean - 20);
  EXPECT_GT(sidebar.deviation, 12);
  EXPECT_GT(timings.deviation, 12);
  EXPECT_LT(measure(bare, 20, 20, 350, 300).deviation, 12);
}

TEST(Window, DrawsTheSameFigureAsTheHeadlessRun) {
  const VirtualDisplay display;
  if (display.name().empty()) GTEST_SKIP() << "Xvfb is not installed";
  const std::string folder = test::freshFolder("window_headless");
  const std::vector<std::string> common{"--size", "320x240",      "--frames", "3",       "--strands",
                                        "800",    "--resolution", "low",      "--style", "short"};
  std::vector<std::string> window = common, headless = common;
  window.insert(window.end(), {"--hide-panels", "--screenshot", folder + "/window.png"});
  headless.insert(headless.end(), {"--headless", "--out", folder});
  ASSERT_EQ(test::runProgram(window, environmentOf(display)).exit_code, 0);
  ASSERT_EQ(test::runProgram(headless).exit_code, 0);
  const app::Image a = app::readPng(folder + "/window.png"), b = app::readPng(folder + "/frame_0002.png");
  ASSERT_EQ(a.rgba.size(), b.rgba.size());
  int different = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) different += std::abs(a.rgba[i] - b.rgba[i]) > 2;
  EXPECT_LT(different, static_cast<int>(a.rgba.size() / 200));
}

// What a window recorded, a run without pictures repeats: its budget went by counted work, its detail by the window's
// small picture.
TEST(Window, RecordsWhatARunWithoutPicturesReplays) {
  const VirtualDisplay display;
  if (display.name().empty()) GTEST_SKIP() << "Xvfb is not installed";
  const std::string file = test::freshFolder("window_record") + "/run.hmr";
  const test::Outcome recorded = test::runProgram(
      {"--size", "160x120", "--frames", "40", "--strands", "100", "--resolution", "medium", "--style", "short",
       "--camera", "0,1.6,5,0,1.5,0", "--budget-ms", "0.02", "--hide-panels", "--record", file},
      environmentOf(display));
  ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
  const test::Outcome replayed = test::runProgram({"--no-images", "--replay", file});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.out << replayed.err;
  EXPECT_NE(replayed.out.find("to the bit"), std::string::npos) << replayed.out;
}

TEST(Window, AnInterruptedRunSaysSoAndWritesItsLastPicture) {
  const VirtualDisplay display;
  if (display.name().empty()) GTEST_SKIP() << "Xvfb is not installed";
  const std::string folder = test::freshFolder("window_interrupted"), picture = folder + "/last.png";
  const std::string interrupt = " sh -c '\"$@\" & while [ ! -s " + folder +
                                "/r.hmr.part ] && kill -0 $!; do sleep 0.1; done; " +
                                "kill -TERM $!; wait $!; test $? = 130' sh";
  const test::Outcome outcome =
      test::runProgram({"--size", "160x120", "--frames", "100000", "--strands", "100", "--resolution", "low", "--style",
                        "short", "--hide-panels", "--screenshot", picture, "--record", folder + "/r.hmr"},
                       environmentOf(display) + interrupt);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("interrupted after "), std::string::npos) << outcome.out;
  EXPECT_EQ(app::readPng(picture).width, 160);
}

TEST(Window, SurvivesBadShaderFolderWithAMessage) {
  const VirtualDisplay display;
  if (display.name().empty()) GTEST_SKIP() << "Xvfb is not installed";
  const std::string folder = test::freshFolder("window_no_shaders");
  std::filesystem::create_directories(folder + "/data/assets");
  std::filesystem::copy(std::string(HAIRMESH_SOURCE_DIR) + "/assets", folder + "/data/assets",
                        std::filesystem::copy_options::recursive);
  const test::Outcome outcome = test::runProgram({"--frames", "1", "--resolution", "low"},
                                                 environmentOf(display) + " HAIRMESH_DATA=" + folder + "/data");
  EXPECT_GT(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("hairmesh: "), std::string::npos);
  EXPECT_NE(outcome.err.find("shader"), std::string::npos) << outcome.err;
}

}  // namespace window_test

// Files that the program writes are whole or not there: on a full disk, over a limit, after Ctrl-C.
#include "app/files/output_file.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mount.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/files/errors.h"
#include "app/files/image_io.h"
#include "app/files/recording.h"
#include "app/files/report_line.h"
#include "tests/run_program.h"

namespace output_file_test {

namespace fs = std::filesystem;
using test::readAll;

TEST(ReportLine, ThreeDigitsHaveNoExponentAboveOne) {
  for (const auto& [value, text] : std::vector<std::pair<double, std::string>>{{0, "0"},
                                                                               {0.01234, "0.0123"},
                                                                               {12.34, "12.3"},
                                                                               {999.4, "999"},
                                                                               {999.6, "1000"},
                                                                               {2183, "2180"},
                                                                               {123456, "123000"},
                                                                               {-4321, "-4320"}})
    EXPECT_EQ(app::threeDigits(value), text);
}

std::vector<std::string> filesIn(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string faultOf(const std::string& file, std::string_view bytes) {
  try {
    app::writeFile(file, bytes);
  } catch (const app::OutputError& fault) {
    return fault.what();
  }
  return "";
}

TEST(OutputFile, ReplacesWhatWasThereAndLeavesNothingBeside) {
  const std::string folder = test::freshFolder("output_file"), file = folder + "/a.txt";
  app::writeFile(file, std::string(100000, 'x'));
  app::writeFile(file, "new");
  EXPECT_EQ(readAll(file), "new");
  EXPECT_EQ(filesIn(folder), std::vector<std::string>{"a.txt"});
}

TEST(OutputFile, WritesWhereALinkLeads) {
  const std::string folder = test::freshFolder("output_link");
  app::writeFile(folder + "/real.txt", "old");
  fs::create_symlink("real.txt", folder + "/link.txt");
  app::writeFile(folder + "/link.txt", "new");
  EXPECT_TRUE(fs::is_symlink(folder + "/link.txt"));
  EXPECT_EQ(readAll(folder + "/real.txt"), "new");
  fs::create_symlink("later.txt", folder + "/first.txt");
  fs::create_symlink("first.txt", folder + "/second.txt");
  app::writeFile(folder + "/second.txt", "there");
  EXPECT_TRUE(fs::is_symlink(folder + "/second.txt"));
  EXPECT_EQ(readAll(folder + "/later.txt"), "there");
}

TEST(OutputFile, WritesIntoAPipeThatALinkLeadsTo) {
  const test::Outcome outcome = test::runProgram(
      {"--no-images", "--frames", "2", "--style", "short", "--resolution", "low", "--report", "/dev/stdout"},
      "sh -c '\"$@\" | cat' sh");
  EXPECT_EQ(outcome.err.find("cannot be written"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("\"frames\""), std::string::npos) << outcome.out;
}

TEST(OutputFile, WithoutACommitTheOldOneStays) {
  const std::string folder = test::freshFolder("output_dropped"), file = folder + "/a.txt";
  app::writeFile(file, "old");
  {
    app::OutputFile output(file);
    output.write("half of the ne");
    output.flush();
    EXPECT_EQ(readAll(file), "old");
  }
  app::checkWritable(file);
  EXPECT_EQ(readAll(file), "old");
  EXPECT_EQ(filesIn(folder), std::vector<std::string>{"a.txt"});
}

TEST(OutputFile, FaultsNameTheFileTheReasonAndTheMend) {
  const std::string folder = test::freshFolder("output_faults");
  EXPECT_NE(faultOf(folder + "/none/a.txt", "x").find("No such file or directory; choose a folder"), std::string::npos);
  EXPECT_NE(faultOf(folder, "x").find(folder + ": cannot be written: Is a directory"), std::string::npos);
  EXPECT_NE(faultOf("/dev/full", "x").find("/dev/full: cannot be written: No space left on device; make room"),
            std::string::npos);
  EXPECT_NE(faultOf(folder + "/" + std::string(300, 'a'), "x").find("choose a shorter name"), std::string::npos);
  EXPECT_EQ(faultOf("/dev/null", "x"), "");
}

// Puts a process under a limit of so many blocks of 512 bytes a file, whose signal would end it: writes beyond it fail
// as on a full disk.
std::string filesUpTo(int blocks) {
  return "sh -c 'ulimit -f " + std::to_string(blocks) + "; exec \"$@\"' sh";
}

TEST(OutputFile, AFileThatDoesNotFitLeavesNothingAndEndsTheRun) {
  const std::string folder = test::freshFolder("output_limit"), report = folder + "/r.json", tape = folder + "/r.hmr";
  for (const std::string option : {"--report", "--record", "--export"}) {
    const test::Outcome outcome = test::runProgram(
        {"--no-images", "--frames", "40", option, folder + "/file" + (option == "--export" ? ".abc" : ""), "--style",
         "short", "--resolution", "low", "--set", "wind_x=1"},
        filesUpTo(option == "--record" ? 1 : 16));
    EXPECT_EQ(outcome.exit_code, app::kExitFault) << option << outcome.err;
    EXPECT_NE(outcome.err.find(": cannot be written: File too large"), std::string::npos) << outcome.err;
    EXPECT_EQ(filesIn(folder), std::vector<std::string>{}) << option;
  }
}

struct SmallDisk {
  std::string folder;
  bool mounted;
  explicit SmallDisk(const char* options)
      : folder(test::freshFolder("small_disk")), mounted(::mount("none", folder.c_str(), "tmpfs", 0, options) == 0) {}
  ~SmallDisk() {
    if (mounted) ::umount2(folder.c_str(), MNT_DETACH);
  }
};

const std::vector<std::string> kPictures{"--headless", "--frames", "6",     "--size",       "160x120", "--strands",
                                         "500",        "--style",  "short", "--resolution", "low"};

std::vector<std::string> with(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

TEST(OutputFile, AFullDiskEndsARunAndTheFramesOnItAreWhole) {
  const SmallDisk disk("size=24k");
  if (!disk.mounted) GTEST_SKIP() << "mounting a small disk needs root";
  const std::string report = test::freshFolder("full_disk") + "/r.json";
  const test::Outcome outcome = test::runProgram(with(kPictures, {"--out", disk.folder, "--report", report}));
  if (outcome.exit_code == app::kExitNoContext) GTEST_SKIP() << outcome.err;
  EXPECT_EQ(outcome.exit_code, app::kExitFault) << outcome.err;
  EXPECT_NE(outcome.err.find("No space left on device; make room"), std::string::npos) << outcome.err;
  const std::vector<std::string> names = filesIn(disk.folder);
  EXPECT_LT(names.size(), 6u);
  for (const std::string& name : names) EXPECT_EQ(app::readPng(disk.folder + "/" + name).width, 160) << name;
  // The frame that could not be written is in the report: it was simulated and drawn.
  EXPECT_EQ(nlohmann::json::parse(readAll(report))["frames"].size(), names.size() + 1);
}

TEST(OutputFile, TwoWritersOfOneNameAreTold) {
  const std::string file = test::freshFolder("two_writers") + "/a.json";
  app::OutputFile one(file);
  app::OutputFile other(file);
  one.write("1");
  one.commit();
  try {
    other.commit();
    ADD_FAILURE() << "the first is lost without a word";
  } catch (const app::OutputError& error) {
    EXPECT_NE(std::string(error.what()).find("written by another run at the same time; give every run a name"),
              std::string::npos)
        << error.what();
  }
}

TEST(OutputFile, APictureThatDoesNotFitLeavesNothingAndEndsTheRun) {
  const std::string out = test::freshFolder("picture_limit");
  const test::Outcome outcome = test::runProgram(with(kPictures, {"--out", out}), filesUpTo(8));
  if (outcome.exit_code == app::kExitNoContext) GTEST_SKIP() << outcome.err;
  EXPECT_EQ(outcome.exit_code, app::kExitFault) << outcome.err;
  EXPECT_NE(outcome.err.find("frame_0000.png: cannot be written: File too large"), std::string::npos) << outcome.err;
  EXPECT_EQ(filesIn(out), std::vector<std::string>{});
}

// A run in a process of its own.
struct Child {
  pid_t pid = 0;
  explicit Child(std::vector<std::string> words) {
    words.insert(words.begin(), HAIRMESH_BINARY);
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    EXPECT_EQ(::posix_spawn(&pid, HAIRMESH_BINARY, nullptr, nullptr, argv.data(), environ), 0);
  }
  bool ended() { return ::waitpid(pid, &status, WNOHANG) == pid; }
  // Waits for `file` to have at least `size` bytes.
  bool waitFor(const std::string& file, std::uintmax_t size) {
    std::error_code ignored;
    for (int tenth = 0; tenth < 1000; ++tenth) {
      if (ended()) return false;
      if (fs::exists(file, ignored) && fs::file_size(file, ignored) >= size) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return false;
  }
  // Twice in a row, as `timeout` does.
  int interrupt(int signal = SIGINT) {
    ::kill(pid, signal);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ::kill(pid, signal);
    ::waitpid(pid, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  int status = 0;
};

TEST(OutputFile, AnInterruptedRunWritesItsReportAndAWholeRecording) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const std::string folder = test::freshFolder("interrupted"), report = folder + "/r.json", tape = folder + "/r.hmr";
    Child run({"--no-images", "--frames", "1000000", "--report", report, "--record", tape, "--style", "short",
               "--resolution", "low"});
    ASSERT_TRUE(run.waitFor(tape + ".part", 8192)) << "the run ended by itself";
    EXPECT_EQ(run.interrupt(signal), app::kExitInterrupted);
    EXPECT_EQ(filesIn(folder), (std::vector<std::string>{"r.hmr", "r.json"}));
    const std::size_t frames = nlohmann::json::parse(readAll(report))["frames"].size();
    EXPECT_GT(frames, 0u);
    const app::Recording recording = app::readRecording(readAll(tape), tape);
    EXPECT_EQ(recording.frames.size(), frames);
    EXPECT_FALSE(recording.state.empty());
  }
}

TEST(OutputFile, FramesOfAnInterruptedRunAreWhole) {
  const std::string folder = test::freshFolder("interrupted_frames"), out = folder + "/frames";
  std::vector<std::string> words = with(kPictures, {"--out", out, "--frames", "100000"});
  Child run(words);
  if (!run.waitFor(out + "/frame_0002.png", 1)) {
    ASSERT_EQ(WEXITSTATUS(run.status), app::kExitNoContext);
    GTEST_SKIP() << "no OpenGL context";
  }
  EXPECT_EQ(run.interrupt(), app::kExitInterrupted);
  const std::vector<std::string> names = filesIn(out);
  EXPECT_GE(names.size(), 3u);
  for (const std::string& name : names) EXPECT_EQ(app::readPng(out + "/" + name).width, 160) << name;
}

TEST(OutputFile, FramesThatALongerRunLeftAreTold) {
  const std::string folder = test::freshFolder("stale"), out = folder + "/frames";
  const test::Outcome whole = test::runProgram(with(kPictures, {"--out", out, "--frames", "4"}));
  if (whole.exit_code == app::kExitNoContext) GTEST_SKIP() << "no OpenGL context";
  EXPECT_EQ(whole.out.find("earlier run"), std::string::npos) << whole.out;
  app::writeFile(out + "/frame_notes.txt", "mine");
  const test::Outcome part = test::runProgram(with(kPictures, {"--out", out, "--frames", "2"}));
  EXPECT_NE(part.out.find("2 frames of an earlier run as well, frame_0002.png to frame_0003.png"), std::string::npos)
      << part.out;
  EXPECT_EQ(filesIn(out).size(), 5u) << "they stay";
}

TEST(OutputFile, LimitedParametersAreToldOnceAndReported) {
  const std::string report = test::freshFolder("limits") + "/r.json";
  const std::vector<std::string> run{"--no-images", "--frames", "3", "--style", "short", "--report", report};
  const test::Outcome usual = test::runProgram(run);
  EXPECT_EQ(usual.err, "");
  EXPECT_TRUE(nlohmann::json::parse(readAll(report))["characters"][0]["limits"].empty());
  const test::Outcome soft = test::runProgram(with(run, {"--set", "stretch_along=100"}));
  EXPECT_EQ(std::count(soft.err.begin(), soft.err.end(), '\n'), 1) << soft.err;
  EXPECT_NE(soft.err.find("stretch_along is set to 100 Pa; used: "), std::string::npos) << soft.err;
  const auto limits = nlohmann::json::parse(readAll(report))["characters"][0]["limits"];
  ASSERT_EQ(limits.size(), 1u);
  EXPECT_EQ(limits[0]["parameter"], "stretch_along");
  EXPECT_GT(limits[0]["used"], limits[0]["set"]);
}

TEST(OutputFile, ARecordingThatWasCutOffSaysSo) {
  const std::string folder = test::freshFolder("cut"), tape = folder + "/r.hmr", cut = folder + "/cut.hmr";
  const std::vector<std::string> run{"--no-images", "--frames", "4", "--style", "short", "--resolution", "low"};
  ASSERT_EQ(test::runProgram(with(run, {"--record", tape})).exit_code, 0);
  const std::string whole = readAll(tape);
  std::size_t end = whole.find('\n', whole.find('\n') + 1);  // of the scene
  end = whole.find('\n', end + 1);                           // of the first frame
  app::writeFile(cut, whole.substr(0, end + 4));
  const test::Outcome within = test::runProgram({"--no-images", "--replay", cut});
  EXPECT_EQ(within.exit_code, app::kExitBadInput);
  EXPECT_NE(within.err.find("line 4: the recording is cut off"), std::string::npos) << within.err;
  app::writeFile(cut, whole.substr(0, end + 1));
  const test::Outcome between = test::runProgram({"--no-images", "--replay", cut});
  EXPECT_EQ(between.exit_code, 0) << between.err;
  EXPECT_NE(between.out.find("replayed 1 frame of a recording that was cut off"), std::string::npos) << between.out;
}

}  // namespace output_file_test

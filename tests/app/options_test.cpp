// The command line: what it means, and what each misuse is answered with.
#include "app/options.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "app/files/errors.h"
#include "app/files/scene_file.h"
#include "tests/run_program.h"

namespace options_test {

using app::Options;
using test::Outcome;
using test::runProgram;

struct Parsed {
  bool go_on;
  int exit_code = 0;
  Options options;
};

Parsed parse(std::vector<std::string> words) {
  words.insert(words.begin(), "hairmesh");
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  Parsed parsed{};
  parsed.go_on = app::parseOptions(static_cast<int>(words.size()), argv.data(), parsed.options, parsed.exit_code);
  return parsed;
}

// One line, with the program's name before it, no more than a person reads.
void expectOneMessage(const Outcome& outcome, int exit_code, const std::string& what) {
  EXPECT_EQ(outcome.exit_code, exit_code) << what << "\n" << outcome.err;
  EXPECT_TRUE(outcome.err.starts_with("hairmesh: ")) << what << ": " << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << what << ": " << outcome.err;
  EXPECT_LT(outcome.err.size(), 1500u) << what;
}

TEST(Options, AreReadAsWritten) {
  const Parsed parsed = parse({"scene.json", "--headless", "--frames",      "12",           "--size",   "320x200",
                               "--out",      "o",          "--set",         "friction=0.5", "--set",    "solver=paper",
                               "--style",    "long",       "--resolution",  "high",         "--speed",  "2.5",
                               "--fps",      "30",         "--strands",     "1000",         "--camera", "1,2,3,0,1,0",
                               "--report",   "r.json",     "--strand-path", "compute",      "--preset", "soft"});
  ASSERT_TRUE(parsed.go_on);
  const Options& o = parsed.options;
  EXPECT_EQ(o.scene, "scene.json");
  EXPECT_TRUE(o.headless && o.frames_given && o.size_given && o.keep_frames);
  EXPECT_EQ(o.frames, 12);
  EXPECT_EQ(o.width, 320);
  EXPECT_EQ(o.height, 200);
  ASSERT_EQ(o.set.size(), 2u);
  EXPECT_EQ(o.set[1], std::make_pair(std::string("solver"), std::string("paper")));
  EXPECT_EQ(o.speed, 2.5);
  EXPECT_EQ(o.strands, 1000);
  EXPECT_EQ(o.camera, "1,2,3,0,1,0");
}

TEST(Options, NothingGivenLeavesAllToTheScene) {
  const Parsed parsed = parse({});
  ASSERT_TRUE(parsed.go_on);
  EXPECT_FALSE(parsed.options.headless || parsed.options.frames_given);
  EXPECT_LT(parsed.options.speed, 0);
  EXPECT_LT(parsed.options.strands, 0);
}

TEST(Options, OverridesReachTheScene) {
  Options options =
      parse({"--style", "long", "--resolution", "low", "--speed", "3", "--strands", "77", "--set", "friction=0.5",
             "--set", "taper=0.9", "--camera", "back", "--loop", "go-on", "--draw-budget-ms", "7"})
          .options;
  const app::Scene scene = app::sceneFromOptions(options);
  ASSERT_EQ(scene.characters.size(), 1u);
  EXPECT_EQ(scene.characters[0].style, app::Style::kLong);
  EXPECT_EQ(scene.characters[0].resolution, app::Resolution::kLow);
  EXPECT_EQ(scene.characters[0].look.strands, 77);
  EXPECT_EQ(scene.characters[0].look.hair.taper, 0.9f);
  EXPECT_EQ(scene.characters[0].loop, app::LoopKind::kGoOn);
  EXPECT_EQ(scene.playback.speed, 3);
  EXPECT_EQ(scene.playback.draw_budget_ms, 7);
  EXPECT_EQ(scene.sim.friction, 0.5);
  EXPECT_EQ(scene.camera.view, "back");
}

TEST(Options, MisuseIsUsageAndSaysSoInOneLine) {
  const std::vector<std::vector<std::string>> misuses{{"--nonsense"},
                                                      {"--frames", "0"},
                                                      {"--frames", "-5"},
                                                      {"--frames", "99999999999999999999"},
                                                      {"--frames", "nan"},
                                                      {"--frames"},
                                                      {"--size", "0x0"},
                                                      {"--size", "1280"},
                                                      {"--size", "1e9x1e9"},
                                                      {"--size", "-1x5"},
                                                      {"--size", "nanxnan"},
                                                      {"--style", "mohawk"},
                                                      {"--resolution", "8k"},
                                                      {"--speed", "-1"},
                                                      {"--speed", "nan"},
                                                      {"--speed", "1e30"},
                                                      {"--draw-budget-ms", "-1"},
                                                      {"--draw-budget-ms", "nan"},
                                                      {"--draw-budget-ms", "5ms"},
                                                      {"--draw-budget-ms", "1e9"},
                                                      {"--no-images", "--frames", "1", "--draw-budget-ms", "5"},
                                                      {"--fps", "0"},
                                                      {"--fps", "inf"},
                                                      {"--strands", "-1"},
                                                      {"--strands", "1e12"},
                                                      {"--strand-path", "x"},
                                                      {"--solver", "x"},
                                                      {"--set", "friction"},
                                                      {"--set", "=1"},
                                                      {"--set", "fricton=1"},
                                                      {"--set", "friction=9"},
                                                      {"--set", "friction=nan"},
                                                      {"--set", "solver=magic"},
                                                      {"--camera", "nowhere"},
                                                      {"--camera", "1,2,3"},
                                                      {"--camera", "1,1,1,1,1,1"},
                                                      {"--camera", "1e300,0,0,0,0,0"},
                                                      {"--parts", "folder"},
                                                      {"--framing", "toe"},
                                                      {"a.json", "b.json"},
                                                      {"--start", "-3"},
                                                      {"--style", "long", "--hair", "x.obj"},
                                                      {"--reverse-faces"},
                                                      {"--no-images", "--screenshot", "s.png"},
                                                      {"--no-images", "--out", "frames"},
                                                      {"--write-hair", "w.txt"},
                                                      {"--replay", "r.hmr", "--set", "friction=0.5"},
                                                      {"--replay", "r.hmr", "--style", "long", "--frames", "9"},
                                                      {"--no-images", "--frames", "1", "--debug", "everything"}};
  for (const auto& words : misuses) {
    std::string all;
    for (const std::string& word : words) all += word + " ";
    expectOneMessage(runProgram(words), app::kExitUsage, all);
  }
}

TEST(Options, AFileThatIsWrittenHasTheEndingOfItsFormat) {
  const std::string folder = test::freshFolder("options_endings");
  for (const auto& [option, name, mend] : {std::array{"--screenshot", "a.jpg", "name it .png"},
                                           {"--screenshot", "png", "name it .png"},
                                           {"--video", "a.mp", "name it .mp4, .webm, .mkv, .mov, .avi or .gif"},
                                           {"--write-hair", "a.txt", "name it .obj"},
                                           {"--cache", "a.bin", "name it .hairmesh"}}) {
    const test::Outcome outcome = runProgram({"--frames", "1", "--size", "64x64", option, folder + "/" + name});
    expectOneMessage(outcome, app::kExitUsage, option);
    EXPECT_NE(outcome.err.find(mend), std::string::npos) << outcome.err;
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST(Options, WhatTheParserCannotReadIsToldInWordsOfOurOwn) {
  for (const auto& [words, expected] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"--resolutoin", "low"}, "there is no option '--resolutoin'; did you mean '--resolution'?"},
           {{"--bogus"}, "there is no option '--bogus'; hairmesh --help lists"},
           {{"--frames"}, "--frames needs a value; write --frames N"},
           {{"--strands", "3", "--strands", "1.5"}, "--strands cannot be '1.5'; write a whole number"},
           {{"a.json", "b.json"}, "'b.json' is one file too many"},
           {{"--replay", "r.hmr", "--set", "bend=0.1"}, "to which --set would do nothing"}}) {
    const Outcome outcome = runProgram(words);
    expectOneMessage(outcome, app::kExitUsage, words[0]);
    EXPECT_NE(outcome.err.find(expected), std::string::npos) << outcome.err;
  }
}

TEST(Options, AMistakeInAValueIsOfTheCommandLineAndNamesItsOption) {
  for (const auto& [option, value] : std::vector<std::pair<std::string, std::string>>{{"--curve", "stiffness=a"},
                                                                                      {"--curve", "stiffness=1,"},
                                                                                      {"--curve", "stiffness="},
                                                                                      {"--curve", "flow=1"},
                                                                                      {"--curve", "=1"},
                                                                                      {"--tie", "sideways"},
                                                                                      {"--tie", "{\"at\": 3}"},
                                                                                      {"--tie", "[{"},
                                                                                      {"--tie", "{\"radius\": 9}"},
                                                                                      {"--compare", "frction=1"},
                                                                                      {"--compare", "friction="},
                                                                                      {"--compare", "friction=0.5,"},
                                                                                      {"--pin", "{"},
                                                                                      {"--pin", "{\"colum\": 1}"},
                                                                                      {"--pin", "3"},
                                                                                      {"--map", "length"},
                                                                                      {"--map", "length="},
                                                                                      {"--map", "lenght=a.png"},
                                                                                      {"--attach", "beanie.obj@"},
                                                                                      {"--attach", "{\"fil\": 1}"},
                                                                                      {"--attach", "[{\"file\": 3}]"},
                                                                                      {"--mends", "--up q"},
                                                                                      {"--video", "film.txt"},
                                                                                      {"--debug", "mesh,"},
                                                                                      {"--export-frames", "9-3"},
                                                                                      {"--set", "friction="},
                                                                                      {"--skip", "sleep=half"},
                                                                                      {"--export", "strands.doc"},
                                                                                      {"--size", "12x"},
                                                                                      {"--camera", "1,2,3,4,5,"}}) {
    std::vector<std::string> words{"--headless", "--frames", "1", option, value};
    if (option == "--mends") words.insert(words.end(), {"--hair", "bob_example.obj"});
    if (option == "--export-frames") words.insert(words.end(), {"--export", "a.abc"});
    const Outcome outcome = runProgram(words);
    expectOneMessage(outcome, app::kExitUsage, option + " " + value);
    EXPECT_NE(outcome.err.find(option), std::string::npos) << value << ": " << outcome.err;
  }
  for (const auto& [option, value] : std::vector<std::pair<std::string, std::string>>{{"--attach", "nothing.obj"},
                                                                                      {"--attach", "nothing@head.obj"},
                                                                                      {"--compare", "nothing"},
                                                                                      {"--preset", "nothing"}}) {
    const Outcome outcome = runProgram({"--headless", "--frames", "1", option, value});
    expectOneMessage(outcome, app::kExitBadInput, option + " " + value);
    EXPECT_TRUE(outcome.err.starts_with(std::string("hairmesh: ") + option)) << outcome.err;
    EXPECT_EQ(outcome.err.find("/0"), std::string::npos) << outcome.err;
  }
}

// A run leaves pictures behind where they are what it was started for.
TEST(Options, FramesAreKeptWhereTheyAreAskedFor) {
  const auto kept = [](const std::vector<std::string>& words) { return parse(words).options.keep_frames; };
  const auto drawn = [](const std::vector<std::string>& words) { return !parse(words).options.no_images; };
  EXPECT_TRUE(kept({"--headless"}));
  EXPECT_TRUE(kept({"--headless", "--replay", "r.take", "--out", "o"}));
  EXPECT_TRUE(kept({"--export", "a.abc", "--out", "o"}) && kept({"--video", "f.mp4", "--out", "o"}));
  EXPECT_FALSE(kept({"--headless", "--replay", "r.take"}) || drawn({"--headless", "--replay", "r.take"}));
  EXPECT_TRUE(drawn({"--headless", "--replay", "r.take", "--gl-debug"})) << "whose calls are checked";
  for (const std::vector<std::string>& picture :
       {std::vector<std::string>{"--video", "f.mp4"}, {"--screenshot", "s.png"}}) {
    std::vector<std::string> words{"--headless", "--replay", "r.take"}, cache{"--cache", "c.hairmesh"};
    words.insert(words.end(), picture.begin(), picture.end());
    cache.insert(cache.end(), picture.begin(), picture.end());
    EXPECT_TRUE(drawn(words) && drawn(cache)) << picture[0];
    EXPECT_FALSE(kept(words) || kept(cache)) << picture[0];
  }
}

// A message names what was given: an option, or the file and the place in it.
TEST(Options, NoMessageNamesAnOptionThatWasNotGiven) {
  const std::string folder = test::freshFolder("named"), scene = folder + "/scene.json", preset = folder + "/mine.json";
  std::ofstream(scene) << R"({"preset": "sofft", "characters": [{"motion": "walk.bvh"}]})";
  std::ofstream(preset) << R"({"sim": {"frction": 1}})";
  const Outcome in_scene = runProgram({scene, "--no-images", "--frames", "1"});
  expectOneMessage(in_scene, app::kExitBadInput, "a preset that a scene names");
  EXPECT_TRUE(in_scene.err.starts_with("hairmesh: " + scene + ": /preset: preset 'sofft'")) << in_scene.err;
  const Outcome opened = runProgram({preset, "--no-images", "--frames", "1"});
  expectOneMessage(opened, app::kExitBadInput, "a preset that is opened");
  EXPECT_TRUE(opened.err.starts_with("hairmesh: " + preset + ": /sim: unknown key 'frction'")) << opened.err;
  const Outcome pin = runProgram({"--no-images", "--frames", "1", "--pin", R"({"column": 9999})"});
  expectOneMessage(pin, app::kExitBadInput, "a column that is not there");
  EXPECT_TRUE(pin.err.starts_with("hairmesh: --pin: /column: is 9999")) << pin.err;
}

TEST(Options, AFileForAnotherOptionIsToldByItsContent) {
  const std::string folder = test::freshFolder("other_kind"), state = folder + "/state.hairmesh";
  ASSERT_EQ(runProgram({"--no-images", "--frames", "1", "--resolution", "low", "--style", "short", "--save-state",
                        state, "--record", folder + "/r.take"})
                .exit_code,
            0);
  std::ofstream(folder + "/words.md") << "# Words\n";
  std::ofstream(folder + "/words.hair") << "# Words\n";
  for (const auto& [words, expected] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"--replay", state}, state + ": is a saved state, no recording; name its scene, and it with --load-state"},
           {{"--replay", HAIRMESH_SOURCE_DIR "/assets/scenes/walk.json"},
            "is a scene, no recording; open it without an option"},
           {{"--replay", folder + "/words.md"}, "words.md: is no recording; give a file that --record wrote"},
           {{"--replay", HAIRMESH_BINARY}, ": is no recording; give a file that --record wrote"},
           {{"--hair", "assets/clips/walk.bvh"}, "is a motion, no hair; give it to --motion"},
           {{"--hair", state}, "is a saved state, no hair"},
           {{"--hair", folder + "/words.hair"},
            "words.hair: does not begin with HAIR, as its name says; write it again"},
           {{"--hair", folder + "/words.md"}, "words.md: holds no hair; give a hair mesh (.obj with groups layer_0"},
           {{folder + "/r.take"}, "is a recording; play it with --replay"}}) {
    std::vector<std::string> all = words;
    all.push_back("--no-images");
    if (words[0] != "--replay") all.insert(all.end(), {"--frames", "1"});
    const Outcome outcome = runProgram(all);
    expectOneMessage(outcome, app::kExitBadInput, words.back());
    EXPECT_NE(outcome.err.find(expected), std::string::npos) << outcome.err;
  }
}

TEST(Options, ARefusedRunLeavesNoFolderBehind) {
  const std::string folder = test::freshFolder("no_folder"), text = folder + "/words.obj";
  std::ofstream(text) << "not a mesh";
  const Outcome outcome = runProgram({"--headless", "--frames", "1", "--out", folder + "/a/b", "--hair", text});
  expectOneMessage(outcome, app::kExitBadInput, "words.obj");
  EXPECT_FALSE(std::filesystem::exists(folder + "/a"));
  EXPECT_TRUE(std::filesystem::exists(text));
}

TEST(Options, WhatARunLeavesUndoneItSays) {
  const Outcome late =
      runProgram({"--no-images", "--frames", "2", "--resolution", "low", "--style", "short", "--start", "99999"});
  EXPECT_EQ(late.exit_code, 0);
  EXPECT_NE(late.err.find("--start 99999 lies beyond the clip's 10 s; it begins at "), std::string::npos) << late.err;
  EXPECT_NE(late.err.find(" s, for the clip goes round"), std::string::npos) << late.err;
  const std::string two = test::freshFolder("late_start") + "/two.json";
  std::ofstream(two) << R"({"characters": [{"resolution": "low"}, {"resolution": "low", "clip_offset": 99}]})";
  const Outcome second = runProgram({two, "--no-images", "--frames", "2"});
  EXPECT_NE(second.err.find("\"clip_offset\" 99 of character 2 lies beyond the clip's 10 s"), std::string::npos)
      << second.err;
  EXPECT_EQ(second.err.find("of character 1"), std::string::npos) << second.err;
  const Outcome hurried =
      runProgram({"--no-images", "--frames", "4", "--resolution", "low", "--style", "short", "--deadline-ms", "1e-5"});
  EXPECT_NE(hurried.out.find("deadline   1e-05 ms: not kept in"), std::string::npos) << hurried.out;
  EXPECT_EQ(runProgram({"--no-images", "--frames", "2", "--resolution", "low"}).out.find("deadline"),
            std::string::npos);
  EXPECT_NE(runProgram({"--help"}).out.find("given twice the last counts"), std::string::npos);
}

// Whatever its name ends in, a groom is told by its content, as --hair tells it.
TEST(Options, AGroomIsToldByItsContent) {
  const std::string folder = test::freshFolder("groom_by_content"), file = folder + "/strands.bin";
  ASSERT_EQ(runProgram({"--no-images", "--frames", "1", "--strands", "300", "--resolution", "low", "--style", "short",
                        "--export", folder + "/strands.ply"})
                .exit_code,
            0);
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::filesystem::rename(entry.path(), file);
    break;
  }
  EXPECT_EQ(app::sceneFromOptions(parse({file}).options).characters[0].hair, file);
}

TEST(Options, FilesThatCannotBeUsedAreBadInput) {
  const std::string folder = test::freshFolder("options");
  std::ofstream(folder + "/empty.json");
  std::ofstream(folder + "/broken.json") << "{ \"characters\": [";
  std::ofstream(folder + "/empty.bvh");
  std::ofstream(folder + "/words.bvh") << "HIERARCHY of needs";
  std::ofstream(folder + "/words.obj") << "not a mesh";
  const std::vector<std::vector<std::string>> misuses{{"missing.json"},
                                                      {folder},
                                                      {folder + "/empty.json"},
                                                      {folder + "/broken.json"},
                                                      {"--motion", "missing.bvh"},
                                                      {"--motion", folder + "/empty.bvh"},
                                                      {"--motion", folder + "/words.bvh"},
                                                      {"--motion", folder},
                                                      {"--hair", "missing.obj"},
                                                      {"--hair", folder + "/words.obj"},
                                                      {"--preset", "missing"},
                                                      {"--clip", "no such clip"}};
  for (std::vector<std::string> words : misuses) {
    const std::string all = words.back();
    words.insert(words.end(), {"--no-images", "--frames", "1"});
    expectOneMessage(runProgram(words), app::kExitBadInput, all);
  }
}

TEST(Options, TheSceneIsNamedAfterAnotherMotion) {
  const auto nameOf = [](std::vector<std::string> words) { return app::sceneFromOptions(parse(words).options).name; };
  const std::string own = nameOf({"assets/scenes/head_shake.json"});
  EXPECT_EQ(nameOf({"--motion", "walk.bvh"}), "walk");
  EXPECT_EQ(nameOf({"assets/scenes/head_shake.json", "--motion", "walk.bvh"}), own + ", with walk");
  EXPECT_NE(nameOf({}), "walk");
}

TEST(Options, ThePapersSettingIsOneWordAndItsPreset) {
  const auto paramsOf = [](const std::vector<std::string>& words) {
    const sim::SimParams params = app::sceneFromOptions(parse(words).options).sim;
    std::string text;
    for (const sim::ParamField& field : sim::paramFields())
      text += std::string(field.name) + "=" + sim::paramText(field, params) + "\n";
    return text;
  };
  const std::string paper = paramsOf({"--solver", "paper"});
  EXPECT_EQ(paper, paramsOf({"--preset", "paper"}));
  EXPECT_EQ(paper, paramsOf({"--solver", "paper", "head_shake.json"}));
  EXPECT_NE(paper, paramsOf({}));
  EXPECT_NE(paper.find("solver=paper\n"), std::string::npos);
  // What is set by name wins, and says no more than it says.
  const sim::SimParams mixed =
      app::sceneFromOptions(parse({"--set", "integrator=bdf2", "--solver", "paper"}).options).sim;
  EXPECT_EQ(mixed.integrator, sim::Integrator::kBdf2);
  const sim::SimParams alone =
      app::sceneFromOptions(parse({"--set", "time_step=0.01", "--set", "solver=paper"}).options).sim;
  EXPECT_EQ(alone.time_step, 0.01);
}

TEST(Options, AMisspeltKeyOfASceneIsToldAsAScenes) {
  const std::string file = test::freshFolder("misspelt") + "/scene.json";
  std::ofstream(file) << R"({"charcters": [{"motion": "walk.bvh"}]})";
  const Outcome outcome = runProgram({file, "--no-images", "--frames", "1"});
  expectOneMessage(outcome, app::kExitBadInput, "charcters");
  EXPECT_NE(outcome.err.find("did you mean 'characters'?"), std::string::npos) << outcome.err;
  const Outcome missing = runProgram({"head_shak.json", "--no-images", "--frames", "1"});
  expectOneMessage(missing, app::kExitBadInput, "head_shak.json");
  EXPECT_NE(missing.err.find("there is no such file; did you mean 'head_shake.json'?"), std::string::npos)
      << missing.err;
  for (const char* option : {"--out", "--report", "--save-state", "--load-state", "--style"})
    expectOneMessage(runProgram({"--headless", "--frames", "1", option, ""}), app::kExitUsage, option);
}

TEST(Options, ChoicesThatAreNoMoreSayWhatTakesTheirPlace) {
  for (const auto& [option, value, now] : std::vector<std::array<std::string, 3>>{
           {"--solver", "warped", "default takes its place"},
           {"--set", "solver=two-level", "default takes its place"},
           {"--set", "integrator=implicit-euler", "linearized-euler takes its place"},
           {"--set", "precision=mixed", "float takes its place"}}) {
    const Outcome outcome = runProgram({option, value, "--no-images", "--frames", "1"});
    expectOneMessage(outcome, app::kExitUsage, value);
    EXPECT_NE(outcome.err.find(now), std::string::npos) << outcome.err;
  }
  const Outcome outcome = runProgram({"--set", "frict=0.2", "--no-images", "--frames", "1"});
  EXPECT_NE(outcome.err.find("did you mean 'friction'?"), std::string::npos) << outcome.err;
}

TEST(Options, AnUnknownPresetIsAnsweredWithThoseThereAre) {
  const Outcome outcome = runProgram({"--preset", "foo", "--no-images", "--frames", "1"});
  expectOneMessage(outcome, app::kExitBadInput, "--preset foo");
  EXPECT_NE(outcome.err.find("'foo': is not there; known are auburn, black"), std::string::npos) << outcome.err;
}

TEST(Options, AFileNamedWithoutAnOptionGoesWhereItsKindBelongs) {
  EXPECT_EQ(app::sceneFromOptions(parse({"trio.json"}).options).characters.size(), 3u);
  const app::Scene walk = app::sceneFromOptions(parse({"walk.bvh"}).options);
  EXPECT_TRUE(walk.characters[0].motion.ends_with("walk.bvh"));
  const app::Scene bob = app::sceneFromOptions(parse({"bob_example.obj"}).options);
  EXPECT_TRUE(bob.characters[0].hair.ends_with("bob_example.obj"));
  const app::Scene soft = app::sceneFromOptions(parse({"soft.json"}).options);
  EXPECT_NE(soft.sim.bend, sim::SimParams{}.bend);
  EXPECT_THROW(app::sceneFromOptions(parse({"walk.bvh", "--motion", "dance.bvh"}).options), app::UsageError);
  EXPECT_THROW(app::sceneFromOptions(parse({"bob_example.obj", "--style", "long"}).options), app::UsageError);
  EXPECT_THROW(app::sceneFromOptions(parse({"README.md"}).options), app::InputError);
}

TEST(Options, TheHairMeshThatIsShownIsWrittenAndShownAgain) {
  const std::string folder = test::freshFolder("write_hair"), file = folder + "/long.obj";
  ASSERT_EQ(runProgram({"--style", "long", "--resolution", "low", "--write-hair", file}).exit_code, app::kExitFine);
  const auto state = [](const std::vector<std::string>& hair) {
    std::vector<std::string> words{"--no-images", "--frames", "3", "--record", "/dev/null"};
    words.insert(words.end(), hair.begin(), hair.end());
    const std::string out = runProgram(words).out;
    return out.substr(out.find("state "), 22);
  };
  const std::string from_file = state({file});
  EXPECT_EQ(from_file.substr(0, 6), "state ");
  EXPECT_EQ(from_file, state({"--style", "long", "--resolution", "low"}));
  EXPECT_NE(from_file, state({"--style", "long", "--resolution", "medium"}));
}

TEST(Options, WhatCannotBeWrittenIsAFaultBeforeTheFirstFrame) {
  const std::vector<std::vector<std::string>> faults{{"--headless", "--out", "/proc/frames"},
                                                     {"--headless", "--screenshot", "/nonexistent/folder/s.png"},
                                                     {"--no-images", "--report", "/nonexistent/folder/r.json"},
                                                     {"--no-images", "--report", "/proc"},
                                                     {"--no-images", "--record", "/nonexistent/folder/r.hmr"}};
  for (std::vector<std::string> words : faults) {
    words.insert(words.end(), {"--frames", "1000000"});
    expectOneMessage(runProgram(words), app::kExitFault, words[1]);
  }
  expectOneMessage(runProgram({"--parameters"}, "sh -c 'exec \"$@\" >/dev/full' sh"), app::kExitFault, "stdout");
}

TEST(Options, HelpNamesEveryOptionAndFitsATerminal) {
  const Outcome help = runProgram({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  for (const char* option : {"--headless", "--frames", "--size", "--out", "--set", "--style", "--resolution", "--hair",
                             "--motion", "--parts", "--speed", "--fps", "--strands", "--camera", "--report",
                             "--strand-path", "--preset", "--solver", "--no-images"}) {
    EXPECT_NE(help.out.find(option), std::string::npos) << option;
  }
}

TEST(Options, WithoutADisplayTheWindowSaysWhatToDo) {
  const Outcome outcome = runProgram({"--frames", "1"}, "-u DISPLAY -u WAYLAND_DISPLAY");
  expectOneMessage(outcome, app::kExitNoContext, "no display");
  EXPECT_NE(outcome.err.find("--headless"), std::string::npos);
}

TEST(Options, WithoutADisplayAReplayIsCheckedAllTheSame) {
  const std::string folder = test::freshFolder("options_replay"), file = folder + "/run.hmr";
  ASSERT_EQ(runProgram({"--no-images", "--frames", "4", "--style", "short", "--resolution", "low", "--record", file})
                .exit_code,
            0);
  const Outcome outcome = runProgram({"--replay", file}, "-u DISPLAY -u WAYLAND_DISPLAY");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("replaying without one"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("the state is the recorded one to the bit"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("replayed without pictures"), std::string::npos) << outcome.out;
}

TEST(Options, AMisspeltPresetIsAnsweredWithTheNearest) {
  const Outcome outcome = runProgram({"--no-images", "--frames", "1", "--preset", "blnd"});
  EXPECT_EQ(outcome.exit_code, app::kExitBadInput);
  EXPECT_NE(outcome.err.find("did you mean 'blond'?"), std::string::npos) << outcome.err;
}

}  // namespace options_test

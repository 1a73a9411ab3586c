// The house holds: who may include whom, how long a file may be, and names that say nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace structure_test {

namespace fs = std::filesystem;

std::vector<fs::path> sources(const std::vector<std::string>& folders) {
  std::vector<fs::path> files;
  for (const std::string& folder : folders) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(HAIRMESH_SOURCE_DIR) / folder)) {
      const std::string ending = entry.path().extension().string();
      if (ending == ".cpp" || ending == ".h") files.push_back(entry.path());
    }
  }
  EXPECT_FALSE(files.empty()) << "no sources are found";
  return files;
}

std::vector<std::string> lines(const fs::path& file) {
  std::ifstream stream(file);
  std::vector<std::string> all;
  for (std::string line; std::getline(stream, line);) all.push_back(line);
  return all;
}

// Lines of `folder` that include what `forbidden` matches.
std::string includesOf(const std::string& folder, const std::string& forbidden) {
  const std::regex pattern("^\\s*#\\s*include\\s*[<\"](" + forbidden + ")");
  std::string found;
  for (const fs::path& file : sources({folder})) {
    for (const std::string& line : lines(file)) {
      if (std::regex_search(line, pattern)) found += file.filename().string() + ": " + line + "\n";
    }
  }
  return found;
}

TEST(Structure, TheSimulatorKnowsNoPictureNoFileAndNoClock) {
  EXPECT_EQ(includesOf("sim",
                       "render/|app/|GL/|GLFW|EGL|imgui|assimp|nlohmann|CLI|fstream|filesystem|chrono|random|iostream"),
            "");
}

// Mesh below linear below forces: what solves knows no contact, and what pulls knows no stabilization.
TEST(Structure, RoomsOfTheSimulatorStandOnThoseBelow) {
  EXPECT_EQ(includesOf("sim/mesh", "sim/(linear|forces|contact|stabilization)/"), "");
  EXPECT_EQ(includesOf("sim/linear", "sim/(forces|contact|stabilization)/"), "");
  EXPECT_EQ(includesOf("sim/forces", "sim/(stabilization)/"), "");
  EXPECT_EQ(includesOf("sim/contact", "sim/(stabilization)/"), "");
}

TEST(Structure, TheRendererKnowsNoSimulatorAndNoProgram) {
  EXPECT_EQ(includesOf("render", "sim/|app/|GLFW|EGL|imgui|assimp|nlohmann|CLI"), "");
}

// Strands are grown without OpenGL: of the renderer they know its plain values alone.
TEST(Structure, StrandsAreGrownWithoutOpenGl) {
  EXPECT_EQ(includesOf("render/strands", "GL/|render/(?!strands/|frame_input\\.h)|shaders/(?!shared\\.h)"), "");
}

// OpenGL and light below bodies and hair, those below what draws strands from buffers; passes, stage and renderer above
// them all.
TEST(Structure, RoomsOfTheRendererStandOnThoseBelow) {
  EXPECT_EQ(includesOf("render/gl", "render/(?!gl/|frame_input\\.h|frame_report\\.h|reload\\.h)"), "");
  EXPECT_EQ(includesOf("render/light", "render/(?!light/|strands/|frame_input\\.h|view_math\\.h)"), "");
  EXPECT_EQ(includesOf("render/body", "render/(?!body/|gl/|frame_input\\.h|view_math\\.h)"), "");
  EXPECT_EQ(includesOf("render/hair",
                       "render/(?!(hair|gl|light|strands)/|frame_(input|report)\\.h|(plan_input|view_math)\\.h)"),
            "");
  for (const char* room : {"render/grown", "render/software"})
    EXPECT_EQ(includesOf(room, "render/(renderer|passes|pass|pass_entry)\\.h"), "") << room;
}

TEST(Structure, SimulatorAndRendererMeetOnlyWhereTheyShould) {
  // Files of app that include both rooms' doors: the hand-over, the demo and its parts, the tables over both, and
  // what fits hair meshes to strands.
  const std::vector<std::string> allowed{"sim_to_render", "demo",       "actor",      "debug_views", "frame_stats",
                                         "look_params",   "scene_file", "camera",     "presets",     "render_faces",
                                         "objects",       "growth_map", "grown_groom"};
  for (const fs::path& file : sources({"app"})) {
    bool sim = false, render = false;
    for (const std::string& line : lines(file)) {
      sim = sim || line.starts_with("#include \"sim/step.h\"") || line.starts_with("#include \"sim/mesh/hair_mesh.h\"");
      render = render || line.starts_with("#include \"render/");
    }
    if (!sim || !render) continue;
    EXPECT_NE(std::find(allowed.begin(), allowed.end(), file.stem().string()), allowed.end()) << file;
  }
}

TEST(Structure, PanelsCallNoOpenGl) {
  const std::regex call("#include <(GL|GLFW|EGL)|\\bgl[A-Z][a-zA-Z]+\\(");
  for (const fs::path& file : sources({"app"})) {
    if (file.parent_path().filename() != "ui") continue;
    for (const std::string& line : lines(file)) {
      EXPECT_FALSE(std::regex_search(line, call)) << file << ": " << line;
    }
  }
}

TEST(Structure, NoFileIsLongerThanFiveHundredLines) {
  for (const fs::path& file : sources({"sim", "render", "app", "tests"})) {
    EXPECT_LE(lines(file).size(), 500u) << file;
  }
}

TEST(Structure, TheSimulatorHasAtMostElevenThousandLines) {
  std::size_t all = 0;
  for (const fs::path& file : sources({"sim"})) all += lines(file).size();
  EXPECT_LE(all, 11000u);
}

struct Function {
  std::string head;
  std::size_t lines = 0;
  bool table = false;  // all of it after the first lines is one list that it returns
  std::string text;
};

// Functions of a file in this project's format: each ends with a brace where its first line begins.
std::vector<Function> functionsOf(const fs::path& file) {
  const std::regex type("^ *(namespace|struct|class|enum|union)\\b.*");
  std::vector<Function> functions;
  const std::vector<std::string> text = lines(file);
  for (const std::string indent : {"", "  "}) {
    std::size_t first = text.size();
    for (std::size_t n = 0; n < text.size(); ++n) {
      const bool here = text[n].starts_with(indent) && text[n].size() > indent.size() && text[n][indent.size()] != ' ';
      if (!here) continue;
      if (text[n] == indent + "}" && first < n && text[first].find('(') != std::string::npos &&
          !std::regex_match(text[first], type)) {
        functions.push_back({text[first], n - first + 1, text[n - 1] == indent + "  };", ""});
        for (std::size_t line = first; line <= n; ++line) functions.back().text += text[line] + "\n";
      }
      first = n;
    }
  }
  return functions;
}

TEST(Structure, NoFunctionIsLongerThanSixtyLinesOutsideOfTables) {
  std::size_t found = 0;
  for (const fs::path& file : sources({"app", "tests", "sim", "render"})) {
    for (const Function& function : functionsOf(file)) {
      ++found;
      EXPECT_TRUE(function.lines <= 60 || function.table) << file << ": " << function.lines << ": " << function.head;
    }
  }
  EXPECT_GT(found, 1000u) << "functions are not recognized";
}

bool hasAny(const std::string& text, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(),
                     [&](const char* word) { return text.find(word) != std::string::npos; });
}

// The words of a text that are followed by an opening bracket.
std::set<std::string> calledIn(const std::string& text) {
  static const std::regex call("(\\w+)(<\\w+>)?\\(");
  std::set<std::string> words;
  for (auto at = std::sregex_iterator(text.begin(), text.end(), call); at != std::sregex_iterator(); ++at)
    words.insert((*at)[1]);
  return words;
}

// A test asserts, itself or in what it calls, or has Crash in its name.
TEST(Structure, ATestWithoutAnAssertionSaysThatItLooksForACrashOnly) {
  struct Body {
    std::string head;
    std::set<std::string> calls;
    bool asserts;
  };
  const std::regex macro("\\b(EXPECT|ASSERT)_|\\b(ADD_)?FAIL(URE)?\\("), name("(\\w+)\\(");
  std::vector<Body> bodies;
  for (const fs::path& file : sources({"tests"})) {
    for (const Function& function : functionsOf(file))
      bodies.push_back({function.head, calledIn(function.text.substr(function.head.size())),
                        std::regex_search(function.text, macro)});
  }
  std::set<std::string> asserting;  // functions that tests call
  for (bool grown = true; grown;) {
    grown = false;
    for (Body& body : bodies) {
      body.asserts =
          body.asserts || std::ranges::any_of(body.calls, [&](const auto& word) { return asserting.contains(word); });
      std::smatch match;
      if (body.asserts && !body.head.starts_with("TEST") && std::regex_search(body.head, match, name))
        grown = asserting.insert(match[1]).second || grown;
    }
  }
  std::size_t tests = 0;
  for (const Body& body : bodies) {
    if (!body.head.starts_with("TEST")) continue;
    ++tests;
    EXPECT_TRUE(body.asserts || hasAny(body.head, {"Crash"})) << body.head;
  }
  EXPECT_GT(tests, 300u) << "tests are not recognized";
}

TEST(Structure, NamesSayWhatThingsAre) {
  for (const fs::path& file : sources({"sim", "render", "app"})) {
    EXPECT_FALSE(hasAny(file.stem().string(), {"manager", "util", "helper"})) << file;
    for (const std::string& line : lines(file)) {
      const bool names_a_type = line.starts_with("class ") || line.starts_with("struct ");
      EXPECT_FALSE(names_a_type && hasAny(line, {"Manager", "Util", "Helper"})) << file << ": " << line;
      EXPECT_FALSE(hasAny(line, {"shared_ptr<", "TODO", "#ifdef HEADLESS"})) << file << ": " << line;
    }
  }
}

// Names of constants at a file's outermost level.
std::set<std::string> constantsOf(const fs::path& file) {
  static const std::regex declared("^(inline )?const(expr)? [^=(]*"), named("\\b(k[A-Z]\\w*)(\\[[^\\]]*\\])? ?[={]");
  std::set<std::string> names;
  for (const std::string& line : lines(file)) {
    if (!std::regex_search(line, declared)) continue;
    for (std::sregex_iterator at(line.begin(), line.end(), named), end; at != end; ++at) names.insert((*at)[1]);
  }
  return names;
}

// Files of a folder are compiled as one: a constant of a file hides that of a header from all files after it.
TEST(Structure, NoFilesConstantHidesOneOfAHeaderBesideIt) {
  std::set<std::string> in_headers;
  for (const fs::path& file : sources({"sim", "render", "app", "tests"})) {
    if (file.extension() != ".h") continue;
    for (const std::string& name : constantsOf(file)) in_headers.insert(file.parent_path().string() + "/" + name);
  }
  EXPECT_GT(in_headers.size(), 100u);
  for (const fs::path& file : sources({"sim", "render", "app", "tests"})) {
    if (file.extension() != ".cpp") continue;
    for (const std::string& name : constantsOf(file))
      EXPECT_FALSE(in_headers.contains(file.parent_path().string() + "/" + name)) << file << ": " << name;
  }
}

TEST(Structure, NoVirtualClasses) {
  for (const fs::path& file : sources({"sim", "render", "app"})) {
    for (const std::string& line : lines(file)) EXPECT_FALSE(line.starts_with("  virtual ")) << file << ": " << line;
  }
}

// Names of parameterized tests are words: no bytes of a structure, no bare number. As every built program lists them.
TEST(Structure, TestNamesAreWords) {
  const std::regex bytes("-byte object|^ +[^ ]*/[0-9]+( |$)");
  std::istringstream programs(HAIRMESH_TEST_PROGRAMS);
  std::size_t found = 0;
  for (std::string program; std::getline(programs, program, ':');) {
    if (!fs::exists(program)) continue;  // a part of the tests can be built alone
    FILE* pipe = popen(("'" + program + "' --gtest_list_tests").c_str(), "r");
    ASSERT_NE(pipe, nullptr);
    for (char text[1024]; std::fgets(text, sizeof text, pipe);) {
      const std::string line(text, std::string(text).find_last_not_of('\n') + 1);
      ++found;
      EXPECT_FALSE(std::regex_search(line, bytes)) << program << ": " << line;
    }
    EXPECT_EQ(pclose(pipe), 0) << program;
  }
  EXPECT_GT(found, 5u);
}

}  // namespace structure_test

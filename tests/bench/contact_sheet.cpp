#include "tests/bench/contact_sheet.h"

#include <array>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "app/files/data_path.h"
#include "app/files/image_io.h"
#include "app/platform/egl_context.h"
#include "app/scene/demo.h"
#include "tests/bench/scene_times.h"
#include "tests/bench/written_files.h"

namespace bench {
namespace {

constexpr int kOversampling = 2;
constexpr std::array<const char*, 4> kViews{"front", "side", "back", "top"};
constexpr std::array<const char*, 8> kHairdos{"pixie",     "bob_fringe", "shoulder_layers", "long_straight",
                                              "long_wavy", "curly",      "pony_tail",       "plaits"};
constexpr std::array<double, 3> kMoments{1.2, 2.6, 4.1};  // s into the motion

app::Scene sceneOf(app::Style style, app::Resolution resolution, const std::string& motion, int strands) {
  app::Scene scene = app::loadScene(app::dataPath("assets/scenes/default.json"));
  app::CharacterSpec& spec = scene.characters.front();
  spec.motion = app::findFile(motion, "", "clips");
  spec.clip.clear();
  spec.style = style;
  spec.resolution = resolution;
  spec.hair.clear();
  spec.clip_offset = 0;
  spec.look.strands = strands;
  scene.characters.resize(1);
  scene.camera = app::CameraSpec{};
  scene.camera.framing = style == app::Style::kLong ? "bust" : "head";
  return scene;
}

// Averages the oversampled picture into a cell of the sheet.
void place(const std::vector<unsigned char>& picture, int column, int row, const app::Image& cell, app::Image& sheet) {
  const int wide = cell.width * kOversampling;
  for (int y = 0; y < cell.height; ++y) {
    for (int x = 0; x < cell.width; ++x) {
      for (int channel = 0; channel < 4; ++channel) {
        int sum = 0;
        for (int j = 0; j < kOversampling; ++j) {
          for (int i = 0; i < kOversampling; ++i) {
            sum +=
                picture[4 * (static_cast<std::size_t>(y * kOversampling + j) * wide + x * kOversampling + i) + channel];
          }
        }
        const std::size_t at = static_cast<std::size_t>(row * cell.height + y) * sheet.width + column * cell.width + x;
        sheet.rgba[4 * at + channel] = static_cast<unsigned char>(sum / (kOversampling * kOversampling));
      }
    }
  }
}

struct Drawing {
  app::EglContext context;
  render::Renderer renderer{app::dataPath("shaders")};
  app::Image cell;
  std::vector<unsigned char> pixels;
  app::FrameTarget target;

  explicit Drawing(int cell_height) {
    cell.height = cell_height;
    cell.width = cell.height * 4 / 5;
    target.renderer = &renderer;
    target.width = cell.width * kOversampling;
    target.height = cell.height * kOversampling;
    target.pixels = &pixels;
  }
  double aspect() const { return static_cast<double>(cell.width) / cell.height; }
};

app::Image emptySheet(const app::Image& cell, int columns, int rows) {
  app::Image sheet;
  sheet.width = columns * cell.width;
  sheet.height = rows * cell.height;
  sheet.rgba.assign(4 * static_cast<std::size_t>(sheet.width) * sheet.height, 255);
  return sheet;
}

void writeSheet(const std::string& folder, const std::string& name, const app::Image& sheet) {
  const std::string file = (std::filesystem::path(folder) / (name + ".png")).string();
  app::writePng(file, sheet.width, sheet.height, sheet.rgba);
  std::printf("%s\n", file.c_str());
}

// A style at rest from all sides, then in motion; a row a resolution.
void drawStyle(app::Style style, const SheetOptions& options, Drawing& drawing) {
  app::Image sheet = emptySheet(drawing.cell, static_cast<int>(kViews.size() + kMoments.size()), 3);
  int row = 0;
  for (const app::Resolution resolution : {app::Resolution::kLow, app::Resolution::kMedium, app::Resolution::kHigh}) {
    int column = 0;
    app::Demo rest = app::openScene(sceneOf(style, resolution, "idle_turns.bvh", options.strands), drawing.aspect());
    for (const char* view : kViews) {
      rest.requests.push_back({app::Ask::kView, view, "", 0});
      app::advanceFrame(rest, 0, drawing.target);
      place(drawing.pixels, column++, row, drawing.cell, sheet);
    }
    app::Demo moving = app::openScene(sceneOf(style, resolution, options.motion, options.strands), drawing.aspect());
    double time = 0;
    for (const double moment : kMoments) {
      for (; time + 1.5 * kFrame < moment; time += kFrame) app::advanceFrame(moving, kFrame, {});
      app::advanceFrame(moving, kFrame, drawing.target);
      time += kFrame;
      place(drawing.pixels, column++, row, drawing.cell, sheet);
    }
    ++row;
  }
  writeSheet(options.folder, "styles_" + std::string(app::styleName(style)), sheet);
}

// The shipped hairdos, a column each, from before and from behind.
void drawHairdos(const SheetOptions& options, Drawing& drawing) {
  app::Image sheet = emptySheet(drawing.cell, static_cast<int>(kHairdos.size()), 2);
  int column = 0;
  for (const char* name : kHairdos) {
    app::Scene scene = app::loadScene(app::dataPath(std::string("assets/scenes/") + name + ".json"));
    const app::CharacterSpec& worn = scene.characters.front();
    const bool hangs = worn.style == app::Style::kLong && worn.ties.empty() && worn.maps.length.empty();
    scene.camera.framing = hangs ? "bust" : "head";
    scene.characters.front().look.strands = options.strands;
    app::Demo demo = app::openScene(std::move(scene), drawing.aspect());
    int row = 0;
    for (const char* view : {"three-quarter", "back"}) {
      demo.requests.push_back({app::Ask::kView, view, "", 0});
      app::advanceFrame(demo, 0, drawing.target);
      place(drawing.pixels, column, row++, drawing.cell, sheet);
    }
    ++column;
  }
  writeSheet(options.folder, "hairdos", sheet);
}

// A bun, a plaited bun and two buns, from the side or obliquely, and from behind.
void drawBuns(const SheetOptions& options, Drawing& drawing) {
  constexpr std::array<std::array<const char*, 2>, 3> kBuns{
      {{"bun", "side"}, {R"({"bun": true, "braided": true})", "side"}, {"buns", "three-quarter"}}};
  app::Image sheet = emptySheet(drawing.cell, 2 * static_cast<int>(kBuns.size()), 1);
  int column = 0;
  for (const auto& [ties, view] : kBuns) {
    app::Scene scene = app::loadScene(app::dataPath("assets/scenes/bun.json"));
    scene.camera.framing = "head";
    scene.characters.front().ties = app::tiesFromText(ties);
    scene.characters.front().look.strands = options.strands;
    app::Demo demo = app::openScene(std::move(scene), drawing.aspect());
    for (const char* from : {view, "back"}) {
      demo.requests.push_back({app::Ask::kView, from, "", 0});
      app::advanceFrame(demo, 0, drawing.target);
      place(drawing.pixels, column++, 0, drawing.cell, sheet);
    }
  }
  writeSheet(options.folder, "buns", sheet);
}

}  // namespace

void drawContactSheets(const SheetOptions& options) {
  makeFolder(options.folder, "choose another with --contact-sheet");
  Drawing drawing(options.cell_height);
  for (const app::Style style : {app::Style::kShort, app::Style::kShoulder, app::Style::kLong})
    drawStyle(style, options, drawing);
  drawHairdos(options, drawing);
  drawBuns(options, drawing);
}

}  // namespace bench

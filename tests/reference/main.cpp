// hairmesh-reference: the renderer's light on hair against a path tracer's, over the strands that the renderer grows,
// with its lobes, lights and camera. Prints tables of errors; see docs/picture.md.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include "app/files/errors.h"
#include "app/files/image_io.h"
#include "app/options.h"
#include "app/platform/egl_context.h"
#include "app/run_main.h"
#include "app/scene/demo.h"
#include "tests/bench/measured_part.h"
#include "tests/bench/table.h"
#include "tests/reference/drawn.h"
#include "tests/reference/trace.h"

namespace {

using Eigen::Vector3f;

struct Asked {
  reference::TraceOptions trace;
  int hairs = 40000;
  std::vector<std::string> styles{"short", "shoulder", "long"}, colours{"black", "brown", "blond", "white"},
      moved_colours{"brown"};
  std::string scene, pictures, document, camera = "three-quarter";
  std::vector<std::string> sets;
  bool moved = false;  // each style once more in motion
};

constexpr double kMovedTime = 2.0;   // s into the clip: the head, at its fastest shake, turns round
constexpr double kFrame = 1.0 / 60;  // s

struct Colour {
  const char* name;
  float eumelanin, pheomelanin;
};
constexpr Colour kColours[] = {{"black", 4, 0.3f}, {"brown", 1.1f, 0.35f}, {"blond", 0.28f, 0.22f}, {"white", 0, 0}};

app::Demo openStyle(const std::string& style, bool moved, const Asked& asked) {
  app::Options options;
  if (moved && asked.scene.empty()) options.motion = "head_shake.bvh";
  (asked.scene.empty() ? options.style : options.scene) = style;
  options.framing = asked.scene.empty() ? "head" : "bust";
  options.camera = asked.camera;
  for (const std::string& set : asked.sets) {
    const std::size_t equals = set.find('=');
    if (equals == std::string::npos) throw app::UsageError("--set takes NAME=VALUE, not '" + set + "'");
    options.set.emplace_back(set.substr(0, equals), set.substr(equals + 1));
  }
  app::Scene scene = app::sceneFromOptions(options);
  // One colour for all strands, as the tracer has.
  render::HairLook& hair = scene.characters.front().look.hair;
  hair.tint_variation = hair.root_darkening = hair.shine_variation = 0;
  app::Demo demo = app::openScene(std::move(scene), static_cast<double>(asked.trace.width) / asked.trace.height);
  app::advanceFrame(demo, 0, {});
  for (double time = 0; moved && time < kMovedTime - 0.5 * kFrame; time += kFrame) app::advanceFrame(demo, kFrame, {});
  return demo;
}

// Real hairs' strands: as many as are traced, each as wide as those that it stands for.
reference::TracedScene tracedScene(const render::FrameInput& frame, int hairs) {
  render::HairInput input = frame.hairs.front();
  const float radius = input.look.strand_radius * input.look.strands_represented / static_cast<float>(hairs);
  input.strands = hairs;
  const auto strands = strand_capture::capture(input, std::string(HAIRMESH_SOURCE_DIR) + "/shaders");
  return {strands, radius, input.look.taper, frame.bodies};
}

// Both pictures side by side, traced first, with one exposure.
void writePictures(const std::string& file, const std::vector<reference::TracedPixel>& traced,
                   const std::vector<Vector3f>& full, const Asked& asked, float brightest) {
  const int width = asked.trace.width, height = asked.trace.height;
  std::vector<unsigned char> rgba(static_cast<std::size_t>(2 * width * height) * 4, 255);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < 2 * width; ++x) {
      const auto at = static_cast<std::size_t>(y * width + x % width);
      const Vector3f value = x < width ? Vector3f(traced[at].cover * traced[at].full) : full[at];
      for (int c = 0; c < 3; ++c) {
        const float shown = std::pow(std::clamp(value[c] / brightest, 0.0f, 1.0f), 1 / 2.2f);
        rgba[4 * static_cast<std::size_t>(y * 2 * width + x) + static_cast<std::size_t>(c)] =
            static_cast<unsigned char>(std::lround(255 * shown));
      }
    }
  }
  app::writePng(file, 2 * width, height, rgba);
}

// Radiance that all but one in two hundred pixels stay below.
float brightestOf(const std::vector<reference::TracedPixel>& traced) {
  std::vector<float> values;
  for (const reference::TracedPixel& pixel : traced) values.push_back(pixel.full.maxCoeff());
  const auto at = values.begin() + static_cast<long>(values.size() * 199 / 200);
  std::nth_element(values.begin(), at, values.end());
  return std::max(2 * *at, 1e-4f);
}

// The lights of the tables: key, key from where the rim light stands, fill, rim.
std::array<Vector3f, 4> lightsOf(const render::LightInput& light) {
  const Vector3f rim = render::directionOr(light.to_rim, -Vector3f::UnitZ());
  return {render::directionOr(light.to_light, Vector3f::UnitY()), rim,
          render::directionOr(light.to_fill, Vector3f::UnitX()), rim};
}

// Cover and shadows of a frame as they are drawn, by the lights of lightsOf.
std::vector<reference::DrawnPixel> drawnShadows(render::FrameInput frame, const reference::DrawOptions& draw) {
  using reference::drawTerm, reference::Term;
  std::vector<reference::DrawnPixel> pixels(static_cast<std::size_t>(draw.width * draw.height));
  const auto cover = drawTerm(frame, Term::kCover, draw);
  const auto hair = drawTerm(frame, Term::kShadow, draw), skin = drawTerm(frame, Term::kSkinShadow, draw);
  frame.light.to_light = frame.light.to_rim;
  const auto hair_behind = drawTerm(frame, Term::kShadow, draw), skin_behind = drawTerm(frame, Term::kSkinShadow, draw);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    pixels[i].cover = cover[i].x();
    pixels[i].skin = cover[i].y();
    pixels[i].lit << hair[i].x(), hair_behind[i].x(), hair[i].tail<2>();
    pixels[i].skin_lit << skin[i].x(), skin_behind[i].x(), skin[i].tail<2>();
  }
  return pixels;
}

constexpr std::array kLightNames{"key", "key from behind", "fill", "rim"};  // of lightsOf

// Everything that is measured, a row a view, a light of one, or a colour of one.
struct Tables {
  bench::Table views{{"style", "cover, drawn over traced", "its RMS"}, {}};
  bench::Table leaks{{"style", "on", "light", "mean, %", "over 1 %, % of the pixels", "pixels"}, {}};
  bench::Table colours{{"style", "colour", "light", "single R", "single G", "single B", "all R", "all G", "all B",
                        "RMS over mean", "traced mean's error"},
                       {}};
  Tables() {
    for (const char* light : kLightNames) views.head.push_back(std::string("shadow's RMS, ") + light);
    for (const char* light : kLightNames) views.head.push_back(std::string("mean difference, ") + light);
  }
};

void addView(const std::string& name, const reference::CoverError& cover, const reference::ShadowError& shadow,
             Tables& tables) {
  std::vector<std::string> row{name, bench::formatted("%.3f", cover.ratio), bench::formatted("%.3f", cover.rms)};
  for (const float rms : shadow.rms) row.push_back(bench::formatted("%.3f", rms));
  for (const float bias : shadow.bias) row.push_back(bench::formatted("%+.3f", bias));
  tables.views.rows.push_back(std::move(row));
}

void addLeaks(const std::string& name, const char* on, const reference::Leaks& leaks, Tables& tables) {
  for (int k = 0; k < 4; ++k)
    tables.leaks.rows.push_back(
        {name, on, kLightNames[static_cast<std::size_t>(k)], bench::formatted("%.2f", 100 * leaks.mean[k]),
         bench::formatted("%.0f", 100 * leaks.above[k]), bench::formatted("%.0f", leaks.pixels[k])});
}

void addColour(const std::string& name, const std::string& colour, const std::string& light,
               const reference::LightError& error, Tables& tables) {
  std::vector<std::string> row{name, colour, light};
  for (const float share : error.single) row.push_back(bench::formatted("%.2f", share));
  for (const float share : error.full) row.push_back(bench::formatted("%.2f", share));
  row.push_back(bench::formatted("%.2f", error.spread));
  row.push_back(bench::formatted("%.3f", error.noise.maxCoeff()));
  tables.colours.rows.push_back(std::move(row));
}

// What the page shows of them: a row a view, and a row a view and light with a column a colour.
std::string pageTables(const Tables& tables) {
  bench::Table views;
  for (std::size_t c = 0; c < 7; ++c) views.head.push_back(tables.views.head[c]);
  for (const char* light : kLightNames) views.head.push_back(std::string("leaks on hair, %, ") + light);
  for (const std::vector<std::string>& view : tables.views.rows) {
    std::vector<std::string>& row = views.rows.emplace_back(view.begin(), view.begin() + 7);
    for (const std::vector<std::string>& leak : tables.leaks.rows)
      if (leak[0] == view[0] && leak[1] == "hair") row.push_back(leak[3]);
  }
  bench::Table colours{{"style", "light"}, {}};
  for (const Colour& colour : kColours) colours.head.emplace_back(colour.name);
  for (const std::vector<std::string>& one : tables.colours.rows) {
    const auto of_view = [&](const std::vector<std::string>& row) { return row[0] == one[0] && row[1] == one[2]; };
    auto row = std::ranges::find_if(colours.rows, of_view);
    if (row == colours.rows.end()) row = colours.rows.insert(row, {one[0], one[2], "-", "-", "-", "-"});
    (*row)[static_cast<std::size_t>(std::ranges::find(colours.head, one[1]) - colours.head.begin())] = one[7];
  }
  return "\n" + views.markdown() + colours.markdown();
}

// The radiance of one colour under the key light as it stands, the other lights being out. name: of the picture.
reference::LightError compareLight(render::FrameInput frame, const Asked& asked, const reference::TracedScene& scene,
                                   const std::vector<reference::DrawnPixel>& drawn, const std::string& name) {
  frame.light.fill = frame.light.rim = frame.light.ambient_sky = frame.light.ambient_ground = {0, 0, 0};
  render::HairInput hair = frame.hairs.front();
  frame.hairs = {&hair, 1};
  const auto traced = reference::traceLight(scene, reference::Fiber(hair.look), frame, asked.trace);
  const reference::DrawOptions draw{asked.trace.width, asked.trace.height, 4, brightestOf(traced)};
  const auto full = reference::drawTerm(frame, reference::Term::kLight, draw);
  hair.look.diffuse = 0;
  const auto single = reference::drawTerm(frame, reference::Term::kLight, draw);
  if (!asked.pictures.empty())
    writePictures(asked.pictures + "/" + name + ".png", traced, full, asked, 0.5f * draw.brightest);
  return reference::lightError(traced, drawn, single, full);
}

// One style, at rest or moved: its cover, its shadows and the light on it in all colours. Appends its rows.
void compare(const std::string& style, bool moved, const Asked& asked, Tables& tables) {
  app::Demo demo = openStyle(style, moved, asked);
  render::FrameInput frame = app::frameInput(demo, asked.trace.width, asked.trace.height);
  const reference::TracedScene scene = tracedScene(frame, asked.hairs);
  const std::string stem = std::filesystem::path(style).stem().string(), name = stem + (moved ? ", moved" : "");
  const auto traced = reference::traceShadows(scene, frame, lightsOf(frame.light), asked.trace);
  const auto drawn = drawnShadows(frame, {asked.trace.width, asked.trace.height});
  addView(name, reference::coverError(traced, drawn), reference::shadowError(traced, drawn), tables);
  addLeaks(name, "hair", reference::hairLeaks(traced, drawn), tables);
  addLeaks(name, "skin", reference::skinLeaks(traced, drawn), tables);
  render::HairInput hair = frame.hairs.front();
  frame.hairs = {&hair, 1};
  const render::Float3 to_key = frame.light.to_light;
  const std::vector<std::string>& colours = moved ? asked.moved_colours : asked.colours;
  for (const Colour& colour : kColours) {
    if (std::find(colours.begin(), colours.end(), colour.name) == colours.end()) continue;
    hair.look.eumelanin = colour.eumelanin;
    hair.look.pheomelanin = colour.pheomelanin;
    for (const bool from_behind : {false, true}) {
      frame.light.to_light = from_behind ? frame.light.to_rim : to_key;
      const std::string light = from_behind ? "back" : "front";
      const std::string picture = stem + (moved ? "_moved_" : "_") + colour.name + "_" + light;
      addColour(name, colour.name, light, compareLight(frame, asked, scene, drawn, picture), tables);
      std::cerr << picture << "\n";
    }
  }
}

Tables measure(const Asked& asked) {
  Tables tables;
  for (const std::string& style : asked.styles) {
    compare(style, false, asked, tables);
    if (asked.moved) compare(style, true, asked, tables);
  }
  return tables;
}

void writeDocument(const std::string& page, const Tables& tables) {
  bench::writeMeasuredPart(page, "reference", pageTables(tables));
  const std::string folder = std::filesystem::path(page).parent_path().string();
  bench::writeTable(folder, "picture_views", tables.views);
  bench::writeTable(folder, "picture_leaks", tables.leaks);
  bench::writeTable(folder, "picture_colours", tables.colours);
}

int run(int argc, char** argv) {
  Asked asked;
  asked.trace.threads = static_cast<int>(std::max(std::thread::hardware_concurrency(), 1u));
  CLI::App cli("The renderer's light on hair against a path tracer's: shadow, single and multiple scattering.");
  cli.add_option("--width", asked.trace.width, "Pixels of the pictures that are compared (80)")
      ->check(CLI::Range(8, 2000));
  cli.add_option("--height", asked.trace.height, "The same, down (100)")->check(CLI::Range(8, 2000));
  cli.add_option("--samples", asked.trace.samples, "Paths of a pixel (64)")->check(CLI::Range(1, 100000));
  cli.add_option("--hairs", asked.hairs, "Hairs traced, standing for all (40000)")->check(CLI::Range(100, 400000));
  cli.add_option("--styles", asked.styles, "Of short, shoulder and long")->delimiter(',');
  cli.add_option("--colours", asked.colours, "Of black, brown, blond and white (all; moved hair: brown)")
      ->delimiter(',');
  cli.add_option("--set", asked.sets, "NAME=VALUE of the parameter tables");
  cli.add_option("--camera", asked.camera, "front, three-quarter, side or back (three-quarter)");
  cli.add_option("--pictures", asked.pictures, "Folder for pictures, traced and drawn side by side");
  cli.add_option("--document", asked.document,
                 "Page whose measured part 'reference' is written, and tables in data/ beside it");
  cli.add_flag("--moved", asked.moved, "Each style once more, two seconds into a head shake or into the scene's clip");
  cli.add_option("--scene", asked.scene, "Scene file in the styles' place, from head to chest");
  CLI11_PARSE(cli, argc, argv);
  if (cli.count("--colours") > 0) asked.moved_colours = asked.colours;
  if (!asked.document.empty()) asked.moved = true;
  if (!asked.scene.empty()) asked.styles = {asked.scene};
  if (!asked.pictures.empty()) std::filesystem::create_directories(asked.pictures);
  const app::EglContext context;
  const Tables tables = measure(asked);
  std::cout << tables.views.markdown() << tables.leaks.markdown() << tables.colours.markdown();
  if (!asked.document.empty()) writeDocument(asked.document, tables);
  return app::kExitFine;
}

}  // namespace

int main(int argc, char** argv) {
  return app::runMain("hairmesh-reference", [&] { return run(argc, argv); });
}

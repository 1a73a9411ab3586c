// hairmesh-reference: the renderer's light on hair against a path tracer's, over the strands that the renderer grows,
// with its lobes, lights and camera. Prints a table of errors for each view; see docs/picture.md.
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

std::string fourOf(const char* format, const Eigen::Vector4f& values) {
  std::string text;
  for (const float value : values) text += (text.empty() ? "" : " ") + bench::formatted(format, value);
  return text;
}

std::string leakColumns(const reference::Leaks& leaks) {
  return " " + fourOf("%.2f", 100 * leaks.mean) + " | " + fourOf("%.0f", 100 * leaks.above) + " | " +
         fourOf("%.0f", leaks.pixels) + " |";
}

std::string lightColumns(const reference::LightError& error) {
  return bench::formatted(" %.2f %.2f %.2f | %.2f %.2f %.2f | %.2f | %.3f |", error.single[0], error.single[1],
                          error.single[2], error.full[0], error.full[1], error.full[2], error.spread,
                          error.noise.maxCoeff());
}

// A style's rows of the tables.
struct Tables {
  std::string shadows, leaks, colours;
};

// The radiance of one colour under the key light as it stands, the other lights being out. name: of the picture.
std::string compareLight(render::FrameInput frame, const Asked& asked, const reference::TracedScene& scene,
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
  return lightColumns(reference::lightError(traced, drawn, single, full));
}

// One style, at rest or moved: its cover, its shadows and the light on it in all colours. Appends its rows.
void compare(const std::string& style, bool moved, const Asked& asked, Tables& tables) {
  app::Demo demo = openStyle(style, moved, asked);
  render::FrameInput frame = app::frameInput(demo, asked.trace.width, asked.trace.height);
  const reference::TracedScene scene = tracedScene(frame, asked.hairs);
  const std::string stem = std::filesystem::path(style).stem().string(), name = stem + (moved ? ", moved" : "");
  const auto traced = reference::traceShadows(scene, frame, lightsOf(frame.light), asked.trace);
  const auto drawn = drawnShadows(frame, {asked.trace.width, asked.trace.height});
  const reference::CoverError cover = reference::coverError(traced, drawn);
  const reference::ShadowError shadow = reference::shadowError(traced, drawn);
  tables.shadows += bench::formatted("| %s | %.3f | %.3f | ", name.c_str(), cover.ratio, cover.rms) +
                    fourOf("%.3f", shadow.rms) + " | " + fourOf("%+.3f", shadow.bias) + " |\n";
  tables.leaks += "| " + name + " |" + leakColumns(reference::hairLeaks(traced, drawn)) +
                  leakColumns(reference::skinLeaks(traced, drawn)) + "\n";
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
      const std::string row = "| " + name + " | " + colour.name + " | " + light + " |" +
                              compareLight(frame, asked, scene, drawn, picture) + "\n";
      std::cerr << row;
      tables.colours += row;
    }
  }
}

std::string measure(const Asked& asked) {
  Tables tables;
  tables.shadows =
      "| style | cover, drawn over traced | its RMS | shadow, RMS of key, key from behind, fill, rim | mean of the "
      "difference |\n|---|---|---|---|---|\n";
  tables.leaks =
      "| style | light where none comes, %, on hair: key, key from behind, fill, rim | over 1 %, % of the pixels | of "
      "pixels | on skin | over 1 % | of pixels |\n|---|---|---|---|---|---|---|\n";
  tables.colours =
      "| style | colour | light | single, drawn over traced, RGB | all, RGB | RMS over mean | traced mean's error |\n"
      "|---|---|---|---|---|---|---|\n";
  for (const std::string& style : asked.styles) {
    compare(style, false, asked, tables);
    if (asked.moved) compare(style, true, asked, tables);
  }
  return "\n" + tables.shadows + "\n" + tables.leaks + "\n" + tables.colours + "\n";
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
  cli.add_option("--document", asked.document, "Markdown file whose measured part 'reference' is written");
  cli.add_flag("--moved", asked.moved, "Each style once more, two seconds into a head shake or into the scene's clip");
  cli.add_option("--scene", asked.scene, "Scene file in the styles' place, from head to chest");
  CLI11_PARSE(cli, argc, argv);
  if (cli.count("--colours") > 0) asked.moved_colours = asked.colours;
  if (!asked.document.empty()) asked.moved = true;
  if (!asked.scene.empty()) asked.styles = {asked.scene};
  if (!asked.pictures.empty()) std::filesystem::create_directories(asked.pictures);
  const app::EglContext context;
  const std::string tables = measure(asked);
  std::cout << tables;
  if (!asked.document.empty()) bench::writeMeasuredPart(asked.document, "reference", tables);
  return app::kExitFine;
}

}  // namespace

int main(int argc, char** argv) {
  return app::runMain("hairmesh-reference", [&] { return run(argc, argv); });
}

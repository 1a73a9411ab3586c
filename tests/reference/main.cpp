// hairmesh-reference: the renderer's light on hair against a path tracer's, over the strands that the renderer grows,
// with its lobes, lights and camera. Prints a table of errors for each view; see docs/picture.md.
#include <CLI/CLI.hpp>
#include <algorithm>
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
  std::vector<std::string> styles{"short", "shoulder", "long"}, colours{"black", "brown", "blond", "white"};
  std::string scene, pictures, document, camera = "three-quarter";
  std::vector<std::string> sets;
};

struct Colour {
  const char* name;
  float eumelanin, pheomelanin;
};
constexpr Colour kColours[] = {{"black", 4, 0.3f}, {"brown", 1.1f, 0.35f}, {"blond", 0.28f, 0.22f}, {"white", 0, 0}};

app::Demo openStyle(const std::string& style, const Asked& asked) {
  app::Options options;
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

// Pixels that hair fills in both pictures.
bool bothFull(float traced, float drawn) {
  return traced > 0.9f && drawn > 0.9f;
}

struct ShadowError {
  Vector3f rms = Vector3f::Zero(), bias = Vector3f::Zero();  // of what is left of key, fill, rim
};

// Over points that are seen lit: what is left of the light is more than exp(-2). The tracer's own noise is taken off.
ShadowError shadowError(const std::vector<reference::TracedPixel>& traced, const std::vector<Vector3f>& drawn,
                        const std::vector<Vector3f>& cover, int samples) {
  ShadowError error;
  Vector3f count = Vector3f::Zero();
  for (std::size_t i = 0; i < traced.size(); ++i) {
    if (!bothFull(traced[i].cover, cover[i].x())) continue;
    for (int k = 0; k < 3; ++k) {
      const float truth = traced[i].lit[k];
      if (truth < std::exp(-2.0f)) continue;
      const float off = drawn[i][k] / cover[i].x() - truth;
      error.rms[k] += off * off - truth * (1 - truth) / (static_cast<float>(samples) * traced[i].cover);
      error.bias[k] += off;
      count[k] += 1;
    }
  }
  count = count.cwiseMax(1.0f);
  error.bias = error.bias.cwiseQuotient(count);
  error.rms = error.rms.cwiseQuotient(count).cwiseMax(0.0f).cwiseSqrt();
  return error;
}

struct LightError {
  Vector3f single = Vector3f::Zero(), full = Vector3f::Zero();  // ratio of the means, drawn over traced
  Vector3f noise = Vector3f::Zero();                            // of the traced mean, relative
  float spread = 0;                                             // RMS of the difference over the traced mean, green
};

LightError lightError(const std::vector<reference::TracedPixel>& traced, const std::vector<Vector3f>& single,
                      const std::vector<Vector3f>& full, const std::vector<Vector3f>& cover) {
  LightError error;
  Vector3f truth_single = Vector3f::Zero(), truth = Vector3f::Zero(), variance = Vector3f::Zero();
  float squares = 0, count = 0;
  for (std::size_t i = 0; i < traced.size(); ++i) {
    if (!bothFull(traced[i].cover, cover[i].x())) continue;
    error.single += single[i] / cover[i].x();
    error.full += full[i] / cover[i].x();
    truth_single += traced[i].single;
    truth += traced[i].full;
    variance += traced[i].full_variance;
    const float off = full[i].y() / cover[i].x() - traced[i].full.y();
    squares += off * off - traced[i].full_variance.y();
    count += 1;
  }
  error.single = error.single.cwiseQuotient(truth_single.cwiseMax(1e-9f));
  error.full = error.full.cwiseQuotient(truth.cwiseMax(1e-9f));
  error.noise = variance.cwiseSqrt().cwiseQuotient(truth.cwiseMax(1e-9f));
  error.spread =
      std::sqrt(std::max(squares / std::max(count, 1.0f), 0.0f)) / std::max(truth.y() / std::max(count, 1.0f), 1e-9f);
  return error;
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

std::string colourRow(const std::string& style, const Colour& colour, const char* light, const LightError& error) {
  return bench::formatted("| %s | %s | %s | %.2f %.2f %.2f | %.2f %.2f %.2f | %.2f | %.3f |\n", style.c_str(),
                          colour.name, light, error.single[0], error.single[1], error.single[2], error.full[0],
                          error.full[1], error.full[2], error.spread, error.noise.maxCoeff());
}

// One style under one light, all colours. Appends its rows.
void compare(app::Demo& demo, const std::string& style, bool from_behind, const Asked& asked,
             const reference::TracedScene* scene, std::string& shadows, std::string& colours) {
  render::FrameInput frame = app::frameInput(demo, asked.trace.width, asked.trace.height);
  if (from_behind) frame.light.to_light = frame.light.to_rim;
  reference::DrawOptions draw{asked.trace.width, asked.trace.height};
  const std::vector<Vector3f> cover = reference::drawTerm(frame, reference::Term::kCover, draw);
  {
    const ShadowError error =
        shadowError(reference::traceShadows(*scene, frame, asked.trace),
                    reference::drawTerm(frame, reference::Term::kShadow, draw), cover, asked.trace.samples);
    shadows += bench::formatted("| %s | %s | %.3f %.3f %.3f | %+.3f %+.3f %+.3f |\n", style.c_str(),
                                from_behind ? "back" : "front", error.rms[0], error.rms[1], error.rms[2], error.bias[0],
                                error.bias[1], error.bias[2]);
  }
  frame.light.fill = frame.light.rim = frame.light.ambient_sky = frame.light.ambient_ground = {0, 0, 0};
  const render::HairInput plain = frame.hairs.front();
  for (const Colour& colour : kColours) {
    if (std::find(asked.colours.begin(), asked.colours.end(), colour.name) == asked.colours.end()) continue;
    render::HairInput hair = plain;
    hair.look.eumelanin = colour.eumelanin;
    hair.look.pheomelanin = colour.pheomelanin;
    frame.hairs = {&hair, 1};
    const auto traced = reference::traceLight(*scene, reference::Fiber(hair.look), frame, asked.trace);
    draw.brightest = brightestOf(traced);
    const auto full = reference::drawTerm(frame, reference::Term::kLight, draw);
    hair.look.diffuse = 0;
    const auto single = reference::drawTerm(frame, reference::Term::kLight, draw);
    const char* light = from_behind ? "back" : "front";
    colours += colourRow(style, colour, light, lightError(traced, single, full, cover));
    std::cerr << colourRow(style, colour, light, lightError(traced, single, full, cover));
    if (!asked.pictures.empty())
      writePictures(asked.pictures + "/" + std::filesystem::path(style).stem().string() + "_" + colour.name + "_" +
                        light + ".png",
                    traced, full, asked, 0.5f * draw.brightest);
  }
}

std::string measure(const Asked& asked) {
  std::string shadows = "| style | light | RMS of key, fill, rim | mean of the difference |\n|---|---|---|---|\n";
  std::string colours =
      "| style | colour | light | single, drawn over traced, RGB | all, RGB | RMS over mean | traced mean's error |\n"
      "|---|---|---|---|---|---|---|\n";
  for (const std::string& style : asked.styles) {
    app::Demo demo = openStyle(style, asked);
    const reference::TracedScene scene =
        tracedScene(app::frameInput(demo, asked.trace.width, asked.trace.height), asked.hairs);
    for (const bool from_behind : {false, true}) compare(demo, style, from_behind, asked, &scene, shadows, colours);
  }
  return "\n" + shadows + "\n" + colours + "\n";
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
  cli.add_option("--colours", asked.colours, "Of black, brown, blond and white")->delimiter(',');
  cli.add_option("--set", asked.sets, "NAME=VALUE of the parameter tables");
  cli.add_option("--camera", asked.camera, "front, three-quarter, side or back (three-quarter)");
  cli.add_option("--pictures", asked.pictures, "Folder for pictures, traced and drawn side by side");
  cli.add_option("--document", asked.document, "Markdown file whose measured part 'reference' is written");
  cli.add_option("--scene", asked.scene, "Scene file in the styles' place, from head to chest");
  CLI11_PARSE(cli, argc, argv);
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

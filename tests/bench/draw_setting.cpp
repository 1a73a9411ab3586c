#include "tests/bench/draw_setting.h"

#include <algorithm>
#include <cassert>
#include <iterator>

#include "app/scene/detail/draw_governor.h"
#include "sim/field_text.h"

namespace bench {
namespace {

using Hairs = std::vector<render::HairInput>;

// A number that the picture's time and error depend on.
struct Factor {
  const char* name;
  void (*set)(double value, render::FrameInput& frame, Hairs& hairs);
};

constexpr const char* kPathFactor = "strand_path";
constexpr const char* kRungFactor = "rung";  // of the drawing governor
constexpr const char* kPathNames[] = {"geometry", "compute", "software"};

constexpr Factor kFactors[] = {
    {"strands",
     [](double value, render::FrameInput&, Hairs& hairs) {
       for (render::HairInput& hair : hairs) hair.strands = static_cast<int>(value);
     }},
    {"segments_per_layer",
     [](double value, render::FrameInput&, Hairs& hairs) {
       for (render::HairInput& hair : hairs) hair.segments_per_layer = static_cast<int>(value);
     }},
    {"shadows", [](double value, render::FrameInput& frame, Hairs&) { frame.light.shadows = value != 0; }},
    {"all_strands", [](double value, render::FrameInput& frame, Hairs&) { frame.skips.strands = value == 0; }},
    {"samples", [](double value, render::FrameInput& frame, Hairs&) { frame.view.samples = static_cast<int>(value); }},
    {"strands_per_pixel",
     [](double value, render::FrameInput& frame, Hairs&) { frame.view.strands_per_pixel = static_cast<float>(value); }},
    {"segment_error",
     [](double value, render::FrameInput& frame, Hairs&) { frame.view.segment_error = static_cast<float>(value); }},
    {"shadow_size",
     [](double value, render::FrameInput& frame, Hairs&) { frame.light.shadow_size = static_cast<int>(value); }},
    {"opacity_layers",
     [](double value, render::FrameInput& frame, Hairs&) { frame.light.opacity_layers = static_cast<int>(value); }},
    {"shadow_strands",
     [](double value, render::FrameInput& frame, Hairs&) { frame.light.shadow_strands = static_cast<int>(value); }},
    {"shadow_strands_per_pixel", [](double value, render::FrameInput& frame,
                                    Hairs&) { frame.light.shadow_strands_per_pixel = static_cast<float>(value); }},
    {kRungFactor,
     [](double value, render::FrameInput& frame, Hairs&) {
       app::DrawGovernor governor;
       governor.budget = 1;
       governor.place = value;
       app::governDrawing(governor, frame);
     }},
    {kPathFactor, [](double value, render::FrameInput& frame,
                     Hairs&) { frame.view.strand_path = static_cast<render::StrandPath>(static_cast<int>(value)); }},
};

// Values of a factor that are tried alone; the first `near` of them came near the front of some scene.
struct Tried {
  const char* name;
  std::vector<double> values;
  std::size_t near;
};

std::vector<Tried> singleFactors() {
  return {{"strands", {10000, 5000}, 1},
          {"segments_per_layer", {2}, 1},
          {"samples", {1}, 0},
          {"strands_per_pixel", {20, 40}, 1},
          {"segment_error", {1.6, 0.2}, 1},
          {"shadow_size", {256, 512}, 1},
          {"opacity_layers", {4}, 1},
          {"shadow_strands", {4000}, 1},
          {"shadow_strands_per_pixel", {12, 24}, 1},
          {kPathFactor, {0, 1}, 0}};
}

std::vector<DrawSetting> combinations() {
  return {
      {{{"strands_per_pixel", 20}, {"shadow_strands_per_pixel", 12}}},
      {{{"segments_per_layer", 2}, {"shadow_strands_per_pixel", 12}}},
      {{{"strands_per_pixel", 40}, {"segment_error", 0.2}, {"shadow_strands_per_pixel", 24}}},
      {{{"strands_per_pixel", 80}, {"segment_error", 0.1}, {"shadow_strands_per_pixel", 48}, {"shadow_size", 2048}}},
  };
}

}  // namespace

std::string DrawSetting::name() const {
  std::string text;
  for (const auto& [factor, value] : changes) {
    const bool path = factor == kPathFactor;
    text += (text.empty() ? "" : ", ") + factor + " " +
            (path ? std::string(kPathNames[static_cast<int>(value)]) : sim::numberText(value));
  }
  return text.empty() ? "the default" : text;
}

void DrawSetting::apply(render::FrameInput& frame, std::vector<render::HairInput>& hairs) const {
  for (const auto& [name, value] : changes) {
    const auto known = std::find_if(std::begin(kFactors), std::end(kFactors),
                                    [&name = name](const Factor& factor) { return name == factor.name; });
    assert(known != std::end(kFactors));
    known->set(value, frame, hairs);
  }
  frame.hairs = hairs;
}

std::vector<DrawSetting> settingsToDraw(bool quick) {
  std::vector<DrawSetting> settings(1);
  for (const Tried& tried : singleFactors()) {
    for (std::size_t k = 0; k < (quick ? tried.near : tried.values.size()); ++k)
      settings.push_back({{{tried.name, tried.values[k]}}});
  }
  for (const DrawSetting& setting : combinations()) settings.push_back(setting);
  for (std::size_t k = 1; k < app::drawLadder().size(); ++k)
    settings.push_back({{{kRungFactor, static_cast<double>(k)}}});
  return settings;
}

}  // namespace bench

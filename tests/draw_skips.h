// The drawing's skips as tests switch them, and the measure that the approximate ones are held to.
#pragma once

#include <algorithm>
#include <array>
#include <cstdlib>

#include "app/files/image_io.h"
#include "render/renderer.h"

namespace draw_skips {

// Levels of 255, and where the hair is so small that a block holds it; the table (app/scene/detail/skips.cpp) states
// them.
constexpr double kDetailBound = 4.5, kSmallBound = 9, kBodyBound = 2, kSmallBodyBound = 4;

inline render::DrawSkips none() {
  render::DrawSkips skips;
  skips.frame = skips.rows = skips.shadows = skips.view = skips.shadow_view = skips.body_parts = false;
  skips.body_detail = skips.strands = skips.segments = skips.shadow_detail = skips.sky_visibility = false;
  skips.skin = skips.shading = skips.hair_light = false;
  return skips;
}

inline app::Image draw(render::Renderer& renderer, const render::FrameInput& frame,
                       render::FrameReport* report = nullptr) {
  app::Image image{frame.width, frame.height, {}};
  const render::FrameReport drawn = renderer.renderImage(frame, image.rgba);
  if (report != nullptr) *report = drawn;
  return image;
}

struct NamedSkip {
  const char* name;
  bool render::DrawSkips::*on;
  render::SkipCount render::DrawSkipCounts::*count;
};
constexpr NamedSkip kExact[] = {
    {"frame", &render::DrawSkips::frame, &render::DrawSkipCounts::frame},
    {"rows", &render::DrawSkips::rows, &render::DrawSkipCounts::rows},
    {"shadows", &render::DrawSkips::shadows, &render::DrawSkipCounts::shadows},
    {"view", &render::DrawSkips::view, &render::DrawSkipCounts::view},
    {"shadow_view", &render::DrawSkips::shadow_view, &render::DrawSkipCounts::shadow_view},
    {"body_parts", &render::DrawSkips::body_parts, &render::DrawSkipCounts::body_parts},
};

inline render::DrawSkips exact() {
  render::DrawSkips skips = none();
  for (const NamedSkip& skip : kExact) skips.*skip.on = true;
  return skips;
}

// Mean difference in levels over blocks of 8 x 8 pixels that hold hair (that change when it, or a body, is taken away):
// single strands are drawn at other places with fewer of them, so that pixels differ by noise; what a person sees is
// their mean.
inline double differenceOver(const app::Image& a, const app::Image& b, const app::Image& bald) {
  constexpr int kBlock = 8;
  double sum = 0, weight = 0;
  for (int top = 0; top + kBlock <= a.height; top += kBlock) {
    for (int left = 0; left + kBlock <= a.width; left += kBlock) {
      std::array<double, 3> off{};
      int hairy = 0;
      for (int y = top; y < top + kBlock; ++y) {
        for (int x = left; x < left + kBlock; ++x) {
          const std::size_t p = 4 * (static_cast<std::size_t>(y) * a.width + x);
          int hair = 0;
          for (std::size_t c = 0; c < 3; ++c) {
            hair = std::max(hair, std::abs(int(a.rgba[p + c]) - int(bald.rgba[p + c])));
            off[c] += int(a.rgba[p + c]) - int(b.rgba[p + c]);
          }
          hairy += hair >= 3;
        }
      }
      if (hairy == 0) continue;
      // By the hair's share of the block: a hair of few pixels is not diluted by what surrounds it.
      sum += (std::abs(off[0]) + std::abs(off[1]) + std::abs(off[2])) / 3;
      weight += hairy;
    }
  }
  return weight > 0 ? sum / weight : 0;
}

}  // namespace draw_skips

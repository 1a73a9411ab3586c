// What a frame did: times of its stages, what was drawn, what was left out.
#pragma once

#include <vector>

namespace render {

struct StageTime {
  const char* name;
  double milliseconds;
};

// How much of something was left out, and of how much.
struct SkipCount {
  long skipped = 0, of = 0;
  SkipCount& operator+=(const SkipCount& other) {
    skipped += other.skipped;
    of += other.of;
    return *this;
  }
};

// One count for each of the DrawSkips.
struct DrawSkipCounts {
  SkipCount frame, rows, shadows, view, shadow_view, body_parts, body_detail, strands, segments, shadow_detail, skin,
      shading, hair_light, sky_visibility;
};

// What a frame did. Times: GPU timer queries where the driver's are usable, glFinish and a steady clock on software
// rasterizers when `measure` is asked for.
struct FrameReport {
  std::vector<StageTime> stages;
  long strands_drawn = 0, strand_vertices = 0, draw_calls = 0;
  long bytes_uploaded = 0;
  long gpu_bytes_hair = 0;     // positions, tangents, layout: everything kept on the GPU for hair models
  long gpu_bytes_shadows = 0;  // all shadow maps
  DrawSkipCounts skip_counts;
};

}  // namespace render

// Which strands of which bundles a frame draws, and how finely: by what the camera sees of them and how large. All
// tables of a frame live in one buffer, which is uploaded when one of them changed.
//
// Detail follows the hair's projected diameter in pixels continuously: strands leave one after another, fading, those
// that stay grow wider by as much, and segments grow longer. At full detail, seen as a whole, a hair needs no table.
#pragma once

#include <span>
#include <vector>

#include "render/frame_input.h"
#include "render/hair/hair_store.h"
#include "render/plan_input.h"

namespace render {

class HairDetail {
 public:
  // Fills in_view, casts, pixels, view_draw and shadow_draw of every hair and uploads the tables. Returns the bytes
  // uploaded. gate: of hairs and their shadows.
  long plan(const PlanInput& input, const ViewGate& gate, std::span<HairResources> hairs, DrawSkipCounts& skip_counts);

  const Texture& table() const { return texture_; }

 private:
  void planView(const PlanInput& input, const Frustum& frustum, HairResources& hair, DrawSkipCounts& skip_counts);
  void planShadow(const PlanInput& input, HairResources& hair, DrawSkipCounts& skip_counts);

  std::vector<float> texels_, uploaded_;
  std::vector<float> segments_;  // a layer, per face of the hair at hand
  GrowingBuffer buffer_;
  Texture texture_;
};

// Pixels that the bounds' diagonal spans at most.
float projectedDiameter(const Bounds& bounds, const CameraInput& camera, int height);

}  // namespace render

#include "render/hair/hair_detail.h"

#include <algorithm>
#include <cmath>

#include "shaders/shared.h"

namespace render {

namespace {

using Eigen::Vector3f;

constexpr float kMinStrands = 300;        // of a hair, however small it is
constexpr float kMinShare = 1e-3f;        // of strands that a frame asks for
constexpr float kFadeShare = 0.4f;        // of the strands drawn are about to leave
constexpr float kMinSegments = 0.25f;     // a layer
constexpr float kLongestSegment = 12;     // pixels: light changes along a strand, and is worked out at its points
constexpr float kShortestSegment = 2.5f;  // pixels: finer cannot be seen

// Strands of rank below `from` are drawn fully, and the share of them that is drawn at all, counted with their fading,
// is `share`.
void fadeTo(float share, HairDraw& draw) {
  if (share >= 1) return;
  const float band = std::min(kFadeShare * share, 2 * (1 - share));
  draw.fade_from = share - 0.5f * band;
  draw.fade_to = share + 0.5f * band;
  draw.gain = 1 / share;
}

// Strands of a face of `count` that may have a rank below the end of the fade.
int keptStrands(int count, const HairDraw& draw) {
  const float kept = std::ceil(std::min(draw.fade_to, 1.0f) * static_cast<float>(count));
  return std::clamp(static_cast<int>(kept), 0, count);
}

// How far (m a layer^2) a strand's own bends turn it away: amplitude times the square of the angle within a layer; see
// sideways() of the shader. layer_length: m.
float ownBend(const HairLook& look, float curl_share, int layers, float layer_length) {
  const auto square = [](float x) { return x * x; };
  const float turn = 6.2831853f / static_cast<float>(std::max(layers - 1, 1)), way = 6.2831853f * layer_length;
  return 0.4f * look.offset * square(1.2f * turn) + look.drift * square(way / 0.12f) +
         1.1f * curl_share * look.curl_radius * square(way / std::max(look.curl_pitch, 1e-3f)) +
         0.5f * look.wave_height * square(way / std::max(look.wave_length, 1e-3f)) +
         0.4f * look.frizz * square(way / 0.05f);
}

constexpr float kNearest = 0.05f;  // m from the eye; what is nearer is seen through

// Of what the box holds, at most. Bundle by bundle: what one does leaves the others' segments as they are.
float pixelsAMetre(const Bounds& box, const CameraInput& camera, int height) {
  const Vector3f eye = asVector(camera.eye);
  const float distance = (eye - eye.cwiseMax(box.low).cwiseMin(box.high)).norm();
  return static_cast<float>(height) / (2 * std::tan(0.5f * camera.fov_y) * std::max(distance, kNearest));
}

}  // namespace

float projectedDiameter(const Bounds& bounds, const CameraInput& camera, int height) {
  const Vector3f eye = asVector(camera.eye);
  const float nearest = (bounds.center() - eye).norm() - 0.5f * bounds.diagonal();
  const float distance = std::max(nearest, 0.25f * bounds.diagonal() + 1e-3f);
  return bounds.diagonal() * static_cast<float>(height) / (2 * std::tan(0.5f * camera.fov_y) * distance);
}

void HairDetail::planView(const PlanInput& input, const Frustum& frustum, HairResources& hair,
                          DrawSkipCounts& skip_counts) {
  const HairLayout& layout = hair.layout();
  const std::size_t faces = layout.faces.size();
  HairDraw& draw = hair.view_draw;
  const float wanted = std::max(input.strands_per_pixel * hair.pixels, kMinStrands);
  const float needed_share =
      input.skips.strands ? std::min(wanted / static_cast<float>(std::max(hair.strands, 1)), 1.0f) : 1;
  const float share = std::clamp(input.strand_share, kMinShare, 1.0f) * needed_share;
  fadeTo(share, draw);

  const auto full = static_cast<float>(hair.segments);
  segments_.assign(faces, full);
  if (input.skips.segments) {
    const float error = std::max(input.segment_error, 1e-3f);
    for (std::size_t f = 0; f < faces; ++f) {
      const float a_metre = pixelsAMetre(hair.face_bounds[f], input.camera, input.height);
      const float own = ownBend(hair.look, layout.curl_share, layout.max_layers, hair.face_step[f]);
      const float layer_pixels = hair.face_step[f] * a_metre;
      // A chord leaves a curve of second derivative b by b / (8 n^2); a Catmull-Rom's is at most twice its vertices'.
      const float bent = std::sqrt((2 * hair.face_bend[f] + own) * a_metre / (8 * error));
      const float needed = std::min(std::max(bent, layer_pixels / kLongestSegment), layer_pixels / kShortestSegment);
      segments_[f] = std::clamp(needed, std::min(kMinSegments, full), full);
    }
  }
  const bool cull = input.skips.view && !std::all_of(hair.face_bounds.begin(), hair.face_bounds.end(),
                                                     [&](const Bounds& box) { return frustum.seesAllOf(box); });
  const bool coarser = std::any_of(segments_.begin(), segments_.end(), [&](float n) { return n < full; });
  skip_counts.view.of += static_cast<long>(faces);
  skip_counts.strands.of += hair.strands;
  const long all_points = static_cast<long>(hair.strands) * hair.pointsPerStrand(draw);
  skip_counts.segments.of += all_points;
  if (!cull && !coarser && share >= 1) return;

  draw.table_first = static_cast<int>(texels_.size() / 4);
  draw.table_strands = draw.table_entries = 0;
  draw.most_segments = 0;
  for (std::size_t f = 0; f < faces; ++f) {
    const int count = hair.style->first_strand[f + 1] - hair.style->first_strand[f];
    if (cull && !frustum.maySee(hair.face_bounds[f])) {
      ++skip_counts.view.skipped;
      continue;
    }
    const int kept = keptStrands(count, draw);
    skip_counts.strands.skipped += count - kept;
    skip_counts.segments.skipped +=
        std::lround((full - segments_[f]) * static_cast<float>(kept) * static_cast<float>(layout.faces[f].layers - 1));
    if (kept == 0) continue;
    const int first = draw.table_strands;
    draw.table_strands += kept;
    ++draw.table_entries;
    draw.most_segments = std::max(draw.most_segments, segments_[f]);
    texels_.insert(texels_.end(), {static_cast<float>(draw.table_strands), static_cast<float>(f),
                                   segments_[f] < full ? segments_[f] : 0.0f, static_cast<float>(first)});
  }
}

// Shadows stand fewer strands, each standing for more hairs, and coarser curves: both blur by far less than a shadow is
// soft.
void HairDetail::planShadow(const PlanInput& input, HairResources& hair, DrawSkipCounts& skip_counts) {
  const LightInput& light = input.light;
  HairDraw& draw = hair.shadow_draw;
  draw.segments = (hair.segments + 1) / 2;
  const auto strands = static_cast<float>(std::max(hair.strands, 1));
  float wanted = light.shadow_strands > 0 ? static_cast<float>(light.shadow_strands) : strands;
  const float most = std::min(wanted, strands);
  if (input.skips.shadow_detail)
    wanted = std::min(wanted, std::max(light.shadow_strands_per_pixel * hair.pixels, kMinStrands));
  const float share = std::clamp(light.shadow_strand_share, kMinShare, 1.0f) * std::min(wanted / strands, 1.0f);
  fadeTo(share, draw);
  skip_counts.shadow_detail.of += std::lround(most);
  if (share >= 1) return;
  const float layer_pixels = hair.layout().layer_length * hair.pixels / std::max(hair.bounds.diagonal(), 1e-6f);
  const auto full = static_cast<float>(draw.segments);
  const float segments = input.skips.shadow_detail
                             ? std::clamp(layer_pixels / (2 * kShortestSegment), std::min(kMinSegments, full), full)
                             : full;
  draw.table_first = static_cast<int>(texels_.size() / 4);
  draw.table_strands = draw.table_entries = 0;
  draw.most_segments = segments;
  const std::vector<int>& first = hair.style->first_strand;
  for (std::size_t f = 0; f + 1 < first.size(); ++f) {
    const int kept = keptStrands(first[f + 1] - first[f], draw);
    if (kept == 0) continue;
    const int begin = draw.table_strands;
    draw.table_strands += kept;
    ++draw.table_entries;
    texels_.insert(texels_.end(), {static_cast<float>(draw.table_strands), static_cast<float>(f),
                                   segments < full ? segments : 0.0f, static_cast<float>(begin)});
  }
  skip_counts.shadow_detail.skipped += std::max(0L, std::lround(most) - draw.table_strands);
}

long HairDetail::plan(const PlanInput& input, const ViewGate& gate, std::span<HairResources> hairs,
                      DrawSkipCounts& skip_counts) {
  const Frustum& frustum = *gate.frustum;
  texels_.clear();
  for (HairResources& hair : hairs) {
    if (!hair.drawable) continue;
    const bool reached = hair.in_view;
    if (reached) {
      hair.pixels = projectedDiameter(hair.bounds, input.camera, input.height);
      hair.in_view = !input.skips.view || std::any_of(hair.face_bounds.begin(), hair.face_bounds.end(),
                                                      [&](const Bounds& box) { return frustum.maySee(box); });
      planShadow(input, hair, skip_counts);
    }
    hair.casts = reached && (!input.skips.shadow_view || gate.admits(hair.around));
    if (hair.in_view) {
      planView(input, frustum, hair, skip_counts);
    } else {
      const auto faces = static_cast<long>(hair.layout().faces.size());
      skip_counts.view += {faces, faces};
    }
  }
  if (texels_.empty() || (texels_ == uploaded_ && texture_)) return 0;
  uploaded_ = texels_;
  const auto bytes = static_cast<GLsizeiptr>(texels_.size() * sizeof(float));
  if (buffer_.upload(texels_.data(), bytes)) {
    texture_ = makeTexture(GL_TEXTURE_BUFFER);
    glTextureBuffer(texture_.id(), GL_RGBA32F, buffer_.id());
  }
  return static_cast<long>(bytes);
}

}  // namespace render

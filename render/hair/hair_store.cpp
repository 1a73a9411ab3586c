#include "render/hair/hair_store.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "render/hair/skin_reach.h"
#include "render/light/fiber_scattering.h"
#include "render/strands/skin_lift.h"
#include "shaders/shared.h"

namespace render {
namespace {

using Eigen::Vector3f;

// m that curls, waves and frizz take a strand from its guide by at most; curl_share: of the curls' radius.
float curledReach(const HairLook& look, float curl_share) {
  return 1.5f * curl_share * look.curl_radius + 0.6f * look.wave_height + 3 * look.frizz;
}

bool allFinite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

// Fills a buffer texture, of RGBA floats or another format, making it anew when its size changes. Returns the bytes
// uploaded.
template <class T>
long fillTexels(std::span<const T> texels, Buffer& buffer, Texture& texture, GLsizeiptr& bytes,
                GLenum format = GL_RGBA32F) {
  const auto wanted = static_cast<GLsizeiptr>(texels.size_bytes());
  if (!buffer || bytes != wanted) {
    buffer = makeBuffer();
    texture = makeTexture(GL_TEXTURE_BUFFER);
    glNamedBufferStorage(buffer.id(), wanted, texels.data(), GL_DYNAMIC_STORAGE_BIT);
    glTextureBuffer(texture.id(), format, buffer.id());
    bytes = wanted;
  } else {
    glNamedBufferSubData(buffer.id(), 0, wanted, texels.data());
  }
  return static_cast<long>(wanted);
}

void append(std::vector<float>& texels, const Vector3f& v, float w) {
  texels.insert(texels.end(), {v.x(), v.y(), v.z(), w});
}

// Faces, columns, and the draw table of all strands behind them.
long uploadStyle(HairStyle& style, std::vector<float>& texels) {
  style.first_strand = dealStrands(style.layout, style.strands);
  const std::vector<int>& first = style.first_strand;
  texels.clear();
  for (std::size_t i = 0; i < style.layout.faces.size(); ++i) {
    const HairFace& face = style.layout.faces[i];
    for (int vertex : face.first_vertex) texels.push_back(static_cast<float>(vertex));
    for (int column : style.layout.face_columns[i]) texels.push_back(static_cast<float>(column));
    texels.insert(texels.end(),
                  {static_cast<float>(face.covered ? -face.layers : face.layers), static_cast<float>(first[i]),
                   static_cast<float>(first[i + 1]), style.layout.face_edge[i]});
  }
  for (const HairColumn& column : style.layout.columns) {
    append(texels, column.rest, static_cast<float>(column.shortest_bundle - 1));
    append(texels, column.axis_u, column.outward.x());
    append(texels, column.axis_v, column.outward.y());
    texels.insert(texels.end(), {column.way.x(), column.way.y(), column.edge, 0});
  }
  for (const auto* shares : {&style.layout.root_shares, &style.layout.along_shares}) {
    for (const LookShare& share : *shares)
      texels.insert(texels.end(), {share.width, share.clump, share.curl, share.roughness, share.color[0],
                                   share.color[1], share.color[2], share.frizz});
  }
  for (std::size_t i = 0; i < style.layout.faces.size(); ++i) {
    texels.insert(texels.end(),
                  {static_cast<float>(first[i + 1]), static_cast<float>(i), 0, static_cast<float>(first[i])});
  }
  return fillTexels<float>(texels, style.buffer, style.texture, style.bytes);
}

long uploadScattering(HairScattering& hair) {
  const FiberScattering scattering = tabulateScattering(hair.look);
  hair.forward_albedo = scattering.forward_albedo;
  hair.backward_albedo = scattering.backward_albedo;
  hair.table = makeTexture(GL_TEXTURE_2D_ARRAY);
  const GLuint id = hair.table.id();
  glTextureStorage3D(id, 1, GL_RGBA16F, shared::kScatterPhi, shared::kScatterTheta, shared::kScatterSlices);
  glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTextureParameteri(id, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(id, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTextureSubImage3D(id, 0, 0, 0, 0, shared::kScatterPhi, shared::kScatterTheta, shared::kScatterSlices, GL_RGBA,
                      GL_FLOAT, scattering.table.data());
  return static_cast<long>(scattering.table.size() * sizeof(float));
}

// Summed projected diameter (m) of the hairs that the drawn strands stand for.
float representedWidth(const HairLook& look) {
  return 2 * look.strand_radius * 0.5f * (1 + look.taper) * look.strands_represented;
}

long uploadBlock(HairResources& hair) {
  const HairLook& look = hair.look;
  const auto strands = static_cast<float>(std::max(hair.strands, 1));
  const float represented = look.strands_represented / strands;
  const Float3 widths = lobeWidths(look.beta_m);
  const HairLayout& layout = hair.layout();
  shared::HairBlock block{};
  block.width = {look.strand_radius * std::pow(represented, look.width_compensation), look.taper,
                 representedWidth(look) / strands, look.least_pixels};
  block.shape = {look.length_variation, look.offset, look.curl_radius, look.curl_pitch};
  block.clumping = {look.clump, look.clump_size, look.frizz, look.flyaways};
  block.groups = {look.lock, look.wisp, look.drift, look.flyaway_lift};
  block.waves = {look.wave_height, look.wave_length, look.hairline, look.baby_hairs};
  block.variation = {look.root_spread, look.shine_variation, curledReach(look, layout.curl_share), 0};
  block.lobe_width = {widths[0], widths[1], widths[2], look.cuticle_angle};
  // Share of the real hairs' width that is drawn; under a half the gaps would let all light in.
  const float covered = std::max(std::pow(represented, look.width_compensation - 1), 0.5f);
  block.gain = {covered, std::clamp(look.diffuse, 0.0f, 1.0f), look.root_darkening, look.tint_variation};
  block.forward_albedo = asVec4(hair.scattering->forward_albedo);
  block.backward_albedo = asVec4(hair.scattering->backward_albedo);
  block.center = asVec4(hair.head.radius > 0 ? hair.head.center : hair.bounds.center(), layout.width_share);
  block.ball = asVec4(hair.bounds.center(), 0.5f * hair.bounds.diagonal() + sidewaysReach(look, layout.curl_share));
  if (!layout.root_shares.empty()) {
    const int along = static_cast<int>(layout.along_shares.size()),
              first = hair.style->fullTableTexel() - along * shared::kShareTexels;
    block.shares = {first - static_cast<int>(layout.root_shares.size()) * shared::kShareTexels, first, along, 0};
  }
  block.skin_count = {static_cast<int>(hair.skin.size() + hair.skin_grids.size()), std::max(layout.max_layers - 1, 1),
                      0, 0};
  for (std::size_t i = 0; i < hair.skin.size(); ++i) {
    const auto [x, y, z] = hair.skin[i].home;
    *std::ranges::copy(hair.skin[i].to_ball, block.skin_rows.begin() + 4 * static_cast<long>(i)).out = {
        x, y, z, liftsWithin(hair.skin[i])};
  }
  for (std::size_t i = 0; i < hair.skin_grids.size(); ++i) {
    const SkinGrid& grid = hair.skin_grids[i];
    std::ranges::copy(grid.to_nodes, block.skin_grid_rows.begin() + 3 * static_cast<long>(i));
    const auto number = std::ranges::find(hair.skin_distances->ids, grid.id) - hair.skin_distances->ids.begin();
    block.skin_grid_nodes[i] = {grid.nodes[0], grid.nodes[1], grid.nodes[2],
                                hair.skin_distances->first[static_cast<std::size_t>(number)]};
  }
  if (!hair.block) {
    hair.block = makeBuffer();
    glNamedBufferStorage(hair.block.id(), sizeof(block), nullptr, GL_DYNAMIC_STORAGE_BIT);
  }
  glNamedBufferSubData(hair.block.id(), 0, sizeof(block), &block);
  return sizeof(block);
}

Bounds boundsOf(std::span<const float> positions) {
  Bounds bounds;
  for (std::size_t i = 0; i + 2 < positions.size(); i += 3)
    bounds.add(Vector3f(positions[i], positions[i + 1], positions[i + 2]));
  return bounds;
}

// Boxes around all strands of each face, and how far these turn away within a layer. Strands leave the hull of a
// bundle's vertices by the bulge of its patches (edge curves: at most 4/27 of each end's tangent), by the overshoot of
// the curve through the layers (1/8 of the steps beside it) and sideways by their look.
void measureFaces(std::span<const float> positions, HairResources& hair) {
  const HairLayout& layout = hair.layout();
  const auto at = [&](int v) { return Vector3f(positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]); };
  hair.face_bounds.resize(layout.faces.size());
  hair.face_bend.resize(layout.faces.size());
  hair.face_step.resize(layout.faces.size());
  const float reach = sidewaysReach(hair.look, layout.curl_share);
  for (std::size_t f = 0; f < layout.faces.size(); ++f) {
    const HairFace& face = layout.faces[f];
    const int corners = face.first_vertex[3] < 0 ? 3 : 4;
    Bounds box;
    float across = 0, along = 0, bend = 0;
    for (int k = 0; k < corners; ++k) {
      const int first = face.first_vertex[k], next = face.first_vertex[(k + 1) % corners];
      for (int layer = 0; layer < face.layers; ++layer) {
        const Vector3f p = at(first + layer);
        box.add(p);
        across = std::max(across, (at(next + layer) - p).squaredNorm());
        if (layer + 1 < face.layers) along = std::max(along, (at(first + layer + 1) - p).squaredNorm());
        if (layer > 0 && layer + 1 < face.layers)
          bend = std::max(bend, (at(first + layer - 1) - 2 * p + at(first + layer + 1)).squaredNorm());
      }
    }
    const float margin = reach + 0.6f * std::sqrt(across) + 0.25f * std::sqrt(along);
    box.low.array() -= margin;
    box.high.array() += margin;
    hair.face_bounds[f] = box;
    hair.face_bend[f] = std::sqrt(bend);
    hair.face_step[f] = std::sqrt(along);
  }
}

// Far hair's soft light is renewed once in so many uploads, and far means fewer pixels than this.
constexpr int kSoftLightEvery = 8;
constexpr float kSoftLightPixels = 110;

}  // namespace

float sidewaysReach(const HairLook& look, float curl_share) {
  return 0.01f + 6 * look.offset + 2 * look.root_spread + look.hairline + 2.5f * look.drift +
         curledReach(look, curl_share) + 2 * look.flyaway_lift + look.clump_size * (1 + 2 * look.lock);
}

int HairStyle::fullTableTexel() const {
  return static_cast<int>(layout.faces.size()) * shared::kFaceTexels +
         static_cast<int>(layout.columns.size()) * shared::kColumnTexels +
         static_cast<int>(layout.root_shares.size() + layout.along_shares.size()) * shared::kShareTexels;
}

int HairResources::pointsPerStrand(const HairDraw& draw) const {
  const float a_layer = draw.most_segments > 0 ? draw.most_segments : static_cast<float>(draw.segments);
  return static_cast<int>(std::ceil(static_cast<float>(layout().max_layers - 1) * a_layer - 1e-4f)) + 1;
}

int HairResources::chunksPerStrand(const HairDraw& draw) const {
  const int segments_a_chunk = shared::kChunkPoints - 1;
  return (pointsPerStrand(draw) - 1 + segments_a_chunk - 1) / segments_a_chunk;
}

long HairResources::gpuBytes() const {
  if (!drawable) return 0;
  const long openness_bytes = 4L * openness_size[0] * openness_size[1] * openness_size[2];
  return static_cast<long>(vertex_bytes + skin_bytes) + openness_bytes + static_cast<long>(sizeof(shared::HairBlock));
}

long HairStore::gpuBytes() const {
  const long table = 8L * shared::kScatterPhi * shared::kScatterTheta * shared::kScatterSlices;
  long bytes = static_cast<long>(scatterings_.size()) * table;
  for (const auto& style : styles_) bytes += static_cast<long>(style->bytes);
  for (const auto& distances : distances_) bytes += static_cast<long>(distances->bytes);
  for (const HairResources& hair : hairs_) bytes += hair.gpuBytes();
  return bytes;
}

HairResources& HairStore::claim(std::size_t slot, std::uint64_t id) {
  const auto from = hairs_.begin() + static_cast<long>(std::min(slot, hairs_.size()));
  const auto found = std::find_if(from, hairs_.end(), [id](const HairResources& hair) { return hair.id == id; });
  if (found == hairs_.end()) {
    hairs_.insert(from, HairResources{});
  } else if (found != from) {
    std::swap(*from, *found);
  }
  hairs_[slot].id = id;
  hairs_[slot].seen = true;
  return hairs_[slot];
}

HairStyle& HairStore::styleOf(const HairInput& input, int strands, long& uploaded) {
  for (const auto& style : styles_) {
    const bool same =
        input.layout_id != 0 ? style->layout_id == input.layout_id : style->layout_id == 0 && style->id == input.id;
    if (same && style->layout_revision == input.layout_revision && style->strands == strands) return *style;
  }
  HairStyle& style = *styles_.emplace_back(std::make_unique<HairStyle>());
  style.id = input.id;
  style.layout_id = input.layout_id;
  style.layout_revision = input.layout_revision;
  style.strands = strands;
  const bool has_rest = input.rest.size() == input.positions.size();
  style.layout = makeHairLayout(input.faces, has_rest ? input.rest : input.positions, input.shares);
  if (!style.layout.faces.empty()) uploaded += uploadStyle(style, texels_);
  return style;
}

HairScattering& HairStore::scatteringOf(const HairLook& look, long& uploaded) {
  for (const auto& scattering : scatterings_) {
    if (scattering->look == look) return *scattering;
  }
  HairScattering& scattering = *scatterings_.emplace_back(std::make_unique<HairScattering>());
  scattering.look = look;
  uploaded += uploadScattering(scattering);
  return scattering;
}

SkinDistances& HairStore::distancesOf(std::span<const SkinGrid> grids, long& uploaded) {
  std::vector<std::uint64_t> ids;
  for (const SkinGrid& grid : grids) ids.push_back(grid.id);
  for (const auto& distances : distances_) {
    if (distances->ids == ids) return *distances;
  }
  SkinDistances& distances = *distances_.emplace_back(std::make_unique<SkinDistances>());
  distances.ids = std::move(ids);
  std::vector<float> texels;
  for (const SkinGrid& grid : grids) {
    distances.first.push_back(static_cast<int>(texels.size()));
    texels.insert(texels.end(), grid.distances.begin(), grid.distances.end());
  }
  uploaded += fillTexels<float>(texels, distances.buffer, distances.texture, distances.bytes, GL_R32F);
  return distances;
}

long HairStore::uploadSkin(HairResources& hair, std::span<const float> positions, const DrawSkips& skips) {
  if (hair.skin.empty() && hair.skin_grids.empty()) return 0;
  reachSkin(hair.layout(), positions, hair.skin, hair.skin_grids, sidewaysReach(hair.look, hair.layout().curl_share),
            hair.skin_reached);
  if (!skips.skin) std::ranges::fill(hair.skin_reached, allSkin(hair.skin.size(), hair.skin_grids.size()));
  const auto all = static_cast<long>(hair.skin.size() + hair.skin_grids.size());
  for (const std::uint64_t reached : hair.skin_reached) skip_counts_.skin += {all - std::popcount(reached), all};
  return fillTexels<std::uint64_t>(hair.skin_reached, hair.skin_buffer, hair.skin_texture, hair.skin_bytes, GL_RG32UI);
}

long HairStore::uploadOpenness(HairResources& hair) {
  const HairOpenness& openness = sky_visibility_.openness();
  const auto [width, height, depth] = openness.size;
  if (!hair.openness || hair.openness_size != openness.size) {
    hair.openness = makeTexture(GL_TEXTURE_3D);
    hair.openness_size = openness.size;
    const GLuint id = hair.openness.id();
    glTextureStorage3D(id, 1, GL_RGBA8, width, height, depth);
    glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    const float open[4] = {1, 0.5f, 0.5f, 0.5f};
    glTextureParameterfv(id, GL_TEXTURE_BORDER_COLOR, open);
    for (const GLenum side : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
      glTextureParameteri(id, side, GL_CLAMP_TO_BORDER);
  }
  glTextureSubImage3D(hair.openness.id(), 0, 0, 0, 0, width, height, depth, GL_RGBA, GL_UNSIGNED_BYTE,
                      openness.texels.data());
  hair.openness_from_head = openness.from_head;
  return static_cast<long>(4 * openness.texels.size());
}

long HairStore::uploadVertices(HairResources& hair, const HairInput& input, bool renew_light, const DrawSkips& skips) {
  const HairLayout& layout = hair.layout();
  const std::span<const float> positions = input.positions;
  long uploaded = 0;
  inLayerGradients(layout, positions, gradients_);
  const auto vertices = static_cast<std::size_t>(layout.vertex_count);
  const bool far = skips.sky_visibility && hair.pixels < kSoftLightPixels && !renew_light &&
                   hair.soft_light.size() == vertices && hair.soft_light_age + 1 < kSoftLightEvery;
  skip_counts_.sky_visibility += {far ? layout.vertex_count : 0, layout.vertex_count};
  if (far) {
    ++hair.soft_light_age;
    hair.head = fitHead(layout, positions);
  } else {
    sky_visibility_.compute(layout, positions, representedWidth(hair.look), hair.look.length_variation,
                            directionOr(to_fill_, Vector3f::UnitX()), directionOr(to_rim_, -Vector3f::UnitZ()),
                            input.skin);
    hair.soft_light.assign(sky_visibility_.values().begin(), sky_visibility_.values().end());
    hair.soft_light_age = 0;
    hair.head = sky_visibility_.head();
    uploaded += uploadOpenness(hair);
  }
  hair.openness_from_world = hair.openness_from_head * headFrame(layout, positions).inverse().matrix();
  texels_.clear();
  for (int v = 0; v < layout.vertex_count; ++v) {
    const Vector3f p(positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]);
    const SoftLight& light = hair.soft_light[static_cast<std::size_t>(v)];
    append(texels_, p, light.sky);
    append(texels_, gradients_[v].col(0), packDepths(light.fill));
    append(texels_, gradients_[v].col(1), packDepths(light.rim));
  }
  measureFaces(positions, hair);
  constexpr std::size_t kRow = 4 * shared::kVertexTexels;
  skip_counts_.rows.of += layout.vertex_count;
  if (!skips.rows || hair.texels.size() != texels_.size() ||
      hair.vertex_bytes != static_cast<GLsizeiptr>(texels_.size() * sizeof(float))) {
    hair.texels = texels_;
    return uploaded + fillTexels<float>(texels_, hair.vertex_buffer, hair.vertex_texture, hair.vertex_bytes);
  }
  const auto differ = std::mismatch(texels_.begin(), texels_.end(), hair.texels.begin());
  const auto first = static_cast<std::size_t>(differ.first - texels_.begin()) / kRow * kRow;
  std::size_t end = texels_.size();
  while (end > first &&
         std::equal(texels_.begin() + static_cast<long>(end - kRow), texels_.begin() + static_cast<long>(end),
                    hair.texels.begin() + static_cast<long>(end - kRow))) {
    end -= kRow;
  }
  skip_counts_.rows.skipped += layout.vertex_count - static_cast<long>((end - first) / kRow);
  if (end <= first) return uploaded;
  std::copy(texels_.begin() + static_cast<long>(first), texels_.begin() + static_cast<long>(end),
            hair.texels.begin() + static_cast<long>(first));
  const auto bytes = static_cast<GLsizeiptr>((end - first) * sizeof(float));
  glNamedBufferSubData(hair.vertex_buffer.id(), static_cast<GLintptr>(first * sizeof(float)), bytes,
                       texels_.data() + first);
  return uploaded + static_cast<long>(bytes);
}

long HairStore::refresh(HairResources& hair, const HairInput& input, const DrawSkips& skips) {
  const int asked = std::clamp(input.segments_per_layer, 1, 8), strands = std::clamp(input.strands, 0, 1 << 24);
  const bool fresh_layout = hair.style == nullptr || hair.style->layout_revision != input.layout_revision ||
                            (input.layout_id != 0 && hair.style->layout_id != input.layout_id);
  const bool fresh_positions = fresh_layout || hair.position_revision != input.position_revision;
  const bool fresh_count = fresh_layout || hair.strands != strands || hair.asked_segments != asked;
  const bool fresh_look = hair.scattering == nullptr || !(hair.look == input.look);
  const bool light_moved = hair.light_revision != light_revision_;
  std::vector<SkinEllipsoid> skin = skinNear(input.skin, hair.around.low, hair.around.high);
  std::vector<SkinGrid> skin_grids = skinNear(input.skin_grids, hair.around.low, hair.around.high);
  const bool fresh_body = !std::ranges::equal(input.skin, hair.body);
  const bool fresh_skin = fresh_body || skin != hair.skin || skin_grids != hair.skin_grids;
  if (!fresh_positions && !fresh_count && !fresh_look && !light_moved && !fresh_skin) return 0;
  if (fresh_positions && !allFinite(input.positions)) {
    // Never draw NaN: what was last good stays on screen, and the old revision makes the next positions be tried.
    if (fresh_layout) hair.drawable = false;
    return 0;
  }
  long uploaded = 0;
  hair.style = &styleOf(input, strands, uploaded);
  hair.position_revision = input.position_revision;
  hair.drawable = !hair.layout().faces.empty() &&
                  input.positions.size() == static_cast<std::size_t>(hair.layout().vertex_count) * 3;
  if (!hair.drawable) return 0;
  ++hair.revision;
  hair.strands = strands;
  hair.asked_segments = asked;
  hair.segments = segmentsFor(hair.layout(), input.look, asked);
  if (fresh_look) {
    hair.look = input.look;
    hair.scattering = &scatteringOf(input.look, uploaded);
  }
  hair.light_revision = light_revision_;
  hair.body.assign(input.skin.begin(), input.skin.end());
  hair.skin = std::move(skin);
  hair.skin_grids = std::move(skin_grids);
  hair.skin_distances = hair.skin_grids.empty() ? nullptr : &distancesOf(input.skin_grids, uploaded);
  const bool renew = fresh_count || fresh_look || light_moved;
  uploaded += uploadSkin(hair, input.positions, skips);
  if (!renew && !fresh_positions && !fresh_body) return uploaded + uploadBlock(hair);
  return uploaded + uploadVertices(hair, input, renew, skips) + uploadBlock(hair);
}

long HairStore::update(std::span<const HairInput> inputs, const LightInput& light, const DrawSkips& skips,
                       const ViewGate& gate) {
  if (light.to_fill != to_fill_ || light.to_rim != to_rim_) ++light_revision_;
  to_fill_ = light.to_fill;
  to_rim_ = light.to_rim;
  skip_counts_ = {};
  for (HairResources& hair : hairs_) hair.seen = false;
  long uploaded = 0;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    HairResources& hair = claim(i, inputs[i].id);
    if (hair.bounds_revision != inputs[i].position_revision || hair.bounds.empty()) {
      if (allFinite(inputs[i].positions)) hair.bounds = boundsOf(inputs[i].positions);
      hair.bounds_revision = inputs[i].position_revision;
    }
    // With room for the strands that leave the hull, and a little for what the hull itself may not hold.
    hair.around = hair.bounds;
    const float margin = sidewaysReach(inputs[i].look, curlShare(inputs[i].shares)) + 0.25f * hair.bounds.diagonal();
    hair.around.low.array() -= margin;
    hair.around.high.array() += margin;
    hair.in_view = hair.bounds.empty() || gate.admits(hair.around);
    hair.casts = true;
    hair.view_draw = hair.shadow_draw = {};
    if (hair.in_view) uploaded += refresh(hair, inputs[i], skips);
    hair.view_draw.segments = hair.segments;
  }
  std::erase_if(hairs_, [](const HairResources& hair) { return !hair.seen; });
  for (const auto& style : styles_) style->seen = false;
  for (const auto& scattering : scatterings_) scattering->seen = false;
  for (const auto& distances : distances_) distances->seen = false;
  for (HairResources& hair : hairs_) {
    if (hair.style) hair.style->seen = true;
    if (hair.scattering) hair.scattering->seen = true;
    if (hair.skin_distances) hair.skin_distances->seen = true;
  }
  std::erase_if(styles_, [](const auto& style) { return !style->seen; });
  std::erase_if(scatterings_, [](const auto& scattering) { return !scattering->seen; });
  std::erase_if(distances_, [](const auto& distances) { return !distances->seen; });
  return uploaded;
}

void HairStore::bind(HairResources& hair, const HairDraw& draw, const Texture* table) {
  const bool full = draw.table_first < 0;
  const shared::ivec4 values[2] = {
      {static_cast<int>(hair.layout().faces.size()),
       full ? static_cast<int>(hair.layout().faces.size()) : draw.table_entries,
       full ? hair.style->fullTableTexel() : draw.table_first, static_cast<int>(hair.look.seed)},
      {hair.strandCount(draw), hair.chunksPerStrand(draw), hair.pointsPerStrand(draw), draw.shadow_map}};
  const shared::vec4 detail{draw.fade_from, draw.fade_to, draw.gain, static_cast<float>(draw.segments)};
  static_assert(offsetof(shared::HairBlock, counts) == 0 && offsetof(shared::HairBlock, draw) == sizeof(values[0]) &&
                offsetof(shared::HairBlock, detail) == sizeof(values));
  glNamedBufferSubData(hair.block.id(), 0, sizeof(values), values);
  glNamedBufferSubData(hair.block.id(), sizeof(values), sizeof(detail), &detail);
  glBindBufferBase(GL_UNIFORM_BUFFER, 1, hair.block.id());
  glBindTextureUnit(shared::kUnitVertices, hair.vertex_texture.id());
  glBindTextureUnit(shared::kUnitLayout, hair.style->texture.id());
  glBindTextureUnit(shared::kUnitSkin, hair.skin_texture ? hair.skin_texture.id() : 0);
  glBindTextureUnit(shared::kUnitSkinGrids, hair.skin_distances ? hair.skin_distances->texture.id() : 0);
  glBindTextureUnit(shared::kUnitTable, full ? hair.style->texture.id() : table->id());
  glBindTextureUnit(shared::kUnitScattering, hair.scattering->table.id());
}

}  // namespace render

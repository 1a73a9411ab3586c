#include "render/hair_store.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "render/fiber_scattering.h"
#include "shaders/shared.h"

namespace render {
namespace {

using Eigen::Vector3f;

bool allFinite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

// Fills a buffer texture of RGBA floats, making it anew when its size changes. Returns the bytes uploaded.
long fillTexels(std::span<const float> texels, Buffer& buffer, Texture& texture, GLsizeiptr& bytes) {
  const auto wanted = static_cast<GLsizeiptr>(texels.size_bytes());
  if (!buffer || bytes != wanted) {
    buffer = makeBuffer();
    texture = makeTexture(GL_TEXTURE_BUFFER);
    glNamedBufferStorage(buffer.id(), wanted, texels.data(), GL_DYNAMIC_STORAGE_BIT);
    glTextureBuffer(texture.id(), GL_RGBA32F, buffer.id());
    bytes = wanted;
  } else {
    glNamedBufferSubData(buffer.id(), 0, wanted, texels.data());
  }
  return static_cast<long>(wanted);
}

void append(std::vector<float>& texels, const Vector3f& v, float w) {
  texels.insert(texels.end(), {v.x(), v.y(), v.z(), w});
}

long uploadLayout(HairResources& hair, std::vector<float>& texels) {
  const std::vector<int> first = dealStrands(hair.layout, hair.strands);
  texels.clear();
  for (std::size_t i = 0; i < hair.layout.faces.size(); ++i) {
    const HairFace& face = hair.layout.faces[i];
    for (int vertex : face.first_vertex) texels.push_back(static_cast<float>(vertex));
    for (int column : hair.layout.face_columns[i]) texels.push_back(static_cast<float>(column));
    texels.insert(texels.end(), {static_cast<float>(face.layers), static_cast<float>(first[i]),
                                 static_cast<float>(first[i + 1]), face.area > 0 ? 1 / face.area : 0.0f});
  }
  for (const HairColumn& column : hair.layout.columns) {
    append(texels, column.rest, static_cast<float>(column.shortest_bundle - 1));
    append(texels, column.axis_u, 0);
    append(texels, column.axis_v, 0);
  }
  return fillTexels(texels, hair.layout_buffer, hair.layout_texture, hair.layout_bytes);
}

long uploadScattering(HairResources& hair) {
  const FiberScattering scattering = tabulateScattering(hair.look);
  hair.forward_albedo = scattering.forward_albedo;
  hair.backward_albedo = scattering.backward_albedo;
  hair.local_back = scattering.local_back;
  if (!hair.scattering) {
    hair.scattering = makeTexture(GL_TEXTURE_2D_ARRAY);
    const GLuint id = hair.scattering.id();
    glTextureStorage3D(id, 1, GL_RGBA16F, shared::kScatterPhi, shared::kScatterTheta, 3);
    glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTextureParameteri(id, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(id, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  }
  glTextureSubImage3D(hair.scattering.id(), 0, 0, 0, 0, shared::kScatterPhi, shared::kScatterTheta, 3, GL_RGBA,
                      GL_FLOAT, scattering.table.data());
  return static_cast<long>(scattering.table.size() * sizeof(float));
}

// Hairs lie in clumps and light passes between those, so shadows are as if half the hairs were strewn evenly.
constexpr float kClumpedShare = 0.5f;

// Summed projected diameter (m) of the hairs that the drawn strands stand for.
float representedWidth(const HairLook& look, int strands) {
  return 2 * look.strand_radius * 0.5f * (1 + look.taper) *
         std::max(look.strands_represented, static_cast<float>(strands));
}

// How far (m) a strand may leave the hull of the hair mesh.
float sidewaysReach(const HairLook& look) {
  return 0.01f + 6 * look.offset + 1.5f * look.curl_radius + 2 * look.frizz + look.clump_size;
}

long uploadBlock(HairResources& hair) {
  const HairLook& look = hair.look;
  const auto strands = static_cast<float>(std::max(hair.strands, 1));
  const float represented = std::max(look.strands_represented / strands, 1.0f);
  const Float3 widths = lobeWidths(look.beta_m);
  shared::HairBlock block{};
  block.width = {look.strand_radius * std::pow(represented, look.width_compensation), look.taper,
                 kClumpedShare * representedWidth(look, hair.strands) / strands, look.least_pixels};
  block.shape = {look.length_variation, look.offset, look.curl_radius, look.curl_turns};
  block.clumping = {look.clump, look.clump_size, look.frizz, look.flyaways};
  block.lobe_width = {widths[0], widths[1], widths[2], look.cuticle_angle};
  block.gain = {look.specular, look.diffuse, look.root_darkening, look.tint_variation};
  block.forward_albedo = asVec4(hair.forward_albedo);
  block.backward_albedo = asVec4(hair.backward_albedo);
  block.local_back = asVec4(hair.local_back);
  const HeadBall& head = hair.openness.head();
  block.center = asVec4(head.radius > 0 ? head.center : hair.bounds.center());
  block.ball = asVec4(hair.bounds.center(), 0.5f * hair.bounds.diagonal() + sidewaysReach(look));
  if (!hair.block) {
    hair.block = makeBuffer();
    glNamedBufferStorage(hair.block.id(), sizeof(block), nullptr, GL_DYNAMIC_STORAGE_BIT);
  }
  glNamedBufferSubData(hair.block.id(), 0, sizeof(block), &block);
  return sizeof(block);
}

}  // namespace

int HairDraw::chunksPerStrand(const HairResources& hair) const {
  const int segments_a_chunk = shared::kChunkPoints - 1;
  return (pointsPerStrand(hair) - 1 + segments_a_chunk - 1) / segments_a_chunk;
}

long HairResources::gpuBytes() const {
  if (!drawable) return 0;
  const long table = 8L * shared::kScatterPhi * shared::kScatterTheta * 3;
  return static_cast<long>(vertex_bytes + layout_bytes) + table + static_cast<long>(sizeof(shared::HairBlock));
}

HairResources& HairStore::claim(std::size_t slot, std::uint64_t id) {
  const auto from = hairs_.begin() + static_cast<long>(std::min(slot, hairs_.size()));
  const auto found = std::find_if(from, hairs_.end(), [id](const HairResources& hair) { return hair.id == id; });
  if (found == hairs_.end()) {
    hairs_.insert(from, HairResources{});
  } else {
    std::swap(*from, *found);
  }
  hairs_[slot].id = id;
  hairs_[slot].seen = true;
  return hairs_[slot];
}

long HairStore::uploadVertices(HairResources& hair, std::span<const float> positions) {
  inLayerGradients(hair.layout, positions, gradients_);
  hair.openness.compute(hair.layout, positions, representedWidth(hair.look, hair.strands),
                        directionOr(to_fill_, Vector3f::UnitX()), directionOr(to_rim_, -Vector3f::UnitZ()));
  hair.bounds = Bounds{};
  texels_.clear();
  for (int v = 0; v < hair.layout.vertex_count; ++v) {
    const Vector3f p(positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]);
    const Vector3f open = hair.openness.values()[v];
    hair.bounds.add(p);
    append(texels_, p, open.x());
    append(texels_, gradients_[v].col(0), open.y());
    append(texels_, gradients_[v].col(1), open.z());
  }
  return fillTexels(texels_, hair.vertex_buffer, hair.vertex_texture, hair.vertex_bytes);
}

long HairStore::refresh(HairResources& hair, const HairInput& input, bool light_moved) {
  const bool fresh_layout = hair.layout_revision != input.layout_revision;
  const bool fresh_positions = fresh_layout || hair.position_revision != input.position_revision;
  const int segments = std::clamp(input.segments_per_layer, 1, 8), strands = std::clamp(input.strands, 0, 1 << 24);
  const bool fresh_count = fresh_layout || hair.strands != strands || hair.segments != segments;
  const bool fresh_look = !hair.scattering || !(hair.look == input.look);
  if (!fresh_positions && !fresh_count && !fresh_look && !light_moved) return 0;
  if (fresh_positions && !allFinite(input.positions)) {
    // Never draw NaN: what was last good stays on screen, and the old revision makes the next positions be tried.
    if (fresh_layout) hair.drawable = false;
    return 0;
  }
  if (fresh_layout) hair.layout = makeHairLayout(input.faces, input.positions);
  hair.layout_revision = input.layout_revision;
  hair.position_revision = input.position_revision;
  hair.drawable =
      !hair.layout.faces.empty() && input.positions.size() == static_cast<std::size_t>(hair.layout.vertex_count) * 3;
  if (!hair.drawable) return 0;
  ++hair.shadow_revision;
  hair.strands = strands;
  hair.segments = segments;
  long uploaded = 0;
  if (fresh_look) {
    hair.look = input.look;
    uploaded += uploadScattering(hair);
  }
  if (fresh_count) uploaded += uploadLayout(hair, texels_);
  return uploaded + uploadVertices(hair, input.positions) + uploadBlock(hair);
}

long HairStore::update(std::span<const HairInput> inputs, const LightInput& light) {
  const bool light_moved = light.to_fill != to_fill_ || light.to_rim != to_rim_;
  to_fill_ = light.to_fill;
  to_rim_ = light.to_rim;
  for (HairResources& hair : hairs_) hair.seen = false;
  long uploaded = 0;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    uploaded += refresh(claim(i, inputs[i].id), inputs[i], light_moved);
  }
  std::erase_if(hairs_, [](const HairResources& hair) { return !hair.seen; });
  return uploaded;
}

void HairStore::bind(HairResources& hair, const HairDraw& draw) {
  const shared::ivec4 values[2] = {
      {static_cast<int>(hair.layout.faces.size()), hair.strands, draw.segments, static_cast<int>(hair.look.seed)},
      {draw.stride, draw.chunksPerStrand(hair), draw.pointsPerStrand(hair), draw.shadow_map}};
  static_assert(offsetof(shared::HairBlock, counts) == 0 && offsetof(shared::HairBlock, draw) == sizeof(values[0]));
  glNamedBufferSubData(hair.block.id(), 0, sizeof(values), values);
  glBindBufferBase(GL_UNIFORM_BUFFER, 1, hair.block.id());
  glBindTextureUnit(shared::kUnitVertices, hair.vertex_texture.id());
  glBindTextureUnit(shared::kUnitLayout, hair.layout_texture.id());
  glBindTextureUnit(shared::kUnitScattering, hair.scattering.id());
}

}  // namespace render

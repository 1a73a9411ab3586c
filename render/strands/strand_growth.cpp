// Functions stand in the order of shaders/common/strand.glsl and bear its names; formulas and their sources are
// explained there.
#include "render/strands/strand_growth.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/strands/shader_math.h"

namespace render {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;
using Eigen::Vector4f;

constexpr float kPi = std::numbers::pi_v<float>;
constexpr int kVertexTexels = 3;

Vector2f facePoint(uint face, uint index, uint key, uint seed) {
  const Vector2f shift(unitFloat(hash(face, seed)), unitFloat(hash(face + 0x51ed27u, seed)));
  const Vector2f spread(unitFloat((index + 1u) * 3242174889u), unitFloat((index + 1u) * 2447445414u));
  const Vector2f random(randomOf(key, 1u), randomOf(key, 2u));
  const float shrink = 1.0f / std::sqrt(static_cast<float>(index) + 1.0f);
  const Vector2f jitter = (random - Vector2f::Constant(0.5f)) * 0.7f * shrink;
  const Vector2f at = shift + spread + jitter;
  return {fract(at.x()), fract(at.y())};
}

float clumpClosing(float t, uint clump_key) {
  const float reach = 0.3f + 0.4f * randomOf(clump_key, 6u);
  const float opens_again = 0.35f + 0.4f * randomOf(clump_key, 7u);
  return smoothstep(0.0f, reach, t) * (1.0f - opens_again * smoothstep(0.6f, 1.0f, t));
}

Vector3f unitOr(const Vector3f& v, const Vector3f& otherwise) {
  const float squared = v.squaredNorm();
  return squared > 1e-16f ? (v * (1.0f / std::sqrt(squared))).eval() : otherwise;
}

int lastPoint(const Strand& strand) {
  return static_cast<int>(std::ceil(strand.end * strand.segments - 1e-4f));
}

int layerOf(const Strand& strand, float s) {
  return std::clamp(static_cast<int>(s), 0, strand.layers - 2);
}

}  // namespace

StrandGrowth::StrandGrowth(std::span<const HairFace> faces, std::span<const float> rest, int strands,
                           int segments_per_layer, const HairLook& look)
    : layout_(makeHairLayout(faces, rest)),
      segments_(static_cast<float>(std::clamp(segments_per_layer, 1, 8))),
      texels_(static_cast<std::size_t>(kVertexTexels) * layout_.vertex_count, Vector4f::Zero()) {
  if (!layout_.faces.empty()) first_strand_ = dealStrands(layout_, std::clamp(strands, 0, 1 << 24));
  setLook(look);
  setPositions(rest);
}

void StrandGrowth::setLook(const HairLook& look) {
  look_ = look;
  const auto strands = static_cast<float>(std::max(strandCount(), 1));
  const float represented = std::max(look.strands_represented / strands, 1.0f);
  root_radius_ = look.strand_radius * std::pow(represented, look.width_compensation);
}

bool StrandGrowth::setPositions(std::span<const float> positions) {
  if (positions.size() != 3 * static_cast<std::size_t>(layout_.vertex_count)) return false;
  if (!std::all_of(positions.begin(), positions.end(), [](float v) { return std::isfinite(v); })) return false;
  inLayerGradients(layout_, positions, gradients_);
  for (int v = 0; v < layout_.vertex_count; ++v) {
    texels_[kVertexTexels * v] = {positions[3 * v], positions[3 * v + 1], positions[3 * v + 2], 0};
    texels_[kVertexTexels * v + 1] << gradients_[v].col(0), 0;
    texels_[kVertexTexels * v + 2] << gradients_[v].col(1), 0;
  }
  return true;
}

int StrandGrowth::maxPoints() const {
  return static_cast<int>(std::ceil(static_cast<float>(layout_.max_layers - 1) * segments_ - 1e-4f)) + 1;
}

Vector2f StrandGrowth::planeOffset(int from, int to) const {
  const HairColumn& column = layout_.columns[from];
  const Vector3f gap = layout_.columns[to].rest - column.rest;
  return {gap.dot(column.axis_u), gap.dot(column.axis_v)};
}

void StrandGrowth::weighQuad(const Vector2f& p, const std::array<int, 4>& columns, Strand& strand) const {
  const float u = p.x(), v = p.y(), iu = 1.0f - u, iv = 1.0f - v;
  const float u0 = iu * iu * (1.0f + 2.0f * u), u1 = 1.0f - u0, v0 = iv * iv * (1.0f + 2.0f * v), v1 = 1.0f - v0;
  const float tu0 = u * iu * iu, tu1 = u * u * iu, tv0 = v * iv * iv, tv1 = v * v * iv;
  strand.blend = {iu * iv, u * iv, u * v, iu * v};
  strand.weight = {iv * u0 + iu * v0, iv * u1 + u * v0, v * u1 + u * v1, v * u0 + iu * v1};
  const std::array<float, 4> to_next{iv * tu0, u * tv0, v * tu1, iu * tv1};
  const std::array<float, 4> to_last{iu * tv0, iv * tu1, u * tv1, v * tu0};
  for (int k = 0; k < 4; ++k) {
    strand.weight[k] -= strand.blend[k];
    const Vector2f d = to_next[k] * planeOffset(columns[k], columns[(k + 1) & 3]) +
                       to_last[k] * planeOffset(columns[k], columns[(k + 3) & 3]);
    strand.along_u[k] = d.x();
    strand.along_v[k] = d.y();
  }
}

void StrandGrowth::weighTriangle(Vector2f p, const std::array<int, 4>& columns, Strand& strand) const {
  if (p.x() + p.y() > 1.0f) p = Vector2f::Ones() - p;
  const std::array<float, 3> b{1.0f - p.x() - p.y(), p.x(), p.y()};
  const float bubble = b[0] * b[1] * b[2];
  strand.blend = {b[0], b[1], b[2], 0};
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3, last = (k + 2) % 3;
    strand.weight[k] = b[k] * b[k] * (3.0f - 2.0f * b[k]) + 2.0f * bubble;
    const Vector2f d = (b[k] * b[k] * b[next] + 0.5f * bubble) * planeOffset(columns[k], columns[next]) +
                       (b[k] * b[k] * b[last] + 0.5f * bubble) * planeOffset(columns[k], columns[last]);
    strand.along_u[k] = d.x();
    strand.along_v[k] = d.y();
  }
}

void StrandGrowth::joinClump(const std::array<int, 4>& columns, int corners, Strand& strand) const {
  Vector3f root = Vector3f::Zero();
  for (int k = 0; k < corners; ++k) root += strand.blend[k] * layout_.columns[columns[k]].rest;
  const float size = std::max(look_.clump_size, 1e-4f);
  const Vector3f cell = (root / size).array() - 0.5f;
  const Eigen::Vector3i base = cell.array().floor().cast<int>();
  Vector3f nearest = Vector3f::Zero();
  float nearest_squared = 1e30f;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3i at = base + Eigen::Vector3i(i & 1, (i >> 1) & 1, i >> 2);
    const uint key = hash(static_cast<uint>(at.x()) * 73856093u ^ static_cast<uint>(at.y()) * 19349663u ^
                              static_cast<uint>(at.z()) * 83492791u,
                          look_.seed);
    const Vector3f jitter(randomOf(key, 1u), randomOf(key, 2u), randomOf(key, 3u));
    const Vector3f gap = at.cast<float>() + (0.8f * (jitter.array() - 0.5f)).matrix() - cell;
    const float squared = gap.squaredNorm();
    if (squared < nearest_squared) {
      nearest_squared = squared;
      nearest = gap;
      strand.clump_key = key;
    }
  }
  const Vector3f pull =
      nearest * size * look_.clump * (1.0f - strand.loose) * (0.75f + 0.25f * randomOf(strand.key, 5u));
  for (int k = 0; k < corners; ++k) {
    strand.pull_u[k] = strand.blend[k] * pull.dot(layout_.columns[columns[k]].axis_u);
    strand.pull_v[k] = strand.blend[k] * pull.dot(layout_.columns[columns[k]].axis_v);
  }
}

Strand StrandGrowth::strand(int number) const {
  const auto after = std::upper_bound(first_strand_.begin() + 1, first_strand_.end(), number);
  const int low = static_cast<int>(after - first_strand_.begin()) - 1;
  const int first = first_strand_[low], end = first_strand_[low + 1];
  const HairFace& face = layout_.faces[low];
  const std::array<int, 4>& columns = layout_.face_columns[low];
  const int corners = columns[3] < 0 ? 3 : 4;
  Strand strand;
  strand.face = low;
  strand.first = face.first_vertex;
  if (corners == 3) strand.first[3] = strand.first[2];
  strand.layers = face.layers;
  const auto of = static_cast<uint>(low), index = static_cast<uint>(number - first);
  strand.key = hash(hash(of, index), look_.seed);
  strand.segments = segments_;
  const float rank = (static_cast<float>(index) + unitFloat(hash(of + 0x2545f4u, look_.seed))) /
                     std::max(static_cast<float>(end) - static_cast<float>(first), 1.0f);
  strand.gain = fade_.gain * std::clamp((fade_.to - rank) / (fade_.to - fade_.from), 0.0f, 1.0f);
  strand.loose = randomOf(strand.key, 3u) < look_.flyaways ? 1.0f : 0.0f;
  strand.root = facePoint(of, index, strand.key, look_.seed);
  if (corners == 4)
    weighQuad(strand.root, columns, strand);
  else
    weighTriangle(strand.root, columns, strand);
  joinClump(columns, corners, strand);
  const float early = mix(randomOf(strand.key, 4u), randomOf(strand.clump_key, 4u), 0.2f * look_.clump);
  float cut = 0;
  for (int k = 0; k < corners; ++k)
    cut += strand.blend[k] * static_cast<float>(layout_.columns[columns[k]].shortest_bundle - 1);
  strand.end = cut * (1.0f - look_.length_variation * early * early);
  return strand;
}

StrandGrowth::LayerPoint StrandGrowth::layerPoint(const Strand& strand, int layer) const {
  LayerPoint point{Vector4f::Zero(), Vector4f::Zero()};
  const float closing =
      clumpClosing(static_cast<float>(layer) / static_cast<float>(strand.layers - 1), strand.clump_key);
  for (int k = 0; k < 4; ++k) {
    const Vector4f* texels = &texels_[static_cast<std::size_t>(kVertexTexels) * (strand.first[k] + layer)];
    point.position += strand.weight[k] * texels[0] + (strand.along_u[k] + closing * strand.pull_u[k]) * texels[1] +
                      (strand.along_v[k] + closing * strand.pull_v[k]) * texels[2];
    point.axis_u += strand.blend[k] * texels[1];
  }
  return point;
}

Vector4f StrandGrowth::layerAfter(const Strand& strand, int layer, const Vector4f& last, const Vector4f& here) const {
  return layer < strand.layers ? layerPoint(strand, layer).position : (2.0f * here - last).eval();
}

StrandGrowth::LayerWindow StrandGrowth::layerWindow(const Strand& strand, int layer) const {
  LayerWindow window;
  window.from = layerPoint(strand, layer);
  window.to = layerPoint(strand, layer + 1);
  window.before =
      layer > 0 ? layerPoint(strand, layer - 1).position : (2.0f * window.from.position - window.to.position).eval();
  window.after = layerAfter(strand, layer + 2, window.from.position, window.to.position);
  return window;
}

Vector4f StrandGrowth::sideways(const Strand& strand, float s) const {
  const float per_layer = 1.0f / static_cast<float>(strand.layers - 1), t = s * per_layer;
  const float grow = t * (1.6f - 0.6f * t), growth = 1.6f - 1.2f * t;
  const float angle = 2.0f * kPi * randomOf(strand.key, 8u);
  const float reach = std::sqrt(randomOf(strand.key, 9u)) * look_.offset * (1.0f + 5.0f * strand.loose);
  const Vector2f away = reach * Vector2f(std::cos(angle), std::sin(angle));
  const float bend_rate = 2.0f * kPi * (0.7f + 0.8f * randomOf(strand.key, 10u));
  const float bend = 2.0f * kPi * (t * (0.7f + 0.8f * randomOf(strand.key, 10u)) + randomOf(strand.key, 11u));
  Vector2f offset = away * grow * (0.6f + 0.4f * std::sin(bend));
  Vector2f rate = away * (growth * (0.6f + 0.4f * std::sin(bend)) + grow * 0.4f * std::cos(bend) * bend_rate);

  const float turn_rate = 2.0f * kPi * look_.curl_turns * (0.85f + 0.3f * randomOf(strand.clump_key, 8u));
  const float turn =
      turn_rate * t + 2.0f * kPi * randomOf(strand.clump_key, 9u) + 0.8f * (randomOf(strand.key, 12u) - 0.5f);
  const float radius = look_.curl_radius * (0.8f + 0.4f * randomOf(strand.key, 13u));
  const Vector2f round(std::cos(turn), std::sin(turn)), round_rate = Vector2f(-round.y(), round.x()) * turn_rate;
  const float opening = smoothstep(0.0f, 0.35f, t), x = std::clamp(t / 0.35f, 0.0f, 1.0f);
  offset += radius * opening * round;
  rate += radius * (opening * round_rate + 6.0f * x * (1.0f - x) / 0.35f * round);

  for (int axis = 0; axis < 2; ++axis) {
    const float wave_rate = 2.0f * kPi * (2.5f + 4.0f * randomOf(strand.key, 14u + static_cast<uint>(axis)));
    const float wave = wave_rate * t + 2.0f * kPi * randomOf(strand.key, 16u + static_cast<uint>(axis));
    offset[axis] += look_.frizz * grow * std::sin(wave);
    rate[axis] += look_.frizz * (growth * std::sin(wave) + grow * std::cos(wave) * wave_rate);
  }
  return {offset.x(), offset.y(), rate.x() * per_layer, rate.y() * per_layer};
}

CurvePoint StrandGrowth::curvePoint(const Strand& strand, const LayerWindow& window, float s, float fraction) const {
  const Vector4f &p0 = window.before, &p1 = window.from.position, &p2 = window.to.position, &p3 = window.after;
  const float f = fraction;
  const Vector4f c1 = 0.5f * (p2 - p0), c2 = p0 - 2.5f * p1 + 2.0f * p2 - 0.5f * p3,
                 c3 = 1.5f * (p1 - p2) + 0.5f * (p3 - p0);
  const Vector3f base = (p1 + f * (c1 + f * (c2 + f * c3))).head<3>();
  const Vector3f slope = (c1 + f * (2.0f * c2 + f * 3.0f * c3)).head<3>();
  const Vector3f axis = unitOr(slope, {0.0f, -1.0f, 0.0f});
  Vector3f aside = (window.from.axis_u * (1.0f - f) + window.to.axis_u * f).head<3>();
  aside = unitOr(aside - axis * axis.dot(aside), {1.0f, 0.0f, 0.0f});
  const Vector3f across = axis.cross(aside);
  const Vector4f bend = sideways(strand, s);
  CurvePoint point;
  point.position = base + aside * bend.x() + across * bend.y();
  point.tangent = unitOr(slope + aside * bend.z() + across * bend.w(), axis);
  point.along = strand.end > 0.0f ? s / strand.end : 0.0f;
  return point;
}

void StrandGrowth::moveWindow(const Strand& strand, int wanted, int& layer, LayerWindow& window) const {
  if (wanted == layer + 1) {
    window.before = window.from.position;
    window.from = window.to;
    window.to = layerPoint(strand, wanted + 1);
    window.after = layerAfter(strand, wanted + 2, window.from.position, window.to.position);
  } else if (wanted > layer) {
    window = layerWindow(strand, wanted);
  }
  layer = wanted;
}

template <class Parameter>
void StrandGrowth::growAt(const Strand& strand, std::span<CurvePoint> points, const Parameter& parameter) const {
  int layer = 0;
  LayerWindow window = layerWindow(strand, 0);
  for (std::size_t index = 0; index < points.size(); ++index) {
    const float s = parameter(index);
    moveWindow(strand, layerOf(strand, s), layer, window);
    points[index] = curvePoint(strand, window, s, s - static_cast<float>(layer));
  }
}

int StrandGrowth::drawnPoints(const Strand& strand) const {
  const int last = lastPoint(strand);
  return last > 0 && strand.gain > 0 ? last + 1 : 0;
}

int StrandGrowth::growDrawn(const Strand& strand, std::span<CurvePoint> points) const {
  const int count = drawnPoints(strand);
  if (count == 0) return 0;
  growAt(strand, points.first(static_cast<std::size_t>(count)),
         [&](std::size_t index) { return std::min(static_cast<float>(index) / strand.segments, strand.end); });
  return count;
}

void StrandGrowth::growEven(const Strand& strand, std::span<CurvePoint> points) const {
  const std::size_t last = points.size() - 1;
  growAt(strand, points, [&](std::size_t index) {
    return index == last ? strand.end : strand.end * (static_cast<float>(index) / static_cast<float>(last));
  });
}

float StrandGrowth::radius(const Strand& strand, float along) const {
  return strand.gain * root_radius_ * mix(1.0f, look_.taper, along * along);
}

}  // namespace render

// Functions stand in the order of shaders/common/strand.glsl and bear its names; formulas and their sources are
// explained there.
#include "render/strands/strand_growth.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/strands/look_share.h"
#include "render/strands/shader_math.h"
#include "shaders/shared.h"

namespace render {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;
using Eigen::Vector4f;

constexpr float kPi = std::numbers::pi_v<float>;
constexpr int kVertexTexels = 3;
constexpr float kLockSize = 3.2f, kWispSize = 0.3f, kFanReach = 0.015f;  // as in shaders/shared.h

Vector2f facePoint(uint face, uint index, uint key, uint seed) {
  const Vector2f shift(unitFloat(hash(face, seed)), unitFloat(hash(face + 0x51ed27u, seed)));
  const Vector2f spread(unitFloat((index + 1u) * 3242174889u), unitFloat((index + 1u) * 2447445414u));
  const Vector2f random(randomOf(key, 1u), randomOf(key, 2u));
  const float shrink = 1.0f / std::sqrt(static_cast<float>(index) + 1.0f);
  const Vector2f jitter = (random - Vector2f::Constant(0.5f)) * 0.7f * shrink;
  const Vector2f at = shift + spread + jitter;
  return {fract(at.x()), fract(at.y())};
}

// m of hair from the root to s layers, and its rate by s.
Vector2f wayAt(const Strand& strand, float s) {
  return {s * (strand.way.x() + strand.way.y() * s), strand.way.x() + 2.0f * strand.way.y() * s};
}

float layersAt(const Strand& strand, float metres) {
  const float root = std::sqrt(std::max(strand.way.x() * strand.way.x() + 4.0f * strand.way.y() * metres, 0.0f));
  return 2.0f * metres / std::max(strand.way.x() + root, 1e-6f);
}

float lockClosing(float t) {
  return smoothstep(0.1f, 0.7f, t) * (1.0f - 0.6f * smoothstep(0.7f, 1.0f, t));
}

float clumpClosing(float t, uint clump_key) {
  const float reach = 0.3f + 0.4f * randomOf(clump_key, 6u);
  const float opens_again = 0.35f + 0.4f * randomOf(clump_key, 7u);
  return smoothstep(0.0f, reach, t) * (1.0f - opens_again * smoothstep(0.6f, 1.0f, t));
}

Vector3f unitOr(const Vector3f& v, const Vector3f& otherwise) {
  const float squared = v.squaredNorm();
  return squared > 1e-16f ? (v / std::sqrt(squared)).eval() : otherwise;
}

Vector2f opening(const Vector2f& way, float reach) {
  const float square = way.x() * way.x(), far = reach * reach, sum = square + far;
  return {square / sum, 2.0f * way.x() * far / (sum * sum) * way.y()};
}

void addSwing(Vector4f& bend, const Vector2f& away, const Vector2f& open, const Vector2f& angle) {
  const float sine = std::sin(angle.x());
  bend.head<2>() += open.x() * sine * away;
  bend.tail<2>() += (open.y() * sine + open.x() * std::cos(angle.x()) * angle.y()) * away;
}

Vector2f onCircle(float turn) {
  return {std::cos(2.0f * kPi * turn), std::sin(2.0f * kPi * turn)};
}

Vector2f swingAngle(const Vector2f& way, float wave_length, float phase) {
  const float rate = 2.0f * kPi / wave_length;
  return {rate * way.x() + 2.0f * kPi * phase, rate * way.y()};
}

int lastPoint(const Strand& strand) {
  return static_cast<int>(std::ceil(strand.end * strand.segments - 1e-4f));
}

int layerOf(const Strand& strand, float s) {
  return std::clamp(static_cast<int>(s), 0, strand.layers - 2);
}

}  // namespace

StrandGrowth::StrandGrowth(std::span<const HairFace> faces, std::span<const float> rest, int strands,
                           int segments_per_layer, const HairLook& look, const LookShares& shares)
    : layout_(makeHairLayout(faces, rest, shares)),
      asked_segments_(segments_per_layer),
      texels_(static_cast<std::size_t>(kVertexTexels) * layout_.vertex_count, Vector4f::Zero()) {
  if (!layout_.faces.empty()) first_strand_ = dealStrands(layout_, std::clamp(strands, 0, 1 << 24));
  setLook(look);
  setPositions(rest);
}

void StrandGrowth::setLook(const HairLook& look) {
  look_ = look;
  segments_ = static_cast<float>(segmentsFor(layout_, look, asked_segments_));
  const auto strands = static_cast<float>(std::max(strandCount(), 1));
  const float represented = look.strands_represented / strands;
  root_radius_ = look.strand_radius * std::pow(represented, look.width_compensation);
}

bool StrandGrowth::setPositions(std::span<const float> positions) {
  if (positions.size() != 3 * static_cast<std::size_t>(layout_.vertex_count)) return false;
  if (!std::all_of(positions.begin(), positions.end(), [](float v) { return std::isfinite(v); })) return false;
  inLayerGradients(layout_, positions, gradients_);
  center_ = middleOfHead(layout_, positions);
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

StrandGrowth::Root StrandGrowth::rootOf(const std::array<int, 4>& columns, int corners, Strand& strand) const {
  Root root;
  for (int k = 0; k < corners; ++k) {
    const HairColumn& column = layout_.columns[columns[k]];
    root.rest += strand.blend[k] * column.rest;
    root.axis_u += strand.blend[k] * column.axis_u;
    root.axis_v += strand.blend[k] * column.axis_v;
    root.cut += strand.blend[k] * static_cast<float>(column.shortest_bundle - 1);
    strand.way += strand.blend[k] * column.way;
    root.edge += strand.blend[k] * column.edge;
    root.outward += strand.blend[k] * column.outward;
  }
  return root;
}

StrandGrowth::Group StrandGrowth::groupOf(const Vector3f& root, float size, uint level) const {
  const Vector3f cell = (root / size).array() - 0.5f;
  const Eigen::Vector3i base = cell.array().floor().cast<int>();
  Group group{Vector3f::Zero(), 0};
  float nearest = 1e30f;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3i at = base + Eigen::Vector3i(i & 1, (i >> 1) & 1, i >> 2);
    const uint key = hash(static_cast<uint>(at.x()) * 73856093u ^ static_cast<uint>(at.y()) * 19349663u ^
                              static_cast<uint>(at.z()) * 83492791u,
                          look_.seed + level);
    const Vector3f jitter = Vector3f(static_cast<float>(key & 1023u), static_cast<float>((key >> 10u) & 1023u),
                                     static_cast<float>((key >> 20u) & 1023u)) *
                            (1.0f / 1024.0f);
    const Vector3f gap = at.cast<float>() + (0.8f * (jitter.array() - 0.5f)).matrix() - cell;
    const float squared = gap.squaredNorm();
    if (squared < nearest) {
      nearest = squared;
      group = {gap, key};
    }
  }
  return group;
}

void StrandGrowth::joinGroups(const Root& root, Strand& strand) const {
  const auto inPlane = [&](const Vector3f& gap) { return Vector2f(gap.dot(root.axis_u), gap.dot(root.axis_v)); };
  const float size = std::max(look_.clump_size, 1e-4f);
  const Group clump = groupOf(root.rest, size, 0u), lock = groupOf(root.rest, kLockSize * size, 1u),
              wisp = groupOf(root.rest, kWispSize * size, 2u);
  strand.clump_key = clump.key;
  strand.lock_key = lock.key;
  strand.clump = size * inPlane(clump.gap);
  strand.lock = kLockSize * size * inPlane(lock.gap);
  strand.wisp = kWispSize * size * inPlane(wisp.gap);
  strand.fan =
      2.718282f * look_.root_spread * std::sqrt(randomOf(strand.key, 32u)) * onCircle(randomOf(strand.key, 33u));
  const float frizzy = std::min(look_.frizz * strand.share.frizz * 200.0f, 0.8f) * randomOf(strand.key, 24u);
  strand.hold = (1.0f - strand.loose) * (1.0f - frizzy) * (0.75f + 0.25f * randomOf(strand.key, 5u));
}

void StrandGrowth::thinHairline(const Root& root, Strand& strand) const {
  if (look_.hairline <= 0.0f) return;
  const float ragged = 0.6f * (randomOf(strand.clump_key, 23u) - 0.5f);
  const float inside = std::clamp(root.edge / look_.hairline + ragged, 0.0f, 1.0f);
  const float chance = randomOf(strand.key, 18u), grown = 0.15f + 0.85f * smoothstep(0.0f, 0.8f, inside);
  strand.rim = 1.0f - inside;
  strand.fine = randomOf(strand.key, 19u) < look_.baby_hairs * strand.rim ? 1.0f : 0.0f;
  if (chance > mix(grown, 1.0f, 0.8f * strand.fine)) strand.gain = 0.0f;
  strand.astray = strand.fine * (0.9f * randomOf(strand.key, 6u) - 0.3f) * root.outward;
  const float alone = randomOf(strand.key, 31u), wisp = randomOf(strand.clump_key, 31u);
  const float before = 0.35f * (alone * alone + wisp * wisp * wisp);
  strand.shift = strand.rim * look_.hairline * before * root.outward;
  strand.gain *= 1.0f - mix(0.3f, 0.6f, strand.fine) * strand.rim * alone;
}

void StrandGrowth::cutStrand(const Root& root, Strand& strand) const {
  const float own = randomOf(strand.key, 4u), apart = strand.clump.norm() / (0.6f * std::max(look_.clump_size, 1e-4f));
  const float early = 0.4f * own * own + 0.25f * randomOf(strand.clump_key, 4u) + 0.2f * randomOf(strand.lock_key, 4u) +
                      0.15f * std::min(apart * apart, 1.0f);
  strand.end = root.cut * (1.0f - look_.length_variation * early);
  const Vector2f chance(randomOf(strand.key, 22u), randomOf(strand.key, 25u));
  if (strand.fine > 0.0f) {
    strand.end = std::min(strand.end, layersAt(strand, 0.006f + 0.028f * chance.x() * chance.x()));
    strand.gain *= 0.25f + 0.3f * chance.y();
    strand.hold = 0.0f;
    if (2.0f * strand.end <= static_cast<float>(strand.layers - 1)) strand.segments *= 2.0f;
  } else if (strand.loose > 0.0f) {
    if (chance.x() < 0.4f) strand.end = std::min(strand.end, layersAt(strand, 0.02f + 0.12f * chance.y()));
    strand.gain *= 0.7f;
  }
  strand.metres = wayAt(strand, strand.end).x();
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
  strand.loose = !face.covered && randomOf(strand.key, 3u) < look_.flyaways ? 1.0f : 0.0f;
  strand.root = facePoint(of, index, strand.key, look_.seed);
  if (corners == 4)
    weighQuad(strand.root, columns, strand);
  else
    weighTriangle(strand.root, columns, strand);
  Root root = rootOf(columns, corners, strand);
  const Vector2f& p = strand.root;
  root.edge += layout_.face_edge[low] * (corners == 4 ? 16.0f * p.x() * p.y() * (1.0f - p.x()) * (1.0f - p.y())
                                                      : 27.0f * strand.blend[0] * strand.blend[1] * strand.blend[2]);
  strand.share = shareOfRoot(layout_, columns, strand.blend);
  joinGroups(root, strand);
  thinHairline(root, strand);
  if (face.covered) strand.fan = strand.shift = Vector2f::Zero();
  cutStrand(root, strand);
  return strand;
}

Vector2f StrandGrowth::groupPull(const Strand& strand, float layer) const {
  const float way = wayAt(strand, layer).x(), far = way / kFanReach;
  const Vector2f own = strand.shift + far * std::exp(-far) * strand.fan;
  if (strand.fine > 0.0f) return own + way * strand.astray;
  const float t = layer / static_cast<float>(strand.layers - 1);
  Vector2f pull = strand.hold * look_.wisp * smoothstep(0.0f, 0.25f, t) * strand.wisp;
  float clump = look_.clump;
  if (!layout_.root_shares.empty())
    clump *= strand.share.clump * shareAlong(layout_, layer / std::max(strand.end, 1e-3f)).clump;
  pull += strand.hold * clump * clumpClosing(t, strand.clump_key) * (strand.clump - pull);
  pull += strand.hold * look_.lock * lockClosing(t) * (strand.lock - pull);
  return own + pull;
}

StrandGrowth::LayerPoint StrandGrowth::layerPoint(const Strand& strand, int layer) const {
  LayerPoint point{Vector4f::Zero(), Vector4f::Zero(), Vector4f::Zero()};
  for (int k = 0; k < 4; ++k) {
    const Vector4f* texels = &texels_[static_cast<std::size_t>(kVertexTexels) * (strand.first[k] + layer)];
    point.position += strand.weight[k] * texels[0] + strand.along_u[k] * texels[1] + strand.along_v[k] * texels[2];
    point.axis_u += strand.blend[k] * texels[1];
    point.axis_v += strand.blend[k] * texels[2];
  }
  point.axis_u *= shared::kMaxSpread / std::max(point.axis_u.norm(), shared::kMaxSpread);
  point.axis_v *= shared::kMaxSpread / std::max(point.axis_v.norm(), shared::kMaxSpread);
  const Vector2f pull = groupPull(strand, static_cast<float>(layer));
  point.position += pull.x() * point.axis_u + pull.y() * point.axis_v;
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

void StrandGrowth::addWander(const Strand& strand, float s, Vector4f& bend) const {
  const float span =
      strand.loose + strand.fine > 0.0f ? std::max(strand.end, 1e-3f) : static_cast<float>(strand.layers - 1);
  const float t = s / span;
  const float reach =
      look_.offset * (1.0f + 5.0f * strand.loose + 3.0f * strand.rim) + 0.06f * strand.fine * strand.metres;
  const Vector2f away = reach * std::sqrt(randomOf(strand.key, 9u)) * onCircle(randomOf(strand.key, 8u));
  const Vector2f grow(t * (1.6f - 0.6f * t), (1.6f - 1.2f * t) / span);
  const float turns = 0.7f + 0.8f * randomOf(strand.key, 10u);
  bend.head<2>() += 0.6f * grow.x() * away;
  bend.tail<2>() += 0.6f * grow.y() * away;
  addSwing(bend, 0.4f * away, grow, 2.0f * kPi * Vector2f(turns * t + randomOf(strand.key, 11u), turns / span));
}

void StrandGrowth::addDrift(const Strand& strand, const Vector2f& way, Vector4f& bend) const {
  const float reach = look_.drift * strand.hold;
  addSwing(bend, 1.5f * reach * onCircle(randomOf(strand.lock_key, 10u)), opening(way, 0.08f),
           swingAngle(way, 0.12f + 0.13f * randomOf(strand.lock_key, 11u), randomOf(strand.lock_key, 12u)));
  addSwing(bend, reach * onCircle(randomOf(strand.clump_key, 10u)), opening(way, 0.05f),
           swingAngle(way, 0.06f + 0.07f * randomOf(strand.clump_key, 11u), randomOf(strand.clump_key, 12u)));
}

void StrandGrowth::addCurl(const Strand& strand, float s, const Vector2f& way, Vector4f& bend) const {
  const float pitch = std::max(look_.curl_pitch, 1e-3f) * (0.8f + 0.4f * randomOf(strand.clump_key, 8u));
  const float hand = randomOf(strand.clump_key, 13u) < 0.5f ? -1.0f : 1.0f;
  const Vector2f angle =
      swingAngle(way, pitch, randomOf(strand.clump_key, 9u) + 0.15f * (randomOf(strand.key, 12u) - 0.5f));
  Vector2f radius = look_.curl_radius *
                    (0.7f + 0.4f * randomOf(strand.clump_key, 14u) + 0.3f * randomOf(strand.key, 13u)) *
                    opening(way, 0.025f);
  if (!layout_.root_shares.empty()) {
    const float span = std::max(strand.end, 1e-3f);
    LookShare rate;
    const float share = shareAlong(layout_, s / span, &rate).curl;
    radius = strand.share.curl * Vector2f(radius.x() * share, radius.y() * share + radius.x() * rate.curl / span);
  }
  const float c = std::cos(angle.x()), d = hand * std::sin(angle.x());
  bend += Vector4f(radius.x() * c, radius.x() * d, radius.y() * c - radius.x() * d * hand * angle.y(),
                   radius.y() * d + radius.x() * c * hand * angle.y());
}

void StrandGrowth::addWave(const Strand& strand, const Vector2f& way, Vector4f& bend) const {
  const float wave_length = std::max(look_.wave_length, 1e-3f) * (0.85f + 0.3f * randomOf(strand.lock_key, 14u));
  const float phase = 0.6f * randomOf(strand.lock_key, 15u) + 0.12f * (randomOf(strand.key, 26u) - 0.5f);
  const float height = look_.wave_height * (0.8f + 0.4f * randomOf(strand.key, 27u));
  addSwing(bend, 0.5f * height * onCircle(randomOf(strand.lock_key, 16u)), opening(way, 0.035f),
           swingAngle(way, wave_length, phase));
}

void StrandGrowth::addFrizz(const Strand& strand, const Vector2f& way, Vector4f& bend) const {
  const float own = randomOf(strand.key, 28u), reach = look_.frizz * strand.share.frizz * (0.3f + 1.7f * own * own);
  const Vector2f open = opening(way, 0.03f);
  for (uint axis = 0; axis < 2; ++axis)
    addSwing(bend, axis == 0 ? Vector2f(reach, 0.0f) : Vector2f(0.0f, reach), open,
             swingAngle(way, 0.025f + 0.05f * randomOf(strand.key, 14u + axis), randomOf(strand.key, 16u + axis)));
}

Vector4f StrandGrowth::sideways(const Strand& strand, float s) const {
  const Vector2f way = wayAt(strand, s);
  Vector4f bend = Vector4f::Zero();
  addWander(strand, s, bend);
  if (look_.drift > 0.0f) addDrift(strand, way, bend);
  if (look_.curl_radius > 0.0f) addCurl(strand, s, way, bend);
  if (look_.wave_height > 0.0f) addWave(strand, way, bend);
  if (look_.frizz > 0.0f) addFrizz(strand, way, bend);
  return bend;
}

Vector2f StrandGrowth::lifted(const Strand& strand, float s) const {
  const float chance = randomOf(strand.key, 29u);
  const float lift = strand.loose * look_.flyaway_lift * (0.2f + 1.8f * chance * chance) +
                     0.35f * strand.fine * chance * strand.metres;
  return lift * opening(wayAt(strand, s), 0.3f * std::min(strand.metres, 0.15f) + 1e-4f);
}

// As if there were no skin.
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
  Vector3f along = slope + aside * bend.z() + across * bend.w();
  if (strand.loose + strand.fine > 0.0f) {
    Vector3f outward = unitOr(base - center_, Vector3f::Zero());
    outward -= axis * axis.dot(outward);
    const Vector2f stray = lifted(strand, s);
    point.position += stray.x() * outward;
    along += stray.y() * outward;
  }
  point.tangent = unitOr(along, axis);
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
  Eigen::AlignedBox3f around;
  for (std::size_t index = 0; index < points.size(); ++index) {
    const float s = parameter(index);
    moveWindow(strand, layerOf(strand, s), layer, window);
    points[index] = curvePoint(strand, window, s, s - static_cast<float>(layer));
    around.extend(points[index].position);
  }
  const SkinAround near = skin_.near(around);
  SkinLift lift;
  for (std::size_t index = 0; index < points.size(); ++index) {
    CurvePoint& point = points[index];
    leaveSkin(near.ellipsoids, near.grids, parameter(index), lift, point.position, point.tangent);
    point.tangent = unitOr(point.tangent, Vector3f::UnitY());
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
  const float radius = strand.gain * root_radius_ * mix(1.0f, look_.taper, along * along);
  return layout_.root_shares.empty() ? radius : radius * strand.share.width * shareAlong(layout_, along).width;
}

Float3 StrandGrowth::color(const Strand& strand, float along) const {
  const Float3 here = shareAlong(layout_, along).color, &root = strand.share.color;
  return {root[0] * here[0], root[1] * here[1], root[2] * here[2]};
}

}  // namespace render

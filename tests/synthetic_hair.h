// A hair and a body that need no other part of the program: a cap of triangles and quadrilaterals on a ball, columns
// combed away from a parting and falling around it, and an egg-shaped bust with shoulders. For the renderer's tests.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "render/frame_input.h"

namespace synthetic {

struct Hair {
  std::vector<render::HairFace> faces;
  std::vector<float> positions;
  int layers = 0;
};

struct Body {
  std::vector<float> positions, normals, weights;
  std::vector<std::uint32_t> triangles;
  std::vector<std::uint16_t> joints;
  std::array<render::Mat4, 1> joint_matrices{render::Mat4{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
};

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kHeadHeight = 1.6f, kHeadRadius = 0.095f;

inline float smooth(float x) {
  x = std::clamp(x, 0.0f, 1.0f);
  return x * x * (3 - 2 * x);
}

// Polar angle of the hairline: high over the forehead (azimuth 0), low at the nape.
inline float hairline(float azimuth) {
  return 1.15f + 1.0f * smooth(std::abs(azimuth) / kPi * 1.15f);
}

// One column: from polar angle `polar` it follows the head, lifted the more the nearer to the crown it roots, then
// falls.
inline void growColumn(float polar, float azimuth, int layers, float length, std::vector<float>& positions) {
  const float share = polar / hairline(azimuth);
  const float lift = 0.004f + 0.022f * (1 - share);
  const float side = azimuth >= 0 ? 1.0f : -1.0f;
  const float turned = std::max(0.0f, 1.75f - std::abs(azimuth)) * side;
  float at_polar = polar, height = 0;
  for (int layer = 0; layer < layers; ++layer) {
    const float t = static_cast<float>(layer) / static_cast<float>(layers - 1);
    const float around = azimuth + turned * smooth(1.5f * t);
    const float raised = kHeadRadius + lift * smooth(4 * t) + 0.01f * t;
    const float radius = raised * std::sin(std::min(at_polar, 1.75f));
    const float drop = raised * std::cos(std::min(at_polar, 1.75f)) - height;
    positions.insert(positions.end(), {radius * std::sin(around), kHeadHeight + drop, radius * std::cos(around)});
    const float step = length / static_cast<float>(layers - 1);
    const float arc = std::min(step, std::max(0.0f, 1.75f - at_polar) * raised);
    at_polar += arc / raised;
    height += step - arc;
  }
}

// 1 + 4 x 10 columns: a fan of triangles at the crown, rings of quadrilaterals below; 369 vertices with 9 layers.
inline Hair makeHair(int layers = 9) {
  constexpr int kAround = 10, kRings = 4;
  Hair hair;
  hair.layers = layers;
  const float bottom = kHeadHeight - 0.24f;
  const auto grow = [&](float polar, float azimuth) {
    const float start = kHeadHeight + kHeadRadius * std::cos(polar);
    growColumn(polar, azimuth, layers, (start - bottom) * 1.12f, hair.positions);
  };
  grow(0.02f, kPi);
  for (int ring = 1; ring <= kRings; ++ring) {
    for (int i = 0; i < kAround; ++i) {
      const float azimuth = std::remainder(2 * kPi * (static_cast<float>(i) + 0.5f) / kAround, 2 * kPi);
      grow(hairline(azimuth) * static_cast<float>(ring) / kRings, azimuth);
    }
  }
  const auto first = [&](int ring, int i) { return ring == 0 ? 0 : (1 + (ring - 1) * kAround + i % kAround) * layers; };
  for (int ring = 0; ring < kRings; ++ring) {
    for (int i = 0; i < kAround; ++i) {
      render::HairFace face;
      face.layers = layers;
      if (ring == 0) {
        face.first_vertex = {first(0, 0), first(1, i), first(1, i + 1), -1};
      } else {
        face.first_vertex = {first(ring, i), first(ring + 1, i), first(ring + 1, i + 1), first(ring, i + 1)};
      }
      const auto at = [&](int k, int axis) { return hair.positions[3 * face.first_vertex[k] + axis]; };
      const int last = face.first_vertex[3] < 0 ? 2 : 3, middle = face.first_vertex[3] < 0 ? 1 : 2;
      std::array<float, 3> a{}, b{};
      for (int axis = 0; axis < 3; ++axis) {
        a[axis] = at(middle, axis) - at(0, axis);
        b[axis] = at(last, axis) - at(last == 2 ? 0 : 1, axis);
      }
      const float x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
      face.area = 0.5f * std::sqrt(x * x + y * y + z * z);
      hair.faces.push_back(face);
    }
  }
  return hair;
}

// Adds a surface of revolution about the y axis, squeezed in z.
inline void addLathe(const std::vector<std::array<float, 2>>& profile, float depth, Body& body) {
  constexpr int kAround = 40;
  const auto base = static_cast<std::uint32_t>(body.positions.size() / 3);
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const std::size_t before = i > 0 ? i - 1 : 0, after = std::min(i + 1, profile.size() - 1);
    const float dr = profile[after][0] - profile[before][0], dy = profile[after][1] - profile[before][1];
    for (int j = 0; j < kAround; ++j) {
      const float angle = 2 * kPi * static_cast<float>(j) / kAround;
      const float s = std::sin(angle), c = std::cos(angle), r = profile[i][0];
      body.positions.insert(body.positions.end(), {r * s, profile[i][1], depth * r * c});
      std::array<float, 3> n{-dy * s, dr, -dy * c / depth};
      const float length = std::max(std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), 1e-9f);
      body.normals.insert(body.normals.end(), {n[0] / length, n[1] / length, n[2] / length});
      body.joints.insert(body.joints.end(), {0, 0, 0, 0});
      body.weights.insert(body.weights.end(), {1, 0, 0, 0});
    }
  }
  for (std::uint32_t i = 0; i + 1 < profile.size(); ++i) {
    for (std::uint32_t j = 0; j < kAround; ++j) {
      const std::uint32_t a = base + i * kAround + j, b = base + i * kAround + (j + 1) % kAround;
      body.triangles.insert(body.triangles.end(), {a, a + kAround, b, b, a + kAround, b + kAround});
    }
  }
}

// Head, neck and shoulders, standing on the ground as a column so that shadows fall.
inline Body makeBody() {
  Body body;
  std::vector<std::array<float, 2>> head, bust;
  for (int i = 0; i <= 24; ++i) {
    const float angle = kPi * static_cast<float>(i) / 24;
    const float narrow = 1 - 0.22f * smooth(-std::cos(angle));
    head.push_back({0.094f * std::sin(angle) * narrow, kHeadHeight - 0.015f + 0.108f * std::cos(angle)});
  }
  for (const auto& [r, y] : {std::pair{0.045f, 1.56f},
                             {0.048f, 1.47f},
                             {0.07f, 1.435f},
                             {0.13f, 1.41f},
                             {0.17f, 1.37f},
                             {0.185f, 1.3f},
                             {0.17f, 1.15f},
                             {0.14f, 1.0f},
                             {0.16f, 0.85f},
                             {0.14f, 0.4f},
                             {0.1f, 0.0f}}) {
    bust.push_back({r, y});
  }
  addLathe(head, 1.08f, body);
  addLathe(bust, 0.6f, body);
  return body;
}

// Every variation off: strands are the hair mesh's own curves.
inline render::HairLook plainLook() {
  render::HairLook look;
  look.length_variation = look.offset = look.clump = look.lock = look.wisp = look.drift = look.root_spread =
      look.curl_radius = look.wave_height = look.frizz = look.flyaways = look.hairline = 0;
  return look;
}

inline render::HairInput hairInput(const Hair& hair, int strands) {
  render::HairInput input;
  input.id = 1;
  input.layout_revision = 1;
  input.position_revision = 1;
  input.faces = hair.faces;
  input.positions = hair.positions;
  input.strands = strands;
  return input;
}

// A ball of skin: centre and radius, m.
inline render::SkinEllipsoid skinBall(const render::Float3& center, float radius) {
  render::SkinEllipsoid skin;
  for (std::size_t k = 0; k < 3; ++k) {
    skin.to_ball[k][k] = 1 / radius;
    skin.to_ball[k][3] = -center[k] / radius;
  }
  return skin;
}

inline render::BodyInput bodyInput(const Body& body) {
  render::BodyInput input;
  input.id = 1;
  input.mesh_id = 1;
  input.hair_id = 1;  // of hairInput
  input.positions = body.positions;
  input.normals = body.normals;
  input.triangles = body.triangles;
  input.joints = body.joints;
  input.weights = body.weights;
  input.joint_matrices = body.joint_matrices;
  input.pose_revision = 1;
  return input;
}

// A frame of one hair and one body; the spans point into the arguments.
inline render::FrameInput frameInput(std::span<const render::HairInput> hairs,
                                     std::span<const render::BodyInput> bodies, int width, int height) {
  render::FrameInput input;
  input.width = width;
  input.height = height;
  input.hairs = hairs;
  input.bodies = bodies;
  input.camera.eye = {0.35f, 1.62f, 0.95f};
  input.camera.target = {0, 1.52f, 0};
  return input;
}

}  // namespace synthetic

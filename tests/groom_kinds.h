// Grooms of several kinds, grown by code: what the conversion is measured on. Metres, y up, z forward, root first.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include "app/groom/fit/grown_groom.h"
#include "app/groom/groom.h"
#include "app/styles/hair_styles.h"
#include "tests/analytic_head.h"

namespace groom_kinds {

using Eigen::Vector3f;

struct Kind {
  std::string name, what;
  std::function<app::Groom(int strands)> make;
  // Bounds for 1,000 strands and 1,000 vertices; distances of the strands' length. A fifth above what was measured.
  double mean, share95, silhouette;
  friend std::ostream& operator<<(std::ostream& stream, const Kind& kind) { return stream << kind.name; }
};

inline float random(std::uint32_t key) {
  std::uint32_t x = key * 747796405u + 2891336453u;
  x = ((x >> ((x >> 28u) + 4u)) ^ x) * 277803737u;
  return static_cast<float>(((x >> 22u) ^ x) >> 8u) / 16777216.0f;
}

// An egg of a head and what grows on it.
struct Head {
  Vector3f radii{0.074f, 0.096f, 0.090f};

  Vector3f surface(const Vector3f& direction) const { return direction / direction.cwiseQuotient(radii).norm(); }
  Vector3f normal(const Vector3f& p) const { return p.cwiseQuotient(radii.cwiseProduct(radii)).normalized(); }
  float height(const Vector3f& p) const { return p.norm() - surface(p.normalized()).norm(); }
};

// Where strand `i` of `count` roots: over the upper and back part, evenly; a spiral.
inline Vector3f rootDirection(int i, int count, float widest = 1.75f) {
  const float share = (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
  const float polar = std::acos(1 - share * (1 - std::cos(widest))), azimuth = 2.3999632f * static_cast<float>(i);
  const Vector3f local(std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth));
  return Eigen::AngleAxisf(-0.55f, Vector3f::UnitX()) * local;
}

struct March {
  float length = 0.2f;
  float lift = 0.004f, rise = 0.06f;  // m over the scalp at once, and per length: upper hair comes from farther
  float weight = 10;                  // 1 / m, how fast strands turn down
  int points = 33;
};

// A strand that leaves along `way`, follows the scalp and falls.
inline std::vector<Vector3f> march(const Head& head, const Vector3f& root, Vector3f way, const March& march) {
  std::vector<Vector3f> line{root};
  const float step = march.length / static_cast<float>(march.points - 1);
  Vector3f p = root;
  for (int k = 1; k < march.points; ++k) {
    const float s = step * static_cast<float>(k);
    way = (way - march.weight * step * Vector3f::UnitY()).normalized();
    Vector3f next = p + step * way;
    const float wanted = march.lift * (1 - std::exp(-s / 0.012f)) + march.rise * s;
    if (head.height(next) < wanted) next += (wanted - head.height(next)) * head.normal(next);
    way = (next - p).normalized();
    p += step * way;
    line.push_back(p);
  }
  return line;
}

inline void add(const std::vector<Vector3f>& line, app::Groom& groom) {
  groom.points.insert(groom.points.end(), line.begin(), line.end());
  groom.strand_first.push_back(static_cast<std::uint32_t>(groom.points.size()));
}

inline Vector3f tangent(const Head& head, const Vector3f& root, const Vector3f& way) {
  const Vector3f n = head.normal(root);
  return (way - way.dot(n) * n).normalized();
}

// All hair away from the parting: a plane x = at over the top of the head, back to the crown.
inline app::Groom parted(int strands, float at, float length, int points = 33) {
  const Head head;
  app::Groom groom;
  for (int i = 0; i < strands; ++i) {
    const Vector3f root = head.surface(rootDirection(i, strands));
    const float side = root.x() > at ? 1.0f : -1.0f, back = std::clamp((0.02f - root.z()) / 0.08f, 0.0f, 1.0f);
    const Vector3f away =
        side * (1 - back) * Vector3f::UnitX() +
        Vector3f(0.6f * root.x() / 0.07f, -1.6f * std::clamp(-root.z() / 0.08f, 0.0f, 1.0f), -0.5f - back);
    March way;
    way.length = length * (1 + 0.05f * (random(static_cast<std::uint32_t>(i)) - 0.5f));
    way.points = points;
    add(march(head, root, tangent(head, root, away), way), groom);
  }
  return groom;
}

// Swept back from the forehead.
inline std::vector<Vector3f> sweptBack(const Head& head, const Vector3f& root, float length, int points) {
  March way;
  way.length = length;
  way.points = points;
  way.weight = 7;
  return march(
      head, root,
      tangent(head, root, Vector3f(0.9f * root.x() / 0.07f, -1.6f * std::clamp(-root.z() / 0.08f, 0.0f, 1.0f), -1)),
      way);
}

// Adds what `offset` says at (share of the length, root) in the frame of each strand.
template <class Offset>
void bendStrand(std::vector<Vector3f>& line, const Offset& offset) {
  std::vector<Vector3f> bent = line;
  Vector3f aside = Vector3f::UnitX();
  for (std::size_t k = 0; k < line.size(); ++k) {
    const Vector3f along = (line[std::min(k + 1, line.size() - 1)] - line[k > 0 ? k - 1 : 0]).normalized();
    aside = (aside - along.dot(aside) * along).normalized();
    const Eigen::Vector2f away = offset(static_cast<float>(k) / static_cast<float>(line.size() - 1));
    bent[k] += away.x() * aside + away.y() * along.cross(aside);
  }
  line = bent;
}

inline float opened(float t) {
  const float x = std::clamp(t / 0.35f, 0.0f, 1.0f);
  return x * x * (3 - 2 * x);
}

inline app::Groom wavy(int strands) {
  const Head head;
  app::Groom groom;
  for (int i = 0; i < strands; ++i) {
    const Vector3f root = head.surface(rootDirection(i, strands));
    std::vector<Vector3f> line = sweptBack(head, root, 0.28f, 65);
    bendStrand(line, [&](float t) {
      return Eigen::Vector2f(0.007f * opened(t) * std::sin(2 * std::numbers::pi_v<float> * 2.5f * t + 12 * root.x()),
                             0);
    });
    add(line, groom);
  }
  return groom;
}

inline app::Groom curly(int strands, float radius = 0.0025f, float turns = 7) {
  const Head head;
  app::Groom groom;
  for (int i = 0; i < strands; ++i) {
    const Vector3f root = head.surface(rootDirection(i, strands));
    std::vector<Vector3f> line = sweptBack(head, root, 0.25f, 129);
    const float phase = 2 * std::numbers::pi_v<float> * random(static_cast<std::uint32_t>(i) + 77u);
    bendStrand(line, [&](float t) {
      const float turn = 2 * std::numbers::pi_v<float> * turns * t + phase;
      return Eigen::Vector2f(radius * opened(t) * Eigen::Vector2f(std::cos(turn), std::sin(turn)));
    });
    add(line, groom);
  }
  return groom;
}

// Away from one point of the crown, and turning about it.
inline app::Groom whorl(int strands, float length, int points = 17) {
  const Head head;
  app::Groom groom;
  const Vector3f crown = head.surface(Vector3f(0.012f, 0.85f, -0.55f).normalized());
  for (int i = 0; i < strands; ++i) {
    const Vector3f root = head.surface(rootDirection(i, strands)), out = tangent(head, root, root - crown);
    const float turn = 0.8f * std::exp(-(root - crown).norm() / 0.05f);
    March way{length, 0.006f, 0.25f, 6, points};
    add(march(head, root, std::cos(turn) * out + std::sin(turn) * head.normal(root).cross(out), way), groom);
  }
  return groom;
}

// Four millimetres over the whole head, leaning away from the crown.
inline app::Groom stubble(int strands) {
  const Head head;
  app::Groom groom;
  for (int i = 0; i < strands; ++i) {
    const Vector3f root = head.surface(rootDirection(i, strands));
    const Vector3f way = (head.normal(root) + 0.8f * tangent(head, root, Vector3f(0, -0.3f, 1))).normalized();
    add({root, root + 0.002f * way, root + 0.004f * way}, groom);
  }
  return groom;
}

// Three centimetres that stand off and lean forward.
inline app::Groom cropped(int strands) {
  const Head head;
  app::Groom groom;
  for (int i = 0; i < strands; ++i) {
    const Vector3f root = head.surface(rootDirection(i, strands)), out = head.normal(root);
    const Vector3f lean = tangent(head, root, Vector3f(0, -0.3f, 1));
    std::vector<Vector3f> line;
    for (int k = 0; k < 17; ++k) {
      const float t = static_cast<float>(k) / 16;
      line.push_back(root + 0.03f * (t * out + 0.5f * t * t * lean));
    }
    add(line, groom);
  }
  return groom;
}

// All hair to a tie behind the head, and on in a tail. What comes from farther lies outside.
inline app::Groom ponytail(int strands, int points = 49) {
  const Head head;
  app::Groom groom;
  const Vector3f knot = head.surface(Vector3f(0, 0.45f, -1).normalized());
  const Vector3f out = head.normal(knot), across = Vector3f::UnitX(), up = across.cross(out);
  for (int i = 0; i < strands; ++i) {
    const Vector3f root = head.surface(rootDirection(i, strands));
    const Vector3f start = root.normalized(), end = knot.normalized();
    const float angle = std::acos(std::clamp(start.dot(end), -1.0f, 1.0f));
    const Vector3f from = (root - knot) - (root - knot).dot(out) * out;
    const float far = angle / 1.9f;
    const Vector3f side = far * from.stableNormalized();
    const Vector3f tie = knot + (0.030f + 0.004f * far) * out + 0.014f * side;
    std::vector<Vector3f> control;
    for (int k = 0; k <= 12; ++k) {  // over the scalp towards the knot, higher the farther it has come
      const float t = 0.86f * static_cast<float>(k) / 12;
      const Vector3f on = head.surface((start * std::sin((1 - t) * angle) + end * std::sin(t * angle)) /
                                       std::max(std::sin(angle), 1e-3f));
      control.push_back(on + (k > 0 ? 1.0f : 0.0f) * (0.004f + 0.02f * far * t) * head.normal(on));
    }
    control.push_back(tie);
    for (int k = 1; k <= 10; ++k) {  // the tail: out, then down
      const float s = 0.022f * static_cast<float>(k), turn = std::min(s / 0.06f, 1.35f);
      const Vector3f middle = 0.06f * (std::sin(turn) * out - (1 - std::cos(turn)) * up) +
                              std::max(0.0f, s - 0.081f) * (std::cos(turn) * out - std::sin(turn) * up);
      const Vector3f turned_up = std::cos(turn) * up + std::sin(turn) * out;
      control.push_back(tie + middle + 0.014f * (side.dot(up) * (turned_up - up)));
    }
    std::vector<Vector3f> even(static_cast<std::size_t>(points));
    double length = 0;
    for (std::size_t k = 1; k < control.size(); ++k) length += (control[k] - control[k - 1]).norm();
    std::size_t segment = 0;
    double passed = 0;
    for (int k = 0; k < points; ++k) {
      const double wanted = length * k / (points - 1);
      while (segment + 2 < control.size() && passed + (control[segment + 1] - control[segment]).norm() < wanted) {
        passed += (control[segment + 1] - control[segment]).norm();
        ++segment;
      }
      const double piece = (control[segment + 1] - control[segment]).norm();
      even[static_cast<std::size_t>(k)] =
          control[segment] + static_cast<float>(std::clamp((wanted - passed) / piece, 0.0, 1.0)) *
                                 (control[segment + 1] - control[segment]);
    }
    add(even, groom);
  }
  return groom;
}

// Swept back, but every tenth strand of a patch goes to the side: no one hair mesh holds it.
inline app::Groom twoWays(int strands) {
  const Head head;
  app::Groom groom;
  for (int i = 0; i < strands; ++i) {
    const Vector3f root = head.surface(rootDirection(i, strands));
    const bool other = root.x() > 0.02f && root.z() > -0.03f && i % 3 == 0;
    if (!other) {
      add(sweptBack(head, root, 0.2f, 33), groom);
    } else {
      March way;
      add(march(head, root, tangent(head, root, Vector3f(0.3f, 0, 1)), way), groom);
    }
  }
  return groom;
}

inline app::Groom styled(app::Style style, app::Resolution resolution, int strands) {
  render::HairLook look;
  look.offset = look.clump = look.frizz = look.flyaways = 0;
  look.lock = look.wisp = look.drift = look.root_spread = look.hairline = look.baby_hairs = 0;
  return app::growGroom(app::makeStyle(style, resolution, tests::analyticScalp(), tests::bodyDistance), look, strands,
                        33);
}

inline std::vector<Kind> kinds() {
  using app::Resolution, app::Style;
  return {
      {"short", "the short style, low", [](int n) { return styled(Style::kShort, Resolution::kLow, n); }, 0.0122,
       0.0318, 0.8},
      {"shoulder", "the shoulder style, medium", [](int n) { return styled(Style::kShoulder, Resolution::kMedium, n); },
       0.0108, 0.0343, 0.8},
      {"long", "the long style, low", [](int n) { return styled(Style::kLong, Resolution::kLow, n); }, 0.0112, 0.0364,
       0.68},
      {"cropped", "3 cm, leaning forward", cropped, 0.0112, 0.0378, 0.79},
      {"swept back", "straight, 20 cm",
       [](int n) {
         app::Groom groom;
         for (int i = 0; i < n; ++i) add(sweptBack(Head{}, Head{}.surface(rootDirection(i, n)), 0.2f, 33), groom);
         return groom;
       },
       0.0074, 0.0213, 0.81},
      {"wavy", "28 cm in waves of 7 mm", wavy, 0.0107, 0.0244, 0.72},
      {"curly", "25 cm in curls of 2.5 mm, each its own", [](int n) { return curly(n); }, 0.016, 0.0278, 0.74},
      {"parted", "parted aside, 22 cm", [](int n) { return parted(n, 0.02f, 0.22f); }, 0.0063, 0.018, 0.85},
      {"ponytail", "to a tie behind the head, and on", [](int n) { return ponytail(n); }, 0.0051, 0.0124, 0.86},
      {"two ways", "a third of a patch goes forward", twoWays, 1, 1, 0},
  };
}

}  // namespace groom_kinds

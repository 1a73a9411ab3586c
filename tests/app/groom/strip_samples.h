// Strips, cards and tubes as OBJ text: hair of known rows.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace strip_samples {

using Eigen::Vector3d;

// Text of an OBJ file that grows.
struct ObjText {
  std::string text;
  int vertices = 0;
  double scale = 1;   // units a metre
  bool z_up = false;  // z up, facing -y

  int vertex(const Vector3d& given) {
    const Vector3d p = z_up ? Vector3d(given.x(), -given.z(), given.y()) : given;
    char line[120];
    std::snprintf(line, sizeof line, "v %.9g %.9g %.9g\n", scale * p.x(), scale * p.y(), scale * p.z());
    text += line;
    return ++vertices;
  }
  void object(const std::string& name) { text += "o " + name + "\n"; }
  void face(const std::vector<int>& corners) {
    text += "f";
    for (const int c : corners) text.append(" ").append(std::to_string(c));
    text += "\n";
  }
  // `cut`: as two triangles, alternately over either diagonal where it is 2.
  void quad(int a, int b, int c, int d, int cut = 0) {
    if (cut == 0) return face({a, b, c, d});
    static int turn = 0;
    if (cut == 1 || turn++ % 2 == 0) {
      face({a, b, c});
      face({a, c, d});
    } else {
      face({a, b, d});
      face({b, c, d});
    }
  }
};

// A card of `across` x `down` quads, 3 cm wide and 20 cm long, that hangs from `root`, bent about its width by `bend`
// (rad) from root to tip.
inline void card(const Vector3d& root, int across, int down, double bend, int cut, ObjText& out, double width = 0.03,
                 double length = 0.2) {
  std::vector<std::vector<int>> rows;
  Vector3d place = root;
  for (int r = 0; r <= down; ++r) {
    const double angle = bend * (r - 0.5) / down;
    if (r > 0) place += length / down * Vector3d(0, -std::cos(angle), std::sin(angle));
    rows.emplace_back();
    for (int k = 0; k <= across; ++k)
      rows.back().push_back(out.vertex(place + Vector3d(width * (static_cast<double>(k) / across - 0.5), 0, 0)));
  }
  for (int r = 0; r < down; ++r) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(across); ++k) {
      const auto row = static_cast<std::size_t>(r);
      out.quad(rows[row][k], rows[row][k + 1], rows[row + 1][k + 1], rows[row + 1][k], cut);
    }
  }
}

enum class Cap { kNone, kPolygon, kFan, kPoint };

// A tube of `sides` x `down` quads, 1 cm in radius and 15 cm long, that hangs from `root` and tapers by half.
inline void tube(const Vector3d& root, int sides, int down, Cap at_root, Cap at_tip, int cut, ObjText& out,
                 double bend = 0) {
  std::vector<std::vector<int>> rows;
  std::vector<Vector3d> middles;
  Vector3d place = root;
  for (int r = 0; r <= down; ++r) {
    const double angle = bend * (r - 0.5) / down;
    if (r > 0) place += 0.15 / down * Vector3d(0, -std::cos(angle), std::sin(angle));
    middles.push_back(place);
    rows.emplace_back();
    for (int k = 0; k < sides; ++k) {
      const double around = 2 * std::numbers::pi * k / sides, radius = 0.01 * (1 - 0.5 * r / down);
      rows.back().push_back(out.vertex(place + radius * Vector3d(std::cos(around), 0, std::sin(around))));
    }
  }
  const auto n = static_cast<std::size_t>(sides);
  for (std::size_t r = 0; r + 1 < rows.size(); ++r) {
    for (std::size_t k = 0; k < n; ++k)
      out.quad(rows[r][k], rows[r][(k + 1) % n], rows[r + 1][(k + 1) % n], rows[r + 1][k], cut);
  }
  const auto close = [&](const std::vector<int>& ring, const Vector3d& middle, const Vector3d& beyond, Cap cap) {
    if (cap == Cap::kPolygon) {
      if (cut == 0) return out.face(ring);
      for (std::size_t k = 1; k + 1 < n; ++k) out.face({ring[0], ring[k], ring[k + 1]});
    } else if (cap != Cap::kNone) {
      const int center = out.vertex(cap == Cap::kFan ? middle : beyond);
      for (std::size_t k = 0; k < n; ++k) out.face({ring[k], ring[(k + 1) % n], center});
    }
  };
  close(rows.front(), middles.front(), middles.front() + Vector3d(0, 0.02, 0), at_root);
  close(rows.back(), middles.back(), middles.back() + (middles.back() - middles[middles.size() - 2]), at_tip);
}

// Roots on a cap of a head of radius 9 cm about the origin.
inline std::vector<Vector3d> rootsOnHead(int count) {
  std::vector<Vector3d> roots;
  for (int i = 0; i < count; ++i) {
    const double polar = 0.3 + 0.9 * i / count, around = 2.4 * i;
    roots.push_back(0.09 *
                    Vector3d(std::sin(polar) * std::cos(around), std::cos(polar), std::sin(polar) * std::sin(around)));
  }
  return roots;
}

// A sphere of quads and triangles about the origin.
inline void ball(double radius, ObjText& out) {
  constexpr int kRows = 8, kColumns = 12;
  std::vector<std::vector<int>> rows;
  for (int i = 1; i < kRows; ++i) {
    rows.emplace_back();
    for (int j = 0; j < kColumns; ++j) {
      const double polar = std::numbers::pi * i / kRows, around = 2 * std::numbers::pi * j / kColumns;
      rows.back().push_back(out.vertex(
          radius * Vector3d(std::sin(polar) * std::cos(around), std::cos(polar), std::sin(polar) * std::sin(around))));
    }
  }
  for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
    for (std::size_t j = 0; j < kColumns; ++j)
      out.quad(rows[i][j], rows[i][(j + 1) % kColumns], rows[i + 1][(j + 1) % kColumns], rows[i + 1][j]);
  }
}

}  // namespace strip_samples

#include "app/figure/scalp_sampling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "app/figure/smoothstep.h"

namespace app {

namespace {

constexpr int kRows = 65, kColumns = 128;
constexpr double kPi = std::numbers::pi;
constexpr double kNone = -1;  // no triangle met

Vec3 direction(int row, int column) {
  const double polar = row * kPi / (kRows - 1), azimuth = column * 2 * kPi / kColumns;
  return {std::sin(polar) * std::sin(azimuth), std::cos(polar), std::sin(polar) * std::cos(azimuth)};
}

// Distance along a ray from the origin to a triangle, or kNone.
double rayTriangle(const Vec3& d, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 e1 = b - a, e2 = c - a, h = d.cross(e2);
  const double det = e1.dot(h);
  if (std::abs(det) < 1e-14) return kNone;
  const Vec3 s = -a;
  const double u = s.dot(h) / det;
  const Vec3 q = s.cross(e1);
  const double v = d.dot(q) / det;
  constexpr double slack = 1e-6;  // rays through edges and vertices must not slip between triangles
  if (u < -slack || v < -slack || u + v > 1 + slack) return kNone;
  const double t = e2.dot(q) / det;
  return t > 0 ? t : kNone;
}

// Offers one triangle's distances to the samples in its angular box.
void castTriangle(const Vec3& a, const Vec3& b, const Vec3& c, std::vector<double>& radius) {
  double polar_low = kPi, polar_high = 0;
  double azimuth[3];
  int k = 0;
  for (const Vec3& p : {a, b, c}) {
    const double polar = std::acos(std::clamp(p.y() / std::max(p.norm(), 1e-12), -1.0, 1.0));
    polar_low = std::min(polar_low, polar);
    polar_high = std::max(polar_high, polar);
    azimuth[k++] = std::atan2(p.x(), p.z());
  }
  // An edge can bulge beyond its ends' polar angles: one row more on either side; near a pole every column counts.
  const int row_low = std::max(0, static_cast<int>(std::floor(polar_low / kPi * (kRows - 1))) - 1);
  const int row_high = std::min(kRows - 1, static_cast<int>(std::ceil(polar_high / kPi * (kRows - 1))) + 1);
  for (int i = 1; i < 3; ++i) azimuth[i] = azimuth[0] + std::remainder(azimuth[i] - azimuth[0], 2 * kPi);
  const double low = std::min({azimuth[0], azimuth[1], azimuth[2]}),
               high = std::max({azimuth[0], azimuth[1], azimuth[2]});
  int column_low = static_cast<int>(std::floor(low / (2 * kPi) * kColumns)) - 1;
  int column_high = static_cast<int>(std::ceil(high / (2 * kPi) * kColumns)) + 1;
  if (high - low > 0.9 * kPi || row_low <= 2 || row_high >= kRows - 3) {
    column_low = 0;
    column_high = kColumns - 1;
  }
  for (int row = row_low; row <= row_high; ++row) {
    for (int column = column_low; column <= column_high; ++column) {
      const int wrapped = ((column % kColumns) + kColumns) % kColumns;
      double& r = radius[row * kColumns + wrapped];
      r = std::max(r, rayTriangle(direction(row, wrapped), a, b, c));
    }
  }
}

double& sample(std::vector<double>& radius, int row, int column) {
  return radius[row * kColumns + ((column % kColumns) + kColumns) % kColumns];
}

// Fills directions without a hit with the mean of their filled neighbours, growing inwards from the hole's rim.
void fillHoles(double fallback, std::vector<double>& radius) {
  const bool any = std::any_of(radius.begin(), radius.end(), [](double r) { return r > 0; });
  if (!any) std::fill(radius.begin(), radius.end(), fallback);
  for (bool open = true; open;) {
    open = false;
    std::vector<double> next = radius;
    for (int row = 0; row < kRows; ++row) {
      for (int column = 0; column < kColumns; ++column) {
        if (sample(radius, row, column) > 0) continue;
        open = true;
        double sum = 0;
        int count = 0;
        for (int dr = -1; dr <= 1; ++dr) {
          for (int dc = -1; dc <= 1; ++dc) {
            if (row + dr < 0 || row + dr >= kRows) continue;
            if (const double r = sample(radius, row + dr, column + dc); r > 0) {
              sum += r;
              ++count;
            }
          }
        }
        if (count > 0) sample(next, row, column) = sum / count;
      }
    }
    radius = std::move(next);
  }
}

// Polar angle grows linearly with the row, so a window of fixed angle spans more columns near the poles.
int columnsFor(int row, double angle) {
  const double ring = std::max(std::sin(row * kPi / (kRows - 1)), 0.2);
  return static_cast<int>(std::lround(angle / ring / (2 * kPi) * kColumns));
}

// Grey-scale opening (least, then greatest of a window): takes away bumps narrower than the window and nothing else.
std::vector<double> opened(const std::vector<double>& radius, double angle) {
  const int rows = static_cast<int>(std::lround(angle / kPi * (kRows - 1)));
  std::vector<double> current = radius;
  for (const bool least : {true, false}) {
    // Separable window: along the columns, then along the rows.
    std::vector<double> across = current;
    for (int row = 0; row < kRows; ++row) {
      const int reach = columnsFor(row, angle);
      for (int column = 0; column < kColumns; ++column)
        for (int d = -reach; d <= reach; ++d) {
          const double r = sample(current, row, column + d);
          double& out = sample(across, row, column);
          out = least ? std::min(out, r) : std::max(out, r);
        }
    }
    current = across;
    for (int row = 0; row < kRows; ++row)
      for (int column = 0; column < kColumns; ++column)
        for (int d = std::max(-rows, -row); d <= std::min(rows, kRows - 1 - row); ++d) {
          const double r = sample(across, row + d, column);
          double& out = sample(current, row, column);
          out = least ? std::min(out, r) : std::max(out, r);
        }
  }
  return current;
}

// Ears: bumps at the sides, between the temples' level and the jaw. Their outline is smoothed over what lies beneath.
void cutEars(double head_height, std::vector<double>& radius) {
  std::vector<double> open = opened(radius, 0.34);
  // An opening leaves flat tops; a few averages make the cut surface smooth where something was cut.
  std::vector<double> cut(radius.size());
  for (std::size_t i = 0; i < radius.size(); ++i) cut[i] = radius[i] - open[i];
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const Vec3 d = direction(row, column);
      const double side = smoothstep(0.55, 0.75, std::abs(d.x())) * smoothstep(0.75, 0.55, -d.y()) *
                          smoothstep(0.62, 0.45, d.y()) * smoothstep(0.55, 0.40, d.z());
      const double bump = smoothstep(0.008, 0.02, cut[row * kColumns + column] / head_height);
      radius[row * kColumns + column] -= side * bump * cut[row * kColumns + column];
    }
  }
}

}  // namespace

HeadMeasure measureHead(std::span<const Vec3> vertices) {
  HeadMeasure m;
  if (vertices.empty()) return m;
  Vec3 low = vertices.front(), high = low;
  for (const Vec3& v : vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  m.crown = high.y();
  // The chin is the lowest part of the front; behind it the neck goes further down.
  const double front = low.z() + 0.72 * (high.z() - low.z());
  m.chin = high.y();
  for (const Vec3& v : vertices)
    if (v.z() > front && std::abs(v.x() - 0.5 * (low.x() + high.x())) < 0.3 * (high.x() - low.x()))
      m.chin = std::min(m.chin, v.y());
  if (m.crown - m.chin < 0.5 * (high.y() - low.y())) m.chin = low.y();
  const double level = m.chin + 0.585 * (m.crown - m.chin);
  double left = -1e30, right = 1e30, back = 1e30, ahead = -1e30;
  for (const Vec3& v : vertices) {
    if (v.y() < level) continue;
    left = std::max(left, v.x());
    right = std::min(right, v.x());
    ahead = std::max(ahead, v.z());
    back = std::min(back, v.z());
  }
  m.center = Vec3(0.5 * (left + right), level, 0.5 * (ahead + back));
  return m;
}

Scalp sampleScalp(std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles,
                  const HeadMeasure& measure) {
  Scalp scalp;
  scalp.center = measure.center;
  scalp.head_height = measure.crown - measure.chin;
  scalp.rows = kRows;
  scalp.columns = kColumns;
  scalp.radius.assign(kRows * kColumns, kNone);
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    const Vec3 a = vertices[triangles[t]] - measure.center, b = vertices[triangles[t + 1]] - measure.center,
               c = vertices[triangles[t + 2]] - measure.center;
    castTriangle(a, b, c, scalp.radius);
  }
  fillHoles(0.45 * scalp.head_height, scalp.radius);
  cutEars(scalp.head_height, scalp.radius);
  for (const int pole : {0, kRows - 1}) {
    double mean = 0;
    for (int column = 0; column < kColumns; ++column) mean += sample(scalp.radius, pole, column) / kColumns;
    for (int column = 0; column < kColumns; ++column) sample(scalp.radius, pole, column) = mean;
  }
  return scalp;
}

}  // namespace app

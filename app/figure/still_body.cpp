#include "app/figure/still_body.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "app/figure/closed_surface.h"

namespace app {

namespace {

using Vec3 = Eigen::Vector3d;
using Box = Eigen::AlignedBox2d;  // x and z

constexpr int kLevels = 192;
constexpr double kNarrow = 0.62;     // a neck's cross-section over the head's, at most
constexpr double kWide = 1.5;        // what lies below over the neck's, at least
constexpr double kOpenNeck = 0.15;   // an open neck's end over the head's cross-section, at least
constexpr double kLeastHead = 0.06;  // of the mesh's height
constexpr double kSlimHead = 0.3;    // a head's width and depth over its height with the neck, at least
constexpr double kBroadHead = 1.6;   // and at most
constexpr double kAhead = 0.05;      // of the head's height: the face before the neck, at least
constexpr double kAsAxis = 0.12;     // rad: a face so near to an axis looks along it
constexpr double kHeadsOfBody = 4;   // its height in heads with the neck, at least
constexpr double kOnePiece = 0.5;    // of a body's faces, at least

// A cross-section: its bounds, and the sum of its edges' middles times their lengths.
struct Level {
  Box box;
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  double length = 0;
};

// The mesh's outline level by level, from the top down.
struct Outline {
  double low = 0, high = 0;
  std::vector<Level> levels;

  double heightOf(int level) const { return high - (level + 0.5) / kLevels * (high - low); }
  double areaOf(int level) const {
    const Box& box = levels[static_cast<std::size_t>(level)].box;
    return box.isEmpty() ? 0 : box.sizes().x() * box.sizes().y();
  }
};

void extendLevels(const std::array<Vec3, 3>& corners, Outline& outline) {
  const double step = (outline.high - outline.low) / kLevels;
  const auto [low, high] = std::minmax({corners[0].y(), corners[1].y(), corners[2].y()});
  const int first = std::max(0, static_cast<int>(std::ceil((outline.high - high) / step - 0.5)));
  const int last = std::min(kLevels - 1, static_cast<int>(std::floor((outline.high - low) / step - 0.5)));
  for (int level = first; level <= last; ++level) {
    const double y = outline.heightOf(level);
    Eigen::Vector2d ends[2] = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
    int crossed = 0;
    for (int k = 0; k < 3; ++k) {
      const Vec3 &a = corners[k], &b = corners[(k + 1) % 3];
      if ((a.y() > y) == (b.y() > y)) continue;
      const Vec3 p = a + (y - a.y()) / (b.y() - a.y()) * (b - a);
      ends[crossed++] = {p.x(), p.z()};
    }
    if (crossed < 2) continue;
    Level& at = outline.levels[static_cast<std::size_t>(level)];
    const double length = (ends[1] - ends[0]).norm();
    at.box.extend(ends[0]).extend(ends[1]);
    at.moment += length / 2 * (ends[0] + ends[1]);
    at.length += length;
  }
}

Outline outlineOf(std::span<const Eigen::Vector3f> positions, std::span<const std::uint32_t> triangles,
                  const Eigen::Matrix3d& turn) {
  Outline outline;
  outline.low = INFINITY, outline.high = -INFINITY;
  for (const std::uint32_t v : triangles) {
    const double y = turn.row(1).dot(positions[v].cast<double>());
    outline.low = std::min(outline.low, y), outline.high = std::max(outline.high, y);
  }
  outline.levels.resize(kLevels);
  if (!(outline.high > outline.low)) return outline;
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    const auto corner = [&](std::size_t k) { return Vec3(turn * positions[triangles[t + k]].cast<double>()); };
    extendLevels({corner(0), corner(1), corner(2)}, outline);
  }
  return outline;
}

// Whether what lies above a level is as wide and deep as heads are.
bool isHead(const Outline& outline, int neck) {
  Box all;
  for (int level = 0; level < neck; ++level) all.extend(outline.levels[static_cast<std::size_t>(level)].box);
  const double height = outline.high - outline.heightOf(neck);
  return !all.isEmpty() && all.sizes().minCoeff() > kSlimHead * height && all.sizes().maxCoeff() < kBroadHead * height;
}

// The narrowest level under a head, -1: there is none.
int neckOf(const Outline& outline) {
  double head = 0;
  int narrowest = -1;
  for (int level = 0; level < kLevels; ++level) {
    const double area = outline.areaOf(level);
    if (narrowest < 0 || area < outline.areaOf(narrowest)) {
      if (area > head && narrowest < 0) head = area;
      if (area < kNarrow * head && level > kLeastHead * kLevels) narrowest = level;
    } else if (area > kWide * outline.areaOf(narrowest)) {
      return isHead(outline, narrowest) ? narrowest : -1;
    }
  }
  return narrowest >= 0 && outline.areaOf(narrowest) > kOpenNeck * head && isHead(outline, narrowest) ? narrowest : -1;
}

// The middle of the edges between two levels.
Eigen::Vector2d levelsMiddle(const Outline& outline, int from, int to) {
  Level all;
  for (int level = from; level < to; ++level) {
    all.moment += outline.levels[static_cast<std::size_t>(level)].moment;
    all.length += outline.levels[static_cast<std::size_t>(level)].length;
  }
  return all.length > 0 ? Eigen::Vector2d(all.moment / all.length) : Eigen::Vector2d::Zero().eval();
}

// The way from the neck to the head's lower half, for a chin lies ahead of a neck; +z where they hardly differ.
Vec3 facing(const Outline& outline, int neck, std::string& note) {
  const double head = outline.high - outline.heightOf(neck);
  const Eigen::Vector2d ahead = levelsMiddle(outline, neck / 2, neck * 7 / 8) - levelsMiddle(outline, neck, neck + 1);
  if (ahead.norm() < kAhead * head) {
    note = "it faces +z, which nothing in the mesh tells";
    return Vec3::UnitZ();
  }
  double angle = std::atan2(ahead.x(), ahead.y());
  const double axis = EIGEN_PI / 2 * std::round(angle / (EIGEN_PI / 2));
  if (std::abs(angle - axis) < kAsAxis) angle = axis;
  char text[96];
  std::snprintf(text, sizeof text, "it faces %+.2f, %+.2f (x, z), as its face lies ahead of its neck", std::sin(angle),
                std::cos(angle));
  note = text;
  return {std::sin(angle), 0, std::cos(angle)};
}

// Metres in a unit of the file, and a note of it.
std::pair<double, std::string> unitOf(double height, double head, double told) {
  if (told > 0) {
    constexpr double kSmall = 0.1, kLarge = 0.8;  // m, of a head with its neck
    char note[192];
    std::snprintf(note, sizeof note, "unit: %g m, as told (the mesh is %.2f m tall, its head with the neck %.2f m%s)",
                  told, height * told, head * told,
                  head * told < kSmall || head * told > kLarge ? ": no person's size" : "");
    return {told, note};
  }
  struct Unit {
    double metres;
    const char* name;
  };
  constexpr std::array<Unit, 4> kUnits{
      {{1.0, "metres"}, {0.0254, "inches"}, {0.01, "centimetres"}, {0.001, "millimetres"}}};
  struct Range {
    double size, least, most;  // size in units, bounds in m
  };
  char note[160];
  for (const Range& range : {Range{head, 0.17, 0.40}, Range{height, 1.2, 2.2}}) {
    for (const Unit& unit : kUnits) {
      if (range.size * unit.metres < range.least || range.size * unit.metres > range.most) continue;
      std::snprintf(note, sizeof note, "unit: %s (the mesh is %.2f m tall, its head with the neck %.2f m)", unit.name,
                    height * unit.metres, head * unit.metres);
      return {unit.metres, note};
    }
  }
  constexpr double kUsualHead = 0.25;  // m
  std::snprintf(note, sizeof note, "unit: unknown (the head with its neck is %.4g units tall), scaled to %.2f m of it",
                head, kUsualHead);
  return {kUsualHead / head, note};
}

}  // namespace

std::optional<StillBody> measureStillBody(std::span<const Eigen::Vector3f> positions,
                                          std::span<const std::uint32_t> triangles, const ToldBody& told) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Outline outline = outlineOf(positions, triangles, turn);
  int neck = told.up == 'z' ? -1 : neckOf(outline);
  const bool z_up = neck < 0 && told.up != 'y';
  if (z_up) {
    turn << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    outline = outlineOf(positions, triangles, turn);
    neck = neckOf(outline);
  }
  if (neck < 0) return std::nullopt;

  StillBody body;
  const double head = outline.high - outline.heightOf(neck);
  const auto [unit, unit_note] = unitOf(outline.high - outline.low, head, told.unit);
  std::string facing_note;
  body.forward = facing(outline, neck, facing_note);
  if (!told.face.isZero(0)) body.forward = told.face, facing_note = "it faces where it is told to";
  const double raised = std::max(0.0, -unit * outline.low);
  const Eigen::Vector2d middle = levelsMiddle(outline, neck, neck + 1);
  body.to_metres.topLeftCorner<3, 3>() = unit * turn;
  body.to_metres(1, 3) = raised;
  body.neck = unit * Vec3(middle.x(), outline.heightOf(neck), middle.y()) + Vec3(0, raised, 0);
  body.height = unit * (outline.high - outline.low);
  body.head_height = unit * head;
  body.notes = {std::string(z_up ? "up axis: z, turned to y" : "up axis: y") + (told.up ? ", as told" : ""), unit_note,
                "head: what lies above the neck, the narrowest level, at " +
                    std::to_string(std::lround(100 * body.neck.y())) + " cm; " + facing_note};
  constexpr double kToBeSaid = 0.005;  // m
  if (raised > kToBeSaid)
    body.notes.push_back("ground: raised by " + std::to_string(std::lround(100 * raised)) + " cm to stand on it");
  return body;
}

bool turnFacesOutwards(int head_joint, SkinnedMesh& mesh) {
  std::vector<std::uint32_t>& index = mesh.triangles;
  const auto place = [&](std::uint32_t v) { return mesh.positions[v].cast<double>(); };
  const auto isOfHead = [&](std::uint32_t v) { return mesh.joints[v][0] == head_joint; };
  Vec3 middle = Vec3::Zero();
  double count = 0;
  for (const std::uint32_t v : index) {
    if (!isOfHead(v)) continue;
    middle += place(v);
    ++count;
  }
  middle /= std::max(count, 1.0);
  double volume = 0, agreement = 0;
  for (std::size_t t = 0; t + 2 < index.size(); t += 3) {
    if (!isOfHead(index[t])) continue;
    const Vec3 a = place(index[t]) - middle, b = place(index[t + 1]) - middle, c = place(index[t + 2]) - middle;
    volume += a.dot(b.cross(c));
    agreement += (b - a).cross(c - a).dot(mesh.normals[index[t]].cast<double>());
  }
  if (volume >= 0) return false;
  for (std::size_t t = 0; t + 2 < index.size(); t += 3) std::swap(index[t + 1], index[t + 2]);
  // Normals of the file may point outwards though its faces do not.
  if (agreement > 0)
    for (Eigen::Vector3f& normal : mesh.normals) normal = -normal;
  return true;
}

std::optional<StillBody> stillBodyOf(const PolygonMesh& mesh) {
  const ClosedSurface surface = weld(mesh);
  std::vector<Eigen::Vector3f> positions;
  for (const Vec3& p : surface.points) positions.push_back(p.cast<float>());
  std::vector<std::uint32_t> triangles;
  for (const auto& face : surface.faces)
    for (const int v : face) triangles.push_back(static_cast<std::uint32_t>(v));
  std::optional<StillBody> body = measureStillBody(positions, triangles);
  if (body && body->height <= kHeadsOfBody * body->head_height && largestPiece(surface) <= kOnePiece) body.reset();
  return body;
}

}  // namespace app

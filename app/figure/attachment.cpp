#include "app/figure/attachment.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>

#include "app/figure/closed_surface.h"
#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/files/polygon_file.h"
#include "sim/field_text.h"
#include "sim/mesh/rigid_motion.h"

namespace app {

namespace {

constexpr double kSmallestWorn = 0.07,
                 kLargestWorn = 0.65;  // m, the longest side of what is worn; less than ten times apart
constexpr double kLargestTold = 2.5;   // m, of what "scale" makes larger than that
constexpr double kNearJoint = 0.35;    // m, from its joint
// Shares of its points inside the head: of one that does not fit, of one that does. What is in assets/attachments has
// 0.03 at most, and at 0.9 of its size 0.25 and more.
constexpr double kSwallowed = 0.2, kWellFitted = 0.035;
constexpr double kOtherUnit = 2;                        // times that a mesh is to be larger: it is in another unit
constexpr double kMuchNearer = 0.6;                     // times as far off the head
constexpr double kNearer = 0.8;                         // the same of a hat, of which both are as near as they come
constexpr double kSeatRoom = 0.008, kSeatStep = 0.002;  // m, for the hair under a hat
constexpr std::size_t kMaxSeatSamples = 20000;          // of a hat that is set on the head
constexpr double kHatSize = 0.08;  // m, the shortest side of a hat; how far before the head it lies
constexpr double kWornSpacing = 0.0025, kMaxWornNodes = 1.2e6;  // m, of the grid
constexpr double kSharpEdge = 0.5;                              // cosine between faces that are shaded as one
constexpr int kMaxPieces = 8;
constexpr double kSlender = 0.4;  // of the longest side, the second one of what is worn
constexpr const char* kTurned = "z up, turned to y";
constexpr const char* kGiveSolid = "give a closed mesh: OBJ, FBX or glTF";

struct WornUnit {
  const char* name;
  double metres;
};
constexpr std::array<WornUnit, 3> kWornUnits{{{"metres", 1}, {"centimetres", 0.01}, {"millimetres", 0.001}}};

// Of the material that covers the largest area.
std::optional<std::array<float, 3>> colorOf(const PolygonMesh& mesh) {
  std::map<std::array<float, 3>, double> areas;
  for (std::size_t f = 0; f < mesh.faceCount(); ++f) {
    const auto& color = mesh.colors[static_cast<std::size_t>(mesh.face_object[f])];
    const auto corners = mesh.face(f);
    const auto at = [&](std::size_t k) { return mesh.positions[static_cast<std::size_t>(corners[k])]; };
    for (std::size_t k = 2; color && k < corners.size(); ++k)
      areas[*color] += (at(k - 1) - at(0)).cross(at(k) - at(0)).norm();
  }
  if (areas.empty()) return std::nullopt;
  return std::ranges::max_element(areas, {}, [](const auto& one) { return one.second; })->first;
}

ClosedSurface readSurface(const std::string& file, PolygonMesh& mesh) {
  try {
    mesh = readPolygons(file);
  } catch (const InputError& error) {
    const std::string text = error.what();
    throw InputError("", "", text.substr(0, text.find("; ")), kGiveSolid);
  }
  ClosedSurface surface = weld(mesh);
  if (surface.faces.empty()) throw InputError(file, "", "holds no face of any area", kGiveSolid);
  if (const int open = openEdges(surface); open > 0)
    throw InputError(file, "",
                     "is open: " + std::to_string(open) +
                         " edges lack a face on one side, and hair is kept out of what a mesh encloses",
                     "close it, or give the sheet a thickness of 3 mm or more (Blender: Solidify)");
  turnOutwards(surface);
  return surface;
}

// The first of them, each once.
std::string listed(const std::vector<std::string_view>& names) {
  constexpr std::size_t kMaxListed = 24;
  std::string list;
  std::size_t count = 0;
  for (auto at = names.begin(); at != names.end(); ++at) {
    if (std::find(names.begin(), at, *at) != at) continue;
    if (++count > kMaxListed) return list + " and more";
    list += (list.empty() ? "" : ", ") + std::string(*at);
  }
  return list;
}

int wornJoint(const AttachmentSpec& spec, const Character& character) {
  std::vector<std::string_view> names{"head"};
  for (std::size_t j = 0; j < character.skeleton.joints.size(); ++j) {
    if (character.skeleton.joints[j].name == spec.joint) return static_cast<int>(j);
    names.push_back(character.skeleton.joints[j].name);
  }
  if (spec.joint == "head") return character.head_joint;
  for (const BodyEllipsoid& part : character.ellipsoids) {
    if (part.name == spec.joint) return part.joint;
    names.push_back(part.name);
  }
  const std::string_view near = sim::nearestName(spec.joint, names);
  throw InputError(spec.file, "joint '" + spec.joint.substr(0, 80) + "'", "the figure has no such joint",
                   near.empty() ? "known are " + listed(names) : "did you mean '" + std::string(near) + "'?");
}

void addNote(const std::string& text, std::string& note) {
  note += (note.empty() ? "" : ", ") + text;
}

std::string millimetresOf(double metres) {
  return std::to_string(std::lround(1000 * metres)) + " mm";
}

// Metres per unit: that of the file where it is as large as what is worn, else the one that makes it so.
const WornUnit& wornUnit(const AttachmentSpec& spec, const PolygonMesh& mesh, double longest, std::string& note) {
  static WornUnit said{"the file's unit", 1};
  const auto fits = [&](double metres) {
    return longest * metres >= kSmallestWorn && longest * metres <= kLargestWorn;
  };
  if (mesh.meters_per_unit && fits(*mesh.meters_per_unit)) return said.metres = *mesh.meters_per_unit, said;
  for (const WornUnit& unit : kWornUnits) {
    if (!fits(unit.metres)) continue;
    if (unit.metres != 1) note = std::string("read in ") + unit.name;
    return unit;
  }
  throw InputError(spec.file, "size",
                   "is " + sim::numberText(std::round(1e4 * longest) / 1e4) +
                       " units, which in metres, centimetres or millimetres is nothing to wear",
                   "scale it in its file (or give \"scale\", metres per unit)");
}

// From z up, facing -y, to y up.
Eigen::Matrix3d quarterTurn() {
  return Eigen::AngleAxisd(-0.5 * std::numbers::pi, Vec3::UnitX()).toRotationMatrix();
}

// Brings the points into the joint's upright frame, m. Unit, origin and axis are tried together: what lies about the
// joint faces +z; what lies at the joint's place on the figure, y up or z up, faces as the figure stands. `upright`:
// the joint's upright frame in the rest pose. Returns whether it was turned from z up by that.
bool placeAt(const AttachmentSpec& spec, const PolygonMesh& mesh, const Rigid& upright, ClosedSurface& surface,
             std::string& note) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : surface.points) box.extend(p);
  const double scale = spec.scale > 0 ? spec.scale : wornUnit(spec, mesh, box.sizes().maxCoeff(), note).metres;
  if (const double longest = spec.size * scale * box.sizes().maxCoeff(); longest > kLargestTold)
    throw InputError(spec.file, "size", "is " + sim::numberText(std::round(10 * longest) / 10) + " m across",
                     "leave \"scale\" out, or give metres per unit: 0.01 for centimetres");
  const Vec3 middle = scale * box.center();
  const Vec3 joint = upright.translation();
  const std::array<Vec3, 3> origins{Vec3::Zero(), joint, quarterTurn().transpose() * joint};
  const auto off = [&](const Vec3& origin) { return (middle - origin).norm(); };
  auto origin = spec.scale == 0 ? std::ranges::find_if(origins, [&](const Vec3& o) { return off(o) <= kNearJoint; })
                                : origins.begin();
  if (origin == origins.end())
    throw InputError(spec.file, "place",
                     "lies " + millimetresOf(off(*std::ranges::min_element(origins, {}, off))) + " from the joint '" +
                         spec.joint + "'",
                     "model it about the joint (or give \"scale\" and \"at\")");
  const bool of_figure = origin != origins.begin();
  const bool turned = origin == origins.begin() + 2 && spec.turn.isZero();
  if (of_figure) note += std::string(note.empty() ? "read" : ",") + " about the figure's origin";
  if (turned) addNote(kTurned, note);
  Eigen::Matrix3d turn = turned ? quarterTurn() : turnOf(spec.turn);
  if (of_figure && spec.turn.isZero()) turn = upright.linear().transpose() * turn;
  for (Vec3& p : surface.points) p = spec.size * (turn * (scale * p - *origin)) + spec.at;
  return turned;
}

// Degrees about x, then y, then z, by which points have come to where they are from those of the file.
Vec3 turnBetween(const ClosedSurface& from, const ClosedSurface& to) {
  const Eigen::Matrix3d turn = sim::rigidMotion(from.points, to.points).linear();
  const Vec3 radians(std::atan2(turn(2, 1), turn(2, 2)), -std::asin(std::clamp(turn(2, 0), -1.0, 1.0)),
                     std::atan2(turn(1, 0), turn(0, 0)));
  constexpr double kRounded = 1e-3;  // degrees
  return kRounded * (180 / std::numbers::pi / kRounded * radians).array().round() + 0.0;
}

// The share of a surface's points that lie inside the head when it is made `times` as large about its joint.
double swallowed(const ClosedSurface& surface, double times, const Rigid& to_scalp, const Scalp& scalp) {
  std::size_t inside = 0;
  for (const Vec3& p : surface.points) {
    const Vec3 from_middle = to_scalp * (times * p) - scalp.center;
    inside += from_middle.norm() < scalp.radiusAt(from_middle.normalized());
  }
  return static_cast<double>(inside) / static_cast<double>(surface.points.size());
}

// What "scale" frees the head: so many times the present one where that is no other unit.
std::string largerBy(const ClosedSurface& surface, const Rigid& to_scalp, const Scalp& scalp) {
  for (double times = 1.05; times < kOtherUnit; times += 0.05) {
    if (swallowed(surface, times, to_scalp, scalp) > kWellFitted) continue;
    char text[64];
    std::snprintf(text, sizeof text, "make it about %.2f times as large (\"size\")", times);
    return text;
  }
  return "make it larger (\"scale\": metres per unit, 0.0254 for inches)";
}

// Whether a hat lies before or behind the head, in the joint's frame. A hat sits on the head; glasses are thin.
bool liesBeside(const ClosedSurface& surface, const Rigid& to_scalp, const Scalp& scalp) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : surface.points) box.extend(to_scalp * p - scalp.center);
  const Vec3 middle = box.center();
  return box.sizes().minCoeff() > kHatSize && std::abs(middle.z()) > std::max(kHatSize, std::abs(middle.y()));
}

// What is wrong with its place, in the joint's frame, though it can be worn; empty: nothing.
std::string placeNote(const ClosedSurface& surface, const Rigid& to_scalp, const Scalp& scalp, bool of_head) {
  double nearest = INFINITY;
  for (const Vec3& p : surface.points) nearest = std::min(nearest, p.norm());
  const double inside = of_head ? swallowed(surface, 1, to_scalp, scalp) : 0;
  if (inside > kSwallowed) {
    return (inside < 1 ? "lies to " + std::to_string(std::lround(100 * inside)) + " %" : "lies wholly") +
           " inside the head; " + largerBy(surface, to_scalp, scalp) + " or move it (\"at\")";
  }
  if (of_head && liesBeside(surface, to_scalp, scalp))
    return "lies before or behind the head; where z is up in the file, turn it by -90 degrees about x (\"turn\": [-90, "
           "0, 0])";
  if (nearest > kNearJoint)
    return "lies " + millimetresOf(nearest) + " from its joint; look at its size and place (\"size\", \"at\")";
  return "";
}

// m, that the surface is off the head's in the mean.
double offHead(const ClosedSurface& surface, const Rigid& to_scalp, const Scalp& scalp) {
  double off = 0;
  for (const Vec3& p : surface.points) {
    const Vec3 from_middle = to_scalp * p - scalp.center;
    off += std::abs(from_middle.norm() - scalp.radiusAt(from_middle.normalized()));
  }
  return off / static_cast<double>(surface.points.size());
}

// Whether it is as thick as a hat. Glasses and bands are thin.
bool isHat(const ClosedSurface& surface) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : surface.points) box.extend(p);
  return box.sizes().minCoeff() > kHatSize;
}

// How far a hat is to be moved, m, scalp frame, so that it sits: its middle over the head's, as low as the head lets
// it.
Vec3 toSeat(const ClosedSurface& surface, const Rigid& to_scalp, const Scalp& scalp) {
  std::vector<Vec3> samples;
  Eigen::AlignedBox3d box;
  const std::vector<Vec3> all = samplesOf(surface);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Vec3 p = to_scalp * all[i] - scalp.center;
    box.extend(p);
    if (i % (all.size() / kMaxSeatSamples + 1) == 0) samples.push_back(p);
  }
  Vec3 move = -box.center();
  const double lowest = scalp.radiusAt(Vec3::UnitY()) - box.max().y();  // with its top at the crown
  move.y() = lowest + box.sizes().y();
  const auto fits = [&](double y) {
    return std::ranges::none_of(samples, [&](const Vec3& p) {
      const Vec3 at = p + Vec3(move.x(), y, move.z());
      return at.norm() < scalp.radiusAt(at.normalized()) + kSeatRoom;
    });
  };
  while (move.y() > lowest && fits(move.y() - kSeatStep)) move.y() -= kSeatStep;
  return move;
}

// A quarter turn to y up of what has z up in its file, facing -y.
ClosedSurface turnedUp(const ClosedSurface& surface, const Rigid& placed) {
  const Rigid quarter(Eigen::AngleAxisd{quarterTurn()});
  const Rigid turn = placed * quarter * placed.inverse(Eigen::Isometry);
  ClosedSurface turned = surface;
  for (Vec3& p : turned.points) p = turn * p;
  return turned;
}

// What is much nearer to the head when it is turned has z up: a hat where both ways are seated, glasses where they lie.
// Judged where it would be without "at". `placed`: from the file's axes, m, to the joint's frame; `moved`: by "at", m,
// there.
void turnUpright(const Rigid& placed, const Vec3& moved, const Rigid& to_scalp, const Scalp& scalp,
                 ClosedSurface& surface, std::string& note) {
  const bool hat = isHat(surface);
  const Rigid unmoved = to_scalp * Eigen::Translation3d(-moved);
  const auto seat = [&](const ClosedSurface& one) {
    return hat ? Rigid(Eigen::Translation3d(toSeat(one, unmoved, scalp))) * unmoved : unmoved;
  };
  ClosedSurface turned = turnedUp(surface, placed);
  const Rigid there = seat(turned);
  const double off = offHead(surface, seat(surface), scalp), off_turned = offHead(turned, there, scalp);
  if (off_turned > (hat ? kNearer : kMuchNearer) * off || swallowed(turned, 1, there, scalp) > kSwallowed) return;
  surface = std::move(turned);
  addNote(kTurned, note);
}

// Moves a hat that lies in the head, or beside it, to where it sits. Returns the way, m, in the joint's frame.
Vec3 seatOnHead(const Rigid& to_scalp, const Scalp& scalp, ClosedSurface& surface, std::string& note) {
  if (!isHat(surface)) return Vec3::Zero();
  if (swallowed(surface, 1, to_scalp, scalp) <= kWellFitted && !liesBeside(surface, to_scalp, scalp))
    return Vec3::Zero();
  const Vec3 move = to_scalp.linear().transpose() * toSeat(surface, to_scalp, scalp);
  for (Vec3& p : surface.points) p += move;
  addNote("set on the head, " + millimetresOf(move.norm()) + " from where the file has it", note);
  return move;
}

// Signed distances; the same as of a body's part.
PartDistance distancesOf(const ClosedSurface& surface, int joint) {
  PartDistance part;
  part.joint = joint;
  std::vector<Triangle> triangles;
  Eigen::AlignedBox3d box;
  for (const auto& f : surface.faces) {
    Triangle triangle;
    for (std::size_t k = 0; k < 3; ++k) box.extend(triangle[k] = surface.points[static_cast<std::size_t>(f[k])]);
    triangles.push_back(triangle);
  }
  part.triangles = static_cast<int>(triangles.size());
  const Vec3 sizes = box.sizes() + Vec3::Constant(6 * kWornSpacing);
  const double spacing = std::max(kWornSpacing, std::cbrt(sizes.prod() / kMaxWornNodes));
  const Vec3 pad = Vec3::Constant(3 * spacing);
  part.grid = layOutGrid(box.min() - pad, box.max() + pad, spacing);
  fillGrid(triangles, 2.5 * spacing, Pieces::kAll, part.grid);
  for (const float d : part.grid.distance) part.deepest = std::max(part.deepest, -static_cast<double>(d));
  part.center = box.center();
  part.radius = 0.5 * box.sizes().norm() + 2 * spacing;
  return part;
}

// Vertices for drawing: where faces meet at a sharp edge each side has its own, with its own normal.
void shadeAttachment(const ClosedSurface& surface, Attachment& out) {
  std::vector<Vec3> face_normals;
  std::vector<std::vector<int>> around(surface.points.size());
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    std::array<Vec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(surface.faces[f][k]);
      p[k] = surface.points[v];
      around[v].push_back(static_cast<int>(f));
    }
    face_normals.push_back((p[1] - p[0]).cross(p[2] - p[0]));  // as long as twice the area
  }
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const Vec3 own = face_normals[f].normalized();
    for (const int corner : surface.faces[f]) {
      Vec3 normal = Vec3::Zero();
      for (const int g : around[static_cast<std::size_t>(corner)]) {
        const Vec3& other = face_normals[static_cast<std::size_t>(g)];
        if (own.dot(other.normalized()) > kSharpEdge) normal += other;
      }
      out.triangles.push_back(static_cast<std::uint32_t>(out.positions.size()));
      out.positions.push_back(surface.points[static_cast<std::size_t>(corner)].cast<float>());
      out.normals.push_back((normal.norm() > 0 ? normal.normalized() : own).cast<float>());
    }
  }
  out.joints.assign(out.positions.size(), {0, 0, 0, 0});
  out.weights.assign(out.positions.size(), {1, 0, 0, 0});
}

}  // namespace

Attachment loadAttachment(const AttachmentSpec& spec, const Character& character) {
  PolygonMesh mesh;
  ClosedSurface surface = readSurface(spec.file, mesh);
  const int joint = wornJoint(spec, character);
  const Joint& carrier = character.skeleton.joints[static_cast<std::size_t>(joint)];
  const Rigid scalp =
      character.skeleton.joints[static_cast<std::size_t>(character.head_joint)].rest_world * character.head_frame;
  // Upright as the scalp's frame, about the joint.
  Rigid upright = Rigid::Identity();
  upright.linear() = scalp.linear();
  upright.translation() = carrier.rest_world.translation();
  Attachment out;
  std::string note;
  const ClosedSurface of_file = surface;
  const bool was_turned = placeAt(spec, mesh, upright, surface, note);
  out.color = colorOf(mesh);
  const Rigid to_joint = carrier.rest_world.inverse(Eigen::Isometry) * upright;
  for (Vec3& p : surface.points) p = to_joint * p;
  const bool of_head = joint == character.head_joint;
  out.to_scalp = scalp.inverse(Eigen::Isometry) * carrier.rest_world;
  const Rigid placed = to_joint * Eigen::Translation3d(spec.at);
  if (of_head && spec.turn.isZero() && !was_turned)
    turnUpright(placed, to_joint.linear() * spec.at, out.to_scalp, character.scalp, surface, note);
  const Rigid from_joint = to_joint.inverse(Eigen::Isometry);
  out.at = spec.at;
  if (of_head && spec.turn.isZero() && spec.at.isZero() && spec.scale == 0)
    out.at = from_joint.linear() * seatOnHead(out.to_scalp, character.scalp, surface, note);
  ClosedSurface about_joint = surface;
  for (Vec3& p : about_joint.points) p = from_joint * p;
  out.turn = turnBetween(of_file, about_joint);
  out.part = distancesOf(surface, joint);
  if (!(out.part.deepest > 0))
    throw InputError(spec.file, "", "is too thin to collide with", "make it at least 3 mm thick");
  const std::string place = placeNote(surface, out.to_scalp, character.scalp, of_head);
  for (const std::string& more : {place, mesh.note}) {
    if (!more.empty()) addNote(more, note);
  }
  if (!note.empty()) out.note = stem(spec.file) + ": " + note;
  shadeAttachment(surface, out);
  return out;
}

Eigen::Matrix3d turnOf(const Vec3& degrees) {
  const Vec3 radians = std::numbers::pi / 180 * degrees;
  return (Eigen::AngleAxisd(radians.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(radians.y(), Vec3::UnitY()) *
          Eigen::AngleAxisd(radians.x(), Vec3::UnitX()))
      .toRotationMatrix();
}

bool looksWorn(const PolygonMesh& mesh) {
  ClosedSurface surface = weld(mesh);
  Eigen::AlignedBox3d box;
  for (const Vec3& p : surface.points) box.extend(p);
  std::array<double, 3> sides{box.sizes().x(), box.sizes().y(), box.sizes().z()};
  std::ranges::sort(sides);
  return surface.faces.size() >= 4 && sides[1] > kSlender * sides[2] && openEdges(surface) == 0 &&
         turnOutwards(surface) <= kMaxPieces;
}

double meetsAlong(const Attachment& attachment, const Scalp& scalp, const Vec3& direction, double most) {
  constexpr double kStride = 0.001, kUnder = 0.004;  // m
  const Vec3 along = direction.normalized();
  const Rigid to_joint = attachment.to_scalp.inverse(Eigen::Isometry);
  const double start = scalp.radiusAt(along);
  for (double r = start - kUnder; r < start + most;) {
    const double distance = attachment.part.grid.interpolate(to_joint * (scalp.center + r * along));
    if (distance <= 0) return r;
    r += std::max(kStride, 0.7 * distance);
  }
  return INFINITY;
}

}  // namespace app

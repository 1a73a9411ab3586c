#include "app/figure/strip_inspect.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "app/figure/attachment.h"
#include "app/figure/hair_fit.h"
#include "app/figure/head_model.h"
#include "app/figure/still_body.h"
#include "app/figure/strip_fit.h"
#include "app/files/errors.h"
#include "app/files/hair_file.h"
#include "app/files/length_units.h"
#include "app/files/median.h"
#include "app/files/polygon_file.h"
#include "app/files/report_line.h"
#include "app/groom/inspect/head_seat.h"

namespace app {

namespace {

constexpr double kFloatingRoot = 0.03;                                          // m from the body: rooted nowhere
constexpr double kDeepInBody = 0.006, kByRoot = 0.01;                           // m
constexpr double kThinnestCard = 0.002, kWidestCard = 0.12, kUsualCard = 0.02;  // m
constexpr std::size_t kManyPieces = 10;
constexpr double kOverHead = 0.05;                     // m, spread of the roots
constexpr double kLeastRim = 0.1;                      // m, of all root edges together: thin cards may be many
constexpr double kNoArea = 1e-12;                      // of the extent, squared
constexpr double kManyWrong = 0.1, kFewerWrong = 0.5;  // of the pieces, and of those with the other axis up

std::string formatted(const char* format, double a, double b = 0) {
  std::array<char, 200> text;
  std::snprintf(text.data(), text.size(), format, a, b);
  return text.data();
}

// "3,7,9", for an option.
std::string commaList(const std::vector<int>& numbers) {
  std::string text;
  for (const int number : numbers) {
    if (!text.empty()) text += ',';
    text += std::to_string(number);
  }
  return text;
}

const char* verbOf(const std::vector<int>& pieces, const char* of_one, const char* of_more) {
  return pieces.size() == 1 ? of_one : of_more;
}

struct StripInspector {
  const PolygonMesh& mesh;
  const StripOptions& options;
  const StripConversion& strips;  // before it is brought to the head
  const HeadModel head;
  const Scalp& scalp;
  Eigen::Affine3d place;  // m in the file's axes to the figure's head
  bool up_given;
  GroomInspection result{};
  std::size_t wrong = 0;  // pieces that float, pieces through the body, pieces rooted at the wrong end: the sum

  GroomFinding& add(const char* what, std::string text, std::string mend, bool certain = false) {
    result.findings.push_back({what, std::move(text), std::move(mend), certain, true});
    return result.findings.back();
  }
  double distance(const Vec3& p) const { return head.distance((place * p).cast<float>()); }
  // m. Tips of long hair are near to the body, too, on shoulders and back.
  double offScalp(const Vec3& p) const {
    const Vec3 from = place * p - scalp.center;
    return std::abs(from.norm() - scalp.radiusAt(from));
  }
  void pieces();
  void area();
  void unit();
  void axes();
  void roots(const FittedStrips& fitted, const Character& character);
  void ends(const Character& character);
  void widths();
  void body();
};

void StripInspector::pieces() {
  if (!strips.astray.empty())
    add("astray", astrayText(strips), strips.astray.size() == 1 ? "it is left out" : "they are left out", true);
  if (strips.left_out.empty()) return;
  std::string names = strips.left_out.front();
  for (std::size_t n = 1; n < std::min<std::size_t>(3, strips.left_out.size()); ++n) names += "; " + strips.left_out[n];
  if (strips.left_out.size() > 3) names += "; and " + std::to_string(strips.left_out.size() - 3) + " more";
  add("left out", names, "give rows of quads from root to tip, or tubes", true);
}

// Faces without area: of strips of no length or width.
void StripInspector::area() {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : mesh.positions) box.extend(p);
  const double least = kNoArea * box.diagonal().squaredNorm();
  std::size_t count = 0;
  std::vector<std::string> objects;
  for (std::size_t f = 0; f < mesh.faceCount(); ++f) {
    const std::span<const int> face = mesh.face(f);
    const auto at = [&](std::size_t k) { return mesh.positions[static_cast<std::size_t>(face[k])]; };
    Vec3 area = Vec3::Zero();
    for (std::size_t k = 1; k + 1 < face.size(); ++k) area += (at(k) - at(0)).cross(at(k + 1) - at(0));
    if (area.norm() > least) continue;
    ++count;
    const std::string& object = mesh.objects[static_cast<std::size_t>(mesh.face_object[f])];
    if (std::ranges::find(objects, object) == objects.end()) objects.push_back(object);
  }
  if (count == 0) return;
  add("zero-length",
      countOf(count, "face") + " without length or width, of '" + objects.front() + "'" +
          (objects.size() > 1 ? " and " + std::to_string(objects.size() - 1) + " more objects" : ""),
      "they are left out", true);
}

void StripInspector::unit() {
  const double said = mesh.meters_per_unit.value_or(1);
  if (options.unit > 0 || std::abs(strips.scale / said - 1) < 0.01) return;
  const auto* const found = std::ranges::find_if(
      kLengthUnits, [&](const LengthUnit& one) { return std::abs(one.metres / strips.scale - 1) < 0.01; });
  const std::string name = found == kLengthUnits.end() ? formatted("%g", strips.scale) : std::string(found->name);
  add("unit",
      "the roots are spread as over a head in " + name +
          (mesh.meters_per_unit ? formatted("; the file tells %g m a unit", said) : ", not m"),
      "--unit " + name, true);
}

// How the hair was turned to lie on the head.
void StripInspector::axes() {
  const double scale = std::cbrt(place.linear().determinant());
  const Eigen::Matrix3d turn = place.linear() / scale;
  const bool z_up = turn(1, 2) > 0.7;
  if (z_up && !up_given) add("up", "the hair lies on the head with z up, not y", "--up z", true);
  if (turn.row(2).dot(z_up ? Vec3(0, -1, 0) : Vec3(0, 0, 1)) < 0)
    add("facing", std::string("the hair lies on the head when it looks along ") + (z_up ? "y, not -y" : "-z, not z"),
        "it is turned about", true);
  if (std::abs(scale - 1) > 0.02)
    add("size", formatted("the roots lie about a head %.2f times as large as the figure's", 1 / scale),
        "they are scaled", true);
}

void StripInspector::roots(const FittedStrips& fitted, const Character& character) {
  result.on_head = fitted.fit.empty();
  if (result.on_head) return;
  std::vector<double> before;
  Vec3 middle = Vec3::Zero();
  const Eigen::Matrix3d turn = place.linear() / std::cbrt(place.linear().determinant());
  for (const FollowedStrip& strip : strips.followed) {
    const Vec3 root = turn * middleOf(strip.rows.rows[0]);
    before.push_back(std::abs(head.distance(root.cast<float>())));
    middle += root / static_cast<double>(strips.followed.size());
  }
  if (farFromHead(fitted.conversion.mesh.shape, character)) {
    add("roots", fitted.fit, "");  // which names the options
    return;
  }
  result.on_head = true;
  const bool world = standsInWorld(head, middle.cast<float>());
  add("roots",
      formatted(world ? "the hair is on a head in the world, %.3g m from the figure's own"
                      : "the roots lie %.3g m from the scalp",
                std::max(median(std::move(before)), world ? (middle.cast<float>() - head.center).norm() : 0.0)),
      "they are moved there", true)
      .fault = !world;
}

// Pieces rooted at the wrong end, and those that are rooted nowhere.
void StripInspector::ends(const Character& character) {
  const std::vector<int> away = rootedAway(strips.followed, character, place);
  std::vector<int> turned, reversed, floating, unclear;
  for (const FollowedStrip& strip : strips.followed) {
    if (strip.turned && strips.turned_by_head) turned.push_back(strip.number);
    const double root = std::abs(distance(middleOf(strip.rows.rows.front()))),
                 tip = offScalp(middleOf(strip.rows.rows.back()));
    if (std::ranges::find(away, strip.number) != away.end()) {
      reversed.push_back(strip.number);
    } else if (root > kFloatingRoot) {
      floating.push_back(strip.number);
    } else if (strip.unclear && tip < kAtScalp) {
      unclear.push_back(strip.number);
    }
  }
  wrong += reversed.size() + floating.size();
  const std::string of = " of " + countOf(strips.followed.size(), "piece");
  if (!turned.empty())
    add("reversed",
        piecesText(turned) + of + verbOf(turned, " has its", " have their") + " other end on the head, and root there",
        "--flip-strips " + commaList(turned), true);
  if (!reversed.empty()) {
    const bool all = reversed.size() == strips.followed.size();
    add("reversed",
        all ? "all pieces are rooted at the end away from the scalp, by " + strips.roots
            : piecesText(reversed) + of + verbOf(reversed, " is", " are") +
                  " rooted at the end away from the scalp, by " + strips.roots,
        all ? "--other-end" : "--flip-strips " + commaList(reversed));
  }
  if (!floating.empty())
    add("roots", piecesText(floating) + of + verbOf(floating, " begins", " begin") + " more than 3 cm from the scalp",
        "--drop-strips " + commaList(floating));
  if (!unclear.empty())
    add("root edge", piecesText(unclear) + ": both ends are about as near to the scalp", "--flip-strips turns them")
        .fault = false;
}

// m, of a quad, or through a tube; and of all root edges together.
void StripInspector::widths() {
  std::vector<double> all;
  double rim = 0;
  for (const FollowedStrip& strip : strips.followed) {
    double sum = 0, count = 0;
    for (const std::vector<Vec3>& row : strip.rows.rows) {
      const std::size_t across = row.size() - 1;
      sum += strip.rows.tube ? 2 * (row[0] - middleOf(row)).norm() : (row[across] - row[0]).norm() / double(across);
      count += 1;
    }
    all.push_back(sum / count);
    rim += sum / count * (strip.rows.tube ? 1 : double(strip.rows.rows[0].size() - 1));
  }
  const double scale = std::cbrt(place.linear().determinant()), middle = scale * median(std::move(all));
  const bool over_head = strips.followed.size() >= kManyPieces && scale * rootSpread(strips.followed) > kOverHead;
  const bool thin = scale * rim < kLeastRim && (middle < kThinnestCard || over_head);
  if (!thin && middle <= kWidestCard) return;
  const double powers = std::round(std::log10(kUsualCard / middle));
  add("widths",
      formatted("the pieces are %.3g mm wide, all roots together %.3g m; cards and tubes are 2 to 120 mm", 1e3 * middle,
                scale * rim),
      formatted("make them %g times as wide in the file", std::pow(10.0, powers)));
}

void StripInspector::body() {
  std::vector<int> through;
  double deepest = 0;
  for (const FollowedStrip& strip : strips.followed) {
    double deep = 0;
    const Vec3 root = middleOf(strip.rows.rows[0]);
    for (const std::vector<Vec3>& row : strip.rows.rows)
      if ((middleOf(row) - root).norm() > kByRoot) deep = std::max(deep, -distance(middleOf(row)));
    if (deep > kDeepInBody) through.push_back(strip.number);
    deepest = std::max(deepest, deep);
  }
  wrong += through.size();
  if (through.empty()) return;
  add("body",
      piecesText(through) + " of " + countOf(strips.followed.size(), "piece") + verbOf(through, " goes", " go") +
          " through the body, " + formatted("%.1f mm at most", 1e3 * deepest),
      "lift them in the file; --drop-strips " + commaList(through) + " leaves them out");
}

// With one axis up.
GroomInspection inspectWithUp(const PolygonMesh& mesh, const StripOptions& options, bool up_given,
                              const std::string& file, const Character& character, double& bad) {
  const FittedStrips fitted = fitStrips(mesh, options, up_given, file, character, true);
  const StripConversion& strips = fitted.conversion;
  StripInspector inspector{mesh, options, strips, headModelOf(character), character.scalp, fitted.place, up_given};
  inspector.pieces();
  inspector.area();
  inspector.unit();
  inspector.axes();
  inspector.roots(fitted, character);
  inspector.ends(character);
  inspector.widths();
  inspector.body();
  bad = static_cast<double>(inspector.wrong) / static_cast<double>(strips.followed.size());
  std::size_t corners = 0;
  std::vector<double> lengths;
  for (const FollowedStrip& strip : strips.followed) {
    corners += strip.rows.rows.size() * strip.rows.rows[0].size();
    lengths.push_back(lineLength(strip.rows));
  }
  inspector.result.summary = countOf(strips.strips, "strip") + " and " + countOf(strips.tubes, "tube") + ", " +
                             std::to_string(corners) + " vertices, " +
                             formatted("%.3g m long (median), in ", median(std::move(lengths))) + strips.unit +
                             "; rooted at " + strips.roots;
  return std::move(inspector.result);
}

}  // namespace

GroomInspection inspectStrips(const PolygonMesh& mesh, const StripOptions& options, bool up_given,
                              const std::string& file, const Character& character) {
  double bad = 0, other = 0;
  GroomInspection inspection = inspectWithUp(mesh, options, up_given, file, character, bad);
  if (up_given || isYUp(file) || bad < kManyWrong || inspection.find("up")) return inspection;
  StripOptions turned = options;
  turned.up = 'z';
  try {
    inspectWithUp(mesh, turned, true, file, character, other);
  } catch (const InputError&) {
    return inspection;  // no strips with z up
  }
  if (other < kFewerWrong * bad)
    inspection.findings.insert(inspection.findings.begin(),
                               {"up",
                                formatted("with y up %.0f %% of the pieces float, go through the body or are rooted at "
                                          "the wrong end, with z up %.0f %%",
                                          100 * bad, 100 * other),
                                "--up z", false, true});
  return inspection;
}

namespace {

GroomInspection inspectHairMesh(std::string_view bytes, const std::string& file, const Character& character) {
  GroomInspection result;
  bool turned = false;
  sim::HairMeshShape shape = readHairMesh(bytes, file, false, "", &turned);
  result.summary = "a hair mesh of this program, " + std::to_string(shape.vertexCount()) + " vertices" + " in " +
                   countOf(shape.columnCount(), "column") + ", " + countOf(shape.root_faces.size(), "root face") +
                   "; show it with hairmesh --hair";
  if (turned) result.findings.push_back({"faces", "all are wound the other way", "they are turned", true, true});
  const std::string fit = fitHair(character, false, shape);
  if (!fit.empty()) result.findings.push_back({"place", fit, "", false, true});
  return result;
}

GroomInspection inspectBody(const PolygonMesh& mesh, const StillBody& body) {
  GroomInspection result;
  result.summary = "a body that stands still, " + std::to_string(mesh.positions.size()) + " vertices" +
                   ", and no hair; show it with hairmesh --motion";
  for (const std::string& note : body.notes) {
    const std::size_t colon = std::min(note.find(": "), note.size() - 2);
    result.findings.push_back({note.substr(0, colon), note.substr(colon + 2), "", false, false});
  }
  return result;
}

}  // namespace

GroomInspection inspectPolygons(std::string_view bytes, const StripOptions& options, bool up_given,
                                const std::string& file, const Character& character) {
  if (hasLayers(bytes)) return inspectHairMesh(bytes, file, character);
  const PolygonMesh mesh = readPolygons(file);
  if (!namesHair(mesh)) {
    if (const std::optional<StillBody> body = stillBodyOf(mesh)) return inspectBody(mesh, *body);
  }
  const bool worn = !namesHair(mesh) && looksWorn(mesh);
  std::optional<GroomInspection> inspection;
  try {
    inspection = inspectStrips(mesh, options, up_given, file, character);
  } catch (const InputError&) {
    if (!worn) throw;
  }
  if (worn && !(inspection && inspection->on_head))
    throw InputError(file, "", "is a mesh to wear, no hair", "give it to hairmesh --attach");
  return *std::move(inspection);
}

}  // namespace app

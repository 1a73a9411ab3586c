#include "app/groom/strips/strip_convert.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

#include "app/files/errors.h"
#include "app/files/length_units.h"
#include "app/files/median.h"
#include "app/files/report_line.h"
#include "app/groom/fit/strand_samples.h"

namespace app {

namespace {

using Eigen::Vector3d;

constexpr std::size_t kMaxPatches = 20000, kMaxScalpPoints = 20000, kToldOf = 6, kPiecesTold = 12;
constexpr double kFarApart = 8;         // medians of the roots' distances from their middle
constexpr double kOfStripLength = 0.2;  // of the median length: the median is taken to be no less
constexpr double kUnclear = 0.1;        // of a strip's length: ends whose measures differ by less are alike
constexpr double kMinSpread = 0.015, kMaxSpread = 0.35;  // m, of the roots of a unit that is said

constexpr const char* kGive =
    "give strips of quads from root to tip, or tubes; of a hair mesh name the groups layer_0, layer_1, ...";

enum class Role { kHair, kScalp, kUnknown };

Role roleOf(std::string name) {
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
  const auto has = [&](auto... words) { return ((name.find(words) != std::string::npos) || ...); };
  if (has("scalp", "skull")) return Role::kScalp;
  if (has("hair", "strand", "strip", "card", "tube", "braid", "ponytail", "fringe")) return Role::kHair;
  if (has("head", "face", "body", "skin")) return Role::kScalp;
  return Role::kUnknown;
}

struct Roles {
  std::vector<bool> hair, scalp;  // per object
  std::string scalp_names;
};

// Where any object is called hair, others are not; where none is, all but the scalp are.
Roles rolesOf(const PolygonMesh& mesh) {
  Roles out;
  std::vector<Role> roles;
  for (const std::string& name : mesh.objects) roles.push_back(roleOf(name));
  const bool named = std::ranges::find(roles, Role::kHair) != roles.end();
  for (std::size_t i = 0; i < roles.size(); ++i) {
    out.hair.push_back(roles[i] == Role::kHair || (!named && roles[i] == Role::kUnknown));
    out.scalp.push_back(roles[i] == Role::kScalp);
    if (out.scalp.back()) out.scalp_names += (out.scalp_names.empty() ? "" : ", ") + mesh.objects[i];
  }
  // A file of one thing is hair, whatever its name.
  if (std::ranges::find(out.hair, true) == out.hair.end()) {
    out.hair.assign(roles.size(), true);
    out.scalp.assign(roles.size(), false);
    out.scalp_names.clear();
  }
  return out;
}

// Middles of faces, evenly thinned.
std::vector<Vector3d> scalpPoints(const PolygonMesh& mesh, const std::vector<bool>* taken) {
  std::vector<Vector3d> points;
  for (std::size_t f = 0; f < mesh.faceCount(); ++f) {
    if (taken && !(*taken)[static_cast<std::size_t>(mesh.face_object[f])]) continue;
    Vector3d sum = Vector3d::Zero();
    for (const int corner : mesh.face(f)) sum += mesh.positions[static_cast<std::size_t>(corner)];
    points.push_back(sum / static_cast<double>(mesh.face(f).size()));
  }
  const std::size_t every = points.size() / kMaxScalpPoints + 1;
  std::vector<Vector3d> some;
  for (std::size_t i = 0; i < points.size(); i += every) some.push_back(points[i]);
  return some;
}

double upOf(const Vector3d& p, char up) {
  return up == 'z' ? p.z() : p.y();
}

RootMeasure measureOf(const StripOptions& options, const std::vector<Vector3d>& scalp, const std::string& file,
                      std::string& words) {
  const char up = options.up;
  if (options.root == RootEdge::kScalp && scalp.empty())
    throw InputError(file, "", "has no scalp: no object whose name has scalp, skull, head, face, body or skin",
                     "give the scalp's mesh with --scalp FILE, or --root-edge highest");
  if (options.root == RootEdge::kScalp || (options.root == RootEdge::kAuto && !scalp.empty())) {
    words = "the end nearest to the scalp";
    return [scalp](const Vector3d& p) {
      double least = std::numeric_limits<double>::infinity();
      for (const Vector3d& q : scalp) least = std::min(least, (p - q).squaredNorm());
      return std::sqrt(least);
    };
  }
  if (options.root == RootEdge::kLowest) {
    words = "the lowest end (" + std::string(1, up) + " up)";
    return [up](const Vector3d& p) { return upOf(p, up); };
  }
  words = "the highest end (" + std::string(1, up) + " up)";
  return [up](const Vector3d& p) { return -upOf(p, up); };
}

// The unit by the spread of the roots; one that the file says stays where it makes a head's spread.
double unitOf(const std::vector<FollowedStrip>& strips, double asked, std::optional<double> said, std::string& words) {
  char text[80];
  Groom roots;
  for (const FollowedStrip& strip : strips) {
    for (const Vector3d& p : strip.rows.rows[0]) {
      roots.points.push_back(p.cast<float>());
      roots.strand_first.push_back(static_cast<std::uint32_t>(roots.points.size()));
    }
  }
  const double spread = rootSpread(strips);
  const bool plausible = said && *said * spread > kMinSpread && *said * spread < kMaxSpread;
  if (asked > 0 || plausible) {
    std::snprintf(text, sizeof text, "units of %g m%s", asked > 0 ? asked : *said,
                  asked > 0 ? "" : ", as the file says");
    words = text;
    return asked > 0 ? asked : *said;
  }
  // Modelling programs count in one of these, which are too far apart to be taken for each other.
  for (const LengthUnit& unit : std::span(kLengthUnits).first(3)) {
    if (unit.metres * spread <= kMinSpread || unit.metres * spread >= kMaxSpread) continue;
    words = std::string(unit.words) + ", inferred from the spread of the roots";
    return unit.metres;
  }
  const double found = inferUnit(roots, words);
  words += ", inferred from the spread of the roots";
  return found;
}

std::string nameOf(const FollowedStrip& strip) {
  return "strip " + std::to_string(strip.number) + " ('" + strip.object + "')";
}

double endMeasure(const std::vector<Vector3d>& row, const RootMeasure& measure) {
  double sum = 0;
  for (const Vector3d& p : row) sum += measure(p);
  return sum / static_cast<double>(row.size());
}

// In the file's unit.
void followAll(const PolygonMesh& mesh, const std::vector<StripPatch>& patches, const StripOptions& options,
               const RootMeasure& measure, StripConversion& out) {
  for (std::size_t n = 0; n < patches.size(); ++n) {
    FollowedStrip one;
    one.number = static_cast<int>(n) + 1;
    if (std::ranges::find(options.dropped, one.number) != options.dropped.end()) continue;
    one.object = mesh.objects[static_cast<std::size_t>(patches[n].object)];
    one.turned = options.other_end != (std::ranges::find(options.flipped, one.number) != options.flipped.end());
    const std::string fault = stripRows(patches[n], measure, one.turned, one.rows);
    if (!fault.empty()) {
      out.left_out.push_back(nameOf(one) + " " + fault);
      continue;
    }
    one.root = endMeasure(one.rows.rows.front(), measure);
    one.tip = endMeasure(one.rows.rows.back(), measure);
    one.unclear = std::abs(one.tip - one.root) < kUnclear * lineLength(one.rows);
    out.cut += one.rows.cut_rows > 0 ? 1 : 0;
    out.followed.push_back(std::move(one));
  }
}

// Distances of points from their middle, which is the median of each coordinate.
std::vector<double> fromMiddle(const std::vector<Vector3d>& points) {
  Vector3d middle;
  for (int k = 0; k < 3; ++k) {
    std::vector<double> along;
    for (const Vector3d& p : points) along.push_back(p[k]);
    middle[k] = median(std::move(along));
  }
  std::vector<double> far;
  for (const Vector3d& p : points) far.push_back((p - middle).norm());
  return far;
}

// Pieces that lie so far from the others that they would tell a wrong unit and place.
void leaveOutAstray(StripConversion& out) {
  std::vector<Vector3d> roots;
  std::vector<double> lengths;
  for (const FollowedStrip& strip : out.followed) {
    roots.push_back(middleOf(strip.rows.rows[0]));
    lengths.push_back(lineLength(strip.rows));
  }
  const std::vector<double> far = fromMiddle(roots);
  const double most = kFarApart * std::max(median(far), kOfStripLength * median(std::move(lengths)));
  std::vector<FollowedStrip> near;
  for (std::size_t s = 0; s < far.size(); ++s) {
    if (far[s] <= most) {
      near.push_back(std::move(out.followed[s]));
    } else {
      out.astray.push_back(out.followed[s].number);
    }
  }
  out.followed = std::move(near);
}

void toMetres(StripConversion& out) {
  for (FollowedStrip& strip : out.followed) {
    strip.root *= out.scale;
    strip.tip *= out.scale;
    for (auto& row : strip.rows.rows)
      for (Vector3d& p : row) p *= out.scale;
  }
}

void checkNumbers(const StripOptions& options, std::size_t count, const std::string& file) {
  for (const std::vector<int>* const numbers : {&options.flipped, &options.dropped}) {
    for (const int number : *numbers) {
      if (number < 1 || static_cast<std::size_t>(number) > count)
        throw InputError(file, "strip " + std::to_string(number), "is not there",
                         "number the strips from 1 to " + std::to_string(count));
    }
  }
}

// Throws InputError where the vertices asked for are too few, or no strip can be made into prisms.
void makeMesh(const StripMeshOptions& options, const std::string& file, StripConversion& out) {
  std::vector<StripRows> strips;
  for (const FollowedStrip& strip : out.followed) strips.push_back(strip.rows);
  const int fewest = fewestVertices(strips, options);
  if (options.vertices > 0 && options.vertices < fewest)
    throw InputError(file, "",
                     "takes " + std::to_string(fewest) + " vertices at the least, for " +
                         countOf(strips.size(), "piece") + " of " +
                         (options.layers > 1 ? std::to_string(options.layers) : "4") + " layers; " +
                         std::to_string(options.vertices) + " are asked for",
                     "give --vertices " + std::to_string(fewest) + " or more, or a file of fewer strips");
  try {
    out.mesh = meshOfStrips(strips, options);
  } catch (const std::runtime_error& fault) {
    throw InputError(file, "", std::string("no hair mesh can be made of it: ") + fault.what(),
                     "give fewer strips with rows that do not fold over each other");
  }
  std::vector<bool> lost(strips.size(), false);
  for (const int s : out.mesh.left_out) {
    lost[static_cast<std::size_t>(s)] = true;
    out.left_out.push_back(nameOf(out.followed[static_cast<std::size_t>(s)]) + " folds over itself");
  }
  for (std::size_t s = 0; s < strips.size(); ++s) {
    if (lost[s]) continue;
    (strips[s].tube ? out.tubes : out.strips) += 1;
    if (!strips[s].tube && strips[s].rows[0].size() > 2) ++out.joined;
  }
}

std::string kinds(const StripConversion& conversion) {
  std::string text = countOf(conversion.strips, "strip");
  if (conversion.joined > 0) text += " (" + std::to_string(conversion.joined) + " of several quads across)";
  return text + " and " + countOf(conversion.tubes, "tube");
}

// Those of which it is so.
std::string pieceNumbers(const StripConversion& conversion, bool FollowedStrip::*so) {
  std::vector<int> numbers;
  for (const FollowedStrip& strip : conversion.followed)
    if (strip.*so) numbers.push_back(strip.number);
  return piecesText(numbers);
}

// "12 to 30 mm"
std::string rangeOf(const StripConversion& conversion, double FollowedStrip::*end) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const FollowedStrip& strip : conversion.followed) {
    least = std::min(least, strip.*end);
    most = std::max(most, strip.*end);
  }
  char text[64];
  std::snprintf(text, sizeof text, "%.0f to %.0f mm", 1e3 * least + 0.0, 1e3 * most + 0.0);
  return text;
}

// Which end of each piece is its root, and how clearly.
std::string rootReport(const StripConversion& conversion) {
  const auto count = [&](bool FollowedStrip::*so) {
    return static_cast<std::size_t>(std::ranges::count(conversion.followed, true, so));
  };
  const std::size_t all = conversion.followed.size(), turned = count(&FollowedStrip::turned),
                    unclear = count(&FollowedStrip::unclear);
  std::string text = reportLine("root edges    %s, of %zu of %zu pieces; --root-edge and --flip-strips overrule it",
                                conversion.roots.c_str(), all - turned, all);
  if (turned > 0)
    text += reportLine("turned        %s: rooted at the other end, %s",
                       turned == all ? "all" : pieceNumbers(conversion, &FollowedStrip::turned).c_str(),
                       conversion.turned_by_head ? "which is on the head" : "as asked for");
  if (conversion.by_scalp)
    text +=
        reportLine("              roots are %s from the scalp, tips %s",
                   rangeOf(conversion, &FollowedStrip::root).c_str(), rangeOf(conversion, &FollowedStrip::tip).c_str());
  if (unclear > 0)
    text += reportLine("unclear       %s: both ends are about as %s; --flip-strips turns them",
                       pieceNumbers(conversion, &FollowedStrip::unclear).c_str(),
                       conversion.by_scalp ? "near to the scalp" : "high");
  return text;
}

}  // namespace

double rootSpread(const std::vector<FollowedStrip>& strips) {
  std::vector<Vector3d> points;
  for (const FollowedStrip& strip : strips)
    points.insert(points.end(), strip.rows.rows[0].begin(), strip.rows.rows[0].end());
  return median(fromMiddle(points));
}

std::string piecesText(const std::vector<int>& numbers) {
  std::string text = numbers.size() == 1 ? "strip " : "strips ";
  for (std::size_t n = 0; n < std::min(kPiecesTold, numbers.size()); ++n)
    text += (n > 0 ? ", " : "") + std::to_string(numbers[n]);
  if (numbers.size() > kPiecesTold) text += " and " + std::to_string(numbers.size() - kPiecesTold) + " more";
  return text;
}

std::string astrayText(const StripConversion& conversion) {
  return piecesText(conversion.astray) + (conversion.astray.size() == 1 ? " lies" : " lie") + " apart from all others";
}

bool namesHair(const PolygonMesh& mesh) {
  return std::ranges::any_of(mesh.objects, [](const std::string& name) { return roleOf(name) == Role::kHair; });
}

StripConversion convertStrips(const PolygonMesh& mesh, const StripOptions& options, const std::string& file) {
  StripConversion out;
  const Roles roles = rolesOf(mesh);
  // The unit is not known yet: joining needs it as the file says.
  const double guess = options.unit > 0 ? options.unit : mesh.meters_per_unit.value_or(1);
  const std::vector<StripPatch> patches = stripPatches(mesh, roles.hair, options.join / guess);
  if (patches.empty() || patches.size() > kMaxPatches)
    throw InputError(file, "", patches.empty() ? "holds no faces of hair" : "has over 20,000 separate pieces", kGive);
  checkNumbers(options, patches.size(), file);
  const std::vector<Vector3d> scalp =
      options.scalp ? scalpPoints(*options.scalp, nullptr) : scalpPoints(mesh, &roles.scalp);
  out.scalp = options.scalp ? "" : roles.scalp_names;
  const RootMeasure measure = measureOf(options, scalp, file, out.roots);
  out.by_scalp = options.root == RootEdge::kScalp || (options.root == RootEdge::kAuto && !scalp.empty());
  followAll(mesh, patches, options, measure, out);
  if (out.followed.empty())
    throw InputError(file, "",
                     out.left_out.empty() ? "has no strip left but those that --drop-strips leaves out"
                                          : "holds no strip or tube that can be followed: " + out.left_out.front(),
                     kGive);
  leaveOutAstray(out);
  out.scale = unitOf(out.followed, options.unit, mesh.meters_per_unit, out.unit);
  for (const Vector3d& p : scalp) out.scalp_points.push_back(out.scale * p);
  toMetres(out);
  makeMesh(options.mesh, file, out);
  return out;
}

std::string stripReport(const StripConversion& conversion) {
  const StripMesh& mesh = conversion.mesh;
  std::string text = reportLine("read          %s in %s", kinds(conversion).c_str(), conversion.unit.c_str());
  if (!conversion.scalp.empty()) text += reportLine("scalp         %.300s", conversion.scalp.c_str());
  text += rootReport(conversion);
  const std::string least = mesh.least_layers < mesh.most_layers ? std::to_string(mesh.least_layers) + " to " : "";
  text +=
      reportLine("hair mesh     %d vertices in %d columns of %s%d layers; %zu root faces%s", mesh.shape.vertexCount(),
                 mesh.shape.columnCount(), least.c_str(), mesh.most_layers, mesh.shape.root_faces.size(),
                 !mesh.thinned                               ? ""
                 : mesh.shape.vertexCount() > kStripVertices ? "; more than usual, and as few as such strips take"
                                                             : "; rows were left out, --vertices asks for more");
  if (mesh.thickness > 0) text += reportLine("thickness     %.1f mm of strips at their roots", 1e3 * mesh.thickness);
  if (conversion.cut > 0)
    text += reportLine("cut short     %s whose last rows are no rows", countOf(conversion.cut, "strip").c_str());
  if (!conversion.astray.empty()) text += reportLine("left out      %s", astrayText(conversion).c_str());
  for (std::size_t k = 0; k < std::min(kToldOf, conversion.left_out.size()); ++k)
    text += reportLine("left out      %.300s", conversion.left_out[k].c_str());
  if (conversion.left_out.size() > kToldOf)
    text += reportLine("              and %zu more", conversion.left_out.size() - kToldOf);
  return text;
}

std::string stripNote(const StripConversion& conversion) {
  std::string text = kinds(conversion) + " in " + conversion.unit + ", rooted at " + conversion.roots + ", as " +
                     std::to_string(conversion.mesh.shape.vertexCount()) + " vertices";
  if (!conversion.astray.empty()) text += "; " + astrayText(conversion) + " and left out";
  if (!conversion.left_out.empty())
    text += "; " + std::to_string(conversion.left_out.size()) + " left out, the first: " + conversion.left_out.front();
  return text;
}

}  // namespace app

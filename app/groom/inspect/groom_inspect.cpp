#include "app/groom/inspect/groom_inspect.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "app/files/length_units.h"
#include "app/files/median.h"
#include "app/files/report_line.h"
#include "app/groom/inspect/groom_shape.h"
#include "app/groom/inspect/head_seat.h"
#include "app/groom/inspect/strand_direction.h"

namespace app {

using Eigen::Matrix3f;
using Eigen::Vector3f;

namespace {

constexpr double kSkullRadius = 0.09;   // m, of the sphere that roots lie about
constexpr double kOtherHeads = 2;       // times as large or small
constexpr float kThinnestHair = 8e-6f;  // m, a diameter
constexpr float kUsualWidth = 8e-5f, kWidestHair = 4e-4f, kAllHairs = 1e5f;
constexpr double kLikeHair = 1.5;                                                  // times as wide or narrow
constexpr float kFar = 0.018f, kAside = 0.05f, kFloating = 0.03f, kDeep = 0.006f;  // m
// Of roots over a scalp: spread and coverage of the sphere about them, and how long the mean of their directions is;
// the cosine between that and the way the hair hangs.
constexpr float kCapSpread = 0.08f, kCapCoverage = 0.03f, kMinCap = 0.2f, kMaxCap = 0.7f, kHanging = -0.3f;
constexpr float kSkull = 0.09f;                         // m around its middle, all of it head
constexpr float kSeated = 0.003f, kSeatSpread = 0.02f;  // m: on the skin, over so much of it
constexpr std::size_t kManyPoints = 256, kNumbersTold = 6;

std::string textOf(const char* format, double a, double b = 0) {
  std::array<char, 160> text;
  std::snprintf(text.data(), text.size(), format, a, b);
  return text.data();
}
std::string countText(std::size_t count, std::size_t of, const char* what) {
  return std::to_string(count) + " of " + std::to_string(of) + " strands " + what;
}

std::string moveText(const Vector3f& move) {
  std::array<char, 96> option;
  const auto millimetres = [](float x) { return std::round(1000.0 * double(x)) / 1000 + 0.0; };  // no minus before zero
  std::snprintf(option.data(), option.size(), "--move %.3f,%.3f,%.3f", millimetres(move.x()), millimetres(move.y()),
                millimetres(move.z()));
  return option.data();
}

// Where roots lie on the figure's skin.
struct Seat {
  const LengthUnit* unit = nullptr;
  Vector3f move = Vector3f::Zero();  // m
};

struct Inspector {
  const Groom& groom;
  const GroomHints& hints;
  const HeadModel* head;
  GroomInspection result{};
  StrandEnds ends{};
  SphereFit skull{};  // of the roots, in metres and our axes once these are known
  // Means of the roots' directions from the skull's middle, and of the ways from root to tip over the strands' length.
  Vector3f cap = Vector3f::Zero(), hang = Vector3f::Zero();
  double judged = 1;           // m a unit that lengths are judged in; 0: no unit fits, and they are not
  std::optional<Seat> seat{};  // of other hair than a scalp's, as a beard

  void add(const char* what, std::string text, std::string mend, bool certain) {
    result.findings.push_back({what, std::move(text), std::move(mend), certain, true});
  }
  // What is told by the shape that hair of a scalp has: of other hair a possibility, and no fault.
  void addGuess(const char* what, std::string text, std::string mend, bool of_scalp, bool certain) {
    add(what, (of_scalp ? "" : "if this is hair of a scalp, ") + text, std::move(mend), of_scalp && certain);
    result.findings.back().fault = of_scalp;
  }
  bool inWorld() const { return hints.world_heads > 0; }
  bool onCap() const;
  bool ofScalp() const;
  bool leftAsTold(std::string_view what) const;
  bool crowd() const { return hints.world_heads > 1; }
  void strands();
  void astray();
  void direction();
  void capAndHang();
  void unit();
  void unitOfSkull(double told);
  void findSeat();
  bool settled() const { return judged == result.mends.unit; }
  std::string inJudged() const { return settled() ? "" : "with " + result.find("unit")->mend + ", "; }
  void toMetres();
  void axes();
  void facing();
  void widths();
  void place();
  void placeSeated();
  bool scaleRoots(std::vector<Vector3f>& roots);
  void floating(const std::vector<Vector3f>& roots);
  void body(const std::vector<Vector3f>& roots, const Vector3f& move, bool skull_alone);
  bool heldToHead() const;
  void turn(const Matrix3f& matrix);
};

// Strands that no program can use, and numbers of points.
void Inspector::strands() {
  const std::size_t all = groom.strandCount();
  ends = strandEnds(groom, kMaxInspected, !inWorld());
  if (ends.non_finite > 0)
    add("non-finite", countText(ends.non_finite, all, "have points that are no finite numbers"), "--drop-bad", true);
  if (ends.zero_length > 0) add("zero-length", countText(ends.zero_length, all, "have no length"), "--drop-bad", true);
  if (ends.too_short > 0)
    add("points", countText(ends.too_short, all, "have fewer than two points"), "--drop-bad", true);
  if (hints.hidden > 0) {
    add("hidden", countOf(hints.hidden, "object") + " of curves that the file does not show are left out", "", false);
    result.findings.back().fault = false;
  }
  if (all < kMinRoots) add("strands", countText(all, kMinRoots, "are there, of which a hair mesh is made"), "", false);
  result.mends.drop_bad = ends.non_finite + ends.zero_length + ends.too_short > 0;
  std::size_t many = 0;
  for (std::size_t s = 0; s < all; ++s) many += groom.pointCount(s) > kManyPoints;
  if (many > 0) add("points", countText(many, all, "have more than 256 points"), "--points 32", false);
}

void Inspector::astray() {
  if (ends.astray.empty()) return;
  std::string numbers;
  for (std::size_t n = 0; n < std::min(kNumbersTold, ends.astray.size()); ++n)
    numbers += (n == 0 ? ": number " : ", ") + std::to_string(ends.astray[n]);
  if (ends.astray.size() > kNumbersTold) numbers += ", ...";
  add("astray", countText(ends.astray.size(), groom.strandCount(), "lie apart, or have a point that does") + numbers,
      "--drop-astray", true);
  result.mends.drop_astray = true;
}

void Inspector::direction() {
  skull = fitSphere(ends.first);
  if (ends.first.size() < kMinRoots || inWorld()) return;
  const StrandDirections found = strandDirections(ends);
  if (found.turned_count == 0 || found.certain) skull = found.skull;
  if (found.turned_count == 0) return;
  for (std::size_t n = 0; found.certain && n < found.turned.size(); ++n) {
    if (found.turned[n]) std::swap(ends.first[n], ends.last[n]);
  }
  const bool all = found.turned_count == found.turned.size();
  if (found.certain) result.mends.reverse = all ? Reverse::kAll : Reverse::kFound;
  addGuess("reversed",
           all ? "the strands run from tip to root"
               : countText(found.turned_count, found.turned.size(), "run from tip to root"),
           all ? "--reverse all" : "--reverse found", found.certain, true);
}

void Inspector::capAndHang() {
  if (ends.first.empty() || !(skull.radius > 0)) return;
  float length = 0;
  for (std::size_t n = 0; n < ends.first.size(); ++n) {
    cap += (ends.first[n] - skull.center) / (skull.radius * static_cast<float>(ends.first.size()));
    hang += ends.last[n] - ends.first[n];
    length += (ends.last[n] - ends.first[n]).norm();
  }
  if (length > 0) hang /= length;
}

// Whether the roots lie over one side of a skull: not over all of a ball, as fur may, nor about a chin or a flat place.
bool Inspector::onCap() const {
  return skull.spread < kCapSpread && skull.coverage > kCapCoverage && cap.norm() > kMinCap && cap.norm() < kMaxCap;
}

// Whether it is hair of a scalp beyond doubt: it hangs away from the side that it grows on.
bool Inspector::ofScalp() const {
  return onCap() && cap.dot(hang) < kHanging * cap.norm() * hang.norm();
}

// Whether hair that is not clearly a scalp's lies on the figure's skin already: about the head's own place or where the
// figure stands, in the unit that is told or one of those known.
void Inspector::findSeat() {
  if (head == nullptr || ends.first.size() < kMinRoots || inWorld() || hints.axes || ofScalp()) return;
  const Matrix3f axes = toldAxes(hints);
  const double told = hints.meters_per_unit.value_or(0);
  std::vector<Vector3f> moves{Vector3f::Zero()};
  if (head->standing) moves.emplace_back(head->center - *head->standing);
  for (const LengthUnit& one : kLengthUnits) {
    if (told > 0 && std::abs(one.metres / told - 1) > 0.01) continue;
    Eigen::AlignedBox3f box;
    std::vector<Vector3f> roots = ends.first;
    for (Vector3f& root : roots) box.extend(root = static_cast<float>(one.metres) * (axes * root));
    if (box.diagonal().norm() < kSeatSpread) continue;
    for (const Vector3f& move : moves) {
      std::vector<Vector3f> moved = roots;
      for (Vector3f& root : moved) root += move;
      if (offHead(*head, moved) > kSeated) continue;
      seat = {&one, move};
      return;
    }
  }
}

void Inspector::unit() {
  const double told = hints.meters_per_unit.value_or(1);
  result.mends.unit = judged = told;
  const bool measured = ends.first.size() >= kMinRoots && skull.radius > 1e-3f * groomSize(groom);
  if (measured && !inWorld()) {
    findSeat();
    if (!seat) {
      unitOfSkull(told);
    } else if (!hints.meters_per_unit && seat->unit != &kLengthUnits[0]) {
      result.mends.unit = judged = seat->unit->metres;
      add("unit", std::string("the roots lie on the figure's skin in ") + seat->unit->name + ", not m",
          std::string("--unit ") + seat->unit->name, true);
    }
  }
  toMetres();
}

// What follows is judged in the unit that was found, be it certain or not: in one that is told of other hair than a
// scalp's, unless that makes it far too large or small for any head.
void Inspector::unitOfSkull(double told) {
  const auto off = [this](double meters) { return std::abs(std::log(meters * skull.radius / kSkullRadius)); };
  const LengthUnit* best = &kLengthUnits[0];
  for (const LengthUnit& unit : kLengthUnits) best = off(unit.metres) < off(best->metres) ? &unit : best;
  const bool fits = off(best->metres) < std::log(1.45);
  const bool strange = off(told) > std::log(10);
  const double likely = fits && (onCap() || strange || !hints.meters_per_unit) ? best->metres
                        : onCap() || strange                                   ? 0
                                                                               : told;
  if (hints.unit_given) {
    if (off(told) <= std::log(3)) return;
    judged = likely;
    add("unit", textOf("in the unit asked for the roots lie about a skull of radius %.3g m", told * skull.radius),
        fits ? std::string("--unit ") + best->name : "leave --unit away", false);
  } else if (fits && std::abs(best->metres / told - 1) > 0.01 && off(told) > std::log(1.45)) {
    // What is told holds, but not where it makes a head more than ten times too large or small.
    const bool certain = hints.meters_per_unit ? strange && ofScalp() : onCap();
    if (certain) result.mends.unit = best->metres;
    judged = likely;
    addGuess("unit",
             textOf("the roots lie about a skull of radius %.3g, which fits ", skull.radius) + best->name +
                 (hints.meters_per_unit ? textOf("; the file tells %g m a unit", told) : ", not m"),
             std::string("--unit ") + best->name, onCap(), certain);
  } else if (!fits && head != nullptr && best->metres == told && onCap() && off(told) < std::log(kOtherHeads)) {
    judged = told;  // of another size of head: place() tells
  } else if (!fits) {
    judged = likely;
    addGuess("unit",
             textOf("the roots lie about a skull of radius %.3g m; no unit makes that a head, --scale %.3g does",
                    skull.radius * told, kSkullRadius / (skull.radius * told)),
             "--unit m|cm|mm|in|ft", onCap() || strange, false);
  }
}

void Inspector::toMetres() {
  const auto scale = static_cast<float>(judged > 0 ? judged : result.mends.unit);
  skull.center *= scale;
  skull.radius *= scale;
  for (auto* points : {&ends.first, &ends.last}) {
    for (Vector3f& p : *points) p *= scale;
  }
}

// Whether something else was found than what the file tells, which holds until it is overruled.
bool Inspector::leftAsTold(std::string_view what) const {
  const GroomFinding* const finding = result.find(what);
  return finding != nullptr && !finding->certain;
}

void Inspector::turn(const Matrix3f& matrix) {
  result.mends.axes = matrix * result.mends.axes;
  for (Vector3f* const one : {&skull.center, &cap, &hang}) *one = matrix * *one;
  for (auto* points : {&ends.first, &ends.last}) {
    for (Vector3f& p : *points) p = matrix * p;
  }
}

// Whether the figure's head tells how the roots are turned: those over a scalp, of a head of its size.
bool Inspector::heldToHead() const {
  return head != nullptr && onCap() && judged > 0 && std::abs(std::log(skull.radius / kSkullRadius)) < std::log(1.25);
}

// By the height of a standing figure's head; else by how the roots lie on the head; else by how hair grows and hangs.
void Inspector::axes() {
  if (hints.axes) return turn(*hints.axes);
  const Matrix3f told = toldAxes(hints);
  turn(told);
  if (ends.first.size() < kMinRoots || inWorld() || seat) return;
  const std::array<float, 6> scores = upsByHang(cap, hang, told);
  const auto hung = static_cast<std::size_t>(std::ranges::max_element(scores) - scores.begin());
  const std::size_t told_up = hints.up == 'Z' ? 1 : 0;
  std::size_t best = hung;
  bool fits = false;
  const auto standing = head != nullptr && judged > 0 ? standingUp(*head, skull.center, told) : std::nullopt;
  if (standing) {
    best = *standing;
    fits = best != told_up;
  } else if (heldToHead()) {
    const std::array<float, 6> off = upsOnHead(*head, ends.first, skull.center, told);
    const auto least = static_cast<std::size_t>(std::ranges::min_element(off) - off.begin());
    if (farBetter(off[least], off[hung])) best = least;
    fits = farBetter(off[best], off[told_up]);
  }
  if (best == told_up) return;
  std::array<float, 6> sorted = scores;
  std::ranges::sort(sorted);
  const bool certain = fits || (!hints.up && sorted[5] - sorted[4] > 0.15f);
  addGuess("up",
           (standing ? "the hair is as high as a standing figure's if "
            : fits   ? "the roots lie on the head as if "
                     : "the hair hangs as if ") +
               std::string(kUps[best]) + (standing ? " is up" : " were up") +
               (hints.up ? std::string("; the file tells ") + (*hints.up == 'Z' ? "z" : "y") : ", not y"),
           "--up " + std::string(kUps[best]), fits || ofScalp(), certain);
  if (certain && (fits || ofScalp())) turn(*axesOfUp(kUps[best]) * told.transpose());
}

// More hair grows behind the middle of the skull than before it; where a scalp is half bald by intent, its roots lie
// nearer to the head as they are. A beard, which grows below the middle, grows before it.
void Inspector::facing() {
  if (hints.turn) return turn(*hints.turn);
  if (ends.first.size() < kMinRoots || crowd() || leftAsTold("up")) return;
  const bool backed = cap.y() < 0 || -cap.z() >= std::abs(cap.x()) || std::hypot(cap.x(), cap.z()) < 0.1f;
  double degrees = backed ? 0 : cap.z() > std::abs(cap.x()) ? 180 : cap.x() > 0 ? 90 : -90;
  // A head is longer than wide: hair a quarter turn aside leaves it by 8 mm, hair that is turned right by 0.3 mm.
  const auto off = [&](double by) { return offHeadTurned(*head, ends.first, skull.center, turnedAbout(by)); };
  if (degrees != 0 && head != nullptr && off(degrees) > 2 * off(0)) degrees = 0;
  const bool fits = degrees == 0 && heldToHead();
  if (fits) degrees = turnOnHead(*head, ends.first, skull.center);
  if (degrees == 0) return;
  const bool certain = fits || ofScalp() || inWorld();
  addGuess("facing",
           textOf("the hair grows on the wrong side: the face would look %.0f degrees aside", std::abs(degrees)),
           textOf("--turn %.0f", degrees), certain, true);
  if (inWorld()) {
    result.findings.back().fault = false;
    result.findings.back().text = textOf("the head looks %.0f degrees aside", std::abs(degrees));
  }
  if (certain) turn(turnedAbout(degrees));
}

void Inspector::widths() {
  if (groom.widths.empty()) return;
  const auto unit = static_cast<float>(judged);
  std::vector<float> usable;
  std::size_t bad = 0;
  for (const float width : groom.widths) {
    const bool fine = std::isfinite(width) && width > 0;
    if (fine) usable.push_back(width * unit);
    bad += !fine;
  }
  if (bad > 0) {
    add("widths",
        std::to_string(bad) + " of " + std::to_string(groom.widths.size()) + " widths are 0, negative or no number",
        "--width 8e-5", false);
  }
  if (usable.empty() || judged == 0) return;
  const float middle = median(usable);
  const float widest = std::max(kWidestHair, 1.5f * kUsualWidth * kAllHairs / static_cast<float>(groom.strandCount()));
  const float most = std::min(widest, 5e-3f);
  if (middle >= kThinnestHair && middle <= most) return;
  // Few strands may be wide by intent, unless a power of ten makes them as wide as hair is.
  const auto powersTo = [&](float wanted) { return std::round(std::log10(wanted / middle)); };
  const double usual = powersTo(kUsualWidth), to_usual = middle * std::pow(10.0, usual) / kUsualWidth;
  const bool plain = middle < kThinnestHair || (to_usual > 1 / kLikeHair && to_usual < kLikeHair);
  const double powers = plain ? usual : powersTo(std::sqrt(kUsualWidth * most));
  const double scale = std::pow(10.0, powers == 0 ? (middle < kThinnestHair ? 1 : -1) : powers);
  const bool certain = settled() && !leftAsTold("unit") && !inWorld();
  if (certain) result.mends.width_scale = static_cast<float>(scale);
  const double wanted = plain ? kUsualWidth : std::sqrt(kUsualWidth * most);  // wider where they are few
  add("widths", inJudged() + textOf("the strands are %.3g mm wide; %.2g mm is usual", 1e3 * middle, 1e3 * wanted),
      textOf("--width-scale %g", scale), certain);
  result.findings.back().fault = !inWorld();  // few strands are drawn wide
}

// Brings roots all over a scalp to the size of the head, where that is certain.
bool Inspector::scaleRoots(std::vector<Vector3f>& roots) {
  if (!ofScalp() || inWorld() || !settled() || leftAsTold("up")) return false;
  const float scale = scaleToHead(*head, roots, skull.center);
  if (scale == 1) return false;
  add("size", textOf("the roots lie about a head %.2f times as large as the figure's", 1 / scale),
      textOf("--scale %.3f", scale), true);
  result.mends.scale = scale;
  for (Vector3f& root : roots) root *= scale;
  return true;
}

void Inspector::place() {
  if (head == nullptr || ends.first.size() < kMinRoots || crowd() || judged == 0) return;
  if (seat) return placeSeated();
  std::vector<Vector3f> roots = ends.first;
  const float before = offHead(*head, roots);
  const float aside = (skull.center - head->center).norm(), away = before > kFar ? before : std::max(before, aside);
  Vector3f move = Vector3f::Zero();
  bool world = inWorld();
  // Roots of a scalp may lie near a head by chance, about its neck.
  const bool elsewhere = before > kFar || (ofScalp() && aside > kAside);
  const bool sized = scaleRoots(roots);
  result.on_head = settled() && !elsewhere && !sized;
  if (elsewhere || sized) {
    move = moveToHead(*head, roots, result.mends.scale * skull.center);
    for (Vector3f& root : roots) root += move;
    const bool fits = offHead(*head, roots) <= kFar && (cap.norm() > kMinCap || inWorld());
    const bool certain = fits && settled() && !leftAsTold("up");
    world = world || (fits && standsInWorld(*head, skull.center));
    add("roots",
        inJudged() + textOf(world ? "the hair is on a head in the world, %.3g m from the figure's own"
                                  : "the roots lie %.3g m from the scalp",
                            away),
        moveText(move), certain);
    result.findings.back().fault = !world;
    result.on_head = certain;
    if (!fits) return;
    if (certain) result.mends.move = move;
  }
  if (!inWorld()) floating(roots);
  body(roots, move, world);
}

// Hair that lies on the skin stays there, or comes along with the head that it lies on in the world.
void Inspector::placeSeated() {
  std::vector<Vector3f> roots = ends.first;
  Vector3f middle = Vector3f::Zero();
  for (Vector3f& root : roots) middle += (root += seat->move) / static_cast<float>(roots.size());
  const bool world = seat->move != Vector3f::Zero();
  const bool face = middle.y() < head->center.y() && middle.z() > head->center.z();
  if (world || face) {
    add("roots",
        std::string(face ? "the hair grows on the face, as a beard does" : "the roots lie on the figure's skin") +
            (world
                 ? textOf(", where the figure stands in the world, %.3g m from the head's own place", seat->move.norm())
                 : "; it stays there"),
        world ? moveText(seat->move) : "", world);
    result.findings.back().fault = false;
  }
  result.on_head = true;
  result.mends.move = seat->move;
  floating(roots);
  body(roots, seat->move, false);
}

void Inspector::floating(const std::vector<Vector3f>& roots) {
  const auto far =
      std::ranges::count_if(roots, [this](const Vector3f& p) { return std::abs(head->distance(p)) > kFloating; });
  if (far == 0) return;
  add("roots",
      inJudged() + countText(static_cast<std::size_t>(far), roots.size(), "begin more than 3 cm from the scalp"),
      "--drop-far 0.03", false);
}

// Strands that go into the body beyond their first tenth. skull_alone: in the world the figure's pose need not be that
// of rest, and the head alone is where it is.
void Inspector::body(const std::vector<Vector3f>& roots, const Vector3f& move, bool skull_alone) {
  std::size_t through = 0;
  float deepest = 0;
  const float scale = static_cast<float>(judged) * result.mends.scale;
  for (std::size_t n = 0; n < ends.strands.size(); ++n) {
    const std::span<const Vector3f> points = groom.strand(ends.strands[n]);
    float deep = 0;
    for (const Vector3f& point : points) {
      const Vector3f at = scale * (result.mends.axes * point) + move;
      if (skull_alone && (at - head->center).norm() > kSkull) continue;
      if ((at - roots[n]).norm() > 0.01f) deep = std::max(deep, -head->distance(at));
    }
    through += deep > kDeep;
    deepest = std::max(deepest, deep);
  }
  if (through * 100 <= ends.strands.size()) return;
  add("body",
      inJudged() + countText(through, ends.strands.size(), "go through the body, ") +
          textOf("%.1f mm at most", 1e3 * deepest),
      "--push-out", false);
}

}  // namespace

const GroomFinding* GroomInspection::find(std::string_view what) const {
  const auto found = std::ranges::find(findings, what, &GroomFinding::what);
  return found == findings.end() ? nullptr : &*found;
}

GroomInspection inspectGroom(const Groom& groom, const GroomHints& hints, const HeadModel* head) {
  Inspector inspector{groom, hints, head};
  inspector.strands();
  inspector.astray();
  inspector.direction();
  inspector.capAndHang();
  inspector.unit();
  inspector.axes();
  inspector.facing();
  inspector.widths();
  inspector.place();
  std::vector<float> counts;
  for (std::size_t s = 0; s < groom.strandCount(); ++s) counts.push_back(static_cast<float>(groom.pointCount(s)));
  inspector.result.summary =
      countOf(groom.strandCount(), "strand") + ", " + countOf(groom.points.size(), "point") + ", " +
      textOf("%.0f a strand (median), %.3g m across", median(counts),
             groomSize(groom) * (inspector.judged > 0 ? inspector.judged : inspector.result.mends.unit));
  return std::move(inspector.result);
}

}  // namespace app

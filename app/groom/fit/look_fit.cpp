#include "app/groom/fit/look_fit.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <deque>
#include <limits>
#include <map>
#include <numbers>

#include "app/groom/fit/clump_fit.h"

namespace app {
namespace {

using Eigen::Vector3f;

constexpr int kFitPoints = 96;            // of a strand that is measured
constexpr std::size_t kFinePerPoint = 4;  // points along the given strand
constexpr std::size_t kMaxLooked = 4000;
constexpr int kMaxTurns = 16;
constexpr double kMinTurns = 2.5, kTurnStep = 0.25, kQuickTurns = 3;  // slower turns are wander
constexpr double kOpening = 0.35;         // share of the length over which curls open, shaders/common/strand.glsl
constexpr double kSmallestCurl = 0.0012;  // m
constexpr double kClearCurl = 0.5;        // of a strand's wander that one rotation explains
// The share of length_variation by which a strand ends early, in the mean: 0.4 u^2 + 0.25 u + 0.2 u of random u, and
// 0.15 of the squared distance from a clump's middle (shaders/common/strand.glsl; 0.48 measured).
constexpr double kMeanEarly = 0.4 / 3 + 0.25 / 2 + 0.2 / 2 + 0.15 * 0.48;
constexpr std::size_t kMinColumnStrands = 8, kMinColumnPairs = 40;
constexpr double kOwn = 0.7;  // of a strand's frizz that the nearest neighbour does not share, where it is its own
constexpr double kOtherFrizz = 0.0004, kOtherClump = 0.25;  // m, 0..1: less is no difference between places
constexpr double kLowClump = 0.3;                           // of what most places have: less varies by chance
constexpr double kMinWidthShare = 0.05;                     // of what most strands have: thinner ones are not seen
// Root mean square of frizz and offset over a strand, in their own amplitudes: of grow(t) = t (1.6 - 0.6 t), two sines,
// and a disc (shaders/common/strand.glsl).
constexpr double kFrizzSpread = 0.667, kOffsetSpread = 0.31;
constexpr float kNearFit = 0.008f;     // m, of strands that share what the hair mesh misses
constexpr double kMaxWander = 0.005;   // m; what strays farther is held by no hair mesh, and drawn as noise by any
constexpr std::size_t kMaxShared = 6;  // the nearest of so many

struct StrandMeasure {
  int face = 0;
  double radius = 0, turns = 0;  // of its clearest rotation; 0: none
  double frizz = 0;              // m, root mean square of what is left by more than three turns
  double own_frizz = -1;         // the same, 0 where a neighbour shares it: the hair mesh misses it; -1: it has none
  double wander = -1;            // the same by less, of its own: not shared with a neighbour; -1: it has none
  double along = 0;              // m, of the strand that grows in its place without curls
  double length_share = 1;       // of what is usual where it roots
  double width = -1;             // at its root, in the groom's unit; negative: it has none
};

// The strand where it has come as far along the grown one as that at its even steps: a curl takes more of a strand's
// own length where it is open.
void besideGrown(std::span<const Vector3f> given, std::span<const Vector3f> grown, std::span<Vector3f> beside) {
  std::vector<Vector3f> fine(kFinePerPoint * grown.size());
  resample(given, fine);
  std::vector<float> way{0};
  for (std::size_t k = 1; k < fine.size(); ++k) {
    const std::size_t at = std::min(k / kFinePerPoint, grown.size() - 2);
    const Vector3f along = (grown[at + 1] - grown[at]).stableNormalized();
    way.push_back(way.back() + std::max(0.0f, along.dot(fine[k] - fine[k - 1])));
  }
  std::size_t k = 0;
  for (std::size_t n = 0; n < beside.size(); ++n) {
    const float wanted = way.back() * static_cast<float>(n) / static_cast<float>(beside.size() - 1);
    while (k + 2 < way.size() && way[k + 1] < wanted) ++k;
    const float step = way[k + 1] - way[k];
    const float share = step > 0 ? std::clamp((wanted - way[k]) / step, 0.0f, 1.0f) : 0;
    beside[n] = fine[k] + share * (fine[k + 1] - fine[k]);
  }
}

// The strand's distance from the grown one as complex numbers in the grown one's frame.
std::vector<std::complex<double>> wander(std::span<const Vector3f> strand, std::span<const Vector3f> grown) {
  std::vector<std::complex<double>> out;
  Vector3f aside = Vector3f::Zero();
  for (std::size_t k = 0; k < grown.size(); ++k) {
    const Vector3f along = (grown[std::min(k + 1, grown.size() - 1)] - grown[k > 0 ? k - 1 : 0]).stableNormalized();
    if (k == 0) aside = along.unitOrthogonal();
    aside = (aside - along.dot(aside) * along).stableNormalized();
    const Vector3f gap = strand[k] - grown[k];
    out.emplace_back(gap.dot(aside), gap.dot(along.cross(aside)));
  }
  return out;
}

// Of kFitPoints points the windowed turning back by `turns`, over the part where curls are open, from `first` on.
struct Turning {
  std::size_t first = static_cast<std::size_t>(kOpening * kFitPoints);
  std::vector<std::complex<double>> back;
  double weights = 0;
  explicit Turning(double turns) {
    for (std::size_t k = first; k < kFitPoints; ++k) {
      const double t = static_cast<double>(k) / (kFitPoints - 1);
      const double x = static_cast<double>(k - first) / static_cast<double>(kFitPoints - 1 - first);
      const double window = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * x);
      back.push_back(window * std::polar(1.0, -2 * std::numbers::pi * turns * t));
      weights += window;
    }
  }
};

// Amplitudes of the rotation either way, beside a mean and a drift.
double amplitudeOf(const std::vector<std::complex<double>>& way, const Turning& turning) {
  std::complex<double> one = 0, other = 0;
  for (std::size_t n = 0; n < turning.back.size(); ++n) {
    const std::complex<double>&z = way[turning.first + n], &back = turning.back[n];
    const double rr = z.real() * back.real(), ii = z.imag() * back.imag();
    const double ri = z.real() * back.imag(), ir = z.imag() * back.real();
    one += std::complex<double>(rr - ii, ir + ri);
    other += std::complex<double>(rr + ii, ir - ri);
  }
  return std::sqrt(std::norm(one) + std::norm(other)) / turning.weights;
}

// The way about its running mean over a turn of `turns`.
std::vector<std::complex<double>> quickPart(const std::vector<std::complex<double>>& way, double turns) {
  const int reach = std::max(1, static_cast<int>(0.5 * static_cast<double>(way.size()) / turns));
  const int count = static_cast<int>(way.size());
  std::vector<std::complex<double>> quick = way;
  for (int k = 0; k < count; ++k) {
    std::complex<double> sum = 0;
    const int side = std::min({reach, k, count - 1 - k});
    for (int d = -side; d <= side; ++d) sum += way[static_cast<std::size_t>(k + d)];
    quick[static_cast<std::size_t>(k)] -= sum / (2.0 * side + 1);
  }
  return quick;
}

double rootMeanSquare(const std::vector<std::complex<double>>& way) {
  double square = 0;
  for (const auto& z : way) square += std::norm(z) / static_cast<double>(way.size());
  return std::sqrt(square);
}

// By less than three turns, and by more, m.
std::array<double, 2> slowAndQuick(const std::vector<std::complex<double>>& way) {
  const double quick = rootMeanSquare(quickPart(way, kQuickTurns)), all = rootMeanSquare(way);
  return {std::sqrt(std::max(0.0, all * all - quick * quick)), quick};
}

void measureTurns(const std::vector<std::complex<double>>& way, StrandMeasure& measure) {
  const std::vector<std::complex<double>> part = quickPart(way, kQuickTurns);
  static const std::vector<Turning> kTurnings = [] {
    std::vector<Turning> all;
    for (double turns = kMinTurns; turns <= kMaxTurns; turns += kTurnStep) all.emplace_back(turns);
    return all;
  }();
  double best = 0;
  for (std::size_t n = 0; n < kTurnings.size(); ++n) {
    const double amplitude = amplitudeOf(part, kTurnings[n]);
    if (amplitude <= best) continue;
    best = amplitude;
    measure.turns = kMinTurns + kTurnStep * static_cast<double>(n);
  }
  const double quick = rootMeanSquare(part);
  if (best * best > kClearCurl * quick * quick) measure.radius = best;
  measure.frizz = measure.radius > 0 ? std::sqrt(std::max(0.0, quick * quick - 0.8 * best * best)) : quick;
}

std::array<int, 3> cellOf(const Vector3f& at, float size) {
  std::array<int, 3> cell;
  for (int k = 0; k < 3; ++k) cell[static_cast<std::size_t>(k)] = static_cast<int>(std::floor(at[k] / size));
  return cell;
}

StrandCharacter summary(const std::vector<const StrandMeasure*>& of) {
  StrandCharacter out;
  out.strands = static_cast<int>(of.size());
  std::vector<float> radius, turns, pitch, frizz, wander, shares;
  for (const StrandMeasure* one : of) {
    if (one->radius > kSmallestCurl) {
      radius.push_back(static_cast<float>(one->radius));
      turns.push_back(static_cast<float>(one->turns));
      pitch.push_back(static_cast<float>(one->along / one->turns));
    }
    frizz.push_back(static_cast<float>(one->frizz));
    if (one->wander >= 0) wander.push_back(static_cast<float>(one->wander));
    shares.push_back(static_cast<float>(one->length_share));
  }
  if (2 * radius.size() > of.size()) {
    out.curl_radius = quantile(radius, 0.5);
    out.curl_turns = quantile(turns, 0.5);
    out.curl_pitch = std::clamp(quantile(pitch, 0.5), 0.003, 0.3);
  }
  out.frizz = quantile(frizz, 0.5) / kFrizzSpread;
  if (!wander.empty()) out.offset = std::min(quantile(wander, 0.5) / kOffsetSpread, kMaxWander);
  // The median: a few baby hairs make no range of lengths.
  out.length_variation = std::clamp((1 - quantile(shares, 0.5)) / kMeanEarly, 0.0, 0.6);
  return out;
}

// One list a column of those whose bundle it is a corner of.
template <class Entry>
std::vector<std::vector<Entry>> byColumn(const std::vector<Entry>& entries, const sim::HairMeshShape& shape,
                                         const auto& face_of) {
  std::vector<std::vector<Entry>> lists(static_cast<std::size_t>(shape.columnCount()));
  for (const Entry& entry : entries) {
    const sim::RootFace& face = shape.root_faces[static_cast<std::size_t>(face_of(entry))];
    for (int k = 0; k < face.corner_count; ++k)
      lists[static_cast<std::size_t>(face.columns[static_cast<std::size_t>(k)])].push_back(entry);
  }
  return lists;
}

// Negative values become that of the nearest column with one. False where none has one.
bool fillGaps(const sim::HairMeshShape& shape, std::vector<double>& values) {
  const std::vector<double> known = values;
  const auto root = [&](std::size_t c) { return shape.positions[static_cast<std::size_t>(shape.column_first[c])]; };
  bool any = false;
  for (std::size_t c = 0; c < values.size(); ++c) {
    double nearest = std::numeric_limits<double>::max();
    for (std::size_t other = 0; known[c] < 0 && other < known.size(); ++other) {
      const double apart = (root(c) - root(other)).squaredNorm();
      if (known[other] < 0 || apart >= nearest) continue;
      nearest = apart;
      values[c] = known[other];
    }
    any = any || values[c] >= 0;
  }
  return any;
}

// Whether values differ by more than `least` and by 1 - `share` from a seventh of the places or more to as many others;
// `most`: what the others have. Fewer may be what the hair mesh misses.
bool differ(const std::vector<double>& values, double least, double& most, double share) {
  const std::vector<float> sorted(values.begin(), values.end());
  const double low = quantile(sorted, 0.14);
  most = quantile(sorted, 0.86);
  return most - low > least && low < share * most;
}

double shareOf(double value, double most) {
  return std::round(1e3 * std::min(1.0, value / most)) / 1e3;
}

double closingOf(const std::vector<float>& ratios) {
  return std::clamp(1 - quantile(ratios, 0.5), 0.0, 1.0);
}

// Where clumps, curls, frizz or widths differ from place to place, `look.all` becomes what most places do not exceed.
void fitPlaces(const std::vector<StrandMeasure>& measures, const ClumpFit& clumps, const sim::HairMeshShape& shape,
               LookFit& look) {
  std::vector<double> clump, curl, frizz, width;
  std::vector<const StrandMeasure*> all;
  for (const StrandMeasure& measure : measures) all.push_back(&measure);
  const auto around = byColumn(all, shape, [](const StrandMeasure* one) { return one->face; });
  for (const std::vector<const StrandMeasure*>& of : around) {
    const bool enough = of.size() >= kMinColumnStrands;
    std::vector<float> own, widths;
    for (const StrandMeasure* one : of) {
      if (one->own_frizz >= 0) own.push_back(static_cast<float>(one->own_frizz));
      if (one->width > 0) widths.push_back(static_cast<float>(one->width));
    }
    width.push_back(widths.size() >= kMinColumnStrands ? quantile(widths, 0.5) : -1);
    curl.push_back(enough ? summary(of).curl_radius : -1);
    frizz.push_back(own.size() >= kMinColumnStrands ? quantile(own, 0.5) / kFrizzSpread : -1);
  }
  std::vector<float> ratios;
  for (const ClumpPair& pair : clumps.pairs) ratios.push_back(pair.ratio);
  const double usual_closing = closingOf(ratios);
  for (const auto& of : byColumn(clumps.pairs, shape, [](const ClumpPair& one) { return one.face; })) {
    ratios.clear();
    for (const ClumpPair& pair : of) ratios.push_back(pair.ratio);
    clump.push_back(ratios.size() >= kMinColumnPairs ? closingOf(ratios) : -1);
  }
  look.columns.assign(around.size(), {});
  bool any = false;
  const auto take = [&](std::vector<double>& values, double least, double& of_all, double ColumnShare::*share,
                        double low = 0.6) {
    double most = 0;
    if (!fillGaps(shape, values) || !differ(values, least, most, low)) return false;
    of_all = most;
    for (std::size_t c = 0; c < values.size(); ++c) look.columns[c].*share = shareOf(values[c], most);
    return any = true;
  };
  if (take(curl, kSmallestCurl, look.all.curl_radius, &ColumnShare::curl)) {
    std::vector<const StrandMeasure*> curled;
    for (std::size_t c = 0; c < around.size(); ++c)
      if (look.columns[c].curl > 0.5) curled.insert(curled.end(), around[c].begin(), around[c].end());
    const StrandCharacter there = summary(curled);
    look.all.curl_turns = there.curl_turns, look.all.curl_pitch = there.curl_pitch;
  }
  take(frizz, kOtherFrizz, look.all.frizz, &ColumnShare::frizz);
  double closing = 0;
  if (take(clump, kOtherClump, closing, &ColumnShare::clump, kLowClump) && usual_closing > 0)
    look.all.clump = std::min(1.0, clumps.clump * closing / usual_closing);
  double usual = 0;
  take(width, 0, usual, &ColumnShare::width);
  for (ColumnShare& column : look.columns) column.width = std::max(column.width, kMinWidthShare);
  if (!any) look.columns.clear();
}

void measureWidths(const Groom& groom, double scale, LookFit& look) {
  if (groom.widths.size() != groom.points.size() || groom.widths.empty()) return;
  std::vector<float> root, ratio;
  for (std::size_t s = 0; s < groom.strandCount(); ++s) {
    if (groom.pointCount(s) < 2) continue;
    const float first = groom.widths[groom.strand_first[s]], last = groom.widths[groom.strand_first[s + 1] - 1];
    if (!(first > 0) || !(last >= 0)) continue;
    root.push_back(first);
    ratio.push_back(last / first);
  }
  if (root.empty()) return;
  look.taper = std::clamp(quantile(ratio, 0.5), 0.0, 1.0);
  look.radius = 0.5 * scale * quantile(root, 0.5);
}

std::vector<StrandMeasure> measureStrands(const Groom& groom, double scale, const StrandSamples& strands,
                                          const HairFit& fit, const GrowthMap& growth) {
  const std::size_t step = std::max<std::size_t>(1, strands.strandCount() / kMaxLooked);
  std::vector<StrandMeasure> measures;
  std::vector<Vector3f> given, strand(kFitPoints), grown(kFitPoints);
  std::map<std::array<int, 3>, std::deque<std::vector<Vector3f>>> missed;  // by where it roots: given less grown
  for (std::size_t s = 0; s < strands.strandCount(); s += step) {
    given.clear();
    for (const Vector3f& p : groom.strand(static_cast<std::size_t>(strands.source[s])))
      given.push_back(static_cast<float>(scale) * p);
    growStrand(fit, growth, fit.strands[s], grown);
    besideGrown(given, grown, strand);
    StrandMeasure& measure = measures.emplace_back();
    measure.face = fit.strands[s].root.face;
    measure.length_share =
        std::min(1.0, static_cast<double>(fit.strands[s].end) / static_cast<double>(fit.knots.size() - 1));
    measure.along = lineLength(grown);
    if (groom.widths.size() == groom.points.size())
      measure.width = groom.widths[groom.strand_first[static_cast<std::size_t>(strands.source[s])]];
    measureTurns(wander(strand, grown), measure);
    double least_quick = -1;
    // What the hair mesh misses of a whole wisp is no wander of its strands.
    auto& missed_near = missed[cellOf(strand[0], kNearFit)];
    for (const std::vector<Vector3f>& near : missed_near) {
      std::vector<Vector3f> own = strand;
      for (std::size_t k = 0; k < own.size(); ++k) own[k] -= near[k];
      const auto [slow, quick] = slowAndQuick(wander(own, grown));
      const double wander_here = slow / std::numbers::sqrt2;
      measure.wander = measure.wander < 0 ? wander_here : std::min(measure.wander, wander_here);
      const double quick_here = quick / std::numbers::sqrt2;
      least_quick = least_quick < 0 ? quick_here : std::min(least_quick, quick_here);
    }
    if (least_quick >= 0) measure.own_frizz = least_quick > kOwn * measure.frizz ? measure.frizz : 0;
    std::vector<Vector3f>& fresh = missed_near.emplace_back(strand);
    for (std::size_t k = 0; k < fresh.size(); ++k) fresh[k] -= grown[k];
    if (missed_near.size() > kMaxShared) missed_near.pop_front();
  }
  return measures;
}

}  // namespace

LookFit fitLook(const Groom& groom, double scale, const StrandSamples& strands, const HairFit& fit) {
  const GrowthMap growth(fit.shape);
  const std::vector<StrandMeasure> measures = measureStrands(groom, scale, strands, fit, growth);
  const ClumpFit clumps = fitClumps(strands, fit, growth);
  LookFit look;
  std::vector<const StrandMeasure*> all;
  for (const StrandMeasure& measure : measures) all.push_back(&measure);
  look.all = summary(all);
  look.all.clump = clumps.clump;
  look.all.clump_size = clumps.size;
  look.all.lock = clumps.lock;
  fitPlaces(measures, clumps, fit.shape, look);
  measureWidths(groom, scale, look);
  return look;
}

void takeLook(const LookFit& fit, render::HairLook& look) {
  look.length_variation = static_cast<float>(fit.all.length_variation);
  look.curl_radius = static_cast<float>(fit.all.curl_radius);
  if (fit.all.curl_radius > 0) look.curl_pitch = static_cast<float>(fit.all.curl_pitch);
  look.frizz = static_cast<float>(std::min(fit.all.frizz, 0.01));
  look.offset = static_cast<float>(std::min(fit.all.offset, 0.02));
  look.clump = static_cast<float>(fit.all.clump);
  look.lock = static_cast<float>(fit.all.lock);
  if (fit.all.clump + fit.all.lock > 0) look.clump_size = static_cast<float>(fit.all.clump_size);
  // What the groom has in its strands' places is not added once more.
  look.wisp = look.drift = look.root_spread = look.hairline = look.baby_hairs = look.flyaways = 0;
  if (fit.taper >= 0) look.taper = static_cast<float>(fit.taper);
}

namespace {

constexpr std::array kTaken{&render::HairLook::length_variation,
                            &render::HairLook::offset,
                            &render::HairLook::clump,
                            &render::HairLook::clump_size,
                            &render::HairLook::curl_radius,
                            &render::HairLook::curl_pitch,
                            &render::HairLook::frizz,
                            &render::HairLook::taper,
                            &render::HairLook::lock,
                            &render::HairLook::wisp,
                            &render::HairLook::drift,
                            &render::HairLook::root_spread,
                            &render::HairLook::hairline,
                            &render::HairLook::baby_hairs,
                            &render::HairLook::flyaways};

}  // namespace

void takeUnset(const LookFit& fit, const render::HairLook& before, render::HairLook& look) {
  const render::HairLook usual;
  render::HairLook fitted;
  takeLook(fit, fitted);
  for (const auto row : kTaken) {
    if (look.*row == usual.*row || look.*row == before.*row) look.*row = fitted.*row;
  }
}

void dropLook(const render::HairLook& before, render::HairLook& look) {
  for (const auto row : kTaken) look.*row = before.*row;
}

}  // namespace app

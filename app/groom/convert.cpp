#include "app/groom/convert.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "app/files/errors.h"
#include "app/files/report_line.h"
#include "app/groom/fit/grown_groom.h"

namespace app {
namespace {

using Eigen::Vector3f;

constexpr int kSamples = 25;                          // points a strand
constexpr std::size_t kSilhouetteStrands = 10000;     // that silhouettes are drawn of
constexpr double kMisfit = 0.03, kAimedMean = 0.01;   // of the hair's length
constexpr double kMaxMisfits = 0.5, kFarMean = 0.05;  // of the strands, and in the mean of their length: no conversion
constexpr float kTogether = 0.012f;                   // m, between roots of strands that are told of as one
constexpr std::size_t kMaxMisfitLines = 6;            // groups that are told of
constexpr std::size_t kMaxRuns = 4;                   // of a group's numbers that are told
constexpr std::size_t kMaxMeasured = 200000;          // strands
constexpr double kCrossing = 0.35;                    // rad-like, of strands that root together

Groom reversed(Groom groom) {
  for (std::size_t s = 0; s < groom.strandCount(); ++s) {
    const auto first = static_cast<std::ptrdiff_t>(groom.strand_first[s]),
               last = static_cast<std::ptrdiff_t>(groom.strand_first[s + 1]);
    std::reverse(groom.points.begin() + first, groom.points.begin() + last);
    if (!groom.widths.empty()) std::reverse(groom.widths.begin() + first, groom.widths.begin() + last);
    if (!groom.colors.empty()) std::reverse(groom.colors.begin() + first, groom.colors.begin() + last);
  }
  return groom;
}

using GridCell = std::array<int, 3>;

GridCell cellOf(const Vector3f& root) {
  return {static_cast<int>(std::floor(root.x() / kTogether)), static_cast<int>(std::floor(root.y() / kTogether)),
          static_cast<int>(std::floor(root.z() / kTogether))};
}

// Cells of misfits that touch each other, gathered from one of them.
std::vector<std::size_t> gather(const GridCell& start, std::map<GridCell, std::vector<std::size_t>>& cells) {
  std::vector<std::size_t> strands;
  std::vector<GridCell> queue{start};
  while (!queue.empty()) {
    const GridCell cell = queue.back();
    queue.pop_back();
    const auto entry = cells.find(cell);
    if (entry == cells.end()) continue;
    strands.insert(strands.end(), entry->second.begin(), entry->second.end());
    cells.erase(entry);
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz) queue.push_back({cell[0] + dx, cell[1] + dy, cell[2] + dz});
  }
  return strands;
}

// Whether strands whose roots share a cell go apart, on the mean over pairs that follow each other.
bool goApart(const StrandSamples& samples, const std::vector<std::size_t>& of) {
  std::map<GridCell, std::size_t> seen;
  double sum = 0, count = 0;
  for (const std::size_t s : of) {
    const auto [entry, added] = seen.try_emplace(cellOf(samples.strand(s)[0]), s);
    if (added) continue;
    const auto path = [&](std::size_t strand) {
      return std::vector<Vector3f>(samples.strand(strand).begin(), samples.strand(strand).end());
    };
    sum += divergence(path(s), path(entry->second));
    ++count;
    entry->second = s;
  }
  return count > 0 && sum / count > kCrossing;
}

bool doesNotFit(const FitError& error, std::size_t s) {
  return error.of_strand[s] > kMisfit * error.strand_length;
}

std::vector<Misfit> findMisfits(const StrandSamples& samples, const HairFit& fit) {
  std::map<GridCell, std::vector<std::size_t>> cells;
  for (std::size_t s = 0; s < samples.strandCount(); ++s) {
    if (doesNotFit(fit.error, s)) cells[cellOf(samples.strand(s)[0])].push_back(s);
  }
  std::vector<Misfit> all;
  while (!cells.empty()) {
    const std::vector<std::size_t> strands = gather(cells.begin()->first, cells);
    Misfit& misfit = all.emplace_back();
    misfit.strands = static_cast<int>(strands.size());
    for (const std::size_t s : strands) {
      misfit.numbers.push_back(samples.source[s]);
      misfit.root += samples.strand(s)[0] / static_cast<float>(strands.size());
      misfit.mean += fit.error.of_strand[s] / static_cast<double>(strands.size());
      misfit.largest = std::max(misfit.largest, static_cast<double>(fit.error.of_strand[s]));
    }
    std::ranges::sort(misfit.numbers);
    misfit.crossing = goApart(samples, strands);
  }
  std::sort(all.begin(), all.end(),
            [](const Misfit& a, const Misfit& b) { return a.strands * a.mean > b.strands * b.mean; });
  return all;
}

// Ascending numbers, which follow each other at `step`, as runs: "3-17, 20, 25-30 and 12 more".
std::string runsOf(const std::vector<int>& numbers, int step) {
  std::string text;
  std::size_t at = 0;
  for (std::size_t run = 0; run < kMaxRuns && at < numbers.size(); ++run) {
    std::size_t end = at;
    while (end + 1 < numbers.size() && numbers[end + 1] <= numbers[end] + step) ++end;
    text += (run > 0 ? ", " : "") + std::to_string(numbers[at]);
    if (end > at) text += "-" + std::to_string(numbers[end]);
    at = end + 1;
  }
  if (at < numbers.size()) text += " and " + std::to_string(numbers.size() - at) + " more";
  return text;
}

std::string misfitLine(const Misfit& misfit, const Conversion& conversion) {
  const FitError& error = conversion.fit.error;
  return reportLine(
      "does not fit  %d strand%s, number%s %s, rooted about (%.3f, %.3f, %.3f) m: %.0f mm off, up to %.0f mm "
      "(%.0f %% of the length)%s",
      misfit.strands, misfit.strands == 1 ? "" : "s", misfit.strands == 1 ? "" : "s",
      runsOf(misfit.numbers, conversion.step).c_str(), misfit.root.x(), misfit.root.y(), misfit.root.z(),
      1e3 * misfit.mean, 1e3 * misfit.largest, 100 * misfit.largest / error.strand_length,
      misfit.crossing ? "; strands of the same roots go other ways" : "");
}

// The strands that grow from the roots of every nth given one.
Groom grownAtRoots(const StrandSamples& samples, const HairFit& fit, std::size_t step) {
  const GrowthMap growth(fit.shape);
  Groom grown;
  std::vector<Vector3f> even(2 * kSamples);
  for (std::size_t s = 0; s < samples.strandCount(); s += step) {
    growStrand(fit, growth, fit.strands[s], even);
    grown.points.insert(grown.points.end(), even.begin(), even.end());
    grown.strand_first.push_back(static_cast<std::uint32_t>(grown.points.size()));
  }
  return grown;
}

void compareSilhouettes(const Groom& groom, const StrandSamples& samples, Conversion& out) {
  Groom given;  // of the samples' strands, as many as are compared
  const std::size_t step =
      std::max<std::size_t>(1, (samples.strandCount() + kSilhouetteStrands - 1) / kSilhouetteStrands);
  for (std::size_t s = 0; s < samples.strandCount(); s += step) {
    for (const Vector3f& p : groom.strand(static_cast<std::size_t>(samples.source[s])))
      given.points.push_back(static_cast<float>(out.scale) * p);
    given.strand_first.push_back(static_cast<std::uint32_t>(given.points.size()));
  }
  out.silhouette = silhouetteOverlap(given, grownAtRoots(samples, out.fit, step));
  render::HairLook look;
  takeLook(out.look, look);
  out.silhouette_drawn = silhouetteOverlap(
      given, growGroom(out.shape, look, static_cast<int>(given.strandCount()), 2 * kSamples, out.look.columns));
}

// The part of the hair's roots, by columns, that have less than half of it; empty where all places are alike.
std::string lessElsewhere(const LookFit& look, double ColumnShare::*share) {
  std::ptrdiff_t less = 0, other = 0;
  for (const ColumnShare& column : look.columns) less += column.*share < 0.5, other += column.*share < 1;
  if (other == 0) return "";
  const double part = 100.0 * static_cast<double>(less) / static_cast<double>(look.columns.size());
  char text[80];
  std::snprintf(text, sizeof text, " (less than half of it over %.0f %% of the scalp)", part);
  return text;
}

std::string characterLine(const LookFit& look) {
  const StrandCharacter& all = look.all;
  std::string text = "strands       ";
  char part[320];
  if (all.curl_radius > 0) {
    std::snprintf(part, sizeof part, "curls of %.1f mm%s, %.1f turns; ", 1e3 * all.curl_radius,
                  lessElsewhere(look, &ColumnShare::curl).c_str(), all.curl_turns);
    text += part;
  }
  std::snprintf(
      part, sizeof part, "end up to %.0f %% early, wander %.1f mm, frizz %.1f mm%s, clumps closed by %.0f %%%s",
      100 * all.length_variation, 1e3 * all.offset, 1e3 * all.frizz, lessElsewhere(look, &ColumnShare::frizz).c_str(),
      100 * all.clump, lessElsewhere(look, &ColumnShare::clump).c_str());
  text += part;
  if (all.clump + all.lock > 0) {
    std::snprintf(part, sizeof part, ", %.0f mm apart, locks by %.0f %%", 1e3 * all.clump_size, 100 * all.lock);
    text += part;
  }
  if (look.taper >= 0) {
    std::snprintf(part, sizeof part, ", %.3g mm wide at the roots (the look's strand_radius stays), tips %.2f of it",
                  2e3 * look.radius, look.taper);
    text += part;
  }
  if (const std::string thinner = lessElsewhere(look, &ColumnShare::width); !thinner.empty())
    text += ", of different widths" + thinner;
  return text + "\n";
}

}  // namespace

Conversion convertGroom(const Groom& given, const GroomHints& hints, const ConvertOptions& options,
                        const std::string& file) {
  Groom turned;
  if (options.reverse) turned = reversed(given);
  const Groom& groom = options.reverse ? turned : given;
  Conversion out;
  out.scale = inferUnit(groom, out.unit);
  const double said = options.unit > 0 ? options.unit : hints.meters_per_unit.value_or(0);
  if (said > 0 && std::isfinite(said)) {
    out.scale = said;
    char text[60];
    std::snprintf(text, sizeof text, "units of %g m", options.file_unit > 0 ? options.file_unit : said);
    out.unit = text;
  }
  const std::size_t step = 1 + (std::max<std::size_t>(groom.strandCount(), 1) - 1) / kMaxMeasured;
  const StrandSamples samples = sampleStrands(groom, out.scale, kSamples, step);
  out.left_out = samples.left_out;
  out.strands = static_cast<int>(groom.strandCount()) - out.left_out;
  out.measured = static_cast<int>(samples.strandCount());
  out.step = static_cast<int>(step);
  try {
    out.fit = fitGroom(samples, options.fit);
    out.shape = out.fit.shape;
    sim::buildHairMesh(out.shape);
  } catch (const std::runtime_error& fault) {
    throw InputError(file, "", std::string("no hair mesh can be made of it: ") + fault.what(),
                     "give strands that root on an area of scalp, root first");
  }
  out.look = fitLook(groom, out.scale, samples, out.fit);
  out.misfits = findMisfits(samples, out.fit);
  for (std::size_t s = 0; s < samples.strandCount(); ++s)
    if (doesNotFit(out.fit.error, s)) out.astray.push_back({samples.source[s], out.fit.error.of_strand[s]});
  if (options.silhouettes) compareSilhouettes(groom, samples, out);
  return out;
}

std::string misfitList(const Conversion& conversion) {
  std::string text;
  for (const StrayStrand& strand : conversion.astray) text += reportLine("%d %.1f", strand.number, 1e3 * strand.off);
  return text;
}

int misfitCount(const Conversion& conversion) {
  int count = 0;
  for (const Misfit& misfit : conversion.misfits) count += misfit.strands;
  return count;
}

std::string conversionWarning(const Conversion& conversion) {
  const int off = misfitCount(conversion);
  const FitError& error = conversion.fit.error;
  if (off <= kMaxMisfits * conversion.measured || error.mean <= kFarMean * error.strand_length) return "";
  return "most of the groom is lost: " + std::to_string(off) + " of " + std::to_string(conversion.measured) +
         " strands do not fit the hair mesh, all are " +
         std::to_string(std::lround(100 * error.mean / error.strand_length)) + " % of their length off in the mean";
}

std::string conversionReport(const Conversion& conversion) {
  const HairFit& fit = conversion.fit;
  const FitError& error = fit.error;
  const std::string warning = conversionWarning(conversion);
  std::string text = warning.empty() ? "" : "warning       " + warning + "\n";
  text += reportLine("read          %d strands in %s, median length %.3f m", conversion.strands,
                     conversion.unit.c_str(), error.strand_length);
  if (conversion.left_out > 0)
    text += reportLine("left out      %d strands: fewer than two points, not finite or shorter than 1 mm",
                       conversion.left_out);
  if (conversion.step > 1)
    text += reportLine("measured      on %d of them, each %dth: the hair mesh, distances and what does not fit",
                       conversion.measured, conversion.step);
  text += reportLine("hair mesh     %d vertices in %d columns of %zu layers; %zu root faces in %d region%s",
                     fit.shape.vertexCount(), fit.shape.columnCount(), fit.knots.size(), fit.shape.root_faces.size(),
                     fit.regions, fit.regions == 1 ? "" : "s");
  if (fit.dropped_faces > 0)
    text += reportLine("left bare     %d root faces: strands over them go through each other", fit.dropped_faces);
  text += reportLine(
      "distance      mean %.2f %% of the length (%.1f mm), 95 %% within %.2f %% (%.1f mm), largest %.0f mm; roots %.1f "
      "mm",
      100 * error.mean / error.strand_length, 1e3 * error.mean, 100 * error.share95 / error.strand_length,
      1e3 * error.share95, 1e3 * error.largest, 1e3 * error.root_mean);
  const bool mean_met = error.mean <= kAimedMean * error.strand_length,
             share_met = error.share95 <= kMisfit * error.strand_length;
  text += reportLine("aims          mean within 1 %%: %s; 95 %% within 3 %%: %s", mean_met ? "met" : "not met",
                     share_met ? "met" : "not met");
  if (conversion.silhouette >= 0)
    text += reportLine("silhouette    overlaps by at least %.3f from six sides, by %.3f with strands dealt out anew",
                       conversion.silhouette, conversion.silhouette_drawn);
  text += characterLine(conversion.look);
  for (std::size_t k = 0; k < std::min(kMaxMisfitLines, conversion.misfits.size()); ++k)
    text += misfitLine(conversion.misfits[k], conversion);
  if (conversion.misfits.size() > kMaxMisfitLines) {
    int rest = 0;
    for (std::size_t k = kMaxMisfitLines; k < conversion.misfits.size(); ++k) rest += conversion.misfits[k].strands;
    text += reportLine("              and %d strands in %zu smaller groups", rest,
                       conversion.misfits.size() - kMaxMisfitLines);
  }
  return text;
}

std::string conversionNote(const Conversion& conversion) {
  const FitError& error = conversion.fit.error;
  const int astray = misfitCount(conversion);
  char text[300];
  std::snprintf(text, sizeof text,
                "%d strands in %s made into a hair mesh of %d vertices: mean distance %.1f %% of their length, 95 %% "
                "within %.1f %%",
                conversion.strands, conversion.unit.c_str(), conversion.shape.vertexCount(),
                100 * error.mean / error.strand_length, 100 * error.share95 / error.strand_length);
  std::string note = text;
  if (astray > 0) note += "; " + countOf(astray, "strand") + " of them do not fit (hairmesh-convert says which)";
  const int bare = conversion.fit.dropped_faces, faces = static_cast<int>(conversion.shape.root_faces.size());
  if (bare > 0)
    note += "; " + std::to_string(100 * bare / (bare + faces)) +
            " % of the scalp under them is left bare, for strands over it go through each other";
  return note;
}

}  // namespace app

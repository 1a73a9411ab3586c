#include "tests/bench/conversion.h"

#include <array>
#include <cstdio>
#include <ctime>

#include "app/groom/convert.h"
#include "app/groom/fit/grown_groom.h"
#include "app/groom/fit/strand_samples.h"
#include "tests/bench/measured_part.h"
#include "tests/groom_kinds.h"

namespace bench {
namespace {

constexpr int kAnewPoints = 129;  // of a strand dealt out anew: the curls' own

double processorSeconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

// Median over the strands of a groom.
struct Lengths {
  double ends = 0, way = 0;  // m, from root to tip, straight and along the strand
};

Lengths lengthsOf(const app::Groom& groom) {
  std::vector<float> ends, ways;
  for (std::size_t s = 0; s < groom.strandCount(); ++s) {
    ends.push_back((groom.strand(s).back() - groom.strand(s).front()).norm());
    ways.push_back(static_cast<float>(app::lineLength(groom.strand(s))));
  }
  return {app::quantile(ends, 0.5), app::quantile(ways, 0.5)};
}

// How far two halves of a groom overlap that were dealt out apart: what a silhouette of so many strands can reach.
double halvesOverlap(const groom_kinds::Kind& kind, int strands) {
  const app::Groom both = kind.make(2 * strands);
  std::array<app::Groom, 2> halves;
  for (std::size_t s = 0; s < both.strandCount(); ++s) {
    app::Groom& half = halves[s % 2];
    half.points.insert(half.points.end(), both.strand(s).begin(), both.strand(s).end());
    half.strand_first.push_back(static_cast<std::uint32_t>(half.points.size()));
  }
  return app::silhouetteOverlap(halves[0], halves[1]);
}

// m, mean, from the hair mesh to where strands grow.
double offsetOf(const sim::HairMeshShape& shape) {
  double sum = 0;
  for (const sim::Vec3& offset : shape.groom_offsets) sum += offset.norm();
  return sum / static_cast<double>(shape.positions.size());
}

std::string row(const groom_kinds::Kind& kind, const ConversionOptions& asked) {
  app::ConvertOptions options;
  options.fit.vertices = asked.vertices;
  options.silhouettes = true;
  const app::Groom groom = kind.make(asked.strands);
  const double before = processorSeconds();
  const app::Conversion conversion = app::convertGroom(groom, {}, options, kind.name);
  const double seconds = processorSeconds() - before;
  const app::FitError& error = conversion.fit.error;
  const int bare = conversion.fit.dropped_faces;
  const std::string left =
      bare > 0 ? formatted("%d of %zu", bare, conversion.shape.root_faces.size() + static_cast<std::size_t>(bare))
               : "0";
  render::HairLook look;
  app::takeLook(conversion.look, look);
  const Lengths given = lengthsOf(groom);
  const Lengths anew = lengthsOf(app::growGroom(conversion.shape, look, asked.strands, kAnewPoints));
  return formatted("| %s | %s | %d | %d x %zu | %.2f | %.2f | %.1f | %.2f | %.2f | %.2f | %.2f | %.2f | %s | %.1f |\n",
                   kind.name.c_str(), kind.what.c_str(), conversion.shape.vertexCount(), conversion.shape.columnCount(),
                   conversion.fit.knots.size(), 100 * error.mean / error.strand_length,
                   100 * error.share95 / error.strand_length, 1e3 * offsetOf(conversion.shape), conversion.silhouette,
                   conversion.silhouette_drawn, halvesOverlap(kind, asked.strands), anew.ends / given.ends,
                   anew.way / given.way, left.c_str(), seconds);
}

}  // namespace

void runConversion(const ConversionOptions& options) {
  std::string table =
      "| groom | what | vertices | columns x layers | mean, % of length | 95 % within | mesh off, mm | silhouette | "
      "dealt out anew | two halves | "
      "root to tip | along | faces left bare | "
      "processor s |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  std::fputs(table.c_str(), stdout);
  for (const groom_kinds::Kind& kind : groom_kinds::kinds()) {
    const std::string one = row(kind, options);
    std::fputs(one.c_str(), stdout);
    std::fflush(stdout);
    table += one;
  }
  if (!options.folder.empty()) writeMeasuredPart(options.folder + "/conversion.md", "kinds", table + "\n");
}

}  // namespace bench

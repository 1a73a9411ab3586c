#include "tests/bench/conversion.h"

#include <cstdio>
#include <ctime>

#include "app/groom/convert.h"
#include "tests/bench/measured_part.h"
#include "tests/groom_kinds.h"

namespace bench {
namespace {

double processorSeconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
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
  return formatted("| %s | %s | %d | %d x %zu | %.2f | %.2f | %.2f | %.2f | %s | %.1f |\n", kind.name.c_str(),
                   kind.what.c_str(), conversion.shape.vertexCount(), conversion.shape.columnCount(),
                   conversion.fit.knots.size(), 100 * error.mean / error.strand_length,
                   100 * error.share95 / error.strand_length, conversion.silhouette,
                   conversion.silhouette_drawn, left.c_str(), seconds);
}

}  // namespace

void runConversion(const ConversionOptions& options) {
  std::string table =
      "| groom | what | vertices | columns x layers | mean, % of length | 95 % within | silhouette | dealt out anew | faces left bare | "
      "processor s |\n|---|---|---|---|---|---|---|---|---|---|\n";
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

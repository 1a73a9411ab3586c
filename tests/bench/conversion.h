// Grooms of ten kinds to hair meshes: errors, silhouettes, time.
#pragma once

#include <string>

namespace bench {

struct ConversionOptions {
  int strands = 10000, vertices = 0;  // a groom; 0 vertices: as many as its bounds ask for
  std::string folder;                   // whose conversion.md gets the table; empty: it is printed alone
};

// Throws app::InputError.
void runConversion(const ConversionOptions& options);

}  // namespace bench

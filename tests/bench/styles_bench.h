// Milliseconds a frame for the nine styles during a walk with contacts, as the paper's figure 6 and section 4 give
// them.
#pragma once

#include <string>

namespace bench {

struct StylesOptions {
  int frames = 360;  // measured, after the hair has come into the walk
  std::string motion = "walk.bvh";
  std::string table;  // Markdown file; empty: none
};

// Prints one row a style: vertices, median milliseconds a 1/60 s frame in all and per stage, solver iterations,
// contacts, and the exponent of the growth of time with the vertex count. Throws app::InputError.
void runStyles(const StylesOptions& options);

}  // namespace bench

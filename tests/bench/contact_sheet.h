// Contact sheets: three styles from front, side, back and above at rest, and in three moments of motion; the hairdos.
#pragma once

#include <string>

namespace bench {

struct SheetOptions {
  std::string folder;     // empty: none
  int cell_height = 360;  // pixels; cells are 4 wide to 5 high
  int strands = 30000;
  std::string motion = "dance.bvh";
};

// Writes styles_short.png, styles_shoulder.png and styles_long.png, a row a resolution, a column a view or moment, and
// hairdos.png, a column a shipped scene of a hairdo, from before and from behind, and buns.png, three kinds of them.
// Drawn at twice the size and averaged down. Throws app::ContextError or app::InputError.
void drawContactSheets(const SheetOptions& options);

}  // namespace bench

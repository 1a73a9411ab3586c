// What a file tells about its strands beside them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace app {

struct GroomHints {
  std::optional<double> meters_per_unit;
  std::optional<char> up;  // 'Y' or 'Z'
  int world_heads = 0;     // of an export of this program: y up, each head where its figure holds it; 0: no such file
};

// What an export says of itself wherever its format has room for text: "hairmesh world of 1 heads, y up, unit 0.01 m".
std::string worldMark(int heads, double meters_per_unit);
// Takes it from the beginning or the end of a file's bytes.
void readWorldMark(std::string_view bytes, GroomHints& hints);

}  // namespace app

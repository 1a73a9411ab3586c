#include "app/groom/groom_hints.h"

#include <algorithm>

#include "sim/field_text.h"

namespace app {

namespace {

constexpr std::string_view kWorldMark = "hairmesh world of ", kAxes = " heads, y up, unit ";
constexpr std::size_t kMarkWithin = 4096;  // bytes of the file's beginning or end

}  // namespace

std::string worldMark(int heads, double meters_per_unit) {
  return std::string(kWorldMark).append(std::to_string(heads)).append(kAxes) + sim::numberText(meters_per_unit) + " m";
}

void readWorldMark(std::string_view bytes, GroomHints& hints) {
  for (const std::string_view part :
       {bytes.substr(0, kMarkWithin), bytes.substr(bytes.size() - std::min(bytes.size(), kMarkWithin))}) {
    const std::size_t at = part.find(kWorldMark);
    if (at == std::string_view::npos) continue;
    const std::string_view rest = part.substr(at + kWorldMark.size());
    const std::size_t axes = rest.find(kAxes);
    if (axes == std::string_view::npos) continue;
    const std::string_view last = rest.substr(axes + kAxes.size());
    double unit = 0, heads = 0;
    if (!sim::parseNumber(rest.substr(0, axes), heads) || !(heads >= 1 && heads <= 1e6)) continue;
    if (!sim::parseNumber(last.substr(0, last.find(' ')), unit) || !(unit > 0)) continue;
    hints.world_heads = static_cast<int>(heads);
    hints.meters_per_unit = unit;
    hints.up = 'Y';
    return;
  }
}

}  // namespace app

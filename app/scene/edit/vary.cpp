#include "app/scene/edit/vary.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string_view>

namespace app {

void varyMaterial(double amount, std::uint64_t seed, sim::SimParams& params) {
  std::mt19937_64 draw(seed);
  for (const sim::ParamField& row : sim::paramFields()) {
    if (std::string_view(row.group) != "Material" || row.kind != sim::FieldKind::kReal) continue;
    // The library's distributions differ between libraries.
    const double share = amount * (static_cast<double>(draw() >> 11) * 0x1p-52 - 1);
    const double value = row.get(params);
    const double moved =
        row.logarithmic ? value * std::pow(10.0, share) : value + share * 0.5 * (row.maximum - row.minimum);
    row.set(params, std::clamp(moved, row.minimum, row.maximum));
  }
}

}  // namespace app

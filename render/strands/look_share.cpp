#include "render/strands/look_share.h"

#include <algorithm>

namespace render {
namespace {

// to + by from.
LookShare added(const LookShare& to, float by, const LookShare& from) {
  LookShare share = to;
  share.width += by * from.width;
  share.clump += by * from.clump;
  share.curl += by * from.curl;
  share.roughness += by * from.roughness;
  share.frizz += by * from.frizz;
  for (std::size_t c = 0; c < 3; ++c) share.color[c] += by * from.color[c];
  return share;
}

constexpr LookShare kNone{0, 0, 0, 0, {0, 0, 0}, 0};

}  // namespace

LookShare shareOfRoot(const HairLayout& layout, const std::array<int, 4>& columns, const std::array<float, 4>& blend) {
  if (layout.root_shares.empty()) return {};
  LookShare share = kNone;
  for (std::size_t k = 0; k < 4 && columns[k] >= 0; ++k)
    share = added(share, blend[k], layout.root_shares[static_cast<std::size_t>(columns[k])]);
  return share;
}

LookShare shareAlong(const HairLayout& layout, float along, LookShare* rate) {
  if (layout.root_shares.empty()) return {};
  const int last = static_cast<int>(layout.along_shares.size()) - 1;
  const float at = std::clamp(along, 0.0f, 1.0f) * static_cast<float>(last);
  const int first = std::min(static_cast<int>(at), last - 1);
  const LookShare& from = layout.along_shares[static_cast<std::size_t>(first)];
  const LookShare step = added(layout.along_shares[static_cast<std::size_t>(first) + 1], -1, from);
  if (rate) *rate = added(kNone, static_cast<float>(last), step);
  return added(from, at - static_cast<float>(first), step);
}

}  // namespace render

#include "app/motion/playback.h"

#include <array>

namespace app {
namespace {

struct LoopRow {
  LoopKind kind;
  std::string_view name;
};
constexpr std::array<LoopRow, 5> kLoopNames{{{LoopKind::kAuto, "auto"},
                                             {LoopKind::kGoOn, "go-on"},
                                             {LoopKind::kInPlace, "in-place"},
                                             {LoopKind::kStop, "stop"},
                                             {LoopKind::kNone, "none"}}};

}  // namespace

std::string_view loopName(LoopKind kind) {
  for (const LoopRow& row : kLoopNames) {
    if (row.kind == kind) return row.name;
  }
  return {};
}

std::optional<LoopKind> parseLoop(std::string_view name) {
  for (const LoopRow& row : kLoopNames) {
    if (row.name == name) return row.kind;
  }
  return {};
}

}  // namespace app

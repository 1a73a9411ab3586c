// The hair's ties: sets of them by name, and the list of which one is picked, changed and taken away.
#include <imgui/imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/scene/edit/tie_list.h"
#include "app/ui/ui_panels.h"
#include "app/ui/ui_widgets.h"

namespace app {

namespace {

constexpr std::array kSetNames{"none", "high", "back", "low", "two"};
constexpr std::array kPlaceNames{"high", "back", "low", "left", "right"};
constexpr std::array kSideNames{"all", "left", "right"};

void postTies(const std::vector<TieSpec>& ties, Demo& demo) {
  postRequest(demo, {Ask::kTie, "", writeTies(ties).dump()});
}

// The ties that the rows speak of: the picked one, or all.
std::vector<std::size_t> meant(const std::vector<TieSpec>& ties, const UiState& ui) {
  std::vector<std::size_t> numbers;
  for (std::size_t k = 0; k < ties.size(); ++k) {
    if (ui.brush.tie_picked < 0 || static_cast<std::size_t>(ui.brush.tie_picked) == k) numbers.push_back(k);
  }
  return numbers;
}

void postChanged(const auto& change, Demo& demo, const UiState& ui) {
  std::vector<TieSpec> ties = selectedActor(demo).spec.ties;
  for (const std::size_t k : meant(ties, ui)) change(ties[k]);
  postTies(ties, demo);
}

// Hair that has no room for a plait or a bun hangs as a tail.
bool hangsBraided(const Actor& actor, const UiState& ui) {
  const std::vector<TieSpec>& ties = actor.spec.ties;
  return !actor.haircut->braids.empty() &&
         std::ranges::all_of(meant(ties, ui), [&](std::size_t k) { return ties[k].braided; });
}
bool hangsInBun(const Actor& actor, const UiState& ui) {
  const std::vector<TieSpec>& ties = actor.spec.ties;
  return !actor.haircut->wound.empty() &&
         std::ranges::all_of(meant(ties, ui), [&](std::size_t k) { return ties[k].bun; });
}

void setRow(const Actor& actor, Demo& demo, UiState& ui) {
  rowLabel("Tie", "A ring that gathers the hair to a tail and holds it to the head; two: left and right");
  const std::vector<TieSpec>& ties = actor.spec.ties;
  const auto isNamed = [](const TieSpec& tie, const char* name) { return tie.place == name && !tie.at; };
  const bool two = ties.size() == 2 && isNamed(ties[0], "left") && isNamed(ties[1], "right");
  int chosen = ties.empty() ? 0 : two ? 4 : -1;
  for (int k = 1; k < 4 && ties.size() == 1; ++k) chosen = isNamed(ties[0], kSetNames[k]) ? k : chosen;
  const int pressed = segments("tie", {"None", "High", "Back", "Low", "Two"}, chosen, ui);
  if (pressed < 0 || pressed == chosen) return;
  ui.brush.tie_picked = -1;
  const bool braided = hangsBraided(actor, ui), bun = hangsInBun(actor, ui);
  if (!braided && !bun) return postRequest(demo, {Ask::kTie, "", kSetNames[pressed]});
  std::vector<TieSpec> wanted = tiesFromText(kSetNames[pressed]);
  for (TieSpec& tie : wanted) tie.braided = braided, tie.bun = bun;
  postTies(wanted, demo);
}

std::string tieLine(const TieSpec& tie, std::size_t number) {
  const char* kind = tie.bun ? tie.braided ? "plaited bun" : "bun" : tie.braided ? "plait" : "tail";
  return std::to_string(number + 1) + "  " + placeText(tie) + ", " + kind + ", " +
         std::to_string(std::lround(1000 * tie.radius)) + " mm";
}

// One line a tie: a press picks it, another lets all be meant again.
void listRows(const std::vector<TieSpec>& ties, Demo& demo, UiState& ui) {
  const float button = 58 * ui.text_scale;
  for (std::size_t k = 0; k < ties.size(); ++k) {
    ImGui::PushID(static_cast<int>(k));
    const bool picked = ui.brush.tie_picked == static_cast<int>(k);
    const float width = ImGui::GetContentRegionAvail().x - button - 5;
    if (ImGui::Selectable(tieLine(ties[k], k).c_str(), picked, 0, {width, 0}))
      ui.brush.tie_picked = picked ? -1 : static_cast<int>(k);
    noteItem("tie " + std::to_string(k), ui);
    tip("The rows below change this tie alone; press again for all of them");
    ImGui::SameLine(0, 5);
    if (ImGui::SmallButton("Remove")) {
      std::vector<TieSpec> left = ties;
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(k));
      ui.brush.tie_picked = -1;
      postTies(left, demo);
    }
    noteItem("remove tie " + std::to_string(k), ui);
    ImGui::PopID();
  }
}

void handButton(const char* label, const char* name, bool moves, UiState& ui) {
  BrushState& brush = ui.brush;
  const bool in_hand = brush.tie && brush.tie_moves == moves;
  if (ImGui::Button(in_hand ? "Drag on the hair" : label, {-1, 0})) {
    brush.tie = !in_hand;
    brush.tie_moves = moves;
    if (brush.tie) brush.tool = brush.field = ui.select.element = -1;
  }
  noteItem(name, ui);
}

void ringRow(const std::vector<TieSpec>& ties, Demo& demo, UiState& ui) {
  BrushState& brush = ui.brush;
  rowLabel("Ring", "Radius of the tie's ring");
  const auto first = static_cast<std::size_t>(std::max(brush.tie_picked, 0));
  if (!ties.empty() && !brush.tie_held && !brush.tie) brush.tie_radius = ties[first].radius;
  auto shown = static_cast<float>(1000 * brush.tie_radius);
  ImGui::SetNextItemWidth(-1);
  {
    const MarksBelowDigits marks;
    if (ImGui::SliderFloat("##tie_radius", &shown, 1000 * kThinnestTie, 1000 * kWidestTie, "%.0f mm",
                           ImGuiSliderFlags_AlwaysClamp))
      brush.tie_radius = std::clamp(static_cast<double>(shown) / 1000, kThinnestTie, kWidestTie);
  }
  noteItem("tie_radius", ui);
  brush.tie_held = ImGui::IsItemActive();
  if (ImGui::IsItemDeactivatedAfterEdit() && !ties.empty() && !brush.tie)
    postChanged([&](TieSpec& tie) { tie.radius = brush.tie_radius; }, demo, ui);
}

// Of the picked tie: where it is, and which hair it takes.
void placeOfTieRows(const TieSpec& tie, Demo& demo, UiState& ui) {
  rowLabel("Place", "Where the picked ring is by name; Move puts it anywhere on the hair");
  const auto place = std::ranges::find(kPlaceNames, tie.place);
  const int now = tie.at ? -1 : static_cast<int>(place - kPlaceNames.begin());
  const int put = segments("tie_place", {"High", "Back", "Low", "Left", "Right"}, now, ui);
  if (put >= 0)
    postChanged([&](TieSpec& one) { one.place = kPlaceNames[static_cast<std::size_t>(put)], one.at.reset(); }, demo,
                ui);
  rowLabel("By hand", "Puts the picked ring where the button is let go on the hair");
  handButton("Move", "tie_move", true, ui);
  rowLabel("Takes", "Hair of the whole head, or of one side of it. A bundle goes to the first tie that takes it");
  const int side = tie.side == "left" ? 1 : tie.side == "right" ? 2 : tie.side.empty() && !tie.at ? -1 : 0;
  const int taken = segments("tie_side", {"All", "Left", "Right"}, side, ui);
  if (taken >= 0) postChanged([&](TieSpec& one) { one.side = kSideNames[static_cast<std::size_t>(taken)]; }, demo, ui);
}

}  // namespace

void tieRows(Demo& demo, UiState& ui) {
  const Actor& actor = selectedActor(demo);
  const std::vector<TieSpec>& ties = actor.spec.ties;
  BrushState& brush = ui.brush;
  if (brush.tie_picked >= static_cast<int>(ties.size())) brush.tie_picked = -1, brush.tie_moves = false;
  setRow(actor, demo, ui);
  listRows(ties, demo, ui);
  if (ties.size() < kMaxTies) {
    rowLabel("By hand",
             "Puts a ring more where the button is let go on the hair; with Mirror (Brushes) one on each side");
    handButton(ties.empty() ? "Put ring" : "Add ring", "tie_by_hand", false, ui);
  }
  ringRow(ties, demo, ui);
  if (ties.empty()) return;
  if (brush.tie_picked >= 0) placeOfTieRows(ties[static_cast<std::size_t>(brush.tie_picked)], demo, ui);
  bool braided = hangsBraided(actor, ui), bun = hangsInBun(actor, ui);
  const auto post = [&] { postChanged([&](TieSpec& tie) { tie.braided = braided, tie.bun = bun; }, demo, ui); };
  rowLabel("Braided", "What hangs from the tie is drawn as a plait of three strands, to a second tie before its end");
  if (ImGui::Checkbox("##braided", &braided)) post();
  noteItem("braided", ui);
  rowLabel("Bun", "What hangs from the tie is wound about it, as a rope or as a plait, and pinned to the head");
  if (ImGui::Checkbox("##bun", &bun)) post();
  noteItem("bun", ui);
}

}  // namespace app

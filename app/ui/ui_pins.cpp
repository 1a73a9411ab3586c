// Pins: what is chosen of the hair mesh is fastened where it is, to the head, a joint or the scene.
#include <imgui/imgui.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/scene/edit/hand_pins.h"
#include "app/scene/edit/mesh_change.h"
#include "app/ui/ui_panels.h"
#include "app/ui/ui_widgets.h"

namespace app {

namespace {

constexpr double kSoftestShown = 0.1, kStiffestShown = 1000;  // N/m
constexpr double kLatestShown = 3600;                         // s

void targetRow(const Actor& actor, UiState& ui) {
  PinState& pin = ui.pin;
  const std::vector<Joint>& joints = actor.body->character.skeleton.joints;
  const auto is = [&](const std::string& name) { return name == pin.to; };
  if (pin.to != "scalp" && pin.to != "scene" && std::ranges::none_of(joints, is, &Joint::name)) pin.to = "scalp";
  rowLabel("To", "What carries the pinned hair: the scalp, a joint of the figure, or nothing that moves (scene)");
  ImGui::SetNextItemWidth(-1);
  const bool open = ImGui::BeginCombo("##pin_to", pin.to.c_str());
  noteItem("pin_to", ui);
  if (!open) return;
  const auto entry = [&](const std::string& name) {
    if (ImGui::Selectable(name.c_str(), is(name))) pin.to = name;
    noteItem("pin_to " + name, ui);
  };
  entry("scalp");
  entry("scene");
  for (const Joint& joint : joints) entry(joint.name);
  ImGui::EndCombo();
}

void dragSeconds(const char* label, const char* help, const std::string& name, const char* format, double& value,
                 UiState& ui) {
  rowLabel(label, help);
  ImGui::SetNextItemWidth(-1);
  constexpr double kNone = 0;
  ImGui::DragScalar(("##" + name).c_str(), ImGuiDataType_Double, &value, 0.02f, &kNone, &kLatestShown, format,
                    ImGuiSliderFlags_AlwaysClamp);
  noteItem(name, ui);
}

void postPins(const std::vector<PinSpec>& pins, Demo& demo) {
  postRequest(demo, {Ask::kPin, "", writePins(pins).dump()});
}

PinChoice choiceOf(const PinState& pin) {
  constexpr double kEver = PinSpec::kForever;
  return {pin.to, pin.firm ? kEver : pin.stiffness, pin.from, pin.until > 0 ? pin.until : kEver};
}

std::vector<int> chosenVertices(const Actor& actor, const UiState& ui) {
  const SelectState& select = ui.select;
  if (select.element < 0 || select.haircut != actor.haircut->id) return {};
  std::vector<int> chosen = verticesOf(static_cast<MeshElement>(select.element), select.chosen, actor.haircut->mesh);
  std::erase_if(chosen, [&](int v) { return actor.haircut->mesh.isRoot(v); });
  return chosen;
}

// A new choice shows the settings of its first pin, to be changed and pinned anew.
void readChosenPin(const std::vector<int>& chosen, const Actor& actor, PinState& shown) {
  if (std::exchange(shown.read_of, chosen) == chosen) return;
  for (std::size_t k = 0; k < actor.spec.pins.size(); ++k) {
    if (std::ranges::find(chosen, actor.pins[k].vertex) == chosen.end()) continue;
    const PinSpec& pin = actor.spec.pins[k];
    shown.to = pin.to;
    shown.firm = !std::isfinite(pin.stiffness);
    if (!shown.firm) shown.stiffness = pin.stiffness;
    shown.from = pin.from;
    shown.until = std::isfinite(pin.until) ? pin.until : 0;
    return;
  }
}

// Of the actor's last step.
std::string awayNote(const Actor& actor) {
  const int away = actor.last_report.pins_out_of_reach;
  return away == 0 ? "" : ", " + std::to_string(away) + " out of reach";
}

}  // namespace

void pinSection(Demo& demo, UiState& ui) {
  const Actor& actor = selectedActor(demo);
  PinState& pin = ui.pin;
  const std::vector<int> chosen = chosenVertices(actor, ui);
  readChosenPin(chosen, actor, pin);
  targetRow(actor, ui);
  rowLabel("Firm", "The pin does not give; else it is a spring");
  ImGui::Checkbox("##pin_firm", &pin.firm);
  noteItem("pin_firm", ui);
  ImGui::BeginDisabled(pin.firm);
  rowLabel("Stiffness", "Of the spring");
  ImGui::SetNextItemWidth(-1);
  auto shown = static_cast<float>(pin.stiffness);
  {
    const MarksBelowDigits marks;
    if (ImGui::SliderFloat("##pin_stiffness", &shown, kSoftestShown, kStiffestShown, "%.1f N/m",
                           ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic))
      pin.stiffness = static_cast<double>(shown);
  }
  noteItem("pin_stiffness", ui);
  ImGui::EndDisabled();
  dragSeconds("From", "Simulated time at which the pin begins to hold. Drag, or double-click to type", "pin_from",
              "%.2f s", pin.from, ui);
  dragSeconds("Until", "Simulated time at which it lets go; 0: never. Drag, or double-click to type", "pin_until",
              pin.until > 0 ? "%.2f s" : "never", pin.until, ui);
  const bool in_order = pin.until == 0 || pin.until > pin.from;
  const std::vector<PinSpec>& pins = actor.spec.pins;
  const bool mirror = ui.brush.mirror;
  const std::vector<PinSpec> rest = withoutPins(mirror ? withLikesAcross(chosen, actor) : chosen, actor);
  const int pressed = segments("pins",
                               {{"Pin",
                                 "Pins what is chosen (Brushes, Vertex to Layer) where it is now; a drag takes "
                                 "its pins along. With Mirror so is its like on the other side",
                                 !chosen.empty() && in_order},
                                {"Unpin", "Lets what is chosen go", rest.size() < pins.size()},
                                {"Unpin all", "Lets all of this hair go", !pins.empty()}},
                               -1, ui);
  if (pressed == 0) postPins(withPins(chosen, choiceOf(pin), mirror, actor), demo);
  if (pressed == 1) postPins(rest, demo);
  if (pressed == 2) postPins({}, demo);
  if (!in_order) ImGui::TextDisabled("Until lies before From: make it later, or 0 for never");
  if (chosen.empty() && pins.empty())
    ImGui::TextDisabled("choose hair first: Brushes, Vertex to Layer");
  else
    fact("Pins", std::to_string(pins.size()) + awayNote(actor));
}

}  // namespace app

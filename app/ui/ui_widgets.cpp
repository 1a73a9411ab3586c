#include "app/ui/ui_widgets.h"

#include <imgui/imgui.h>
#include <imgui/imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "app/files/data_path.h"
#include "app/files/field_map.h"
#include "app/files/report_line.h"
#include "sim/field_text.h"
#include "sim/stabilization/parameter_limits.h"

namespace app {

namespace {

constexpr float kLabelShare = 0.43f;
constexpr float kMarkShare = 0.16f;  // of a slider's height
constexpr float kTipDelay = 0.3f;    // s
constexpr float kEndedTip = 1e9f;    // s

ImU32 color(ImGuiCol index, float alpha = 1) {
  return ImGui::GetColorU32(index, alpha);
}

// A number with its unit inside the slider.
bool numberSlider(const char* name, sim::FieldKind kind, bool logarithmic, double low, double high, const char* unit,
                  double& value) {
  const ShownUnit shown = shownUnit(unit, high);
  double number = shown.times * value;
  // With four digits from 10,000 on it would have an exponent.
  std::string format = kind == sim::FieldKind::kInteger ? "%.0f" : number < 1000 ? "%.4g" : "%.6g";
  if (*unit) format.append(" ").append(shown.unit);
  ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp;
  if (logarithmic) flags |= ImGuiSliderFlags_Logarithmic;
  const MarksBelowDigits marks;
  const double least = shown.times * low, most = shown.times * high;
  if (!ImGui::SliderScalar(name, ImGuiDataType_Double, &number, &least, &most, format.c_str(), flags)) return false;
  value = std::clamp(number / shown.times, low, high);
  return true;
}

bool choiceCombo(const char* name, std::span<const char* const> choices, double& value) {
  const auto chosen = static_cast<std::size_t>(value);
  bool changed = false;
  if (!ImGui::BeginCombo(name, choices[chosen])) return false;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (ImGui::Selectable(choices[i], i == chosen)) {
      value = static_cast<double>(i);
      changed = true;
    }
  }
  ImGui::EndCombo();
  return changed;
}

// What a row is for, its name and range in files, and how a number is typed.
template <class Row>
std::string helpText(const Row& row, const std::string& standard) {
  std::string text = std::string(row.help) + "\n\n" + row.name + ", ";
  if (row.kind == sim::FieldKind::kSwitch) return text + "on or off, default " + standard;
  if (row.kind == sim::FieldKind::kChoice) return text + "a choice, default " + standard;
  const auto shown = [&](double value) { return shownText(sim::numberText(value), row.unit, row.maximum); };
  text += shown(row.minimum) + " to " + shown(row.maximum) + ", default " + shownText(standard, row.unit, row.maximum);
  if (shownUnit(row.unit, row.maximum).times != 1) text.append("; in files ").append(row.unit);
  return text + "\nCtrl and a click: type a number";
}

void fillRow(bool with_reset, UiState& ui) {
  const float room = ImGui::GetContentRegionAvail().x;
  ImGui::SetNextItemWidth(with_reset ? room - kResetWidth * ui.text_scale - 4 : room);
}

// Under a slider whose value the hair cannot bear: the value that is used, and why.
void limitNote(const sim::ParamField& field, const Demo& demo, UiState& ui) {
  const Actor& actor = selectedActor(demo);
  const sim::HairMesh& mesh = actor.coarse.active ? actor.coarse.pair->coarse->mesh : actor.haircut->mesh;
  for (const sim::LimitedValue& limited : sim::limitedValues(mesh, demo.scene.sim)) {
    if (limited.field != &field) continue;
    char text[160];
    const ShownUnit shown = shownUnit(field.unit, field.maximum);
    std::snprintf(text, sizeof text, "used: %s %s, %s", threeDigits(shown.times * limited.used).c_str(),
                  shown.unit.data(), limited.reason);
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + kLabelShare * ImGui::GetContentRegionAvail().x);
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_CheckMark));
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
    noteItem(std::string(field.name) + " " + text, ui);
  }
}

}  // namespace

void noteItem(const std::string& name, UiState& ui) {
  const ImVec2 low = ImGui::GetItemRectMin(), size = ImGui::GetItemRectSize();
  ui.items.push_back({name, low.x, low.y, size.x, size.y});
}

void noteMark(const std::string& name, float x, float y, float radius, UiState& ui) {
  ui.items.push_back({name, x - radius, y - radius, 2 * radius, 2 * radius});
}

void postRequest(Demo& demo, Request request) {
  demo.requests.push_back(std::move(request));
}

Picture shownPicture(const Demo& demo) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const bool half = demo.comparison.on() && demo.comparison.side_by_side;
  return {(half ? 0.5 : 1.0) * static_cast<double>(size.x), static_cast<double>(size.y), demo.place};
}

MarksBelowDigits::MarksBelowDigits() : first_(ImGui::GetWindowDrawList()->VtxBuffer.Size) {}

// Dear ImGui draws a mark as high as its slider and the digits over it: the vertices of its two colours are moved.
MarksBelowDigits::~MarksBelowDigits() {
  constexpr ImU32 kTint = ~IM_COL32_A_MASK;
  const ImU32 still = color(ImGuiCol_SliderGrab) & kTint, held = color(ImGuiCol_SliderGrabActive) & kTint;
  const float low = ImGui::GetItemRectMin().y, high = ImGui::GetItemRectMax().y, height = kMarkShare * (high - low);
  ImVector<ImDrawVert>& vertices = ImGui::GetWindowDrawList()->VtxBuffer;
  for (int v = first_; v < vertices.Size; ++v) {
    ImDrawVert& vertex = vertices[v];
    const ImU32 tint = vertex.col & kTint;
    if (tint != still && tint != held) continue;
    vertex.pos.y = vertex.pos.y < 0.5f * (low + high) ? high - 1 - height : high - 1;
  }
}

namespace {

// Whether the pointer has rested on the last widget. One without an identity of its own has that of its words.
bool rested(const char* words) {
  const ImGuiIO& io = ImGui::GetIO();
  const bool over =
      ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled | ImGuiHoveredFlags_AllowWhenBlockedByActiveItem);
  if (!over || GImGui->NavDisableMouseHover) return false;
  ImGuiStorage* kept = ImGui::GetStateStorage();
  const ImGuiID item = ImGui::GetItemID() ? ImGui::GetItemID() : ImGui::GetID(words);
  ImGui::PushID(static_cast<int>(item));
  const ImGuiID id = ImGui::GetID("rested");
  ImGui::PopID();
  int* last = kept->GetIntRef(id, 0);
  const bool arrives = std::exchange(*last, ImGui::GetFrameCount()) + 1 < ImGui::GetFrameCount();
  float* seconds = kept->GetFloatRef(id + 1, 0);
  *seconds = arrives ? 0 : *seconds + io.DeltaTime;
  if (ImGui::IsMouseDown(0) || ImGui::IsMouseReleased(0)) *seconds = -kEndedTip;
  return *seconds >= kTipDelay;
}

}  // namespace

void tip(const std::string& text) {
  if (text.empty() || !rested(text.c_str())) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(ImGui::GetFontSize() * 24);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

bool colorSwatch(const char* name, std::array<float, 3>& linear, int flags) {
  std::array<float, 3> shown{};
  for (std::size_t c = 0; c < 3; ++c) shown[c] = static_cast<float>(pictureValue(static_cast<double>(linear[c])));
  if (!ImGui::ColorEdit3(name, shown.data(), flags)) return false;
  for (std::size_t c = 0; c < 3; ++c) {
    const double value = std::clamp(static_cast<double>(shown[c]), 0.0, 1.0);
    linear[c] = static_cast<float>(linearShare(value));
  }
  return true;
}

bool section(const char* title, bool open_at_first) {
  ImGui::SetNextItemOpen(open_at_first, ImGuiCond_FirstUseEver);
  return ImGui::CollapsingHeader(title);
}

std::string fileCombo(const char* name, const std::string& shown, const std::vector<std::string>& files, UiState& ui) {
  std::string chosen;
  ImGui::SetNextItemWidth(-1);
  const bool of_list = std::ranges::any_of(files, [&](const std::string& file) { return stem(file) == shown; });
  const bool open = ImGui::BeginCombo(name, (of_list ? readable(shown) : shown).c_str());
  noteItem(name, ui);
  if (!open) return chosen;
  for (const std::string& file : files) {
    if (ImGui::Selectable(readable(stem(file)).c_str(), stem(file) == shown)) chosen = file;
    noteItem(std::string(name) + " " + stem(file), ui);
  }
  ImGui::EndCombo();
  return chosen;
}

void fact(const char* label, const std::string& value) {
  rowLabel(label, "");
  ImGui::TextDisabled("%s", value.c_str());
}

void rowLabel(const std::string& text, const std::string& help) {
  const float start = ImGui::GetCursorPosX();
  const float width = ImGui::GetContentRegionAvail().x;
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(text.c_str());
  tip(help);
  ImGui::SameLine(start + kLabelShare * width);
}

// A row that another one makes idle is grey: moving it would show nothing.
bool hasEffect(std::string_view name, const CharacterLook& look) {
  if (name == "color") return look.hair.use_color;
  if (name == "eumelanin" || name == "pheomelanin") return !look.hair.use_color;
  if (name == "curl_pitch") return look.hair.curl_radius > 0;
  if (name == "wave_length") return look.hair.wave_height > 0;
  if (name == "clump_size") return look.hair.clump + look.hair.lock + look.hair.wisp + look.hair.drift > 0;
  if (name == "flyaway_lift") return look.hair.flyaways > 0;
  if (name == "baby_hairs") return look.hair.hairline > 0;
  return true;
}

bool hasEffect(std::string_view name, const SceneLook& look) {
  const bool of_shadows = name.starts_with("shadow_") || name == "opacity_layers" || name == "layer_thickness";
  if (of_shadows) return look.light.shadows;
  if (name == "strand_path") return look.view.show_strands;
  return name != "ground_color" || look.view.ground;
}

bool hasEffect(const sim::ParamField& row, const sim::SimParams& params) {
  const std::string_view name = row.name, group = row.group;
  if (name == "gust") return params.wind_x != 0 || params.wind_y != 0 || params.wind_z != 0;
  return params.collide || group != "Contact" || name == "collide" || name == "self_collide";
}

void simRow(const sim::ParamField& field, Demo& demo, UiState& ui) {
  const sim::SimParams& params = demo.scene.sim;
  double value = field.get(params);
  const sim::SimParams& base = demo.scene.base.sim;
  const std::string standard = sim::paramText(field, base);
  const std::string help = helpText(field, sim::paramText(field, sim::SimParams{}));
  const bool touched = value != field.get(base);
  ImGui::PushID(field.name);
  rowLabel(rowTitle(field.name), help);
  fillRow(touched, ui);
  ImGui::BeginDisabled(!hasEffect(field, params));
  bool changed = false;
  if (field.kind == sim::FieldKind::kSwitch) {
    bool on = value != 0;
    changed = ImGui::Checkbox("##value", &on);
    value = on;
  } else if (field.kind == sim::FieldKind::kChoice) {
    changed = choiceCombo("##value", field.choices, value);
  } else {
    changed = numberSlider("##value", field.kind, field.logarithmic, field.minimum, field.maximum, field.unit, value);
  }
  ImGui::EndDisabled();
  noteItem(field.name, ui);
  if (!ImGui::IsItemActive()) tip(help);
  if (changed) {
    sim::SimParams wanted = params;
    field.set(wanted, value);
    postRequest(demo, {Ask::kSetParam, field.name, sim::paramText(field, wanted)});
  }
  if (touched && resetMark(field.name, shownText(standard, field.unit, field.maximum), ui))
    postRequest(demo, {Ask::kSetParam, field.name, standard});
  limitNote(field, demo, ui);
  ImGui::PopID();
}

namespace {

// What a look's rows go back to.
const CharacterLook& baseOf(const CharacterLook&, const Demo& demo) {
  return demo.scene.base.hairs[static_cast<std::size_t>(demo.selected)];
}
const SceneLook& baseOf(const SceneLook&, const Demo& demo) {
  return demo.scene.base.scene;
}

}  // namespace

template <class Owner>
void lookRow(const LookField<Owner>& field, const Owner& owner, Demo& demo, UiState& ui) {
  LookValue value = field.get(owner);
  const Owner& base = baseOf(owner, demo);
  const std::string standard = lookText(base, field);
  const std::string help = helpText(field, lookText(Owner{}, field));
  const bool touched = value != field.get(base);
  ImGui::PushID(field.name);
  rowLabel(rowTitle(field.name), help);
  fillRow(touched, ui);
  ImGui::BeginDisabled(!hasEffect(field.name, owner));
  bool changed = false;
  if (field.shape == LookShape::kColor) {
    std::array<float, 3> rgb{static_cast<float>(value[0]), static_cast<float>(value[1]), static_cast<float>(value[2])};
    // Lights go beyond 1 and are shown by their numbers.
    changed = field.maximum > 1
                  ? ImGui::ColorEdit3("##value", rgb.data(), ImGuiColorEditFlags_Float | ImGuiColorEditFlags_HDR)
                  : colorSwatch("##value", rgb, ImGuiColorEditFlags_Float);
    for (std::size_t i = 0; i < 3; ++i)
      value[i] = std::clamp(static_cast<double>(rgb[i]), field.minimum, field.maximum);
  } else if (field.shape == LookShape::kDirection) {
    float xyz[3] = {static_cast<float>(value[0]), static_cast<float>(value[1]), static_cast<float>(value[2])};
    const MarksBelowDigits marks;
    changed = ImGui::SliderFloat3("##value", xyz, -1, 1, "%.2f", ImGuiSliderFlags_AlwaysClamp);
    for (int i = 0; i < 3; ++i) value[i] = xyz[i];
    changed = changed && (xyz[0] != 0 || xyz[1] != 0 || xyz[2] != 0);
  } else if (field.kind == sim::FieldKind::kSwitch) {
    bool on = value[0] != 0;
    changed = ImGui::Checkbox("##value", &on);
    value[0] = on;
  } else if (field.kind == sim::FieldKind::kChoice) {
    changed = choiceCombo("##value", field.choices, value[0]);
  } else {
    changed =
        numberSlider("##value", field.kind, field.logarithmic, field.minimum, field.maximum, field.unit, value[0]);
  }
  ImGui::EndDisabled();
  noteItem(field.name, ui);
  if (!ImGui::IsItemActive()) tip(help);
  if (changed) {
    Owner wanted = owner;
    field.set(wanted, value);
    postRequest(demo, {Ask::kSetParam, field.name, lookText(wanted, field)});
  }
  if (touched && resetMark(field.name, shownText(standard, field.unit, field.maximum), ui))
    postRequest(demo, {Ask::kSetParam, field.name, standard});
  ImGui::PopID();
}

template void lookRow(const HairField&, const CharacterLook&, Demo&, UiState&);
template void lookRow(const SceneField&, const SceneLook&, Demo&, UiState&);

void simGroup(std::string_view group, Demo& demo, UiState& ui) {
  for (const sim::ParamField& field : sim::paramFields()) {
    if (group == field.group) simRow(field, demo, ui);
  }
}

void hairGroup(std::string_view group, Demo& demo, UiState& ui) {
  for (const HairField& field : hairFields()) {
    if (group == field.group) lookRow(field, selectedActor(demo).spec.look, demo, ui);
  }
}

void sceneGroup(std::string_view group, Demo& demo, UiState& ui) {
  for (const SceneField& field : sceneFields()) {
    if (group == field.group) lookRow(field, demo.scene.look, demo, ui);
  }
}

int segments(const char* name, std::initializer_list<Segment> row, int chosen, UiState& ui) {
  int pressed = -1, index = 0;
  const float gap = 3, count = static_cast<float>(row.size());
  // Every button gets its text's width and an even share of what is left.
  float left = ImGui::GetContentRegionAvail().x - gap * (count - 1);
  for (const Segment& segment : row) left -= ImGui::CalcTextSize(segment.label).x;
  ImGui::PushID(name);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {2, ImGui::GetStyle().FramePadding.y});
  for (const auto& [label, help, enabled] : row) {
    if (index) ImGui::SameLine(0, gap);
    const bool lit = index == chosen;
    if (lit) {
      ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_SliderGrabActive));
      ImGui::PushStyleColor(ImGuiCol_ButtonHovered, ImGui::GetStyleColorVec4(ImGuiCol_SliderGrabActive));
      ImGui::PushStyleColor(ImGuiCol_ButtonActive, ImGui::GetStyleColorVec4(ImGuiCol_SliderGrabActive));
      ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(0.07f, 0.07f, 0.08f, 1));
    }
    ImGui::BeginDisabled(!enabled);
    if (ImGui::Button(label, {ImGui::CalcTextSize(label).x + std::max(left / count, 2.0f), 0})) pressed = index;
    ImGui::EndDisabled();
    if (lit) ImGui::PopStyleColor(4);
    noteItem(std::string(name) + " " + label, ui);
    tip(help);
    ++index;
  }
  ImGui::PopStyleVar();
  ImGui::PopID();
  return pressed;
}

}  // namespace app

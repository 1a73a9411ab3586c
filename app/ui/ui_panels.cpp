#include "app/ui/ui_panels.h"

#include <imgui/imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "app/files/data_path.h"
#include "app/files/length_units.h"
#include "app/files/told_body.h"
#include "app/scene/background_load.h"
#include "app/scene/hairdo.h"
#include "app/ui/ui_widgets.h"
#include "sim/field_text.h"

namespace app {

namespace {

// A path to type, or to look for by the button beside it; true when it was confirmed.
template <std::size_t N>
bool pathInput(const char* name, const char* hint, BrowseFor what, std::array<char, N>& path, UiState& ui) {
  const float button = 52 * ui.text_scale;
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - button - 5);
  const bool entered =
      ImGui::InputTextWithHint(name, hint, path.data(), path.size(), ImGuiInputTextFlags_EnterReturnsTrue);
  noteItem(name, ui);
  ImGui::SameLine(0, 5);
  ImGui::PushID(name);
  if (ImGui::Button("Open", {button, 0})) browseFor(what, ui);
  ImGui::PopID();
  noteItem(std::string("open ") + name, ui);
  return entered && path[0] != 0;
}

bool slider(const char* name, double low, double high, const char* format, bool logarithmic, double& value) {
  const ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp | (logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
  const MarksBelowDigits marks;
  return ImGui::SliderScalar(name, ImGuiDataType_Double, &value, &low, &high, format, flags);
}

bool contains(std::string text, std::string_view part) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text.find(part) != std::string::npos;
}

// Rows of all three tables whose name or help has what was typed. Returns whether anything was.
bool searchResults(Demo& demo, UiState& ui) {
  ImGui::SetNextItemWidth(-1);
  ImGui::InputTextWithHint("##search", "search all parameters", ui.search.data(), ui.search.size());
  noteItem("search", ui);
  std::string wanted = ui.search.data();
  if (wanted.empty()) return false;
  std::transform(wanted.begin(), wanted.end(), wanted.begin(), [](unsigned char c) { return std::tolower(c); });
  const auto found = [&](const auto& row) {
    return contains(row.name, wanted) || contains(rowTitle(row.name), wanted) || contains(row.help, wanted);
  };
  for (const sim::ParamField& row : sim::paramFields()) {
    if (found(row)) simRow(row, demo, ui);
  }
  for (const HairField& row : hairFields()) {
    if (found(row)) lookRow(row, selectedActor(demo).spec.look, demo, ui);
  }
  for (const SceneField& row : sceneFields()) {
    if (found(row)) lookRow(row, demo.scene.look, demo, ui);
  }
  return true;
}

void clipRows(const Actor& actor, Demo& demo, UiState& ui) {
  rowLabel("Motion", "Clips that come with the program; or give a file below, or drop one on the window");
  if (const std::string file = fileCombo("##motion", stem(actor.spec.motion), ui.clips, ui); !file.empty()) {
    postRequest(demo, {Ask::kMotionFile, "", file});
  }
  const std::vector<Clip>& clips = actor.body->character.clips;
  if (clips.size() > 1) {
    rowLabel("Clip", "Clips within the file");
    ImGui::SetNextItemWidth(-1);
    if (ImGui::BeginCombo("##clip", actor.playedClip().name.c_str())) {
      for (const Clip& clip : clips) {
        if (ImGui::Selectable(clip.name.c_str(), &clip == &actor.playedClip()))
          postRequest(demo, {Ask::kClip, clip.name, ""});
      }
      ImGui::EndCombo();
    }
  }
  rowLabel("File", "BVH, glTF, FBX, or ARCSim's .mot with its folder of body parts");
  const bool is_mot = std::string(ui.motion_path.data()).ends_with(".mot");
  bool entered = pathInput("##motion_path", "path, then Enter", BrowseFor::kMotion, ui.motion_path, ui);
  if (is_mot) {
    rowLabel("Body parts", "Folder of body0000.obj ...");
    entered = pathInput("##parts_path", "folder, then Enter", BrowseFor::kParts, ui.parts_path, ui) || entered;
  }
  if (entered) postRequest(demo, {Ask::kMotionFile, is_mot ? ui.parts_path.data() : "", ui.motion_path.data()});
}

// What the clip does at its end, and what that comes to.
void loopRows(const Actor& actor, Demo& demo, UiState& ui) {
  rowLabel("At the end",
           "Go on from where the figure is, stay in place, stop, or none: begin again without a blend. Auto goes on "
           "unless the clip stays in place by itself.");
  ImGui::TextDisabled("%s", loopText(actor.playback.loop).c_str());
  const int chosen = static_cast<int>(actor.spec.loop);
  const int pressed = segments("loop", {"Auto", "Go on", "In place", "Stop", "None"}, chosen, ui);
  if (pressed >= 0) postRequest(demo, {Ask::kLoop, std::string(loopName(static_cast<LoopKind>(pressed))), ""});
}

void stateRow(Demo& demo, UiState& ui) {
  constexpr const char* kFile = "hairmesh.state";
  rowLabel("State", "Keeps all that moves in hairmesh.state in the working folder, and goes on from it");
  if (ImGui::Button("Save##state")) postRequest(demo, {Ask::kSaveState, "", kFile});
  noteItem("save_state", ui);
  ImGui::SameLine(0, 5);
  if (ImGui::Button("Load##state")) postRequest(demo, {Ask::kLoadState, "", kFile});
  noteItem("load_state", ui);
}

void recordHairRow(Demo& demo, UiState& ui) {
  rowLabel("Record hair",
           "Writes the strands of every frame from now on into the working folder, or of glb the hair mesh; a cache is "
           "what the timeline shows");
  if (demo.capture.hair) {
    if (ImGui::Button("End##record_hair")) postRequest(demo, {Ask::kRecordHair, "", "", 0});
    noteItem("record_hair_end", ui);
    return;
  }
  static constexpr const char* kEndings[] = {".abc", ".usda", ".hair", ".ply", ".glb", ".hairmesh"};
  const int pressed = segments("record_hair", {"abc", "usda", "hair", "ply", "glb", "cache"}, -1, ui);
  if (pressed >= 0) postRequest(demo, {Ask::kRecordHair, "", kEndings[pressed], 1});
}

void playbackRows(const Actor& actor, Demo& demo, UiState& ui) {
  double speed = actor.playback.speed;
  rowLabel("Speed", "Clip seconds per second. The paper shows 10x; the hair's own time does not change.");
  ImGui::SetNextItemWidth(-1);
  if (slider("##speed", 0, 20, "%.3g x", true, speed)) postRequest(demo, {Ask::kSpeed, "", "", speed});
  noteItem("speed", ui);
  rowLabel("", "");
  static constexpr double kSpeeds[] = {0.25, 1, 2, 5, 10, 20};
  int chosen = -1;
  for (int i = 0; i < 6; ++i) chosen = std::abs(speed - kSpeeds[i]) < 1e-9 ? i : chosen;
  const int pressed = segments("speeds", {"1/4", "1x", "2x", "5x", "10x", "20x"}, chosen, ui);
  if (pressed >= 0) postRequest(demo, {Ask::kSpeed, "", "", kSpeeds[pressed]});

  double time = actor.playback.time;
  rowLabel("Time", "Scrubs the clip; the hair is carried along with the head");
  ImGui::SetNextItemWidth(-1);
  char format[48];
  std::snprintf(format, sizeof format, "%%.2f / %.2f s", actor.playedClip().duration());
  if (slider("##scrub", 0, actor.playedClip().duration(), format, false, time))
    postRequest(demo, {Ask::kCarryAlong, "", "", time});
  noteItem("scrub", ui);
  rowLabel("To the start",
           "Puts the figure to the clip's start; the hair keeps its shape and velocity against the head");
  if (ImGui::Button("Carry hair along")) postRequest(demo, {Ask::kCarryAlong, "", "", 0});
  noteItem("carry", ui);

  bool held = actor.playback.paused;
  rowLabel("Hold motion", "The figure stands still while the hair goes on");
  if (ImGui::Checkbox("##held", &held)) postRequest(demo, {Ask::kPauseMotion, "", "", held ? 1.0 : 0.0});
  noteItem("hold", ui);
  loopRows(actor, demo, ui);
  stateRow(demo, ui);
  recordHairRow(demo, ui);
}

void substepRow(Demo& demo, UiState& ui) {
  rowLabel("Steps per 1/60 s", "Sets the time step to a whole part of a sixtieth of a second");
  static constexpr int kCounts[] = {1, 2, 4, 8};
  int chosen = -1;
  for (int i = 0; i < 4; ++i) chosen = std::abs(demo.scene.sim.time_step * 60 * kCounts[i] - 1) < 1e-6 ? i : chosen;
  const int pressed = segments("substeps", {"1", "2", "4", "8"}, chosen, ui);
  if (pressed < 0) return;
  sim::SimParams wanted = demo.scene.sim;
  wanted.time_step = 1.0 / (60 * kCounts[pressed]);
  postRequest(demo, {Ask::kSetParam, "time_step", sim::paramText(*sim::findParam("time_step"), wanted)});
}

// One variation replaces the last, until one is kept or something else is changed.
void varyRow(Demo& demo, UiState& ui) {
  rowLabel("Vary by", "Draws all rows of Material at random about what they are: so many decades up or down");
  const float button = 52 * ui.text_scale;
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - 2 * button - 10);
  slider("##vary", 0.02, 1, "%.2f", false, ui.vary.amount);
  noteItem("vary_amount", ui);
  const EditHistory& edits = demo.edits;
  const bool varied = edits.done > 0 && edits.steps[edits.done - 1].request.what == Ask::kVary;
  const bool replaces = varied && edits.done != ui.vary.kept;
  ImGui::SameLine(0, 5);
  if (ImGui::Button(replaces ? "Other" : "Vary", {button, 0})) {
    if (replaces) postRequest(demo, {Ask::kUndo, "", "", 1});
    postRequest(demo, {Ask::kVary, "", sim::numberText(ui.vary.amount), static_cast<double>(++ui.vary.seed)});
  }
  noteItem("vary", ui);
  ImGui::SameLine(0, 5);
  ImGui::BeginDisabled(!replaces);
  if (ImGui::Button("Keep", {button, 0})) ui.vary.kept = edits.done;
  noteItem("keep_variation", ui);
  ImGui::EndDisabled();
}

std::string metres(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f cm", 100 * value);
  return text;
}

// What a person tells of a body without bones, where the outline told otherwise.
void bodyRows(const Actor& actor, Demo& demo, UiState& ui) {
  ToldBody told;
  const Request* coming = comingRequest(Ask::kBody, demo);  // a second choice adds to one that is being loaded
  readToldBody(coming ? coming->text : actor.spec.body, told);
  const auto* const unit = std::ranges::find(kLengthUnits, told.unit, &LengthUnit::metres);
  rowLabel("Unit", "Of the file; Auto: as the size of head and body tells");
  const int of_unit = segments("body_unit", {"Auto", "m", "cm", "mm", "in", "ft"},
                               unit == kLengthUnits.end() ? 0 : 1 + static_cast<int>(unit - kLengthUnits.begin()), ui);
  if (of_unit >= 0) told.unit = of_unit == 0 ? 0 : kLengthUnits[static_cast<std::size_t>(of_unit) - 1].metres;
  rowLabel("Up", "The file's axis that is up");
  const int up = segments("body_up", {"Auto", "y", "z"}, told.up == 0 ? 0 : told.up == 'y' ? 1 : 2, ui);
  if (up >= 0) told.up = up == 0 ? '\0' : up == 1 ? 'y' : 'z';
  rowLabel("Faces", "Where the face looks once y is up");
  const std::array<Vec3, 5> ways{Vec3::Zero(), Vec3::UnitZ(), -Vec3::UnitZ(), Vec3::UnitX(), -Vec3::UnitX()};
  const int face = segments("body_face", {"Auto", "z", "-z", "x", "-x"},
                            static_cast<int>(std::ranges::find(ways, told.face) - ways.begin()), ui);
  if (face >= 0) told.face = ways[static_cast<std::size_t>(face)];
  if (of_unit >= 0 || up >= 0 || face >= 0) postRequest(demo, {Ask::kBody, "", writeToldBody(told)});
}

}  // namespace

void simulationTab(Demo& demo, UiState& ui) {
  if (searchResults(demo, ui)) return;
  presetRows(demo, ui);
  compareRows(demo, ui);
  varyRow(demo, ui);
  ImGui::Spacing();
  for (const char* group : {"Material", "Contact", "World", "Rest shape", "Time", "Numerics"}) {
    const bool open = std::string_view(group) == "Material" || std::string_view(group) == "Contact";
    if (section(group, open)) simGroup(group, demo, ui);
    noteItem(std::string("section ") + group, ui);
  }
}

void motionTab(Demo& demo, UiState& ui) {
  const Actor& actor = selectedActor(demo);
  if (section("Clip", true)) clipRows(actor, demo, ui);
  if (section("Playback", true)) playbackRows(actor, demo, ui);
  if (section("Time step", true)) {
    substepRow(demo, ui);
    simGroup("Time", demo, ui);
    char text[64];
    std::snprintf(text, sizeof text, "%d this frame, %.2f s given up", demo.stats.steps, demo.stats.lost);
    fact("Steps", text);
  }
  if (section("Camera", true)) {
    static constexpr const char* kViews[] = {"front", "three-quarter", "side", "back", "top"};
    const int pressed = segments("view", {"Front", "3/4", "Side", "Back", "Top"}, -1, ui);
    if (pressed >= 0) postRequest(demo, {Ask::kView, kViews[pressed], ""});
    bool following = demo.camera.follow;
    rowLabel("Follow figure", "The camera goes along with the head");
    if (ImGui::Checkbox("##follow", &following)) postRequest(demo, {Ask::kFollow, "", "", following ? 1.0 : 0.0});
    cameraRows(demo, ui);
  }
  if (actor.body->character.is_still && section("Body", true)) bodyRows(actor, demo, ui);
  if (section("What was read", false)) {
    for (const std::string& note : actor.body->character.notes) {
      ImGui::PushTextWrapPos(0);
      ImGui::TextDisabled("%s", note.c_str());
      ImGui::PopTextWrapPos();
    }
  }
}

namespace {

// The inspector's option as words: "drop bad".
std::string plainMend(std::string mend) {
  for (std::size_t at = mend.find("--"); at != std::string::npos; at = mend.find("--", at)) mend.erase(at, 2);
  return mend;
}

// What the inspector says of curves from a file, with its mends as buttons.
void inspectorSection(const Actor& actor, Demo& demo, UiState& ui) {
  if (!actor.haircut->look || !actor.spec.fit || !section("Inspector", true)) return;
  constexpr std::string_view kNoGuess = "--no-guess";
  const std::string& mends = actor.spec.mends;
  const std::size_t at = mends.find(kNoGuess);
  bool guesses = at == std::string::npos;
  rowLabel("Mend by itself", "What is certain is mended while the file is read");
  if (ImGui::Checkbox("##guesses", &guesses)) {
    std::string other = mends;
    if (at == std::string::npos) other = std::string(kNoGuess) + " " + other;
    if (at != std::string::npos) other.erase(at, kNoGuess.size());
    postRequest(demo, {Ask::kHairMends, "", other});
  }
  noteItem("mend_certain", ui);
  if (actor.haircut->findings.empty()) ImGui::TextDisabled("nothing is wrong");
  for (const MendedFinding& one : actor.haircut->findings) {
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted((one.finding.what + ": " + one.finding.text).c_str());
    ImGui::PopTextWrapPos();
    if (one.done) {
      ImGui::TextDisabled("mended: %s", plainMend(one.finding.mend).c_str());
    } else if (one.finding.mend.find('|') == std::string::npos) {
      if (ImGui::Button(("Mend##" + one.finding.what).c_str()))
        postRequest(demo, {Ask::kHairMends, "", mends + (mends.empty() ? "" : " ") + one.finding.mend});
      noteItem("mend " + one.finding.what, ui);
      ImGui::SameLine(0, 6);
      ImGui::TextDisabled("%s", plainMend(one.finding.mend).c_str());
    }
  }
}

}  // namespace

void hairTab(Demo& demo, UiState& ui) {
  const Actor& actor = selectedActor(demo);
  if (section("Brushes", true)) brushSection(demo, ui);
  if (section("Pins", !actor.spec.pins.empty())) pinSection(demo, ui);
  noteItem("section Pins", ui);
  if (section("Haircut", true)) {
    const bool from_file = !actor.spec.hair.empty();
    const int style = segments("style",
                               {"Short",
                                "Shoulder",
                                "Long",
                                {"Bob", "To the jaw, with a fringe"},
                                {"Pixie", "Ears free, with a fringe"},
                                {"Shaved", "Stubble, to grow a hairdo from with the brushes"}},
                               from_file ? -1 : static_cast<int>(actor.spec.style), ui);
    if (style >= 0) postRequest(demo, {Ask::kStyle, std::string(kStyleNames[static_cast<std::size_t>(style)]), ""});
    rowLabel("Hairdo", "A style with its look, ties and maps, on this figure: the hair of a scene of assets/scenes");
    static const std::vector<std::string> kHairdos(kHairdoNames.begin(), kHairdoNames.end());
    if (const std::string hairdo = fileCombo("##hairdo", "choose...", kHairdos, ui); !hairdo.empty())
      postRequest(demo, {Ask::kStyle, hairdo, ""});
    const int resolution = segments("resolution", {"Low", "Medium", "High", "Ultra"},
                                    from_file ? -1 : static_cast<int>(actor.spec.resolution), ui);
    static constexpr const char* kResolutions[] = {"low", "medium", "high", "ultra"};
    if (resolution >= 0) postRequest(demo, {Ask::kResolution, kResolutions[resolution], ""});
    tieRows(demo, ui);
    rowLabel("Hair mesh file", "OBJ with one group a layer; see assets/hair/README.md");
    if (pathInput("##hair_path", from_file ? stem(actor.spec.hair).c_str() : "path, then Enter", BrowseFor::kHair,
                  ui.hair_path, ui)) {
      postRequest(demo, {Ask::kHairFile, "", ui.hair_path.data()});
    }
    const sim::HairMesh& mesh = actor.haircut->mesh;
    fact("Vertices", std::to_string(mesh.vertexCount()) + " in " + std::to_string(mesh.columnCount()) + " columns");
    fact("Prisms",
         std::to_string(mesh.prisms.size()) + " in " + std::to_string(mesh.shape.root_faces.size()) + " bundles");
    fact("Length", metres(mesh.hair_length));
  }
  if (section("Worn", !actor.spec.attachments.empty())) attachmentSection(demo, ui);
  noteItem("section Worn", ui);
  if (section("Root to tip", false)) curveRows(demo, ui);
  noteItem("section Root to tip", ui);
  inspectorSection(actor, demo, ui);
  for (const char* group : {"Strands", "Styling"}) {
    if (section(group, true)) hairGroup(group, demo, ui);
  }
}

namespace {

// The panorama that the lights are taken from.
void environmentRow(Demo& demo, UiState& ui) {
  const std::string& file = demo.scene.environment;
  rowLabel("Environment", "A panorama (.hdr) that key, fill, rim, sky and ground light are taken from. " + file);
  if (ImGui::Button("Open...##environment")) browseFor(BrowseFor::kEnvironment, ui);
  noteItem("open environment", ui);
  ImGui::SameLine(0, 5);
  ImGui::BeginDisabled(file.empty());
  if (ImGui::Button("None##environment")) postRequest(demo, {Ask::kEnvironment, "", ""});
  ImGui::EndDisabled();
  noteItem("no environment", ui);
  ImGui::SameLine(0, 8);
  ImGui::TextDisabled("%s", file.empty() ? "none" : readable(stem(file)).c_str());
  noteItem("environment " + stem(file), ui);
}

}  // namespace

void lookTab(Demo& demo, UiState& ui) {
  if (section("Color", true)) hairGroup("Color", demo, ui);
  if (section("Shine", true)) hairGroup("Shine", demo, ui);
  if (section("Light", false)) {
    environmentRow(demo, ui);
    sceneGroup("Light", demo, ui);
  }
  noteItem("section Light", ui);
  if (section("Shadows", true)) sceneGroup("Shadows", demo, ui);
  if (section("Picture", false)) sceneGroup("Picture", demo, ui);
  if (section("Body", false)) hairGroup("Body", demo, ui);
}

void debugTab(Demo& demo, UiState& ui) {
  if (ui.timings_in_tab && section("Timings", true)) timingsPanel(demo, ui);
  for (const DebugView& view : kDebugViews) {
    bool on = demo.debug.*view.on;
    if (ImGui::Checkbox(view.label.data(), &on))
      postRequest(demo, {Ask::kDebugView, std::string(view.name), "", on ? 1.0 : 0.0});
    noteItem(std::string("debug ") + std::string(view.name), ui);
    ImGui::PushTextWrapPos(0);
    ImGui::Indent(27 * ui.text_scale);
    ImGui::TextDisabled("%s", view.help.data());
    ImGui::Unindent(27 * ui.text_scale);
    ImGui::PopTextWrapPos();
    ImGui::Spacing();
  }
  ImGui::Separator();
  for (const char* name : {"show_strands", "show_body", "ground"}) {
    lookRow(*findSceneField(name), demo.scene.look, demo, ui);
  }
  simRow(*sim::findParam("collide"), demo, ui);
  simRow(*sim::findParam("minimize_deformation"), demo, ui);
  ImGui::Spacing();
  if (section("Skips", true)) skipsSection(demo, ui);
}

}  // namespace app

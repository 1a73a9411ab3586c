// The file panel: looks for a file to open, or for a name to save under.
#include <imgui/imgui.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "app/files/data_path.h"
#include "app/files/field_map.h"
#include "app/files/file_ending.h"
#include "app/scene/project.h"
#include "app/ui/ui_panels.h"
#include "app/ui/ui_widgets.h"

namespace app {

namespace fs = std::filesystem;

namespace {

constexpr float kWidth = 560, kHeight = 460;

struct Purpose {
  BrowseFor what;
  const char* title;
  const char* button;
  std::vector<std::string_view> endings;  // empty: all files
};

const Purpose& purposeOf(BrowseFor what) {
  static const Purpose kPurposes[] = {
      {BrowseFor::kOpen,
       "Open a scene, preset, motion, body, hair, hat, panorama or state",
       "Open",
       {".json", ".bvh",  ".glb",  ".gltf", ".fbx", ".dae", ".mot", ".obj", ".abc",   ".usda",
        ".usd",  ".usdc", ".usdz", ".hair", ".tfx", ".ply", ".vrm", ".hdr", ".state", ".hairmesh"}},
      {BrowseFor::kMotion, "Open a motion", "Open", {".bvh", ".glb", ".gltf", ".fbx", ".dae", ".mot", ".obj"}},
      {BrowseFor::kParts, "Folder of body parts", "Choose", {"/"}},
      {BrowseFor::kHair,
       "Open a hair mesh or a groom",
       "Open",
       {".obj", ".abc", ".usda", ".hair", ".ply", ".tfx", ".fbx", ".glb", ".gltf", ".vrm"}},
      {BrowseFor::kEnvironment, "Open a panorama that the light is taken from", "Open", {".hdr"}},
      {BrowseFor::kWorn, "Open a hat, glasses or a collar", "Open", {".obj", ".fbx", ".glb", ".gltf"}},
      {BrowseFor::kMap,
       "Open a picture of the unrolled head, or a head with coloured vertices",
       "Open",
       {".png", ".obj", ".ply", ".glb", ".gltf", ".fbx"}},
      {BrowseFor::kSaveScene, "Save the scene: style, motion, hair, camera, look, parameters", "Save", {".json"}}};
  return *std::find_if(std::begin(kPurposes), std::end(kPurposes) - 1,
                       [&](const Purpose& purpose) { return purpose.what == what; });
}

void setName(const std::string& name, FileBrowser& browser) {
  browser.name.fill(0);
  std::copy_n(name.begin(), std::min(name.size(), browser.name.size() - 1), browser.name.begin());
}

void goTo(const std::string& folder, FileBrowser& browser) {
  std::error_code ignored;
  browser.folder = fs::weakly_canonical(folder, ignored).string();
  browser.entries = listFolder(browser.folder, purposeOf(browser.what).endings);
}

void close(FileBrowser& browser) {
  browser.what = BrowseFor::kNothing;
  browser.to_replace.clear();
}

void placesRow(UiState& ui) {
  FileBrowser& browser = ui.browser;
  const auto place = [&](const char* label, const char* help, const std::string& folder) {
    if (ImGui::Button(label)) goTo(folder, browser);
    noteItem(std::string("place ") + label, ui);
    tip(help);
    ImGui::SameLine(0, 4);
  };
  place("Up", "The folder above", folderAbove(browser.folder));
  place("Working folder", "The folder that the program was started in, where it writes pictures", ".");
  place("Examples", "What comes with the program", dataPath("assets"));
  if (const char* home = std::getenv("HOME")) place("Home", home, home);
  // The end of a long path says more than its start.
  std::string shown = browser.folder;
  const float room = ImGui::GetContentRegionAvail().x;
  while (shown.size() > 4 && ImGui::CalcTextSize(shown.c_str()).x > room) shown = "..." + shown.substr(7);
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("%s", shown.c_str());
}

// A file's full path once it is chosen twice or by the button; empty until then.
std::string entryList(UiState& ui) {
  FileBrowser& browser = ui.browser;
  std::string chosen, enter;
  for (const FolderEntry& entry : browser.entries) {
    const std::string label = entry.name + (entry.folder ? "/" : "");
    const bool lit = !entry.folder && entry.name == browser.name.data();
    if (ImGui::Selectable(label.c_str(), lit, ImGuiSelectableFlags_AllowDoubleClick)) {
      if (entry.folder) {
        enter = entry.name;
      } else {
        setName(entry.name, browser);
        if (lit && ImGui::IsMouseDoubleClicked(0)) chosen = (fs::path(browser.folder) / entry.name).string();
      }
    }
    noteItem("entry " + entry.name, ui);
  }
  if (browser.entries.empty()) ImGui::TextDisabled("nothing here to choose from");
  if (!enter.empty()) goTo((fs::path(browser.folder) / enter).string(), browser);
  return chosen;
}

// The files opened last, one line each.
std::string recentList(UiState& ui) {
  std::string chosen;
  ImGui::TextDisabled("opened last");
  for (std::size_t i = 0; i < std::min<std::size_t>(4, ui.recent.size()); ++i) {
    const fs::path file(ui.recent[i]);
    if (ImGui::Selectable((file.filename().string() + "##recent" + std::to_string(i)).c_str())) chosen = file.string();
    noteItem("recent " + file.filename().string(), ui);
    tip(file.string());
  }
  ImGui::Separator();
  return chosen;
}

// A typed name counts from the folder that is shown.
std::string typedPath(const FileBrowser& browser) {
  const fs::path name(browser.name.data());
  if (name.empty()) return browser.what == BrowseFor::kParts ? browser.folder : "";
  fs::path whole = name.is_absolute() ? name : fs::path(browser.folder) / name;
  if (browser.what == BrowseFor::kSaveScene && whole.extension().empty()) whole += ".json";
  return whole.lexically_normal().string();
}

void setPath(const std::string& text, std::array<char, 512>& path) {
  path.fill(0);
  std::copy_n(text.begin(), std::min(text.size(), path.size() - 1), path.begin());
}

void postMap(const std::string& file, Demo& demo, UiState& ui) {
  if (ui.brush.field < 0) return;
  ui.field = {};  // the file may have changed
  postRequest(demo, {Ask::kMap, std::string(kFieldNames[static_cast<std::size_t>(ui.brush.field)]), file});
}

void take(const std::string& file, Demo& demo, UiState& ui) {
  FileBrowser& browser = ui.browser;
  std::error_code ignored;
  if (browser.what != BrowseFor::kParts && fs::is_directory(file, ignored)) {
    setName("", browser);
    return goTo(file, browser);
  }
  if (browser.what == BrowseFor::kSaveScene && fs::exists(file, ignored) && browser.to_replace != file) {
    browser.to_replace = file;
    browser.opened = true;  // the next Enter is the name's again
    return;
  }
  switch (browser.what) {
    case BrowseFor::kNothing:
      break;
    case BrowseFor::kOpen:
      openFile(file, demo, ui);
      break;
    case BrowseFor::kMotion:
      setPath(file, ui.motion_path);
      if (!file.ends_with(".mot")) openFile(file, demo, ui);
      break;
    case BrowseFor::kParts:
      setPath(file, ui.parts_path);
      postRequest(demo, {Ask::kMotionFile, file, ui.motion_path.data()});
      break;
    case BrowseFor::kHair:
    case BrowseFor::kEnvironment:
      openFile(file, demo, ui);
      break;
    case BrowseFor::kWorn:
      postRequest(demo, {Ask::kAttach, "add", file});
      ui.asked.push_back(file);
      break;
    case BrowseFor::kMap:
      postMap(file, demo, ui);
      break;
    case BrowseFor::kSaveScene:
      postRequest(demo, {browser.project ? Ask::kSaveProject : Ask::kSaveScene, "", file});
      browser.last = browser.saving = file;
      ui.asked.push_back(file);
      break;
  }
  close(browser);
}

bool willReplace(const FileBrowser& browser) {
  return !browser.to_replace.empty() && browser.to_replace == typedPath(browser);
}

void nameRow(Demo& demo, UiState& ui, std::string chosen) {
  FileBrowser& browser = ui.browser;
  const std::string typed = typedPath(browser);
  const bool replaces = willReplace(browser);
  if (replaces) {
    const bool loses = browser.what == BrowseFor::kSaveScene && !browser.project && holdsProject(typed);
    ImGui::TextUnformatted(
        loses ? "A project is there already; Enter again puts a scene in its place, without the moving hair"
              : "A file of this name is there already; Enter again replaces it");
    noteItem("replaces", ui);
  }
  const float button = 74 * ui.text_scale;
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - 2 * button - 10);
  if (std::exchange(browser.opened, false)) ImGui::SetKeyboardFocusHere();
  constexpr ImGuiInputTextFlags kFlags = ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll;
  const bool entered = ImGui::InputTextWithHint("##file_name", "name or path, then Enter", browser.name.data(),
                                                browser.name.size(), kFlags);
  noteItem("file_name", ui);
  ImGui::SameLine(0, 5);
  const bool pressed = ImGui::Button(replaces ? "Replace" : purposeOf(browser.what).button, {button, 0});
  noteItem("file_take", ui);
  ImGui::SameLine(0, 5);
  const bool cancelled = ImGui::Button("Cancel", {button, 0});
  noteItem("file_cancel", ui);
  if (chosen.empty() && (entered || pressed)) chosen = typed;
  if (cancelled) return close(browser);
  if (!chosen.empty()) take(chosen, demo, ui);
}

// Unless something else is asked for meanwhile.
void nameAgain(const std::string& file, UiState& ui) {
  if (ui.browser.what != BrowseFor::kNothing) return;
  browseFor(BrowseFor::kSaveScene, ui);
  setName(file, ui.browser);
}

}  // namespace

void browseFor(BrowseFor what, UiState& ui) {
  FileBrowser& browser = ui.browser;
  browser.what = what;
  browser.opened = true;
  browser.to_replace.clear();
  setName("", browser);
  std::erase_if(ui.recent, [](const std::string& file) {
    std::error_code ignored;
    return !fs::exists(file, ignored);
  });
  goTo(browser.folder.empty() ? "." : browser.folder, browser);
}

void browseToSave(const Demo& demo, UiState& ui) {
  FileBrowser& browser = ui.browser;
  const bool named = !browser.last.empty() && stem(browser.last) == demo.scene.name;
  const fs::path file(named ? browser.last : demo.scene.file);
  const bool own = file.string().starts_with(dataPath("assets"));  // the program's are not written over by two presses
  std::error_code ignored;
  if (!file.empty() && !own) {
    browser.folder = file.has_parent_path() ? file.parent_path().string() : ".";
  } else if (browser.folder == fs::weakly_canonical(ui.kept_folder, ignored)) {
    browser.folder.clear();  // it is for what is kept by itself
  }
  browseFor(BrowseFor::kSaveScene, ui);
  if (!own && fs::exists(file, ignored)) browser.project = holdsProject(file.string());
  // A scene has no strokes on tied hair.
  browser.project |= std::ranges::any_of(
      demo.actors, [](const Actor& actor) { return !actor.spec.ties.empty() && reshapedByHand(*actor.haircut); });
  setName(file.empty() ? demo.scene.name : own ? file.stem().string() : file.filename().string(), browser);
}

void openFile(const std::string& file, Demo& demo, UiState& ui) {
  // A picture paints the field that is chosen.
  if (ui.brush.field >= 0 && endingOf(file) == ".png") return postMap(file, demo, ui);
  if (file.ends_with(".json")) ui.browser.last = file;
  postRequest(demo, {Ask::kOpenFile, "", file});
  ui.asked.push_back(file);
}

void noteFiles(Demo& demo, UiState& ui) {
  for (const FileEnd& end : std::exchange(demo.file_ends, {})) {
    if (end.file == ui.to_go_on_from) {
      ui.gone_on_from = end.done ? end.file : "";
      ui.to_go_on_from.clear();
      if (end.done) demo.edits.saved = kNeverSaved;
    }
    if (end.file == ui.browser.saving) {
      ui.browser.saving.clear();
      if (!end.done) nameAgain(end.file, ui);
    }
    if (std::erase(ui.asked, end.file) == 0) continue;
    (end.done ? noteRecent : forgetRecent)(end.file, ui.kept_folder, ui.recent);
  }
}

void filePanel(Demo& demo, UiState& ui) {
  if (ui.browser.what == BrowseFor::kNothing) return;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float scale = ui.text_scale, margin = 12 * scale;
  const ImVec2 wanted(std::min(kWidth * scale, size.x - 2 * margin), std::min(kHeight * scale, size.y - 2 * margin));
  ImGui::SetNextWindowPos({0.5f * size.x, 0.5f * size.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({std::max(32.0f, wanted.x), std::max(32.0f, wanted.y)});
  const ImGuiWindowFlags flags =
      ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse;
  ImGui::SetNextWindowBgAlpha(1);
  if (ImGui::Begin("files", nullptr, flags)) {
    ImGui::PushTextWrapPos(0);
    const bool project = ui.browser.what == BrowseFor::kSaveScene && ui.browser.project;
    ImGui::TextUnformatted(project ? "Save the project: the scene, with the hair as it moves and its brushed shape"
                                   : purposeOf(ui.browser.what).title);
    ImGui::PopTextWrapPos();
    if (ui.browser.what == BrowseFor::kSaveScene) {
      // The keyboard goes on to the name.
      if (ImGui::Checkbox("As a project", &ui.browser.project)) ui.browser.opened = true;
      noteItem("as_project", ui);
      tip("With the hair as it moves and its brushed shape");
    }
    placesRow(ui);
    std::string chosen;
    const float words = willReplace(ui.browser) ? ImGui::GetTextLineHeightWithSpacing() : 0;
    const float below = ImGui::GetFrameHeightWithSpacing() + words;
    if (ImGui::BeginChild("list", {0, -below}, true)) {
      if (ui.browser.what == BrowseFor::kOpen && !ui.recent.empty()) chosen = recentList(ui);
      if (const std::string entry = entryList(ui); !entry.empty()) chosen = entry;
    }
    ImGui::EndChild();
    nameRow(demo, ui, chosen);
  }
  ImGui::End();
}

}  // namespace app

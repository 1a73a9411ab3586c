// Fonts and colours of the panels.
#include <imgui/imgui.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/files/json_reader.h"
#include "app/files/text_file.h"
#include "app/ui/ui.h"

namespace app {

namespace {

// The first that is installed; Roboto is in the list of packages that ./run looks after.
const char* const kTextFonts[] = {"/usr/share/fonts/truetype/roboto/unhinted/RobotoTTF/Roboto-Regular.ttf",
                                  "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"};
const char* const kHeadingFonts[] = {"/usr/share/fonts/truetype/roboto/unhinted/RobotoTTF/Roboto-Medium.ttf",
                                     "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf"};

template <std::size_t N>
ImFont* addFont(const char* const (&files)[N], float size) {
  ImFontAtlas* atlas = ImGui::GetIO().Fonts;
  for (const char* file : files) {
    if (std::filesystem::exists(file)) return atlas->AddFontFromFileTTF(file, size);
  }
  return atlas->AddFontDefault();
}

void setColors(ImGuiStyle& style) {
  const ImVec4 ground(0.075f, 0.080f, 0.092f, 0.93f), raised(0.155f, 0.165f, 0.185f, 1),
      hover(0.215f, 0.225f, 0.25f, 1);
  const ImVec4 pressed(0.26f, 0.27f, 0.30f, 1), text(0.90f, 0.90f, 0.91f, 1), dim(0.55f, 0.57f, 0.60f, 1);
  const ImVec4 copper(0.86f, 0.56f, 0.36f, 1), copper_lit(0.93f, 0.66f, 0.46f, 1), line(1, 1, 1, 0.07f);
  ImGui::StyleColorsDark(&style);
  ImVec4* c = style.Colors;
  c[ImGuiCol_Text] = text;
  c[ImGuiCol_TextDisabled] = dim;
  c[ImGuiCol_WindowBg] = ground;
  c[ImGuiCol_PopupBg] = {0.10f, 0.106f, 0.12f, 0.98f};
  c[ImGuiCol_ChildBg] = {0, 0, 0, 0};
  c[ImGuiCol_Border] = line;
  c[ImGuiCol_Separator] = line;
  c[ImGuiCol_FrameBg] = {0.125f, 0.132f, 0.15f, 1};
  c[ImGuiCol_FrameBgHovered] = {0.165f, 0.175f, 0.195f, 1};
  c[ImGuiCol_FrameBgActive] = {0.185f, 0.195f, 0.215f, 1};
  c[ImGuiCol_Button] = raised;
  c[ImGuiCol_ButtonHovered] = hover;
  c[ImGuiCol_ButtonActive] = pressed;
  c[ImGuiCol_Header] = {1, 1, 1, 0.045f};
  c[ImGuiCol_HeaderHovered] = {1, 1, 1, 0.085f};
  c[ImGuiCol_HeaderActive] = {1, 1, 1, 0.12f};
  c[ImGuiCol_Tab] = {0, 0, 0, 0};
  c[ImGuiCol_TabHovered] = hover;
  c[ImGuiCol_TabActive] = raised;
  c[ImGuiCol_TitleBg] = c[ImGuiCol_TitleBgActive] = c[ImGuiCol_TitleBgCollapsed] = ground;
  c[ImGuiCol_SliderGrab] = {0.78f, 0.51f, 0.33f, 1};
  c[ImGuiCol_SliderGrabActive] = copper;
  c[ImGuiCol_NavHighlight] = copper_lit;
  c[ImGuiCol_CheckMark] = copper_lit;
  c[ImGuiCol_PlotHistogram] = copper;
  c[ImGuiCol_ScrollbarBg] = {0, 0, 0, 0};
  c[ImGuiCol_ScrollbarGrab] = {1, 1, 1, 0.14f};
  c[ImGuiCol_ScrollbarGrabHovered] = {1, 1, 1, 0.22f};
  c[ImGuiCol_ScrollbarGrabActive] = {1, 1, 1, 0.3f};
  c[ImGuiCol_TextSelectedBg] = {0.86f, 0.56f, 0.36f, 0.35f};
}

// As the scene calls itself once it is open.
std::string sceneName(const std::string& file) {
  try {
    const nlohmann::json scene = parseJson(readText(file), file);
    if (const auto name = scene.find("name"); name != scene.end() && name->is_string()) return name->get<std::string>();
  } catch (const InputError&) {  // said when it is opened
  }
  return stem(file);
}

}  // namespace

float fittingTextScale(float wanted, int width, int height) {
  constexpr float kMinWidth = 400, kMinHeight = 300;  // points
  const float room = std::min(static_cast<float>(width) / kMinWidth, static_cast<float>(height) / kMinHeight);
  return std::clamp(wanted <= room ? wanted : std::floor(8 * room) / 8, 0.5f, 4.0f);
}

void prepareUi(float text_scale, UiState& ui) {
  ui.text_scale = text_scale;
  ImGuiIO& io = ImGui::GetIO();
  // Window places are this program's own affair; no file is left in the working folder.
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
  io.Fonts->Clear();
  addFont(kTextFonts, 15 * text_scale);
  ui.heading = addFont(kHeadingFonts, 18 * text_scale);
  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();
  setColors(style);
  style.WindowRounding = 8;
  style.ChildRounding = style.FrameRounding = style.PopupRounding = style.GrabRounding = style.TabRounding = 4;
  style.WindowBorderSize = 1;
  style.FrameBorderSize = 1;
  style.WindowPadding = {12, 10};
  style.FramePadding = {7, 4};
  style.ItemSpacing = {7, 5};
  style.ScrollbarSize = 11;
  style.GrabMinSize = 10;
  style.WindowMenuButtonPosition = ImGuiDir_Right;
  style.ScaleAllSizes(text_scale);
  ui.scenes = listAssets("scenes", {".json"});
  ui.scene_names.clear();
  for (const std::string& file : ui.scenes) ui.scene_names.push_back(sceneName(file));
  ui.presets = listAssets("presets", {".json"});
  ui.clips = listAssets("clips", {".bvh", ".glb", ".gltf", ".fbx"});
  ui.hairs = listAssets("hair", {".obj"});
  ui.attachments = listAssets("attachments", {".obj", ".glb", ".gltf", ".fbx"});
}

}  // namespace app

// The brushes: their settings, the ring on the hair, and the strokes that a drag makes.
#include <imgui/imgui.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/scene/edit/groom_brush.h"
#include "app/scene/edit/paint_brush.h"
#include "app/scene/edit/picking.h"
#include "app/scene/edit/tie_list.h"
#include "app/ui/ui_panels.h"
#include "app/ui/ui_widgets.h"

namespace app {

namespace {

constexpr double kMinWay = 0.0015;  // m between two samples of combing
constexpr int kRingPoints = 48;
constexpr double kWeak = 0.45, kHidden = 0.2;  // of a ring's opacity: of the mirrored one, of one behind the head

Rigid worldToScalp(const Actor& actor) {
  return scalpToWorld(actor.body->character, actor.pose).inverse(Eigen::Isometry);
}

bool paintsColor(const BrushState& brush) {
  return brush.field >= 0 && kFieldNames[static_cast<std::size_t>(brush.field)] == "color";
}

// Whether the head lies between the eye and a point: the way to it comes inside the scalp before its end.
bool behindHead(const Vec3& point, const Camera& camera, const Actor& actor) {
  constexpr double kWithin = 0.95;  // of the scalp's radius: roots lie on it
  const Scalp& scalp = actor.body->character.scalp;
  const Rigid to_scalp = worldToScalp(actor);
  const Vec3 eye = to_scalp * (camera.anchor + camera.target + camera.distance * viewBack(camera));
  const Vec3 way = to_scalp * point - eye;
  const double nearest = std::clamp((scalp.center - eye).dot(way) / std::max(way.squaredNorm(), 1e-12), 0.0, 1.0);
  const Vec3 off = eye + nearest * way - scalp.center;
  return off.norm() < kWithin * scalp.radiusAt(off);
}

// Where a brush at a place acts as well: seen in the plane that parts the head. m, world.
Vec3 acrossHead(const Vec3& place, const Actor& actor) {
  const Rigid to_scalp = worldToScalp(actor);
  return to_scalp.inverse(Eigen::Isometry) * mirrored(to_scalp * place, actor.body->character.scalp.center.x());
}

// The most that a brush reaches of a point, its mirrored one included.
double reachOf(const Vec3& point, const Vec3& place, const BrushState& brush, const Actor& actor) {
  Brush reach;
  reach.at = place, reach.radius = brush.radius, reach.falloff = brush.falloff;
  const double own = brushReach(reach, point);
  reach.at = acrossHead(place, actor);
  return brush.mirror ? std::max(own, brushReach(reach, point)) : own;
}

// White where there is none, or where its file is no longer there.
ColorMap readShownField(const std::string& picture, bool colors) {
  const FieldMap white{1, 1, {1}, {}};
  if (picture.empty()) return {white, white, white};
  try {
    if (colors) return readColorMap(picture);
    const FieldMap grey = readFieldMap(picture);
    return {grey, grey, grey};
  } catch (const InputError&) {
    return {white, white, white};
  }
}

// The painted field at the roots, in the colours of its picture; under the ring brighter.
void drawField(const Vec3& place, const Demo& demo, UiState& ui) {
  const Picture shown = shownPicture(demo);
  const Actor& actor = selectedActor(demo);
  const BrushState& brush = ui.brush;
  const float scale = ui.text_scale;
  const std::string field(kFieldNames[static_cast<std::size_t>(brush.field)]);
  const std::string& picture = mapOf(field, actor.spec.maps);
  if (ui.field.map[0].value.empty() || ui.field.picture != field + picture)
    ui.field = {field + picture, readShownField(picture, paintsColor(brush))};
  const ColorMap& map = ui.field.map;
  const sim::HairMesh& mesh = actor.haircut->mesh;
  for (int c = 0; c < mesh.columnCount(); ++c) {
    const auto root = static_cast<std::size_t>(mesh.shape.column_first[static_cast<std::size_t>(c)]);
    if (behindHead(actor.hair.positions[root + 1], demo.camera, actor)) continue;
    const Vec3 direction = mesh.shape.positions[root] - actor.body->character.scalp.center;
    const auto shade = [&](std::size_t channel) { return static_cast<int>(255 * map[channel].at(direction)); };
    double weight = 0;
    for (int k = 0; k < mesh.shape.columnLength(c); ++k)
      weight = std::max(weight, reachOf(actor.hair.positions[root + static_cast<std::size_t>(k)], place, brush, actor));
    const auto pixel = pixelOf(actor.hair.positions[root + 1], shown, demo.camera);
    if (!pixel) continue;
    const ImVec2 at(static_cast<float>((*pixel)[0]), static_cast<float>((*pixel)[1]));
    ImDrawList* list = ImGui::GetBackgroundDrawList();
    list->AddCircleFilled(at, 4.2f * scale, weight > 0.02 ? IM_COL32(240, 172, 120, 235) : IM_COL32(20, 20, 24, 200),
                          12);
    list->AddCircleFilled(at, 3.0f * scale, IM_COL32(shade(0), shade(1), shade(2), 255), 12);
  }
}

// `opacity`: 0..1.
void drawRing(const std::string& name, const Vec3& place, double opacity, const Demo& demo, UiState& ui) {
  const Picture shown = shownPicture(demo);
  const double radius = ui.brush.tie ? ui.brush.tie_radius : ui.brush.radius;
  const float scale = ui.text_scale;
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  const Vec3 back = viewBack(demo.camera), right = Vec3::UnitY().cross(back).normalized(), up = back.cross(right);
  ImVec2 ring[kRingPoints];
  for (int k = 0; k < kRingPoints; ++k) {
    const double turn = 2 * 3.14159265358979 * k / kRingPoints;
    const auto pixel = pixelOf(place + radius * (std::cos(turn) * right + std::sin(turn) * up), shown, demo.camera);
    if (!pixel) return;
    ring[k] = {static_cast<float>((*pixel)[0]), static_cast<float>((*pixel)[1])};
  }
  const int dark = static_cast<int>(150 * opacity), light = static_cast<int>(235 * opacity);
  list->AddPolyline(ring, kRingPoints, IM_COL32(20, 20, 24, dark), ImDrawFlags_Closed, 3.5f * scale);
  list->AddPolyline(ring, kRingPoints, IM_COL32(240, 172, 120, light), ImDrawFlags_Closed, 1.6f * scale);
  const ImVec2 middle(0.5f * (ring[0].x + ring[kRingPoints / 2].x), 0.5f * (ring[0].y + ring[kRingPoints / 2].y));
  noteMark(name, middle.x, middle.y,
           0.5f * std::hypot(ring[0].x - ring[kRingPoints / 2].x, ring[0].y - ring[kRingPoints / 2].y), ui);
}

// What the brush reaches: its ring, the mirrored one weaker, and a dot at each vertex, the brighter the more it is
// moved.
void drawReach(const Vec3& place, const Demo& demo, UiState& ui) {
  const BrushState& brush = ui.brush;
  const Picture shown = shownPicture(demo);
  const Actor& actor = selectedActor(demo);
  const float scale = ui.text_scale;
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  if (brush.mirror) {
    const Vec3 across = acrossHead(place, actor);
    drawRing("mirror_ring", across, behindHead(across, demo.camera, actor) ? kHidden : kWeak, demo, ui);
  }
  drawRing("brush_ring", place, 1, demo, ui);
  Brush reach;
  reach.at = place, reach.radius = brush.radius, reach.falloff = brush.falloff;
  const std::vector<float>& frozen = actor.haircut->frozen;
  for (std::size_t v = 0; v < actor.hair.positions.size(); ++v) {
    const Vec3& p = actor.hair.positions[v];
    const double own = brushReach(reach, p), weight = std::max(own, kWeak * reachOf(p, place, brush, actor));
    const float held = frozen.empty() ? 0 : frozen[v];
    if ((weight <= 0.02 && held <= 0.02f) || behindHead(p, demo.camera, actor)) continue;
    const auto pixel = pixelOf(p, shown, demo.camera);
    if (!pixel) continue;
    const ImVec2 at(static_cast<float>((*pixel)[0]), static_cast<float>((*pixel)[1]));
    const int alpha = static_cast<int>(40 + 180 * std::max(weight, double(held)));
    list->AddCircleFilled(at, 1.6f * scale,
                          held > 0.02f ? IM_COL32(120, 190, 255, alpha) : IM_COL32(255, 214, 170, alpha), 8);
  }
}

void postSample(const Vec3& at, const Vec3& along, Demo& demo, const BrushState& brush) {
  BrushSample sample;
  sample.tool = static_cast<BrushTool>(brush.tool);
  sample.at = at, sample.along = along;
  sample.radius = brush.radius, sample.strength = brush.strength, sample.falloff = brush.falloff;
  sample.mirror = brush.mirror;
  postRequest(demo, {Ask::kBrush, std::string(kBrushNames[static_cast<std::size_t>(brush.tool)]), brushText(sample)});
}

void postPaint(const Vec3& at, Demo& demo, const BrushState& brush) {
  const std::string field(kFieldNames[static_cast<std::size_t>(brush.field)]);
  PaintSample sample{field, at, brush.radius, brush.strength, brush.falloff, brush.mirror, brush.value};
  for (std::size_t c = 0; c < 3; ++c) sample.color[c] = static_cast<double>(brush.color[c]);
  postRequest(demo, {Ask::kPaint, field, paintText(sample)});
}

// What a brush does while the button is held goes by time, as at 60 frames a second; of slower frames than 15 a part is
// left out, for edits take time themselves.
int samplesAFrame() {
  return std::clamp(static_cast<int>(std::lround(60 * ImGui::GetIO().DeltaTime)), 1, 4);
}

// One frame of a drag. Combing moves by the way of the hand; the others act as long as the button is held. While the
// hair is made anew nothing acts: a stroke is for the hair that is seen.
void stroke(const Ray& ray, const std::optional<Vec3>& hit, Demo& demo, BrushState& brush) {
  const Rigid to_scalp = worldToScalp(selectedActor(demo));
  const bool acts = !demo.loading.running.valid();
  if (brush.field >= 0) {
    for (int k = 0; acts && hit && k < samplesAFrame(); ++k) postPaint(to_scalp * *hit, demo, brush);
    return;
  }
  if (brush.tool != static_cast<int>(BrushTool::kComb)) {
    for (int k = 0; acts && hit && k < samplesAFrame(); ++k) postSample(to_scalp * *hit, Vec3::Zero(), demo, brush);
    return;
  }
  const Vec3 last = to_scalp.inverse(Eigen::Isometry) * brush.last;
  const Vec3 now = pointInPlane(ray, last, viewBack(demo.camera)), way = now - last;
  if (way.norm() < kMinWay) return;
  if (acts) postSample(brush.last, to_scalp.linear() * way, demo, brush);
  brush.last = to_scalp * now;
}

}  // namespace

namespace {

void paintRow(UiState& ui) {
  BrushState& brush = ui.brush;
  const auto row = [&](std::initializer_list<Segment> fields, int before) {
    const int pressed = segments("paint", fields, brush.field - before, ui);
    if (pressed < 0) return;
    brush.field = before + pressed;
    if (brush.field >= 0) brush.tool = -1, ui.select.element = -1;
  };
  // Each draws a field over the scalp towards a value, at the roots of the hair within the ring.
  row({"No paint",
       {"Stiff", "Paints how stiff the hair is, as a share of the parameters' stiffness"},
       {"Length", "Paints how long the hair is, as a share of the style's"},
       {"Density", "Paints how many strands grow there, as a share"},
       {"Mass", "Paints how heavy the hair is, as a share"}},
      -1);
  row({{"Bend", "Paints the resistance to bending alone, as a share"},
       {"Width", "Paints how thick the strands are, as a share"},
       {"Clump", "Paints how far strands gather to locks, as a share"}},
      4);
  row({{"Curl", "Paints how wide the curls are, as a share; without curls nothing shows"},
       {"Color", "Paints a pigment over the hair's own color"},
       {"Rough", "Paints how wide the highlights are, as a share"},
       {"Damp", "Paints how soon the hair's own motion dies away, as a share of the parameters' damping"},
       {"Frizz", "Paints the frizz's height, as a share"}},
      7);
}

// The field's picture, from a file or none.
void fieldFileRow(Demo& demo, UiState& ui) {
  const std::string field(kFieldNames[static_cast<std::size_t>(ui.brush.field)]);
  const std::string& picture = mapOf(field, selectedActor(demo).spec.maps);
  rowLabel("From a file",
           "A picture of the unrolled head (PNG), or a head with coloured vertices (OBJ, PLY, glTF, FBX)");
  if (ImGui::Button("Open...##map")) browseFor(BrowseFor::kMap, ui);
  noteItem("open map", ui);
  ImGui::SameLine(0, 5);
  ImGui::BeginDisabled(picture.empty());
  if (ImGui::Button("None##map")) postRequest(demo, {Ask::kMap, field, ""});
  ImGui::EndDisabled();
  noteItem("no map", ui);
  ImGui::SameLine(0, 8);
  ImGui::TextDisabled("%s", picture.empty() ? "white" : isPictureText(picture) ? "painted" : stem(picture).c_str());
}

void colorRow(UiState& ui) {
  rowLabel("Color", "Share of the light that passes through pigment: white leaves the hair its own color");
  ImGui::SetNextItemWidth(-1);
  ImGui::ColorEdit3("##brush_color", ui.brush.color.data(), ImGuiColorEditFlags_DisplayRGB);
  noteItem("brush_color", ui);
}

// Colours at the root, half-way and at the tip.
void colorCurveRows(const FieldCurves& curves, Demo& demo, UiState& ui) {
  constexpr std::array kPlaces{"Color, root", "Color, middle", "Color, tip"};
  std::array<std::array<float, 3>, 3> colors;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::array<double, 3> light = colorAt(curves.color, 0.5 * static_cast<double>(k));
    for (std::size_t c = 0; c < 3; ++c) colors[k][c] = static_cast<float>(pictureValue(light[c]));
  }
  bool changed = false;
  for (std::size_t k = 0; k < 3; ++k) {
    rowLabel(kPlaces[k], "Share of the light that passes through pigment; white leaves it as it is");
    ImGui::SetNextItemWidth(-1);
    const std::string name = "curve_color" + std::to_string(k);
    changed |= ImGui::ColorEdit3(("##" + name).c_str(), colors[k].data(), ImGuiColorEditFlags_DisplayRGB);
    noteItem(name, ui);
  }
  if (!changed) return;
  std::string text;
  for (const std::array<float, 3>& color : colors) {
    std::array<char, 8> hex{};
    const auto byte = [&](std::size_t c) {
      return static_cast<unsigned>(std::lround(255 * std::clamp(color[c], 0.0f, 1.0f)));
    };
    std::snprintf(hex.data(), hex.size(), "#%02x%02x%02x", byte(0), byte(1), byte(2));
    text.append(text.empty() ? "" : ",").append(hex.data());
  }
  postRequest(demo, {Ask::kCurve, "color", text});
}

}  // namespace

void brushSection(Demo& demo, UiState& ui) {
  BrushState& brush = ui.brush;
  const int pressed = segments("brush",
                               {"Off",
                                {"Comb", "Turns the hair along the stroke; lengths stay"},
                                {"Cut", "Cuts the hair back to where the ring is"},
                                {"Grow", "Makes the hair longer"},
                                {"Smooth", "Evens bends and differences between neighbours"},
                                {"Puff", "Lifts the hair off the head"}},
                               brush.tool + 1, ui);
  if (pressed >= 0) brush.tool = pressed - 1, brush.field = -1, ui.select.element = -1;
  const int second = segments("brush",
                              {{"Pinch", "Draws the hair together towards the ring's middle"},
                               {"Spread", "Drives it apart from there"},
                               {"Push", "Pushes the hair out of the body"},
                               {"Twist", "Winds the hair about its own line"},
                               {"Freeze", "Keeps the hair from being changed by other brushes"},
                               {"Thaw", "Lets it be changed again"}},
                              brush.tool - 5, ui);
  if (second >= 0) brush.tool = second + 5, brush.field = -1, ui.select.element = -1;
  paintRow(ui);
  selectRow(demo, ui);
  ImGui::BeginDisabled(brush.tool < 0 && brush.field < 0 && ui.select.element < 0);
  const auto row = [&](const char* label, const char* help, const char* name, float low, float high, const char* format,
                       double shown_scale, double& value) {
    rowLabel(label, help);
    ImGui::SetNextItemWidth(-1);
    float shown = static_cast<float>(shown_scale * value);
    const MarksBelowDigits marks;
    if (ImGui::SliderFloat(name, &shown, low, high, format, ImGuiSliderFlags_AlwaysClamp)) value = shown / shown_scale;
    noteItem(name, ui);
  };
  row("Radius", "[ and ] change it", "brush_radius", 5, 200, "%.0f mm", 1000, brush.radius);
  row("Strength", "Share of the way that the middle of the brush takes", "brush_strength", 0.02f, 1, "%.2f", 1,
      brush.strength);
  row("Falloff", "0: all within the ring alike; larger: softer edge", "brush_falloff", 0, 4, "%.1f", 1, brush.falloff);
  if (paintsColor(brush)) colorRow(ui);
  if (brush.field >= 0 && !paintsColor(brush))
    row("Value", "Painted share: 1 is the parameter's own value, 0 its least", "brush_value", 0, 1, "%.2f", 1,
        brush.value);
  if (brush.field >= 0) fieldFileRow(demo, ui);
  rowLabel("Mirror", "Acts on the other side of the head as well");
  ImGui::Checkbox("##brush_mirror", &brush.mirror);
  noteItem("brush_mirror", ui);
  ImGui::EndDisabled();
}

void curveRows(Demo& demo, UiState& ui) {
  const FieldCurves& curves = selectedActor(demo).spec.curves;
  const auto row = [&](const char* label, const std::string& name, const std::vector<double>& curve) {
    rowLabel(label, "Shares of the value at the root, half-way and at the tip");
    std::array<float, 3> shares;
    for (std::size_t k = 0; k < 3; ++k) shares[k] = static_cast<float>(curveAt(curve, 0.5 * static_cast<double>(k)));
    ImGui::SetNextItemWidth(-1);
    if (ImGui::SliderFloat3(("##curve_" + name).c_str(), shares.data(), 0.05f, 3, "%.2f",
                            ImGuiSliderFlags_AlwaysClamp)) {
      std::string text;
      for (const float share : shares) text.append(text.empty() ? "" : ",").append(std::to_string(share));
      postRequest(demo, {Ask::kCurve, name, text});
    }
    noteItem("curve_" + name, ui);
  };
  for (const std::string_view name : kCurveNames) {
    std::string label(name);
    label[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(label[0])));
    if (name == "color")
      colorCurveRows(curves, demo, ui);
    else
      row(label.c_str(), std::string(name), curveOf(name, curves));
  }
}

namespace {

// m, scalp frame, to a tenth of a millimetre: a ring of the whole hair, or with Mirror one of each side.
std::vector<TieSpec> tieAt(const Vec3& at, const BrushState& brush, const Actor& actor) {
  const Vec3 place = (1e4 * at).array().round() / 1e4;
  TieSpec tie;
  tie.at = place;
  tie.radius = brush.tie_radius;
  if (!brush.mirror) return {tie};
  const double middle = actor.body->character.scalp.center.x();
  const bool left = place.x() > middle;
  tie.side = left ? "left" : "right";
  TieSpec other = tie;
  other.at = ((1e4 * mirrored(place, middle)).array().round() / 1e4).matrix();
  other.side = left ? "right" : "left";
  return {tie, other};
}

// Once, for it soon is a habit to turn the camera so with a brush in hand.
void sayOffHair(Demo& demo, BrushState& brush) {
  if (std::exchange(brush.off_hair_said, true)) return;
  demo.message = "no hair under the pointer: a drag from here turns the camera";
  demo.message_is_fault = false;
}

// A ring that goes with the pointer over the hair, and is tied where the button is let go.
void tieFrame(bool begins, Demo& demo, UiState& ui) {
  BrushState& brush = ui.brush;
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantCaptureMouse && !brush.stroking) return;
  const Actor& actor = selectedActor(demo);
  const auto hit = pickHair(rayThrough(io.MousePos.x, io.MousePos.y, shownPicture(demo), demo.camera), actor);
  brush.over_hair = hit.has_value();
  brush.stroking = brush.stroking || (begins && hit);
  if (begins && !hit) sayOffHair(demo, brush);
  if (hit) brush.last = worldToScalp(actor) * *hit;
  if (!brush.stroking && !hit) return;
  const Vec3 place = worldToScalp(actor).inverse(Eigen::Isometry) * brush.last;
  if (brush.mirror && !brush.tie_moves) drawRing("mirror_ring", acrossHead(place, actor), kWeak, demo, ui);
  drawRing("tie_ring", place, 1, demo, ui);
  if (!brush.stroking || brush.held) return;
  brush.stroking = brush.tie = false;
  std::vector<TieSpec> ties = actor.spec.ties;
  const auto picked = static_cast<std::size_t>(std::max(brush.tie_picked, 0));
  if (brush.tie_moves && picked < ties.size())
    ties[picked].at = tieAt(brush.last, brush, actor).front().at;
  else
    ties = withRings(std::move(ties), tieAt(brush.last, brush, actor), actor.body->character.scalp);
  postRequest(demo, {Ask::kTie, "", writeTies(ties).dump()});
}

}  // namespace

void brushFrame(Demo& demo, UiState& ui) {
  BrushState& brush = ui.brush;
  const ImGuiIO& io = ImGui::GetIO();
  const bool held = io.MouseDown[0], begins = held && !brush.held;
  brush.held = held;
  brush.over_hair = false;
  if (brush.tool >= 0 || brush.field >= 0 || ui.select.element >= 0) brush.tie = false;
  if (brush.tie && io.DisplaySize.y >= 1) return tieFrame(begins, demo, ui);
  if (ui.select.element >= 0 && io.DisplaySize.y >= 1) return selectFrame(begins, demo, ui);
  if ((brush.tool < 0 && brush.field < 0) || (io.WantCaptureMouse && !brush.stroking) || io.DisplaySize.y < 1) {
    brush.stroking = false;
    return;
  }
  const Ray ray = rayThrough(io.MousePos.x, io.MousePos.y, shownPicture(demo), demo.camera);
  const std::optional<Vec3> hit = pickHair(ray, selectedActor(demo));
  brush.over_hair = hit.has_value();
  if (begins && hit) {
    brush.stroking = true;
    brush.last = worldToScalp(selectedActor(demo)) * *hit;
  } else if (begins) {
    sayOffHair(demo, brush);
  }
  brush.stroking = brush.stroking && held;
  if (brush.stroking) stroke(ray, hit, demo, brush);
  const Vec3 combed = worldToScalp(selectedActor(demo)).inverse(Eigen::Isometry) * brush.last;
  if (brush.field >= 0) drawField(hit.value_or(Vec3::Constant(1e6)), demo, ui);
  if (hit || brush.stroking) drawReach(brush.stroking && !hit ? combed : *hit, demo, ui);
}

}  // namespace app

// Elements of the hair mesh: chosen by a click, moved by a drag or by arrow keys, and what the mesh's buttons ask for.
#include <imgui/imgui.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "app/scene/edit/groom_brush.h"
#include "app/scene/edit/hand_pins.h"
#include "app/scene/edit/mesh_change.h"
#include "app/scene/edit/picking.h"
#include "app/ui/ui_panels.h"
#include "app/ui/ui_widgets.h"

namespace app {

namespace {

constexpr double kMinMove = 0.001;                   // m between two samples of a drag
constexpr double kNudge = 0.002, kLongNudge = 0.01;  // m
constexpr double kShownReach = 0.02;                 // of a weight
constexpr int kChosenColor = 0, kHoverColor = 1, kMirrorColor = 2, kPinnedColor = 3;
constexpr double kMirrorShare = 0.45;  // of what is reached: across the mirror

MeshElement elementOf(const SelectState& select) {
  return static_cast<MeshElement>(select.element);
}

std::size_t numbersEach(const SelectState& select) {
  return elementOf(select) == MeshElement::kEdge ? 2 : 1;
}

// What was chosen of another mesh is chosen no more.
void followMesh(const Actor& actor, SelectState& select) {
  if (select.haircut != actor.haircut->id) select.chosen.clear(), select.led.clear();
  select.haircut = actor.haircut->id;
}

std::optional<ImVec2> screenPlace(const Vec3& point, const Demo& demo) {
  const auto pixel = pixelOf(point, shownPicture(demo), demo.camera);
  if (!pixel) return {};
  return ImVec2(static_cast<float>((*pixel)[0]), static_cast<float>((*pixel)[1]));
}

// Lines and dots over the picture; what lies behind the head's middle is faint.
class MeshOverlay {
 public:
  MeshOverlay(const Demo& demo, float scale)
      : demo_(demo), actor_(selectedActor(demo)), back_(viewBack(demo.camera)), scale_(scale) {
    middle_ = (scalpToWorld(actor_.body->character, actor_.pose) * actor_.body->character.scalp.center).dot(back_);
  }

  void line(int a, int b, int color) const {
    const Vec3 &p = place(a), &q = place(b);
    const auto from = screenPlace(p, demo_), to = screenPlace(q, demo_);
    if (!from || !to) return;
    ImDrawList* list = ImGui::GetBackgroundDrawList();
    const int alpha = std::min(alphaAt(p), alphaAt(q));
    list->AddLine(*from, *to, IM_COL32(20, 20, 24, alpha / 2), 4 * scale_);
    list->AddLine(*from, *to, tint(color, alpha), (color == kChosenColor ? 2.0f : 1.2f) * scale_);
  }
  void dot(int v, int color) const {
    const auto at = screenPlace(place(v), demo_);
    if (!at) return;
    ImDrawList* list = ImGui::GetBackgroundDrawList();
    const float radius = (color == kChosenColor ? 4.0f : 3.0f) * scale_;
    list->AddCircleFilled(*at, radius + 1.2f * scale_, IM_COL32(20, 20, 24, alphaAt(place(v))), 14);
    list->AddCircleFilled(*at, radius, tint(color, alphaAt(place(v))), 14);
  }
  void reached(int v, double weight) const {
    const auto at = screenPlace(place(v), demo_);
    if (!at) return;
    const int alpha = static_cast<int>((0.2 + 0.7 * weight) * alphaAt(place(v)));
    ImGui::GetBackgroundDrawList()->AddCircleFilled(*at, 1.8f * scale_, IM_COL32(255, 214, 170, alpha), 8);
  }

  const Demo& demo() const { return demo_; }

 private:
  const Vec3& place(int v) const { return actor_.hair.positions[static_cast<std::size_t>(v)]; }
  int alphaAt(const Vec3& p) const { return p.dot(back_) > middle_ ? 235 : 50; }
  static ImU32 tint(int color, int alpha) {
    if (color == kPinnedColor) return IM_COL32(110, 220, 205, alpha);
    if (color == kMirrorColor) return IM_COL32(240, 190, 150, std::max(40, alpha / 2));
    return color == kChosenColor ? IM_COL32(240, 150, 80, alpha) : IM_COL32(255, 255, 255, alpha);
  }

  const Demo& demo_;
  const Actor& actor_;
  Vec3 back_;
  float scale_;
  double middle_ = 0;
};

// A vertex, or its like on the other side.
using Like = std::function<int(int)>;

int itself(int v) {
  return v;
}

void drawElements(MeshElement element, std::span<const int> chosen, int color, const sim::HairMesh& mesh,
                  const MeshOverlay& overlay, const Like& like = itself) {
  const auto line = [&](int a, int b) { overlay.line(like(a), like(b), color); };
  switch (element) {
    case MeshElement::kVertex:
      break;
    case MeshElement::kEdge:
      for (std::size_t k = 0; k + 1 < chosen.size(); k += 2) line(chosen[k], chosen[k + 1]);
      break;
    case MeshElement::kColumn:
      for (const int c : chosen) {
        const int first = mesh.shape.column_first[static_cast<std::size_t>(c)];
        for (int v = first + 1; v < first + mesh.shape.columnLength(c); ++v) line(v - 1, v);
      }
      break;
    case MeshElement::kLayer:
      for (const int l : chosen) {
        for (const sim::Wall& wall : mesh.walls) {
          if (mesh.layer_of[static_cast<std::size_t>(wall.v[0])] == l) line(wall.v[0], wall.v[1]);
          if (mesh.layer_of[static_cast<std::size_t>(wall.v[2])] == l) line(wall.v[2], wall.v[3]);
        }
      }
      return;
  }
  for (const int v : verticesOf(element, chosen, mesh)) overlay.dot(like(v), color);
}

// The element under the pointer.
std::vector<int> elementAt(MeshElement element, const HairHit& hit, const Actor& actor) {
  const sim::HairMesh& mesh = actor.haircut->mesh;
  const sim::ExternalFace& face = mesh.external_faces[static_cast<std::size_t>(hit.face)];
  const auto corner = [&](int k) { return face.v[static_cast<std::size_t>(k % face.corner_count)]; };
  const auto place = [&](int k) -> const Vec3& { return actor.hair.positions[static_cast<std::size_t>(corner(k))]; };
  int nearest = 0, edge = 0;
  double at_vertex = INFINITY, at_edge = INFINITY;
  for (int k = 0; k < face.corner_count; ++k) {
    const Vec3 off = hit.at - place(k), way = place(k + 1) - place(k);
    const double share = std::clamp(off.dot(way) / std::max(1e-18, way.squaredNorm()), 0.0, 1.0);
    const double beside = (off - share * way).squaredNorm();
    if (off.squaredNorm() < at_vertex) at_vertex = off.squaredNorm(), nearest = corner(k);
    if (beside < at_edge) at_edge = beside, edge = k;
  }
  if (element == MeshElement::kEdge)
    return {std::min(corner(edge), corner(edge + 1)), std::max(corner(edge), corner(edge + 1))};
  if (element == MeshElement::kColumn) return {mesh.column_of[static_cast<std::size_t>(nearest)]};
  if (element == MeshElement::kLayer) return {mesh.layer_of[static_cast<std::size_t>(nearest)]};
  return {nearest};
}

// A click: alone it chooses what is under the pointer unless that is chosen already; with Shift it adds or takes away.
void choose(const std::vector<int>& element, bool adds, SelectState& select) {
  const std::size_t each = numbersEach(select);
  auto at = select.chosen.begin();
  while (at != select.chosen.end() && !std::equal(element.begin(), element.end(), at))
    at += static_cast<std::ptrdiff_t>(each);
  const bool is = at != select.chosen.end();
  if (is && adds) {
    select.chosen.erase(at, at + static_cast<std::ptrdiff_t>(each));
  } else if (!is) {
    if (!adds) select.chosen.clear();
    select.chosen.insert(select.chosen.end(), element.begin(), element.end());
  }
}

void postMove(const Vec3& along, Demo& demo, const UiState& ui) {
  if (ui.select.chosen.empty() || demo.loading.running.valid()) return;
  MoveSample sample{elementOf(ui.select), ui.select.chosen, along, ui.brush.radius, ui.brush.falloff, ui.brush.mirror};
  const std::string element(kElementNames[static_cast<std::size_t>(ui.select.element)]);
  postRequest(demo, {Ask::kMove, element, moveText(sample)});
}

// A drag begins at `at` (m, scalp frame).
void beginDrag(const Vec3& at, const Actor& actor, SelectState& select) {
  const sim::HairMesh& mesh = actor.haircut->mesh;
  select.from = at;
  select.said.clear();
  select.led = verticesOf(elementOf(select), select.chosen, mesh);
  std::erase_if(select.led, [&](int v) { return mesh.isRoot(v); });
  select.led_from.clear();
  for (const int v : select.led) select.led_from.push_back(mesh.shape.positions[static_cast<std::size_t>(v)]);
}

// Says how far what is dragged fell short of the pointer when that was at `asked` (m, scalp frame), and why.
void sayShortfall(const Vec3& asked, const Actor& actor, Demo& demo, SelectState& select) {
  constexpr double kShort = 0.001;  // m
  if (select.led.empty() || !actor.haircut->brushes) return;
  const std::vector<Vec3>& rest = actor.haircut->mesh.shape.positions;
  double least = INFINITY;
  for (std::size_t k = 0; k < select.led.size(); ++k) {
    const Vec3 gone = rest[static_cast<std::size_t>(select.led[k])] - select.led_from[k];
    least = std::min(least, (asked - select.from - gone).norm());
  }
  const bool ours = !select.said.empty() && demo.message == select.said;
  if (least < kShort) {
    if (ours) demo.message.clear();
    return;
  }
  const HeldBy by = actor.haircut->brushes->heldBy();
  if (by == HeldBy::kNothing && ours) return;
  select.said = std::to_string(std::lround(1e3 * least)) + " mm short of the pointer" + heldText(by);
  demo.message = select.said;
  demo.message_is_fault = false;
}

// Across the mirror, of what is chosen alone; one a vertex. Empty without a mirror.
std::vector<int> likesOfChosen(const Actor& actor, const UiState& ui) {
  std::vector<int> likes;
  if (!ui.brush.mirror) return likes;
  const sim::HairMesh& mesh = actor.haircut->mesh;
  likes.assign(static_cast<std::size_t>(mesh.vertexCount()), -1);
  for (const int v : verticesOf(elementOf(ui.select), ui.select.chosen, mesh))
    likes[static_cast<std::size_t>(v)] = likeAcross(v, actor.body->character.scalp.center.x(), mesh);
  return likes;
}

// The hair that follows what is chosen.
void drawReached(const Actor& actor, const std::vector<int>& likes, const UiState& ui, const MeshOverlay& overlay) {
  const sim::HairMesh& mesh = actor.haircut->mesh;
  std::vector<int> led = verticesOf(elementOf(ui.select), ui.select.chosen, mesh);
  std::vector<double> weights = reachAround(led, actor.hair.positions, ui.brush.radius, ui.brush.falloff);
  if (ui.brush.mirror) {
    std::erase_if(led, [&](int v) { return mesh.isRoot(v); });
    for (int& v : led) v = likes[static_cast<std::size_t>(v)];
    const std::vector<double> there = reachAround(led, actor.hair.positions, ui.brush.radius, ui.brush.falloff);
    for (std::size_t v = 0; v < weights.size(); ++v) weights[v] = std::max(weights[v], kMirrorShare * there[v]);
  }
  for (std::size_t v = 0; v < weights.size(); ++v) {
    const bool follows = weights[v] > kShownReach && !mesh.isRoot(static_cast<int>(v));
    if (follows) overlay.reached(static_cast<int>(v), weights[v]);
  }
}

// Vertices that a person has pinned.
void drawPinned(const Actor& actor, const MeshOverlay& overlay, UiState& ui) {
  for (const int v : pinnedVertices(actor)) {
    overlay.dot(v, kPinnedColor);
    const auto at = screenPlace(actor.hair.positions[static_cast<std::size_t>(v)], overlay.demo());
    if (at) noteMark("pinned " + std::to_string(v), at->x, at->y, 4 * ui.text_scale, ui);
  }
}

// What is led across the mirror. A layer goes round the head and is its own like.
void drawMirrored(const Demo& demo, const std::vector<int>& likes, const MeshOverlay& overlay, UiState& ui) {
  const Actor& actor = selectedActor(demo);
  if (likes.empty() || elementOf(ui.select) == MeshElement::kLayer) return;
  const sim::HairMesh& mesh = actor.haircut->mesh;
  const auto like = [&](int v) { return likes[static_cast<std::size_t>(v)]; };
  drawElements(elementOf(ui.select), ui.select.chosen, kMirrorColor, mesh, overlay, like);
  for (const int v : verticesOf(elementOf(ui.select), ui.select.chosen, mesh)) {
    const int across = like(v);
    const auto at = screenPlace(actor.hair.positions[static_cast<std::size_t>(across)], demo);
    if (at) noteMark("mirrored " + std::to_string(across), at->x, at->y, 4 * ui.text_scale, ui);
  }
}

// The pairs of columns that share an edge of the scalp and are both chosen.
std::string pairsText(const std::set<int>& columns, const sim::HairMesh& mesh) {
  std::set<std::pair<int, int>> pairs;
  for (const sim::RootFace& face : mesh.shape.root_faces) {
    for (int k = 0; k < face.corner_count; ++k) {
      const int a = face.columns[static_cast<std::size_t>(k)],
                b = face.columns[static_cast<std::size_t>((k + 1) % face.corner_count)];
      if (columns.contains(a) && columns.contains(b)) pairs.insert({std::min(a, b), std::max(a, b)});
    }
  }
  std::string text;
  for (const auto& [a, b] : pairs)
    text.append(text.empty() ? "" : " ").append(std::to_string(a)).append(" ").append(std::to_string(b));
  return text;
}

std::string changeText(MeshChange change, const SelectState& select, const sim::HairMesh& mesh) {
  std::set<int> columns, layers;
  for (const int v : verticesOf(elementOf(select), select.chosen, mesh)) {
    columns.insert(mesh.column_of[static_cast<std::size_t>(v)]);
    layers.insert(mesh.layer_of[static_cast<std::size_t>(v)]);
  }
  if (columns.empty()) return "";
  if (change == MeshChange::kAddLayer || change == MeshChange::kRemoveLayer) return std::to_string(*layers.begin());
  std::string text;
  const bool pairs = change == MeshChange::kSplit || change == MeshChange::kExtrude;
  if (pairs && elementOf(select) != MeshElement::kEdge) return pairsText(columns, mesh);
  if (pairs) {
    for (std::size_t k = 0; k + 1 < select.chosen.size(); k += 2) {
      const int a = mesh.column_of[static_cast<std::size_t>(select.chosen[k])],
                b = mesh.column_of[static_cast<std::size_t>(select.chosen[k + 1])];
      if (a != b) text.append(text.empty() ? "" : " ").append(std::to_string(a)).append(" ").append(std::to_string(b));
    }
    return text;
  }
  for (const int c : columns) text.append(text.empty() ? "" : " ").append(std::to_string(c));
  return text;
}

}  // namespace

void selectRow(Demo& demo, UiState& ui) {
  SelectState& select = ui.select;
  const int pressed = segments("select",
                               {"No select",
                                {"Vertex", "Click chooses a vertex, Shift adds; a drag or arrow keys move it"},
                                {"Edge", "Click chooses an edge, Shift adds; a drag or arrow keys move it"},
                                {"Column", "Click chooses all from a root to its tip, Shift adds; a drag moves it"},
                                {"Layer", "Click chooses all as far from the roots, Shift adds; a drag moves it"}},
                               select.element + 1, ui);
  if (pressed >= 0) chooseElement(pressed - 1, ui);
  followMesh(selectedActor(demo), select);
  ImGui::BeginDisabled(select.element < 0 || select.chosen.empty());
  const int change = segments("mesh",
                              {{"Layer +", "Adds a layer beyond the chosen one"},
                               {"Layer -", "Takes the chosen layer away"},
                               {"Part", "Draws a parting along the chosen edges or columns"},
                               {"Weld", "Closes the parting there"},
                               {"Extrude", "Grows new bundles at chosen edges of the border"}},
                              -1, ui);
  ImGui::EndDisabled();
  if (change < 0) return;
  const auto what = static_cast<MeshChange>(change);
  const bool layer = what == MeshChange::kAddLayer || what == MeshChange::kRemoveLayer;
  const std::string chosen = changeText(what, select, selectedActor(demo).haircut->mesh);
  const std::string mirror(ui.brush.mirror && !layer && !chosen.empty() ? kMirrorText : "");
  postRequest(demo, {Ask::kMesh, std::string(kMeshChangeNames[static_cast<std::size_t>(change)]), mirror + chosen});
}

void chooseElement(int element, UiState& ui) {
  ui.select.element = element;
  ui.select.chosen.clear();
  if (element >= 0) ui.brush.tool = ui.brush.field = -1;
}

void selectFrame(bool begins, Demo& demo, UiState& ui) {
  BrushState& brush = ui.brush;
  SelectState& select = ui.select;
  const ImGuiIO& io = ImGui::GetIO();
  const Actor& actor = selectedActor(demo);
  followMesh(actor, select);
  const MeshOverlay overlay(demo, ui.text_scale);
  const bool free = !io.WantCaptureMouse || brush.stroking;
  const Ray ray = rayThrough(io.MousePos.x, io.MousePos.y, shownPicture(demo), demo.camera);
  const std::optional<HairHit> hit = free ? pickHairFace(ray, actor) : std::nullopt;
  const Rigid to_scalp = scalpToWorld(actor.body->character, actor.pose).inverse(Eigen::Isometry);
  brush.over_hair = hit.has_value();
  if (begins && hit) {
    choose(elementAt(elementOf(select), *hit, actor), io.KeyShift, select);
    brush.stroking = true;
    brush.last = to_scalp * hit->at;
    beginDrag(brush.last, actor, select);
  }
  brush.stroking = brush.stroking && io.MouseDown[0];
  if (brush.stroking) {
    sayShortfall(brush.last, actor, demo, select);
    const Vec3 last = to_scalp.inverse(Eigen::Isometry) * brush.last;
    const Vec3 now = pointInPlane(ray, last, viewBack(demo.camera)), way = now - last;
    if (way.norm() >= kMinMove) {
      postMove(to_scalp.linear() * way, demo, ui);
      brush.last = to_scalp * now;
    }
  } else if (hit) {
    drawElements(elementOf(select), elementAt(elementOf(select), *hit, actor), kHoverColor, actor.haircut->mesh,
                 overlay);
  }
  const std::vector<int> likes = likesOfChosen(actor, ui);
  drawReached(actor, likes, ui, overlay);
  drawMirrored(demo, likes, overlay, ui);
  drawElements(elementOf(select), select.chosen, kChosenColor, actor.haircut->mesh, overlay);
  drawPinned(actor, overlay, ui);
}

bool nudgeChosen(int key, bool far, Demo& demo, UiState& ui) {
  if (ui.select.element < 0 || ui.select.chosen.empty() || key < kKeyRight || key > kKeyUp) return false;
  const Actor& actor = selectedActor(demo);
  followMesh(actor, ui.select);
  const Vec3 back = viewBack(demo.camera), right = Vec3::UnitY().cross(back).normalized(), up = back.cross(right);
  const Vec3 way = key == kKeyRight ? right : key == kKeyLeft ? Vec3(-right) : key == kKeyUp ? up : Vec3(-up);
  const Rigid to_scalp = scalpToWorld(actor.body->character, actor.pose).inverse(Eigen::Isometry);
  postMove(to_scalp.linear() * ((far ? kLongNudge : kNudge) * way), demo, ui);
  return true;
}

}  // namespace app

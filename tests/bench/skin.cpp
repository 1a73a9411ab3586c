#include "tests/bench/skin.h"

#include "app/files/errors.h"

#ifdef HAIRMESH_EMBREE

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <unordered_set>

#include "app/files/data_path.h"
#include "app/options.h"
#include "app/scene/demo.h"
#include "render/strands/strand_growth.h"
#include "tests/bench/measured_part.h"
#include "tests/bench/scene_times.h"
#include "tests/bench/table.h"
#include "tests/sim_probes.h"
#include "tests/skin/drawn_skin.h"

namespace bench {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3f;

constexpr int kEvery = 6;            // frames from one look to the next
constexpr double kLongestClip = 60;  // s of a clip
constexpr int kWidth = 1280, kHeight = 720;
constexpr double kSeen = 1e-3, kDeepest = 4e-3;                  // m
constexpr double kShare = 1e-3;                                  // of the points that may lie deeper than kSeen
constexpr const char* kModels = "/usr/share/assimp/models/FBX";  // Debian: assimp-testmodels
constexpr const char* kModel = "huesitos.fbx";                   // the one that has a head
constexpr float kNear = 0.02f;  // m: skin so near to a strand is skin that hair can reach

// kind: the figures of a row of the document.
struct SkinFigure {
  std::string file, parts, name, kind;
};

std::string kindOf(const fs::path& file, bool own) {
  const std::string ending = file.extension().string();
  if (ending == ".mot") return "rigid parts (ARCSim)";
  if (ending != ".bvh") return file.filename().string();
  return own ? "mannequin, own clips" : "mannequin, captures";
}

// `missing` gets the folders that are not there.
std::vector<SkinFigure> allFigures(std::vector<std::string>& missing) {
  const fs::path own = fs::path(app::findFile("walk.bvh", "", "clips")).parent_path();
  const fs::path shared = own / ".." / ".." / ".." / "shared";
  std::vector<SkinFigure> figures;
  for (const fs::path& folder : {own, shared / "mocap", shared / "arcsim", shared / "characters", fs::path(kModels)}) {
    if (!fs::exists(folder)) {
      missing.push_back(folder.filename().string());
      continue;
    }
    std::vector<SkinFigure> found;
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string ending = entry.path().extension().string(), name = entry.path().filename().string();
      if (folder == kModels && name != kModel) continue;
      const std::string parts = ending == ".mot" ? (folder / "female-objs").string() : "";
      if (ending == ".mot" || ending == ".bvh" || ending == ".glb" || ending == ".fbx")
        found.push_back({entry.path().string(), parts, name, kindOf(entry.path(), folder == own)});
    }
    std::ranges::sort(found, {}, &SkinFigure::name);
    figures.insert(figures.end(), found.begin(), found.end());
  }
  return figures;
}

std::vector<SkinFigure> figuresOf(const SkinOptions& options) {
  std::vector<std::string> missing;
  std::vector<SkinFigure> figures = allFigures(missing);
  for (const std::string& folder : missing) std::printf("%s is not there: its figures are left out\n", folder.c_str());
  std::erase_if(figures, [&](const SkinFigure& figure) {
    return !options.clips.empty() && std::ranges::find(options.clips, figure.name) == options.clips.end();
  });
  return figures;
}

struct Looked {
  int frames = 0;
  long points = 0, seen = 0;       // strands' points; those deeper than kSeen
  double deepest = 0, pixels = 0;  // m; of the picture
  double deepest_at = 0;           // s
  std::vector<float> out;          // m, how far reachable skin lies outside of the ellipsoids; 0 inside
  double worst_out = 0;            // m
  std::string worst_joint;         // which carries the skin that is worst out

  double share() const { return static_cast<double>(seen) / static_cast<double>(std::max(points, 1L)); }
  bool holds() const { return share() <= kShare && deepest <= kDeepest; }
};

// Cells that hold a point, so that what is near them is found.
struct NearCells {
  std::unordered_set<std::uint64_t> cells;
  static std::uint64_t key(const Eigen::Vector3i& cell) {
    const auto part = [&](int k) { return static_cast<std::uint64_t>(cell[k] + (1 << 20)) & 0x1fffff; };
    return part(0) | part(1) << 21 | part(2) << 42;
  }
  static Eigen::Vector3i cellOf(const Vector3f& p) { return (p / kNear).array().floor().cast<int>(); }
  void add(const Vector3f& p) { cells.insert(key(cellOf(p))); }
  bool near(const Vector3f& p) const {
    for (int n = 0; n < 27; ++n) {
      if (cells.contains(key(cellOf(p) + Eigen::Vector3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)))) return true;
    }
    return false;
  }
};

// m, of a point outside of all; 0 inside one.
double outOf(const std::vector<sim::Ellipsoid>& ellipsoids, const sim::Vec3& p) {
  double nearest = 1e9;
  for (const sim::Ellipsoid& e : ellipsoids) {
    if (test::implicitValue(e, p) <= 0) return 0;
    nearest = std::min(nearest, sim::closestPoint(e, p).distance);
  }
  return nearest;
}

void lookAtSkin(const app::Demo& demo, const skin::DrawnSkin& skin, const NearCells& cells, Looked& looked) {
  const app::Actor& actor = demo.actors.front();
  const app::Character& character = actor.body->character;
  std::vector<sim::Ellipsoid> ellipsoids;
  app::poseEllipsoids(character, actor.shown_pose, actor.shown_pose, 0, ellipsoids);
  for (std::size_t v = 0; v < character.mesh.positions.size(); ++v) {
    const Vector3f& p = skin.vertices()[v];
    if (!cells.near(p) || skin.depth(p) > kSeen) continue;  // or hidden in another piece
    const double out = outOf(ellipsoids, p.cast<double>() + demo.origin);
    looked.out.push_back(static_cast<float>(out));
    if (out <= looked.worst_out) continue;
    looked.worst_out = out;
    const auto& w = character.mesh.weights[v];
    looked.worst_joint =
        character.skeleton.joints[character.mesh.joints[v][std::ranges::max_element(w) - w.begin()]].name;
  }
}

void look(app::Demo& demo, double time, render::StrandGrowth& growth, Looked& looked) {
  const render::FrameInput frame = app::frameInput(demo, kWidth, kHeight);
  const skin::DrawnSkin skin(frame.bodies.front());
  growth.setPositions(frame.hairs.front().positions);
  growth.setSkin(frame.hairs.front().skin, frame.hairs.front().skin_grids);
  std::vector<render::CurvePoint> strand(static_cast<std::size_t>(growth.maxPoints()));
  const Vector3f eye(frame.camera.eye.data());
  const double pixels_a_radian = kHeight / (2 * std::tan(frame.camera.fov_y / 2));
  NearCells cells;
  for (int number = 0; number < growth.strandCount(); ++number) {
    const int count = growth.growDrawn(growth.strand(number), strand);
    for (int i = 0; i < count; ++i) {
      const Vector3f& p = strand[i].position;
      cells.add(p);
      const double depth = skin.depth(p);
      ++looked.points;
      looked.seen += depth > kSeen;
      looked.pixels = std::max(looked.pixels, depth * pixels_a_radian / (p - eye).norm());
      if (depth <= looked.deepest) continue;
      looked.deepest = depth;
      looked.deepest_at = time;
    }
  }
  lookAtSkin(demo, skin, cells, looked);
  ++looked.frames;
}

app::Scene sceneOf(const SkinFigure& figure, const std::string& style, const SkinOptions& options) {
  app::Options asked;
  asked.motion = figure.file;
  asked.parts = figure.parts;
  asked.style = style.substr(0, style.find(' '));
  asked.resolution = style.substr(style.find(' ') + 1);
  asked.framing = "bust";
  asked.strands = options.strands;
  asked.set = options.sets;
  asked.speed = options.speed;
  return app::sceneFromOptions(asked);
}

Looked play(const SkinFigure& figure, const std::string& style, const SkinOptions& options) {
  app::Demo demo = app::openScene(sceneOf(figure, style, options), static_cast<double>(kWidth) / kHeight);
  const double seconds = std::clamp(demo.actors.front().playedClip().duration(), kFrame, kLongestClip);
  app::advanceFrame(demo, 0, {});
  const render::HairInput hair = app::frameInput(demo, kWidth, kHeight).hairs.front();
  render::StrandGrowth growth(hair.faces, hair.rest, hair.strands, hair.segments_per_layer, hair.look);
  Looked looked;
  for (int frame = 0; frame * kFrame < seconds; ++frame) {
    app::advanceFrame(demo, frame == 0 ? 0 : kFrame, {});
    if (frame % kEvery == 0) look(demo, frame * kFrame, growth, looked);
  }
  return looked;
}

const std::vector<std::string> kSkinHead{"style",        "clip",        "frames",      "points",
                                         "over 1 mm",    "deepest, mm", "deepest, px", "holds",
                                         "skin out, mm", "99.9 %, mm",  "out by 3 mm", "where"};

std::vector<std::string> rowOf(const std::string& style, const std::string& clip, Looked& looked, bool& all_hold) {
  all_hold = all_hold && looked.holds();
  std::ranges::sort(looked.out);
  const std::size_t count = looked.out.size();
  const double most = count == 0 ? 0 : looked.out[static_cast<std::size_t>(0.999 * static_cast<double>(count - 1))];
  const long far = looked.out.end() - std::ranges::upper_bound(looked.out, 3e-3f);
  return {style,
          clip,
          formatted("%d", looked.frames),
          formatted("%ld", looked.points),
          formatted("%.3f %%", 100 * looked.share()),
          formatted("%.2f", 1e3 * looked.deepest),
          formatted("%.1f", looked.pixels),
          looked.holds() ? "yes" : "no",
          formatted("%.1f", 1e3 * looked.worst_out),
          formatted("%.1f", 1e3 * most),
          formatted("%.2f %%", 100.0 * static_cast<double>(far) / static_cast<double>(std::max<std::size_t>(count, 1))),
          looked.worst_joint};
}

// The rows of the document: all clips of one kind of figure with one style.
struct SkinRow {
  std::string kind, style, deepest_clip;
  int clips = 0, hold = 0;
  Looked all;
};

void addTo(std::vector<SkinRow>& rows, const SkinFigure& figure, const std::string& style, const Looked& looked) {
  auto row = std::ranges::find_if(rows, [&](const SkinRow& r) { return r.kind == figure.kind && r.style == style; });
  if (row == rows.end()) row = rows.insert(rows.end(), SkinRow{figure.kind, style, "", 0, 0, {}});
  ++row->clips;
  row->hold += looked.holds();
  row->all.points += looked.points;
  row->all.seen += looked.seen;
  row->all.pixels = std::max(row->all.pixels, looked.pixels);
  row->all.worst_out = std::max(row->all.worst_out, looked.worst_out);
  if (looked.deepest < row->all.deepest || (looked.deepest == 0 && row->clips > 1)) return;
  row->all.deepest = looked.deepest;
  row->deepest_clip = figure.name.substr(0, figure.name.find('.'));
}

Table documentOf(const std::vector<SkinRow>& rows) {
  Table table{
      {"figure", "style", "over 1 mm", "deepest, mm", "deepest, px", "in clip", "skin out, mm", "clips that hold"}, {}};
  for (const SkinRow& row : rows) {
    table.rows.push_back({row.kind, row.style, formatted("%.3f %%", 100 * row.all.share()),
                          formatted("%.1f", 1e3 * row.all.deepest), formatted("%.1f", row.all.pixels), row.deepest_clip,
                          formatted("%.1f", 1e3 * row.all.worst_out), formatted("%d of %d", row.hold, row.clips)});
  }
  return table;
}

}  // namespace

std::vector<std::string> skinClips() {
  std::vector<std::string> missing, names;
  for (const SkinFigure& figure : allFigures(missing)) names.push_back(figure.name);
  return names;
}

bool runSkin(const SkinOptions& options) {
  const std::vector<std::string> styles =
      options.styles.empty() ? std::vector<std::string>{"short low", "shoulder low", "long low"} : options.styles;
  Table table{kSkinHead, {}};
  std::vector<SkinRow> rows;
  bool all_hold = true;
  for (const std::string& style : styles) {
    for (const SkinFigure& figure : figuresOf(options)) {
      Looked looked = play(figure, style, options);
      addTo(rows, figure, style, looked);
      table.rows.push_back(rowOf(style, figure.name, looked, all_hold));
      for (const std::string& cell : table.rows.back())
        std::printf("%s%s", cell.c_str(), &cell == &table.rows.back().back() ? "" : ", ");
      std::printf(" (at %.2f s)\n", looked.deepest_at);
      std::fflush(stdout);
    }
  }
  if (table.rows.empty()) throw app::InputError("", "--clips", "names no clip that is there", "such as walk.bvh");
  if (!options.folder.empty()) {
    writeTable(options.folder, "skin", table);
    writeMeasuredPart(options.folder + "/skin.md", "skin", documentOf(rows).markdown());
  }
  return all_hold;
}

}  // namespace bench

#else

namespace bench {

std::vector<std::string> skinClips() {
  return {};
}

bool runSkin(const SkinOptions&) {
  throw app::InputError("--skin", "", "needs Embree 3, which was missing when this was built",
                        "install libembree-dev and configure again");
}

}  // namespace bench

#endif

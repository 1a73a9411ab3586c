#include "tests/bench/draw_passes.h"

#include <GL/glew.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <map>
#include <vector>

#include "app/files/data_path.h"
#include "app/files/median.h"
#include "app/platform/egl_context.h"
#include "render/gl/driver.h"
#include "render/gl/shader.h"
#include "render/grown/grown_strands.h"
#include "render/hair/strand_draw.h"
#include "render/passes.h"
#include "render/renderer.h"
#include "render/stage.h"
#include "tests/bench/cpu_clock.h"
#include "tests/bench/draw_scene.h"
#include "tests/bench/measured_part.h"
#include "tests/bench/table.h"

namespace bench {
namespace {

constexpr int kUncounted = 2, kFramesARun = 10, kDrawsARun = 10;
constexpr double kRowSeconds = 2;  // s that a row takes about
constexpr int kFewest = 3;         // frames that it counts all the same
constexpr double kTooSlow = 500;   // ms a frame: a path that takes as long is not timed with more strands
constexpr double kMaxOverTriangles = 2, kMaxForShadows = 0.35;

struct PictureSize {
  int width, height;
  std::string name() const { return std::to_string(width) + "x" + std::to_string(height); }
};

std::vector<PictureSize> pictureSizes(bool quick) {
  if (quick) return {{640, 360}};
  return {{1920, 1080}, {3840, 2160}};
}

std::vector<int> strandCounts(bool quick) {
  if (quick) return {10000};
  return {10000, 50000, 100000, 400000};
}

constexpr int kMaxExpanded = 100000;  // strands; more would not fit into many a GPU's memory as triangles

constexpr const char* kStagePaths[] = {"geometry", "compute"};  // as StrandPath counts

DrawSetting settingOf(int strands, int path, bool shadows) {
  return {{{"strands", static_cast<double>(strands)},
           {"strand_path", static_cast<double>(path)},
           {"all_strands", 1},
           {"shadows", shadows ? 1.0 : 0.0}}};
}

// Medians of milliseconds of each pass, and of all of them.
using Passes = std::vector<std::pair<std::string, double>>;

Passes timePasses(render::Renderer& renderer, DrawStage& scene, const DrawSetting& setting, const PictureSize& size,
                  int frames) {
  std::vector<unsigned char> rgba;
  std::vector<std::string> names;
  std::map<std::string, std::vector<double>> times;
  const double begin = secondsOf(CLOCK_MONOTONIC);
  for (int k = 0; k < kUncounted + frames; ++k) {
    if (k >= kUncounted + kFewest && secondsOf(CLOCK_MONOTONIC) - begin > kRowSeconds) break;
    const render::FrameReport report =
        renderer.renderImage(scene.frame(setting, k % 2, size.width, size.height), rgba, true);
    if (k < kUncounted) continue;
    double all = 0;
    for (const render::StageTime& time : report.stages) {
      if (k == kUncounted) names.emplace_back(time.name);
      times[time.name].push_back(time.milliseconds);
      all += time.milliseconds;
    }
    times["all"].push_back(all);
  }
  names.emplace_back("all");
  Passes medians;
  for (const std::string& name : names) medians.emplace_back(name, app::median(times[name]));
  return medians;
}

double timeOf(const Passes& passes, const char* name) {
  return std::ranges::find(passes, name, &Passes::value_type::first)->second;
}

// A corner of a strand's ribbon, as the geometry stage writes it.
struct Corner {
  std::array<float, 4> place, lit;
  float dither;
  bool operator==(const Corner&) const = default;
};

// Triangles that share their corners, as a mesh would be kept.
struct Triangles {
  render::Buffer corners, indices;
  GLsizei count = 0;
};

// Takes together the corners that a strip's triangles repeat: they are among the last few.
Triangles sharedCorners(const std::vector<Corner>& repeated) {
  constexpr std::size_t kBack = 4;
  std::vector<Corner> corners;
  std::vector<GLuint> indices;
  indices.reserve(repeated.size());
  for (const Corner& corner : repeated) {
    std::size_t found = corners.size();
    for (std::size_t back = 1; back <= std::min(kBack, corners.size()); ++back) {
      if (corners[corners.size() - back] == corner) found = corners.size() - back;
    }
    if (found == corners.size()) corners.push_back(corner);
    indices.push_back(static_cast<GLuint>(found));
  }
  Triangles triangles{render::makeBuffer(), render::makeBuffer(), static_cast<GLsizei>(indices.size())};
  const auto upload = [](const render::Buffer& buffer, const auto& values) {
    glNamedBufferStorage(buffer.id(), static_cast<GLsizeiptr>(values.size() * sizeof(values[0])), values.data(), 0);
  };
  upload(triangles.corners, corners);
  upload(triangles.indices, indices);
  return triangles;
}

// The strands of a frame's only hair, drawn alone: grown by the shader stages, and from triangles.
class StrandsAlone {
 public:
  explicit StrandsAlone(const std::string& shaders)
      : geometry_(shaders, {{"strand.vert", "strand.geom", "strand.frag"}, {}, {}}),
        capture_(shaders, {{"strand.vert", "strand.geom", "strand.frag"}, {}, {"gl_Position", "lit", "dither"}}),
        grown_(shaders),
        triangles_(shaders, {{"../tests/bench/expanded.vert", "strand.frag"}, {}, {}}),
        nothing_(render::makeVertexArray()),
        corners_(render::makeVertexArray()),
        elapsed_(render::makeQuery(GL_TIME_ELAPSED)) {
    for (const render::PassMaker make : render::kPasses) passes_.push_back(make(shaders));
    const GLuint array = corners_.id();
    const std::array<int, 3> floats{4, 4, 1};
    for (GLuint k = 0, at = 0; k < floats.size(); at += static_cast<GLuint>(floats[k] * sizeof(float)), ++k) {
      glEnableVertexArrayAttrib(array, k);
      glVertexArrayAttribFormat(array, k, floats[k], GL_FLOAT, GL_FALSE, at);
      glVertexArrayAttribBinding(array, k, 0);
    }
  }

  struct Times {
    double geometry, compute, triangles;  // ms
  };

  Times time(const render::FrameInput& input, int draws) {
    drawAll(input);
    const Triangles triangles = grow();
    glVertexArrayVertexBuffer(corners_.id(), 0, triangles.corners.id(), 0, sizeof(Corner));
    glVertexArrayElementBuffer(corners_.id(), triangles.indices.id());
    std::array<std::vector<double>, 3> times;
    const double begin = secondsOf(CLOCK_MONOTONIC);
    for (int k = -1; k < draws; ++k) {  // the first warms up
      if (k >= kFewest && secondsOf(CLOCK_MONOTONIC) - begin > kRowSeconds) break;
      const std::array<double, 3> now{timed([this] { issueWith(geometry_); }), timed([this] { grown_.draw(stage_); }),
                                      timed([&] { draw(triangles); })};
      for (std::size_t way = 0; way < now.size() && k >= 0; ++way) times[way].push_back(now[way]);
    }
    return {app::median(times[0]), app::median(times[1]), app::median(times[2])};
  }

 private:
  render::HairResources& hair() { return stage_.hairs.hairs()[0]; }

  // Every pass into the radiance, which leaves all that strands are drawn with.
  void drawAll(const render::FrameInput& input) {
    render::FrameReport report;
    stage_.width = input.width;
    stage_.height = input.height;
    stage_.update(input, report);
    for (const render::PassEntry& pass : passes_) pass.update(pass.pass.get(), input);
    for (const render::PassEntry& pass : passes_) {
      if (pass.target != render::Target::kRadiance) continue;
      stage_.beginRadiance();
      pass.draw(pass.pass.get(), stage_, report);
    }
    render::HairStore::bind(hair(), hair().view_draw, &stage_.detail.table());
    stage_.shadows.bindMaps();
  }

  void issueWith(const render::ShaderProgram& program) {
    glBindVertexArray(nothing_.id());
    program.use();
    render::issueStrands(hair(), hair().view_draw, 2);
  }

  void draw(const Triangles& triangles) {
    glBindVertexArray(corners_.id());
    triangles_.use();
    glDrawElements(GL_TRIANGLES, triangles.count, GL_UNSIGNED_INT, nullptr);
  }

  Triangles grow() {
    const render::HairDraw& draw = hair().view_draw;
    const std::size_t most =
        static_cast<std::size_t>(hair().strandCount(draw)) * static_cast<std::size_t>(hair().pointsPerStrand(draw)) * 6;
    const render::Buffer result = render::makeBuffer();
    glNamedBufferStorage(result.id(), static_cast<GLsizeiptr>(most * sizeof(Corner)), nullptr, 0);
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, result.id());
    const render::Query written = render::makeQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN);
    stage_.beginRadiance();
    glBindVertexArray(nothing_.id());
    capture_.use();
    glBeginQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, written.id());
    glBeginTransformFeedback(GL_TRIANGLES);
    render::issueStrands(hair(), draw, 2);
    glEndTransformFeedback();
    glEndQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN);
    GLuint count = 0;
    glGetQueryObjectuiv(written.id(), GL_QUERY_RESULT, &count);
    std::vector<Corner> repeated(std::size_t{3} * count);
    glGetNamedBufferSubData(result.id(), 0, static_cast<GLsizeiptr>(repeated.size() * sizeof(Corner)), repeated.data());
    return sharedCorners(repeated);
  }

  // Milliseconds of a draw into a cleared picture.
  template <class Draw>
  double timed(const Draw& draw) {
    stage_.beginRadiance();
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glFinish();
    glBeginQuery(GL_TIME_ELAPSED, elapsed_.id());
    draw();
    glEndQuery(GL_TIME_ELAPSED);
    GLuint64 nanoseconds = 0;
    glGetQueryObjectui64v(elapsed_.id(), GL_QUERY_RESULT, &nanoseconds);
    return static_cast<double>(nanoseconds) * 1e-6;
  }

  render::Stage stage_;
  std::vector<render::PassEntry> passes_;
  render::ShaderProgram geometry_, capture_;
  render::GrownStrands grown_;
  render::ShaderProgram triangles_;
  render::VertexArray nothing_, corners_;
  render::Query elapsed_;
};

struct DrawTables {
  Table passes, triangles;
  std::vector<std::string> faults;
};

void addPasses(DrawTables& measured, const std::string& size, const std::string& strands, const std::string& path,
               const std::string& shadows, const Passes& passes) {
  if (measured.passes.head.empty()) {
    measured.passes.head = {"picture", "strands", "path", "shadows"};
    for (const auto& [name, time] : passes) measured.passes.head.push_back(name);
  }
  std::vector<std::string> row{size, strands, path, shadows};
  for (const auto& [name, time] : passes) row.push_back(formatted("%.3f", time));
  measured.passes.rows.push_back(row);
  std::printf("%s, %s strands, %s, shadows %s: %.3f ms\n", size.c_str(), strands.c_str(), path.c_str(), shadows.c_str(),
              timeOf(passes, "all"));
  std::fflush(stdout);
}

void measurePasses(DrawTables& measured, const DrawPassesOptions& options, const DrawScene& one,
                   const DrawScene& many) {
  render::Renderer renderer(app::dataPath("shaders"));
  const int frames = kFramesARun * options.runs;
  DrawStage bust(one, renderer);
  for (const PictureSize& size : pictureSizes(options.quick)) {
    bool too_slow[std::size(kStagePaths)] = {};
    for (const int strands : strandCounts(options.quick)) {
      for (int path = 0; path < static_cast<int>(std::size(kStagePaths)); ++path) {
        if (too_slow[path]) continue;
        double times[2] = {};
        for (const bool shadows : {false, true}) {
          const Passes passes = timePasses(renderer, bust, settingOf(strands, path, shadows), size, frames);
          times[shadows] = timeOf(passes, "all");
          addPasses(measured, size.name(), std::to_string(strands), kStagePaths[path], shadows ? "on" : "off", passes);
        }
        too_slow[path] = times[1] > kTooSlow;
        const double share = times[1] / times[0] - 1;
        const bool used = path == static_cast<int>(render::pathFor(render::StrandPath::kAuto));
        if (used && share > kMaxForShadows)
          measured.faults.push_back(formatted("%s, %d strands: shadows cost %.0f %% on top (bound %.0f %%)",
                                              size.name().c_str(), strands, 100 * share, 100 * kMaxForShadows));
      }
    }
  }
  DrawStage hundred(many, renderer);
  for (const PictureSize& size : pictureSizes(options.quick)) {
    addPasses(measured, size.name(), "a hundred figures", "auto", "on",
              timePasses(renderer, hundred, {}, size, frames));
  }
}

void measureTriangles(DrawTables& measured, const DrawPassesOptions& options, const DrawScene& one) {
  render::Renderer renderer(app::dataPath("shaders"));
  DrawStage bust(one, renderer);
  StrandsAlone strands_alone(app::dataPath("shaders"));
  measured.triangles.head = {"picture", "strands", "geometry", "compute", "triangles", "compute over triangles"};
  for (const PictureSize& size : pictureSizes(options.quick)) {
    for (const int strands : strandCounts(options.quick)) {
      if (strands > kMaxExpanded) continue;
      const auto times = strands_alone.time(bust.frame(settingOf(strands, 0, true), 0, size.width, size.height),
                                            kDrawsARun * options.runs);
      const double ratio = times.compute / times.triangles;
      measured.triangles.rows.push_back({size.name(), std::to_string(strands), formatted("%.3f", times.geometry),
                                         formatted("%.3f", times.compute), formatted("%.3f", times.triangles),
                                         formatted("%.2f", ratio)});
      std::printf("%s, %d strands: geometry %.3f, compute %.3f, triangles %.3f ms\n", size.name().c_str(), strands,
                  times.geometry, times.compute, times.triangles);
      std::fflush(stdout);
      if (ratio > kMaxOverTriangles)
        measured.faults.push_back(formatted("%s, %d strands: %.2f times the time of triangles (bound %.1f)",
                                            size.name().c_str(), strands, ratio, kMaxOverTriangles));
    }
  }
}

DrawScene sceneNamed(const std::string& name) {
  const std::vector<DrawScene> scenes = drawScenes();
  return *std::ranges::find_if(scenes, [&](const DrawScene& scene) { return scene.name == name; });
}

}  // namespace

bool runDrawPasses(const DrawPassesOptions& options) {
  app::EglContext context;
  const std::string renderer = render::rendererName();
  std::printf("%s\n", renderer.c_str());
  DrawTables measured;
  measureTriangles(measured, options, sceneNamed("bust"));
  measurePasses(measured, options, sceneNamed("bust"), sceneNamed("hundred"));
  writeTable(options.folder, "gpu_passes", measured.passes);
  writeTable(options.folder, "gpu_triangles", measured.triangles);
  const std::string page = options.folder + "/gpu.md";
  if (std::filesystem::exists(page)) {
    writeMeasuredPart(page, "gpu-renderer", renderer + "\n");
    writeMeasuredPart(page, "gpu-triangles", measured.triangles.markdown());
    writeMeasuredPart(page, "gpu-passes", measured.passes.markdown());
  }
  for (const std::string& fault : measured.faults) std::printf("off its bound: %s\n", fault.c_str());
  return measured.faults.empty();
}

}  // namespace bench

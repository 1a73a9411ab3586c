#include "tests/bench/colliders.h"

#include <algorithm>
#include <cstdio>
#include <map>

#include "app/files/data_path.h"
#include "app/scene/actor.h"
#include "tests/bench/cpu_clock.h"
#include "tests/bench/scene_times.h"
#include "tests/bench/skin_distance.h"

namespace bench {
namespace {

constexpr int kFramesPerSkin = 20;  // the skin is posed and measured every so many frames
constexpr double kReach = 0.05;     // m, as far as distances to the skin are told

struct ColliderRow {
  std::vector<double> step, collision;  // s
  double worst_inside = 0;              // m, deepest external vertex under the skin
  int vertices = 0, inside = 0;         // looked at; under the skin by more than a millimetre
  std::vector<double> gaps;             // m, of vertices in contact, beyond the contact offset
};

ColliderRow measure(const sim::SimParams& params, int frames, app::Actor& actor) {
  app::settleActor(params, kSettle, actor);
  ColliderRow row;
  for (int frame = 0; frame < frames; ++frame) {
    app::moveActor(params.time_step, actor);
    const double started = cpuSeconds();
    const sim::StepReport report = app::simulateActor(params, params.time_step, frame * params.time_step, actor);
    row.step.push_back(cpuSeconds() - started);
    row.collision.push_back(report.seconds[sim::kStageCollision] + report.seconds[sim::kStageMinimization]);
    if (frame % kFramesPerSkin != 0) continue;
    const SkinDistance skin(actor.body->character, actor.pose);
    std::map<int, double> distance;
    for (const int v : actor.haircut->mesh.external_vertices) {
      const double d = distance[v] = skin.at(actor.hair.positions[v], kReach);
      row.worst_inside = std::max(row.worst_inside, -d);
      row.inside += d < -0.001;
      ++row.vertices;
    }
    for (const sim::Contact& contact : actor.hair.contacts) {
      if (const auto at = distance.find(contact.vertex); at != distance.end())
        row.gaps.push_back(at->second - params.contact_offset);
    }
  }
  return row;
}

}  // namespace

void runColliders(const ColliderOptions& options, std::FILE* out) {
  std::fprintf(
      out,
      "| style | clip | collider | ms a step | of it contacts | deepest under the skin, mm | vertices under it | "
      "contacts' "
      "gap to the skin, median mm | 10 %% to 90 %% |\n|---|---|---|---|---|---|---|---|---|\n");
  app::AssetCache asset_cache;
  for (const std::string& clip : options.clips) {
    for (const app::Style style : {app::Style::kShort, app::Style::kShoulder, app::Style::kLong}) {
      for (const app::Resolution resolution :
           {app::Resolution::kLow, app::Resolution::kMedium, app::Resolution::kHigh}) {
        const std::string name =
            std::string(app::styleName(style)) + " " + std::string(app::resolutionName(resolution));
        const bool wanted = options.styles.empty()
                                ? resolution == app::Resolution::kMedium
                                : std::find(options.styles.begin(), options.styles.end(), name) != options.styles.end();
        if (!wanted) continue;
        for (const sim::ColliderKind kind : {sim::ColliderKind::kEllipsoids, sim::ColliderKind::kSdf}) {
          app::CharacterSpec spec;
          spec.motion = app::findFile(clip, "", "clips");
          spec.style = style, spec.resolution = resolution;
          app::Actor actor = app::makeActor(spec, app::PlaybackSpec{}, asset_cache);
          sim::SimParams params;
          params.collider = kind;
          ColliderRow row = measure(params, options.frames, actor);
          std::sort(row.gaps.begin(), row.gaps.end());
          const auto part = [&](double share) {
            return row.gaps.empty() ? 0.0 : 1e3 * row.gaps[static_cast<std::size_t>(share * (row.gaps.size() - 1))];
          };
          std::fprintf(out, "| %s | %s | %s | %.2f | %.3f | %.1f | %.2f %% | %.1f | %.1f to %.1f |\n", name.c_str(),
                       clip.c_str(), kind == sim::ColliderKind::kSdf ? "sdf" : "ellipsoids", 1e3 * medianOf(row.step),
                       1e3 * medianOf(row.collision), 1e3 * row.worst_inside, 100.0 * row.inside / row.vertices,
                       part(0.5), part(0.1), part(0.9));
          std::fflush(out);
        }
      }
    }
  }
}

}  // namespace bench

#include "app/files/report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "app/files/median.h"
#include "app/files/output_file.h"
#include "app/files/report_line.h"
#include "sim/stabilization/parameter_limits.h"

namespace app {

namespace {

using nlohmann::json;

json milliseconds(const std::vector<double>& seconds) {
  double sum = 0, longest = 0;
  for (const double value : seconds) {
    sum += value;
    longest = std::max(longest, value);
  }
  return {{"median", 1e3 * median(seconds)},
          {"mean", seconds.empty() ? 0.0 : 1e3 * sum / static_cast<double>(seconds.size())},
          {"max", 1e3 * longest}};
}

// What each skip left out, of those that had anything to leave out.
json skippedJson(const SkipCounts& counts) {
  json skipped = json::object();
  for (const Skip& skip : skipTable()) {
    const SkipCount& count = counts[skip.id];
    if (count.of == 0) continue;
    skipped[skip.name] = {{"skipped", count.skipped},
                          {"of", count.of},
                          {"saved_milliseconds", skip.timed() ? json(1e3 * count.seconds) : json()}};
  }
  return skipped;
}

// What is left out without a switch, where it is counted.
json alwaysJson(const BuiltInCounts& counts) {
  json always = json::object();
  for (const BuiltInSkip& skip : builtInSkips()) {
    const SkipCount& count = counts[skip.id];
    if (count.of > 0) always[skip.name] = {{"skipped", count.skipped}, {"of", count.of}};
  }
  return always;
}

template <class Pick>
std::vector<double> gather(const RunReport& run, Pick&& pick) {
  std::vector<double> values;
  for (const FrameStats& frame : run.frames) values.push_back(pick(frame));
  return values;
}

json millisecondsJson(const FrameStats& stats) {
  json stages = json::object(), drawing = json::object();
  for (int s = 0; s < kFrameStageCount; ++s) stages[std::string(kFrameStageNames[s])] = 1e3 * stats.seconds[s];
  for (const render::StageTime& stage : stats.draw.stages) drawing[stage.name] = stage.milliseconds;
  return {
      {"frame", 1e3 * stats.whole}, {"simulation", 1e3 * stats.simulation()}, {"stages", stages}, {"drawing", drawing}};
}

json countsJson(const FrameStats& stats) {
  return {{"steps", stats.steps},
          {"solver_iterations", stats.solver_iterations},
          {"minimization_iterations", stats.minimization_iterations},
          {"work_units", stats.work_units},
          {"solves_cut", stats.solves_cut},
          {"corrections_cut", stats.corrections_cut},
          {"contacts", stats.contacts},
          {"corrected_vertices", stats.corrected},
          {"recoveries", stats.recoveries},
          {"carried", stats.carried},
          {"led_back_columns", stats.guided},
          {"pins_out_of_reach", stats.pins_out_of_reach},
          {"strands_drawn", stats.draw.strands_drawn},
          {"draw_calls", stats.draw.draw_calls}};
}

json frameJson(const FrameStats& stats, long index, double fps) {
  return {{"frame", index},
          {"seconds", static_cast<double>(index) / fps},
          {"lost_seconds", stats.lost},
          {"milliseconds", millisecondsJson(stats)},
          {"counts", countsJson(stats)},
          {"bytes",
           {{"uploaded", stats.draw.bytes_uploaded},
            {"gpu_hair", stats.draw.gpu_bytes_hair},
            {"gpu_shadows", stats.draw.gpu_bytes_shadows}}},
          {"solver",
           {{"converged", stats.converged},
            {"relative_residual", stats.residual},
            {"residual_metres_per_second_squared", stats.residual_acceleration}}},
          {"max_penetration_metres", stats.max_penetration},
          {"rung", stats.rung},
          {"draw_rung", stats.draw_rung},
          {"trouble", sim::faultText(stats.fault_report)},
          {"skipped", skippedJson(stats.skipped)},
          {"always_skipped", alwaysJson(stats.always)}};
}

json limitsJson(const Actor& actor, const sim::SimParams& params) {
  json limits = json::array();
  for (const sim::LimitedValue& limited : sim::limitedValues(actor.haircut->mesh, params))
    limits.push_back({{"parameter", limited.field->name},
                      {"set", limited.field->get(params)},
                      {"used", limited.used},
                      {"unit", limited.field->unit},
                      {"reason", limited.reason}});
  return limits;
}

json actorJson(const Actor& actor, const sim::SimParams& params) {
  const sim::HairMesh& mesh = actor.haircut->mesh;
  return {{"motion", actor.spec.motion},
          {"clip", actor.playedClip().name},
          {"clip_seconds", actor.playedClip().duration()},
          {"loop",
           {{"asked", loopName(actor.spec.loop)},
            {"kind", loopName(actor.playback.loop.kind)},
            {"treadmill", actor.playback.loop.treadmill},
            {"travel_metres", std::hypot(actor.playback.loop.travel.x, actor.playback.loop.travel.z)},
            {"turn_degrees", actor.playback.loop.travel.turn * 180 / std::numbers::pi},
            {"blend_seconds", actor.playback.loop.blend},
            {"haste", actor.playback.loop.haste}}},
          {"hair", actor.spec.hair.empty() ? std::string(styleName(actor.spec.style)) + " " +
                                                 std::string(resolutionName(actor.spec.resolution))
                                           : actor.spec.hair},
          {"vertices", mesh.vertexCount()},
          {"columns", mesh.columnCount()},
          {"prisms", mesh.prisms.size()},
          {"hair_length_metres", mesh.hair_length},
          {"limits", limitsJson(actor, params)},
          {"hair_note", actor.haircut->note},
          {"strands", actor.spec.look.strands},
          {"joints", actor.body->character.skeleton.joints.size()},
          {"ellipsoids", actor.body->character.ellipsoids.size()},
          {"notes", actor.body->character.notes}};
}

// How the budget was held: what was promised, and what came.
json budgetJson(const RunReport& run, const Demo& demo) {
  const Governor& governor = demo.governor;
  if (governor.budget <= 0) return nullptr;
  json rungs = json::array();
  for (int k = 0; k < static_cast<int>(ladder().size()); ++k) {
    std::vector<double> measured, counted;
    for (const FrameStats& frame : run.frames) {
      if (frame.rung != k) continue;
      measured.push_back(frame.simulation());
      counted.push_back(frame.counted_cost);
    }
    if (measured.empty()) continue;
    rungs.push_back({{"rung", k},
                     {"name", ladder()[k].name},
                     {"frames", measured.size()},
                     {"predicted_error_over_length", ladder()[k].error},
                     {"measured_milliseconds", milliseconds(measured)},
                     {"counted_milliseconds", milliseconds(counted)}});
  }
  return {{"budget_milliseconds", 1e3 * governor.budget},
          {"cost", governor.counted ? "counted work" : "measured time"},
          {"rung", rungName(governor)},
          {"predicted_milliseconds", 1e3 * governor.predicted_cost},
          {"measured_milliseconds", 1e3 * governor.measured_cost},
          {"predicted_error_over_length", predictedError(governor)},
          {"measured_error_over_length", governor.measured_error},
          {"changes", governor.changes},
          {"over_budget", governor.over_budget},
          {"rungs", rungs}};
}

// How the deadline was kept, in the units of work that it is counted in, and by the clock.
json deadlineJson(const RunReport& run, const Deadline& deadline) {
  if (deadline.seconds <= 0) return nullptr;
  const double units = deadline.seconds / deadline.seconds_per_unit;
  const auto over = [&](auto&& exceeds) { return std::ranges::count_if(run.frames, exceeds); };
  return {{"deadline_milliseconds", 1e3 * deadline.seconds},
          {"work_units", units},  // that it is worth at the end
          {"frames_over_units", over([&](const FrameStats& frame) { return frame.work_units > units; })},
          {"frames_over_milliseconds", over([&](const FrameStats& f) { return f.simulation() > deadline.seconds; })}};
}

// How the drawing's budget was held, rung by rung.
json drawBudgetJson(const RunReport& run, const Demo& demo) {
  const DrawGovernor& governor = demo.draw_governor;
  if (governor.budget <= 0) return nullptr;
  json rungs = json::array();
  for (int k = 0; k < static_cast<int>(drawLadder().size()); ++k) {
    std::vector<double> measured;
    for (const FrameStats& frame : run.frames) {
      if (frame.draw_rung == k && !frame.draw.stages.empty()) measured.push_back(frame.drawing());
    }
    if (measured.empty()) continue;
    rungs.push_back({{"rung", k},
                     {"name", drawLadder()[k].name},
                     {"frames", measured.size()},
                     {"measured_milliseconds", milliseconds(measured)}});
  }
  return {{"budget_milliseconds", 1e3 * governor.budget},
          {"rung", governor.rung},
          {"name", drawRungName(governor)},
          {"measured_milliseconds", 1e3 * governor.measured_cost},
          {"changes", governor.changes},
          {"over_budget", governor.over_budget},
          {"rungs", rungs}};
}

// What --compare found, of the frames so far.
json comparisonJson(const Demo& demo) {
  const Comparison& found = demo.comparison;
  if (!found.on() || found.frames == 0) return nullptr;
  const auto frames = static_cast<double>(found.frames);
  const double rms = found.rms_sum / frames, length = demo.actors.front().haircut->mesh.hair_length;
  json apart = nullptr;
  if (found.now.known)
    apart = {{"rms_metres_mean", rms}, {"worst_metres", found.worst}, {"rms_over_length_mean", rms / length}};
  return {{"with", found.with},
          {"frames", found.frames},
          {"hair_apart", apart},
          {"simulation_milliseconds_mean",
           {{"this", 1e3 * found.seconds[0] / frames}, {"other", 1e3 * found.seconds[1] / frames}}}};
}

}  // namespace

std::vector<std::string> limitNotes(const Demo& demo) {
  std::vector<std::string> notes;
  for (const Actor& actor : demo.actors) {
    for (const sim::LimitedValue& limited : sim::limitedValues(actor.haircut->mesh, demo.scene.sim)) {
      std::ostringstream note;
      note << limited.field->name << " is set to " << limited.field->get(demo.scene.sim) << " " << limited.field->unit
           << "; used: " << limited.used << " " << limited.field->unit << ", " << limited.reason;
      if (std::find(notes.begin(), notes.end(), note.str()) == notes.end()) notes.push_back(note.str());
    }
  }
  return notes;
}

void writeReport(const std::string& file, const RunReport& run, const Demo& demo) {
  json stages;
  for (int s = 0; s < kFrameStageCount; ++s) {
    stages[std::string(kFrameStageNames[s])] =
        milliseconds(gather(run, [&](const FrameStats& f) { return f.seconds[s]; }));
  }
  long recoveries = 0;
  for (const FrameStats& frame : run.frames) recoveries += frame.recoveries;
  SkipCounts skipped{};
  BuiltInCounts always{};
  const auto add = [](const auto& counts, auto& sums) {
    for (std::size_t k = 0; k < sums.size(); ++k) {
      sums[k].skipped += counts[k].skipped;
      sums[k].of += counts[k].of;
      sums[k].seconds += counts[k].seconds;
    }
  };
  for (const FrameStats& frame : run.frames) {
    add(frame.skipped, skipped);
    add(frame.always, always);
  }
  json switches = json::object();
  for (const Skip& skip : skipTable()) switches[skip.name] = demo.scene.skips[skip.id];
  json characters = json::array(), frames = json::array();
  for (const Actor& actor : demo.actors) characters.push_back(actorJson(actor, demo.scene.sim));
  for (const FrameStats& frame : run.frames)
    frames.push_back(frameJson(frame, run.first + std::ssize(frames), run.fps));
  const json report = {
      {"scene", demo.scene.name},
      {"renderer", run.renderer},
      {"characters", characters},
      {"time_step_seconds", demo.running.time_step},
      {"budget", budgetJson(run, demo)},
      {"draw_budget", drawBudgetJson(run, demo)},
      {"deadline", deadlineJson(run, demo.deadline)},
      {"comparison", comparisonJson(demo)},
      {"skips", switches},
      {"frames_per_second", run.fps},
      {"start_milliseconds", 1e3 * run.start_seconds},
      {"summary",
       {{"counts", {{"frames", run.frames.size()}, {"recoveries", recoveries}}},
        {"milliseconds",
         {{"frame", milliseconds(gather(run, [](const FrameStats& f) { return f.whole; }))},
          {"simulation", milliseconds(gather(run, [](const FrameStats& f) { return f.simulation(); }))},
          {"stages", stages}}},
        {"lost_seconds", demo.clock.lost},
        {"skipped", skippedJson(skipped)},
        {"always_skipped", alwaysJson(always)}}},
      {"frames", frames}};
  writeFile(file, report.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
}

namespace {

// How the deadline was kept; empty without one.
std::string deadlineLine(const RunReport& run, const Deadline& counted) {
  const double deadline = counted.seconds, units = deadline / counted.seconds_per_unit;
  if (deadline <= 0 || run.frames.empty()) return "";
  int over = 0, over_units = 0, cut = 0;
  double longest = 0;
  for (const FrameStats& frame : run.frames) {
    over += frame.simulation() > deadline;
    over_units += frame.work_units > units;
    cut += frame.solves_cut > 0 || frame.corrections_cut > 0;
    longest = std::max(longest, frame.simulation());
  }
  std::ostringstream text;
  text << "  deadline   " << threeDigits(1e3 * deadline) << " ms: ";
  if (over == 0) text << "kept in every frame";
  if (over > 0) text << "not kept in " << over << " of " << run.frames.size() << " frames";
  if (counted.counted) text << "; by the work counted (" << threeDigits(units) << " units) over it in " << over_units;
  text << ", the longest took " << threeDigits(1e3 * longest) << " ms; work left out in " << cut << " frames, "
       << threeDigits(run.frames.back().lost) << " s of motion given up\n";
  return text.str();
}

// How a budget was held in the frames that `pick` has a time for, in seconds; empty without one.
template <class Pick>
std::string budgetLine(const char* name, double budget, const std::string& rung, const RunReport& run, Pick pick) {
  std::vector<double> times = gather(run, pick);
  std::erase_if(times, [](double seconds) { return seconds <= 0; });
  if (budget <= 0 || times.empty()) return "";
  const auto over = std::ranges::count_if(times, [&](double seconds) { return seconds > budget; });
  std::ostringstream text;
  text << "  budget of " << name << " " << threeDigits(1e3 * budget) << " ms: ";
  if (over == 0) text << "held in every frame";
  if (over > 0) text << "not held in " << over << " of " << times.size() << " frames";
  text << "; the last had \"" << rung << "\"\n";
  return text.str();
}

// Pins that let go while the run went on; empty where all held.
std::string pinsLine(const RunReport& run) {
  const auto away = std::ranges::count_if(run.frames, [](const FrameStats& f) { return f.pins_out_of_reach > 0; });
  if (away == 0) return "";
  const auto most = std::ranges::max(run.frames, {}, &FrameStats::pins_out_of_reach).pins_out_of_reach;
  return "  pins       up to " + std::to_string(most) + " let go in " +
         countOf(static_cast<std::size_t>(away), "frame") + ": farther from the root than twice the hair's length\n";
}

}  // namespace

std::string summary(const RunReport& run, const Demo& demo) {
  // Frames between two steps take no time; where most are such, the median is of the others.
  const auto stepped = std::ranges::count_if(run.frames, [](const FrameStats& f) { return f.steps > 0; });
  const bool some = stepped > 0 && 2 * stepped <= std::ssize(run.frames);
  std::vector<double> simulation;
  for (const FrameStats& f : run.frames)
    if (!some || f.steps > 0) simulation.push_back(f.simulation());
  const std::string of = some ? ", of the " + std::to_string(stepped) + " that took a step" : "";
  const std::string both = demo.comparison.on() ? " of both, compared" : "";
  const bool drawn = std::ranges::any_of(run.frames, [](const FrameStats& f) { return !f.draw.stages.empty(); });
  return "median of " + countOf(run.frames.size(), "frame") + ":\n" + "  frame      " +
         threeDigits(1e3 * median(gather(run, [](const FrameStats& f) { return f.whole; }))) + " ms" + both +
         "\n  simulation " + threeDigits(1e3 * median(simulation)) + " ms" + of + "\n" +
         (drawn ? "  drawing    " +
                      threeDigits(1e3 * median(gather(run, [](const FrameStats& f) { return f.seconds[kTimeDraw]; }))) +
                      " ms\n"
                : "") +
         budgetLine("simulation", demo.governor.budget, rungName(demo.governor), run,
                    [](const FrameStats& f) { return f.simulation(); }) +
         budgetLine("drawing", demo.draw_governor.budget, drawRungName(demo.draw_governor), run,
                    [](const FrameStats& f) { return f.draw.stages.empty() ? 0 : f.seconds[kTimeDraw]; }) +
         deadlineLine(run, demo.deadline) + pinsLine(run);
}

}  // namespace app

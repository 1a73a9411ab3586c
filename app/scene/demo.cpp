#include "app/scene/demo.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/files/errors.h"
#include "app/scene/attachments.h"
#include "app/scene/detail/level_of_detail.h"
#include "app/scene/sim_to_render.h"
#include "app/scene/view/figure_input.h"
#include "app/scene/view/world_light.h"

namespace app {

namespace {

constexpr double kWholeTurn = 2 * 3.14159265358979323846;

// How many steps the frame takes: the clock's, or those asked for one by one.
int stepsToTake(double seconds, Demo& demo) {
  const sim::SimParams& params = demo.running;
  const int most = affordableSteps(params.max_steps_per_frame, demo.deadline);
  if (!demo.paused) return tick(seconds, params.time_step, most, demo.clock);
  const int steps = std::exchange(demo.single_steps, 0);
  stepSingly(steps, params.time_step, demo.clock);
  return steps;
}

// Takes one of the frame's steps, with so many more to come.
void moveActors(double time, int more, Demo& demo) {
  long all = 0;
  for (const Actor& actor : demo.actors) all += actor.haircut->mesh.vertexCount();
  long to_come = (1 + more) * all;
  for (Actor& actor : demo.actors) {
    const int vertices = actor.haircut->mesh.vertexCount();
    actor.max_work = workOfStep(vertices, to_come, demo.deadline);
    to_come -= vertices;
    const double before = demo.stats.work_units;
    stepInDetail(time, demo, actor);
    if (demo.deadline.seconds > 0) demo.deadline.left -= demo.stats.work_units - before;
  }
}

// What the frame cost and how far it strayed, to the governor.
void updateGovernor(double seconds, int steps, Demo& demo) {
  FrameStats& stats = demo.stats;
  stats.rung = demo.governor.budget > 0 ? demo.governor.rung : -1;
  if (demo.paused || stats.rung < 0) return;
  FrameCost frame;
  frame.shown = std::max(0.0, seconds);
  frame.simulated = steps * demo.running.time_step;
  frame.cost = demo.governor.counted ? stats.counted_cost : stats.simulation();
  if (stats.steps > 0) frame.error = accumulatedError(demo.running.integrator, stats.step_error / stats.steps);
  observe(frame, demo.governor);
}

// What the drawing of the frame took, to its governor. A frame that was kept took nothing, and says nothing.
void updateDrawGovernor(double seconds, Demo& demo) {
  const render::FrameReport& drawn = demo.stats.draw;
  demo.stats.draw_rung = demo.draw_governor.budget > 0 ? demo.draw_governor.rung : -1;
  if (demo.stats.draw_rung < 0 || drawn.stages.empty() || drawn.skip_counts.frame.skipped > 0) return;
  observeDrawing(seconds, demo.stats.drawing(), demo.draw_governor);
}

// Nothing is handed over when neither a step nor the clock has moved since the last time.
void handOverPositions(bool moved, Demo& demo) {
  const double fraction = shownFraction(demo.clock, demo.running.time_step);
  if (const Vec3 origin = pictureOrigin(demo.camera.anchor); origin != demo.origin) {
    demo.origin = origin;
    for (Actor& actor : demo.actors) actor.shown_still = false;
    moved = true;
  }
  if (moved || fraction != demo.shown_fraction || !demo.scene.skips[kSkipPose]) {
    for (Actor& actor : demo.actors) showActor(fraction, demo.origin, actor);
    demo.shown_fraction = fraction;
  }
  demo.debug_geometry.lines.clear();
  demo.debug_geometry.triangles.clear();
  demo.debug_geometry.points.clear();
  if (!demo.debug.any()) return;
  for (const Actor& actor : demo.actors) addDebugViews(demo.debug, actor, demo.debug_geometry);
  const render::Float3 origin = toFloat3(demo.origin);
  for (auto* vertices : {&demo.debug_geometry.lines, &demo.debug_geometry.triangles, &demo.debug_geometry.points}) {
    for (render::LineVertex& vertex : *vertices) {
      for (std::size_t k = 0; k < 3; ++k) vertex.position[k] -= origin[k];
    }
  }
}

void showFault(Demo& demo) {
  const std::string note = numericalNote(demo.stats);
  if (note.empty()) return;
  demo.message = note;
  demo.message_is_fault = demo.stats.recoveries > 0;
}

// By what was simulated: time that is given up does not count, and steps taken one by one do. `before`: the clock as
// the frame began.
void advanceShownTime(double seconds, const FixedClock& before, Demo& demo) {
  const FixedClock& clock = demo.clock;
  demo.shown_time +=
      demo.paused ? (clock.time - clock.ahead) - (before.time - before.ahead) : seconds - (clock.lost - before.lost);
  demo.stats.shown_time = demo.shown_time;
  demo.stats.lost = demo.clock.lost;
}

render::DrawSkips drawSkips(const SkipSet& skips) {
  render::DrawSkips draw;
  draw.frame = skips[kSkipFrame];
  draw.rows = skips[kSkipRows];
  draw.shadows = skips[kSkipShadows];
  draw.view = skips[kSkipView];
  draw.shadow_view = skips[kSkipShadowView];
  draw.body_parts = skips[kSkipBodyParts];
  draw.body_detail = skips[kSkipBodyDetail];
  draw.strands = skips[kSkipStrands];
  draw.segments = skips[kSkipSegments];
  draw.shadow_detail = skips[kSkipShadowDetail];
  draw.skin = skips[kSkipSkin];
  draw.shading = skips[kSkipShading];
  draw.hair_light = skips[kSkipHairLight];
  draw.sky_visibility = skips[kSkipSkyVisibility];
  return draw;
}

// A frame that takes no step because time stands still has no times to tell.
void addToHistory(Demo& demo) {
  if (demo.paused && demo.stats.steps == 0 && !demo.history.empty()) return;
  if (demo.history.size() < kHistoryLength) {
    demo.history.push_back(demo.stats);
  } else {
    demo.history[demo.history_next] = demo.stats;
  }
  demo.history_next = (demo.history_next + 1) % kHistoryLength;
}

}  // namespace

void addDrawing(const render::DrawSkipCounts& drawing, SkipCounts& counts) {
  const auto add = [&](SkipId id, const render::SkipCount& count) {
    counts[id].skipped += count.skipped;
    counts[id].of += count.of;
  };
  add(kSkipFrame, drawing.frame);
  add(kSkipRows, drawing.rows);
  add(kSkipShadows, drawing.shadows);
  add(kSkipView, drawing.view);
  add(kSkipShadowView, drawing.shadow_view);
  add(kSkipBodyParts, drawing.body_parts);
  add(kSkipBodyDetail, drawing.body_detail);
  add(kSkipStrands, drawing.strands);
  add(kSkipSegments, drawing.segments);
  add(kSkipShadowDetail, drawing.shadow_detail);
  add(kSkipSkin, drawing.skin);
  add(kSkipShading, drawing.shading);
  add(kSkipHairLight, drawing.hair_light);
  add(kSkipSkyVisibility, drawing.sky_visibility);
}

void addWork(const FrameStats& more, FrameStats& stats) {
  for (std::size_t k = 0; k < stats.seconds.size(); ++k) stats.seconds[k] += more.seconds[k];
  stats.whole += more.whole;
  stats.steps += more.steps;
  stats.solver_iterations += more.solver_iterations;
  stats.solves += more.solves;
  stats.minimization_iterations += more.minimization_iterations;
  stats.residual = std::max(stats.residual, more.residual);
  stats.residual_acceleration = std::max(stats.residual_acceleration, more.residual_acceleration);
  stats.converged = stats.converged && more.converged;
  stats.work_units += more.work_units;
  stats.solves_cut += more.solves_cut;
  stats.corrections_cut += more.corrections_cut;
  stats.contacts += more.contacts;
  stats.corrected += more.corrected;
  stats.recoveries += more.recoveries;
  if (more.recoveries > 0) stats.fault_report = more.fault_report;
  stats.carried += more.carried;
  stats.guided += more.guided;
  stats.pins_out_of_reach = std::max(stats.pins_out_of_reach, more.pins_out_of_reach);
  stats.max_penetration = std::max(stats.max_penetration, more.max_penetration);
  for (std::size_t id = 0; id < stats.always.size(); ++id) {
    stats.always[id].skipped += more.always[id].skipped;
    stats.always[id].of += more.always[id].of;
  }
}

void addStep(const sim::StepReport& report, double step_seconds, FrameStats& stats) {
  FrameStats step;
  double inside = 0;
  for (const double stage : report.seconds) inside += stage;
  step.seconds[kTimeForces] = report.seconds[sim::kStageForces];
  step.seconds[kTimeSolve] = report.seconds[sim::kStageSolve];
  step.seconds[kTimeCollision] = report.seconds[sim::kStageCollision];
  step.seconds[kTimeMinimization] = report.seconds[sim::kStageMinimization];
  step.seconds[kTimeStepOther] = report.seconds[sim::kStageOther];
  // A step of an actor is its simulation and, before that, its pose.
  step.seconds[kTimeCharacter] = std::max(0.0, step_seconds - inside);
  step.steps = 1;
  step.solver_iterations = report.solver_iterations;
  step.solves = report.solves;
  step.minimization_iterations = report.minimization_iterations;
  step.residual = report.residual;
  step.residual_acceleration = report.residual_acceleration;
  step.converged = report.converged;
  step.work_units = report.work_units;
  step.solves_cut = report.solve_cut;
  step.corrections_cut = report.corrections_cut;
  step.contacts = report.contacts;
  step.corrected = report.corrected;
  step.recoveries = report.recoveries;
  step.fault_report = report.fault_report;
  step.carried = report.carried;
  step.guided = report.guided;
  step.pins_out_of_reach = report.pins_out_of_reach;
  step.max_penetration = report.max_penetration;
  count(report.contacts == 0 && report.corrected == 0, step.always[kNoContact]);
  count(report.solver_iterations == 0, step.always[kSolvedAtStart]);
  step.always[kNoNewBalance] = {report.refreshes.skipped, report.refreshes.of};
  step.always[kNoStiffness] = {report.force_kinds.skipped, report.force_kinds.of};
  step.always[kOutOfReach] = {report.collider_tests.skipped, report.collider_tests.of};
  addWork(step, stats);
}

std::string numericalNote(const FrameStats& stats) {
  if (stats.recoveries > 0)
    return std::to_string(stats.recoveries) + " recoveries from numerical trouble: " + faultText(stats.fault_report);
  return stats.carried > 0 ? "the head jumped; the hair was carried along" : "";
}

std::string hairNotes(std::span<const Actor> actors) {
  std::string notes;
  for (const Actor& actor : actors) {
    for (const std::string& note : {actor.haircut->note, attachmentNotes(actor)})
      if (!note.empty() && notes.find(note) == std::string::npos) notes += (notes.empty() ? "" : "\n") + note;
  }
  return notes;
}

namespace {

// Of several characters a fault says whose it is.
Actor makeOneOf(const Scene& scene, std::size_t i, AssetCache& asset_cache) {
  try {
    return makeActor(scene.characters[i], scene.playback, asset_cache);
  } catch (const InputError& error) {
    if (scene.file.empty() || scene.characters.size() < 2) throw;
    throw InputError(scene.file, "/characters/" + std::to_string(i), error.what(), "");
  }
}

}  // namespace

Demo openScene(Scene scene, double aspect, bool beside) {
  Demo demo;
  demo.scene = std::move(scene);
  demo.aspect = aspect;
  for (std::size_t i = 0; i < demo.scene.characters.size(); ++i) {
    demo.actors.push_back(makeOneOf(demo.scene, i, demo.asset_cache));
    demo.actors.back().steps = demo.actors.size();
  }
  demo.loading.on = beside;
  followColliders(demo);
  demo.running = demo.scene.sim;
  setBudget(1e-3 * demo.scene.playback.budget_ms, demo.governor);
  setDrawBudget(1e-3 * demo.scene.playback.draw_budget_ms, demo.draw_governor);
  demo.deadline.seconds = 1e-3 * demo.scene.playback.deadline_ms;
  const double settle = demo.scene.playback.settle;
  settleActor(demo.scene.sim, settle, demo.actors.front());
  demo.camera = makeCamera(demo.scene.camera, demo.actors.front(), aspect);
  for (std::size_t i = 0; i < demo.bookmarks.size(); ++i)
    if (const auto& kept = demo.scene.bookmarks[i]) demo.bookmarks[i] = makeCamera(*kept, demo.actors.front(), aspect);
  chooseDetail(demo);
  for (std::size_t i = 1; i < demo.actors.size(); ++i) {
    settleInDetail(settle, demo, demo.actors[i]);
  }
  for (Actor& actor : demo.actors) actor.context->refreshGradually(true);
  demo.message = hairNotes(demo.actors);
  keepBase(demo);
  return demo;
}

void keepBase(Demo& demo) {
  RowValues& base = demo.scene.base;
  base = {demo.scene.sim, {}, demo.scene.look};
  for (const Actor& actor : demo.actors) base.hairs.push_back(actor.spec.look);
}

render::FrameInput frameInput(Demo& demo, int width, int height) {
  demo.hair_inputs.clear();
  demo.body_inputs.clear();
  demo.drawn_hair.resize(demo.actors.size());
  demo.bands.resize(demo.actors.size());
  for (std::size_t i = 0; i < demo.actors.size(); ++i) {
    const Actor& actor = demo.actors[i];
    demo.hair_inputs.push_back(hairInput(actor, actor.spec.look, actor.shown_positions, demo.drawn_hair[i]));
    demo.body_inputs.push_back(bodyInput(actor, actor.spec.look, demo.scene.look.view.show_strands));
    for (std::size_t k = 0; k < actor.worn.size(); ++k)
      demo.body_inputs.push_back(attachmentInput(actor, k, demo.scene.look.view.show_strands));
    if (demo.scene.look.view.show_strands) addBands(actor, actor.shown_positions, demo.bands[i], demo.body_inputs);
  }
  render::FrameInput input;
  input.width = width;
  input.height = height;
  input.camera = cameraInput(demo.camera, demo.place, demo.origin);
  input.light = lightAbout(demo.actors.front(), demo.scene.look.light);
  input.view = demo.scene.look.view;
  input.skips = drawSkips(demo.scene.skips);
  input.hairs = demo.hair_inputs;
  input.bodies = demo.body_inputs;
  input.debug_lines = demo.debug_geometry.lines;
  input.debug_triangles = demo.debug_geometry.triangles;
  input.debug_points = demo.debug_geometry.points;
  governDrawing(demo.draw_governor, input);
  return input;
}

namespace {

// Side by side each half's own free part lies between its panels and the middle. Both show the figure in one size.
void placeHalves(const PicturePart& free, double aspect, ViewPlace& left, ViewPlace& right) {
  const auto halfFrom = [&](double low) {
    PicturePart half = free;
    half.left = std::clamp(2 * (free.left - low), 0.0, 1.0);
    half.right = std::clamp(2 * (free.right - low), 0.0, 1.0);
    return half;
  };
  const PicturePart first = halfFrom(0), second = halfFrom(0.5);
  const double zoom = std::min(placeIn(first, aspect).zoom, placeIn(second, aspect).zoom);
  left = placeIn(first, aspect, zoom), right = placeIn(second, aspect, zoom);
}

// The demo and the one that it is compared with, in one picture, and in the same detail.
render::FrameReport drawPair(Demo& demo, const FrameTarget& target, bool measure) {
  const Comparison& comparison = demo.comparison;
  const render::PairLayout layout{comparison.side_by_side, comparison.line};
  const int left = render::firstWidth(layout, target.width), right = render::secondWidth(layout, target.width);
  demo.aspect = static_cast<double>(left) / target.height;
  Demo& other = demo.comparison.other.front();
  other.place = demo.place;
  if (comparison.side_by_side) {
    placeHalves(target.free, demo.aspect, demo.place, other.place);
  }
  other.draw_governor = demo.draw_governor;
  const render::FrameInput first = frameInput(demo, left, target.height);
  const render::FrameInput second = frameInput(other, right, target.height);
  if (target.pixels) {
    return target.pair->renderImage(*target.renderer, first, second, layout, target.width, *target.pixels, measure);
  }
  return target.pair->renderFrame(*target.renderer, first, second, layout, target.width, target.framebuffer, measure);
}

}  // namespace

void drawFrame(Demo& demo, const FrameTarget& target) {
  count(!target.renderer, demo.stats.always[kNoPicture]);
  if (!target.renderer || target.width <= 0 || target.height <= 0) return;
  demo.aspect = static_cast<double>(target.width) / target.height;
  demo.picture_height = target.height;
  demo.place = placeIn(target.free, demo.aspect);
  const bool measure = target.measure || demo.draw_governor.budget > 0;
  if (demo.comparison.on() && target.pair) {
    demo.stats.draw = drawPair(demo, target, measure);
    return addDrawing(demo.stats.draw.skip_counts, demo.stats.skipped);
  }
  const render::FrameInput input = frameInput(demo, target.width, target.height);
  demo.stats.draw = target.pixels ? target.renderer->renderImage(input, *target.pixels, measure)
                                  : target.renderer->renderFrame(input, target.framebuffer, measure);
  addDrawing(demo.stats.draw.skip_counts, demo.stats.skipped);
}

namespace {

// The steps of a frame of `seconds`; returns how many there were.
int takeSteps(double seconds, Demo& demo) {
  demo.running = governed(demo.scene.sim, demo.governor);
  const int steps = stepsToTake(seconds, demo);
  if (steps > 0) {
    noteMoment(demo.edits);
    chooseDetail(demo);
  }
  for (int i = 1; i <= steps; ++i) moveActors(demo.clock.time - (steps - i) * demo.running.time_step, steps - i, demo);
  return steps;
}

}  // namespace

void simulateAgain(double seconds, Demo& demo) {
  const FrameStats stats = demo.stats;
  const bool paused = std::exchange(demo.paused, seconds < 0);
  const int single_steps = std::exchange(demo.single_steps, seconds < 0 ? 1 : 0);
  followColliders(demo);
  const FixedClock before = demo.clock;
  takeSteps(std::max(0.0, seconds), demo);
  advanceShownTime(std::max(0.0, seconds), before, demo);
  ++demo.frames;
  demo.stats = stats;
  demo.paused = paused, demo.single_steps = single_steps;
}

void advanceFrame(Demo& demo, double seconds, const FrameTarget& target) {
  const double start = now();
  followRange(demo);
  demo.stats = FrameStats{};
  const bool asked = !demo.requests.empty();
  std::vector<Request> of_both = sharedRequests(demo.requests);
  applyRequests(demo);
  leaveCachedFrame(demo);
  followColliders(demo);

  const FixedClock before = demo.clock;
  const int steps = takeSteps(seconds, demo);
  count(demo.paused && steps == 0, demo.stats.always[kPausedFrame]);
  observeWork(steps, demo.stats.work_units, demo.stats.simulation(), demo.deadline);
  updateGovernor(seconds, steps, demo);
  showFault(demo);

  timed(demo.stats.seconds[kTimeHandOver], [&] { handOverPositions(asked || steps > 0, demo); });
  follow(demo.actors.front(), seconds, demo.aspect, demo.camera);
  if (demo.turntable != 0) demo.camera.yaw = std::remainder(demo.camera.yaw + demo.turntable * seconds, kWholeTurn);

  advanceShownTime(seconds, before, demo);
  ++demo.frames;
  keepMoment(seconds, demo);
  advanceCompared(seconds, std::move(of_both), demo);

  glide(seconds, demo.draw_governor);
  timed(demo.stats.seconds[kTimeDraw], [&] { drawFrame(demo, target); });
  updateDrawGovernor(seconds, demo);
  if (target.draw_panels) {
    timed(demo.stats.seconds[kTimePanels], [&] { target.draw_panels(demo); });
  }
  demo.stats.whole = now() - start;
  addToHistory(demo);
}

}  // namespace app

#include "tests/bench/draw_scene.h"

#include <algorithm>
#include <utility>

#include "app/files/data_path.h"
#include "tests/bench/cpu_clock.h"

namespace bench {
namespace {

constexpr double kFrameSeconds = 1.0 / 60;
constexpr int kFiner = 4;               // pixels of the reference along one of the picture's
constexpr float kFinerDetail = 2;       // of the level of detail, for each of those
constexpr int kReferenceShadow = 2048;  // pixels a side of a hair's map
constexpr int kReferenceSegments = 8, kReferenceSamples = 16;

app::Demo openDrawScene(const DrawScene& scene) {
  app::Scene opened = app::loadScene(app::dataPath(std::string("assets/scenes/") + scene.file));
  if (*scene.framing) opened.camera.framing = scene.framing;
  app::Demo demo = app::openScene(std::move(opened), static_cast<double>(scene.width) / scene.height);
  demo.picture_height = scene.height;
  demo.camera.distance *= scene.nearer;
  return demo;
}

}  // namespace

std::vector<DrawScene> drawScenes() {
  return {{"close_up", "default.json", "head", 0.42, 320, 180, 75},
          {"bust", "walk.json", "bust", 1, 320, 180, 40},
          {"figure", "walk.json", "figure", 1, 320, 180, 40},
          {"ten", "ten_in_a_row.json", "", 1, 320, 180, 24},
          {"hundred", "crowd.json", "", 1, 256, 144, 24}};
}

DrawStage::DrawStage(const DrawScene& scene, render::Renderer& renderer)
    : scene_(scene), renderer_(renderer), demo_(openDrawScene(scene)) {
  for (int frame = 0; frame < scene.frames; ++frame) app::advanceFrame(demo_, frame == 0 ? 0 : kFrameSeconds, {});
  moments_[0] = shownNow();
  app::advanceFrame(demo_, kFrameSeconds, {});
  moments_[1] = shownNow();
}

std::vector<DrawStage::Shown> DrawStage::shownNow() const {
  std::vector<Shown> moment;
  for (const app::Actor& actor : demo_.actors) {
    Shown& shown = moment.emplace_back();
    shown.positions = actor.shown_positions;
    shown.skin = actor.shown_skin;
    shown.joints = actor.joint_matrices;
    for (const app::WornAttachment& worn : actor.worn) shown.worn.push_back(worn.matrix);
  }
  return moment;
}

void DrawStage::show(const std::vector<Shown>& moment) {
  for (std::size_t i = 0; i < moment.size(); ++i) {
    app::Actor& actor = demo_.actors[i];
    actor.shown_positions = moment[i].positions;
    actor.shown_skin = moment[i].skin;
    actor.joint_matrices = moment[i].joints;
    for (std::size_t k = 0; k < actor.worn.size(); ++k) actor.worn[k].matrix = moment[i].worn[k];
    ++actor.position_revision;
    ++actor.pose_revision;
  }
}

render::FrameInput DrawStage::frame(const DrawSetting& setting, int moment, int width, int height) {
  show(moments_[moment]);
  render::FrameInput input = app::frameInput(demo_, width, height);
  setting.apply(input, demo_.hair_inputs);
  return input;
}

DrawnFrame DrawStage::draw(const DrawSetting& setting) {
  std::vector<unsigned char> rgba;
  renderer_.renderImage(frame(setting, 0, scene_.width, scene_.height), rgba);
  const render::FrameInput input = frame(setting, 1, scene_.width, scene_.height);
  DrawnFrame drawn;
  const double wall = secondsOf(CLOCK_MONOTONIC), processor = secondsOf(CLOCK_PROCESS_CPUTIME_ID);
  const render::FrameReport report = renderer_.renderImage(input, rgba);
  drawn.processor = secondsOf(CLOCK_PROCESS_CPUTIME_ID) - processor;
  drawn.wall = secondsOf(CLOCK_MONOTONIC) - wall;
  drawn.strands = report.strands_drawn;
  drawn.picture = levelsOf(scene_.width, scene_.height, rgba);
  return drawn;
}

LevelPicture referencePicture(app::Demo& demo, int width, int height, render::Renderer& renderer,
                              LevelPicture* larger) {
  render::FrameInput input = app::frameInput(demo, kFiner * width, kFiner * height);
  for (render::HairInput& hair : demo.hair_inputs) hair.segments_per_layer = kReferenceSegments;
  input.hairs = demo.hair_inputs;
  input.view.samples = kReferenceSamples;
  input.view.strands_per_pixel *= kFinerDetail;
  input.view.segment_error /= kFinerDetail;
  input.light.shadow_strands = 0;
  input.light.shadow_strands_per_pixel *= kFinerDetail;
  input.light.shadow_size = kReferenceShadow;
  input.skips.hair_light = input.skips.sky_visibility = false;
  std::vector<unsigned char> rgba;
  renderer.renderImage(input, rgba);
  LevelPicture fine = levelsOf(kFiner * width, kFiner * height, rgba), picture = averagedDown(fine, kFiner);
  if (larger) *larger = std::move(fine);
  return picture;
}

DrawReference DrawStage::reference() {
  show(moments_[1]);
  LevelPicture larger;
  DrawReference reference{referencePicture(demo_, scene_.width, scene_.height, renderer_, &larger), {}};
  const PictureError off =
      differenceOf(averagedDown(larger, kFiner, Half::kEven), averagedDown(larger, kFiner, Half::kOdd));
  reference.own = {0.5 * off.rms, 0.5 * off.blocks};  // the mean of two independent halves is off by half as much
  return reference;
}

}  // namespace bench

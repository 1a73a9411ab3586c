#include "app/platform/preset_pictures.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace app {

namespace {

// While a slider is dragged every frame has another subject: pictures are made once it has stayed for so many frames.
constexpr int kStillFrames = 10;
constexpr int kPicturePoints = 112;  // a side, pixels at a text scale of one

// Recordings, loading and a drawing budget that is short of time go before.
bool moreUrgent(const Demo& demo) {
  return demo.capture.recording || demo.capture.screenshot || demo.loading.running.valid() ||
         (demo.draw_governor.budget > 0 && (demo.draw_governor.rung > 0 || demo.draw_governor.over_budget));
}

std::filesystem::file_time_type writtenAt(const std::string& file) {
  std::error_code ignored;
  return std::filesystem::last_write_time(file, ignored);
}

}  // namespace

PresetPictures::PresetPictures(std::string shader_dir, bool waits)
    : shader_dir_(std::move(shader_dir)), waits_(waits) {}

PresetPictures::~PresetPictures() = default;

PresetPictures::Picture& PresetPictures::pictureOf(const std::string& file) {
  const auto at = std::ranges::find(pictures_, file, [](const auto& picture) { return picture->file; });
  if (at != pictures_.end()) return **at;
  pictures_.push_back(std::make_unique<Picture>());
  pictures_.back()->file = file;
  return *pictures_.back();
}

void PresetPictures::begin(const std::string& file, const Demo& demo) {
  pictureOf(file).written = writtenAt(file);
  try {
    coming_.emplace(Coming{file, subject_, presetScene(file, demo), {}});
  } catch (const std::exception&) {
    // What is wrong with it is said where it is chosen.
    Picture& picture = pictureOf(file);
    picture.subject = subject_;
    picture.faulty = true;
    return;
  }
  if (std::optional<Swing> swing = swingOf(coming_->preset, demo))
    coming_->hair = std::async(std::launch::async, [of = std::move(*swing)] { return swungHair(of); });
}

void PresetPictures::finish(const Demo& demo, int side) {
  const std::vector<Vec3> hair = coming_->hair.valid() ? coming_->hair.get() : std::vector<Vec3>();
  if (coming_->subject == subject_) {
    if (!renderer_) renderer_ = std::make_unique<render::Renderer>(shader_dir_);
    Picture& picture = pictureOf(coming_->file);
    picture.image.prepare(side, side);
    renderer_->renderFrame(presetFrame(demo, hair, side, side, ++revision_, coming_->preset),
                           picture.image.framebuffer());
    picture.subject = std::move(coming_->subject);
    picture.faulty = false;
  }
  coming_.reset();
}

bool PresetPictures::work(const Demo& demo, UiState& ui) {
  if (ui.presets_in_sight.empty() || moreUrgent(demo)) return false;
  PictureSubject subject = pictureSubject(demo);
  still_ = subject == subject_ ? still_ + 1 : 0;
  subject_ = std::move(subject);
  if (still_ < kStillFrames) return true;
  const auto side = static_cast<int>(std::lround(kPicturePoints * ui.text_scale));
  if (!coming_) {
    const auto old = [&](const std::string& file) {
      const Picture& picture = pictureOf(file);
      return picture.subject != subject_ || picture.written != writtenAt(file);
    };
    const auto next = std::ranges::find_if(ui.presets_in_sight, old);
    if (next == ui.presets_in_sight.end()) return false;
    begin(*next, demo);
  }
  if (coming_) {
    const bool there = waits_ || !coming_->hair.valid() ||
                       coming_->hair.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    if (there) finish(demo, side);
  }
  ui.preset_pictures.clear();
  for (const auto& picture : pictures_)
    ui.preset_pictures.push_back({picture->file, picture->image.texture(), picture->faulty});
  return true;
}

}  // namespace app

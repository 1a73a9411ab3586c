#include "app/platform/capture.h"

#include <cstdio>
#include <filesystem>

#include "app/files/errors.h"
#include "app/files/image_io.h"
#include "app/files/report_line.h"
#include "render/gl/read_back.h"

namespace app {

namespace {

// Without panels, and so with the view over all of the picture.
std::vector<unsigned char> drawn(Demo& demo, const FrameTarget& target) {
  std::vector<unsigned char> pixels;
  const ViewPlace place = demo.place;
  if (demo.comparison.on() && target.pair) {
    FrameTarget offscreen = target;
    offscreen.pixels = &pixels;
    offscreen.free = {};
    drawFrame(demo, offscreen);
  } else {
    demo.place = {};
    target.renderer->renderImage(frameInput(demo, target.width, target.height), pixels);
  }
  demo.place = place;
  return pixels;
}

void say(const std::string& text, Demo& demo) {
  demo.message = text;
  demo.message_is_fault = false;
}

void writeScreenshot(Demo& demo, const FrameTarget& target) {
  Capture& capture = demo.capture;
  capture.screenshot = false;
  const std::string file = capture.screenshot_file.empty() ? freeName("hairmesh", ".png") : capture.screenshot_file;
  writePng(file, target.width, target.height, drawn(demo, target));
  say("screenshot " + file, demo);
}

}  // namespace

void PictureWriter::recordFrame(Demo& demo, const FrameTarget& target) {
  Capture& capture = demo.capture;
  if (capture.recorded == 0) {
    capture.folder = freeName("recording", "");
    std::error_code error;
    std::filesystem::create_directory(capture.folder, error);
    if (error)
      throw OutputError(capture.folder, "cannot be made: " + error.message(),
                        "start in a folder that may be written to");
    if (canWriteVideo())
      film_ =
          std::make_unique<VideoWriter>(capture.folder + ".mp4", target.width, target.height, demo.scene.playback.fps);
    say("recording into " + capture.folder, demo);
  }
  const std::vector<unsigned char> pixels = drawn(demo, target);
  char name[32];
  std::snprintf(name, sizeof name, "frame_%04d.png", capture.recorded);
  writePng((std::filesystem::path(capture.folder) / name).string(), target.width, target.height, pixels);
  // A film has one size: in another window size the pictures alone go on.
  if (film_ && film_->width() == target.width && film_->height() == target.height) film_->add(pixels);
  capture.recorded += 1;
}

void PictureWriter::endRecording(Demo& demo) {
  const Capture& capture = demo.capture;
  std::string text = countOf(capture.recorded, "frame") + " in " + capture.folder;
  if (film_) {
    film_->finish();
    text += " and " + film_->file() + film_->sizeNote();
  } else {
    text += "; with the package ffmpeg installed they would be a film as well";
  }
  film_.reset();
  say(text, demo);
}

std::string freeName(const std::string& prefix, const std::string& ending) {
  for (int number = 1;; ++number) {
    char digits[16];
    std::snprintf(digits, sizeof digits, "-%04d", number);
    const std::string name = prefix + digits + ending;
    if (!std::filesystem::exists(name)) return name;
  }
}

void PictureWriter::close(Demo& demo) {
  demo.capture.screenshot = demo.capture.recording = false;
  write(demo, {});
}

void PictureWriter::write(Demo& demo, const FrameTarget& target) {
  Capture& capture = demo.capture;
  try {
    if (capture.screenshot) writeScreenshot(demo, target);
    if (capture.recording) recordFrame(demo, target);
    if (recording_ && !capture.recording) endRecording(demo);
  } catch (const std::exception& fault) {
    demo.message = fault.what();
    demo.message_is_fault = true;
    capture.screenshot = capture.recording = false;
    film_.reset();
  }
  recording_ = capture.recording;
}

void writeWindow(const std::string& file, const FrameTarget& target) {
  if (file.empty()) return;
  std::vector<unsigned char> pixels;
  render::readFramebuffer(0, target.width, target.height, pixels);
  writePng(file, target.width, target.height, pixels);
}

}  // namespace app

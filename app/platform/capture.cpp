#include "app/platform/capture.h"

#include <cstdio>
#include <filesystem>

#include "app/files/errors.h"
#include "app/files/image_io.h"

namespace app {

namespace {

void writePicture(const std::string& file, Demo& demo, const FrameTarget& target) {
  std::vector<unsigned char> pixels;
  target.renderer->renderImage(frameInput(demo, target.width, target.height), pixels);
  writePng(file, target.width, target.height, pixels);
}

void writeScreenshot(Demo& demo, const FrameTarget& target) {
  Capture& capture = demo.capture;
  capture.screenshot = false;
  const std::string file = capture.screenshot_file.empty() ? freeName("hairmesh", ".png") : capture.screenshot_file;
  writePicture(file, demo, target);
  demo.message = "screenshot " + file;
  demo.message_is_fault = false;
}

void recordFrame(Demo& demo, const FrameTarget& target) {
  Capture& capture = demo.capture;
  if (capture.recorded == 0) {
    capture.folder = freeName("recording", "");
    std::filesystem::create_directories(capture.folder);
    demo.message = "recording into " + capture.folder;
    demo.message_is_fault = false;
  }
  char name[32];
  std::snprintf(name, sizeof name, "frame_%04d.png", capture.recorded);
  writePicture((std::filesystem::path(capture.folder) / name).string(), demo, target);
  capture.recorded += 1;
}

}  // namespace

std::string freeName(const std::string& prefix, const std::string& ending) {
  for (int number = 1;; ++number) {
    char digits[16];
    std::snprintf(digits, sizeof digits, "-%04d", number);
    const std::string name = prefix + digits + ending;
    if (!std::filesystem::exists(name)) return name;
  }
}

void writePictures(Demo& demo, const FrameTarget& target) {
  try {
    if (demo.capture.screenshot) writeScreenshot(demo, target);
    if (demo.capture.recording) recordFrame(demo, target);
  } catch (const std::exception& fault) {
    demo.message = fault.what();
    demo.message_is_fault = true;
    demo.capture.screenshot = demo.capture.recording = false;
  }
}

}  // namespace app

// Pictures that a person asks for while the window runs.
#pragma once

#include <memory>
#include <string>

#include "app/platform/video.h"
#include "app/scene/demo.h"

namespace app {

class PictureWriter {
 public:
  // Takes the screenshot and the recording's frame that demo.capture asks for; pictures show the scene without the
  // panels. Where ffmpeg is installed a recording becomes a film as well, beside its folder. Faults become the demo's
  // message and end the recording.
  void write(Demo& demo, const FrameTarget& target);

  // Finishes a recording that goes on: the program ends.
  void close(Demo& demo);

 private:
  std::unique_ptr<VideoWriter> film_;
  bool recording_ = false;

  void recordFrame(Demo& demo, const FrameTarget& target);
  void endRecording(Demo& demo);
};

// The window as it is, panels included, for a file that is named.
void writeWindow(const std::string& file, const FrameTarget& target);

// "prefix-0001ending", the first that does not exist.
std::string freeName(const std::string& prefix, const std::string& ending);

}  // namespace app

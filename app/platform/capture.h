// Pictures that a person asks for while the window runs.
#pragma once

#include "app/scene/demo.h"

namespace app {

// Takes the screenshot and the recording's frame that demo.capture asks for; pictures show the scene without the
// panels. Faults become the demo's message and end the recording.
void writePictures(Demo& demo, const FrameTarget& target);

// "prefix-0001ending", the first that does not exist.
std::string freeName(const std::string& prefix, const std::string& ending);

}  // namespace app

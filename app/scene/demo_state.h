// A demo's state as a file: all that outlives a frame, of every character. Frames that go on from a restored state show
// the same bits as those that went on from the saved one, with the same scene, settings and frame lengths, on the same
// build and processor.
//
// Settings are not part of it: parameters, look, pins, speed, budget and skips are those of the scene at hand. Nor is
// what the renderer keeps of figures that are small in the picture (sky visibility of a few frames ago, shadow tiles,
// levels): their pictures go on within the bounds of those skips, and to the bit where they are off.
#pragma once

#include <string>

#include "app/scene/demo.h"

namespace app {

// Of the layout; another one after every change of a field.
inline constexpr unsigned kDemoStateVersion = 3;

std::string demoStateBytes(const Demo& demo);

// Which characters with which motion and hair a scene has, in words: a state fits where this is the same.
std::string demoIdentity(const Demo& demo);

// Puts the state of a file in place. `keep_view`: the camera's direction and distance stay.
// Throws InputError when the file is no state, cut off, changed, of another version or of another scene; then nothing
// has changed.
void loadDemoState(const std::string& file, bool keep_view, Demo& demo);
// The same of bytes at hand; `name` is for messages.
void restoreDemoState(const std::string& bytes, const std::string& name, bool keep_view, Demo& demo);

}  // namespace app

// What people save: a preset, a scene, a project or a state, in the file that the request names. Each throws where it
// cannot be written, with what was there before in its place, and says what it has written.
#pragma once

#include "app/scene/request.h"

namespace app {

struct Demo;

void savePreset(const Request& request, Demo& demo);
void saveScene(const Request& request, Demo& demo);
void saveAsProject(const Request& request, Demo& demo);
void saveState(const Request& request, Demo& demo);

}  // namespace app

// --debug LIST.
#pragma once

#include <string>

#include "app/scene/view/debug_views.h"

namespace app {

// Switches on the views of a comma separated list. Throws UsageError for an unknown one.
void setDebugViews(const std::string& list, DebugViews& views);

}  // namespace app

// Whether a person means to leave.
#pragma once

#include "app/ui/ui.h"

namespace app {

// What closing the window does: where something was changed it asks at first, and closes while the question stands.
bool mayClose(Demo& demo, UiState& ui);

}  // namespace app

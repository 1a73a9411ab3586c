// Messages as the window shows them. They are written for both the command line and the window.
#pragma once

#include <string>

namespace app {

// The message without what speaks of the command line: a parenthesis, or a clause after the first, that names an option
// ("--hair"). Clauses end with "; ", ": ", ", or ", ", and " and the line.
std::string windowWords(const std::string& message);

}  // namespace app

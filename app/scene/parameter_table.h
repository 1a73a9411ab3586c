// The three parameter tables as text for people: --parameters and the README.
#pragma once

#include <string>

namespace app {

// Markdown: one table a group, a row a parameter.
std::string parameterTable();

}  // namespace app

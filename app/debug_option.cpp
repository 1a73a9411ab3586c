#include "app/debug_option.h"

#include <vector>

#include "app/options.h"
#include "sim/field_text.h"

namespace app {

void setDebugViews(const std::string& list, DebugViews& views) {
  std::vector<std::string_view> known;
  for (const DebugView& view : kDebugViews) known.push_back(view.name);
  std::size_t begin = 0;
  while (!list.empty() && begin <= list.size()) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    const std::string name = list.substr(begin, end - begin);
    bool found = false;
    for (const DebugView& view : kDebugViews) {
      if (view.name == name) found = views.*view.on = true;
    }
    if (!found) throw UsageError("--debug cannot be '" + name + "'; " + sim::nameHint(name, known));
    begin = end + 1;
  }
}

}  // namespace app

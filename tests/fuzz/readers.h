// Every reader of files as a function of bytes: what tests/fuzz/run fuzzes and tests/app/files/hostile_input_test
// damages.
#pragma once

#include <span>
#include <string_view>

namespace tests {

struct Reader {
  const char* name;                      // of its folder in seeds/
  void (*read)(std::string_view bytes);  // throws app::InputError for what it refuses; any other exception is a fault
};

std::span<const Reader> readers();

}  // namespace tests

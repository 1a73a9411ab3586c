// The fields of plain structs, one by one: what compares, saves and restores a state visits them all.
#pragma once

#include <tuple>

// In a struct: names its data members, in order. A member that is left out does not compile where fields() is used.
#define HAIRMESH_FIELDS(...)       \
  static auto fields(auto& self) { \
    auto& [__VA_ARGS__] = self;    \
    return std::tie(__VA_ARGS__);  \
  }

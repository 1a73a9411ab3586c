// Cases of the short run that fall short today, by name.
#pragma once

#include <cstdint>
#include <string>

namespace stress {

// Why it does; nullptr for all others, and for every case of another seed than the one that the list was made with.
const char* knownFailure(const std::string& name, std::uint64_t seed);

}  // namespace stress

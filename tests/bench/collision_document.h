// docs/collision.md: its tables measured anew.
#pragma once

#include <string>

namespace bench {

// Measures everything that collisions claim and puts the tables into `folder`/collision.md between its marks. Throws
// app::InputError.
void writeCollisionDocument(const std::string& folder, int frames);

}  // namespace bench

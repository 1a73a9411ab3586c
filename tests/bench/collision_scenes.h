// Collisions set up on purpose, on a style's hair: bodies that appear inside it, thin ones that cross it at speed, and
// its bundles against one another.
#pragma once

#include <cstdio>

namespace bench {

// A ball switched on within the hanging hair, for several bounds on the speed of getting out: how long that takes, how
// fast the hair gets and what motion is left.
void writeSpawns(std::FILE* out);

// A thin arm that crosses the hair within a step or two: how many vertices it met and how many it passed through.
void writeCrossings(std::FILE* out);

// The hair's own bundles: vertices inside foreign ones with self-contact off and on, and what it costs.
void writeSelfContacts(int frames, std::FILE* out);

}  // namespace bench

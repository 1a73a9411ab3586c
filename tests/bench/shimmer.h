// How much a moving picture shimmers beside the same one without its sampling: a slow camera and a shaken head.
#pragma once

namespace bench {

// Prints a table; false where a picture shimmers more than 1.15 times as much as its reference. Throws app::InputError.
bool runShimmer();

}  // namespace bench

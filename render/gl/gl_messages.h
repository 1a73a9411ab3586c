// What the driver says of this program's OpenGL calls (KHR_debug): faults, undefined behaviour, slow paths.
#pragma once

namespace render {

// From now on every message above a notification is counted, and printed on stderr when it is said for the first time.
// Needs a current debug context: others may stay silent.
void watchGl();

// Messages so far.
long glMessageCount();

}  // namespace render

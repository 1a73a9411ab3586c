// Outside peers on the same hair mesh and motion, in the same run as ours.
#pragma once

#include <string>

namespace bench {

struct PeersOptions {
  std::string folder;  // peers.json goes here
};

// The default, the paper's setting and Bullet's soft bodies (where installed) at 1/60 s, without collision, on the low
// and the high long style: a head shake's milliseconds a frame, edge and volume errors; then how far each is from its
// own undisturbed rest after it was collapsed onto its roots, and after the jump at ten times its speed. Prints a table
// and writes <folder>/peers.json.
void runPeers(const PeersOptions& options);

}  // namespace bench

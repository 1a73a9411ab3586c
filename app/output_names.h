// Which files a command line writes, held against those that it reads.
#pragma once

#include "app/options.h"

namespace app {

// Throws UsageError where two outputs name one file, where an output names an input, which would be lost, and for an
// output beside --write-hair, which ends before a run. A state may be loaded from the file that it is saved to at the
// end.
void refuseOutputsOverFiles(const Options& options);

}  // namespace app

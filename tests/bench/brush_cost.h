// What an edit by a brush or a drag of the hair mesh costs: the frame in which a sample of it is applied, beside frames
// without one.
#pragma once

namespace bench {

// Prints median and p99 of 200 samples a tool on the walking long high hair, milliseconds of processor time. Returns
// whether each tool's p99, less what a frame costs anyway, keeps within 8 ms.
bool runBrushCost();

}  // namespace bench

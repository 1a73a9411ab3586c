// What an edit by a brush or a drag of the hair mesh costs: the frame in which a sample of it is applied, beside frames
// without one.
#pragma once

namespace bench {

// Prints what strokes with pauses between them cost on the walking long high hair, milliseconds of processor time, and
// what changes of the mesh do. Returns whether each tool's p99 over all frames, of its own work and gravity's balance
// in the same frame together, keeps within 8 ms.
bool runBrushCost();

}  // namespace bench

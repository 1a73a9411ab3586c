// What an edit by a brush or a drag of the hair mesh costs: the frame in which a sample of it is applied, beside frames
// without one.
#pragma once

namespace bench {

// Prints what 200 samples a tool cost on the walking long high hair, milliseconds of processor time. Returns whether
// each tool's p99 of its own work and gravity's balance keep within 8 ms together.
bool runBrushCost();

}  // namespace bench

// How far strands close to clumps, and how far clumps root apart.
//
// Method: pairs of strands by the distance of their roots; of each the distance across the hair where clumps are
// closed, over that of the strands that grow in their places. Quantiles of these ratios are compared with those of
// strands that the program grows from the same hair mesh with locks and clumps. Where such a groom has locks that the
// hair mesh does not hold, they come back as wider and closer clumps.
#pragma once

#include <vector>

#include "app/groom/fit/groom_fit.h"

namespace app {

struct ClumpPair {
  int face = 0;     // where the first of two strands roots
  float apart = 0;  // m, of their roots
  float ratio = 1;  // their distance over that of the grown ones
};

struct ClumpFit {
  double clump = 0, lock = 0;    // as render::HairLook: what the hair mesh does not hold itself
  double size = 0.012;           // m, as render::HairLook::clump_size
  std::vector<ClumpPair> pairs;  // of strands that are nearer than a clump's size
};

ClumpFit fitClumps(const StrandSamples& strands, const HairFit& fit, const GrowthMap& growth);

}  // namespace app

// What makes strands individual, fitted from what a hair mesh leaves of them.
#pragma once

#include <vector>

#include "app/files/hair_file.h"
#include "app/groom/fit/groom_fit.h"
#include "render/frame_input.h"

namespace app {

// Of all strands, or of those around one column.
struct StrandCharacter {
  int strands = 0;                            // that it was measured on
  double length_variation = 0;                // share of their length by which strands end early, at most
  double curl_radius = 0;                     // m; 0: no curls that the hair mesh does not follow itself
  double curl_turns = 0, curl_pitch = 0.035;  // over a strand; m a turn, along the hair without its curls
  double frizz = 0, offset = 0;               // m, as render::HairLook
  double clump = 0, lock = 0;                 // 0..1
  double clump_size = 0.012;                  // m, as render::HairLook
};

struct LookFit {
  StrandCharacter all;
  // One a column, of `all`, where strands differ from place to place; empty: they are alike everywhere.
  std::vector<ColumnShare> columns;
  double taper = -1, radius = -1;  // as render::HairLook; negative: the groom has no widths
};

// `scale`: metres in a unit of the groom, as the samples were made with.
LookFit fitLook(const Groom& groom, double scale, const StrandSamples& strands, const HairFit& fit);

// The look with what was fitted in place of its own.
void takeLook(const LookFit& fit, render::HairLook& look);

// The same for the rows that have their defaults or are as `before`: what a person set stays.
void takeUnset(const LookFit& fit, const render::HairLook& before, render::HairLook& look);

// Gives the rows that takeLook sets the values that they have in `before`.
void dropLook(const render::HairLook& before, render::HairLook& look);

}  // namespace app

// The stroke of a cutting brush. While it is drawn hair gives way as far as its prisms let it at once; when it ends,
// hair of the shape before it is cut to what was asked for, over the frames that follow, and its prisms are untangled.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "app/groom/edit/shape_brush.h"
#include "app/styles/style_shorten.h"

namespace app {

struct Demo;

struct CutStroke {
  std::vector<Vec3> before;     // rest positions when it began
  std::vector<Vec3> after;      // as its last sample left them: whatever else changes the shape ends the stroke
  std::vector<double> lengths;  // m, asked for, per column
};

// m, that columns count as to the next sample of the stroke; begins it where none goes on.
std::span<const double> cutLengths(const sim::HairMeshShape& shape, std::optional<CutStroke>& stroke);

// Takes over what a sample asked for; `shape` as it left it.
void followCut(std::span<const double> asked, const sim::HairMeshShape& shape, std::optional<CutStroke>& stroke);

// A stroke that has ended, and what its hair is coming to.
struct CutFinish {
  CutStroke stroke;
  Shortening shortening;
};

// Ends the strokes on the characters' hair. workOnCuts() or finishCuts() finish them.
void endCuts(Demo& demo);

// Does a frame's share of the work on strokes that have ended: some milliseconds. A message says by how much hair stays
// longer, and why. A stroke whose hair has changed its shape meanwhile is dropped.
void workOnCuts(Demo& demo);

// Does all of that work at once: up to half a second. Every request calls it first, so that it finds the hair cut.
void finishCuts(Demo& demo);

// Whether a stroke has ended that is not finished.
bool cutsAreComing(const Demo& demo);

}  // namespace app

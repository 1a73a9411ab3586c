// Grooms as USD curves in text (`.usda`): prims of the type BasisCurves.
//
// type (linear, cubic), basis (bezier, bspline, catmullRom), wrap (nonperiodic, periodic, pinned), curveVertexCounts,
// points and their timeSamples, widths (diameters), primvars with their interpolation (constant, uniform a curve,
// varying, vertex). Source: openusd.org, UsdGeomBasisCurves, UsdGeomPrimvar; the layer's metersPerUnit and upAxis:
// UsdGeomMetrics.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/groom/clip_settings.h"
#include "app/groom/groom.h"
#include "app/groom/groom_hints.h"

namespace app {

// All curves, one after another, at moment `moment` (the last where there are fewer), with the transforms of the prims
// above at their default applied. Control points are taken as points, of Bezier curves every third.
// primvars:displayColor gives colours; groom_root_uv, else st or uv, root UVs; groom_id, groom_group_id, groom_guide
// the rest. Without groups each prim is one. Unit and up axis, where the layer tells them, go to `hints`. Throws
// InputError naming the line.
Groom readUsda(std::string_view text, const std::string& file, std::size_t moment = 0, GroomHints* hints = nullptr);

// Seconds of the moments, by the curves that have most of them; one entry for a file without motion. Throws InputError.
std::vector<double> usdaTimes(std::string_view text, const std::string& file);

// Writes a clip moment by moment as curves through the points (Catmull-Rom, pinned); memory does not grow with the
// number of moments but for 24 bytes each. Points change, everything else is taken from the first moment. Reading gives
// back the same bits.
class UsdaWriter {
 public:
  // Throws OutputError where the file cannot be made.
  UsdaWriter(const std::string& file, const ClipSettings& settings);
  ~UsdaWriter();

  // Throws OutputError when strands differ from those of the first moment, and when bytes could not be written.
  void add(const Groom& groom);
  // Without it nothing is left of the file.
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace app

// Curves to a hair mesh: columns, root faces and layers are found from the strands themselves, and placed so that
// strands grown from the hair mesh come back to those that were given.
//
// Method: roots are mapped and divided into regions of hair that goes one way (root_raster.h), columns and faces laid
// over them (root_mesh.h). For given root faces the growth is linear in the columns' positions (growth_map.h), so these
// are a least-squares fit to the strands; corner tetrahedra that it leaves flat or inverted are then opened, and the
// fit repeated about the result.
#pragma once

#include <string>
#include <vector>

#include "app/groom/fit/growth_map.h"
#include "app/groom/fit/root_raster.h"
#include "app/groom/fit/strand_samples.h"
#include "app/groom/groom.h"
#include "sim/mesh/hair_mesh.h"

namespace app {

struct FitOptions {
  int vertices =
      0;  // most of the hair mesh, 100 to 20,000; 0: the least of 400, 800, 1,600 and 2,400 that meets the bounds
  int layers = 0;  // of a column, 4 to 24; 0: as length and vertices ask for
};

// A strand as the hair mesh has it.
struct StrandFit {
  RootPlace root;
  float end = 0;  // layers: where the grown strand is as long as the given one
};

// Distances in metres, of points of the given strands from the same share of the grown ones' length.
struct FitError {
  double strand_length = 0;                   // m, median of the given strands: what the shares are of
  double mean = 0, share95 = 0, largest = 0;  // m; 95 % of the points are within share95
  double root_mean = 0;                       // m, of the roots alone
  std::vector<float> of_strand;               // m, mean of each of the samples' strands
};

struct HairFit {
  sim::HairMeshShape shape;  // m, the groom's axes
  ScalpMap map;
  std::vector<double> knots;  // per layer: its share of the length, 0 to 1
  std::vector<int> face_region;
  int regions = 0;
  int dropped_faces = 0;           // root faces over which no prisms could be made
  std::vector<StrandFit> strands;  // of the samples
  FitError error;
  double flattest = 0;  // smallest fatness of a corner tetrahedron, see app/styles/style_untangle.h
};

// Throws std::runtime_error where the strands carry no hair mesh: fewer than 20 of them, or roots that span no face.
HairFit fitGroom(const StrandSamples& strands, const FitOptions& options = {});

// The strand that grows there, cut at `end`, at `even.size()` even steps of its length.
void growStrand(const HairFit& fit, const GrowthMap& growth, const StrandFit& strand, std::span<Eigen::Vector3f> even);

}  // namespace app

// A groom to a hair mesh with its look, and what is said about it. docs/conversion.md
#pragma once

#include <string>
#include <vector>

#include "app/groom/fit/groom_fit.h"
#include "app/groom/fit/look_fit.h"
#include "app/groom/groom_file.h"

namespace app {

struct ConvertOptions {
  FitOptions fit;
  double unit = 0;           // metres in a unit of the file; 0: as the file says, or inferred from the roots' spread
  double file_unit = 0;      // metres in a unit of the file where points are metres by now, to say; 0: as `unit`
  bool reverse = false;      // strands are given from tip to root
  bool silhouettes = false;  // compare them: takes as long as drawing both grooms six times
};

// Neighbouring strands that one hair mesh cannot hold within 3 % of the hair's length.
struct Misfit {
  int strands = 0;
  std::vector<int> numbers;                        // in the groom, ascending
  Eigen::Vector3f root = Eigen::Vector3f::Zero();  // m, their mean root, the file's axes
  double mean = 0, largest = 0;                    // m, of the strands' mean distances
  bool crossing = false;                           // strands of the same roots go other ways
};

// A strand by its number in the groom.
struct StrayStrand {
  int number = 0;
  float off = 0;  // m, mean distance
};

struct Conversion {
  sim::HairMeshShape shape;  // m, the file's axes; has passed sim::buildHairMesh
  HairFit fit;
  LookFit look;
  std::string unit;  // in words
  double scale = 1;  // metres in a unit
  int strands = 0, left_out = 0;
  int measured = 0, step = 1;  // of the strands, every step-th: on these the mesh is fitted and distances are measured
  // Smallest overlaps of six sides; negative: not compared. Of the strands that grow from the given roots to the given
  // lengths, and of as many that are dealt out over the hair mesh as when it is drawn.
  double silhouette = -1, silhouette_drawn = -1;
  std::vector<Misfit> misfits;
  std::vector<StrayStrand> astray;  // those of all misfits, by their numbers
};

// Throws InputError naming `file` where no hair mesh can be made of it.
Conversion convertGroom(const Groom& groom, const GroomHints& hints, const ConvertOptions& options,
                        const std::string& file);

// Of the strands that are measured, how many do not fit.
int misfitCount(const Conversion& conversion);

// One sentence where more than half of the strands do not fit and all are more than 5 % of their length off in the
// mean; else empty.
std::string conversionWarning(const Conversion& conversion);

// Each strand that does not fit with its offset in mm, one a line.
std::string misfitList(const Conversion& conversion);

// Vertices, distances, character of the strands, and what does not fit: one fact a line.
std::string conversionReport(const Conversion& conversion);

// The same in one sentence: vertices, distances, and how many strands do not fit.
std::string conversionNote(const Conversion& conversion);

}  // namespace app

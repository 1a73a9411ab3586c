// Strips, cards and tubes of a polygon file to a hair mesh, and what is said about it. docs/conversion.md
#pragma once

#include <string>
#include <vector>

#include "app/groom/strips/polygon_mesh.h"
#include "app/groom/strips/strip_mesh.h"

namespace app {

// Which end of a strip is its root edge.
enum class RootEdge {
  kAuto,
  kScalp,
  kHighest,
  kLowest
};  // kAuto: nearest to the scalp where there is one, else highest

struct StripOptions {
  StripMeshOptions mesh;
  RootEdge root = RootEdge::kAuto;
  bool other_end = false;              // of every strip: the end that is not found is the root
  std::vector<int> flipped;            // numbers of strips, from 1, of which it is so
  std::vector<int> dropped;            // numbers of those that are left out
  double unit = 0;                     // m in a unit of the file; 0: as it says where that is plausible, or inferred
  double join = 0;                     // m: neighbouring strips nearer than this become one sheet
  char up = 'y';                       // the file's axis that is up, for the highest end
  const PolygonMesh* scalp = nullptr;  // of another file, in the same unit and axes
};

// A piece that was followed from its root edge to its tip.
struct FollowedStrip {
  int number = 0;            // from 1, as --flip-strips has it
  std::string object;        // the file's name for it
  StripRows rows;            // m, the file's axes
  bool turned = false;       // its root is the end that --other-end or --flip-strips says
  double root = 0, tip = 0;  // m, of its ends: from the scalp, or their height (negative where the highest is it)
  bool unclear = false;      // both ends are about as far, for its length
};

struct StripConversion {
  StripMesh mesh;                         // m, the file's axes
  int strips = 0, joined = 0, tubes = 0;  // pieces that became hair; joined: strips of several quads across
  std::string unit;                       // in words
  double scale = 1;
  std::string roots;                          // in words: how the root edges were told
  bool by_scalp = false;                      // by their distance from it
  std::vector<FollowedStrip> followed;        // as the file has them: those of left_out that fold are among them
  std::vector<std::string> left_out;          // "strip 3 ('hair_back'): ..."
  std::vector<int> astray;                    // numbers of pieces left out, which would tell a wrong unit and place
  int cut = 0;                                // strips whose last rows were left out
  bool turned_by_head = false;                // those that are turned are so for their other end is on the head
  std::string scalp;                          // objects taken for the scalp
  std::vector<Eigen::Vector3d> scalp_points;  // m, the file's axes: all over it
};

// m, the median distance of the root edges' points from their middle, which is the median of each coordinate: a single
// stray piece changes it little.
double rootSpread(const std::vector<FollowedStrip>& strips);

// "strip 3"; "strips 3, 7, 9", of many the first.
std::string piecesText(const std::vector<int>& numbers);
// "strips 3, 7 lie apart from all others"; of some.
std::string astrayText(const StripConversion& conversion);

// Whether any object is called hair: then others are none.
bool namesHair(const PolygonMesh& mesh);

// Throws InputError naming `file` where it holds no strip or tube that can be followed.
StripConversion convertStrips(const PolygonMesh& mesh, const StripOptions& options, const std::string& file);

// One fact a line.
std::string stripReport(const StripConversion& conversion);
// In one sentence.
std::string stripNote(const StripConversion& conversion);

}  // namespace app

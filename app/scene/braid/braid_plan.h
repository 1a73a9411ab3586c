// Tails that are drawn as plaits of three strands, or wound to a bun.
//
// The simulation knows the tail alone. What is drawn is a finer hair mesh: every drawn vertex is a function of the
// simulated ones, made once a frame on the CPU, so that all that grows strands from a hair mesh grows braided hair.
// A plan holds all that stays the same from frame to frame. Lengths are metres.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "render/frame_input.h"

namespace app {

inline constexpr int kBraidStrands = 3;

// A tie whose tail is to be braided, in the frame of the positions at rest.
struct BraidTie {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  // unit, of the ring: away from the head
  double radius = 0.02;
  bool mirrored = false;  // the strands cross the other way round, as in the right one of two plaits
  std::vector<int> ring;  // the vertices in it, one a column
  bool braided = true;    // a bun's rope is a plait; otherwise its three strands are twisted
  double wound = 0;       // m of hair that is wound to a bun; 0: it hangs, and is as long as at rest
  // Of a bun: the ring's middle, its height over the head, and the head's radius there; m.
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  double over_scalp = 0, head = 0;
};

// A place along a plait.
struct BraidStep {
  float share = 0;                                   // of the tail's length, 0 at the tie
  float hold = 0;                                    // 0: hair lies as in the tail, 1: as in the plait
  float phase = 0;                                   // rad, of the first strand
  std::array<Eigen::Vector2f, kBraidStrands> middle  // of each strand, from the plait's middle: across and outwards
      {Eigen::Vector2f::Zero(), Eigen::Vector2f::Zero(), Eigen::Vector2f::Zero()};
  Eigen::Vector2f half = Eigen::Vector2f::Zero();  // half axes of a strand's section
  Eigen::Vector2f twist{1, 0};                     // cosine and sine of the angle that its hair has turned by
};

// Columns of a tail that have as many layers.
struct BraidLayers {
  int layers = 0;
  std::vector<int> first_vertex;
};

// What a vertex adds to the head's turn since rest.
struct BraidAnchor {
  int vertex = 0;
  Eigen::Vector3d weight = Eigen::Vector3d::Zero();  // 1/m
};

// A place along a bun's rope, at rest.
struct CoilStep {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();    // m
  Eigen::Vector3d out = Eigen::Vector3d::UnitZ();  // away from the dome that it lies on
};

struct Braid {
  int ring_layer = 0;            // of the simulated columns
  std::vector<BraidStep> steps;  // the first lies in the ring
  std::vector<BraidLayers> tail;
  std::vector<BraidAnchor> anchors;
  Eigen::Vector3d held = Eigen::Vector3d::Zero();  // middle of the anchors at rest
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ(), across = Eigen::Vector3d::UnitX();  // at rest
  bool mirrored = false;
  std::array<double, kBraidStrands> hair{};  // share of the tail's hair that each strand holds
  double length = 0, width = 0;              // of the tail from the ring on, at rest; of the plait where it is widest
  std::vector<CoilStep> coil;                // each step of a bun; empty: it hangs
  int band_step = 0;                         // where the second tie holds the end; a bun has none
  double band_radius = 0;
};

struct DrawnColumn {
  int first_vertex = 0, layers = 0;  // simulated
  int first_drawn = 0;
  int braid = -1, strand = 0;                       // -1: in none
  Eigen::Vector2f place = Eigen::Vector2f::Zero();  // in the strand's section, of which the rim is at 1
};

struct BraidPlan {
  std::vector<Braid> braids;  // empty: what is simulated is drawn
  int finer = 1;              // drawn layers a simulated one, outside of plaits
  std::vector<DrawnColumn> columns;
  std::vector<render::HairFace> faces;
  std::vector<float> rest;
  std::vector<render::LookShare> root_shares;
  std::string note;  // which tails hang as they are, and why

  bool empty() const { return braids.empty(); }
};

// column_first: first vertex of each column, and the number of vertices. rest: 3 floats a vertex. shares: of roots, one
// a vertex, or none. `names` of the ties are for notes.
BraidPlan planBraids(std::span<const render::HairFace> faces, std::span<const int> column_first,
                     std::span<const float> rest, std::span<const render::LookShare> shares,
                     std::span<const BraidTie> ties, std::span<const std::string> names);

// Segments of a drawn layer where `asked` are wanted of a simulated one.
int braidSegments(const BraidPlan& plan, int asked);

}  // namespace app

// Combing out: hair that stays turned over is drawn back to its rest shape.
//
// A tip that has been thrown through its neighbours keeps the length of every edge, and the way back leads through a
// flat prism: mirrored hair can be as good a rest as any other, as a glove turned inside out is. Forces alone, the
// volume force's included, do not bring it home. So where a corner tetrahedron has been turned over for kTurnedFor, or
// a column folded back on itself, the columns concerned are led, over kCombing and along straight lines seen from the
// head, to where they rest. What bodies are in the way still pushes them out, and hair that a body holds turned over is
// left as it is. Hair that turns over again where it was combed is left in peace for four times as long each time.
#pragma once

#include <span>
#include <vector>

#include "sim/hair_mesh.h"
#include "sim/hair_state.h"

namespace sim {

inline constexpr double kTurnedFor = 0.8;  // s

// What is known of tangles from step to step: one per hair.
struct Tangles {
  explicit Tangles(const HairMesh& mesh);

  struct Column {
    double combed = -1;   // s since its combing began; negative: it is not being combed
    double wait = 0;      // s before it may be combed again
    double patience = 0;  // s that it has to wait after the next combing
    double upright = 0;   // s since one of its tetrahedra was last seen turned over
  };
  std::vector<Column> columns;
  std::vector<double> turned;                             // s that each corner tetrahedron has been turned over
  std::vector<double> folded;                             // s that the column has been folded back at each vertex
  std::vector<char> touched;                              // by a body, per vertex
  std::vector<Vec3> rest_roots, roots_before, roots_now;  // m, one per column
  std::vector<Vec3> target;                               // m, seen from the head: where what is combed is led
  double since_look = 0;                                  // s
  int combing = 0;                                        // columns
};

// The step that was taken: positions (m) at its start; `state` holds its end.
struct CombedStep {
  const HairMesh& mesh;
  std::span<const Vec3> start;
  double dt;          // s
  bool looks = true;  // for new tangles, too
};

// Looks for tangles a few times a second, and moves the columns that are being combed. Returns how many these are.
int combOut(const CombedStep& step, Tangles& tangles, HairState& state);

// Has every column led to where `there` has it, over the next steps.
void leadTo(const HairMesh& mesh, const HairState& there, Tangles& tangles);

}  // namespace sim

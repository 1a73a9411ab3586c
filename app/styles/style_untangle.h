// Fattens the prisms of a style that the curvature of a head has flattened or turned inside out.
#pragma once

#include <memory>

#include "app/styles/hair_styles.h"

namespace app {

// How fat a corner tetrahedron is: its volume over that of a box corner with the same three edges; 1 is square, 0 flat,
// negative inside out.
double cornerFatness(const Vec3& corner, const Vec3& next, const Vec3& previous, const Vec3& along);

// Raises and lowers all but the roots along `up` (unit, per vertex), as little as it can in the mean square, until
// every corner tetrahedron is at least `fatness` fat (0.75 of that where a layer's corner is acute) and every vertex
// keeps `gap` (m) off the body. Deterministic; stops after a fixed number of sweeps and leaves what is not mended yet.
void layFlat(const BodyDistance& body, const std::vector<Vec3>& up, double fatness, double gap,
             sim::HairMeshShape& shape);

// Least fatness of the corner tetrahedra over a root face.
double flattestOf(const sim::RootFace& face, const sim::HairMeshShape& shape);

// Moves all but the roots, as little as it can, until every corner tetrahedron is at least `fatness` fat (0.75 of that
// where a layer's corner is acute), and keeps `gap` (m) off the body. Deterministic; gives up after a fixed number of
// sweeps and returns what it reached: the smallest fatness of all.
double untangle(const BodyDistance& body, double fatness, double gap, sim::HairMeshShape& shape);

// untangle() a few sweeps at a time, and again from what it reached. `body` and `shape` outlive it.
class Untangling {
 public:
  Untangling(const BodyDistance& body, double fatness, double gap, sim::HairMeshShape& shape);
  ~Untangling();

  // From the shape's positions of now.
  void begin();

  // At most so many sweeps; returns those made: fewer where nothing is left to do.
  int work(int sweeps);

  bool done() const;
  double flattest() const;  // of all corners

 private:
  struct Relaxation;
  std::unique_ptr<Relaxation> relaxation_;
};

}  // namespace app

// Columns of a hair mesh made shorter, each by its own share, that leaves no prism flat.
#pragma once

#include <vector>

#include "app/styles/hair_styles.h"
#include "app/styles/style_untangle.h"

namespace app {

// Cuts each column to a share (above 0; 1: as it is) of its length, along its own curve. Neighbours of very unequal
// length have flat prisms between them: shares are raised until none of a root face is below half of another, and on
// where prisms are flat all the same; then prisms are untangled (style_untangle.h) to `fatness`. Where no such cut
// leaves prisms, as on heads that leave no room, a part of it is made, or none. Deterministic.
class Shortening {
 public:
  Shortening(const BodyDistance& body, double fatness, std::vector<double> shares, sim::HairMeshShape shape);
  Shortening(const Shortening&) = delete;
  Shortening& operator=(const Shortening&) = delete;

  // Goes on by about so many sweeps of untangling, each a tenth of a microsecond a vertex; answers whether it is done.
  // A cut takes up to a thousand or two.
  bool work(int sweeps);

  // What it has come to; once it is done `shares` is what columns were cut to.
  const sim::HairMeshShape& shape() const { return shape_; }
  const std::vector<double>& shares() const { return shares_; }

 private:
  BodyDistance body_;
  std::vector<Vec3> whole_;  // positions before the cut
  sim::HairMeshShape shape_;
  std::vector<double> asked_, shares_;
  Untangling untangling_;  // of shape_
  int attempt_ = 0, raised_ = 0, rounds_ = 0;
  bool raising_ = false, done_ = false;

  void cut();
  void beginAttempt();
  int raise();
  int untangle(int sweeps);
};

// All of it at once. On return `shares` is what columns were cut to.
void shortenColumns(const BodyDistance& body, double fatness, std::vector<double>& shares, sim::HairMeshShape& shape);

}  // namespace app

// The strands of a groom at even steps of their length: what the conversion to a hair mesh works on.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "app/groom/groom.h"

namespace app {

// `count` points a strand, root to tip, evenly spaced by arc length. Strands that are no curve are left out.
struct StrandSamples {
  int count = 0;                    // points a strand
  std::vector<Eigen::Vector3f> at;  // m, strands x count
  std::vector<float> length;        // m, one a strand
  std::vector<int> source;          // the strand's number in the groom
  int left_out = 0;                 // of all: of fewer than two points, not finite, or shorter than 1 mm

  std::size_t strandCount() const { return length.size(); }
  std::span<const Eigen::Vector3f> strand(std::size_t s) const {
    return std::span(at).subspan(s * static_cast<std::size_t>(count), static_cast<std::size_t>(count));
  }
};

// `scale`: metres in a unit of the groom. Between its ends a sample is the mean of the strand over the steps beside it,
// so that curls narrower than that do not alias. Of all strands every `step`th.
StrandSamples sampleStrands(const Groom& groom, double scale, int count, std::size_t step = 1);

// The points of a polyline at `count` even steps of its length.
void resample(std::span<const Eigen::Vector3f> line, std::span<Eigen::Vector3f> even);

// m
double lineLength(std::span<const Eigen::Vector3f> line);

// The value that a share (0..1) of the values lies below; 0 without values.
double quantile(std::vector<float> values, double share);

// Metres in a unit of the groom, from the spread of its roots: that of hair over a head. `name` becomes "metres",
// "centimetres", "millimetres", "inches" or "feet".
double inferUnit(const Groom& groom, std::string& name);

}  // namespace app

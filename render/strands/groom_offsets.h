// Where strands grow from, beside the hair mesh that is simulated. Hair of a groom lies closer to itself than prisms
// can be thin, so a valid hair mesh passes a few millimetres beside it; each vertex's offset leads to where the groom
// has that layer, and turns with the hair around the vertex.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "render/frame_input.h"

namespace render {

class GroomOffsets {
 public:
  GroomOffsets() = default;

  // faces, rest: as in HairInput. offsets: as many as of rest, m, added to it. An offset of nought, or at a vertex with
  // no column above or below or beside it, is none.
  GroomOffsets(std::span<const HairFace> faces, std::span<const float> rest, std::span<const float> offsets);

  bool empty() const { return frames_.empty(); }

  // positions: as many as of rest. `drawn` becomes where strands grow from.
  void add(std::span<const float> positions, std::vector<float>& drawn) const;

 private:
  // Of a vertex: an axis along its column, one across that towards a vertex beside it, and one at right angles to both.
  struct Frame {
    int vertex, before, after, beside;
    Eigen::Vector3f offset;  // m, along these axes
  };
  static Eigen::Matrix3f axes(const Frame& frame, std::span<const float> positions);

  std::vector<Frame> frames_;
};

}  // namespace render

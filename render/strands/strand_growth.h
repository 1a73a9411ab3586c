// The strands of a hair on the CPU, as the shaders draw them: shaders/common/strand.glsl and what it includes, step by
// step in single precision, without the light. Nothing is stored per strand and nothing is allocated per strand, so any
// subset can be grown in any order, on any thread.
//
// Points agree with those of the GPU within 1e-5 of the hair's length (tests/render/strand_growth_test.cpp). Positions
// should be near the origin for that: at 1,000 m a float has steps of 0.06 mm.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/frame_input.h"
#include "render/strands/hair_layout.h"

namespace render {

// Strands of a lower rank (0..1) than `from` are grown, those above `to` are not; each stands for `gain`.
struct StrandFade {
  float from = 2, to = 3, gain = 1;
};

// One strand, without its points. The fields are those of the shader's structure.
struct Strand {
  std::array<int, 4> first{};  // first vertex of each corner's column; [3] repeats [2] with weight 0 in a triangle
  int layers = 0;
  std::array<float, 4> weight{};                   // of positions
  std::array<float, 4> along_u{}, along_v{};       // of gradients du, dv
  std::array<float, 4> pull_u{}, pull_v{};         // what the clump adds to them at full strength
  std::array<float, 4> blend{};                    // linear weights: frames
  float end = 0;                                   // curve parameter of the tip, in layers
  std::uint32_t key = 0, clump_key = 0;            // hash keys of the strand and of its clump
  float loose = 0;                                 // 1 for a flyaway, else 0
  float segments = 1;                              // a layer
  float gain = 1;                                  // of width: how many strands this one stands for; 0: not grown
  int face = 0;                                    // of the layout
  Eigen::Vector2f root = Eigen::Vector2f::Zero();  // in the unit square of the face, corners 0, 1, 2, 3 around it
};

struct CurvePoint {
  Eigen::Vector3f position;  // m, in the frame of the positions given
  Eigen::Vector3f tangent;   // unit
  float along;               // 0 root .. 1 tip of this strand
};

class StrandGrowth {
 public:
  // faces, rest, strands, segments_per_layer, look: as in HairInput, with the same limits; what they make is the same
  // for every pose. rest: 3 floats a vertex. Without usable faces there are no strands.
  StrandGrowth(std::span<const HairFace> faces, std::span<const float> rest, int strands, int segments_per_layer,
               const HairLook& look);

  // The pose that strands are grown from: 3 floats a vertex, as many as of `rest`. Allocates at its first call alone.
  // Returns false, and changes nothing, where the number is another one or a value is not finite.
  bool setPositions(std::span<const float> positions);

  void setLook(const HairLook& look);
  void setFade(const StrandFade& fade) { fade_ = fade; }

  const HairLayout& layout() const { return layout_; }
  int strandCount() const { return first_strand_.empty() ? 0 : first_strand_.back(); }
  int maxPoints() const;  // of a strand as drawn

  // Strand `number` of 0 .. strandCount() - 1; the same for every pose.
  Strand strand(int number) const;

  // Points of a strand as it is drawn: none where it has no length or gain.
  int drawnPoints(const Strand& strand) const;
  // Those points, root first. `points` has room for them; returns their number.
  int growDrawn(const Strand& strand, std::span<CurvePoint> points) const;
  // points.size() points, at least two, evenly from root to tip in the curve parameter, whatever is drawn of the
  // strand.
  void growEven(const Strand& strand, std::span<CurvePoint> points) const;

  // m, as drawn: with what strands left out add, before it is widened to what a pixel can show.
  float radius(const Strand& strand, float along) const;

 private:
  struct LayerPoint {
    Eigen::Vector4f position, axis_u;  // [3]: 0
  };
  // The layers around a segment: `before` and `after` are mirrored where the strand has none.
  struct LayerWindow {
    Eigen::Vector4f before;
    LayerPoint from, to;
    Eigen::Vector4f after;
  };

  Eigen::Vector2f planeOffset(int from, int to) const;
  void weighQuad(const Eigen::Vector2f& p, const std::array<int, 4>& columns, Strand& strand) const;
  void weighTriangle(Eigen::Vector2f p, const std::array<int, 4>& columns, Strand& strand) const;
  void joinClump(const std::array<int, 4>& columns, int corners, Strand& strand) const;
  LayerPoint layerPoint(const Strand& strand, int layer) const;
  Eigen::Vector4f layerAfter(const Strand& strand, int layer, const Eigen::Vector4f& last,
                             const Eigen::Vector4f& here) const;
  LayerWindow layerWindow(const Strand& strand, int layer) const;
  void moveWindow(const Strand& strand, int wanted, int& layer, LayerWindow& window) const;
  Eigen::Vector4f sideways(const Strand& strand, float s) const;
  CurvePoint curvePoint(const Strand& strand, const LayerWindow& window, float s, float fraction) const;
  template <class Parameter>
  void growAt(const Strand& strand, std::span<CurvePoint> points, const Parameter& parameter) const;

  HairLayout layout_;
  std::vector<int> first_strand_;  // see dealStrands
  HairLook look_;
  StrandFade fade_;
  float segments_;         // a layer
  float root_radius_ = 0;  // m, as drawn
  std::vector<Eigen::Matrix<float, 3, 2>> gradients_;
  std::vector<Eigen::Vector4f> texels_;  // 3 a vertex: position, du, dv, as on the GPU
};

}  // namespace render

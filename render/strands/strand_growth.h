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
#include "render/strands/skin_lift.h"

namespace render {

struct SkinLift;

// Strands of a lower rank (0..1) than `from` are grown, those above `to` are not; each stands for `gain`.
struct StrandFade {
  float from = 2, to = 3, gain = 1;
};

// One strand, without its points. The fields are those of the shader's structure.
struct Strand {
  std::array<int, 4> first{};  // first vertex of each corner's column; [3] repeats [2] with weight 0 in a triangle
  int layers = 0;
  std::array<float, 4> weight{};              // of positions
  std::array<float, 4> along_u{}, along_v{};  // of gradients du, dv
  std::array<float, 4> blend{};               // linear weights: frames
  // m in the rest scalp's plane: from the root to the middles of its groups.
  Eigen::Vector2f wisp = Eigen::Vector2f::Zero(), clump = Eigen::Vector2f::Zero(), lock = Eigen::Vector2f::Zero();
  Eigen::Vector2f way = Eigen::Vector2f::Zero();       // m of hair from the root to s layers at rest: s (x + y s)
  float end = 0;                                       // curve parameter of the tip, in layers
  float metres = 0;                                    // of hair to the tip
  std::uint32_t key = 0, clump_key = 0, lock_key = 0;  // hash keys of the strand and of its groups
  float loose = 0;                                     // 1 for a stray hair, else 0
  float fine = 0;                                      // 1 for a short fine hair of the hairline, else 0
  float rim = 0;                                       // 1 at the hairline .. 0 well inside
  Eigen::Vector2f astray = Eigen::Vector2f::Zero();    // m a m of hair: how a fine hair leaves the others
  Eigen::Vector2f shift = Eigen::Vector2f::Zero();     // m: how far before the hairline it roots
  Eigen::Vector2f fan = Eigen::Vector2f::Zero();       // m: e times how far it goes aside near its root
  float hold = 0;                                      // 0..1: how far it goes along with its groups
  float segments = 1;                                  // a layer
  float gain = 1;                                      // of width: how many strands this one stands for; 0: not grown
  int face = 0;                                        // of the layout
  Eigen::Vector2f root = Eigen::Vector2f::Zero();      // in the unit square of the face, corners 0, 1, 2, 3 around it
  LookShare share;                                     // painted, of its root
};

struct CurvePoint {
  Eigen::Vector3f position;  // m, in the frame of the positions given
  Eigen::Vector3f tangent;   // unit
  float along;               // 0 root .. 1 tip of this strand
};

class StrandGrowth {
 public:
  // faces, rest, strands, segments_per_layer, look, shares: as in HairInput, with the same limits; what they make is
  // the same for every pose. rest: 3 floats a vertex. Without usable faces there are no strands.
  StrandGrowth(std::span<const HairFace> faces, std::span<const float> rest, int strands, int segments_per_layer,
               const HairLook& look, const LookShares& shares = {});

  // The pose that strands are grown from: 3 floats a vertex, as many as of `rest`. Allocates at its first call alone.
  // Returns false, and changes nothing, where the number is another one or a value is not finite.
  bool setPositions(std::span<const float> positions);

  void setLook(const HairLook& look);
  // What drawn strands are lifted out of, whose distances stay where they are; none at first.
  void setSkin(std::span<const SkinEllipsoid> skin, std::span<const SkinGrid> grids) { skin_ = {skin, grids}; }
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
  // Share of the light that passes through its pigment, painted.
  Float3 color(const Strand& strand, float along) const;

 private:
  struct LayerPoint {
    Eigen::Vector4f position, axis_u, axis_v;  // [3]: 0
  };
  // What a strand's root is at rest, and a group of hairs; see the shader.
  struct Root {
    Eigen::Vector3f rest = Eigen::Vector3f::Zero(), axis_u = rest, axis_v = rest;
    float cut = 0, edge = 0;
    Eigen::Vector2f outward = Eigen::Vector2f::Zero();
  };
  struct Group {
    Eigen::Vector3f gap;
    std::uint32_t key;
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
  Root rootOf(const std::array<int, 4>& columns, int corners, Strand& strand) const;
  Group groupOf(const Eigen::Vector3f& root, float size, std::uint32_t level) const;
  void joinGroups(const Root& root, Strand& strand) const;
  void thinHairline(const Root& root, Strand& strand) const;
  void cutStrand(const Root& root, Strand& strand) const;
  Eigen::Vector2f groupPull(const Strand& strand, float layer) const;
  LayerPoint layerPoint(const Strand& strand, int layer) const;
  Eigen::Vector4f layerAfter(const Strand& strand, int layer, const Eigen::Vector4f& last,
                             const Eigen::Vector4f& here) const;
  LayerWindow layerWindow(const Strand& strand, int layer) const;
  void moveWindow(const Strand& strand, int wanted, int& layer, LayerWindow& window) const;
  void addWander(const Strand& strand, float s, Eigen::Vector4f& bend) const;
  void addDrift(const Strand& strand, const Eigen::Vector2f& way, Eigen::Vector4f& bend) const;
  void addCurl(const Strand& strand, float s, const Eigen::Vector2f& way, Eigen::Vector4f& bend) const;
  void addWave(const Strand& strand, const Eigen::Vector2f& way, Eigen::Vector4f& bend) const;
  void addFrizz(const Strand& strand, const Eigen::Vector2f& way, Eigen::Vector4f& bend) const;
  Eigen::Vector4f sideways(const Strand& strand, float s) const;
  Eigen::Vector2f lifted(const Strand& strand, float s) const;
  CurvePoint curvePoint(const Strand& strand, const LayerWindow& window, float s, float fraction) const;
  template <class Parameter>
  void growAt(const Strand& strand, std::span<CurvePoint> points, const Parameter& parameter) const;

  HairLayout layout_;
  std::vector<int> first_strand_;  // see dealStrands
  HairLook look_;
  SkinAround skin_;
  StrandFade fade_;
  int asked_segments_;                                // a layer
  float segments_ = 1;                                // a layer, with those that curls need
  Eigen::Vector3f center_ = Eigen::Vector3f::Zero();  // m: the middle of the head
  float root_radius_ = 0;                             // m, as drawn
  std::vector<Eigen::Matrix<float, 3, 2>> gradients_;
  std::vector<Eigen::Vector4f> texels_;  // 3 a vertex: position, du, dv, as on the GPU
};

}  // namespace render

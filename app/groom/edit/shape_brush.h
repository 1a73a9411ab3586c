// Brushes on the rest shape of a hair mesh, placed where the moving hair is seen. Whatever a brush does, every prism
// stays positive, edges keep a length, and nothing comes nearer to the body.
//
// All positions are in the scalp's frame, m.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "sim/mesh/hair_mesh.h"

namespace app {

using Vec3 = Eigen::Vector3d;

enum class BrushTool {
  kComb,    // along the stroke; lengths stay
  kCut,     // columns end nearer the brush
  kGrow,    // columns become longer, straight on from their tips
  kSmooth,  // towards the mean of the neighbours; lengths stay
  kPuff,    // away from the head's middle; lengths stay
  kPinch,   // towards the middle of what it reaches, across the hair; lengths stay
  kSpread,  // away from there
  kPush,    // out of the body, along its normal; lengths stay
  kTwist,   // about the hair's own direction; lengths stay
  kFreeze,  // moves nothing: what it reaches stays under other brushes
  kThaw     // takes that back
};
inline constexpr std::array<std::string_view, 11> kBrushNames{"comb",   "cut",  "grow",  "smooth", "puff", "pinch",
                                                              "spread", "push", "twist", "freeze", "thaw"};

// A place (m) seen in the plane x = `plane`.
inline Vec3 mirrored(const Vec3& place, double plane) {
  return {2 * plane - place.x(), place.y(), place.z()};
}

struct Brush {
  BrushTool tool = BrushTool::kComb;
  Vec3 at = Vec3::Zero();                 // on the moving hair
  Vec3 along = Vec3::Zero();              // of combing: the way from the last place to this one
  double radius = 0.04;                   // m
  double strength = 0.5;                  // 0 to 1
  double falloff = 1;                     // of the reach: (1 - (distance / radius)^2)^falloff
  std::optional<double> mirror;           // x of the plane across which the brush acts as well
  Vec3 centre = Vec3::Zero();             // the head's middle, that puffing leads away from
  std::span<const float> frozen{};        // share of its way that each vertex does not go; empty: none is frozen
  double shortest = 0.03, longest = 1.2;  // m, columns that are cut and grown
  std::span<const double> lengths{};      // m, that columns count as before a cut; empty: their own
};

// How much a brush reaches of a vertex seen at a place: 0 outside, 1 in the middle.
double brushReach(const Brush& brush, const Vec3& seen);

// The vertex of the same layer nearest to where the plane x = `plane` (m) mirrors one, at rest.
int likeAcross(int vertex, double plane, const sim::HairMesh& mesh);

// Vertices that a hand leads, and the hair around them that follows. Lengths follow too. Where one has to stop, those
// within two radii of it along the edges go less of their way as well: hair bends there and has no kink.
struct HairMove {
  std::vector<int> vertices;          // that go all of the way
  Vec3 along = Vec3::Zero();          // m
  double radius = 0.04, falloff = 1;  // of the hair around, as a brush's
  bool bends = false;                 // whole columns are led: their way grows from none at the root over two radii
  std::optional<double> mirror;       // x of the plane across which hair goes the mirrored way
  std::span<const float> frozen{};    // as a brush's
};

// How much each vertex follows those that are led: 1 of these, else what a brush reaches about the nearest of them.
std::vector<double> reachAround(std::span<const int> led, std::span<const Vec3> seen, double radius, double falloff);

// What kept hair from going all of its way.
enum class HeldBy { kNothing, kPrism, kEdge, kBody, kFrozen, kCount };

class ShapeBrushes {
 public:
  explicit ShapeBrushes(const sim::HairMesh& mesh);

  // What one sample of a stroke makes of the mesh's rest positions, into `positions`. `seen`: the moving hair, one
  // place a vertex. `body`: signed distance to the body at rest; empty: there is none. Returns how many vertices it
  // moves: 0 where it reaches none, or where all that it reaches is as short, as long or as close as it may be.
  int apply(const Brush& brush, const sim::HairMesh& mesh, std::span<const Vec3> seen,
            const std::function<double(const Vec3&)>& body, std::vector<Vec3>& positions);

  // The same of a move. heldBy() says what kept those that are led from going all of their way, the most common of it.
  int move(const HairMove& move, const sim::HairMesh& mesh, std::span<const Vec3> seen,
           const std::function<double(const Vec3&)>& body, std::vector<Vec3>& positions);

  HeldBy heldBy() const { return held_by_; }
  // m, that the last cut or growth asked of each column; infinite: nothing. Prisms may have held it longer.
  const std::vector<double>& askedLengths() const { return asked_; }

 private:
  std::vector<int> neighbour_first_, neighbours_;  // of each vertex: within its layer, and in its column
  std::vector<double> weight_, share_;             // scratch: reach; how much of its way each vertex goes
  std::vector<Vec3> wanted_;
  std::vector<double> went_, asked_;
  std::vector<unsigned char> touched_;
  std::vector<int> tets_;
  std::array<int, static_cast<std::size_t>(HeldBy::kCount)> spoilt_{};  // vertices by HeldBy
  HeldBy held_by_ = HeldBy::kNothing;

  void reach(const Brush& brush, const sim::HairMesh& mesh, std::span<const Vec3> seen);
  void comb(const Brush& brush, const Vec3& along);
  void smooth(const sim::HairMesh& mesh);
  void puff(const Brush& brush, const sim::HairMesh& mesh);
  void push(const sim::HairMesh& mesh, const std::function<double(const Vec3&)>& body);
  void aboutHair(BrushTool tool, const sim::HairMesh& mesh);
  void scaleColumns(const Brush& brush, const sim::HairMesh& mesh, std::span<const Vec3> seen);
  void keepLengths(const sim::HairMesh& mesh);
  int finish(double spread, const sim::HairMesh& mesh, const std::function<double(const Vec3&)>& body,
             std::vector<Vec3>& positions);
  void holdBack(const sim::HairMesh& mesh, double spread);
  void limit(double spread, const sim::HairMesh& mesh, const std::function<double(const Vec3&)>& body,
             std::vector<Vec3>& positions);
};

}  // namespace app

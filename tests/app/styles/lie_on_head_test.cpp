// How the built-in styles lie on the head: the surface that the drawn strands make, against the scalp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "app/figure/character.h"
#include "app/scene/sim_to_render.h"
#include "app/styles/hair_styles.h"
#include "app/styles/style_roots.h"
#include "render/strands/hair_layout.h"
#include "tests/analytic_head.h"
#include "tests/strand_reference.h"

namespace lie_on_head_test {

using app::Resolution;
using app::Style;
using sim::Vec3;

constexpr double kDegree = std::numbers::pi / 180;

struct Head {
  const char* name;
  app::Scalp scalp;
  app::BodyDistance body;
};

const std::vector<Head>& heads() {
  static const std::vector<Head> all = [] {
    const app::Character character =
        app::loadCharacter(std::string(HAIRMESH_SOURCE_DIR) + "/assets/clips/idle_turns.bvh");
    return std::vector<Head>{{"analytic head", tests::analyticScalp(), tests::bodyDistance},
                             {"mannequin", character.scalp, app::restBodyDistance(character)}};
  }();
  return all;
}

// A place on the drawn strands of a style, seen from the scalp.
struct Sample {
  Vec3 place, skin;  // m; skin: the scalp under it
  double height;     // m over the scalp, along the ray from its centre
  double away;       // m from the parting's line on the scalp; positive: the character's left
  double along;      // 0 front of the parting, 1 crown: the station that `away` is taken from
};

struct Root {
  double angle;      // rad, between the strand and the scalp
  double away;       // m, as above
  double departing;  // cosine between the strand, in the scalp's tangent plane, and the way off the parting
};

struct Surface {
  std::vector<Sample> samples;
  std::vector<Root> roots;
};

std::vector<Vec3> partingOf(const app::Scalp& scalp, Style style) {
  const app::FlowLines lines = app::traceFlowLines(scalp, app::hasFringe(style));
  std::vector<Vec3> middle;
  for (int s = 0; 2 * s < lines.sheets; ++s)
    middle.push_back(0.5 * (lines.at(s, 0) + lines.at(lines.sheets - 1 - s, 0)));
  return middle;
}

// Nearest point of the parting's polyline: its station, and the signed distance.
void placeBeside(const std::vector<Vec3>& parting, const Vec3& p, double& along, double& away) {
  double nearest = 1e9;
  for (std::size_t i = 0; i + 1 < parting.size(); ++i) {
    const Vec3 step = parting[i + 1] - parting[i];
    const double t = std::clamp((p - parting[i]).dot(step) / step.squaredNorm(), 0.0, 1.0);
    const double distance = (p - parting[i] - t * step).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    along = (static_cast<double>(i) + t) / static_cast<double>(parting.size() - 1);
    away = p.x() > parting[i].x() ? distance : -distance;
  }
}

Surface surfaceOf(const Head& head, Style style, Resolution resolution) {
  const sim::HairMesh mesh = sim::buildHairMesh(app::makeStyle(style, resolution, head.scalp, head.body));
  std::vector<float> positions;
  app::blendPositions(mesh.shape.positions, mesh.shape.positions, 1, Vec3::Zero(), positions);
  const render::HairLayout layout = render::makeHairLayout(app::renderFaces(mesh), positions);
  const strand_reference::Reference strands(layout, positions);
  const std::vector<Vec3> parting = partingOf(head.scalp, style);
  Surface surface;
  const int across = mesh.vertexCount() < 1000 ? 6 : mesh.vertexCount() < 4000 ? 4 : 2, along_layers = 6;
  for (int face = 0; face < static_cast<int>(layout.faces.size()); ++face) {
    for (int i = 0; i < (across + 1) * (across + 1); ++i) {
      const strand_reference::Vec2 q(i % (across + 1) / static_cast<double>(across),
                                     i / (across + 1) / static_cast<double>(across));
      if (layout.face_columns[face][3] < 0 && q.sum() > 1) continue;
      const Vec3 root = strands.curve(face, q, 0), next = strands.curve(face, q, 0.05);
      const Vec3 normal = (root - head.scalp.center).normalized();
      Root leaving{std::asin((next - root).normalized().dot(normal)), 0, 0};
      double along = 0;
      placeBeside(parting, root, along, leaving.away);
      Vec3 off = root - parting[std::lround(along * (parting.size() - 1.0))], flow = next - root;
      off -= off.dot(normal) * normal;
      flow -= flow.dot(normal) * normal;
      leaving.departing = off.normalized().dot(flow.normalized());
      surface.roots.push_back(leaving);
      const double tip = layout.faces[face].layers - 1;
      for (int k = 1; k <= along_layers * tip; ++k) {
        Sample sample;
        sample.place = strands.curve(face, q, static_cast<double>(k) / along_layers);
        const Vec3 ray = sample.place - head.scalp.center;
        sample.skin = app::skinPoint(head.scalp, ray);
        sample.height = ray.norm() - head.scalp.radiusAt(ray);
        placeBeside(parting, sample.skin, sample.along, sample.away);
        surface.samples.push_back(sample);
      }
    }
  }
  return surface;
}

struct Name {
  const Head& head;
  Style style;
  Resolution resolution;
};

const Surface& surfaceOnce(const std::string& title, const Name& name) {
  static std::map<std::string, Surface> all;
  auto found = all.find(title);
  if (found == all.end()) found = all.emplace(title, surfaceOf(name.head, name.style, name.resolution)).first;
  return found->second;
}

template <class Law>
void forEveryStyle(Law law) {
  for (const Head& head : heads()) {
    for (const Style style : {Style::kShort, Style::kShoulder, Style::kLong, Style::kBob, Style::kPixie}) {
      // The minimal resolution is for hair that is small in the picture.
      for (const Resolution resolution :
           {Resolution::kLow, Resolution::kMedium, Resolution::kHigh, Resolution::kUltra}) {
        const std::string title = std::string(head.name) + ", " + std::string(app::styleName(style)) + " " +
                                  std::string(app::resolutionName(resolution));
        SCOPED_TRACE(title);
        const Name name{head, style, resolution};
        law(name, surfaceOnce(title, name));
      }
    }
  }
}

// m: the outer surface over square patches of scalp, 10 mm of the parting by 5 mm beside it, between two distances.
std::vector<double> outerHeights(const Surface& surface, double nearest, double farthest) {
  std::map<std::pair<int, int>, double> outer;
  for (const Sample& s : surface.samples) {
    if (s.along < 0.1 || s.along > 0.75 || std::abs(s.away) < nearest || std::abs(s.away) > farthest) continue;
    double& height = outer[{static_cast<int>(s.along * 10), static_cast<int>(std::floor(s.away / 0.005))}];
    height = std::max(height, s.height);
  }
  std::vector<double> heights;
  for (const auto& [patch, height] : outer) heights.push_back(height);
  std::sort(heights.begin(), heights.end());
  return heights;
}

double quantile(const std::vector<double>& sorted, double share) {
  return sorted.empty() ? 0 : sorted[static_cast<std::size_t>(share * (static_cast<double>(sorted.size()) - 1))];
}

// m: how deep the outline from an azimuth (0: the front) lies under its convex hull, over the upper half of the head.
double deepestNotch(const Surface& surface, const app::Scalp& scalp, double azimuth) {
  const Vec3 right(std::cos(azimuth), 0, -std::sin(azimuth));
  constexpr int kBins = 90;
  std::vector<double> radius(kBins + 1, 0.0);
  const auto add = [&](const Vec3& p) {
    const double angle = std::atan2(p.y(), p.dot(right)) / std::numbers::pi;
    if (angle < 0 || angle > 1) return;
    double& r = radius[static_cast<std::size_t>(std::lround(angle * kBins))];
    r = std::max(r, std::hypot(p.y(), p.dot(right)));
  };
  for (const Sample& s : surface.samples) add(s.place - scalp.center);
  for (int i = 0; i < 400; ++i)  // the head itself, where no hair stands out
    for (int j = 0; j < 100; ++j) add(app::skinPoint(scalp, app::scalpDirection(0.9 * i, 0.9 * j)) - scalp.center);
  std::vector<Eigen::Vector2d> outline;
  for (int i = 0; i <= kBins; ++i) {
    const double a = std::numbers::pi * i / kBins;
    if (radius[i] > 0) outline.emplace_back(radius[i] * std::cos(a), radius[i] * std::sin(a));
  }
  double deepest = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    for (std::size_t j = i + 2; j < outline.size(); ++j) {
      const Eigen::Vector2d chord = (outline[j] - outline[i]).normalized();
      for (std::size_t k = i + 1; k < j; ++k) {
        const Eigen::Vector2d in = outline[k] - outline[i];
        deepest = std::max(deepest, chord.x() * in.y() - chord.y() * in.x());
      }
    }
  }
  return deepest;
}

// m, what a resolution is held to. On a round head every edge of a prism dips below the scalp's tangent, and a prism is
// positive only if its columns climb: the coarser, the steeper.
struct Bounds {
  double near, beside, crown, notch;
};

Bounds boundsOf(Resolution resolution) {
  if (resolution == Resolution::kLow) return {0.013, 0.019, 0.024, 0.0075};
  if (resolution == Resolution::kUltra) return {0.014, 0.0215, 0.019, 0.004};
  return {0.008, resolution == Resolution::kHigh ? 0.013 : 0.0145, 0.018, 0.004};
}

TEST(StylesLieOnTheHead, LowBesideThePartingAndOverTheCrown) {
  forEveryStyle([](const Name& name, const Surface& surface) {
    const Bounds bounds = boundsOf(name.resolution);
    const std::vector<double> near = outerHeights(surface, 0.008, 0.020), beside = outerHeights(surface, 0.040, 0.050);
    EXPECT_GT(quantile(near, 0.5), 0.0025);
    EXPECT_LT(quantile(near, 1), bounds.near);
    EXPECT_LT(quantile(beside, 1), bounds.beside);
    double crown = 0;  // on the middle line, 30 to 60 mm behind the parting's end
    for (const Sample& s : surface.samples) {
      if (s.along > 0.999 && s.place.z() < name.head.scalp.center.z() && std::abs(s.skin.x()) < 0.015 &&
          std::abs(s.away) > 0.03 && std::abs(s.away) < 0.06)
        crown = std::max(crown, s.height);
    }
    EXPECT_GT(crown, 0.008);
    EXPECT_LT(crown,
              bounds.crown + (app::hasFringe(name.style) ? 0.001 : 0.0));  // its parting is shorter, and fans out more
  });
}

TEST(StylesLieOnTheHead, RootsLeaveTheScalpFlatAndOffTheParting) {
  forEveryStyle([](const Name& name, const Surface& surface) {
    std::vector<double> angles, departing;
    for (const Root& root : surface.roots) {
      angles.push_back(root.angle / kDegree);
      if (std::abs(root.away) > 0.002 && std::abs(root.away) < 0.01) departing.push_back(root.departing);
    }
    std::sort(angles.begin(), angles.end());
    std::sort(departing.begin(), departing.end());
    EXPECT_GT(quantile(angles, 0.5), 10);
    EXPECT_LT(quantile(angles, 0.5), 30);
    EXPECT_LT(quantile(angles, 0.9), 45);
    EXPECT_GT(quantile(departing, 0.03), name.resolution == Resolution::kLow ? -0.1 : 0.0);
  });
}

TEST(StylesLieOnTheHead, TheOutlineIsOneDome) {
  forEveryStyle([](const Name& name, const Surface& surface) {
    const Bounds bounds = boundsOf(name.resolution);
    EXPECT_LT(deepestNotch(surface, name.head.scalp, 0), bounds.notch) << "from the front";
    // From elsewhere the step at the hairline shows.
    for (const double azimuth : {45.0, 90.0, 135.0})
      EXPECT_LT(deepestNotch(surface, name.head.scalp, azimuth * kDegree), 0.012) << azimuth;
  });
}

}  // namespace lie_on_head_test

// The built-in styles: what a haircut must be on any head.
#include "app/styles/hair_styles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "app/figure/character.h"
#include "app/files/data_path.h"
#include "app/styles/style_untangle.h"
#include "tests/analytic_head.h"

namespace hair_styles_test {

using app::Resolution;
using app::Style;
using sim::HairMeshShape;
using sim::Vec3;

constexpr Style kStyles[] = {Style::kShort, Style::kShoulder, Style::kLong, Style::kBob, Style::kPixie};
constexpr Resolution kResolutions[] = {Resolution::kLow, Resolution::kMedium, Resolution::kHigh, Resolution::kUltra,
                                       Resolution::kMinimal};

struct Head {
  std::string name;
  app::Scalp scalp;
  app::BodyDistance body;
};

struct Haircut {
  std::string name;
  Style style;
  Resolution resolution;
  HairMeshShape shape;
};

std::vector<Haircut> haircutsOn(const Head& head) {
  std::vector<Haircut> out;
  for (const Style style : kStyles)
    for (const Resolution resolution : kResolutions)
      out.push_back(
          {head.name + ", " + std::string(app::styleName(style)) + " " + std::string(app::resolutionName(resolution)),
           style, resolution, app::makeStyle(style, resolution, head.scalp, head.body)});
  return out;
}

// The analytic head, and the mannequin that the program grows around its own clip.
const std::vector<Head>& heads() {
  static const std::vector<Head> all = [] {
    std::vector<Head> out{{"analytic head", tests::analyticScalp(), tests::bodyDistance}};
    const std::string clip = std::string(HAIRMESH_SOURCE_DIR) + "/assets/clips/idle_turns.bvh";
    if (std::filesystem::exists(clip)) {
      const app::Character character = app::loadCharacter(clip);
      out.push_back({"mannequin", character.scalp, app::restBodyDistance(character)});
    }
    return out;
  }();
  return all;
}

const std::vector<Haircut>& haircuts(const Head& head) {
  static std::map<std::string, std::vector<Haircut>> all;
  auto found = all.find(head.name);
  if (found == all.end()) found = all.emplace(head.name, haircutsOn(head)).first;
  return found->second;
}

int bundleLayers(const HairMeshShape& shape, const sim::RootFace& face) {
  int layers = shape.columnLength(face.columns[0]);
  for (int k = 1; k < face.corner_count; ++k) layers = std::min(layers, shape.columnLength(face.columns[k]));
  return layers;
}

const Vec3& vertex(const HairMeshShape& shape, int column, int layer) {
  return shape.positions[shape.column_first[column] + layer];
}

// Distance along a ray to a triangle, or a negative number.
double hit(const Vec3& origin, const Vec3& ray, const Vec3& a, const Vec3& b, const Vec3& c) {
  Eigen::Matrix3d m;
  m << b - a, c - a, -ray;
  if (std::abs(m.determinant()) < 1e-15) return -1;
  const Vec3 x = m.inverse() * (origin - a);
  return x.x() >= -1e-6 && x.y() >= -1e-6 && x.x() + x.y() <= 1 + 1e-6 ? x.z() : -1;
}

bool hitsRootFace(const HairMeshShape& shape, const Vec3& origin, const Vec3& ray) {
  for (const sim::RootFace& face : shape.root_faces) {
    const auto p = [&](int k) -> const Vec3& { return vertex(shape, face.columns[k], 0); };
    if (hit(origin, ray, p(0), p(1), p(2)) > 0) return true;
    if (face.corner_count == 4 && hit(origin, ray, p(0), p(2), p(3)) > 0) return true;
  }
  return false;
}

Vec3 direction(double azimuth, double elevation) {
  const double a = azimuth * std::numbers::pi / 180, e = elevation * std::numbers::pi / 180;
  return {std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a)};
}

template <class Law>
void forEveryHaircut(Law law) {
  for (const Head& head : heads()) {
    for (const Haircut& cut : haircuts(head)) {
      SCOPED_TRACE(cut.name);
      law(head, cut);
    }
  }
}

// Those of the paper, and of styles that are not in it as many as their length asks for.
TEST(HairStyles, VertexCountsAreAsDeclaredWithinFivePercent) {
  const std::map<std::pair<Style, Resolution>, int> wanted = {
      {{Style::kShort, Resolution::kLow}, 215},        {{Style::kShort, Resolution::kMedium}, 570},
      {{Style::kShort, Resolution::kHigh}, 1380},      {{Style::kShoulder, Resolution::kLow}, 361},
      {{Style::kShoulder, Resolution::kMedium}, 900},  {{Style::kShoulder, Resolution::kHigh}, 2305},
      {{Style::kLong, Resolution::kLow}, 361},         {{Style::kLong, Resolution::kMedium}, 900},
      {{Style::kLong, Resolution::kHigh}, 2305},       {{Style::kShort, Resolution::kUltra}, 7000},
      {{Style::kShoulder, Resolution::kUltra}, 10000}, {{Style::kLong, Resolution::kUltra}, 10000},
      {{Style::kShort, Resolution::kMinimal}, 85},     {{Style::kShoulder, Resolution::kMinimal}, 119},
      {{Style::kLong, Resolution::kMinimal}, 170},     {{Style::kBob, Resolution::kLow}, 385},
      {{Style::kBob, Resolution::kMedium}, 974},       {{Style::kBob, Resolution::kHigh}, 2293},
      {{Style::kBob, Resolution::kUltra}, 9899},       {{Style::kBob, Resolution::kMinimal}, 144},
      {{Style::kPixie, Resolution::kLow}, 275},        {{Style::kPixie, Resolution::kMedium}, 748},
      {{Style::kPixie, Resolution::kHigh}, 1433},      {{Style::kPixie, Resolution::kUltra}, 7805},
      {{Style::kPixie, Resolution::kMinimal}, 120}};
  forEveryHaircut([&](const Head&, const Haircut& cut) {
    const int count = wanted.at({cut.style, cut.resolution});
    EXPECT_NEAR(cut.shape.vertexCount(), count, 0.05 * count);
  });
}

TEST(HairStyles, AreValidHairMeshesOfTrianglesAndQuads) {
  forEveryHaircut([](const Head&, const Haircut& cut) {
    EXPECT_NO_THROW(sim::buildHairMesh(cut.shape));
    int triangles = 0, quads = 0;
    std::set<std::set<int>> faces;
    for (const sim::RootFace& face : cut.shape.root_faces) {
      (face.corner_count == 3 ? triangles : quads)++;
      EXPECT_TRUE(faces.emplace(face.columns.begin(), face.columns.begin() + face.corner_count).second);
    }
    EXPECT_GT(triangles, 0);
    EXPECT_GT(quads + (cut.resolution == Resolution::kMinimal), triangles);
    int shortest = 1000, longest = 0;
    for (int c = 0; c < cut.shape.columnCount(); ++c) {
      shortest = std::min(shortest, cut.shape.columnLength(c));
      longest = std::max(longest, cut.shape.columnLength(c));
    }
    // Columns of the coarsest styles are too short to lose a layer.
    if (cut.resolution != Resolution::kLow && cut.resolution != Resolution::kMinimal) {
      EXPECT_LT(shortest, longest);
    }
  });
}

TEST(HairStyles, PrismsAreFatAtEveryCorner) {
  forEveryHaircut([](const Head&, const Haircut& cut) {
    const HairMeshShape& s = cut.shape;
    double thinnest = 1;
    for (const sim::RootFace& face : s.root_faces) {
      const int n = face.corner_count;
      for (int l = 0; l + 1 < bundleLayers(s, face); ++l) {
        for (int k = 0; k < n; ++k) {
          const int here = face.columns[k], next = face.columns[(k + 1) % n], previous = face.columns[(k + n - 1) % n];
          thinnest = std::min(thinnest, app::cornerFatness(vertex(s, here, l), vertex(s, next, l),
                                                           vertex(s, previous, l), vertex(s, here, l + 1)));
          thinnest = std::min(thinnest, app::cornerFatness(vertex(s, here, l + 1), vertex(s, previous, l + 1),
                                                           vertex(s, next, l + 1), vertex(s, here, l)));
        }
      }
    }
    EXPECT_GT(thinnest, 0.05);
  });
}

// Degrees from square to the hair that a bundle's last layer lies.
double slantOfEnd(const HairMeshShape& shape, const sim::RootFace& face) {
  const int last = bundleLayers(shape, face) - 1;
  Vec3 normal = Vec3::Zero(), along = Vec3::Zero();
  for (int k = 0; k < face.corner_count; ++k) {
    const int here = face.columns[k], next = face.columns[(k + 1) % face.corner_count];
    normal += vertex(shape, here, last).cross(vertex(shape, next, last));
    along += (vertex(shape, here, last) - vertex(shape, here, last - 1)).normalized();
  }
  return std::acos(std::abs(normal.normalized().dot(along.normalized()))) * 180 / std::numbers::pi;
}

// Locks whose layers lie along the hair come to rest turned over (docs/safety_nets.md). Those in front of the shoulders
// are thin, and no root face joins them to the rest; the first lies at the begin of the list. Cut
// as far aslant as a full coat their layers would lie at 67 to 70 degrees on the mannequin, 70 to 77 on the other head.
TEST(HairStyles, LocksInFrontAreNotCutAlongTheHair) {
  forEveryHaircut([](const Head& head, const Haircut& cut) {
    if (cut.style != Style::kLong || cut.resolution == Resolution::kMinimal) return;
    std::vector<double> slants;
    std::set<int> lock;  // columns
    for (const sim::RootFace& face : cut.shape.root_faces) {
      const auto end = face.columns.begin() + face.corner_count;
      if (!lock.empty() && std::none_of(face.columns.begin(), end, [&](int c) { return lock.contains(c); })) break;
      lock.insert(face.columns.begin(), end);
      slants.push_back(slantOfEnd(cut.shape, face));
    }
    ASSERT_LT(slants.size(), cut.shape.root_faces.size());
    std::sort(slants.begin(), slants.end());
    EXPECT_LT(slants[slants.size() / 2], head.name == "mannequin" ? 64 : 72);
  });
}

TEST(HairStyles, EdgesAreNeitherShortNorEndless) {
  forEveryHaircut([](const Head&, const Haircut& cut) {
    const sim::HairMesh mesh = sim::buildHairMesh(cut.shape);
    for (const sim::Edge& e : mesh.horizontal_edges) EXPECT_GT(e.rest_length, 0.003);
    for (const sim::Edge& e : mesh.vertical_edges) {
      EXPECT_GT(e.rest_length, 0.003);
      EXPECT_LT(e.rest_length, 0.16);
    }
  });
}

TEST(HairStyles, RootsAreOnTheScalpAndAllElseIsClearOfTheBody) {
  forEveryHaircut([](const Head& head, const Haircut& cut) {
    double farthest = 0, nearest = 1;
    for (int c = 0; c < cut.shape.columnCount(); ++c) {
      const Vec3 root = vertex(cut.shape, c, 0) - head.scalp.center;
      farthest = std::max(farthest, std::abs(root.norm() - head.scalp.radiusAt(root)));
      for (int l = 1; l < cut.shape.columnLength(c); ++l)
        nearest = std::min(nearest, head.body(vertex(cut.shape, c, l)));
    }
    EXPECT_LT(farthest, 0.001);
    EXPECT_GT(nearest, 0.002);
  });
}

// Everything above a line from the forehead over the ears to the nape grows hair; the parting shows less than 5 mm of
// skin.
TEST(HairStyles, NoBaldPatch) {
  forEveryHaircut([](const Head& head, const Haircut& cut) {
    const auto covered = [&](const Vec3& ray) { return hitsRootFace(cut.shape, head.scalp.center, ray); };
    for (double azimuth = -180; azimuth < 180; azimuth += 5) {
      const double side = std::abs(azimuth);
      const double hairline = side < 62 ? 56 : side < 105 ? 24 : side < 140 ? 8 : -14;
      for (double elevation = hairline; elevation <= 88; elevation += 4) {
        const Vec3 ray = direction(azimuth, elevation);
        const Vec3 aside(0.0025 / head.scalp.radiusAt(ray), 0, 0);
        EXPECT_TRUE(covered(ray) || covered(ray + aside) || covered(ray - aside)) << azimuth << " " << elevation;
      }
    }
  });
}

// Between the temples and below the hairline, of a fringe below the brow, nothing stands before the face, whatever the
// layers do.
TEST(HairStyles, NothingHangsIntoTheFace) {
  forEveryHaircut([](const Head& head, const Haircut& cut) {
    const HairMeshShape& s = cut.shape;
    for (const sim::RootFace& face : s.root_faces) {
      for (int l = 0; l < bundleLayers(s, face); ++l) {
        for (int k = 0; k < face.corner_count; ++k) {
          const Vec3 p =
              0.5 * (vertex(s, face.columns[k], l) + vertex(s, face.columns[(k + 1) % face.corner_count], l)) -
              head.scalp.center;
          if (p.y() > (app::hasFringe(cut.style) ? -0.04 : 0.02) || p.y() < -0.55 * head.scalp.head_height || p.z() < 0)
            continue;
          const double azimuth = std::abs(std::atan2(p.x(), p.z())) * 180 / std::numbers::pi;
          EXPECT_GT(azimuth, app::hasFringe(cut.style) ? 26 : 42) << p.transpose();
        }
      }
    }
  });
}

// Below the hairline hair stands before the forehead, from temple to temple.
TEST(HairStyles, AFringeCoversTheForehead) {
  forEveryHaircut([](const Head& head, const Haircut& cut) {
    const HairMeshShape& s = cut.shape;
    const auto covered = [&](const Vec3& ray) {
      for (const sim::RootFace& face : s.root_faces) {
        for (int l = 0; l + 1 < bundleLayers(s, face); ++l) {
          for (int k = 0; k < face.corner_count; ++k) {
            const int a = face.columns[k], b = face.columns[(k + 1) % face.corner_count];
            const Vec3 &p = vertex(s, a, l), &q = vertex(s, b, l), &r = vertex(s, b, l + 1), &t = vertex(s, a, l + 1);
            const Vec3& eye = head.scalp.center;
            if (hit(eye, ray, p, q, r) > 0 || hit(eye, ray, p, r, t) > 0) return true;
          }
        }
      }
      return false;
    };
    for (double azimuth = -40; azimuth <= 40; azimuth += 5)
      EXPECT_EQ(covered(direction(azimuth, 17)), app::hasFringe(cut.style)) << azimuth;
  });
}

// Over the scalp hair fans out and where long hair divides over a shoulder it parts; elsewhere neighbours run alongside
// each other.
TEST(HairStyles, NeighbouringColumnsAreNearlyParallel) {
  forEveryHaircut([](const Head&, const Haircut& cut) {
    const HairMeshShape& s = cut.shape;
    std::vector<double> cosines;
    for (const sim::RootFace& face : s.root_faces) {
      for (int l = 0; l + 1 < bundleLayers(s, face); ++l) {
        for (int k = 0; k < face.corner_count; ++k) {
          const int a = face.columns[k], b = face.columns[(k + 1) % face.corner_count];
          cosines.push_back((vertex(s, a, l + 1) - vertex(s, a, l))
                                .normalized()
                                .dot((vertex(s, b, l + 1) - vertex(s, b, l)).normalized()));
        }
      }
    }
    std::sort(cosines.begin(), cosines.end());
    // Columns farther apart on a round head point farther apart.
    const double usual = cut.resolution == Resolution::kMinimal ? 25 : 15;
    EXPECT_GT(cosines[cosines.size() / 2], std::cos(usual * std::numbers::pi / 180));
    EXPECT_GT(cosines[cosines.size() / 20], std::cos(75 * std::numbers::pi / 180));
  });
}

// The same haircut at every resolution: hair of one resolution ends where that of another does.
TEST(HairStyles, ResolutionsAreTheSameHaircut) {
  for (const Head& head : heads()) {
    for (const Style style : kStyles) {
      SCOPED_TRACE(head.name + " " + std::string(app::styleName(style)));
      std::vector<std::vector<Vec3>> tips, full_tips;  // all; of the columns that reach the cut
      std::vector<double> volumes, lengths;
      for (const Haircut& cut : haircuts(head)) {
        if (cut.style != style) continue;
        const sim::HairMesh mesh = sim::buildHairMesh(cut.shape);
        volumes.push_back(mesh.total_volume);
        lengths.push_back(mesh.hair_length);
        tips.emplace_back();
        full_tips.emplace_back();
        int longest = 0;
        for (int c = 0; c < cut.shape.columnCount(); ++c) longest = std::max(longest, cut.shape.columnLength(c));
        for (int c = 0; c < cut.shape.columnCount(); ++c) {
          tips.back().push_back(vertex(cut.shape, c, cut.shape.columnLength(c) - 1));
          if (cut.shape.columnLength(c) == longest) full_tips.back().push_back(tips.back().back());
        }
      }
      for (const int coarse : {0, 1, 4}) {
        // Prisms of long edges are positive on a round head only where they stand off it: the minimal resolution's do.
        EXPECT_NEAR(volumes[coarse] / volumes[2], 1, coarse == 4 ? 1.15 : 0.4);
        EXPECT_NEAR(lengths[coarse] / lengths[2], 1, 0.10);
        const auto farthest = [](const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
          double most = 0;
          for (const Vec3& a : from) {
            double nearest = 1;
            for (const Vec3& b : to) nearest = std::min(nearest, (a - b).norm());
            most = std::max(most, nearest);
          }
          return most;
        };
        EXPECT_LT(farthest(full_tips[coarse], full_tips[2]), 0.032);
        // A column that ends a layer early ends by one of its own mesh's layers early, and coarse layers are long.
        EXPECT_LT(farthest(tips[coarse], tips[2]), 0.065);
      }
    }
  }
}

TEST(HairStyles, LengthsAreWhatTheNamesSay) {
  for (const Head& head : heads()) {
    std::map<Style, double> lowest;
    for (const Haircut& cut : haircuts(head)) {
      double y = 1;
      for (const Vec3& p : cut.shape.positions)
        y = std::min(y, (p.y() - head.scalp.center.y()) / head.scalp.head_height);
      if (cut.resolution == Resolution::kHigh) lowest[cut.style] = y;
    }
    SCOPED_TRACE(head.name);
    EXPECT_GT(lowest[Style::kShort], -0.50);
    EXPECT_LT(lowest[Style::kShoulder], -0.50);
    EXPECT_GT(lowest[Style::kShoulder], -1.00);
    EXPECT_LT(lowest[Style::kLong], -1.50);
    EXPECT_NEAR(lowest[Style::kBob], -0.50, 0.05);
    EXPECT_GT(lowest[Style::kPixie], -0.50);
  }
}

TEST(HairStyles, AreDeterministic) {
  const Head& head = heads().front();
  const HairMeshShape a = app::makeStyle(Style::kLong, Resolution::kMedium, head.scalp, head.body);
  const HairMeshShape b = app::makeStyle(Style::kLong, Resolution::kMedium, head.scalp, head.body);
  ASSERT_EQ(a.positions.size(), b.positions.size());
  for (std::size_t v = 0; v < a.positions.size(); ++v) EXPECT_EQ(a.positions[v], b.positions[v]);
}

// Heads that are not heads: a ball, a giant, a child, one with horns, one that looks into a wall.
TEST(HairStyles, ValidOnOddHeads) {
  struct Odd {
    const char* name;
    double scale, horns;
    bool wall;
  };
  for (const Odd& odd : {Odd{"child", 0.6, 0, false}, Odd{"giant", 3, 0, false}, Odd{"horned", 1, 0.06, false},
                         Odd{"wall", 1, 0, true}}) {
    SCOPED_TRACE(odd.name);
    app::Scalp scalp = tests::analyticScalp();
    scalp.head_height *= odd.scale;
    for (int i = 0; i < scalp.rows; ++i) {
      for (int j = 0; j < scalp.columns; ++j) {
        double& r = scalp.radius[static_cast<std::size_t>(i) * scalp.columns + j];
        if (i > 10 && i < 16 && (j % 64) > 20 && (j % 64) < 26) r += odd.horns;
        r *= odd.scale;
      }
    }
    const app::BodyDistance body = [&](const Vec3& p) {
      const double head = odd.scale * tests::bodyDistance(p / odd.scale);
      return odd.wall ? std::min(head, 0.16 + p.z()) : head;
    };
    for (const Style style : kStyles) {
      for (const Resolution resolution :
           {Resolution::kMinimal, Resolution::kLow, Resolution::kHigh, Resolution::kUltra}) {
        if (resolution == Resolution::kUltra && style != Style::kLong) continue;  // takes its time
        EXPECT_NO_THROW(sim::buildHairMesh(app::makeStyle(style, resolution, scalp, body)))
            << app::styleName(style) << " " << app::resolutionName(resolution);
      }
    }
  }
}

// Whoever is loaded gets hair: the paper's mannequin, a robot with a box for a head, a figure whose neck carries the
// head.
TEST(HairStylesOnCharacters, AreValidOnEachAtHand) {
  const std::string shared = std::string(HAIRMESH_SOURCE_DIR) + "/../shared";
  if (!std::filesystem::exists(shared)) GTEST_SKIP() << "needs " << shared;
  const std::pair<const char*, const char*> files[] = {{"/arcsim/dance.mot", "/arcsim/female-objs"},
                                                       {"/characters/robot.glb", ""},
                                                       {"/mocap/deepmimic_cartwheel.bvh", ""}};
  int found = 0;
  for (const auto& [motion, parts] : files) {
    if (!std::filesystem::exists(shared + motion)) continue;
    ++found;
    const app::Character character = app::loadCharacter(shared + motion, *parts ? shared + parts : "");
    const app::BodyDistance body = app::restBodyDistance(character);
    for (const Style style : kStyles) {
      for (const Resolution resolution : {Resolution::kLow, Resolution::kHigh}) {
        EXPECT_NO_THROW(sim::buildHairMesh(app::makeStyle(style, resolution, character.scalp, body)))
            << motion << " " << app::styleName(style) << " " << app::resolutionName(resolution);
      }
    }
  }
  EXPECT_GT(found, 0) << "no character in " << shared;
}

// Straight stubble of 16 mm on an ordinary head, outside of it, on the roots of short hair.
TEST(HairStyles, ShavedHairIsStubbleOnEachHeadAtHand) {
  const std::string robot = std::string(HAIRMESH_SOURCE_DIR) + "/../shared/characters/robot.glb";
  std::vector<std::string> files{app::dataPath("assets/clips/idle_turns.bvh")};
  if (std::filesystem::exists(robot)) files.push_back(robot);
  for (const std::string& file : files) {
    const app::Character character = app::loadCharacter(file, "");
    const app::BodyDistance body = app::restBodyDistance(character);
    for (const Resolution resolution :
         {Resolution::kMinimal, Resolution::kLow, Resolution::kMedium, Resolution::kHigh, Resolution::kUltra}) {
      const sim::HairMeshShape shape = app::makeStyle(Style::kShaved, resolution, character.scalp, body);
      ASSERT_NO_THROW(sim::buildHairMesh(shape)) << file << " " << app::resolutionName(resolution);
      EXPECT_EQ(shape.columnCount(), app::makeStyle(Style::kShort, resolution, character.scalp, body).columnCount());
      const double length = 0.016 * character.scalp.head_height / 0.23;
      for (int c = 0; c < shape.columnCount(); ++c) {
        const int first = shape.column_first[static_cast<std::size_t>(c)], tip = first + shape.columnLength(c) - 1;
        const Vec3& end = shape.positions[static_cast<std::size_t>(tip)];
        const double way = (end - shape.positions[static_cast<std::size_t>(first)]).norm();
        EXPECT_LT(way, 1.1 * length) << file;
        EXPECT_GT(way, 0.9 * length) << file;
      }
    }
  }
}

TEST(Scalp, RadiusIsInterpolatedAndPeriodic) {
  app::Scalp scalp;
  scalp.rows = 33;
  scalp.columns = 64;
  scalp.radius.resize(33 * 64);
  const auto radius = [](const Vec3& d) { return 0.1 + 0.01 * d.x() + 0.02 * d.y() - 0.015 * d.z() * d.x(); };
  for (int i = 0; i < 33; ++i)
    for (int j = 0; j < 64; ++j) scalp.radius[i * 64 + j] = radius(direction(j * 360.0 / 64, 90 - i * 180.0 / 32));
  for (double azimuth = -360; azimuth <= 360; azimuth += 7.3) {
    for (double elevation = -90; elevation <= 90; elevation += 6.1) {
      const Vec3 d = direction(azimuth, elevation);
      EXPECT_NEAR(scalp.radiusAt(3.7 * d), radius(d), 1.5e-4);
    }
  }
}

}  // namespace hair_styles_test

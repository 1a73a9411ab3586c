// The inspector of polygons: cards of a hairdo with one seeded defect each, in several formats; every defect is named.
#include "app/figure/strip_inspect.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/files/hair_file.h"
#include "app/files/output_file.h"
#include "app/files/polygon_file.h"
#include "app/files/text_file.h"
#include "app/styles/hair_styles.h"
#include "tests/app/groom/strip_samples.h"
#include "tests/run_program.h"

namespace strip_inspect_test {

using app::Vec3;
using Card = std::vector<std::array<Vec3, 2>>;  // m, in the head's frame: rows from root to tip

const app::Character& figure() {
  static const app::Character character = app::loadCharacter(app::dataPath("assets/clips/idle_turns.bvh"));
  return character;
}

// Whether a quad has a corner beyond 45 degrees from a right one: no modeller's card.
bool slanted(const Card& card) {
  for (std::size_t r = 0; r + 1 < card.size(); ++r) {
    const Vec3 across = (card[r][1] - card[r][0]).normalized();
    for (std::size_t k = 0; k < 2; ++k)
      if (std::abs(across.dot((card[r + 1][k] - card[r][k]).normalized())) > 0.7) return true;
  }
  return false;
}

// Between neighbouring columns of a built-in style: cards that lie on the head and outside of it.
const std::vector<Card>& cardsOf(app::Style style) {
  static std::map<app::Style, std::vector<Card>> made;
  std::vector<Card>& cards = made[style];
  if (!cards.empty()) return cards;
  const sim::HairMeshShape shape =
      app::makeStyle(style, app::Resolution::kLow, figure().scalp, app::restBodyDistance(figure()));
  std::vector<bool> taken(static_cast<std::size_t>(shape.columnCount()), false);
  for (const sim::RootFace& face : shape.root_faces) {
    const int a = face.columns[0], b = face.columns[1];
    if (taken[static_cast<std::size_t>(a)] || taken[static_cast<std::size_t>(b)]) continue;
    taken[static_cast<std::size_t>(a)] = taken[static_cast<std::size_t>(b)] = true;
    Card& card = cards.emplace_back();
    for (int l = 0; l < std::min(shape.columnLength(a), shape.columnLength(b)); ++l)
      card.push_back({shape.positions[shape.column_first[a] + l], shape.positions[shape.column_first[b] + l]});
    if (slanted(card)) cards.pop_back();
  }
  return cards;
}

struct Scene {
  std::vector<Card> cards;
  std::string more;  // of an OBJ, with indices from the end
  void each(auto&& change) {
    for (Card& card : cards)
      for (auto& row : card)
        for (Vec3& p : row) p = change(p);
  }
};

std::string objOf(const Scene& scene) {
  strip_samples::ObjText out;
  for (std::size_t c = 0; c < scene.cards.size(); ++c) {
    out.object("hair_" + std::to_string(c));
    std::vector<std::array<int, 2>> rows;
    for (const auto& row : scene.cards[c]) rows.push_back({out.vertex(row[0]), out.vertex(row[1])});
    for (std::size_t r = 0; r + 1 < rows.size(); ++r)
      out.face({rows[r][0], rows[r][1], rows[r + 1][1], rows[r + 1][0]});
  }
  return out.text + scene.more;
}

// Written in the format of the name's ending; returns the file. Fbx counts in centimetres.
std::string written(Scene scene, const std::string& folder, const std::string& ending) {
  if (ending == "fbx") scene.each([](const Vec3& p) { return Vec3(100 * p); });
  const std::string source = folder + "/hair.obj", file = folder + "/hair." + ending;
  app::writeFile(source, objOf(scene));
  if (ending == "obj") return source;
  Assimp::Importer importer;
  const aiScene* const read = importer.ReadFile(source, 0);
  const std::string made = ending == "vrm" ? file + ".glb" : file;
  EXPECT_EQ(Assimp::Exporter().Export(read, ending == "fbx" ? "fbxa" : "glb2", made, ending == "fbx" ? 0u : 8u),
            AI_SUCCESS);
  if (made != file) std::filesystem::rename(made, file);
  return file;
}

app::GroomInspection inspected(const std::string& file) {
  return app::inspectPolygons(app::readText(file), {}, false, file, figure());
}

std::string namesIn(const app::GroomInspection& inspection) {
  std::string names = inspection.summary + "\n";
  for (const app::GroomFinding& one : inspection.findings)
    names += one.what + ": " + one.text + "; " + one.mend + (one.certain ? " (certain)" : "") + "\n";
  return names;
}

struct Random {
  std::mt19937 engine;
  double between(double a, double b) { return a + (b - a) * static_cast<double>(engine()) / 4294967296.0; }
  Card& pick(Scene& scene) { return scene.cards[engine() % scene.cards.size()]; }
};

void widen(double scale, Scene& scene) {
  for (Card& card : scene.cards) {
    for (auto& row : card) {
      const Vec3 middle = (row[0] + row[1]) / 2;
      for (Vec3& p : row) p = middle + scale * (p - middle);
    }
  }
}

struct Defect {
  const char* what;
  const char* mend;  // of the option, or what it begins with
  void (*plant)(Random&, Scene&);
  bool of_gltf = true;  // else not: it tells its axis, and has triangles, which do not tell ends from sides
};

// Of all cards.
std::vector<Defect> wholeDefects() {
  return {
      {"unit", "--unit",
       [](Random& random, Scene& scene) {
         const double scale = random.engine() % 2 ? 100 : 1000;
         scene.each([&](const Vec3& p) { return Vec3(scale * p); });
       }},
      {"up", "--up z",
       [](Random&, Scene& scene) { scene.each([](const Vec3& p) { return Vec3(p.x(), -p.z(), p.y()); }); }, false},
      {"facing", "",
       [](Random&, Scene& scene) { scene.each([](const Vec3& p) { return Vec3(-p.x(), p.y(), -p.z()); }); }},
      {"roots", "",
       [](Random& random, Scene& scene) {
         const Vec3 away(random.between(-0.1, 0.1), random.between(0.1, 1.2), random.between(-0.2, 0.2));
         scene.each([&](const Vec3& p) { return Vec3(p + away); });
       }},
      {"widths", "make them 10 times", [](Random&, Scene& scene) { widen(0.1, scene); }},
      {"widths", "make them 0.1 times", [](Random&, Scene& scene) { widen(10, scene); }, false},
  };
}

// Of single ones.
std::vector<Defect> pieceDefects() {
  return {
      {"roots", "--drop-strips",
       [](Random& random, Scene& scene) {
         for (int n = 0; n < 3; ++n) {
           const Vec3 away =
               0.1 * Vec3(random.between(-1, 1), random.between(0.5, 1), -random.between(0, 1)).normalized();
           for (auto& row : random.pick(scene))
             for (Vec3& p : row) p += away;
         }
       }},
      {"reversed", "--flip-strips",
       [](Random& random, Scene& scene) {  // stands up: its highest end is the tip
         for (int n = 0; n < 3; ++n) {
           Card& card = random.pick(scene);
           const std::array<Vec3, 2> root = card[0];
           const Vec3 out = (root[0] - figure().scalp.center + Vec3(0, 0.15, 0)).normalized();
           for (std::size_t r = 0; r < card.size(); ++r)
             for (std::size_t k = 0; k < 2; ++k) card[r][k] = root[k] + 0.02 * static_cast<double>(r) * out;
         }
       }},
      {"astray", "it is left out",
       [](Random& random, Scene& scene) {
         const Vec3 away(random.between(2, 9), random.between(-2, 2), random.between(-2, 2));
         for (auto& row : random.pick(scene))
           for (Vec3& p : row) p += away;
       }},
      {"body", "lift them",
       [](Random& random, Scene& scene) {
         for (int n = 0; n < 3; ++n) {
           Card& card = random.pick(scene);
           for (std::size_t r = 1; r < card.size(); ++r)
             for (Vec3& p : card[r]) p += random.between(0.6, 0.7) * (figure().scalp.center - p);
         }
       }},
      {"zero-length", "",
       [](Random& random, Scene& scene) {
         Card& card = random.pick(scene);
         std::ranges::fill(card, card[0]);
       }},
      {"left out", "",
       [](Random&, Scene& scene) {  // a disc
         scene.more = "o hair_disc\nv 0 0.3 0\n";
         for (int k = 0; k < 16; ++k)
           scene.more += "v " + std::to_string(0.05 * std::cos(k * std::numbers::pi / 8)) + " 0.3 " +
                         std::to_string(0.05 * std::sin(k * std::numbers::pi / 8)) + "\n";
         for (int k = 0; k < 16; ++k)
           scene.more += "f -17 " + std::to_string(k - 16) + " " + std::to_string((k + 1) % 16 - 16) + "\n";
       }},
  };
}

const std::vector<std::string> kPolygonFormats{"obj", "glb", "fbx", "vrm"};
constexpr std::array kStyles{app::Style::kShort, app::Style::kShoulder, app::Style::kBob};

TEST(StripInspect, SaysNothingOfCardsThatFit) {
  std::vector<app::Style> styles(kStyles.begin(), kStyles.end());
  styles.push_back(app::Style::kLong);  // whose tips lie on the body
  for (const app::Style style : styles) {
    for (const std::string& format : kPolygonFormats) {
      const std::string file = written({cardsOf(style), ""}, test::freshFolder("strip_inspect_fits"), format);
      const app::GroomInspection inspection = inspected(file);
      EXPECT_TRUE(inspection.findings.empty()) << format << ": " << namesIn(inspection);
    }
  }
}

TEST(StripInspect, EverySeededDefectIsNamed) {
  int planted = 0, named = 0;
  std::vector<Defect> defects = wholeDefects();
  std::ranges::copy(pieceDefects(), std::back_inserter(defects));
  for (const Defect& defect : defects) {
    for (std::uint32_t seed = 0; seed < 4; ++seed) {
      const std::string& format = kPolygonFormats[seed % kPolygonFormats.size()];
      if (!defect.of_gltf && (format == "glb" || format == "vrm")) continue;
      Random random{std::mt19937(seed)};
      Scene scene{cardsOf(kStyles[(seed + seed / 3) % kStyles.size()]), ""};
      defect.plant(random, scene);
      const std::string file = written(scene, test::freshFolder("strip_inspect"), format);
      const app::GroomInspection inspection = inspected(file);
      ++planted;
      const auto is = [&](const app::GroomFinding& one) {
        const bool by_itself = one.certain || one.what != "reversed";  // single strips are turned
        return one.what == defect.what && one.fault && one.mend.starts_with(defect.mend) && by_itself;
      };
      const bool found = std::ranges::any_of(inspection.findings, is);
      named += found;
      EXPECT_TRUE(found) << defect.what << " of seed " << seed << " (" << format << "): " << namesIn(inspection);
    }
  }
  RecordProperty("planted", planted);
  EXPECT_EQ(named, planted);
  EXPECT_GE(planted, 40);
}

}  // namespace strip_inspect_test

// Hair meshes in another unit, with another axis up, about another origin or for another head come back to the scalp.
#include "app/figure/hair_fit.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <sstream>
#include <string>

#include "app/figure/strip_fit.h"
#include "app/files/data_path.h"
#include "app/files/hair_file.h"
#include "app/files/output_file.h"
#include "app/files/polygon_file.h"
#include "app/groom/groom_writer.h"
#include "app/scene/hair_from_file.h"
#include "tests/app/groom/combed_groom.h"
#include "tests/app/groom/strip_samples.h"
#include "tests/run_program.h"

namespace hair_fit_test {

using app::Vec3;

const app::Character& figure() {
  static const app::Character character = app::loadCharacter(app::dataPath("assets/clips/walk.bvh"));
  return character;
}

sim::HairMeshShape styled(app::Style style) {
  static const app::BodyDistance distance = app::restBodyDistance(figure());
  return app::makeStyle(style, app::Resolution::kLow, figure().scalp, distance);
}

template <class Change>
sim::HairMeshShape changed(sim::HairMeshShape shape, Change&& change) {
  for (Vec3& p : shape.positions) p = change(p);
  return shape;
}

double farthest(const sim::HairMeshShape& a, const sim::HairMeshShape& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.positions.size(); ++i) most = std::max(most, (a.positions[i] - b.positions[i]).norm());
  return most;
}

TEST(HairFit, WhatFitsIsLeftAlone) {
  for (const app::Style style :
       {app::Style::kShort, app::Style::kShoulder, app::Style::kLong, app::Style::kBob, app::Style::kPixie}) {
    const sim::HairMeshShape shape = styled(style);
    sim::HairMeshShape fitted = shape;
    EXPECT_EQ(app::fitHair(figure(), true, fitted), "");
    EXPECT_EQ(fitted.positions, shape.positions);
    EXPECT_LT(app::rootDistance(shape, figure().scalp), 0.25 * app::kFarRoots);
  }
}

TEST(HairFit, WhatIsNearTheHeadButTurnedAboutIsTurnedBack) {
  for (const app::Style style :
       {app::Style::kShort, app::Style::kShoulder, app::Style::kLong, app::Style::kBob, app::Style::kPixie}) {
    const sim::HairMeshShape shape = styled(style);
    const auto about = [](const Vec3& p) { return Vec3(-p.x(), p.y(), -p.z()); };
    sim::HairMeshShape file = changed(shape, about), told = file;
    const std::string note = app::fitHair(figure(), true, file);
    EXPECT_NE(note.find("y up, facing -z"), std::string::npos) << static_cast<int>(style) << ": " << note;
    EXPECT_LT(farthest(file, shape), 1e-9) << note;
    EXPECT_EQ(app::fitHair(figure(), true, told, {.axes = true}), "") << "told axes hold";
  }
}

TEST(HairFit, AToldAxisIsUpAndTheFacingIsFound) {
  const auto back = [](const Vec3& p) -> Vec3 { return Vec3(-p.x(), p.z(), p.y()) + Vec3(0, 0, 1.6); };  // facing y
  for (const char up : {'y', 'z'}) {
    sim::HairMeshShape file = changed(styled(app::Style::kLong), back);
    const std::string note = app::fitHair(figure(), true, file, {.metres = true, .up = up});
    EXPECT_EQ(note.find("z up, facing y") != std::string::npos, up == 'z') << note;
    EXPECT_EQ(farthest(file, styled(app::Style::kLong)) < 0.06, up == 'z') << note;
  }
}

struct Written {
  const char* name;
  Vec3 (*axes)(const Vec3&);  // of the scalp's frame, as the file has them
};
const Written kAxes[] = {{"", [](const Vec3& p) { return p; }},
                         {"z up, facing -y", [](const Vec3& p) { return Vec3(p.x(), -p.z(), p.y()); }},
                         {"z up, facing y", [](const Vec3& p) { return Vec3(-p.x(), p.z(), p.y()); }}};
struct In {
  const char* name;
  double in_a_metre;
};
const In kUnits[] = {
    {"", 1}, {"centimetres", 100}, {"millimetres", 1000}, {"inches", 1 / 0.0254}, {"feet", 1 / 0.3048}};

TEST(HairFit, UnitsAxesAndOriginAreNamedAndTakenBack) {
  const app::Rigid head = app::scalpToWorld(figure(), app::restPose(figure().skeleton));
  for (const app::Style style :
       {app::Style::kShort, app::Style::kShoulder, app::Style::kLong, app::Style::kBob, app::Style::kPixie}) {
    const sim::HairMeshShape shape = styled(style);
    for (const Written& axes : kAxes) {
      for (const In& unit : kUnits) {
        for (const bool from_ground : {false, true}) {
          sim::HairMeshShape file = changed(
              shape, [&](const Vec3& p) -> Vec3 { return unit.in_a_metre * axes.axes(from_ground ? head * p : p); });
          const double before = app::rootDistance(file, figure().scalp);
          const bool as_it_is = before <= app::kFarRoots * figure().scalp.head_height / 0.23;
          const sim::HairMeshShape unread = file;
          sim::HairMeshShape off = file;
          const std::string note = app::fitHair(figure(), true, file), told = app::fitHair(figure(), false, off);
          const std::string what = std::string(unit.name) + " " + axes.name + (from_ground ? " ground: " : ": ") + note;
          EXPECT_EQ(off.positions, unread.positions) << what;
          if (as_it_is) {
            EXPECT_EQ(note, "") << what;
            continue;
          }
          EXPECT_LT(farthest(file, shape), 1e-9) << what;
          EXPECT_NE(note.find(unit.name), std::string::npos) << what;
          EXPECT_NE(note.find(axes.name), std::string::npos) << what;
          EXPECT_EQ(note.find("figure's origin") != std::string::npos, from_ground) << what;
          EXPECT_NE(told.find("--fit on"), std::string::npos) << told;
        }
      }
    }
  }
}

TEST(HairFit, HairForAnotherHeadIsScaledAndMoved) {
  const double limit = app::kFarRoots * figure().scalp.head_height / 0.23;
  for (const double scale : {0.8, 1.3}) {
    sim::HairMeshShape file = changed(styled(app::Style::kShoulder),
                                      [&](const Vec3& p) -> Vec3 { return scale * p + Vec3(0.01, 0.1, -0.08); });
    ASSERT_GT(app::rootDistance(file, figure().scalp), limit);
    const std::string note = app::fitHair(figure(), true, file);
    EXPECT_NE(note.find("for another head, scaled by"), std::string::npos) << note;
    EXPECT_LT(app::rootDistance(file, figure().scalp), limit) << note;
    EXPECT_LT(farthest(file, styled(app::Style::kShoulder)), 0.06) << note;
  }
}

TEST(HairFit, HairOfTheRightSizeIsBroughtFromAnywhere) {
  const app::Rigid head = app::scalpToWorld(figure(), app::restPose(figure().skeleton));
  for (const double in_a_metre : {1.0, 100.0}) {
    for (const double off : {0.02, 0.1, 1.6, 40.0}) {
      sim::HairMeshShape file = changed(styled(app::Style::kShoulder), [&](const Vec3& p) -> Vec3 {
        return in_a_metre * (head * p + Vec3(0, off, 0));
      });
      const std::string note = app::fitHair(figure(), true, file);
      EXPECT_LT(farthest(file, styled(app::Style::kShoulder)), 0.06) << off << ": " << note;
      EXPECT_EQ(note.find("centimetres") != std::string::npos, in_a_metre == 100) << off << ": " << note;
    }
  }
}

TEST(HairFit, AFileInNoKnownSizeOrAxesIsSaidAndLeftAlone) {
  const std::vector<Vec3 (*)(const Vec3&)> kUnknown{[](const Vec3& p) -> Vec3 { return 1e-5 * p; },
                                                    [](const Vec3& p) { return Vec3(p.y(), -p.x(), p.z()); }};
  for (const auto& unknown : kUnknown) {
    sim::HairMeshShape file = changed(styled(app::Style::kLong), unknown);
    const sim::HairMeshShape before = file;
    const std::string note = app::fitHair(figure(), true, file);
    EXPECT_NE(note.find("in no unit"), std::string::npos) << note;
    EXPECT_TRUE(file.positions == before.positions) << note;
  }
}

// Hair of back and sides alone, on a head a little larger: as round as ours, it fits the face nearly as well.
sim::HairMeshShape backHair() {
  const app::Scalp& scalp = figure().scalp;
  sim::HairMeshShape shape;
  shape.column_first = {0};
  for (const double polar : {0.8, 1.2, 1.5}) {
    for (int j = 0; j <= 8; ++j) {
      const double azimuth = std::numbers::pi * (0.5 + j / 8.0);
      const Vec3 out(std::sin(polar) * std::sin(azimuth), std::cos(polar), std::sin(polar) * std::cos(azimuth));
      const Vec3 root = scalp.center + 1.06 * scalp.radiusAt(out) * out;
      for (int l = 0; l < 5; ++l) shape.positions.push_back(root + l * (0.006 * out - Vec3(0, 0.06, 0)));
      shape.column_first.push_back(static_cast<int>(shape.positions.size()));
    }
  }
  return shape;
}

double meanForward(const sim::HairMeshShape& shape) {
  double forward = 0;
  for (const Vec3& p : shape.positions)
    forward += (p.z() - figure().scalp.center.z()) / static_cast<double>(shape.positions.size());
  return forward;
}

TEST(HairFit, HairOfTheBackIsNotReadAsHairBeforeTheFace) {
  for (const double in_a_metre : {1.0, 100.0}) {
    for (const double up : {0.0, 0.05, 1.6}) {
      sim::HairMeshShape file = changed(backHair(), [&](const Vec3& p) -> Vec3 {
        return in_a_metre * (Vec3(p.x(), -p.z(), p.y()) + Vec3(0, 0, up));
      });
      const std::string note = app::fitHair(figure(), true, file);
      EXPECT_NE(note.find("z up, facing -y"), std::string::npos) << note;
      EXPECT_LT(meanForward(file), -0.01) << note;
    }
  }
}

// What --mends tells of a hair mesh holds, whatever else would fit.
TEST(HairFit, ToldUnitAndAxesOfAHairMeshAreTaken) {
  const std::string folder = test::freshFolder("told_mends");
  app::CharacterSpec spec;
  spec.hair = folder + "/hair.obj";
  app::writeFile(spec.hair, app::writeHairMesh(changed(styled(app::Style::kShort), [](const Vec3& p) -> Vec3 {
                   return 100 * Vec3(p.x(), -p.z(), p.y());
                 })));
  spec.mends = "--unit cm --up z --turn 180 --points 9";
  app::Haircut turned;
  EXPECT_NEAR(meanForward(app::hairFromFile(spec, figure(), turned)), -meanForward(styled(app::Style::kShort)), 0.02)
      << turned.note;
  EXPECT_NE(turned.note.find("of a hair mesh \"mends\" are"), std::string::npos) << turned.note;
  spec.mends = "--unit cm --up z";
  app::Haircut upright;
  EXPECT_LT(farthest(app::hairFromFile(spec, figure(), upright), styled(app::Style::kShort)), 1e-6) << upright.note;
  EXPECT_EQ(upright.note, "");
}

// What hairmesh-convert writes are two files; who opens one alone is told of the other.
TEST(HairFit, AHairMeshSaysThatItsStrandsLookIsBesideIt) {
  const std::string folder = test::freshFolder("look_beside");
  app::CharacterSpec spec;
  spec.hair = folder + "/hair.obj";
  app::writeFile(spec.hair, app::writeHairMesh(styled(app::Style::kShort)));
  const auto noteOf = [&] {
    app::Haircut cut;
    app::hairFromFile(spec, figure(), cut);
    return cut.note;
  };
  EXPECT_EQ(noteOf(), "");
  app::writeFile(folder + "/hair.json", R"({"characters": []})");
  EXPECT_EQ(noteOf(), "") << "a scene is no look";
  app::writeFile(folder + "/hair.json", R"({"name": "hair", "hair": {"curl_radius": 0.01}})");
  EXPECT_NE(noteOf().find("look is in " + folder + "/hair.json"), std::string::npos) << noteOf();
  spec.look.hair.frizz = 0.001f;
  EXPECT_NE(noteOf(), "") << "another look";
  spec.look.hair = {};
  spec.look.hair.curl_radius = 0.01f;
  EXPECT_EQ(noteOf(), "") << "it was opened already";
}

TEST(HairFit, TheProgramSaysItOnceAndReadsIt) {
  const std::string folder = test::freshFolder("hair_fit"), file = folder + "/hair.obj", out = folder + "/out.obj";
  app::writeFile(file, app::writeHairMesh(changed(styled(app::Style::kShort), [](const Vec3& p) -> Vec3 {
                   return 100 * Vec3(p.x(), -p.z(), p.y());
                 })));
  const std::vector<std::string> run{"--no-images", "--frames", "2", "--motion", "walk.bvh", "--hair", file};
  const test::Outcome fitted = test::runProgram(run);
  EXPECT_EQ(fitted.exit_code, 0) << fitted.err;
  EXPECT_NE(fitted.err.find("looks like centimetres, z up, facing -y, and is read so"), std::string::npos)
      << fitted.err;
  std::vector<std::string> off = run;
  off.insert(off.end(), {"--fit", "off"});
  const test::Outcome left = test::runProgram(off);
  EXPECT_EQ(left.exit_code, 0) << left.err;
  EXPECT_NE(left.err.find("--fit on reads it so"), std::string::npos) << left.err;
}

// Strips are rooted at their highest ends: which ends these are depends on the axis that is up.
TEST(HairFit, StripsAwayFromTheHeadAreBroughtToItWithEitherAxisUp) {
  const std::string folder = test::freshFolder("fit_strips");
  for (const bool z_up : {false, true}) {
    strip_samples::ObjText made;
    for (const Vec3& root : strip_samples::rootsOnHead(60)) strip_samples::card(root, 1, 6, 0.3, 0, made);
    std::string text;
    std::istringstream lines(made.text);
    for (std::string line; std::getline(lines, line);) {
      double x = 0, y = 0, z = 0;
      if (std::sscanf(line.c_str(), "v %lf %lf %lf", &x, &y, &z) == 3) {
        const Vec3 p = Vec3(2, 3, 1) + (z_up ? Vec3(x, -z, y) : Vec3(x, y, z));
        line = "v " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z());
      }
      text += line + "\n";
    }
    app::CharacterSpec spec;
    spec.hair = folder + (z_up ? "/z.obj" : "/y.obj");
    if (z_up) spec.mends = "--push-out";
    app::writeFile(spec.hair, text);
    app::Haircut haircut;
    const sim::HairMeshShape shape = app::hairFromFile(spec, figure(), haircut);
    EXPECT_LT(app::rootDistance(shape, figure().scalp), app::kFarRoots) << haircut.note;
    EXPECT_EQ(haircut.note.find("z up, facing") != std::string::npos, z_up) << haircut.note;
    EXPECT_EQ(haircut.note.find("of strips \"mends\" are") != std::string::npos, z_up) << haircut.note;
    double fall = 0;
    for (int c = 0; c < shape.columnCount(); ++c) {
      const int root = shape.column_first[static_cast<std::size_t>(c)];
      fall += shape.positions[static_cast<std::size_t>(root)].y() -
              shape.positions[static_cast<std::size_t>(root + shape.columnLength(c) - 1)].y();
    }
    EXPECT_GT(fall / shape.columnCount(), 0.1);
  }
}

// What a USD file says of its unit holds; that its hair looks like another is said with the option that says so.
TEST(HairFit, ADoubtedUnitOfAGroomIsSaid) {
  std::filesystem::create_directories(HAIRMESH_TEST_OUT);
  const std::string file = std::string(HAIRMESH_TEST_OUT) + "/false_unit.usda";
  app::Groom groom = combed::combedGroom(300, 5);
  combed::moveAll(groom, Eigen::Matrix3f::Identity(), 1 / 0.3048f, Eigen::Vector3f::Zero());
  app::writeGroom(groom, file);
  app::CharacterSpec spec;
  spec.hair = file;
  app::Haircut haircut;
  app::hairFromFile(spec, figure(), haircut);
  EXPECT_NE(haircut.note.find("fits ft; the file tells 1 m a unit (--mends \"--unit ft\")"), std::string::npos)
      << haircut.note;
  spec.mends = "--unit ft";
  app::Haircut mended;
  app::hairFromFile(spec, figure(), mended);
  EXPECT_EQ(mended.note.find("the file tells"), std::string::npos) << mended.note;
}

// A column of two vertices, `rise` and 8 cm outwards from where `out` meets the scalp, about the figure's feet.
void addColumn(const Vec3& out, double rise, sim::HairMeshShape& shape) {
  const app::Scalp& scalp = figure().scalp;
  const Vec3 along = out.normalized(), root = scalp.center + scalp.radiusAt(along) * along + Vec3(0, 1.55, 0);
  if (shape.column_first.empty()) shape.column_first.push_back(0);
  shape.positions.push_back(root);
  shape.positions.push_back(root + 0.08 * along + Vec3(0, rise, 0));
  shape.column_first.push_back(static_cast<int>(shape.positions.size()));
}

TEST(HairFit, AFringeStaysInFront) {
  sim::HairMeshShape fringe;
  for (double turn = -1.3; turn <= 1.31; turn += 0.1) {
    for (const double lift : {0.5, 0.9}) addColumn({std::sin(turn), lift, std::cos(turn)}, -0.15, fringe);
  }
  const std::string note = app::fitHair(figure(), true, fringe, {.metres = true});
  EXPECT_EQ(note.find("facing"), std::string::npos) << note;
  EXPECT_LT(app::rootDistance(fringe, figure().scalp), app::kFarRoots) << note;
  EXPECT_GT(fringe.positions[fringe.positions.size() / 2 & ~1u].z(), figure().scalp.center.z()) << note;
}

// Standing hair on the crown fits in many ways: alone it rises from where it is brought to, and a head in its file
// tells its own place.
TEST(HairFit, TheHeadOfAFilePlacesItsHair) {
  sim::HairMeshShape spikes;
  std::vector<Vec3> head;
  for (double turn = 0; turn < 6.2; turn += 0.3) {
    for (const double lift : {2.0, 4.0}) addColumn({std::sin(turn), lift, std::cos(turn)}, 0.05, spikes);
    for (double lift = -2; lift <= 2; lift += 0.25) {
      const Vec3 out = Vec3(std::sin(turn), lift, std::cos(turn)).normalized();
      head.push_back(figure().scalp.center + figure().scalp.radiusAt(out) * out + Vec3(0, 1.55, 0));
    }
  }
  sim::HairMeshShape alone = spikes;
  EXPECT_NE(app::fitHair(figure(), true, alone, {.metres = true}).find("hair for another head"), std::string::npos);
  EXPECT_LT(app::rootDistance(alone, figure().scalp), app::kFarRoots);
  EXPECT_GT(alone.positions[1].y(), alone.positions[0].y());
  const std::string note = app::fitHair(figure(), true, spikes, {.metres = true}, head);
  EXPECT_LT(app::rootDistance(spikes, figure().scalp), 0.5 * app::kFarRoots) << note;
}

// A card that rises from its root by 7 cm and comes forward; `over`: its tip falls below its root.
void quiffCard(const Vec3& root, bool over, strip_samples::ObjText& out) {
  constexpr int kRows = 8;
  std::vector<std::array<int, 2>> rows;
  for (int r = 0; r <= kRows; ++r) {
    const double t = static_cast<double>(r) / kRows;
    const Vec3 place =
        root + Vec3(0, 0.07 * std::sin((over ? 1.1 : 0.7) * std::numbers::pi * t), (over ? 0.08 : 0.04) * t);
    rows.push_back({out.vertex(place - Vec3(0.008, 0, 0)), out.vertex(place + Vec3(0.008, 0, 0))});
  }
  for (std::size_t r = 0; r < kRows; ++r) out.quad(rows[r][0], rows[r][1], rows[r + 1][1], rows[r + 1][0]);
}

// Cards of a quiff over the forehead, in a file without a head: where the figure stands, in any usual unit and either
// axis up. Roots come to the scalp, and hair rises from them.
TEST(HairFit, CardsThatStandAreRootedAtTheEndsThatLieOnTheHead) {
  const std::string folder = test::freshFolder("fit_quiff");
  const app::Rigid to_world = app::scalpToWorld(figure(), app::restPose(figure().skeleton));
  for (const bool over : {false, true}) {
    for (const double units : {1.0, 100.0, 1000.0}) {
      for (const bool z_up : {false, true}) {
        strip_samples::ObjText made;
        made.scale = units;
        made.z_up = z_up;
        for (int i = 0; i < 40; ++i) {
          const double side = 0.2 * (i % 8 - 3.5), ahead = 0.45 - 0.22 * (i / 8);
          const Vec3 out = Vec3(side, 1, ahead).normalized();
          quiffCard(to_world * Vec3(figure().scalp.center + figure().scalp.radiusAt(out) * out), over, made);
        }
        const std::string file = folder + "/quiff.obj";
        app::writeFile(file, made.text);
        const app::PolygonMesh mesh = app::readPolygons(file);
        const app::FittedStrips fitted = app::fitStrips(mesh, {}, false, file, figure(), true);
        const sim::HairMeshShape& shape = fitted.conversion.mesh.shape;
        SCOPED_TRACE(std::to_string(units) + (over ? " over" : "") + (z_up ? " z up: " : ": ") + fitted.fit);
        EXPECT_LT(app::rootDistance(shape, figure().scalp), 0.25 * app::kFarRoots);
        EXPECT_LT(fitted.as_made_distance, 0.25 * app::kFarRoots);
        double rise = 0;
        for (int c = 0; c < shape.columnCount(); ++c) {
          const int root = shape.column_first[c];
          rise += (shape.positions[root + 1] - shape.positions[root]).normalized().y() / shape.columnCount();
        }
        EXPECT_GT(rise, 0.7);
      }
    }
  }
}

}  // namespace hair_fit_test

// Hats, glasses, collars: the hair stays outside of them and under them, what cannot be worn is told, and they are put
// on, undone, saved and recorded.
#include "app/scene/attachments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "app/files/errors.h"
#include "app/files/file_kind.h"
#include "app/files/recording.h"
#include "app/scene/record/hair_export.h"
#include "tests/app/scene/small_scene.h"
#include "tests/run_program.h"

namespace attachments_test {

using app::Ask;

app::Scene wearing(const std::string& text, app::Style style = app::Style::kLong, const char* clip = "walk.bvh") {
  app::Scene scene = test::smallScene(clip, 0.5);
  scene.characters[0].style = style;
  scene.characters[0].attachments = app::attachmentsFromText(text);
  return scene;
}

std::string refusalOf(const std::string& text) {
  try {
    app::openScene(wearing(text), 1.5);
  } catch (const app::InputError& error) {
    return error.what();
  }
  return "accepted";
}

// m, how deep the deepest vertex lies in what the first character wears, roots left out.
double deepestOf(const app::Demo& demo) {
  double deepest = 0;
  const app::Actor& actor = demo.actors[0];
  for (const app::WornAttachment& worn : actor.worn) {
    const app::Rigid to_joint = actor.pose.world[static_cast<std::size_t>(worn.mesh->part.joint)].inverse();
    for (int v = 0; v < actor.haircut->mesh.vertexCount(); ++v) {
      if (actor.haircut->mesh.isRoot(v)) continue;
      deepest = std::max(
          deepest, -worn.mesh->part.grid.interpolate(to_joint * actor.hair.positions[static_cast<std::size_t>(v)]));
    }
  }
  return deepest;
}

// A box between two corners as OBJ, m about the head joint; `open` leaves one side out.
std::string box(const std::string& name, const sim::Vec3& low, const sim::Vec3& high, bool open = false) {
  const std::string file = test::freshFolder("attachments_" + name) + "/" + name + ".obj";
  std::ofstream out(file);
  for (int k = 0; k < 8; ++k)
    out << "v " << (k & 1 ? high.x() : low.x()) << " " << (k & 2 ? high.y() : low.y()) << " "
        << (k & 4 ? high.z() : low.z()) << "\n";
  out << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\n";
  if (!open) out << "f 2 4 8 6\n";
  return file;
}

TEST(Attachments, TheHairStaysOutsideInAWalkAndAHeadShake) {
  for (const char* file : {"beanie.obj", "headband.obj", "sun_hat.obj", "glasses.obj"}) {
    for (const app::Style style :
         {app::Style::kShort, app::Style::kShoulder, app::Style::kLong, app::Style::kBob, app::Style::kPixie}) {
      if (file == std::string("beanie.obj") && app::hasFringe(style)) {
        EXPECT_THROW(app::openScene(wearing(file, style, "head_shake.bvh"), 1.5), app::InputError)
            << "a rim on a fringe";
        continue;
      }
      app::Demo demo = app::openScene(wearing(file, style, "head_shake.bvh"), 1.5);
      EXPECT_LT(deepestOf(demo), 0.001) << file << " " << app::styleName(style) << " at rest";
      double deepest = 0;
      int recoveries = 0;
      for (int frame = 0; frame < 90; ++frame) {
        app::advanceFrame(demo, 1.0 / 60, {});
        deepest = std::max(deepest, deepestOf(demo));
        recoveries += demo.stats.recoveries;
      }
      std::printf("%s %s: %.2f mm, %zu vertices under it\n", file, std::string(app::styleName(style)).c_str(),
                  1000 * deepest, demo.actors[0].haircut->covered.size());
      EXPECT_LT(deepest, 0.003) << file << " " << app::styleName(style);
      EXPECT_EQ(recoveries, 0);
    }
  }
}

TEST(Attachments, WhatHangsInTheAirIsSaid) {
  const auto noteOf = [](const std::string& file) {
    const app::Demo demo = app::openScene(wearing(file, app::Style::kShort, "idle_turns.bvh"), 1.5);
    return app::attachmentNotes(demo.actors[0]);
  };
  for (const char* file : {"beanie.obj", "headband.obj", "sun_hat.obj", "glasses.obj"})
    EXPECT_EQ(noteOf(file).find("hangs"), std::string::npos) << file;
  const std::string note = noteOf(box("high", sim::Vec3(-0.1, 0.32, -0.1), sim::Vec3(0.1, 0.36, 0.1)));
  EXPECT_NE(note.find("high hangs "), std::string::npos) << note;
}

TEST(Attachments, WhatCannotBeWornIsTold) {
  const auto told = [](const std::string& text, const std::string& part) {
    const std::string refusal = refusalOf(text);
    EXPECT_NE(refusal.find(part), std::string::npos) << refusal;
    EXPECT_NE(refusal.find("; "), std::string::npos) << "no mend: " << refusal;
  };
  const sim::Vec3 a(-0.2, -0.1, -0.2), b(0.2, 0.3, 0.2);
  told(box("solid", a, b), "encloses");
  told(box("open", a, b, true), "is open: 4 edges");
  told("beanie.obj@hed", "no such joint");
  told("nothing.obj", "is not there");
  told(R"({"file": "beanie.obj", "at": [0, -0.05, 0]})", "encloses");
  told(box("far", sim::Vec3(4, 4, 4), sim::Vec3(4.2, 4.2, 4.2)), "from the joint");
  told(box("huge", sim::Vec3(-3, -3, -3), sim::Vec3(3, 3, 3)), "nothing to wear");
  const std::string text = test::freshFolder("attachments_text") + "/hat.obj";
  std::ofstream(text) << "a hat, as a poem\n";
  EXPECT_NE(refusalOf(text), "accepted");
  const test::Outcome run =
      test::runProgram({"--headless", "--no-images", "--frames", "1", "--attach", box("open2", a, b, true)});
  EXPECT_EQ(run.exit_code, app::kExitBadInput) << run.err;
}

TEST(Attachments, ASheetIsToldThatAClosedMeshIsNeeded) {
  const std::string file = test::freshFolder("attachments_sheet") + "/sheet.obj";
  std::ofstream(file) << "v -0.1 0.2 -0.1\nv 0.1 0.2 -0.1\nv 0.1 0.2 0.1\nv -0.1 0.2 0.1\nf 1 2 3 4\n";
  const std::string refusal = refusalOf(file);
  EXPECT_NE(refusal.find("is open: 4 edges"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("a thickness"), std::string::npos) << refusal;
}

TEST(Attachments, AnAtInAFilesNameNeedsNoJoint) {
  const std::string folder = test::freshFolder("attachments_at"), file = folder + "/cap@home.obj";
  std::filesystem::copy_file(app::dataPath("assets/attachments/beanie.obj"), file);
  const auto given = app::attachmentsFromText(file), placed = app::attachmentsFromText(file + "@Neck");
  EXPECT_EQ(given.at(0).file, file);
  EXPECT_EQ(given.at(0).joint, "head");
  EXPECT_EQ(placed.at(0).file, file);
  EXPECT_EQ(placed.at(0).joint, "Neck");
  EXPECT_EQ(refusalOf(file), "accepted");
}

TEST(Attachments, NothingIsRefusedAndNoneIsNone) {
  EXPECT_THROW(app::attachmentsFromText(""), app::InputError);
  EXPECT_TRUE(app::attachmentsFromText("none").empty());
}

TEST(Attachments, TheSameTwiceIsSaidOnce) {
  const app::Demo twice = app::openScene(wearing(R"([{"file": "beanie.obj"}, {"file": "beanie.obj"}])"), 1.5);
  EXPECT_EQ(twice.message, "beanie is worn 2 times in one place; take the others off");
  const app::Demo both = app::openScene(wearing(R"([{"file": "headband.obj"}, {"file": "glasses.obj"}])"), 1.5);
  EXPECT_EQ(both.message, "");
}

TEST(Attachments, TheFilesMaterialGivesTheColourUnlessTheSceneDoes) {
  const std::string file = box("dyed", sim::Vec3(-0.05, 0.24, -0.05), sim::Vec3(0.05, 0.32, 0.05));
  const std::string shape = test::readAll(file);
  std::ofstream(std::filesystem::path(file).replace_extension(".mtl")) << "newmtl felt\nKd 0.5 0.25 0.125\n";
  std::ofstream(file) << "mtllib dyed.mtl\nusemtl felt\n" << shape;
  const app::Demo demo = app::openScene(wearing(file), 1.5);
  EXPECT_EQ(app::wornColor(demo.actors[0], 0), (std::array{0.5f, 0.25f, 0.125f}));
  const app::Demo picked = app::openScene(wearing(R"({"file": ")" + file + R"(", "color": [1, 0, 0]})"), 1.5);
  EXPECT_EQ(app::wornColor(picked.actors[0], 0), (std::array{1.0f, 0.0f, 0.0f}));
  std::filesystem::remove(std::filesystem::path(file).replace_extension(".mtl"));
  const app::Demo plain = app::openScene(wearing(file), 1.5);
  EXPECT_NE(plain.message.find("its materials 'dyed.mtl' are not there"), std::string::npos) << plain.message;
  const app::Scene back = app::readScene(app::writeScene(wearing(file)), "scene.json");
  EXPECT_FALSE(back.characters[0].attachments[0].color.has_value());
}

// Of the strands' points where a headband is, the share that lies over it.
double shareOver(const app::Demo& demo) {
  const app::Actor& actor = demo.actors[0];
  const app::Scalp& scalp = actor.body->character.scalp;
  const app::Rigid to_scalp = app::scalpToWorld(actor.body->character, actor.shown_pose).inverse();
  const app::Attachment& band = *actor.worn[0].mesh;
  const app::Rigid to_joint = band.to_scalp.inverse(Eigen::Isometry);
  app::StrandExport strands(demo, app::ExportWhat::kStrands, 0);
  const app::Groom& groom = strands.groom(demo, 1);
  double at_band = 0, over = 0;
  for (std::size_t s = 0; s < groom.strandCount(); s += 3) {
    for (const Eigen::Vector3f& point : groom.strand(s)) {
      const app::Vec3 place = to_scalp * point.cast<double>(), out = place - scalp.center;
      const double meets = app::meetsAlong(band, scalp, out, 0.04);
      if (std::isinf(meets)) continue;
      at_band += 1;
      over += out.norm() > meets && band.part.grid.interpolate(to_joint * place) > 0;
    }
  }
  return over / at_band;
}

// With the hair of the crown left to lie over it, and that of the nape to fall through it, 0.04 to 0.07.
TEST(Attachments, HairPassesUnderAHeadband) {
  for (const app::Style style : {app::Style::kLong, app::Style::kShoulder}) {
    app::Scene scene = wearing("headband.obj", style, "head_shake.bvh");
    scene.characters[0].resolution = app::Resolution::kMedium;
    app::Demo demo = app::openScene(std::move(scene), 1.5);
    app::advanceFrame(demo, 0, {});
    EXPECT_LT(shareOver(demo), 0.01) << app::styleName(style) << " at rest";
    for (int frame = 0; frame < 60; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
    EXPECT_LT(shareOver(demo), 0.02) << app::styleName(style) << " in motion";
  }
}

// Every way out of the head's middle that meets it does so within 11 mm of the head; none in it.
TEST(Attachments, AHeadbandLiesAgainstTheHeadAllRound) {
  const app::Demo demo = app::openScene(wearing("headband.obj"), 1.5);
  const app::Scalp& scalp = demo.actors[0].body->character.scalp;
  for (int turn = 0; turn < 360; turn += 10) {
    int met = 0;
    for (int polar = 30; polar < 130; polar += 2) {
      const double t = turn * EIGEN_PI / 180, p = polar * EIGEN_PI / 180;
      const app::Vec3 along(std::sin(p) * std::sin(t), std::cos(p), std::sin(p) * std::cos(t));
      const double meets = app::meetsAlong(*demo.actors[0].worn[0].mesh, scalp, along, 0.04);
      if (std::isinf(meets)) continue;
      ++met;
      EXPECT_LT(meets, scalp.radiusAt(along) + 0.011) << turn << " " << polar;
      EXPECT_GT(meets, scalp.radiusAt(along) + 0.006) << turn << " " << polar;
    }
    EXPECT_GE(met, 4) << turn;
  }
}

// Strands that come out of a hat's dome: within 55 degrees of the crown.
int piercing(const app::Demo& demo) {
  const app::Actor& actor = demo.actors[0];
  const app::Scalp& scalp = actor.body->character.scalp;
  const app::Rigid to_scalp = app::scalpToWorld(actor.body->character, actor.shown_pose).inverse();
  app::StrandExport strands(demo, app::ExportWhat::kStrands, 0);
  const app::Groom& groom = strands.groom(demo, 1);
  int count = 0;
  for (std::size_t s = 0; s < groom.strandCount(); ++s) {
    bool out = false;
    for (const Eigen::Vector3f& point : groom.strand(s)) {
      const app::Vec3 p = to_scalp * point.cast<double>() - scalp.center;
      if (p.y() < std::cos(0.96) * p.norm()) continue;
      out = out || p.norm() > app::meetsAlong(*actor.worn[0].mesh, scalp, p, 0.04) + 0.0075;
    }
    count += out;
  }
  return count;
}

// A few of some 19,000 strands still do: 1 of loose hair, by 2 mm; 7 and 13 of tied hair, by up to 5 mm, as measured.
TEST(Attachments, HardlyAStrandPiercesAHatOverTiedOrLooseHair) {
  for (const char* tie : {"none", "back", "low"}) {
    app::Scene scene = wearing("sun_hat.obj");
    scene.characters[0].ties = app::tiesFromText(tie);
    app::Demo demo = app::openScene(std::move(scene), 1.5);
    app::advanceFrame(demo, 0, {});
    const std::vector<render::HairFace>& faces = demo.actors[0].haircut->faces;
    EXPECT_GT(3 * std::ranges::count_if(faces, &render::HairFace::covered), std::ssize(faces)) << tie;
    EXPECT_LE(piercing(demo), std::string(tie) == "none" ? 2 : 15) << tie;
  }
}

TEST(Attachments, ATieUnderACapGoesBelowItsRim) {
  for (const char* style : {"shoulder", "long"}) {
    app::Scene scene = wearing("beanie.obj", *app::parseStyle(style));
    scene.characters[0].ties = app::tiesFromText("back");
    app::Demo demo = app::openScene(std::move(scene), 1.5);
    EXPECT_NE(demo.message.find("mm lower, to leave the hair room under beanie"), std::string::npos) << demo.message;
    for (int frame = 0; frame < 30; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
    EXPECT_LT(deepestOf(demo), 0.003) << style;
    EXPECT_GT(demo.actors[0].haircut->tied.size(), 0.6 * demo.actors[0].haircut->mesh.columnCount());
    const app::HairTie& ring = demo.actors[0].haircut->ties.at(0);
    const std::vector<app::HairTie> asked =
        app::placeTies(app::tiesFromText("back"), demo.actors[0].body->character.scalp);
    EXPECT_LT(ring.at.y(), asked.at(0).at.y() - 0.03) << style;
  }
}

TEST(Attachments, AFringeUnderARimIsToldHowMuchRoomItNeedsAndThatIsEnough) {
  for (const char* style : {"bob", "pixie"}) {
    std::string refusal;
    try {
      app::openScene(wearing("beanie.obj", *app::parseStyle(style)), 1.5);
    } catch (const app::InputError& error) {
      refusal = error.what();
    }
    EXPECT_NE(refusal.find("a tenth wider"), std::string::npos) << refusal;
    EXPECT_NE(refusal.find("\"at\": [0, 0.02, 0]"), std::string::npos) << refusal;
    for (const char* mend : {R"({"file": "beanie.obj", "size": 1.1})", R"({"file": "beanie.obj", "at": [0, 0.02, 0]})"})
      EXPECT_NO_THROW(app::openScene(wearing(mend, *app::parseStyle(style)), 1.5)) << style << mend;
  }
}

// At 0.8 of its size a sun hat's crown is in the head and no root lies in its felt.
TEST(Attachments, AHatMostlyInsideTheHeadIsSaidWithHowMuchLargerItShouldBe) {
  const auto messageOf = [](const std::string& text) {
    return app::openScene(wearing(text, app::Style::kShort), 1.5).message;
  };
  const std::string small = messageOf(R"({"file": "sun_hat.obj", "scale": 0.8})");
  EXPECT_NE(
      small.find(
          "sun_hat: lies to 76 % inside the head; make it about 1.15 times as large (\"size\") or move it (\"at\")"),
      std::string::npos)
      << small;
  EXPECT_NE(messageOf(R"({"file": "headband.obj", "scale": 0.88})").find("inside the head"), std::string::npos);
  for (const char* file : {"beanie.obj", "headband.obj", "sun_hat.obj", "glasses.obj"})
    EXPECT_EQ(messageOf(file).find("inside the head"), std::string::npos) << file;
}

TEST(Attachments, AnExportSaysThatItLeavesThemOut) {
  const std::string folder = test::freshFolder("attachments_export");
  for (const char* file : {"/hair.glb", "/hair.ply"}) {
    std::vector<std::string> words{"--no-images", "--frames", "1",        "--resolution", "low",
                                   "--strands",   "300",      "--export", folder + file};
    EXPECT_EQ(test::runProgram(words).out.find("without what is worn"), std::string::npos);
    words.insert(words.end(), {"--attach", "beanie.obj"});
    const test::Outcome run = test::runProgram(words);
    EXPECT_NE(run.out.find("without what is worn (beanie)"), std::string::npos) << run.out << run.err;
  }
}

// An attachment in another unit. `moved`: m, y up.
std::string inUnit(const char* name, double units_per_metre, bool z_up, const sim::Vec3& moved = sim::Vec3::Zero()) {
  const std::string file = test::freshFolder("attachments_unit") + "/cap.obj";
  std::ifstream in(app::dataPath(std::string("assets/attachments/") + name));
  std::ofstream out(file);
  for (std::string line; std::getline(in, line);) {
    double x = 0, y = 0, z = 0;
    if (std::sscanf(line.c_str(), "v %lf %lf %lf", &x, &y, &z) == 3) {
      x += moved.x(), y += moved.y(), z += moved.z();
      if (z_up) std::swap(y, z), y = -y;
      out << "v " << units_per_metre * x << " " << units_per_metre * y << " " << units_per_metre * z << "\n";
    } else {
      out << line << "\n";
    }
  }
  return file;
}

std::string beanieIn(double units_per_metre, bool z_up = false) {
  return inUnit("beanie.obj", units_per_metre, z_up);
}

TEST(Attachments, UnitAndOriginAreInferredAndTold) {
  const app::Demo metres = app::openScene(wearing("beanie.obj"), 1.5);
  EXPECT_EQ(metres.message, "");
  const app::Demo centimetres = app::openScene(wearing(beanieIn(100)), 1.5);
  EXPECT_NE(centimetres.message.find("read in centimetres"), std::string::npos) << centimetres.message;
  EXPECT_NEAR(centimetres.actors[0].worn[0].mesh->part.radius, metres.actors[0].worn[0].mesh->part.radius, 1e-6);
}

// Wherever "at" puts it; and none that has y up.
TEST(Attachments, OneWithZUpIsTurned) {
  for (const char* file : {"beanie.obj", "glasses.obj", "headband.obj", "sun_hat.obj"}) {
    for (const double up : {0.0, 0.1}) {
      const std::string at = R"(", "at": [0, )" + std::to_string(up) + ", 0]}";
      const app::Demo upright = app::openScene(wearing(R"({"file": ")" + std::string(file) + at), 1.5),
                      turned = app::openScene(wearing(R"({"file": ")" + inUnit(file, 1, true) + at), 1.5);
      EXPECT_EQ(upright.message.find("turned to y"), std::string::npos) << file << " " << upright.message;
      EXPECT_NE(turned.message.find("z up, turned to y"), std::string::npos) << file << " " << turned.message;
      const auto middle = [](const app::Demo& demo) { return demo.actors[0].worn[0].mesh->part.center; };
      EXPECT_LT((middle(turned) - middle(upright)).norm(), 1e-4) << file;
    }
  }
}

// Made at the standing figure's place, in any unit and with either axis up, it lies where one about the joint does.
TEST(Attachments, UnitAxisAndOriginAreFoundTogether) {
  const app::Demo about_joint = app::openScene(wearing("sun_hat.obj"), 1.5);
  const app::Character& character = about_joint.actors[0].body->character;
  const sim::Vec3 joint =
      character.skeleton.joints[static_cast<std::size_t>(character.head_joint)].rest_world.translation();
  const auto middle = [](const app::Demo& demo) { return demo.actors[0].worn[0].mesh->part.center; };
  for (const double units : {1.0, 100.0, 1000.0}) {
    for (const bool z_up : {false, true}) {
      const std::string file = inUnit("sun_hat.obj", units, z_up, joint);
      const app::Demo found = app::openScene(wearing(file), 1.5);
      EXPECT_LT((middle(found) - middle(about_joint)).norm(), 0.03) << units << " " << z_up << " " << found.message;
      EXPECT_NE(found.message.find("about the figure's origin"), std::string::npos) << found.message;
      EXPECT_EQ(found.message.find("z up, turned to y") != std::string::npos, z_up) << found.message;
      EXPECT_EQ(found.message.find("centimetres") != std::string::npos, units == 100) << found.message;
      // What was inferred, given, changes nothing.
      const sim::Vec3 turn = found.actors[0].worn[0].mesh->turn;
      EXPECT_LT((turn - sim::Vec3(z_up ? -90 : 0, 0, 0)).norm(), 0.01);
      const std::string given = R"({"file": ")" + file + R"(", "turn": [)" + std::to_string(turn.x()) + ", 0, 0]}";
      EXPECT_LT((middle(app::openScene(wearing(given), 1.5)) - middle(found)).norm(), 1e-4);
    }
  }
}

// A hat modelled about its rim comes to lie where one modelled about the joint does, y up or z up.
TEST(Attachments, AHatAboutItsRimIsSetOnTheHead) {
  const app::Demo fitted = app::openScene(wearing("sun_hat.obj"), 1.5);
  for (const bool z_up : {false, true}) {
    const std::string file = inUnit("sun_hat.obj", 1, z_up, sim::Vec3(0, -0.084, 0));
    const app::Demo set = app::openScene(wearing(file), 1.5);
    EXPECT_NE(set.message.find("set on the head"), std::string::npos) << set.message;
    const auto middle = [](const app::Demo& demo) { return demo.actors[0].worn[0].mesh->part.center; };
    EXPECT_LT((middle(set) - middle(fitted)).norm(), 0.03);
    // What was inferred, given, changes nothing: the panel moves it on from there.
    const sim::Vec3 at = set.actors[0].worn[0].mesh->at;
    const std::string given = R"({"file": ")" + file + R"(", "at": [)" + std::to_string(at.x()) + ", " +
                              std::to_string(at.y()) + ", " + std::to_string(at.z()) + "]}";
    EXPECT_LT((middle(app::openScene(wearing(given), 1.5)) - middle(set)).norm(), 1e-4);
  }
}

TEST(Attachments, OneInInchesOrFarOffIsSaidToBeNowhereToBeSeen) {
  const app::Demo inches = app::openScene(wearing(beanieIn(1 / 0.0254)), 1.5);
  EXPECT_NE(inches.message.find("lies wholly inside the head; make it larger (\"scale\""), std::string::npos)
      << inches.message;
  const app::Demo lying = app::openScene(wearing(R"({"file": "beanie.obj", "turn": [90, 0, 0]})"), 1.5);
  EXPECT_NE(lying.message.find("turn it by -90 degrees about x (\"turn\": [-90, 0, 0])"), std::string::npos)
      << lying.message;
  const app::Demo far = app::openScene(wearing(R"({"file": "beanie.obj", "at": [0, 3, 0]})"), 1.5);
  EXPECT_NE(far.message.find("from its joint; look at its size and place (\"size\", \"at\")"), std::string::npos)
      << far.message;
}

TEST(Attachments, AreDroppedUndoneAndTakenOff) {
  app::Demo demo = app::openScene(wearing("none"), 1.5);
  const std::string bare = app::stateHash(demo), hat = app::dataPath("assets/attachments/beanie.obj");
  EXPECT_EQ(app::fileKind(hat), app::FileKind::kAttachment);
  EXPECT_EQ(app::fileKind(app::dataPath("assets/hair/bob_example.obj")), app::FileKind::kHairMesh);
  demo.requests = {{Ask::kOpenFile, "", hat}};
  app::advanceFrame(demo, 0, {});
  ASSERT_FALSE(demo.message_is_fault) << demo.message;
  ASSERT_EQ(demo.actors[0].worn.size(), 1u);
  EXPECT_EQ(app::frameInput(demo, 64, 64).bodies.size(), 2u);
  demo.requests = {{Ask::kAttach, "add", "glasses.obj"}};
  app::advanceFrame(demo, 0, {});
  EXPECT_EQ(demo.actors[0].worn.size(), 2u) << demo.message;
  const std::string both = app::stateHash(demo);
  demo.requests = {{Ask::kAttach, "add", box("solid2", sim::Vec3(-0.2, -0.1, -0.2), sim::Vec3(0.2, 0.3, 0.2))}};
  app::advanceFrame(demo, 0, {});
  EXPECT_TRUE(demo.message_is_fault);
  EXPECT_EQ(app::stateHash(demo), both) << "what was there stays";
  demo.requests = {{Ask::kUndo, "", "", 2}};
  app::advanceFrame(demo, 0, {});
  EXPECT_EQ(app::stateHash(demo), bare);
  demo.requests = {{Ask::kRedo, "", "", 1}};
  app::advanceFrame(demo, 0, {});
  EXPECT_EQ(demo.actors[0].worn.size(), 1u);
  demo.requests = {{Ask::kAttach, "", "none"}};
  app::advanceFrame(demo, 0, {});
  EXPECT_TRUE(demo.actors[0].worn.empty());
}

TEST(Attachments, ASceneKeepsThemAndATakeReplaysThemToTheBit) {
  const app::Scene scene = wearing(R"([{"file": "beanie.obj", "at": [0, 0.01, 0], "turn": [5, 0, 0]}])");
  const app::Scene back = app::readScene(app::writeScene(scene), "scene.json");
  EXPECT_EQ(app::wornText(back.characters[0].attachments), app::wornText(scene.characters[0].attachments));
  const std::string take = test::freshFolder("attachments_take") + "/take";
  const std::string scene_file = app::dataPath("assets/scenes/beanie.json");
  const test::Outcome record =
      test::runProgram({"--headless", "--no-images", "--frames", "20", scene_file, "--record", take});
  EXPECT_EQ(record.exit_code, 0) << record.err;
  const test::Outcome replay = test::runProgram({"--headless", "--no-images", "--replay", take});
  EXPECT_NE((replay.out + replay.err).find("to the bit"), std::string::npos) << replay.out << replay.err;
}

}  // namespace attachments_test

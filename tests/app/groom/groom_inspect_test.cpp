// The inspector: grooms with one seeded defect each, over all formats; every defect is named, and its mend brings the
// groom back.
#include "app/groom/inspect/groom_inspect.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <map>
#include <numbers>

#include "app/groom/groom_file.h"
#include "app/groom/groom_writer.h"
#include "app/groom/inspect/certain_mends.h"
#include "tests/app/groom/combed_groom.h"
#include "tests/app/groom/groom_samples.h"
#include "tests/run_program.h"

namespace groom_inspect_test {

using namespace combed;

// One defect: what the inspector is to name, and how it is planted.
struct Defect {
  const char* what;
  void (*plant)(Random&, app::Groom&);
};

std::span<Vector3f> pick(Random& random, app::Groom& groom) {
  const std::size_t s = random.engine() % groom.strandCount();
  return std::span(groom.points).subspan(groom.strand_first[s], groom.pointCount(s));
}

std::vector<Defect> defects() {
  return {
      {"unit",
       [](Random& random, app::Groom& groom) {
         const float scale = std::array{100.0f, 1000.0f, 39.37f, 3.281f}[random.engine() % 4];
         moveAll(groom, Eigen::Matrix3f::Identity(), scale, Vector3f::Zero());
         for (float& width : groom.widths) width *= scale;
       }},
      {"up",
       [](Random& random, app::Groom& groom) {
         moveAll(groom, turnOf(std::array{"z", "-y", "-z", "x", "-x"}[random.engine() % 5]), 1, Vector3f::Zero());
       }},
      {"facing",
       [](Random& random, app::Groom& groom) {
         moveAll(groom, app::turnedAbout(std::array{180.0, 90.0, -90.0}[random.engine() % 3]), 1, Vector3f::Zero());
       }},
      {"reversed",
       [](Random&, app::Groom& groom) {
         for (std::size_t s = 0; s < groom.strandCount(); ++s)
           std::reverse(groom.points.begin() + groom.strand_first[s], groom.points.begin() + groom.strand_first[s + 1]);
       }},
      {"reversed",
       [](Random& random, app::Groom& groom) {
         for (int n = 0; n < 20; ++n) std::ranges::reverse(pick(random, groom));
       }},
      {"widths",
       [](Random& random, app::Groom& groom) {
         const float scale = std::array{100.0f, 1000.0f, 0.01f, 0.001f}[random.engine() % 4];
         for (float& width : groom.widths) width *= scale;
       }},
      {"roots",
       [](Random& random, app::Groom& groom) {
         const Vector3f away(random.between(-0.1f, 0.1f), random.between(0.1f, 1.6f), random.between(-0.2f, 0.2f));
         moveAll(groom, Eigen::Matrix3f::Identity(), 1, away);
       }},
      {"roots",
       [](Random& random, app::Groom& groom) {
         for (int n = 0; n < 10; ++n) {
           const Vector3f away = Vector3f(random.between(-1, 1), random.unit(), -random.unit()).normalized();
           for (Vector3f& point : pick(random, groom)) point += 0.12f * away;
         }
       }},
      {"body",
       [](Random& random, app::Groom& groom) {
         for (int n = 0; n < 30; ++n) {
           const std::span<Vector3f> points = pick(random, groom);
           const float share = random.between(0.5f, 0.8f);
           for (Vector3f& point : points.subspan(3)) point += share * (head().center - point);
         }
       }},
      {"zero-length",
       [](Random& random, app::Groom& groom) {
         for (int n = 0; n < 3; ++n) {
           const std::span<Vector3f> points = pick(random, groom);
           std::ranges::fill(points, points[0]);
         }
       }},
      {"non-finite",
       [](Random& random, app::Groom& groom) {
         const float bad = random.engine() % 2 ? NAN : HUGE_VALF;
         for (int n = 0; n < 3; ++n) pick(random, groom)[random.engine() % 8][random.engine() % 3] = bad;
       }},
  };
}

app::GroomInspection inspected(const app::Groom& groom, const std::string& file) {
  app::writeGroom(groom, file);
  app::GroomHints hints;
  const app::Groom read = app::readGroom(file, &hints);
  const app::HeadModel model = head();
  return app::inspectGroom(read, hints, &model);
}

const std::vector<std::string> kFormats{"abc", "usda", "hair", "ply", "tfx"};

TEST(GroomInspect, SaysNothingOfAGroomThatFits) {
  const std::string folder = test::freshFolder("inspect_fits");
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const std::string file = folder + "/fits." + kFormats[seed % 5];
    EXPECT_EQ(namesOf(inspected(combedGroom(300, seed), file)), "") << seed;
  }
}

// A unit that is asked for is taken, and told where it cannot be right.
TEST(GroomInspect, AForcedUnitThatMakesADollIsTold) {
  const app::HeadModel model = head();
  app::GroomHints hints;
  hints.unit_given = true;
  hints.meters_per_unit = 1;
  EXPECT_EQ(namesOf(app::inspectGroom(combedGroom(300, 7), hints, &model)).find("unit: "), std::string::npos);
  hints.meters_per_unit = 0.1;
  const app::GroomInspection doll = app::inspectGroom(combedGroom(300, 7), hints, &model);
  ASSERT_TRUE(doll.find("unit"));
  EXPECT_EQ(doll.find("unit")->mend, "--unit m");
  EXPECT_EQ(doll.findings.size(), 1u) << namesOf(doll);
}

constexpr float kFeet = 1 / 0.3048f;  // in a metre

// What follows a unit that is wrong is judged in the right one, and left alone.
TEST(GroomInspect, WhatFollowsAWrongUnitIsJudgedInTheRightOne) {
  const app::HeadModel model = head();
  app::GroomHints hints;
  hints.meters_per_unit = 1;  // of feet
  app::Groom groom = combedGroom(300, 5);
  for (float& width : groom.widths) width *= kFeet;
  moveAll(groom, Eigen::Matrix3f::Identity(), kFeet, Vector3f::Zero());
  const app::GroomInspection unit_alone = app::inspectGroom(groom, hints, &model);
  EXPECT_EQ(unit_alone.findings.size(), 1u) << namesOf(unit_alone);
  moveAll(groom, Eigen::Matrix3f::Identity(), 1, Vector3f(0, 0.5f * kFeet, 0));
  for (float& width : groom.widths) width *= 1000;
  const app::GroomInspection all = app::inspectGroom(groom, hints, &model);
  for (const char* what : {"widths", "roots"}) {
    const app::GroomFinding* const finding = all.find(what);
    ASSERT_TRUE(finding) << what << ": " << namesOf(all);
    EXPECT_EQ(finding->text.find("with --unit ft, "), 0u) << finding->text;
    EXPECT_FALSE(finding->certain) << "the unit comes first";
  }
  EXPECT_NE(all.find("roots")->text.find("0.4"), std::string::npos) << all.find("roots")->text;
  EXPECT_EQ(all.mends.unit, 1);
  EXPECT_EQ(all.mends.width_scale, 1);
  EXPECT_EQ(all.mends.move, Vector3f::Zero().eval());
}

// Hair that lies on the head of the figure as it stands in its world has no fault; a mend brings it to the head's own.
TEST(GroomInspect, HairOnTheHeadOfTheStandingFigureIsNoFault) {
  app::HeadModel model = head();
  app::Groom groom = combedGroom(300, 5);
  moveAll(groom, Eigen::Matrix3f::Identity(), 1, Vector3f(0, 1.4f, -0.02f));
  const app::GroomInspection nowhere = app::inspectGroom(groom, {}, &model);
  ASSERT_TRUE(nowhere.find("roots"));
  EXPECT_TRUE(nowhere.find("roots")->fault);
  model.standing = model.center + Vector3f(0.05f, 1.45f, 0);
  const app::GroomInspection inspection = app::inspectGroom(groom, {}, &model);
  ASSERT_TRUE(inspection.find("roots"));
  EXPECT_TRUE(std::ranges::none_of(inspection.findings, &app::GroomFinding::fault)) << namesOf(inspection);
  EXPECT_TRUE(inspection.find("roots")->certain && inspection.on_head);
  EXPECT_LT((inspection.mends.move + Vector3f(0, 1.4f, -0.02f)).norm(), 0.01f);
}

TEST(GroomInspect, AnExportOfAHalfBaldHeadIsNotTurned) {
  const app::HeadModel model = head();
  app::GroomHints hints;
  hints.meters_per_unit = 1;
  hints.world_heads = 1;
  for (const float side : {-1.0f, 1.0f}) {
    const app::Groom whole = combedGroom(300, 7);
    app::Groom groom;
    for (std::size_t s = 0; s < whole.strandCount(); ++s) {
      const auto strand = whole.strand(s);
      if (side * strand[0].x() < 0) continue;
      groom.points.insert(groom.points.end(), strand.begin(), strand.end());
      groom.strand_first.push_back(static_cast<std::uint32_t>(groom.points.size()));
    }
    ASSERT_GT(groom.strandCount(), 100u);
    EXPECT_EQ(namesOf(app::inspectGroom(groom, hints, &model)), "");
  }
}

TEST(GroomInspect, NamesEveryOfTwoHundredAndSeventyFiveSeededDefects) {
  const std::string folder = test::freshFolder("inspect_defects");
  std::map<std::string, int> planted, named;
  std::uint32_t seed = 100;
  for (const Defect& defect : defects()) {
    for (const std::string& format : kFormats) {
      for (int n = 0; n < 5; ++n) {
        Random random{std::mt19937(++seed)};
        app::Groom groom = combedGroom(300, seed);
        defect.plant(random, groom);
        const app::GroomInspection inspection = inspected(groom, folder + "/bad." + format);
        const app::GroomFinding* finding = inspection.find(defect.what);
        ++planted[defect.what];
        named[defect.what] += finding != nullptr;
        EXPECT_TRUE(finding) << defect.what << " in " << format << ", seed " << seed << ": " << namesOf(inspection);
        EXPECT_TRUE(!finding || finding->mend.starts_with("--"));
      }
    }
  }
  int all = 0;
  for (const auto& [what, count] : planted) all += count;
  EXPECT_GE(all, 200);
  EXPECT_EQ(named, planted);
}

// What a file tells of its axis is taken, and what its hair says otherwise is named.
TEST(GroomInspect, ADeclaredAxisIsTakenAndAWrongOneNamed) {
  const app::HeadModel model = head();
  const app::Groom clean = combedGroom(300, 7);
  for (const bool z_up : {false, true}) {
    app::Groom groom = clean;
    if (z_up) moveAll(groom, turnOf("z"), 1, Vector3f::Zero());
    for (const char declared : {'Y', 'Z'}) {
      app::GroomHints hints;
      hints.up = declared;
      const bool right = z_up == (declared == 'Z');
      const app::GroomInspection inspection = app::inspectGroom(groom, hints, &model);
      EXPECT_EQ(inspection.mends.axes, app::toldAxes(hints));
      ASSERT_EQ(inspection.find("up") == nullptr, right) << namesOf(inspection);
      if (!right) {
        EXPECT_EQ(inspection.find("up")->mend, z_up ? "--up z" : "--up y");
        EXPECT_TRUE(inspection.find("up")->fault);
        EXPECT_FALSE(inspection.find("up")->certain);
        EXPECT_EQ(test::lacking(inspection.find("up")->text, declared == 'Z' ? "tells z" : "tells y"), "");
        // Nor is what follows from the axis.
        EXPECT_EQ(inspection.mends.move, Vector3f(Vector3f::Zero()));
        EXPECT_EQ(inspection.mends.scale, 1);
        continue;
      }
      EXPECT_EQ(namesOf(inspection), "");
      for (const char* wishes : {"", "--no-guess"}) {
        app::Groom mended = groom;
        app::mendCertain(hints, &model, wishes, mended);
        EXPECT_LT((mended.points.back() - clean.points.back()).norm(), 1e-6f) << declared << wishes;
      }
      app::Groom turned = groom;
      app::mendCertain(hints, nullptr, "--no-guess --up x", turned);
      EXPECT_EQ(turned.points.back(), Vector3f(*app::axesOfUp("x") * groom.points.back())) << "a wish overrules it";
    }
  }
}

// A beard on the lower front of a ball of 9.2 cm, fur all over it, fur of a flat piece of 20 cm: y up, metres.
app::Groom otherHair(int kind) {
  Random random{std::mt19937(static_cast<std::uint32_t>(kind))};
  app::Groom groom;
  while (groom.strandCount() < 1500) {
    const Vector3f way = Vector3f(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)).normalized();
    if (kind == 0 && !(way.y() < -0.1f && way.z() > 0.2f)) continue;
    const Vector3f flat(random.between(-0.1f, 0.1f), 0, random.between(-0.1f, 0.1f));
    const Vector3f root = kind == 2 ? flat : Vector3f(0.092f * way);
    const Vector3f out = kind == 2 ? Vector3f(0.3f, 1, 0.5f) : way;
    for (int p = 0; p < 6; ++p) {
      const auto along = static_cast<float>(p);
      groom.points.push_back(root + 0.004f * along * out + Vector3f(0, -0.002f * along * along, 0));
    }
    groom.strand_first.push_back(static_cast<std::uint32_t>(groom.points.size()));
  }
  return groom;
}

TEST(GroomInspect, HairOfNoScalpIsNotTurnedOrScaled) {
  const app::HeadModel model = head();
  for (int kind = 0; kind < 3; ++kind) {
    for (const char* up : {"", "y", "z"}) {
      app::GroomHints hints;
      app::Groom groom = otherHair(kind);
      if (*up == 'z') moveAll(groom, turnOf("z"), 1, Vector3f::Zero());
      if (*up != 0) hints.up = *up == 'z' ? 'Z' : 'Y', hints.meters_per_unit = 0.01;
      if (*up != 0) moveAll(groom, Eigen::Matrix3f::Identity(), 100, Vector3f::Zero());
      const app::GroomInspection inspection = app::inspectGroom(groom, hints, &model);
      EXPECT_EQ(inspection.mends.axes, app::toldAxes(hints)) << kind << up << namesOf(inspection);
      EXPECT_EQ(inspection.mends.unit, hints.meters_per_unit.value_or(1)) << kind << up << namesOf(inspection);
      for (const char* what : {"unit", "up", "facing", "reversed"}) {
        const app::GroomFinding* const finding = inspection.find(what);
        EXPECT_TRUE(!finding || !(finding->certain || finding->fault)) << kind << up << namesOf(inspection);
      }
    }
  }
}

// Hair that contradicts the unit that its file tells is named, and the unit stays.
TEST(GroomInspect, AUnitThatTheFileTellsHoldsUntilItIsOverruled) {
  const app::HeadModel model = head();
  app::GroomHints hints;
  hints.meters_per_unit = 1;
  app::Groom groom = combedGroom(300, 5);
  moveAll(groom, Eigen::Matrix3f::Identity(), kFeet, Vector3f::Zero());
  const app::GroomInspection inspection = app::inspectGroom(groom, hints, &model);
  ASSERT_TRUE(inspection.find("unit"));
  EXPECT_EQ(inspection.find("unit")->mend, "--unit ft");
  EXPECT_TRUE(inspection.find("unit")->fault && !inspection.find("unit")->certain);
  EXPECT_EQ(inspection.mends.unit, 1);
}

// A skull of 9 m or of 0.9 mm is nobody's.
TEST(GroomInspect, AToldUnitOfAGiantOrADwarfIsMendedByItself) {
  const app::HeadModel model = head();
  for (const auto& [told, scale] : {std::pair(1.0, 100.0f), std::pair(0.01, 1.0f)}) {
    app::GroomHints hints;
    hints.meters_per_unit = told;
    app::Groom groom = combedGroom(300, 5);
    moveAll(groom, Eigen::Matrix3f::Identity(), scale, Vector3f::Zero());
    for (float& width : groom.widths) width *= scale;
    EXPECT_EQ(namesOf(app::inspectGroom(groom, hints, &model)).find("unit: "), 0u);
    app::Groom kept = groom;
    EXPECT_EQ(app::mendCertain(hints, &model, "--no-guess", kept).unit, told);
    const app::MendReport report = app::mendCertain(hints, &model, "", groom);
    EXPECT_NEAR(report.unit, 1 / scale, 1e-9);
    EXPECT_TRUE(report.on_head);
    EXPECT_EQ(test::lacking(app::mendText(report), "mended        unit: "), "");
    EXPECT_EQ(test::lacking(app::mendText(report), "; the file tells"), "");
  }
}

// What is certain is mended: then nothing more is said, and strands lie where they lay.
TEST(GroomInspect, CertainMendsBringTheGroomBack) {
  const app::HeadModel model = head();
  std::uint32_t seed = 1000;
  for (const Defect& defect : defects()) {
    for (int n = 0; n < 6; ++n) {
      Random random{std::mt19937(++seed)};
      const app::Groom whole = combedGroom(300, seed);
      app::Groom groom = whole;
      defect.plant(random, groom);
      const app::GroomInspection inspection = app::inspectGroom(groom, {}, &model);
      const app::GroomFinding* finding = inspection.find(defect.what);
      ASSERT_TRUE(finding) << defect.what;
      if (!finding->certain) continue;
      app::mendGroom(inspection.mends, &model, groom);
      EXPECT_EQ(namesOf(app::inspectGroom(groom, {}, &model)), "") << defect.what << " seed " << seed;
      if (groom.points.size() != whole.points.size()) continue;  // bad strands are gone
      float off = 0;
      for (std::size_t p = 0; p < whole.points.size(); ++p)
        off += (groom.points[p] - whole.points[p]).norm() / static_cast<float>(whole.points.size());
      EXPECT_LT(off, 0.006f) << defect.what << " seed " << seed;
    }
  }
}

TEST(GroomInspect, OtherMendsDoWhatTheyAreAskedFor) {
  const app::HeadModel model = head();
  app::Groom groom = combedGroom(200, 7);
  groom.points[3] += 0.9f * (model.center - groom.points[3]);
  groom.widths[5] = 0;
  app::GroomMends mends;
  mends.points = 16;
  mends.push_out = true;
  mends.width = 1e-4f;
  app::mendGroom(mends, &model, groom);
  EXPECT_EQ(groom.points.size(), 200u * 16);
  EXPECT_EQ(groom.widths.size(), 200u * 16);
  for (const Vector3f& point : groom.points) EXPECT_GT(model.distance(point), -1e-4f);
  for (const float width : groom.widths) EXPECT_GT(width, 0);
  mends = {};
  mends.drop_far = 0.03f;
  for (Vector3f& point : std::span(groom.points).first(16)) point.y() += 0.5f;
  app::mendGroom(mends, &model, groom);
  EXPECT_EQ(groom.strandCount(), 199u);
}

TEST(GroomInspect, AxesAreTurnsThatBringUpToY) {
  const std::map<std::string, Vector3f> ups{{"y", Vector3f::UnitY()},   {"z", Vector3f::UnitZ()},
                                            {"-y", -Vector3f::UnitY()}, {"-z", -Vector3f::UnitZ()},
                                            {"x", Vector3f::UnitX()},   {"-x", -Vector3f::UnitX()}};
  for (const auto& [name, up] : ups) {
    const Eigen::Matrix3f axes = *app::axesOfUp(name);
    EXPECT_EQ(Vector3f(axes * up), Vector3f::UnitY()) << name;
    EXPECT_NEAR(axes.determinant(), 1, 1e-6f) << name << " is a mirror";
  }
  EXPECT_EQ(Vector3f(*app::axesOfUp("z") * -Vector3f::UnitY()), Vector3f::UnitZ()) << "z up faces -y";
  EXPECT_EQ(Vector3f(app::turnedAbout(90) * Vector3f::UnitZ()), Vector3f::UnitX());
  EXPECT_FALSE(app::axesOfUp("w"));
}

// Every second, third and fifth strand runs the other way; of 3,000 strands not all are looked at.
TEST(GroomInspect, JudgesTheDirectionOfEachStrand) {
  const app::HeadModel model = head();
  for (const std::size_t strands : {300, 3000}) {
    for (const std::size_t every : {2, 3, 5, 10}) {
      const app::Groom whole = combedGroom(strands, static_cast<std::uint32_t>(40 + every));
      app::Groom groom = whole;
      for (std::size_t s = 0; s < strands; s += every)
        std::reverse(groom.points.begin() + groom.strand_first[s], groom.points.begin() + groom.strand_first[s + 1]);
      const app::GroomInspection inspection = app::inspectGroom(groom, {}, &model);
      ASSERT_TRUE(inspection.find("reversed")) << every;
      EXPECT_TRUE(inspection.find("reversed")->certain) << every;
      EXPECT_EQ(inspection.findings.size(), 1u) << every << ": " << namesOf(inspection);
      app::mendGroom(inspection.mends, &model, groom);
      std::size_t wrong = 0;
      for (std::size_t s = 0; s < strands; ++s) wrong += groom.strand(s).front() != whole.strand(s).front();
      EXPECT_EQ(wrong, 0u) << every << " of " << strands;
    }
  }
}

// Ends that lie about no skull say nothing for certain.
TEST(GroomInspect, IsNotCertainOfDirectionsWithoutASkull) {
  Random random{std::mt19937(9)};
  app::Groom groom;
  for (int s = 0; s < 300; ++s) {
    for (int end = 0; end < 2; ++end)
      groom.points.emplace_back(random.between(-0.2f, 0.2f), random.between(-0.2f, 0.2f), random.between(-0.2f, 0.2f));
    groom.strand_first.push_back(static_cast<std::uint32_t>(groom.points.size()));
  }
  const app::GroomInspection inspection = app::inspectGroom(groom, {}, nullptr);
  EXPECT_TRUE(!inspection.find("reversed") || !inspection.find("reversed")->certain);
  EXPECT_EQ(inspection.mends.reverse, app::Reverse::kNone);
}

// The program: what it says, what it writes, and how it ends.
TEST(GroomInspect, TheProgramMendsWhatIsCertain) {
  const std::string folder = test::freshFolder("inspect_program");
  app::Groom groom = combedGroom(300, 5);
  moveAll(groom, turnOf("z"), 100, Vector3f::Zero());
  for (float& width : groom.widths) width *= 100;
  app::writeGroom(groom, folder + "/z_cm.hair");
  const std::string binary = std::filesystem::path(HAIRMESH_BINARY).parent_path().string() + "/hairmesh-inspect";
  const auto run = [&](const std::string& arguments) {
    const std::string command = test::shellQuoted(binary) + " " + arguments + " >" +
                                test::shellQuoted(folder + "/out") + " 2>" + test::shellQuoted(folder + "/err");
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  };
  const std::string in = test::shellQuoted(folder + "/z_cm.hair"), out = test::shellQuoted(folder + "/mended.abc");
  EXPECT_EQ(run(in + " --out " + out), 0) << test::readAll(folder + "/err");
  EXPECT_EQ(test::lacking(test::readAll(folder + "/out"), "--unit cm (certain)"), "");
  EXPECT_EQ(test::lacking(test::readAll(folder + "/out"), "--up z (certain)"), "");
  EXPECT_EQ(run(out), 0);
  EXPECT_EQ(run(in + " --strict"), 1);
  EXPECT_EQ(run(out + " --push-out --strict --out " + test::shellQuoted(folder + "/pushed.abc")), 1);
  EXPECT_EQ(run(test::shellQuoted(folder + "/pushed.abc") + " --strict"), 0);
  EXPECT_NE(test::lacking(test::readAll(folder + "/out"), "unit: "), "") << "the unit is mended";
  EXPECT_EQ(run(test::shellQuoted(folder + "/none.hair")), 4);
  EXPECT_EQ(run(in + " --unit furlong"), 2);
  const std::string err = test::shellQuoted(folder + "/err"), to_full = " >/dev/full 2>" + err;
  EXPECT_NE(std::system((test::shellQuoted(binary) + " " + in + to_full).c_str()), 0);
  EXPECT_EQ(test::lacking(test::readAll(folder + "/err"), "standard output: cannot be written"), "");
  EXPECT_EQ(run(in + " --out " + test::shellQuoted(folder + "/none/a.abc")), 1);
  EXPECT_EQ(run(in + " --out a.xyz"), 2);
  EXPECT_EQ(test::lacking(test::readAll(folder + "/err"), "--out cannot be 'a.xyz'; name it .abc, .usda"), "");
  EXPECT_EQ(run(in + " --move 1,2"), 2);
  EXPECT_EQ(test::lacking(test::readAll(folder + "/err"), "--move needs 3 values; write --move X,Y,Z"), "");
  EXPECT_EQ(run(in + " --unti cm"), 2);
  EXPECT_EQ(test::lacking(test::readAll(folder + "/err"), "no option '--unti'; did you mean '--unit'?"), "");
}

// Few strands are exported as wide as they are drawn.
TEST(GroomInspect, WidthsOfAnExportOfFewStrandsAreNoFault) {
  const app::HeadModel model = head();
  app::GroomHints hints;
  hints.meters_per_unit = 1;
  app::Groom groom = combedGroom(47, 5);
  for (float& width : groom.widths) width = 6.69e-3f;
  for (const int heads : {0, 1}) {
    hints.world_heads = heads;
    const app::GroomInspection inspection = app::inspectGroom(groom, hints, &model);
    ASSERT_TRUE(inspection.find("widths"));
    EXPECT_EQ(inspection.find("widths")->fault, heads == 0);
    EXPECT_EQ(inspection.find("widths")->certain, heads == 0);
    EXPECT_EQ(inspection.mends.width_scale == 1, heads == 1);
  }
}

TEST(GroomInspect, SaysThatAHandfulOfStrandsIsTooFew) {
  const app::HeadModel model = head();
  EXPECT_NE(app::inspectGroom(combedGroom(5, 1), {}, &model).find("strands"), nullptr);
  EXPECT_EQ(app::inspectGroom(combedGroom(50, 1), {}, &model).find("strands"), nullptr);
}

}  // namespace groom_inspect_test

// hairmesh-inspect: what is wrong with a groom, and what mends it.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/figure/head_model.h"
#include "app/figure/strip_inspect.h"
#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/files/file_kind.h"
#include "app/files/length_units.h"
#include "app/files/output_file.h"
#include "app/files/polygon_file.h"
#include "app/files/report_line.h"
#include "app/files/text_file.h"
#include "app/files/text_scanner.h"
#include "app/groom/formats/groom_bytes.h"
#include "app/groom/formats/tfx_file.h"
#include "app/groom/groom_file.h"
#include "app/groom/groom_writer.h"
#include "app/groom/inspect/groom_inspect.h"
#include "app/options.h"
#include "app/parse_fault.h"
#include "app/run_main.h"

namespace {

constexpr const char* kAbout =
    "Says what is wrong with a groom and which option mends it: curves (.abc, .usda, .hair, .ply, .tfx), or strips, "
    "cards "
    "and tubes (.obj, .fbx, .glb, .gltf, .vrm; mends are options of hairmesh-convert), a hair mesh or a body. What is "
    "certain is mended by itself in what --out writes, and by hairmesh-convert; options overrule it.";

constexpr double kLeastFactor = 1e-6, kMostFactor = 1e6;
constexpr double kFarthest = 1e7;  // m
constexpr std::string_view kOfPolygons[] = {"--figure", "--unit", "--up", "--strict", "--flip-strips", "--drop-strips"};

double metresOf(const std::string& unit) {
  return std::ranges::find(app::kLengthUnits, unit, &app::LengthUnit::name)->metres;
}

struct Asked {
  std::string file, out, figure = "idle_turns.bvh";
  std::string unit, up, reverse;
  std::optional<double> turn;
  std::vector<float> move;
  std::vector<int> flipped, dropped;
  app::GroomMends mends;
  bool no_guess = false, strict = false;
};

void addOptions(CLI::App& parser, Asked& asked) {
  parser.add_option("FILE", asked.file, "The groom")->required();
  parser.add_option("--out", asked.out, "Write the mended groom: .abc, .usda, .hair, .ply or .tfx; metres, y up");
  parser.add_option("--figure", asked.figure, "Motion or model whose head the hair is held against (a mannequin's)");
  parser.add_option("--unit", asked.unit, "Unit of the file: m, cm, mm, in or ft")
      ->check(CLI::IsMember({"m", "cm", "mm", "in", "ft"}));
  parser.add_option("--up", asked.up, "Axis that is up in the file: y, z, -y, -z, x or -x")
      ->check(CLI::IsMember({"y", "z", "-y", "-z", "x", "-x"}));
  parser.add_option("--turn", asked.turn, "Degrees about y, after --up: 180 for hair that faces backwards")
      ->check(app::within(-360, 360));
  parser.add_option("--reverse", asked.reverse, "Strands that run from tip to root: none, found or all")
      ->check(CLI::IsMember({"none", "found", "all"}));
  parser.add_option("--width-scale", asked.mends.width_scale, "Factor of the widths, beside the unit")
      ->check(app::within(kLeastFactor, kMostFactor));
  parser.add_option("--width", asked.mends.width, "Width, m, in place of those that are 0, negative or no number")
      ->check(app::within(1e-7, 1));
  parser.add_option("--points", asked.mends.points, "Points a strand, evenly along it")->check(CLI::Range(2, 1024));
  parser.add_option("--scale", asked.mends.scale, "Factor of the points, for hair of another head; widths stay")
      ->check(app::within(kLeastFactor, kMostFactor));
  parser.add_option("--move", asked.move, "Shift, m")
      ->delimiter(',')
      ->expected(3)
      ->check(app::within(-kFarthest, kFarthest))
      ->option_text("X,Y,Z");
  parser.add_option("--drop-far", asked.mends.drop_far, "Leave out strands whose root is further from the body, m")
      ->check(app::within(0, kFarthest));
  parser.add_flag("--drop-bad", asked.mends.drop_bad, "Leave out strands that are not finite or have no length");
  parser.add_flag("--drop-astray", asked.mends.drop_astray,
                  "Leave out strands that lie apart from all others, or have a point that does");
  parser.add_flag("--push-out", asked.mends.push_out, "Bring points that lie inside the body to its surface");
  parser
      .add_option("--flip-strips", asked.flipped, "Of strips and tubes, the numbers of those rooted at the other end")
      ->delimiter(',');
  parser.add_option("--drop-strips", asked.dropped, "Of strips and tubes, the numbers of those that are left out")
      ->delimiter(',');
  parser.add_flag("--no-guess", asked.no_guess, "Mend only what the options say");
  parser.add_flag("--strict", asked.strict, "Exit code 1 where the file has a fault, for scripts");
}

// What was found for certain, with what was asked for in its place.
app::GroomMends mendsOf(const CLI::App& parser, const Asked& asked, const app::GroomHints& hints,
                        const app::GroomMends& found) {
  app::GroomMends mends = asked.no_guess ? app::GroomMends() : found;
  if (asked.no_guess) {
    mends.unit = asked.unit.empty() ? hints.meters_per_unit.value_or(1) : metresOf(asked.unit);
    mends.axes = asked.up.empty() ? app::toldAxes(hints) : *app::axesOfUp(asked.up);
    if (asked.turn) mends.axes = app::turnedAbout(*asked.turn) * mends.axes;
  }
  if (asked.reverse == "none") mends.reverse = app::Reverse::kNone;
  if (asked.reverse == "found") mends.reverse = app::Reverse::kFound;
  if (asked.reverse == "all") mends.reverse = app::Reverse::kAll;
  if (parser.count("--width-scale") > 0) mends.width_scale = asked.mends.width_scale;
  if (parser.count("--scale") > 0) mends.scale = asked.mends.scale;
  if (!asked.move.empty()) mends.move = Eigen::Vector3f(asked.move[0], asked.move[1], asked.move[2]);
  mends.width = asked.mends.width;
  mends.points = asked.mends.points;
  mends.drop_far = asked.mends.drop_far;
  mends.drop_bad = mends.drop_bad || asked.mends.drop_bad;
  mends.drop_astray = mends.drop_astray || asked.mends.drop_astray;
  mends.push_out = asked.mends.push_out;
  return mends;
}

// What of the certain mends was done without being asked for, as options.
std::string mendedByItself(const CLI::App& parser, const Asked& asked, const app::GroomInspection& inspection) {
  std::string mended;
  for (const app::GroomFinding& finding : inspection.findings) {
    const std::string option = finding.mend.substr(0, finding.mend.find(' '));
    const bool done = finding.certain && option.starts_with("--") && !asked.no_guess && parser.count(option) == 0;
    if (done && (mended + " ").find(finding.mend + " ") == std::string::npos)
      mended += (mended.empty() ? "" : " ") + finding.mend;
  }
  return mended;
}

void checkOutput(const Asked& asked) {
  if (asked.out.empty()) return;
  std::error_code ignored;
  if (!app::isGroomOutput(asked.out))
    throw app::UsageError("--out cannot be '" + asked.out + "'; name it .abc, .usda, .hair, .ply or .tfx");
  if (std::filesystem::equivalent(asked.file, asked.out, ignored))
    throw app::UsageError("--out cannot be '" + asked.out + "', which is read as well; choose another name");
}

int tell(const Asked& asked, const app::GroomInspection& inspection) {
  std::cout << asked.file << ": " << inspection.summary << "\n";
  for (const app::GroomFinding& finding : inspection.findings)
    std::cout << (finding.fault ? "" : "no fault: ") << finding.what << ": " << finding.text
              << (finding.mend.empty() ? "" : "; ") << finding.mend << (finding.certain ? " (certain)" : "") << "\n";
  const bool faulty = std::ranges::any_of(inspection.findings, &app::GroomFinding::fault);
  if (!faulty) std::cout << "nothing is wrong\n";
  return asked.strict && faulty ? app::kExitFault : app::kExitFine;
}

app::Character figureOf(const Asked& asked) {
  return app::loadCharacter(app::foundFile(asked.figure, "", "clips"));
}

// Of a file that holds no curves.
int runPolygons(const CLI::App& parser, const Asked& asked, const std::string& bytes) {
  for (const CLI::Option* const option : parser.get_options()) {
    const std::string name = option->get_name();
    if (option->count() > 0 && name.starts_with("--") && std::ranges::find(kOfPolygons, name) == std::end(kOfPolygons))
      throw app::UsageError(name + " would do nothing: FILE holds no curves; hairmesh-convert makes a hair mesh of it");
  }
  if (asked.up.size() > 1 || asked.up == "x")
    throw app::UsageError("--up cannot be '" + asked.up + "'; of strips it is y or z");
  app::refuseOwnExport(bytes, asked.file);
  app::refuseUtf16(bytes, asked.file);
  if (!app::hasPolygonEnding(asked.file)) app::refuseNoHair(asked.file, true);
  app::StripOptions options;
  if (!asked.unit.empty()) options.unit = metresOf(asked.unit);
  if (!asked.up.empty()) options.up = asked.up[0];
  options.flipped = asked.flipped;
  options.dropped = asked.dropped;
  return tell(asked, app::inspectPolygons(bytes, options, !asked.up.empty(), asked.file, figureOf(asked)));
}

int run(const CLI::App& parser, const Asked& asked) {
  checkOutput(asked);
  const std::string bytes = app::readText(asked.file, app::kMaxGroomFile);
  if (!app::groomFormat(bytes, asked.file) && !app::hasGroomEnding(asked.file))
    return runPolygons(parser, asked, bytes);
  if (!asked.flipped.empty() || !asked.dropped.empty())
    throw app::UsageError("--flip-strips and --drop-strips would do nothing: FILE holds curves");
  app::GroomHints hints;
  app::Groom groom = app::readGroom(bytes, asked.file, &hints);
  const app::HeadModel head = app::headModelOf(figureOf(asked));
  app::GroomHints known = hints;
  if (!asked.unit.empty()) known.meters_per_unit = metresOf(asked.unit), known.unit_given = true;
  if (!asked.up.empty()) known.axes = app::axesOfUp(asked.up);
  if (asked.turn) known.turn = app::turnedAbout(*asked.turn);
  const app::GroomInspection inspection = app::inspectGroom(groom, known, &head);
  const int exit_code = tell(asked, inspection);
  if (asked.out.empty()) return exit_code;
  app::GroomMends mends = mendsOf(parser, asked, hints, inspection.mends);
  if (mends.points == 0 && asked.out.ends_with(".tfx")) {
    mends.points = app::nearestTfxPoints(groom);
    std::cout << "points: " << mends.points << " a strand, the power of two nearest to theirs (.tfx takes no other)\n";
  }
  if (const std::string mended = mendedByItself(parser, asked, inspection); !mended.empty())
    std::cout << "mended by itself: " << mended << "\n";
  app::mendGroom(mends, &head, groom);
  if (groom.strandCount() == 0)
    throw app::InputError(asked.file, "", "no strand of it is left to write", "mend the points in the file itself");
  app::writeGroom(groom, asked.out);
  std::cout << app::countOf(groom.strandCount(), "strand") << " written to " << asked.out << "\n";
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  app::failAtFileLimit();
  CLI::App parser{kAbout};
  parser.name("hairmesh-inspect");
  parser.footer(
      "Exit codes: 0 fine, 1 a file that cannot be written (--strict: or that has a fault), 2 usage, 4 a file that "
      "cannot be used.");
  Asked asked;
  addOptions(parser, asked);
  return app::runMain("hairmesh-inspect", [&] {
    try {
      parser.parse(argc, argv);
    } catch (const CLI::Success& done) {
      return parser.exit(done);
    } catch (const CLI::ParseError& fault) {
      throw app::UsageError(app::parseFault(fault, parser, "give one groom, and --out FILE"));
    }
    return run(parser, asked);
  });
}

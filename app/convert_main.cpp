// hairmesh-convert IN OUT.obj: curves, strips and tubes of other programs to a hair mesh.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <filesystem>
#include <initializer_list>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "app/figure/head_model.h"
#include "app/figure/strip_fit.h"
#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/files/file_kind.h"
#include "app/files/hair_file.h"
#include "app/files/length_units.h"
#include "app/files/output_file.h"
#include "app/files/polygon_file.h"
#include "app/files/text_file.h"
#include "app/files/text_scanner.h"
#include "app/groom/convert.h"
#include "app/groom/formats/groom_bytes.h"
#include "app/groom/inspect/certain_mends.h"
#include "app/groom/strips/strip_convert.h"
#include "app/options.h"
#include "app/parse_fault.h"
#include "app/run_main.h"

namespace {

struct Arguments {
  std::string in, out, preset, scalp, mends, misfits, figure = "idle_turns.bvh";
  double unit = 0;
  bool no_mend = false, up_given = false;
  std::vector<std::string> given;  // names of the options
  app::ConvertOptions curves;
  app::StripOptions strips;
};

const char* const kFooter =
    R"(IN is told by its content: curves (.hair, .abc, .usda, .tfx, .ply), or strips of quads, cards and tubes (.obj, .fbx,
.glb, .gltf, .vrm). OUT.obj is read by hairmesh --hair; of curves OUT.json beside it has what makes the strands
individual, as a preset for hairmesh --preset.

Exit codes: 0 fine, 1 a file that cannot be written, strips that are left away from the head, or a groom most of which
is lost (more than half of the strands do not fit, and all are over 5 % of their length off in the mean), 2 usage, 4 a file
that cannot be used.)";

// Puts metres in place of a unit's name; returns what is wrong with it.
std::string metresOf(std::string& text) {
  const auto* const unit = std::ranges::find(app::kLengthUnits, text, &app::LengthUnit::name);
  if (unit != app::kLengthUnits.end()) text = std::to_string(unit->metres);
  double metres = 0;
  const bool good = CLI::detail::lexical_cast(text, metres) && metres > 0 && metres <= 1e6;
  return good ? "" : "'" + text + "' is no unit; give m, cm, mm, in or ft, or its metres, 0.01 for centimetres";
}

void addCurveOptions(CLI::App& parser, Arguments& arguments) {
  parser
      .add_option(
          "--vertices", arguments.curves.fit.vertices,
          "Most vertices; by default the least of 400, 800, 1600 and 2400 with which the mean distance is within "
          "1 % of the length and 95 % of the points within 3 %; no more than 8 a strand, or 400; of strips 4000")
      ->check(CLI::Range(60, 20000))
      ->option_text("N (60 to 20000)");
  parser
      .add_option("--layers", arguments.curves.fit.layers,
                  "Layers of every column; by default as the strands ask for, or the rows of a strip")
      ->check(CLI::Range(3, 40))
      ->option_text("N (3 to 40)");
  parser
      .add_option("--unit", arguments.unit,
                  "Unit of the file: m, cm, mm, in or ft, or metres in it; by default as it says, or inferred")
      ->transform(CLI::Validator(metresOf, ""))
      ->option_text("UNIT");
  parser.add_option("--mends", arguments.mends, app::kMendsHelp);
  parser.add_flag("--no-mend", arguments.no_mend,
                  "The hair is taken as it is, but for the unit and the axis that is up");
  parser
      .add_option("--misfits", arguments.misfits,
                  "List the strands that do not fit: a number and its offset in mm a line; of curves")
      ->option_text("FILE.txt");
  parser.add_option("--figure", arguments.figure,
                    "Motion or model whose head the hair is held against (a mannequin's)");
  parser.add_flag("--reverse-strands", arguments.curves.reverse, "Strands are given from tip to root");
}

void addStripOptions(CLI::App& parser, Arguments& arguments) {
  using app::RootEdge;
  static const std::map<std::string, RootEdge> kEdges{{"auto", RootEdge::kAuto},
                                                      {"scalp", RootEdge::kScalp},
                                                      {"highest", RootEdge::kHighest},
                                                      {"lowest", RootEdge::kLowest}};
  app::StripOptions& strips = arguments.strips;
  parser
      .add_option(
          "--root-edge", strips.root,
          "Of strips and tubes, the end that is the root: scalp (nearest to it), highest, lowest, or auto: scalp "
          "where there is one, else highest")
      ->transform(CLI::CheckedTransformer(kEdges))
      ->option_text("END");
  parser.add_flag("--other-end", strips.other_end,
                  "Of strips and tubes, the root is the other end than --root-edge says");
  parser.add_option("--flip-strips", strips.flipped, "Numbers of single strips, from 1, whose root is the other end")
      ->delimiter(',');
  parser.add_option("--drop-strips", strips.dropped, "Numbers of single strips, from 1, that are left out")
      ->delimiter(',');
  parser.add_option(
      "--scalp", arguments.scalp,
      "Mesh of the scalp in the strips' unit and axes; by default objects of IN called scalp, head, body");
  parser
      .add_option("--up", strips.up,
                  "The axis that is up in a file of strips: y or z; by default whichever brings them to the head")
      ->check(CLI::IsMember({'y', 'z'}))
      ->option_text("AXIS");
  parser
      .add_option("--join", strips.join,
                  "Metres: neighbouring strips nearer than that become one sheet; by default those that share vertices")
      ->check(app::within(0, 0.05))
      ->option_text("METRES (0 to 0.05)");
  parser
      .add_option("--thickness", strips.mesh.thickness,
                  "Metres that strips are thick at their roots; by default by their width")
      ->check(app::within(0.0002, 0.05))
      ->option_text("METRES (0.0002 to 0.05)");
}

// Throws CLI::ParseError.
Arguments parse(int argc, char** argv, CLI::App& parser) {
  parser.name("hairmesh-convert");
  parser.footer(kFooter);
  Arguments arguments;
  parser.add_option("IN", arguments.in, "Groom: curves, strips or tubes")->required();
  parser.add_option("OUT", arguments.out, "Hair mesh to write (OBJ)")->required();
  addCurveOptions(parser, arguments);
  addStripOptions(parser, arguments);
  parser.parse(argc, argv);
  arguments.up_given = parser.count("--up") > 0;
  for (const CLI::Option* option : parser.get_options())
    if (option->count() > 0) arguments.given.push_back(option->get_name());
  arguments.curves.unit = arguments.strips.unit = arguments.unit;
  arguments.curves.silhouettes = true;
  arguments.strips.mesh.vertices = arguments.curves.fit.vertices;
  arguments.strips.mesh.layers = arguments.curves.fit.layers;
  arguments.preset = std::filesystem::path(arguments.out).replace_extension(".json").string();
  return arguments;
}

std::string presetText(const app::LookFit& fit, const std::string& name) {
  render::HairLook look;
  app::takeLook(fit, look);
  nlohmann::ordered_json hair{{"length_variation", look.length_variation},
                              {"offset", look.offset},
                              {"clump", look.clump},
                              {"clump_size", look.clump_size},
                              {"lock", look.lock},
                              {"curl_radius", look.curl_radius},
                              {"curl_pitch", look.curl_pitch},
                              {"frizz", look.frizz}};
  for (const char* none : {"wisp", "drift", "root_spread", "hairline", "baby_hairs", "flyaways"}) hair[none] = 0;
  if (fit.taper >= 0) hair["taper"] = look.taper;
  return nlohmann::ordered_json{{"name", name}, {"hair", hair}}.dump(2) + "\n";
}

app::Character figureOf(const Arguments& arguments) {
  return app::loadCharacter(app::foundFile(arguments.figure, "", "clips"));
}

// Does what the inspector is certain of, as metres, y up, root first; returns what it says.
std::string mend(const Arguments& arguments, app::GroomHints& hints, app::Groom& groom, app::ConvertOptions& options) {
  const app::HeadModel head = app::headModelOf(figureOf(arguments));
  if (options.unit > 0) hints.meters_per_unit = options.unit, hints.unit_given = true;
  const std::string wishes = options.reverse ? arguments.mends + " --reverse all" : arguments.mends;
  const app::MendReport report = app::mendCertain(hints, &head, wishes, groom);
  options.reverse = false;
  options.unit = report.unit_known ? 1 : 0;
  options.file_unit = report.unit_known ? report.unit : 0;
  hints = {};
  return app::mendText(report);
}

int convertCurves(std::string bytes, const Arguments& arguments) {
  app::GroomHints hints;
  app::Groom groom = app::readGroom(bytes, arguments.in, &hints);
  std::string().swap(bytes);  // as large as the groom
  app::ConvertOptions options = arguments.curves;
  if (arguments.no_mend) {
    app::mendGroom({.axes = app::toldAxes(hints)}, nullptr, groom);
  } else {
    std::cout << mend(arguments, hints, groom, options);
  }
  const app::Conversion conversion = app::convertGroom(groom, hints, options, arguments.in);
  app::writeFile(arguments.out, app::writeHairMesh(conversion.shape, conversion.look.columns));
  app::writeFile(arguments.preset, presetText(conversion.look, std::filesystem::path(arguments.out).stem().string()));
  if (!arguments.misfits.empty()) app::writeFile(arguments.misfits, app::misfitList(conversion));
  std::cout << app::conversionReport(conversion) << "written       " << arguments.out << " and " << arguments.preset
            << "; open with hairmesh --hair " << arguments.out << " --preset " << arguments.preset << "\n";
  return app::conversionWarning(conversion).empty() ? app::kExitFine : app::kExitFault;
}

// What hairmesh says of its --fit, as of this program's option.
std::string withOwnOption(std::string text) {
  constexpr std::string_view kTheirs = "--fit off";
  if (const std::size_t at = text.find(kTheirs); at != std::string::npos) text.replace(at, kTheirs.size(), "--no-mend");
  return text;
}

int convertPolygons(const Arguments& arguments) {
  app::StripOptions options = arguments.strips;
  std::optional<app::PolygonMesh> scalp;
  if (!arguments.scalp.empty()) options.scalp = &scalp.emplace(app::readPolygons(arguments.scalp));
  const app::PolygonMesh mesh = app::readPolygons(arguments.in);
  app::FittedStrips fitted;
  if (arguments.no_mend) {
    fitted.conversion = app::convertStrips(mesh, options, arguments.in);
  } else {
    fitted = app::fitStrips(mesh, options, arguments.up_given, arguments.in, figureOf(arguments), true);
  }
  const app::StripConversion& conversion = fitted.conversion;
  if (!mesh.note.empty()) std::cout << "note          " << mesh.note << "\n";
  app::writeFile(arguments.out, app::writeHairMesh(conversion.mesh.shape));
  const bool lost = !arguments.no_mend && app::farFromHead(conversion.mesh.shape, figureOf(arguments));
  if (!fitted.fit.empty())
    std::cout << (lost ? "warning       " : "mended        ") << withOwnOption(std::move(fitted.fit)) << "\n";
  std::cout << app::stripReport(conversion) << "written       " << arguments.out << "\n";
  return lost ? app::kExitFault : app::kExitFine;
}

// What is written is a hair mesh, and what is read stays.
void checkOutput(const Arguments& arguments) {
  std::error_code ignored;
  if (std::filesystem::path(arguments.out).extension() != ".obj")
    throw app::UsageError("OUT cannot be '" + arguments.out + "'; a hair mesh is written as .obj");
  for (const std::string& read : {arguments.in, arguments.scalp})
    if (std::filesystem::equivalent(read, arguments.out, ignored))
      throw app::InputError(arguments.out, "", "is what is read as well", "choose another name");
  app::checkWritable(arguments.out);
  if (arguments.misfits.empty()) return;
  for (const std::string& other : {arguments.in, arguments.out, arguments.preset})
    if (arguments.misfits == other || std::filesystem::equivalent(arguments.misfits, other, ignored))
      throw app::InputError(arguments.misfits, "", "is read or written as well", "choose another name for --misfits");
  app::checkWritable(arguments.misfits);
}

// Throws UsageError for an option of the other kind of groom.
void refuseIdle(std::initializer_list<std::string_view> idle, const char* kind, const Arguments& arguments) {
  for (const std::string& name : arguments.given)
    if (std::ranges::find(idle, name) != idle.end())
      throw app::UsageError(name + " would do nothing: IN holds " + kind + "; leave it out");
}

int run(const Arguments& arguments) {
  checkOutput(arguments);
  std::string bytes = app::readText(arguments.in, app::kMaxGroomFile);
  if (app::groomFormat(bytes, arguments.in)) {
    refuseIdle(
        {"--root-edge", "--other-end", "--flip-strips", "--drop-strips", "--scalp", "--up", "--join", "--thickness"},
        "curves", arguments);
    return convertCurves(std::move(bytes), arguments);
  }
  refuseIdle({"--mends", "--reverse-strands", "--misfits"}, "no curves", arguments);
  app::refuseOwnExport(bytes, arguments.in);
  if (!app::hasPolygonEnding(arguments.in)) {
    app::refuseUtf16(bytes, arguments.in);
    app::refuseNoHair(arguments.in, true);
  }
  if (app::hasLayers(bytes))
    throw app::InputError(arguments.in, "", "is a hair mesh already", "show it with hairmesh --hair");
  return convertPolygons(arguments);
}

}  // namespace

int main(int argc, char** argv) {
  app::failAtFileLimit();
  return app::runMain("hairmesh-convert", [&] {
    CLI::App parser{"Makes a hair mesh of a groom, and says how near its strands come back."};
    try {
      return run(parse(argc, argv, parser));
    } catch (const CLI::Success& done) {
      return parser.exit(done);
    } catch (const CLI::ParseError& fault) {
      throw app::UsageError(app::parseFault(fault, parser, "give IN and OUT.obj"));
    }
  });
}

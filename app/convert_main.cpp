// hairmesh-convert IN OUT.obj: curves of other programs to a hair mesh.
#include <CLI/CLI.hpp>
#include <exception>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/files/errors.h"
#include "app/files/hair_file.h"
#include "app/files/output_file.h"
#include "app/groom/convert.h"

namespace {

struct Arguments {
  std::string in, out, preset;
  app::ConvertOptions convert;
};

const char* const kFooter =
    R"(IN is told by its content: .hair, .abc, .usda, .tfx or .ply. OUT.obj is read by hairmesh --hair; beside it OUT.json has
what makes the strands individual, as a preset for hairmesh --preset.

Exit codes: 0 fine, 1 a file that cannot be written, 2 usage, 4 a file that cannot be used.)";

// Throws CLI::ParseError.
Arguments parse(int argc, char** argv, CLI::App& parser) {
  parser.name("hairmesh-convert");
  parser.footer(kFooter);
  Arguments arguments;
  parser.add_option("IN", arguments.in, "Groom")->required();
  parser.add_option("OUT", arguments.out, "Hair mesh to write (OBJ)")->required();
  parser
      .add_option(
          "--vertices", arguments.convert.fit.vertices,
          "Most vertices; by default the least of 400, 800, 1600 and 2400 with which the mean distance is within "
          "1 % of the length and 95 % of the points within 3 %")
      ->check(CLI::Range(60, 20000));
  parser
      .add_option("--layers", arguments.convert.fit.layers, "Layers of every column; by default as the strands ask for")
      ->check(CLI::Range(3, 40));
  parser
      .add_option("--unit", arguments.convert.unit, "Metres in a unit of the file; by default as it says, or inferred")
      ->check(CLI::PositiveNumber);
  parser.add_flag("--reverse-strands", arguments.convert.reverse, "Strands are given from tip to root");
  parser.parse(argc, argv);
  arguments.convert.silhouettes = true;
  arguments.preset = std::filesystem::path(arguments.out).replace_extension(".json").string();
  return arguments;
}

std::string presetText(const app::LookFit& fit, const std::string& name) {
  render::HairLook look;
  app::takeLook(fit, look);
  nlohmann::ordered_json hair{
      {"length_variation", look.length_variation}, {"offset", look.offset},         {"clump", look.clump},
      {"curl_radius", look.curl_radius},           {"curl_pitch", look.curl_pitch}, {"frizz", look.frizz}};
  for (const char* none : {"lock", "wisp", "drift", "hairline", "baby_hairs", "flyaways"}) hair[none] = 0;
  if (fit.taper >= 0) hair["taper"] = look.taper;
  return nlohmann::ordered_json{{"name", name}, {"hair", hair}}.dump(2) + "\n";
}

int run(const Arguments& arguments) {
  app::checkWritable(arguments.out);
  app::GroomHints hints;
  const app::Groom groom = app::readGroom(arguments.in, &hints);
  const app::Conversion conversion = app::convertGroom(groom, hints, arguments.convert, arguments.in);
  app::writeFile(arguments.out, app::writeHairMesh(conversion.shape));
  app::writeFile(arguments.preset, presetText(conversion.look, std::filesystem::path(arguments.out).stem().string()));
  std::cout << app::conversionReport(conversion) << "written       " << arguments.out << " and " << arguments.preset
            << "\n";
  return app::kExitFine;
}

int fail(const std::exception& fault, int exit_code) {
  std::cerr << "hairmesh-convert: " << fault.what() << "\n";
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App parser{"Makes a hair mesh of a groom, and says how near its strands come back."};
  try {
    return run(parse(argc, argv, parser));
  } catch (const CLI::Success& done) {
    return parser.exit(done);
  } catch (const CLI::ParseError& fault) {
    std::cerr << "hairmesh-convert: " << fault.what() << "; hairmesh-convert --help lists the options\n";
    return app::kExitUsage;
  } catch (const app::InputError& fault) {
    return fail(fault, app::kExitBadInput);
  } catch (const std::exception& fault) {
    return fail(fault, app::kExitFault);
  }
}

#include "app/scene/hair_from_file.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>

#include "app/figure/hair_fit.h"
#include "app/figure/head_model.h"
#include "app/figure/strip_fit.h"
#include "app/files/errors.h"
#include "app/files/field_map.h"
#include "app/files/file_kind.h"
#include "app/files/hair_file.h"
#include "app/files/polygon_file.h"
#include "app/files/presets.h"
#include "app/files/text_file.h"
#include "app/files/text_scanner.h"
#include "app/groom/convert.h"
#include "app/groom/formats/groom_bytes.h"

namespace app {

namespace {

// on_head: whether its roots lie on the figure's head now, beards too.
Conversion convertMended(const std::string& bytes, const CharacterSpec& spec, const Character& character,
                         Haircut& haircut, bool& on_head) {
  GroomHints hints;
  Groom groom = readGroom(bytes, spec.hair, &hints);
  ConvertOptions options;
  if (!spec.fit) {
    mendGroom({.axes = toldAxes(hints)}, nullptr, groom);
    return convertGroom(groom, hints, options, spec.hair);
  }
  const HeadModel head = headModelOf(character);
  const MendReport report = mendCertain(hints, &head, spec.mends, groom);
  haircut.findings = report.findings;
  on_head = report.on_head;
  if (report.unit_known) options.unit = 1, options.file_unit = report.unit;
  return convertGroom(groom, {}, options, spec.hair);
}

// What was mended, and what of the file's own word is doubted or left out.
std::string mendedBy(const Haircut& haircut) {
  std::string text, left;
  const bool off = std::ranges::any_of(haircut.findings, [](const MendedFinding& one) {
    return !one.done && one.finding.fault && (one.finding.what == "roots" || one.finding.what == "body");
  });
  for (const MendedFinding& one : haircut.findings) {
    const GroomFinding& finding = one.finding;
    if (one.done) text += (text.empty() ? "mended: " : ", ") + finding.what + " (" + finding.mend + ")";
    const bool stays = finding.what == "roots" && !finding.fault && finding.mend.empty();
    const bool place = finding.what == "unit" || finding.what == "up";
    // What may be wrong with hair that lies off the head or in the body.
    const bool doubted = (finding.fault && (place || finding.what == "roots" || finding.what == "body")) ||
                         (off && (place || finding.what == "facing"));
    if (!one.done && (doubted || stays || finding.what == "hidden"))
      left += "; " + finding.text + (finding.mend.empty() ? "" : " (--mends \"" + finding.mend + "\")");
  }
  return text.empty() && !left.empty() ? left.substr(2) : text + left;
}

// A hair mesh brought to metres, y up, by the mends that are told. Returns what of these it has no use for, in words.
std::string placeAsTold(const std::string& wishes, ToldPlace& told, sim::HairMeshShape& shape) {
  GroomMends mends;
  if (const std::string fault = readMends(wishes, mends); !fault.empty()) throw InputError("", "mends", fault, "");
  const Eigen::Matrix3d turned = mends.unit * mends.scale * mends.axes.cast<double>();
  for (Vec3& p : shape.positions) p = turned * p + mends.move.cast<double>();
  for (Vec3& offset : shape.groom_offsets) offset = turned * offset;
  told.metres = wishes.find("--unit") != std::string::npos;
  told.axes = wishes.find("--up") != std::string::npos || wishes.find("--turn") != std::string::npos;
  GroomMends rest;
  rest.unit = mends.unit, rest.axes = mends.axes, rest.scale = mends.scale, rest.move = mends.move;
  return rest == mends ? ""
                       : "of a hair mesh \"mends\" are --unit, --up, --turn, --scale and --move; others change nothing";
}

struct BroughtField {
  std::string FieldFiles::*picture;
  double ColumnShare::*share;
};
constexpr std::array kBrought{
    BroughtField{&FieldFiles::clump, &ColumnShare::clump}, BroughtField{&FieldFiles::curl, &ColumnShare::curl},
    BroughtField{&FieldFiles::frizz, &ColumnShare::frizz}, BroughtField{&FieldFiles::width, &ColumnShare::width}};

// Shares of the columns as pictures of the unrolled head; none of what is 1 everywhere.
FieldFiles fieldsOf(const std::vector<ColumnShare>& shares, const sim::HairMeshShape& shape, const Scalp& scalp) {
  FieldFiles fields;
  std::vector<Vec3> directions;
  for (std::size_t c = 0; c < shares.size(); ++c)
    directions.push_back(
        (shape.positions[static_cast<std::size_t>(shape.column_first[c])] - scalp.center).normalized());
  for (const BroughtField& field : kBrought) {
    std::vector<double> values;
    for (const ColumnShare& share : shares) values.push_back(share.*field.share);
    if (std::ranges::any_of(values, [](double value) { return value < 1; }))
      fields.*field.picture = pictureText(fieldOver(directions, values));
  }
  return fields;
}

// Of a hair mesh with a preset of its name beside it, as hairmesh-convert writes, whose look it does not have: where
// that is.
std::string lookBeside(const CharacterSpec& spec) {
  const std::string preset = std::filesystem::path(spec.hair).replace_extension(".json").string();
  if (!std::filesystem::is_regular_file(preset)) return "";
  try {
    if (!presetSections(preset).hair) return "";
    sim::SimParams sim;
    SceneLook scene;
    CharacterLook look = spec.look, *looks[] = {&look};
    loadPreset(preset, {&sim, &scene, looks});
    if (look == spec.look) return "";
  } catch (const InputError&) {
    return "";
  }
  return "how its strands look is in " + preset + " beside it: open that too, or give it to --preset";
}

}  // namespace

sim::HairMeshShape hairFromFile(const CharacterSpec& spec, const Character& character, Haircut& haircut) {
  sim::HairMeshShape shape;
  bool on_head = false;
  ToldPlace told;
  std::vector<ColumnShare> shares;
  const auto note = [&](const std::string& text) {
    if (!text.empty()) haircut.note += (haircut.note.empty() ? spec.hair + ": " : "; ") + text;
  };
  const std::string bytes = readText(spec.hair, kMaxGroomFile);
  refuseOwnExport(bytes, spec.hair);
  if (groomFormat(bytes, spec.hair)) {
    const Conversion conversion = convertMended(bytes, spec, character, haircut, on_head);
    haircut.look = conversion.look;
    shares = conversion.look.columns;
    shape = conversion.shape;
    note(conversionWarning(conversion));
    note(mendedBy(haircut));
    note(conversionNote(conversion));
  } else if (hasPolygonEnding(spec.hair) && !hasLayers(bytes)) {
    const PolygonMesh mesh = readPolygons(spec.hair);
    StripOptions options;
    const bool up_given = spec.mends == "--up y" || spec.mends == "--up z";
    if (up_given) options.up = spec.mends.back();
    if (!up_given && !spec.mends.empty())
      note("of strips \"mends\" are \"--up y\" or \"--up z\", others change nothing; hairmesh-convert takes more");
    FittedStrips fitted = fitStrips(mesh, options, up_given, spec.hair, character, spec.fit);
    note(stripNote(fitted.conversion));
    note(mesh.note);
    note(fitted.fit);
    return std::move(fitted.conversion.mesh.shape);
  } else {
    refuseUtf16(bytes, spec.hair);
    if (!hasLayers(bytes)) refuseNoHair(spec.hair);
    bool turned = false;
    shape = readHairMesh(bytes, spec.hair, spec.reverse_faces, "", &turned, &shares);
    if (turned) note("all its faces were wound the other way, and are turned");
    note(lookBeside(spec));
    if (!spec.mends.empty()) note(placeAsTold(spec.mends, told, shape));
  }
  if (!on_head) note(fitHair(character, spec.fit, shape, told));
  haircut.fields = fieldsOf(shares, shape, character.scalp);
  return shape;
}

FieldFiles withFields(const Haircut& haircut, const CharacterSpec& spec) {
  FieldFiles maps = spec.maps;
  if (spec.fields_of == spec.hair) return maps;
  for (const auto& [picture, share] : kBrought) {
    const std::string &own = maps.*picture, &brought = haircut.fields.*picture;
    if ((haircut.look || !brought.empty()) && (own.empty() || own == spec.maps_before.*picture))
      maps.*picture = brought;
  }
  return maps;
}

void chooseHair(const std::string& file, CharacterSpec& spec) {
  if (spec.look_before) {
    dropLook(*spec.look_before, spec.look.hair);
    for (const auto& [picture, share] : kBrought) spec.maps.*picture = spec.maps_before.*picture;
  }
  spec.look_before.reset();
  spec.maps_before = {};
  spec.fields_of.clear();
  if (!file.empty()) spec.look_before = spec.look.hair, spec.maps_before = spec.maps;
  spec.hair = file;
}

}  // namespace app

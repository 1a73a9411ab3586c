#include "app/scene/hair_from_file.h"

#include "app/figure/hair_fit.h"
#include "app/figure/head_model.h"
#include "app/files/errors.h"
#include "app/files/file_kind.h"
#include "app/files/hair_file.h"
#include "app/files/polygon_file.h"
#include "app/files/text_file.h"
#include "app/files/text_scanner.h"
#include "app/groom/convert.h"
#include "app/groom/formats/groom_bytes.h"
#include "app/groom/strips/strip_convert.h"

namespace app {

namespace {

// on_head: whether its roots lie on the figure's head now, beards too.
Conversion convertMended(const std::string& bytes, const CharacterSpec& spec, const Character& character,
                         Haircut& haircut, bool& on_head) {
  GroomHints hints;
  Groom groom = readGroom(bytes, spec.hair, &hints);
  ConvertOptions options;
  if (!spec.fit) return convertGroom(groom, hints, options, spec.hair);
  const HeadModel head = headModelOf(character);
  const MendReport report = mendCertain(hints, &head, spec.mends, groom);
  haircut.findings = report.findings;
  on_head = report.on_head;
  if (report.unit_known) options.unit = 1;
  return convertGroom(groom, {}, options, spec.hair);
}

struct PlacedStrips {
  sim::HairMeshShape shape;
  std::string strips, fit;  // what is said of them, and of their place
};

PlacedStrips placeStrips(const PolygonMesh& mesh, char up, const CharacterSpec& spec, const Character& character) {
  StripOptions options;
  options.up = up;
  const StripConversion conversion = convertStrips(mesh, options, spec.hair);
  PlacedStrips placed{conversion.mesh.shape, stripNote(conversion), ""};
  if (!mesh.note.empty()) placed.strips += "; " + mesh.note;
  placed.fit = fitHair(character, spec.fit, placed.shape, true);
  return placed;
}

// Strips are rooted at their highest ends, and their file does not say which axis is up. Away from the head it is y or
// z, whichever brings the roots nearer to the scalp.
PlacedStrips placeStrips(const CharacterSpec& spec, const Character& character) {
  const PolygonMesh mesh = readPolygons(spec.hair);
  PlacedStrips placed = placeStrips(mesh, 'y', spec, character);
  if (!spec.fit || placed.fit.empty()) return placed;
  try {
    PlacedStrips turned = placeStrips(mesh, 'z', spec, character);
    const auto off = [&](const PlacedStrips& one) { return rootDistance(one.shape, character.scalp); };
    return off(placed) > 0.5 * kFarRoots && off(turned) < off(placed) ? turned : placed;
  } catch (const InputError&) {
    return placed;  // no strips with z up
  }
}

std::string mendedBy(const Haircut& haircut) {
  std::string text;
  for (const MendedFinding& one : haircut.findings) {
    if (one.done) text += (text.empty() ? "mended by " : ", ") + one.finding.mend;
  }
  return text;
}

[[noreturn]] void refuseNoHair(const std::string& file) {
  const auto [kind, use] = kindAndUse(file);
  if (!kind.empty()) throw InputError(file, "", kind + ", no hair", use);
  throw InputError(
      file, "", "holds no hair",
      "give a hair mesh (.obj with groups layer_0, layer_1, ...), curves (.hair, .abc, .usda, .tfx, .ply), "
      "or strips and tubes (.obj, .fbx, .glb, .gltf, .vrm)");
}

}  // namespace

sim::HairMeshShape hairFromFile(const CharacterSpec& spec, const Character& character, Haircut& haircut) {
  sim::HairMeshShape shape;
  bool on_head = false;
  const auto note = [&](const std::string& text) {
    if (!text.empty()) haircut.note += (haircut.note.empty() ? spec.hair + ": " : "; ") + text;
  };
  const std::string bytes = readText(spec.hair, kMaxGroomFile);
  if (bytes.starts_with("glTF") && bytes.find("\"generator\":\"hairmesh\"") != std::string::npos)
    throw InputError(spec.hair, "", "is a moving hair mesh that this program has exported, and is not read back",
                     "export strands (.abc, .usda, .hair, .ply), or write the hair mesh (--write-hair FILE.obj)");
  if (groomFormat(bytes, spec.hair)) {
    const Conversion conversion = convertMended(bytes, spec, character, haircut, on_head);
    haircut.look = conversion.look;
    shape = conversion.shape;
    note(mendedBy(haircut));
    note(conversionNote(conversion));
  } else if (hasPolygonEnding(spec.hair) && !hasLayers(bytes)) {
    PlacedStrips placed = placeStrips(spec, character);
    note(placed.strips);
    note(placed.fit);
    return std::move(placed.shape);
  } else {
    refuseUtf16(bytes, spec.hair);
    if (!hasLayers(bytes)) refuseNoHair(spec.hair);
    shape = readHairMesh(bytes, spec.hair, spec.reverse_faces);
  }
  if (!on_head) note(fitHair(character, spec.fit, shape));
  return shape;
}

}  // namespace app

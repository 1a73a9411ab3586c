#include "app/figure/strip_fit.h"

#include "app/figure/hair_fit.h"
#include "app/files/errors.h"

namespace app {

namespace {

FittedStrips fitWithUp(const PolygonMesh& mesh, const StripOptions& options, const std::string& file,
                       const Character& character, bool mend) {
  FittedStrips fitted{convertStrips(mesh, options, file), ""};
  StripConversion& strips = fitted.conversion;
  fitted.fit = fitHair(character, mend, strips.mesh.shape, true, strips.scalp_points);
  return fitted;
}

}  // namespace

FittedStrips fitStrips(const PolygonMesh& mesh, const StripOptions& options, bool up_given, const std::string& file,
                       const Character& character, bool mend) {
  FittedStrips fitted = fitWithUp(mesh, options, file, character, mend);
  if (!mend || up_given || fitted.fit.empty()) return fitted;
  StripOptions turned_options = options;
  turned_options.up = 'z';
  try {
    FittedStrips turned = fitWithUp(mesh, turned_options, file, character, mend);
    const auto off = [&](const FittedStrips& one) { return rootDistance(one.conversion.mesh.shape, character.scalp); };
    return off(fitted) > 0.5 * kFarRoots && off(turned) < off(fitted) ? turned : fitted;
  } catch (const InputError&) {
    return fitted;  // no strips with z up
  }
}

bool farFromHead(const sim::HairMeshShape& shape, const Character& character) {
  return rootDistance(shape, character.scalp) > 3 * kFarRoots;
}

}  // namespace app

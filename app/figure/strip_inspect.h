// What is wrong with a file of polygons: strips, cards and tubes, hair meshes, bodies. The mends are options of
// hairmesh-convert.
#pragma once

#include <string>
#include <string_view>

#include "app/figure/character.h"
#include "app/groom/inspect/groom_inspect.h"
#include "app/groom/strips/strip_convert.h"

namespace app {

// Strips as fitStrips brings them to the head: what that does by itself is certain. Findings: left out, no area,
// astray, unit, up, facing, size, roots, reversed, root edge, widths, body. Throws InputError as fitStrips does.
GroomInspection inspectStrips(const PolygonMesh& mesh, const StripOptions& options, bool up_given,
                              const std::string& file, const Character& character);

// Of any file of polygons, told by its content: a hair mesh of this program is held against the head, of a body it is
// said how it is read, and all else is strips. Throws InputError.
GroomInspection inspectPolygons(std::string_view bytes, const StripOptions& options, bool up_given,
                                const std::string& file, const Character& character);

}  // namespace app

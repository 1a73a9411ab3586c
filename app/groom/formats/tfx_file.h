// TressFX hair (`.tfx`): strands of one number of points.
//
// 160 bytes of header: version (float, 4.0), strands, points a strand (4 to 64, a power of two), offsets of positions
// (4 floats a point, the last is an inverse mass), of root UVs (2 floats a strand), of UVs of points, of thicknesses (a
// float a strand), of colours (4 floats a point), 32 reserved numbers; an offset of 0 stands for nothing. Offsets are
// multiples of 8 from the file's start. Little-endian. Source: TressFXFileFormat.h of AMD's TressFX 4.
#pragma once

#include <string>
#include <string_view>

#include "app/files/output_file.h"
#include "app/groom/groom.h"

namespace app {

// Whether a strand may have so many points: 4, 8, 16, 32 or 64.
bool isTfxPoints(std::size_t points);

// Whether the bytes can be such a file; the format has no mark of its own.
bool looksLikeTfx(std::string_view bytes);

// A strand's thickness becomes the width of all its points. `file` names the bytes in messages. Throws InputError.
Groom readTfx(std::string_view bytes, const std::string& file);

// The number of points that the format has, nearest (in ratio) to the median of the strands'.
int nearestTfxPoints(const Groom& groom);

// Writes points, root UVs, colours, and as thickness the width of the root. Reading gives the same bits of what the
// format holds. Throws OutputError naming a strand of another number of points than the first, or a number that the
// format does not have.
// `text`: up to 128 bytes for the reserved numbers.
void writeTfx(const Groom& groom, const std::string& file, OutputFile& output, std::string_view text = "");

}  // namespace app

// `.hair` files of strands, as Cem Yuksel's hair models are kept; the format's description is on their page
// (cemyuksel.com/research/hairmodels, "HAIR File Format Specification").
//
// 128 bytes of header: 'HAIR', strands, points, flags (1 segments, 2 points, 4 thickness, 8 transparency, 16 colour),
// default segments, default thickness, default transparency, default colour, 88 bytes of text; then the arrays that the
// flags name, in that order: 16-bit segments a strand, three floats a point, a float a point, a float a point, three
// floats a point. Numbers are little-endian. Neither unit nor axes are told; the models of that page are z-up. What
// this program exports says in the text what worldMark (groom_file.h) has.
#pragma once

#include <string>
#include <string_view>

#include "app/files/output_file.h"
#include "app/groom/groom.h"

namespace app {

// Points, widths and colours in the bits of the file; thickness is a diameter in the points' unit. A default thickness
// other than 0 gives every point that width; a default colour other than white likewise. Transparency is passed over.
// Points may be anything a float holds. `file` names the bytes in messages. Throws InputError.
Groom readHairStrands(std::string_view bytes, const std::string& file);

// Writes what the format can hold: strands, points, widths, colours. Reading gives the same bits. Throws OutputError
// naming a strand without points or with more than 65,536 of them, and when the bytes could not be written.
// `text`: 87 bytes of it at most go into the header.
void writeHairStrands(const Groom& groom, const std::string& file, OutputFile& output, std::string_view text = "");

}  // namespace app

// Strands as polylines in PLY (`.ply`): text and both binary orders in, text and little-endian binary out.
//
// A header of lines ("ply", "format ascii|binary_little_endian|binary_big_endian 1.0", "element NAME COUNT", "property
// TYPE NAME", "property list TYPE TYPE NAME", "end_header"), then the rows of each element. Source: G. Turk, The PLY
// Polygon File Format (1994), whose edges are rows of vertex1 and vertex2.
//
// Strands are told, in this order, by an element "strand" (or "polyline", "curve", "line") with its number of points or
// a list of its vertices; by an element "edge", a vertex without an edge to the one before it being a root; or by a
// vertex's strand number (strand, strand_id, strand_index). Of a vertex are read x y z; width, thickness or twice a
// radius; red green blue (bytes as sRGB shares of 255, floats as they are). Of a strand root_u root_v id group guide.
#pragma once

#include <string>
#include <string_view>

#include "app/files/output_file.h"
#include "app/groom/groom.h"

namespace app {

// `file` names the bytes in messages. Throws InputError naming line or byte.
Groom readPlyStrands(std::string_view bytes, const std::string& file);

// Writes every array; edges stand beside the strands for programs that draw edges. Reading gives the same bits, of text
// too. Throws OutputError.
// `comment`: one line for the header.
void writePlyStrands(const Groom& groom, bool text, OutputFile& output, const std::string& comment = "");

}  // namespace app

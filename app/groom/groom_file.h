// Grooms from files of any kind that is read, told by content. Tables of what each format holds: docs/files.md.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "app/groom/groom.h"
#include "app/groom/groom_hints.h"

namespace app {

enum class GroomFormat { kHair, kAlembic, kUsda, kPly, kTfx };

// By the first bytes, and for a kind without a mark by the plausibility of its header. Throws InputError for what is
// known and not read: Alembic in HDF5, binary or packed USD. Nothing: no groom.
std::optional<GroomFormat> groomFormat(std::string_view bytes, const std::string& file);

// What a groom of the name's ending begins with; empty for other endings.
std::string beginningOfGroom(const std::string& file);
// Throws InputError where the file's name tells a format of grooms: its bytes are of another.
void refuseOtherBeginning(const std::string& file);
// Whether the name ends like a groom's: .hair, .abc, .usda, .tfx, .ply and those that are refused by name.
bool hasGroomEnding(const std::string& file);

// The groom as the file has it: its unit, its axes, its order of points; strands without points are kept. Where a file
// holds several moments, the first. Memory used is bounded by a small multiple of the file's size; files over
// kMaxGroomFile bytes and grooms over kMaxGroomPoints points are refused (groom_bytes.h). Throws InputError naming the
// place, the fault and the mend. What the file tells of its unit and axes goes to `hints`.
Groom readGroom(const std::string& file, GroomHints* hints = nullptr);
Groom readGroom(std::string_view bytes, const std::string& file, GroomHints* hints = nullptr);

// What an export says of itself wherever its format has room for text: "hairmesh world of 1 heads, y up, unit 0.01 m".
std::string worldMark(int heads, double meters_per_unit);
// Takes it from the beginning or the end of a file's bytes.
void readWorldMark(std::string_view bytes, GroomHints& hints);

}  // namespace app

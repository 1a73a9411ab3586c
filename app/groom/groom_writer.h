// Grooms into a file of whatever kind its name ends in: .abc and .usda take a clip, .hair, .ply and .tfx a file a
// frame.
#pragma once

#include <string>
#include <variant>

#include "app/groom/clip_settings.h"
#include "app/groom/formats/alembic_file.h"
#include "app/groom/formats/usda_file.h"
#include "app/groom/groom.h"

namespace app {

// Whether one file of this name takes a clip; false also for endings that are not known.
bool takesClip(const std::string& file);
bool isGroomOutput(const std::string& file);

// "hair_0012.ply" of "hair.ply": the frame's number before the dot.
std::string numberedName(const std::string& file, long frame);

class GroomWriter {
 public:
  // `numbered`: files of one frame get its number. Throws OutputError when the file cannot be made; nothing that was
  // there is lost yet.
  GroomWriter(const std::string& file, const ClipSettings& settings, bool numbered);

  // Throws OutputError.
  void add(const Groom& groom, long frame);
  // A clip appears under its name; without it nothing is left of one. Throws OutputError.
  void finish();

 private:
  std::string file_;
  bool numbered_;
  std::string mark_;  // worldMark, or empty
  std::variant<std::monostate, AlembicWriter, UsdaWriter> clip_;
};

// One frame into one file. Throws OutputError.
void writeGroom(const Groom& groom, const std::string& file);

}  // namespace app

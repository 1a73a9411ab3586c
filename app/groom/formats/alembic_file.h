// Grooms as Alembic curves (`.abc`, Ogawa), with the attributes that Unreal Engine's groom importer takes.
//
// An object of the schema AbcGeom_Curve_v2 has a compound ".geom": "P" (points), "nVertices" (points a curve),
// "curveBasisAndType" (type 1 linear, wrap 0, basis, basis), ".selfBnds" (box), "width" (diameters), and below
// ".arbGeomParams" and ".userProperties" whatever a program adds. Source: lib/Alembic/AbcGeom (OCurves, OGeomParam,
// XformOp) of the repository alembic/alembic. Unreal's attributes: "Alembic for Grooms Specification" in its
// documentation: groom_version_major, groom_version_minor, groom_tool once; groom_id, groom_group_id, groom_guide,
// groom_root_uv a strand; groom_width, groom_color a point.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/files/output_file.h"
#include "app/groom/clip_settings.h"
#include "app/groom/groom.h"

namespace app {

// All curves of all objects, one after another, at moment `moment` (the last where there are fewer), with the objects'
// transforms at their first moment applied. Control points are taken as points, of Bezier curves every third. Arrays
// that some objects lack are filled with 0 (ids -1); without groups each object is one. `file` names the bytes in
// messages. Throws InputError.
Groom readAlembic(std::string_view bytes, const std::string& file, std::size_t moment = 0);

// Seconds of the moments, by the curves that have most of them; one entry for a file without motion. Throws InputError.
std::vector<double> alembicTimes(std::string_view bytes, const std::string& file);

// Writes a clip moment by moment; memory does not grow with the number of moments but for 40 bytes each. Points change,
// everything else is taken from the first moment. Reading gives back the same bits.
class AlembicWriter {
 public:
  // Throws OutputError where the file cannot be made.
  AlembicWriter(const std::string& file, const ClipSettings& times);
  ~AlembicWriter();

  // Throws OutputError when strands differ from those of the first moment, and when bytes could not be written.
  void add(const Groom& groom);
  // Without it nothing is left of the file.
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace app

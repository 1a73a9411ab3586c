// The lines of an OBJ text that matter to a hair mesh, layer by layer, each with the line that it stands on.
#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "sim/mesh/hair_mesh.h"

namespace app {

struct ObjFace {
  int line = 0;
  int corner_count = 0;                  // 3 or 4
  std::array<int, 4> v{-1, -1, -1, -1};  // indices of ObjLayers::positions
  std::string_view bundle;               // the name that `usemtl bundle_...` gave, or empty
};

struct ObjLayer {
  int line = 0;  // of its first group line
  std::vector<ObjFace> faces;
};

struct ObjLayers {
  std::vector<sim::Vec3> positions;
  std::vector<int> position_lines;
  std::vector<sim::Vec3> offsets;       // of the vertices before lines "#groom_offset"; as many as positions, or none
  std::vector<Eigen::Vector4d> shares;  // 0 to 1, of clump, curl, frizz and width: likewise before lines "#look_share"
  std::map<int, ObjLayer> layers;       // by layer number
};

// Views into `text` live as long as it does. Throws InputError.
ObjLayers readObjLayers(std::string_view text, const std::string& file);

}  // namespace app

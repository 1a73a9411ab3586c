// Files that a glTF names by URI, where a blank is "%20" and any byte may be "%" and two hexadecimal digits (RFC 3986,
// 2.1): the name as it is written where there is such a file, else with those decoded.
#pragma once

#include <assimp/DefaultIOSystem.h>

#include <string>

namespace app {

std::string fileOfUri(const std::string& name);

// What assimp's importers open goes through fileOfUri: buffers as well as pictures.
class UriFiles : public Assimp::DefaultIOSystem {
 public:
  bool Exists(const char* name) const override;
  Assimp::IOStream* Open(const char* name, const char* mode) override;
};

}  // namespace app

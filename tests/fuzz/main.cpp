// libFuzzer's target: the reader named by --reader=NAME (libFuzzer leaves alone what begins with two dashes), or every
// reader's name under --list.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "app/files/errors.h"
#include "app/files/painted_mesh.h"
#include "tests/fuzz/readers.h"

// Painted meshes are read by assimp, which is not linked here.
namespace app {

bool hasPaintedEnding(const std::string&) {
  return false;
}
Image readPaintedMesh(const std::string& file) {
  throw InputError(file, "", "is a mesh", "");
}

}  // namespace app

namespace {

const tests::Reader* chosen = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  constexpr std::string_view option = "--reader=";
  for (int i = 1; i < *count; ++i) {
    const std::string_view argument = (*arguments)[i];
    for (const tests::Reader& reader : tests::readers()) {
      if (argument == "--list") std::puts(reader.name);
      if (argument.starts_with(option) && argument.substr(option.size()) == reader.name) chosen = &reader;
    }
  }
  if (!chosen) std::exit(2);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    chosen->read({reinterpret_cast<const char*>(data), size});
  } catch (const app::InputError&) {
  }
  return 0;
}

#include "app/library/objects.h"

namespace app::library {

HandleTable<MeshRef>& meshes() {
  static HandleTable<MeshRef> table("hair mesh", 1);
  return table;
}

HandleTable<std::unique_ptr<Hair>>& hairs() {
  static HandleTable<std::unique_ptr<Hair>> table("hair", 0x80000001u);
  return table;
}

MeshRef meshOf(hm_mesh handle) {
  return meshes().with(handle.id, [](const MeshRef& mesh) { return mesh; });
}

HairUse::HairUse(hm_hair handle) : id_(handle.id) {
  hairs().with(id_, [&](const std::unique_ptr<Hair>& hair) {
    if (hair->busy) throw Fault{HM_ERROR_BUSY, "another thread is working on this hair; call again when it is done"};
    hair->busy = true;
    hair_ = hair.get();
  });
}

// A hair in use cannot have been destroyed.
HairUse::~HairUse() {
  hairs().with(id_, [](const std::unique_ptr<Hair>& hair) { hair->busy = false; });
}

}  // namespace app::library

#include "sim/forces/stored_energy.h"

namespace sim {

StoredEnergy::StoredEnergy(const HairMesh& mesh)
    : mesh_(&mesh), layout_(mesh), pattern_(mesh, layout_), elements_(mesh, layout_, pattern_), x_(layout_) {}

double StoredEnergy::at(const ForceModel<double>& model, std::span<const Vec3> positions) {
  if (!known_) elements_.setElements(*mesh_, layout_, model);
  known_ = true;
  elements_.setMoving(model, Vec3::Zero());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const int slot = layout_.slot[i];
    x_.x[slot] = positions[i].x(), x_.y[slot] = positions[i].y(), x_.z[slot] = positions[i].z();
  }
  return evaluate<double>(elements_, layout_, x_, {});
}

}  // namespace sim

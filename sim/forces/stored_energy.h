// The elastic energy of a hair (J), in double precision: the kernels' sum without forces and Hessians. Accounts of
// energy compare differences of a millionth of it.
#pragma once

#include <span>

#include "sim/forces/kernels.h"

namespace sim {

class StoredEnergy {
 public:
  explicit StoredEnergy(const HairMesh& mesh);
  // The model's elements have changed. They are read when next asked for.
  void forget() { known_ = false; }
  // `model` is that of the calls before, unless forgotten; its moving elements are read at every call. Positions in m.
  double at(const ForceModel<double>& model, std::span<const Vec3> positions);

 private:
  const HairMesh* mesh_;
  ColumnLayout layout_;
  ColumnPattern pattern_;
  ColumnModel<double> elements_;
  ColumnField<double> x_;
  bool known_ = false;
};

}  // namespace sim

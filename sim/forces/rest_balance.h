// The force model as it follows the material parameters: at once, and cheaply where only their values change.
//
// Rest shifts that balance gravity are a linear solve of hundreds of iterations, far too long for a frame in which a
// slider is dragged. But what balances gravity is the product of stiffness and shift of each element: kept while the
// stiffness changes, gravity stays balanced exactly. Only which of all balances it is, the one of least energy, needs
// the solve, and that can come a little later, some iterations a step.
#pragma once

#include <memory>
#include <vector>

#include "sim/forces/model.h"
#include "sim/mesh/hair_memory.h"

namespace sim {

// A balance of gravity in the styled pose: the change of each element's condition, and the stiffness that it was solved
// for; one entry a kind, one value an element. The shift is minus the change.
struct RestBalance {
  std::array<std::vector<double>, ForceKinds::kCount> change, stiffness;
  double load = 0;  // density times gravity, N/m^3; 0: there is none
};

struct Material {
  ForceModel<double> model;

  Material(const HairMesh& mesh, const BlockPattern& pattern);
  ~Material();

  // Stiffnesses: moduli times each element's share of the hair's volume. With sag_free, rest shifts balance gravity
  // (down the scalp frame's y) in the styled pose: elastic forces equal minus the weight, to a relative residual of
  // 1e-9 unless a kind's maxShift bounds a shift.
  void set(const SimParams& params);

  // How far gravity would draw the styled hair without the balance in use (m, one a vertex); empty: there is none. The
  // next balance is sought from there. start(): set() as near as kFirst iterations come from there, work() goes on;
  // false where there is nothing to start from.
  const std::vector<V3<double>>& sag() const { return start_.empty() ? sag_ : start_; }
  void startFrom(std::vector<V3<double>> sag) { start_ = std::move(sag); }
  bool start(const SimParams& params);

  // Stiffnesses and weight follow at once, the balance by its products. Then outdated() until its own is solved for.
  void follow(const SimParams& params);

  // The mesh has another rest shape (mesh/rest_shape.h). What balanced gravity in the old one serves, by its products,
  // until the new one's balance is solved for: outdated() until then.
  void reshape();

  // Makes the elements anew that the step's input moves.
  void setMoving(std::span<const PinnedVertex> pins);

  // Goes on with the solve for the balance of the last parameters by up to kSlice iterations, fewer of large hair;
  // answers whether `model` has just changed. A parameter that changes meanwhile lets the solve finish and begin again.
  static constexpr int kSlice = 32, kFirst = 16;
  bool work();
  bool outdated() const { return memory_.outdated || solving_; }

  // What the above have come to: model and solve follow from it. recall() remakes them where they are another's, and
  // answers whether they were.
  const MaterialMemory& memory() const { return memory_; }
  bool recall(const MaterialMemory& memory);

 private:
  const HairMesh* mesh_;
  const BlockPattern* pattern_;
  SimParams params_;
  std::array<std::vector<double>, ForceKinds::kCount> unloaded_;  // shifts before any balance
  RestBalance balance_, coming_;
  std::vector<V3<double>> sag_, start_;
  MaterialMemory memory_;
  struct Solve;  // that of `coming_`; kept while sliders are dragged
  std::unique_ptr<Solve> solve_;
  bool solving_ = false;

  double wantedLoad() const { return params_.sag_free ? params_.density * params_.gravity : 0; }
  void rebuild();
  void beginAnew(const SimParams& params);
  void beginBalance();
  bool continueBalance(int iterations);
  void takeChanges();
  void applyBalance();
};

}  // namespace sim

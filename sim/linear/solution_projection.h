// A nearer start for the linear solve of a step: motion is smooth, so the velocity changes much as it did in the steps
// before. The start is moved by that combination of their changes of velocity which lowers the energy norm of the error
// most (projection onto earlier solutions, after Fischer 1998). It costs a product a change and saves up to half the
// iterations: the part of the answer that it finds is the smooth one, on which iterations are slow. Earlier
// steps' errors come with it, and cost more than is won unless the solve stays conjugate to them (deflation).
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "sim/linear/modified_pcg.h"
#include "sim/mesh/hair_memory.h"

namespace sim {

template <class T>
struct SolutionProjection {
  // Measured on head shakes and walks: the second halves the error that the first leaves, more do not pay.
  static constexpr int kChanges = 2;

  explicit SolutionProjection(int vertices);

  // Takes the change of velocity (m/s) that a step made of every vertex, as a function of its number. All but the last
  // kChanges are forgotten.
  template <class Change>
  void record(const Change& change) {
    memory.newest = (memory.newest + 1) % kChanges;
    std::vector<Vec3>& newest = memory.changes[memory.newest];
    newest.resize(directions_[0].size());
    for (std::size_t i = 0; i < newest.size(); ++i) {
      const V3<T> moved = change(i);
      newest[i] = Vec3(moved.x, moved.y, moved.z);
    }
    memory.recorded = memory.recorded < kChanges ? memory.recorded + 1 : kChanges;
  }

  // y = A x.
  using Product = std::function<void(std::span<const V3<T>> x, std::span<V3<T>> y)>;
  // Moves x within the filter's free directions and keeps r = b - A x true: r then says nothing along the directions
  // of deflation(). Returns by how much (J) the squared energy norm of the error has become less. Allocates nothing,
  // if the making of the product does not.
  double improve(const Product& a, const Filter<T>& filter, std::span<V3<T>> x, std::span<V3<T>> r);
  // The same along x itself, within its free directions. What an unfinished solve leaves in a velocity, stiff hair
  // answers with forces many times as large; begun from a velocity farther off than none at all, the next one ends
  // with as much of it, and the hair trembles for ever.
  void shorten(const Product& a, const Filter<T>& filter, std::span<V3<T>> x, std::span<V3<T>> r);
  // What it looked along: for the solve, which finds the answer in fewer iterations when it goes on looking there.
  // Valid until the next call.
  std::span<const Deflated<T>> deflation() const { return {deflated_.data(), static_cast<std::size_t>(used_)}; }

  ProjectionMemory memory;  // of the hair that is solved for

 private:
  using Field = std::vector<V3<T>>;
  std::array<Field, kChanges> directions_, products_;
  std::array<Deflated<T>, kChanges> deflated_;
  int used_ = 0;
};

}  // namespace sim

#include "sim/linear/solution_projection.h"

#include <algorithm>

#include "sim/linear/vector_kernels.h"

namespace sim {
namespace {

constexpr double kIndependent = 1e-5;  // of a change's energy, that must be left when the others' share is taken out

}  // namespace

template <class T>
SolutionProjection<T>::SolutionProjection(int vertices) {
  for (auto* fields : {&directions_, &products_}) {
    for (Field& field : *fields) field.resize(vertices);
  }
}

template <class T>
double SolutionProjection<T>::improve(const Product& a, const Filter<T>& filter, std::span<V3<T>> x,
                                      std::span<V3<T>> r) {
  double gained = 0;
  used_ = 0;
  for (int k = 0; k < memory.recorded; ++k) {
    const std::span<V3<T>> d(directions_[used_]), q(products_[used_]);
    const std::vector<Vec3>& change = memory.changes[(memory.newest + kChanges - k) % kChanges];
    for (std::size_t i = 0; i < d.size(); ++i)
      d[i] = {static_cast<T>(change[i].x()), static_cast<T>(change[i].y()), static_cast<T>(change[i].z())};
    filter.apply(d);
    // Conjugate to the others before the product, which then is that of what is left of it to the last bit; and once
    // more, for where little is left, rounding has spoilt it.
    double shared = 0;
    for (int pass = 0; pass < 2; ++pass) {
      for (const Deflated<T>& one : deflation()) {
        const double along = innerProduct<T>(one.q, d);
        addScaled<T>(static_cast<T>(-along / one.energy), one.x, d);
        shared += along * along / one.energy;
      }
    }
    a(d, q);
    const double energy = innerProduct<T>(d, q), along = innerProduct<T>(d, r);
    // Nothing has moved, or not otherwise than before: what is left would be noise. Or a value is not finite.
    if (!(energy > kIndependent * shared)) continue;
    deflated_[used_++] = {d, q, energy};
    const T step = static_cast<T>(along / energy);
    addScaled<T>(step, d, x);
    addScaled<T>(-step, q, r);
    gained += along * along / energy;
  }
  return gained;
}

template <class T>
void SolutionProjection<T>::shorten(const Product& a, const Filter<T>& filter, std::span<V3<T>> x, std::span<V3<T>> r) {
  const std::span<V3<T>> d(directions_[0]), q(products_[0]);
  std::copy(x.begin(), x.end(), d.begin());
  filter.apply(d);
  a(d, q);
  const double energy = innerProduct<T>(d, q);
  if (!(energy > 0)) return;
  const T step = static_cast<T>(innerProduct<T>(d, r) / energy);
  addScaled<T>(step, d, x);
  addScaled<T>(-step, q, r);
}

template struct SolutionProjection<float>;
template struct SolutionProjection<double>;

}  // namespace sim

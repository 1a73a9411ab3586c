#include "sim/forces/evaluate.h"

namespace sim {

template <class T>
T evaluate(const ForceModel<T>& model, std::span<const V3<T>> x, const Evaluation<T>& out) {
  T energy = 0;
  model.forEach([&](const auto& elements) { evaluateElements(elements, BlockSums<T>{x, out}, energy); });
  return energy;
}

template float evaluate(const ForceModel<float>&, std::span<const V3<float>>, const Evaluation<float>&);
template double evaluate(const ForceModel<double>&, std::span<const V3<double>>, const Evaluation<double>&);

}  // namespace sim

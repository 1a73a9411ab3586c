// The curve that strands follow along the layers of a column: uniform Catmull-Rom; beyond the ends its points are
// mirrored. The shaders' is in shaders/common, with slopes.
#pragma once

#include <algorithm>

namespace render {

// The curve's point at s, in layers from 0 to `layers` - 1; `point` gives those of the layers. At least two of them.
template <class Vector, class Point>
Vector onLayers(const Point& point, int layers, typename Vector::Scalar s) {
  using Scalar = typename Vector::Scalar;
  const int layer = std::clamp(static_cast<int>(s), 0, layers - 2);
  const Scalar f = s - static_cast<Scalar>(layer);
  const Vector p1 = point(layer), p2 = point(layer + 1);
  const Vector p0 = layer > 0 ? Vector(point(layer - 1)) : Vector(2 * p1 - p2);
  const Vector p3 = layer + 2 < layers ? Vector(point(layer + 2)) : Vector(2 * p2 - p1);
  const Vector c1 = Scalar(0.5) * (p2 - p0), c2 = p0 - Scalar(2.5) * p1 + 2 * p2 - Scalar(0.5) * p3,
               c3 = Scalar(1.5) * (p1 - p2) + Scalar(0.5) * (p3 - p0);
  return p1 + f * (c1 + f * (c2 + f * c3));
}

}  // namespace render

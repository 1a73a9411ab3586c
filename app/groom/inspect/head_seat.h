// How roots of hair come to lie on a head.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "app/groom/inspect/groom_inspect.h"

namespace app {

// m, in the median over the roots.
float offHead(const HeadModel& head, const std::vector<Eigen::Vector3f>& roots);

// m, the shift that brings the roots onto the head: along the distance's gradient, again and again. center: of the
// skull that they lie about.
Eigen::Vector3f moveToHead(const HeadModel& head, const std::vector<Eigen::Vector3f>& roots,
                           const Eigen::Vector3f& center);

// The size, of a third less to two thirds more, in which roots of hair all over a scalp come much closer to the head
// when they are moved there as well. 1 where none does: heads differ in shape, and hair keeps its size then.
float scaleToHead(const HeadModel& head, const std::vector<Eigen::Vector3f>& roots, const Eigen::Vector3f& center);

}  // namespace app

// How roots of hair come to lie on a head.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "app/groom/inspect/groom_inspect.h"

namespace app {

// m, in the median over the roots.
float offHead(const HeadModel& head, const std::vector<Eigen::Vector3f>& roots);

// m, the shift that brings the roots onto the head: along the distance's gradient, again and again. center: of the
// skull that they lie about.
Eigen::Vector3f moveToHead(const HeadModel& head, const std::vector<Eigen::Vector3f>& roots,
                           const Eigen::Vector3f& center, int rounds = 20);

// The same of roots turned by `matrix`, and moved to the head. center: of the skull, before.
float offHeadTurned(const HeadModel& head, std::vector<Eigen::Vector3f> roots, const Eigen::Vector3f& center,
                    const Eigen::Matrix3f& matrix);

// Axes that may be up in a file, as --up has them.
inline constexpr std::array<std::string_view, 6> kUps{"y", "z", "-y", "-z", "x", "-x"};

// How much each of kUps is up. Hair grows on the upper side of a skull (cap: the mean direction of the roots from its
// middle) and hangs down (hang: the mean way from root to tip, over their length); -infinity where the roots would lie
// on the underside. Hair that stands away from where it grows, as a mohawk's or stubble, says nothing of down.
std::array<float, kUps.size()> upsByHang(const Eigen::Vector3f& cap, const Eigen::Vector3f& hang,
                                         const Eigen::Matrix3f& told);

// How far (m) roots all over a head are off it with each of kUps, faced as fits best: a head is longer than wide. told:
// the file's axes to those in which roots are.
std::array<float, kUps.size()> upsOnHead(const HeadModel& head, const std::vector<Eigen::Vector3f>& roots,
                                         const Eigen::Vector3f& center, const Eigen::Matrix3f& told);
// Whether roots that are off the head by so much (m) lie on it, and those with the other number do not.
bool farBetter(float off, float other);

// Whether roots about this middle (m) lie about the head of the figure as it stands in the world.
bool standsInWorld(const HeadModel& head, const Eigen::Vector3f& center);
// The one of kUps with which they do; nothing where none or several do.
std::optional<std::size_t> standingUp(const HeadModel& head, const Eigen::Vector3f& center,
                                      const Eigen::Matrix3f& told);

// Degrees about y, turned by which they lie on it by far better than as they are; 0 where there are none.
double turnOnHead(const HeadModel& head, const std::vector<Eigen::Vector3f>& roots, const Eigen::Vector3f& center);

// The size, of a third less to two thirds more, in which roots of hair all over a scalp come much closer to the head
// when they are moved there as well. 1 where none does: heads differ in shape, and hair keeps its size then.
float scaleToHead(const HeadModel& head, const std::vector<Eigen::Vector3f>& roots, const Eigen::Vector3f& center);

}  // namespace app

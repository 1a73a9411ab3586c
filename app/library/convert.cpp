#include "app/library/convert.h"

#include <cmath>
#include <cstring>

namespace app::library {
namespace {

constexpr double kNormError = 1e-4;  // of a rotation's quaternion

// Bytes of an element.
std::size_t sizeOf(hm_type type, int numbers) {
  return (type == HM_FLOAT32 ? sizeof(float) : sizeof(double)) * static_cast<std::size_t>(numbers);
}

std::size_t strideOf(std::size_t stride, hm_type type, int numbers) {
  return stride != 0 ? stride : sizeOf(type, numbers);
}

// `type` may be any number that a program in C has put there: it is not read as an enumerator before it is known to be
// one.
template <class Array>
void checkLayout(const Array& array, std::size_t needed, int numbers, const char* name) {
  int number = 0;
  static_assert(sizeof number == sizeof array.type);
  std::memcpy(&number, &array.type, sizeof number);
  if (number != HM_FLOAT32 && number != HM_FLOAT64)
    throw Fault{HM_ERROR_ARGUMENT, std::string(name) + ".type is none of HM_FLOAT32 and HM_FLOAT64"};
  if (const std::size_t size = sizeOf(array.type, numbers); array.stride != 0 && array.stride < size)
    throw Fault{HM_ERROR_ARGUMENT, std::string(name) + ".stride is " + std::to_string(array.stride) +
                                       " bytes, and an element takes " + std::to_string(size) +
                                       "; give at least that, or 0 where they lie side by side"};
  if (array.count != needed)
    throw Fault{HM_ERROR_SIZE, std::string(name) + " has " + std::to_string(array.count) + " elements; " +
                                   std::to_string(needed) + " are needed"};
  if (!array.data && needed > 0) throw Fault{HM_ERROR_ARGUMENT, std::string(name) + ".data is NULL; give an array"};
}

// m, m/s or rad/s: beyond it squares of differences lose what is seen of a hair.
constexpr double kFarthest = 1e7;

bool usable(const Vec3& numbers) {
  return numbers.cwiseAbs().maxCoeff() <= kFarthest && numbers.allFinite();
}

Vec3 finiteVector(const double* numbers, const Place& place, const char* field) {
  const Vec3 vector(numbers[0], numbers[1], numbers[2]);
  if (!usable(vector)) throw Fault{HM_ERROR_VALUE, place.text(field) + " is not finite or beyond 1e7; give SI units"};
  return vector;
}

Eigen::Quaterniond rotationOf(const double* numbers, const Place& place, const char* field) {
  const Eigen::Quaterniond rotation(numbers[3], numbers[0], numbers[1], numbers[2]);
  if (!(std::abs(rotation.norm() - 1) <= kNormError))
    throw Fault{HM_ERROR_VALUE, place.text(field) + " is no unit quaternion x, y, z, w; normalize it"};
  return rotation;
}

}  // namespace

void readElement(const hm_array& array, std::size_t index, int count, double* numbers) {
  const auto* at = static_cast<const char*>(array.data) + index * strideOf(array.stride, array.type, count);
  if (array.type == HM_FLOAT64) {
    std::memcpy(numbers, at, sizeof(double) * static_cast<std::size_t>(count));
    return;
  }
  for (int k = 0; k < count; ++k) {
    float value = 0;
    std::memcpy(&value, at + sizeof(float) * static_cast<std::size_t>(k), sizeof value);
    numbers[k] = value;
  }
}

void writeElement(const hm_target& target, std::size_t index, int count, const double* numbers) {
  auto* at = static_cast<char*>(target.data) + index * strideOf(target.stride, target.type, count);
  if (target.type == HM_FLOAT64) {
    std::memcpy(at, numbers, sizeof(double) * static_cast<std::size_t>(count));
    return;
  }
  for (int k = 0; k < count; ++k) {
    const auto value = static_cast<float>(numbers[k]);
    std::memcpy(at + sizeof(float) * static_cast<std::size_t>(k), &value, sizeof value);
  }
}

void checkArray(const hm_array& array, std::size_t count, const char* name) {
  checkLayout(array, count, 3, name);
}

void checkTarget(const hm_target& target, std::size_t count, int numbers, const char* name) {
  checkLayout(target, count, numbers, name);
}

Vec3 pointOf(const hm_array& array, std::size_t index, const char* name) {
  double numbers[3];
  readElement(array, index, 3, numbers);
  const Vec3 point(numbers[0], numbers[1], numbers[2]);
  if (!usable(point))
    throw Fault{HM_ERROR_VALUE,
                Place{name, static_cast<std::ptrdiff_t>(index)}.text("") + " is not finite or beyond 1e7; give metres"};
  return point;
}

std::string Place::text(const char* field) const {
  std::string text = name;
  if (index >= 0) text.append("[").append(std::to_string(index)).append("]");
  if (*field) text.append(".").append(field);
  return text;
}

Eigen::Isometry3d poseOf(const hm_pose& pose, const Place& place) {
  Eigen::Isometry3d placed = Eigen::Isometry3d::Identity();
  placed.linear() = rotationOf(pose.rotation, place, "rotation").normalized().toRotationMatrix();
  placed.translation() = finiteVector(pose.position, place, "position");
  return placed;
}

sim::Ellipsoid ellipsoidOf(const hm_ellipsoid& given, const Place& place) {
  sim::Ellipsoid ellipsoid;
  ellipsoid.center = finiteVector(given.pose.position, place, "pose.position");
  ellipsoid.rotation = rotationOf(given.pose.rotation, place, "pose.rotation");
  ellipsoid.radii = finiteVector(given.radii, place, "radii");
  ellipsoid.velocity = finiteVector(given.velocity, place, "velocity");
  ellipsoid.angular_velocity = finiteVector(given.angular_velocity, place, "angular_velocity");
  if (!(ellipsoid.radii.minCoeff() > 0))
    throw Fault{HM_ERROR_VALUE, place.text("radii") + " are not all above 0; leave the ellipsoid out instead"};
  return ellipsoid;
}

sim::PinnedVertex pinOf(const hm_pin& given, int vertices, const Place& place) {
  if (given.vertex < 0 || given.vertex >= vertices)
    throw Fault{HM_ERROR_ARGUMENT, place.text("vertex") + " is " + std::to_string(given.vertex) +
                                       "; the hair mesh has vertices 0 to " + std::to_string(vertices - 1)};
  if (!(given.stiffness >= 0))
    throw Fault{HM_ERROR_VALUE, place.text("stiffness") + " is no number from 0 on; INFINITY pins firmly"};
  return {given.vertex, finiteVector(given.target, place, "target"), finiteVector(given.velocity, place, "velocity"),
          given.stiffness};
}

}  // namespace app::library

// Eight or sixteen numbers at once: the compiler's vector type, and the few functions that the condition functions need
// of it and of plain numbers alike. One source of each formula serves the scalar reference and the vectorized kernels.
#pragma once

#include <cmath>
#include <cstddef>
#include <new>
#include <type_traits>
#include <vector>

// Kernels are compiled for several instruction sets, and the widest that the processor has is picked when the program
// starts. Sanitizers run the resolvers too early, other compilers and processors do not know them: these get the plain
// code. All that a kernel calls must be inlined into it, else it would be compiled for the smallest set. A test that
// wants one set says so by defining the macro itself.
#if defined(HAIRMESH_CLONES)
#elif defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    defined(__OPTIMIZE__)
#define HAIRMESH_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define HAIRMESH_CLONES
#endif
#define HAIRMESH_INLINE [[gnu::always_inline]] inline

namespace sim {

inline constexpr int kLanes = 8;

template <class T, int kCount = kLanes>
struct LaneOf {
  typedef T Type __attribute__((vector_size(kCount * sizeof(T))));
};
template <class T, int kCount = kLanes>
using Lanes = typename LaneOf<T, kCount>::Type;
// One register of the widest processors, two of the others: for kernels that are bound by their instructions.
inline constexpr int kWideLanes = 16;

template <class T>
concept Scalar = std::is_floating_point_v<T>;

template <class T>
HAIRMESH_INLINE T constant(double value) {
  if constexpr (Scalar<T>) {
    return static_cast<T>(value);
  } else {
    using Element = std::remove_reference_t<decltype(T{}[0])>;
    return T{} + static_cast<Element>(value);
  }
}

template <class T, int kCount = kLanes>
HAIRMESH_INLINE Lanes<T, kCount> load(const T* from) {
  Lanes<T, kCount> out;
  __builtin_memcpy(&out, from, sizeof out);
  return out;
}
template <class T, int kCount = kLanes>
HAIRMESH_INLINE void store(T* to, const Lanes<T, kCount>& value) {
  __builtin_memcpy(to, &value, sizeof value);
}
template <class T, int kCount = kLanes>
HAIRMESH_INLINE void addTo(T* to, const Lanes<T, kCount>& value) {
  store<T, kCount>(to, load<T, kCount>(to) + value);
}

// Whether a comparison holds in any lane.
template <class Mask>
HAIRMESH_INLINE bool anyOf(const Mask& mask) {
  if constexpr (std::is_integral_v<Mask>) {
    return mask != 0;
  } else {
    static_assert(sizeof mask % sizeof(unsigned long long) == 0);
    unsigned long long words[sizeof mask / sizeof(unsigned long long)], any = 0;
    __builtin_memcpy(words, &mask, sizeof mask);
    for (const unsigned long long word : words) any |= word;
    return any != 0;
  }
}

// `now` moved up by one lane, with the last one of `before` coming in.
template <class T>
HAIRMESH_INLINE Lanes<T> shifted(const Lanes<T>& before, const Lanes<T>& now) {
  return __builtin_shufflevector(before, now, 7, 8, 9, 10, 11, 12, 13, 14);
}

// A vector whose first entry starts a cache line, so that lanes at multiples of kLanes never straddle two.
template <class T>
struct LineAllocator {
  using value_type = T;
  static constexpr std::align_val_t kLine{64};
  LineAllocator() = default;
  template <class U>
  LineAllocator(const LineAllocator<U>&) {}
  T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), kLine)); }
  void deallocate(T* at, std::size_t) { ::operator delete(at, kLine); }
  template <class U>
  bool operator==(const LineAllocator<U>&) const {
    return true;
  }
};
template <class T>
using LineVector = std::vector<T, LineAllocator<T>>;

template <class T>
HAIRMESH_INLINE T squareRoot(T value) {
  if constexpr (Scalar<T>) {
    return std::sqrt(value);
  } else {
    for (int k = 0; k < kLanes; ++k) value[k] = __builtin_sqrt(value[k]);
    return value;
  }
}
template <>
HAIRMESH_INLINE Lanes<float> squareRoot(Lanes<float> value) {
  for (int k = 0; k < kLanes; ++k) value[k] = __builtin_sqrtf(value[k]);
  return value;
}

// atan2(y, x), absolute error below 4e-7 (float) and 1e-14 (double); 0 for (0, 0). The argument is brought to
// |u| <= tan(pi / 8), where the Taylor series converges fast.
template <class T>
HAIRMESH_INLINE T arcTangent2(T y, T x) {
  if constexpr (Scalar<T>) {
    return std::atan2(y, x);
  } else {
    constexpr int kTerms = sizeof(T) / kLanes == 4 ? 9 : 20;
    const T zero = constant<T>(0), one = constant<T>(1);
    const T ax = x < zero ? -x : x, ay = y < zero ? -y : y;
    const T larger = ax > ay ? ax : ay, smaller = ax > ay ? ay : ax;
    const T t = smaller / (larger > zero ? larger : one);
    const auto steep = t > constant<T>(0.41421356237309503);
    const T u = steep ? (t - one) / (t + one) : t;
    const T u2 = u * u;
    T series = constant<T>(0);
    for (int k = kTerms - 1; k >= 0; --k) series = constant<T>((k % 2 ? -1.0 : 1.0) / (2 * k + 1)) + u2 * series;
    T angle = u * series;
    angle = steep ? angle + constant<T>(0.78539816339744831) : angle;
    angle = ay > ax ? constant<T>(1.5707963267948966) - angle : angle;
    angle = x < zero ? constant<T>(3.14159265358979324) - angle : angle;
    return y < zero ? -angle : angle;
  }
}

}  // namespace sim

// Values as bytes, field by field: numbers, arrays, and structs with HAIRMESH_FIELDS. Little endian.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <tuple>
#include <type_traits>
#include <vector>

#include "sim/sim_params.h"

namespace sim {

static_assert(std::endian::native == std::endian::little, "saved states are little endian");

using Bytes = std::vector<std::byte>;

// One number, or so many that the type says how many.
template <class T>
concept Numbers = std::is_arithmetic_v<T> || std::is_same_v<T, std::byte> || std::is_same_v<T, Eigen::Quaterniond> ||
    std::is_same_v<T, Eigen::Isometry3d> || requires {
  T::SizeAtCompileTime;
};

template <class T>
concept Array = requires(T& values) {
  values.emplace_back();
};

template <class T>
concept FixedArray = requires(T& values) {
  values.fill(values[0]);
}
&&!Numbers<T>;

// Calls act with each part of a tuple or of a struct with fields, in order.
template <class T>
void eachField(T& value, auto&& act) {
  const auto all = [&](auto&... field) { (act(field), ...); };
  if constexpr (requires { T::fields(value); }) {
    std::apply(all, T::fields(value));
  } else {
    std::apply(all, value);
  }
}

template <class T>
void writeBytes(const T& value, Bytes& out) {
  if constexpr (Numbers<T>) {
    const auto bytes = std::as_bytes(std::span(&value, 1));
    out.insert(out.end(), bytes.begin(), bytes.end());
  } else if constexpr (FixedArray<T>) {
    for (const auto& one : value) writeBytes(one, out);
  } else if constexpr (Array<T>) {
    writeBytes(std::uint64_t{value.size()}, out);
    for (const auto& one : value) writeBytes(one, out);
  } else if constexpr (std::is_same_v<T, SimParams>) {
    for (const ParamField& field : paramFields()) writeBytes(field.get(value), out);
  } else {
    eachField(value, [&](const auto& field) { writeBytes(field, out); });
  }
}

// What is left to be read; all of it is gone once something was missing.
struct ByteReader {
  std::span<const std::byte> left;
  bool complete = true;

  bool take(void* to, std::size_t size) {
    if (left.size() < size) {
      complete = false, left = {};
      return false;
    }
    std::memcpy(to, left.data(), size);
    left = left.subspan(size);
    return true;
  }
};

template <class T>
void readBytes(ByteReader& from, T& value) {
  if constexpr (std::is_same_v<T, bool>) {
    unsigned char byte = 0;
    from.take(&byte, 1);
    value = byte != 0;
  } else if constexpr (Numbers<T>) {
    from.take(static_cast<void*>(&value), sizeof(T));
  } else if constexpr (FixedArray<T>) {
    for (auto& one : value) readBytes(from, one);
  } else if constexpr (Array<T>) {
    std::uint64_t count = 0;
    readBytes(from, count);
    value.clear();
    // One by one: a count that promises more than there is must not take memory.
    for (std::uint64_t i = 0; i < count && from.complete; ++i) readBytes(from, value.emplace_back());
  } else if constexpr (std::is_same_v<T, SimParams>) {
    for (const ParamField& field : paramFields()) {
      double number = 0;
      readBytes(from, number);
      // Limits may have taken a number beyond its slider's range; a choice beyond its own has no meaning.
      const bool fits = field.kind == FieldKind::kReal || (number >= field.minimum && number <= field.maximum);
      if (!fits) from.complete = false;
      if (fits) field.set(value, number);
    }
  } else {
    eachField(value, [&](auto& field) { readBytes(from, field); });
  }
}

// FNV-1a.
inline std::uint64_t fingerprint(std::span<const std::byte> bytes) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const std::byte byte : bytes) hash = (hash ^ static_cast<std::uint64_t>(byte)) * 0x100000001b3ull;
  return hash;
}

}  // namespace sim

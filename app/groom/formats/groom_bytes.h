// Bytes of groom files: little-endian numbers in and out, and the bounds that every reader holds.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace app {

static_assert(std::endian::native == std::endian::little, "numbers of the formats are copied as they are");

// What one groom may hold; a groom with every array takes 48 bytes a point. Five million strands of six points fit.
inline constexpr std::size_t kMaxGroomPoints = std::size_t{32} << 20;
inline constexpr std::size_t kMaxGroomFile = std::size_t{2} << 30;  // bytes; text of as many points with its widths

// Throws InputError, which names how many strands of this file fit, when `points` are more than kMaxGroomPoints.
void checkGroomSize(const std::string& file, const std::string& place, std::size_t strands, std::size_t points);

// A cursor over a binary file. Nothing is copied but what is asked for; nothing is allocated beyond what the file
// holds.
struct ByteReader {
  std::string_view bytes;
  std::string file;  // names the bytes in messages
  std::size_t at = 0;

  std::size_t left() const { return bytes.size() - at; }

  // The next number; `what` names it in the message. Throws InputError at the end of the bytes.
  template <class Number>
  Number number(const char* what) {
    static_assert(std::is_trivially_copyable_v<Number>);
    need(1, sizeof(Number), what);
    Number value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    at += sizeof value;
    return value;
  }

  // The next `count` elements into `all`, which is sized once it is known that the file holds them. Throws InputError.
  template <class Element>
  void array(std::size_t count, const char* what, std::vector<Element>& all) {
    need(count, sizeof(Element), what);
    all.resize(count);
    if (count > 0) std::memcpy(static_cast<void*>(all.data()), bytes.data() + at, count * sizeof(Element));
    at += count * sizeof(Element);
  }

  // Goes to an offset from the file's start. Throws InputError when it lies outside.
  void seek(std::size_t offset, const char* what);
  // Throws InputError when less than `count` elements of `size` bytes are left.
  void need(std::size_t count, std::size_t size, const char* what) const;
  [[noreturn]] void fail(const std::string& fault, const std::string& mend) const;
};

// The bytes of a number or an array, as OutputFile takes them.
template <class Number>
std::string_view bytesOf(const Number& number) {
  static_assert(std::is_trivially_copyable_v<Number>);
  return {reinterpret_cast<const char*>(&number), sizeof number};
}
template <class Element>
std::string_view bytesOf(const std::vector<Element>& all) {
  return {reinterpret_cast<const char*>(all.data()), all.size() * sizeof(Element)};
}

}  // namespace app

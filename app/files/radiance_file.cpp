#include "app/files/radiance_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "app/files/errors.h"
#include "app/files/text_file.h"

namespace app {
namespace {

constexpr int kMaxPanoramaSide = 8192;                      // pixels
constexpr int kNarrowestPacked = 8, kWidestPacked = 32767;  // pixels: rows of other widths are never packed
constexpr int kBias = 136;                                  // of the exponent, with the eight bits of the mantissa

// A library that Debian has reads such files too (stb_image 2.27), and never ends on one that is broken off.
class Reader {
 public:
  Reader(const std::string& file, std::string_view bytes) : file_(file), bytes_(bytes) {}

  RadiancePicture read() {
    readHeader();
    RadiancePicture picture{width_, height_, std::vector<float>(static_cast<std::size_t>(width_) * height_ * 3)};
    std::vector<std::array<unsigned char, 4>> row(width_);
    float* out = picture.rgb.data();
    for (row_ = 0; row_ < height_; ++row_) {
      readRow(row);
      for (const std::array<unsigned char, 4>& pixel : row) {
        for (int c = 0; c < 3; ++c)
          *out++ = pixel[3] == 0 ? 0.0f : std::ldexp(static_cast<float>(pixel[c]), pixel[3] - kBias);
      }
    }
    return picture;
  }

 private:
  [[noreturn]] void refuse(const std::string& place, const std::string& fault, const std::string& mend) const {
    throw InputError(file_, place, fault, mend);
  }

  std::string_view line() {
    const std::size_t end = bytes_.find('\n', at_);
    if (end == std::string_view::npos || end - at_ > 1000)
      refuse("header", "does not end", "save it again as .hdr (RGBE)");
    const std::string_view text = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    return text;
  }

  void readHeader() {
    if (!bytes_.starts_with("#?"))
      refuse("first line", "is no Radiance picture's", "name a panorama saved as .hdr (RGBE)");
    bool rgbe = false;
    for (std::string_view text = line(); !text.empty(); text = line()) rgbe |= text == "FORMAT=32-bit_rle_rgbe";
    if (!rgbe) refuse("header", "lacks FORMAT=32-bit_rle_rgbe", "save it again as .hdr (RGBE)");
    const std::string size(line());
    int end = 0;
    const bool read = std::sscanf(size.c_str(), "-Y %9d +X %9d%n", &height_, &width_, &end) == 2;
    if (!read || end != static_cast<int>(size.size()) || width_ < 1 || height_ < 1)
      refuse("size", "is not -Y HEIGHT +X WIDTH", "save it with the top row first and each row from the left");
    if (std::max(width_, height_) > kMaxPanoramaSide)
      refuse("size", "is larger than 8192 pixels a side", "scale it down, 1024x512 is enough");
  }

  unsigned char byte() {
    if (at_ >= bytes_.size()) refuse("row " + std::to_string(row_), "is broken off", "copy or save the file again");
    return static_cast<unsigned char>(bytes_[at_++]);
  }

  void readRow(std::vector<std::array<unsigned char, 4>>& row) {
    std::array<unsigned char, 4> first{};
    for (unsigned char& b : first) b = byte();
    const bool packed =
        width_ >= kNarrowestPacked && width_ <= kWidestPacked && first[0] == 2 && first[1] == 2 && first[2] < 128;
    if (!packed) {
      row[0] = first;
      for (std::size_t i = 1; i < row.size(); ++i)
        for (unsigned char& b : row[i]) b = byte();
      return;
    }
    if (first[2] * 256 + first[3] != width_) refuseRow();
    for (int c = 0; c < 4; ++c) unpack(c, row);
  }

  // One channel of a row: runs of one value (128 and their length, the value), and stretches that differ (their length,
  // the values).
  void unpack(int channel, std::vector<std::array<unsigned char, 4>>& row) {
    for (std::size_t i = 0; i < row.size();) {
      const unsigned char code = byte();
      const bool run = code > 128;
      const std::size_t count = run ? code - 128 : code;
      if (count == 0 || count > row.size() - i) refuseRow();
      const unsigned char value = run ? byte() : 0;
      for (std::size_t end = i + count; i < end; ++i) row[i][channel] = run ? value : byte();
    }
  }

  [[noreturn]] void refuseRow() const {
    refuse("row " + std::to_string(row_), "is packed for another width", "copy or save the file again");
  }

  const std::string& file_;
  std::string_view bytes_;
  std::size_t at_ = 0;
  int width_ = 0, height_ = 0, row_ = 0;
};

}  // namespace

RadiancePicture readRadiance(const std::string& file) {
  const std::string bytes = readText(file, std::size_t{400} << 20);
  return Reader(file, bytes).read();
}

}  // namespace app

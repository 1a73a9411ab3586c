// Pictures in, PNG files out.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace app {

// 8-bit RGBA sRGB, top row first, width * height * 4 bytes.
struct Image {
  int width = 0, height = 0;
  std::vector<unsigned char> rgba;
};

// Writes a PNG (alpha left out when every pixel is opaque). Throws OutputError.
void writePng(const std::string& file, int width, int height, std::span<const unsigned char> rgba);

// The same as bytes.
std::string pngBytes(int width, int height, std::span<const unsigned char> rgba);

// Reads a PNG of those bytes; `name` is for messages. Throws InputError.
Image readPngBytes(std::string_view bytes, const std::string& name);

// Reads a PNG, JPEG, TGA or BMP of those bytes. Throws InputError, also where a side is longer than `max_side` pixels.
Image readPictureBytes(std::string_view bytes, const std::string& name, int max_side);

// Reads a PNG. Throws InputError when it is missing, broken or larger than 16,384 pixels a side.
Image readPng(const std::string& file);

}  // namespace app

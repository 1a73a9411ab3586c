// PNG files in and out.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace app {

// 8-bit RGBA sRGB, top row first, width * height * 4 bytes.
struct Image {
  int width = 0, height = 0;
  std::vector<unsigned char> rgba;
};

// Writes a PNG (alpha left out when every pixel is opaque). Throws OutputError.
void writePng(const std::string& file, int width, int height, std::span<const unsigned char> rgba);

// Reads a PNG. Throws InputError when it is missing, broken or larger than 16,384 pixels a side.
Image readPng(const std::string& file);

}  // namespace app

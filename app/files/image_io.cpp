#include "app/files/image_io.h"

#include <algorithm>
#include <cassert>
#include <climits>
#include <cstddef>
#include <filesystem>
#include <memory>

#include "app/files/errors.h"
#include "app/files/output_file.h"
#include "app/files/text_file.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wsign-compare"
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_TGA
#define STBI_ONLY_BMP
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace app {
namespace {

constexpr int kMaxSide = 16384;
constexpr std::size_t kLargestPng = std::size_t{1} << 30;

bool isOpaque(std::span<const unsigned char> rgba) {
  for (std::size_t i = 3; i < rgba.size(); i += 4) {
    if (rgba[i] != 255) return false;
  }
  return true;
}

}  // namespace

std::string pngBytes(int width, int height, std::span<const unsigned char> rgba) {
  assert(width > 0 && height > 0 && rgba.size() == static_cast<std::size_t>(width) * height * 4);
  std::string png;
  const auto append = [](void* text, void* bytes, int size) {
    static_cast<std::string*>(text)->append(static_cast<const char*>(bytes), static_cast<std::size_t>(size));
  };
  if (isOpaque(rgba)) {
    std::vector<unsigned char> rgb(static_cast<std::size_t>(width) * height * 3);
    for (std::size_t i = 0; i < rgb.size() / 3; ++i) {
      for (int c = 0; c < 3; ++c) rgb[3 * i + c] = rgba[4 * i + c];
    }
    stbi_write_png_to_func(append, &png, width, height, 3, rgb.data(), 3 * width);
  } else {
    stbi_write_png_to_func(append, &png, width, height, 4, rgba.data(), 4 * width);
  }
  return png;
}

void writePng(const std::string& file, int width, int height, std::span<const unsigned char> rgba) {
  const std::string png = pngBytes(width, height, rgba);
  if (png.empty()) throw OutputError(file, "cannot be encoded as PNG", "free some memory");
  writeFile(file, png);
}

Image readPictureBytes(std::string_view bytes, const std::string& name, int max_side) {
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const int size = static_cast<int>(std::min<std::size_t>(bytes.size(), INT_MAX));
  Image image;
  int channels = 0;
  const bool known = stbi_info_from_memory(data, size, &image.width, &image.height, &channels) != 0;
  if (known && (image.width > max_side || image.height > max_side)) {
    throw InputError(name, "size", "is larger than " + std::to_string(max_side) + " pixels a side",
                     "scale the image down");
  }
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      known ? stbi_load_from_memory(data, size, &image.width, &image.height, &channels, 4) : nullptr, stbi_image_free);
  if (!pixels) throw InputError(name, "image data", "is not a readable picture", "save it again as PNG");
  image.rgba.assign(pixels.get(), pixels.get() + static_cast<std::size_t>(image.width) * image.height * 4);
  return image;
}

Image readPngBytes(std::string_view bytes, const std::string& name) {
  constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
  if (!bytes.starts_with(kSignature))
    throw InputError(name, "image data", "is not a readable PNG", "save it again as PNG");
  return readPictureBytes(bytes, name, kMaxSide);
}

Image readPng(const std::string& file) {
  if (!std::filesystem::is_regular_file(file)) {
    throw InputError(file, "input image", "is not a file", "name an existing PNG file");
  }
  return readPngBytes(readText(file, kLargestPng), file);
}

}  // namespace app

// PNG files as libpng reads them, which writes and reads nothing of the program's.
#include "app/files/image_io.h"

#include <gtest/gtest.h>
#include <png.h>

#include <string>
#include <vector>

#include "tests/run_program.h"

namespace image_io_test {

using Bytes = std::vector<unsigned char>;

// RGBA, top row first; empty, with a failure, where libpng finds fault.
Bytes decoded(const std::string& file, unsigned width, unsigned height) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_file(&image, file.c_str()), 0) << image.message;
  EXPECT_EQ(image.width, width);
  EXPECT_EQ(image.height, height);
  image.format = PNG_FORMAT_RGBA;
  Bytes rgba(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, rgba.data(), 0, nullptr), 0) << image.message;
  png_image_free(&image);
  return rgba;
}

// Every pixel tells its place: red the column, green the row, blue their product.
Bytes picture(int width, int height, bool opaque) {
  Bytes rgba;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (const int value : {3 * x + 1, 5 * y + 2, x * y, opaque ? 255 : 40 + x + y})
        rgba.push_back(static_cast<unsigned char>(value));
    }
  }
  return rgba;
}

TEST(ImageIo, PixelsLieInTheFileWhereTheyWereGiven) {
  constexpr int kWidth = 37, kHeight = 23;
  const std::string file = test::freshFolder("png") + "/picture.png";
  for (const bool opaque : {true, false}) {
    const Bytes rgba = picture(kWidth, kHeight, opaque);
    app::writePng(file, kWidth, kHeight, rgba);
    EXPECT_EQ(decoded(file, kWidth, kHeight), rgba);
    const app::Image read = app::readPng(file);
    EXPECT_EQ(read.width, kWidth);
    EXPECT_EQ(read.height, kHeight);
    EXPECT_EQ(read.rgba, rgba);
  }
}

}  // namespace image_io_test

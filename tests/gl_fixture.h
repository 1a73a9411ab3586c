// A context without a window, made once for all tests of an executable; tests skip, saying why, where none can be made.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <string>

#include "app/files/errors.h"
#include "app/platform/egl_context.h"

namespace gl_fixture {

inline const std::string kShaderDir = std::string(HAIRMESH_SOURCE_DIR) + "/shaders";

// Empty when there is a current context, else why there is none.
inline const std::string& contextFault() {
  static std::unique_ptr<app::EglContext> context;
  static const std::string fault = [] {
    try {
      context = std::make_unique<app::EglContext>();
      return std::string();
    } catch (const app::ContextError& error) {
      return std::string(error.what());
    }
  }();
  return fault;
}

class GlTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!contextFault().empty()) GTEST_SKIP() << contextFault();
  }
};

// A copy of the shaders, of this process alone, that a test may add to or break.
inline std::string copyShaders(const std::string& name) {
  const std::string folder = std::string(HAIRMESH_TEST_OUT) + "/" + name + "_" + std::to_string(::getpid());
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  std::filesystem::copy(kShaderDir, folder, std::filesystem::copy_options::recursive);
  return folder;
}

}  // namespace gl_fixture

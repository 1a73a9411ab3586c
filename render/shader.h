// Shader programs from files: #include, defines, messages with file and line, hot reload that keeps the old program.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "render/gl_object.h"

namespace render {

// What a program is made of.
struct ProgramSource {
  std::vector<std::string> files;     // below the shader folder; the ending names the stage: .vert, .geom, .frag, .comp
  std::vector<std::string> defines;   // "NAME VALUE"
  std::vector<std::string> captured;  // transform feedback outputs, interleaved; for tests
};

// A linked program that remembers which files it came from.
class ShaderProgram {
 public:
  ShaderProgram() = default;
  // Compiles and links. Throws std::runtime_error "FILE:LINE: the driver's words" or "FILE: cannot be read".
  ShaderProgram(std::string shader_dir, ProgramSource source);

  GLuint id() const { return program_.id(); }
  void use() const { glUseProgram(program_.id()); }

  // Compiles again when a file has changed since; returns the message on failure (the old program stays), else empty.
  std::string reloadIfChanged();

 private:
  std::string shader_dir_;
  ProgramSource source_;
  Program program_;
  std::vector<std::string> read_files_;
  std::filesystem::file_time_type newest_ = std::filesystem::file_time_type::min();
};

}  // namespace render

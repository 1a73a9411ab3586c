// Shader programs from files: #include, defines, messages with file and line, hot reload that keeps the old program.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include "render/gl/gl_object.h"
#include "render/reload.h"

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

  // Compiles and links again. On failure the old program stays, and is tried again when one of its files changes.
  ReloadReport reload(Reload which);

 private:
  // A file as it was when it was last read.
  struct ReadFile {
    std::string name;
    std::filesystem::file_time_type time;  // min() where it is missing
  };

  // Adds the files it reads to `read`, also when it throws.
  Program build(std::vector<ReadFile>& read) const;
  ReadFile stampOf(const std::string& name) const;

  std::string shader_dir_;
  ProgramSource source_;
  Program program_;
  std::vector<ReadFile> read_files_;
};

// Reloads each program.
ReloadReport reloadPrograms(std::initializer_list<ShaderProgram*> programs, Reload which);

}  // namespace render

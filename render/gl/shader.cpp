#include "render/gl/shader.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <functional>
#include <sstream>
#include <stdexcept>

namespace render {
namespace {

// "common/strand.glsl" of the line `#include "common/strand.glsl"`, empty for any other line.
std::string includedFile(const std::string& line) {
  std::istringstream words(line);
  std::string directive, name, rest;
  words >> directive >> name >> rest;
  const bool includes = directive == "#include" && name.size() > 2 && name.front() == '"' && name.back() == '"';
  return includes && rest.empty() ? name.substr(1, name.size() - 2) : "";
}

// A stage's text with its includes put in, and the files it came from in the order of their #line numbers.
struct ExpandedText {
  std::string text;
  std::vector<std::string> files;
};

struct Expander {
  const std::string& folder;
  std::function<void(const std::string&)> on_file;  // called with each file before it is read
  ExpandedText result;

  // Each file is put in once: included again, it is skipped, so headers need no guards.
  void append(const std::string& name, const std::string& from) {
    if (std::find(result.files.begin(), result.files.end(), name) != result.files.end()) return;
    on_file(name);
    std::ifstream stream(folder + "/" + name);
    if (!stream) {
      const std::string path = folder + "/" + name;
      throw std::runtime_error(from.empty()
                                   ? path + ": cannot be read; restore the shader file"
                                   : from + ": includes " + path + ", which cannot be read; restore that file");
    }
    const std::size_t number = result.files.size();
    result.files.push_back(name);
    std::string line;
    if (number > 0) result.text += "#line 1 " + std::to_string(number) + "\n";
    for (int line_number = 1; std::getline(stream, line); ++line_number) {
      if (const std::string included = includedFile(line); !included.empty()) {
        append(included, folder + "/" + name + ":" + std::to_string(line_number));
        result.text += "#line " + std::to_string(line_number + 1) + " " + std::to_string(number) + "\n";
      } else {
        result.text += line + "\n";
      }
    }
  }
};

GLenum stageOf(const std::string& file) {
  const std::string ending = std::filesystem::path(file).extension().string();
  if (ending == ".vert") return GL_VERTEX_SHADER;
  if (ending == ".geom") return GL_GEOMETRY_SHADER;
  if (ending == ".frag") return GL_FRAGMENT_SHADER;
  if (ending == ".comp") return GL_COMPUTE_SHADER;
  throw std::runtime_error(file + ": unknown shader ending; use .vert, .geom, .frag or .comp");
}

// Puts file names in the place of source numbers. Mesa writes "2:14(5): error", NVIDIA "2(14) : error".
std::string nameFiles(const std::string& log, const std::string& folder, const std::vector<std::string>& files) {
  std::istringstream lines(log);
  std::string line, named;
  while (std::getline(lines, line)) {
    unsigned file = 0, row = 0;
    int length = 0;
    if (std::sscanf(line.c_str(), "%u%*1[:(]%u%n", &file, &row, &length) == 2 && file < files.size()) {
      if (line[length] == ')') ++length;
      line = folder + "/" + files[file] + ":" + std::to_string(row) + line.substr(length);
    }
    if (!line.empty()) named += (named.empty() ? "" : "\n") + line;
  }
  return named;
}

ShaderStage compileStage(const std::string& folder, const std::string& file, const ExpandedText& expanded,
                         const std::vector<std::string>& defines) {
  std::string head = "#version 450 core\n";
  for (const std::string& define : defines) head += "#define " + define + "\n";
  head += "#line 1 0\n";
  const char* texts[] = {head.c_str(), expanded.text.c_str()};
  ShaderStage stage(glCreateShader(stageOf(file)));
  glShaderSource(stage.id(), 2, texts, nullptr);
  glCompileShader(stage.id());
  GLint compiled = GL_FALSE, length = 0;
  glGetShaderiv(stage.id(), GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_TRUE) return stage;
  glGetShaderiv(stage.id(), GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
  glGetShaderInfoLog(stage.id(), length, nullptr, log.data());
  log.resize(log.find('\0') == std::string::npos ? log.size() : log.find('\0'));
  throw std::runtime_error(nameFiles(log, folder, expanded.files));
}

Program linkProgram(const std::vector<ShaderStage>& stages, const ProgramSource& source) {
  Program program(glCreateProgram());
  for (const ShaderStage& stage : stages) glAttachShader(program.id(), stage.id());
  if (!source.captured.empty()) {
    std::vector<const char*> names;
    for (const std::string& name : source.captured) names.push_back(name.c_str());
    glTransformFeedbackVaryings(program.id(), static_cast<GLsizei>(names.size()), names.data(), GL_INTERLEAVED_ATTRIBS);
  }
  glLinkProgram(program.id());
  GLint linked = GL_FALSE, length = 0;
  glGetProgramiv(program.id(), GL_LINK_STATUS, &linked);
  if (linked == GL_TRUE) return program;
  glGetProgramiv(program.id(), GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
  glGetProgramInfoLog(program.id(), length, nullptr, log.data());
  throw std::runtime_error(source.files.front() + ": does not link: " + log.c_str());
}

std::filesystem::file_time_type timeOf(const std::string& file) {
  std::error_code failure;
  const auto time = std::filesystem::last_write_time(file, failure);
  return failure ? std::filesystem::file_time_type::min() : time;
}

}  // namespace

ReloadReport& ReloadReport::operator+=(const ReloadReport& other) {
  programs += other.programs;
  if (fault.empty()) fault = other.fault;
  return *this;
}

ShaderProgram::ShaderProgram(std::string shader_dir, ProgramSource source)
    : shader_dir_(std::move(shader_dir)), source_(std::move(source)) {
  program_ = build(read_files_);
}

ShaderProgram::ReadFile ShaderProgram::stampOf(const std::string& name) const {
  return {name, timeOf(shader_dir_ + "/" + name)};
}

Program ShaderProgram::build(std::vector<ReadFile>& read) const {
  std::vector<ShaderStage> stages;
  for (const std::string& file : source_.files) {
    // The time is taken before the file is read: a change during the reading is found by the next look.
    Expander expander{shader_dir_, [&](const std::string& name) { read.push_back(stampOf(name)); }, {}};
    expander.append(file, "");
    stages.push_back(compileStage(shader_dir_, file, expander.result, source_.defines));
  }
  return linkProgram(stages, source_);
}

ReloadReport ShaderProgram::reload(Reload which) {
  const bool changed = std::any_of(read_files_.begin(), read_files_.end(),
                                   [&](const ReadFile& file) { return stampOf(file.name).time != file.time; });
  if (which == Reload::kChanged && !changed) return {};
  std::vector<ReadFile> read;
  try {
    program_ = build(read);
    read_files_ = std::move(read);
    return {1, {}};
  } catch (const std::runtime_error& error) {
    // Files that this attempt did not come to are watched on: one of them may mend it.
    for (const ReadFile& file : read_files_) {
      if (std::none_of(read.begin(), read.end(), [&](const ReadFile& r) { return r.name == file.name; }))
        read.push_back(stampOf(file.name));
    }
    read_files_ = std::move(read);
    return {0, error.what()};
  }
}

ReloadReport reloadPrograms(std::initializer_list<ShaderProgram*> programs, Reload which) {
  ReloadReport report;
  for (ShaderProgram* program : programs) report += program->reload(which);
  return report;
}

}  // namespace render

#include "render/shader.h"

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace render {
namespace {

// A stage's text with its includes put in, and the files it came from in the order of their #line numbers.
struct ExpandedText {
  std::string text;
  std::vector<std::string> files;
};

struct Expander {
  const std::string& folder;
  ExpandedText result;

  // Each file is put in once: included again, it is skipped, so headers need no guards.
  void append(const std::string& name, const std::string& from) {
    if (std::find(result.files.begin(), result.files.end(), name) != result.files.end()) return;
    std::ifstream stream(folder + "/" + name);
    if (!stream) {
      const std::string path = folder + "/" + name;
      throw std::runtime_error(from.empty()
                                   ? path + ": cannot be read; restore the shader file"
                                   : from + ": includes " + path + ", which cannot be read; restore that file");
    }
    const std::size_t number = result.files.size();
    result.files.push_back(name);
    static const std::regex include_line(R"re(^\s*#include\s+"([^"]+)"\s*$)re");
    std::string line;
    std::smatch match;
    if (number > 0) result.text += "#line 1 " + std::to_string(number) + "\n";
    for (int line_number = 1; std::getline(stream, line); ++line_number) {
      if (std::regex_match(line, match, include_line)) {
        append(match[1], folder + "/" + name + ":" + std::to_string(line_number));
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
  static const std::regex place(R"(^(\d+)[:(](\d+)\)?)");
  std::istringstream lines(log);
  std::string line, named;
  std::smatch match;
  while (std::getline(lines, line)) {
    if (std::regex_search(line, match, place) && std::stoul(match[1]) < files.size()) {
      line = folder + "/" + files[std::stoul(match[1])] + ":" + match[2].str() + match.suffix().str();
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

std::filesystem::file_time_type newestOf(const std::string& folder, const std::vector<std::string>& files) {
  std::filesystem::file_time_type newest = std::filesystem::file_time_type::min();
  for (const std::string& file : files) {
    std::error_code failure;
    const auto time = std::filesystem::last_write_time(folder + "/" + file, failure);
    if (!failure) newest = std::max(newest, time);
  }
  return newest;
}

}  // namespace

ShaderProgram::ShaderProgram(std::string shader_dir, ProgramSource source)
    : shader_dir_(std::move(shader_dir)), source_(std::move(source)) {
  std::vector<ShaderStage> stages;
  for (const std::string& file : source_.files) {
    Expander expander{shader_dir_, {}};
    expander.append(file, "");
    stages.push_back(compileStage(shader_dir_, file, expander.result, source_.defines));
    read_files_.insert(read_files_.end(), expander.result.files.begin(), expander.result.files.end());
  }
  program_ = linkProgram(stages, source_);
  newest_ = newestOf(shader_dir_, read_files_);
}

std::string ShaderProgram::reloadIfChanged() {
  const auto newest = newestOf(shader_dir_, read_files_);
  const bool missing = std::any_of(read_files_.begin(), read_files_.end(), [&](const std::string& file) {
    return !std::filesystem::exists(shader_dir_ + "/" + file);
  });
  if (newest <= newest_ && !missing) return {};
  try {
    *this = ShaderProgram(shader_dir_, source_);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return {};
}

}  // namespace render

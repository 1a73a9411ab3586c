#include "app/files/data_path.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "app/files/errors.h"
#include "sim/field_text.h"

namespace app {

namespace fs = std::filesystem;

std::string dataFolder() {
  if (const char* folder = std::getenv("HAIRMESH_DATA"); folder && *folder) return folder;
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  const fs::path installed = (program.parent_path() / HAIRMESH_INSTALLED_DATA).lexically_normal();
  return fs::is_directory(installed / "shaders", ignored) ? installed.string() : HAIRMESH_SOURCE_DIR;
}

std::string dataPath(const std::string& relative) {
  return (fs::path(dataFolder()) / relative).string();
}

std::string findFile(const std::string& name, const std::string& base_file, const std::string& kind) {
  const fs::path given(name);
  if (given.is_absolute()) return name;
  const fs::path beside = base_file.empty() ? given : fs::path(base_file).parent_path() / given;
  std::error_code ignored;
  for (const fs::path& candidate :
       {beside, fs::path(dataFolder()) / given, fs::path(dataFolder()) / "assets" / kind / given}) {
    if (fs::exists(candidate, ignored)) return candidate.lexically_normal().string();
  }
  return name;
}

std::string foundFile(const std::string& name, const std::string& base_file, const std::string& kind) {
  std::string file = findFile(name, base_file, kind);
  std::error_code ignored;
  if (!fs::exists(file, ignored)) throw InputError(file, "", "there is no such file", missingMend(file));
  return file;
}

std::vector<std::string> listAssets(const std::string& kind, const std::vector<std::string>& endings) {
  std::vector<std::string> files;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(dataPath("assets/" + kind), ignored)) {
    const std::string ending = entry.path().extension().string();
    if (std::find(endings.begin(), endings.end(), ending) != endings.end()) files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string missingMend(const std::string& file) {
  constexpr std::size_t kMostNames = 2000;
  std::vector<std::string> names;
  std::error_code ignored;
  const fs::path folder = fs::path(file).parent_path();
  for (fs::directory_iterator at(folder.empty() ? "." : folder, ignored), end; at != end && names.size() < kMostNames;
       at.increment(ignored))
    names.push_back(at->path().filename().string());
  for (const char* kind : {"scenes", "presets", "clips", "hair", "attachments"}) {
    for (const std::string& asset : listAssets(kind, {".json", ".bvh", ".obj"}))
      names.push_back(fs::path(asset).filename().string());
  }
  // An ending that both have says nothing of what was meant.
  std::vector<std::string_view> candidates;
  for (const std::string& name : names) {
    const std::string meant = stem(name);
    const std::string_view one = meant;
    if (fs::path(name).extension() == fs::path(file).extension() && !sim::nearestName(stem(file), {&one, 1}).empty())
      candidates.push_back(name);
  }
  const std::string_view near = sim::nearestName(fs::path(file).filename().string(), candidates);
  if (near.empty()) return "check the path";
  const fs::path beside = folder / near;
  return "did you mean '" + (fs::exists(beside, ignored) ? beside.string() : std::string(near)) + "'?";
}

std::string stem(const std::string& path) {
  return fs::path(path).stem().string();
}

}  // namespace app

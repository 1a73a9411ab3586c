#include "app/files/folder_list.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "app/files/errors.h"
#include "app/files/output_file.h"

namespace app {

namespace fs = std::filesystem;

namespace {

bool endsIn(const std::string& name, const std::vector<std::string_view>& endings) {
  std::string lower = name;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  return endings.empty() ||
         std::any_of(endings.begin(), endings.end(), [&](std::string_view ending) { return lower.ends_with(ending); });
}

std::string listFile(const std::string& kept_folder) {
  return (fs::path(kept_folder) / "recent.txt").string();
}

std::string wholePath(const std::string& file) {
  std::error_code ignored;
  return fs::absolute(file, ignored).lexically_normal().string();
}

void writeRecent(const std::string& kept_folder, const std::vector<std::string>& recent) {
  if (kept_folder.empty()) return;
  std::error_code ignored;
  fs::create_directories(kept_folder, ignored);
  std::string text;
  for (const std::string& line : recent) text += line + "\n";
  try {
    writeFile(listFile(kept_folder), text);
  } catch (const OutputError&) {
  }
}

}  // namespace

std::vector<FolderEntry> listFolder(const std::string& folder, const std::vector<std::string_view>& endings) {
  std::vector<FolderEntry> entries;
  std::error_code error;
  for (fs::directory_iterator at(folder.empty() ? "." : folder, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    std::error_code ignored;
    const bool is_folder = at->is_directory(ignored);
    if (name.starts_with(".") || (!is_folder && (!at->is_regular_file(ignored) || !endsIn(name, endings)))) continue;
    entries.push_back({name, is_folder});
  }
  std::sort(entries.begin(), entries.end(), [](const FolderEntry& a, const FolderEntry& b) {
    return a.folder != b.folder ? a.folder : a.name < b.name;
  });
  return entries;
}

std::string folderAbove(const std::string& folder) {
  std::error_code ignored;
  const fs::path whole = fs::weakly_canonical(folder.empty() ? "." : folder, ignored);
  return whole.has_parent_path() ? whole.parent_path().string() : folder;
}

std::string keptFolder() {
  const auto of = [](const char* name) {
    const char* value = std::getenv(name);
    return std::string(value ? value : "");
  };
  if (const std::string state = of("XDG_STATE_HOME"); !state.empty()) return (fs::path(state) / "hairmesh").string();
  const std::string home = of("HOME");
  return home.empty() ? "" : (fs::path(home) / ".local" / "state" / "hairmesh").string();
}

std::vector<std::string> readRecent(const std::string& kept_folder) {
  std::vector<std::string> recent;
  if (kept_folder.empty()) return recent;
  std::ifstream stream(listFile(kept_folder));
  std::error_code ignored;
  for (std::string line; recent.size() < kMaxRecent && std::getline(stream, line);) {
    if (fs::exists(line, ignored)) recent.push_back(line);
  }
  return recent;
}

void noteRecent(const std::string& file, const std::string& kept_folder, std::vector<std::string>& recent) {
  const std::string whole = wholePath(file);
  std::erase(recent, whole);
  recent.insert(recent.begin(), whole);
  if (recent.size() > kMaxRecent) recent.resize(kMaxRecent);
  writeRecent(kept_folder, recent);
}

void forgetRecent(const std::string& file, const std::string& kept_folder, std::vector<std::string>& recent) {
  if (std::erase(recent, wholePath(file)) > 0) writeRecent(kept_folder, recent);
}

}  // namespace app

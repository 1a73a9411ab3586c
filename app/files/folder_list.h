// What a folder holds, for a person who looks for a file, and the files that were opened last.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace app {

struct FolderEntry {
  std::string name;  // within the folder
  bool folder = false;
};

// Folders first, then files that end in one of `endings` (in any case; none: all files), each sorted by name. What is
// hidden and what cannot be read is left out; a folder that cannot be read is empty.
std::vector<FolderEntry> listFolder(const std::string& folder, const std::vector<std::string_view>& endings);

// The folder above; the folder itself at the top.
std::string folderAbove(const std::string& folder);

// Where the program keeps what outlives a run: $XDG_STATE_HOME/hairmesh or ~/.local/state/hairmesh. Empty where the
// environment names neither; then nothing is kept.
std::string keptFolder();

inline constexpr std::size_t kMaxRecent = 12;

// Files opened last, the latest first; those that are gone are left out.
std::vector<std::string> readRecent(const std::string& kept_folder);

// Puts `file` first and writes the list; a list that cannot be written is no fault.
void noteRecent(const std::string& file, const std::string& kept_folder, std::vector<std::string>& recent);

// Takes `file` out, and writes the list if it was in it.
void forgetRecent(const std::string& file, const std::string& kept_folder, std::vector<std::string>& recent);

}  // namespace app

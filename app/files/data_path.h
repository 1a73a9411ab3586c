// Where the program's own files are: shaders, scenes, presets, clips, hair meshes.
#pragma once

#include <string>
#include <vector>

namespace app {

// The data folder: the environment's HAIRMESH_DATA when set, else that of the installation which the running program is
// part of (HAIRMESH_INSTALLED_DATA from its folder), else the source tree that it was built from.
std::string dataFolder();

// A file of the data folder, for instance dataPath("shaders").
std::string dataPath(const std::string& relative);

// Finds a file that a person named: as given when absolute, else beside `base_file` (a scene; may be empty: then the
// working folder), then in the data folder, then in assets/`kind` of the data folder ("clips", "hair", "scenes",
// "presets"). Returns the name as given when nothing is found, so that the reader's message shows what was asked for.
std::string findFile(const std::string& name, const std::string& base_file, const std::string& kind);

// The same of a file that must be there: throws InputError, with missingMend, where nothing is found.
std::string foundFile(const std::string& name, const std::string& base_file, const std::string& kind);

// Names of the files of assets/`kind` that end in one of `endings`, full paths, sorted.
std::vector<std::string> listAssets(const std::string& kind, const std::vector<std::string>& endings);

// What to do about a file that is not there: the name that was meant, of its folder's or of the program's own files,
// else to check the path.
std::string missingMend(const std::string& file);

// "walk" of "/a/b/walk.bvh".
std::string stem(const std::string& path);

}  // namespace app

#include "app/output_names.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace app {

namespace {

namespace fs = std::filesystem;

using Named = std::pair<std::string, std::string>;  // an option, and the file that it names; empty: none

std::vector<Named> outputsOf(const Options& options) {
  return {{"--record", options.record},         {"--report", options.report},
          {"--save-state", options.save_state}, {"--screenshot", options.screenshot},
          {"--video", options.video},           {"--export", options.hair_export.file},
          {"--cache", options.cache},           {"--write-hair", options.write_hair}};
}

std::vector<Named> inputsOf(const Options& options) {
  std::vector<Named> inputs{{"the scene", options.scene},
                            {"the project", options.project},
                            {"--motion", options.motion},
                            {"--parts", options.parts},
                            {"--hair", options.hair},
                            {"--preset", options.preset},
                            {"--environment", options.environment},
                            {"--replay", options.replay},
                            {"--load-state", options.load_state},
                            {"--compare", options.compare}};
  for (const std::string& map : options.maps) inputs.emplace_back("--map", map.substr(map.find('=') + 1));
  for (const std::string& worn : options.attachments) inputs.emplace_back("--attach", worn.substr(0, worn.rfind('@')));
  return inputs;
}

bool same(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty()) return false;
  std::error_code ignored;
  const auto place = [&](const std::string& file) {
    return fs::weakly_canonical(fs::absolute(file, ignored), ignored);
  };
  return place(a) == place(b);
}

}  // namespace

void refuseOutputsOverFiles(const Options& options) {
  const std::vector<Named> outputs = outputsOf(options), inputs = inputsOf(options);
  for (const auto& [name, file] : outputs)
    if (!options.write_hair.empty() && name != "--write-hair" && !file.empty())
      throw UsageError("--write-hair writes the hair mesh and ends: " + name + " would do nothing; leave one out");
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const auto& [name, file] = outputs[i];
    for (std::size_t k = 0; k < i; ++k)
      if (same(file, outputs[k].second))
        throw UsageError(outputs[k].first + " and " + name + " name one file, '" + file + "'; name two");
    for (const auto& [read, input] : inputs) {
      const bool goes_on = name == "--save-state" && read == "--load-state";
      if (same(file, input) && !goes_on)
        throw UsageError(name + " would write over '" + file + "', which is " +
                         (read.starts_with("--") ? read + "'s" : read) + "; name another file");
    }
  }
}

}  // namespace app

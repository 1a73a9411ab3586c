#include "tests/stress/ablation.h"

#include <cstdio>

#include "app/options.h"

namespace stress {

std::vector<std::string> ablationsOf(const std::string& asked) {
  std::vector<std::string> names{"none"};
  std::string known;
  for (const sim::SafetyNetName& net : sim::kSafetyNets) {
    if (asked == "all" || asked == net.name) names.push_back(net.name);
    known += std::string(known.empty() ? "" : ", ") + net.name;
  }
  if (names.size() == 1 && asked != "none")
    throw app::UsageError("--ablate: there is no safety net '" + asked + "'; choose all, none or one of " + known);
  return names;
}

std::vector<StressCase> without(const std::string& net, std::span<const StressCase> cases) {
  std::vector<StressCase> all(cases.begin(), cases.end());
  for (StressCase& one : all) {
    for (const sim::SafetyNetName& known : sim::kSafetyNets) {
      if (net == known.name) one.nets.*known.on = false;
    }
  }
  return all;
}

std::string ablationTable(std::span<const Ablation> rows) {
  std::string table = "net,cases,failed,lost,gained,guided,cpu_s,cpu_ratio\n";
  for (const Ablation& row : rows) {
    char line[200];
    std::snprintf(line, sizeof line, "%s,%ld,%ld,%ld,%ld,%ld,%.1f,%.3f\n", row.net.c_str(), row.cases, row.failed,
                  row.lost, row.gained, row.guided, row.seconds, row.seconds / rows.front().seconds);
    table += line;
  }
  return table;
}

}  // namespace stress

#include "app/ui/window_words.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace app {

namespace {

bool namesOption(std::string_view words) {
  for (std::size_t at = words.find("--"); at != std::string_view::npos; at = words.find("--", at + 2)) {
    const bool begins = at == 0 || words[at - 1] == ' ' || words[at - 1] == '(';
    if (begins && at + 2 < words.size() && std::islower(static_cast<unsigned char>(words[at + 2]))) return true;
  }
  return false;
}

// Of an attachment in a scene file or behind --attach.
bool namesKey(std::string_view words) {
  constexpr std::array<std::string_view, 4> kKeys{"\"at\"", "\"turn\"", "\"size\"", "\"scale\""};
  return std::ranges::any_of(kKeys, [&](std::string_view key) { return words.find(key) != words.npos; });
}

void dropParentheses(std::string& line) {
  std::size_t open = line.find(" (");
  while (open != std::string::npos) {
    const std::size_t close = line.find(')', open);
    if (close == std::string::npos) return;
    const std::string_view within = std::string_view(line).substr(open, close - open);
    const bool drop = namesOption(within) || namesKey(within);
    if (drop) line.erase(open, close + 1 - open);
    open = line.find(" (", drop ? open : close);
  }
}

// Where the clause that begins at `from` ends: before the nearest of what parts clauses.
std::size_t clauseEnd(const std::string& line, std::size_t from) {
  constexpr std::array<std::string_view, 4> kParts{"; ", ": ", ", or ", ", and "};
  std::size_t end = line.size();
  for (const std::string_view part : kParts) end = std::min(end, line.find(part, from));
  return end;
}

std::string withoutOptions(std::string line) {
  dropParentheses(line);
  std::size_t end = clauseEnd(line, 0);
  std::string kept = line.substr(0, end);
  while (end < line.size()) {
    const std::size_t next = clauseEnd(line, end + 1);
    const std::string clause = line.substr(end, next - end);
    if (!namesOption(clause)) kept += clause;
    end = next;
  }
  return kept;
}

}  // namespace

std::string windowWords(const std::string& message) {
  std::string shown;
  for (std::size_t at = 0; at <= message.size();) {
    const std::size_t end = std::min(message.find('\n', at), message.size());
    if (at > 0) shown += '\n';
    shown += withoutOptions(message.substr(at, end - at));
    at = end + 1;
  }
  return shown;
}

}  // namespace app

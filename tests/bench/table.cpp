#include "tests/bench/table.h"

#include <algorithm>
#include <cassert>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "app/files/output_file.h"

namespace bench {
namespace {

std::string trimmed(std::string cell) {
  const std::string blank = " *";
  const auto first = cell.find_first_not_of(blank);
  if (first == std::string::npos) return "";
  return cell.substr(first, cell.find_last_not_of(blank) - first + 1);
}

// What lies between the bars of a Markdown line.
std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream stream(line.substr(1));
  for (std::string cell; std::getline(stream, cell, '|');) cells.push_back(trimmed(cell));
  return cells;
}

std::vector<std::string> cellsOfCsv(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (line[k] == '"') {
      if (quoted && k + 1 < line.size() && line[k + 1] == '"')
        cells.back() += line[++k];
      else
        quoted = !quoted;
    } else if (line[k] == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += line[k];
    }
  }
  return cells;
}

std::size_t placeOf(const Table& table, const std::string& column) {
  const auto found = std::find(table.head.begin(), table.head.end(), column);
  assert(found != table.head.end());
  return static_cast<std::size_t>(found - table.head.begin());
}

std::string markdownLine(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) line += " " + cell + " |";
  return line + "\n";
}

std::string csvLine(const std::vector<std::string>& cells) {
  std::string line;
  for (const std::string& cell : cells) {
    std::string text = cell;
    if (text.find_first_of(",\"") != std::string::npos) {
      for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2) text.insert(at, 1, '"');
      text = '"' + text + '"';
    }
    line += (&cell == &cells.front() ? "" : ",") + text;
  }
  return line + "\n";
}

int decimalsOf(const std::string& number) {
  const auto point = number.find('.');
  return point == std::string::npos ? 0 : static_cast<int>(number.size() - point - 1);
}

std::string foldedCell(const std::string& a, const std::string& b, Fold fold) {
  const double x = std::atof(a.c_str()), y = std::atof(b.c_str());
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", std::max(decimalsOf(a), decimalsOf(b)),
                fold == Fold::kSum ? x + y : std::max(x, y));
  return text;
}

}  // namespace

std::string Table::markdown() const {
  std::string text = markdownLine(head) + "|";
  for (std::size_t k = 0; k < head.size(); ++k) text += "---|";
  text += "\n";
  for (const auto& row : rows) text += markdownLine(row);
  return text + "\n";
}

std::string Table::csv() const {
  std::string text = csvLine(head);
  for (const auto& row : rows) {
    if (row.size() != head.size())
      throw std::logic_error("a row of " + std::to_string(row.size()) + " cells in a table of " +
                             std::to_string(head.size()) + " columns: " + csvLine(row));
    text += csvLine(row);
  }
  return text;
}

Table tableOf(const std::string& markdown) {
  Table table;
  std::stringstream stream(markdown);
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with("|") || line.starts_with("|-")) continue;
    const std::vector<std::string> cells = cellsOf(line);
    if (table.head.empty()) {
      table.head = cells;
    } else if (cells.size() == table.head.size() && cells != table.head) {
      table.rows.push_back(cells);
    }
  }
  return table;
}

Table tableOfCsv(const std::string& text) {
  Table table;
  std::stringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    if (table.head.empty())
      table.head = cellsOfCsv(line);
    else
      table.rows.push_back(cellsOfCsv(line));
  }
  return table;
}

Table columns(const Table& table, const std::vector<std::string>& names) {
  Table some;
  some.head = names;
  for (const auto& row : table.rows) {
    some.rows.emplace_back();
    for (const std::string& name : names) some.rows.back().push_back(row[placeOf(table, name)]);
  }
  return some;
}

Table rowsWith(const Table& table, const std::string& column, const std::string& value) {
  Table some{table.head, {}};
  for (const auto& row : table.rows) {
    if (row[placeOf(table, column)] == value) some.rows.push_back(row);
  }
  return some;
}

Table joined(const Table& table, const Table& more, const std::string& key) {
  Table all = table;
  const std::size_t skipped = placeOf(more, key);
  for (std::size_t k = 0; k < more.head.size(); ++k) {
    if (k == skipped) continue;
    all.head.push_back(more.head[k]);
    for (auto& row : all.rows) {
      const Table same = rowsWith(more, key, row[placeOf(table, key)]);
      row.push_back(same.rows.empty() ? "-" : same.rows.front()[k]);
    }
  }
  return all;
}

Table withColumn(const std::string& name, const std::string& value, const Table& table) {
  Table more = table;
  more.head.insert(more.head.begin(), name);
  for (auto& row : more.rows) row.insert(row.begin(), value);
  return more;
}

void append(const Table& more, Table& table) {
  if (table.head.empty()) table.head = more.head;
  assert(table.head == more.head);
  table.rows.insert(table.rows.end(), more.rows.begin(), more.rows.end());
}

Table folded(const Table& table, const std::vector<std::string>& keys,
             const std::vector<std::pair<std::string, Fold>>& values) {
  std::vector<std::string> names = keys;
  for (const auto& [name, fold] : values) names.push_back(name);
  const Table some = columns(table, names);
  Table out{names, {}};
  for (const auto& row : some.rows) {
    const auto same = std::find_if(out.rows.begin(), out.rows.end(), [&](const auto& known) {
      return std::equal(known.begin(), known.begin() + static_cast<std::ptrdiff_t>(keys.size()), row.begin());
    });
    if (same == out.rows.end()) {
      out.rows.push_back(row);
      continue;
    }
    for (std::size_t k = keys.size(); k < names.size(); ++k)
      (*same)[k] = foldedCell((*same)[k], row[k], values[k - keys.size()].second);
  }
  return out;
}

std::string dataFolder(const std::string& folder) {
  const std::string data = folder + "/data";
  std::error_code fault;
  std::filesystem::create_directories(data, fault);
  return data;
}

void writeTable(const std::string& folder, const std::string& name, const Table& table) {
  const std::string file = dataFolder(folder) + "/" + name + ".csv";
  app::writeFile(file, table.csv());
}

}  // namespace bench

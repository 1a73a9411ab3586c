// Tables of the documents: measured as Markdown, kept whole as CSV, shown in part.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace bench {

struct Table {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;

  std::string markdown() const;  // ends with an empty line
  std::string csv() const;  // cells with a comma or a quote in quotes; a row of another length is a programmer's error
};

// Reads the first table of a Markdown text, and the rows of later ones with as many columns. Bold is dropped.
Table tableOf(const std::string& markdown);

// Reads what csv() writes.
Table tableOfCsv(const std::string& text);

// The named columns, in that order; a name that is none is a programmer's error.
Table columns(const Table& table, const std::vector<std::string>& names);

// The rows whose cell in `column` is `value`.
Table rowsWith(const Table& table, const std::string& column, const std::string& value);

// The columns of `more` but its `key`, added to the row of the same key; "-" where there is none.
Table joined(const Table& table, const Table& more, const std::string& key);

// A first column of the same value in every row.
Table withColumn(const std::string& name, const std::string& value, const Table& table);

// Adds the rows of a table with the same columns; an empty table takes its head.
void append(const Table& more, Table& table);

enum class Fold { kSum, kLargest };

// One row for each value of the `keys`, in the order in which they appear; the numbers of the named columns folded, and
// written with as many decimals as they had.
Table folded(const Table& table, const std::vector<std::string>& keys,
             const std::vector<std::pair<std::string, Fold>>& values);

// <folder>/data, where a page keeps its full tables and charts. Made where it is missing.
std::string dataFolder(const std::string& folder);

// Writes the table to <folder>/data/<name>.csv. Throws app::OutputError where that cannot be written.
void writeTable(const std::string& folder, const std::string& name, const Table& table);

}  // namespace bench

// The pages of docs show what stands beside them in docs/data, and stay within two screens.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "tests/bench/table.h"

namespace document_test {

using bench::Fold;
using bench::Table;

const std::string kDocs = std::string(HAIRMESH_SOURCE_DIR) + "/docs/";

std::string textOf(const std::string& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

Table dataOf(const std::string& name) {
  return bench::tableOfCsv(textOf(kDocs + "data/" + name + ".csv"));
}

// A page's measured part.
std::string partOf(const std::string& page, const std::string& name) {
  const std::string text = textOf(kDocs + page), opening = "<!-- measured: " + name + " -->\n\n";
  const auto start = text.find(opening) + opening.size();
  return text.substr(start, text.find("<!-- end of " + name + " -->") - start);
}

TEST(Table, ReadsBackWhatItWrites) {
  const Table table{{"a", "b, c"}, {{"1", "say \"x\""}, {"", "2 %"}}};
  EXPECT_EQ(bench::tableOfCsv(table.csv()).csv(), table.csv());
  EXPECT_EQ(bench::tableOfCsv(table.csv()).rows, table.rows);
  EXPECT_EQ(bench::tableOf(table.markdown()).rows, table.rows);
}

TEST(Table, FoldsNumbersUnderTheirKeyAndJoinsByIt) {
  const Table table{{"style", "clip", "n", "mm"},
                    {{"x", "1", "2", "0.5"}, {"y", "1", "3", "0.1"}, {"x", "2", "4", "0.2"}}};
  const Table folded = bench::folded(table, {"style"}, {{"n", Fold::kSum}, {"mm", Fold::kLargest}});
  EXPECT_EQ(folded.rows, (std::vector<std::vector<std::string>>{{"x", "6", "0.5"}, {"y", "3", "0.1"}}));
  const Table joined = bench::joined(folded, {{"style", "rest"}, {{"y", "7"}}}, "style");
  EXPECT_EQ(joined.rows, (std::vector<std::vector<std::string>>{{"x", "6", "0.5", "-"}, {"y", "3", "0.1", "7"}}));
}

TEST(Documents, ShowWhatStandsInTheirData) {
  EXPECT_EQ(partOf("gate.md", "figures"), columns(dataOf("gate"), {"figure", "value", "bound", "holds"}).markdown());
  EXPECT_EQ(partOf("drawing.md", "draw-scenes"), dataOf("draw_scenes").markdown());
  EXPECT_EQ(partOf("drawing.md", "draw-settings"), dataOf("draw_settings").markdown());
  EXPECT_EQ(partOf("collision.md", "crossing"), bench::folded(dataOf("collision_crossing"), {"speed, m/s"},
                                                              {{"vertices met", Fold::kSum},
                                                               {"slid over the rim", Fold::kSum},
                                                               {"passed through", Fold::kSum},
                                                               {"inside afterwards, mm", Fold::kLargest}})
                                                    .markdown());
  EXPECT_NE(partOf("stability.md", "result")
                .find(columns(dataOf("stability_families"),
                              {"family", "what varies", "cases", "failed", "slowest return, s", "guided", "recoveries"})
                          .markdown()),
            std::string::npos);
}

TEST(Documents, PicturesShowTheirViews) {
  const std::vector<std::string> shown{"style",
                                       "cover, drawn over traced",
                                       "its RMS",
                                       "shadow's RMS, key",
                                       "shadow's RMS, key from behind",
                                       "shadow's RMS, fill",
                                       "shadow's RMS, rim"};
  const Table views = columns(dataOf("picture_views"), shown);
  EXPECT_GT(views.rows.size(), 0u);
  EXPECT_EQ(columns(bench::tableOf(partOf("picture.md", "reference")), shown).rows, views.rows);
}

TEST(Documents, AreTwoScreensLong) {
  int pages = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kDocs)) {
    if (entry.path().extension() != ".md") continue;
    ++pages;
    const std::string text = textOf(entry.path());
    EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 130) << entry.path();
    std::istringstream words(text);
    EXPECT_LE(std::distance(std::istream_iterator<std::string>(words), {}), 2400) << entry.path();
  }
  EXPECT_GT(pages, 0);
}

}  // namespace document_test

// The recipes of docs/recipes.md are true: each names an example, the code of every place it lists names that example,
// and that of no other file of the program does.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace recipes_test {

namespace fs = std::filesystem;

const fs::path kRoot = HAIRMESH_SOURCE_DIR;

struct Recipe {
  std::string title, example;
  std::set<std::string> places;  // paths from the root
};

std::string textOf(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// Sections "Adding ...", each with a line "Example: `word`." and a numbered list of places, each beginning with its
// path in backticks.
std::vector<Recipe> recipesIn(const fs::path& file) {
  const std::regex example("^Example: `([^`]+)`"), place("^[0-9]+\\. `([^`]+)`");
  std::vector<Recipe> recipes;
  Recipe recipe;
  const auto finish = [&] {
    if (recipe.title.starts_with("Adding ")) recipes.push_back(recipe);
  };
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    std::smatch match;
    if (line.starts_with("## ")) {
      finish();
      recipe = {line.substr(3), "", {}};
    } else if (std::regex_search(line, match, example)) {
      recipe.example = match[1];
    } else if (std::regex_search(line, match, place)) {
      recipe.places.insert(match[1]);
    }
  }
  finish();
  return recipes;
}

// The files of the program whose code, comments and names of included files aside, has a word that begins with `word`,
// in any case.
std::set<std::string> filesNaming(const std::string& word) {
  const std::regex comment("//[^\n]*|#include[^\n]*"), beginning("\\b" + word, std::regex::icase);
  std::set<std::string> files;
  for (const char* folder : {"sim", "render", "app", "shaders"}) {
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
      if (entry.is_regular_file() &&
          std::regex_search(std::regex_replace(textOf(entry.path()), comment, ""), beginning))
        files.insert(fs::relative(entry.path(), kRoot).generic_string());
    }
  }
  return files;
}

TEST(Recipes, ListEveryPlaceOfTheirExampleAndNoOther) {
  const std::vector<Recipe> recipes = recipesIn(kRoot / "docs/recipes.md");
  ASSERT_GE(recipes.size(), 4u);
  for (const Recipe& recipe : recipes) {
    ASSERT_FALSE(recipe.example.empty()) << recipe.title << ": no example";
    EXPECT_EQ(filesNaming(recipe.example), recipe.places) << recipe.title << ": example " << recipe.example;
  }
}

TEST(Recipes, TheReadmeAndEveryPageLinkToFilesThatExist) {
  const std::regex link("\\]\\(([^)#:]+)(#[^)]*)?\\)");
  std::vector<fs::path> pages{kRoot / "README.md"};
  for (const auto& entry : fs::recursive_directory_iterator(kRoot / "docs")) {
    if (entry.path().extension() == ".md") pages.push_back(entry.path());
  }
  for (const fs::path& page : pages) {
    const std::string text = textOf(page);
    for (std::sregex_iterator match(text.begin(), text.end(), link), end; match != end; ++match) {
      EXPECT_TRUE(fs::exists(page.parent_path() / (*match)[1].str())) << page << " links to " << (*match)[1];
    }
  }
}

}  // namespace recipes_test

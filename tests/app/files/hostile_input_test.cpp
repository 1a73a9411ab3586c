// Every reader under the texts that the fuzzers begin with, cut short anywhere and damaged at random: read, or refused
// with a message, and nothing else. The same targets as tests/fuzz, which needs clang; this needs none.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "app/files/errors.h"
#include "tests/fuzz/readers.h"

namespace tests {

void PrintTo(const Reader& reader, std::ostream* out) {
  *out << reader.name;
}

}  // namespace tests

namespace hostile_input_test {

// What the fuzzers begin with, and what they once found.
std::vector<std::string> textsOf(const std::string& reader) {
  std::vector<std::string> texts;
  for (const char* folder : {"seeds", "found"}) {
    const std::filesystem::path path = std::filesystem::path(HAIRMESH_SOURCE_DIR) / "tests/fuzz" / folder / reader;
    if (!std::filesystem::exists(path)) continue;
    for (const auto& entry : std::filesystem::directory_iterator(path)) {
      std::ifstream file(entry.path(), std::ios::binary);
      texts.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    }
  }
  return texts;
}

class HostileInput : public testing::TestWithParam<tests::Reader> {
 protected:
  void read(const std::string& text) const {
    try {
      GetParam().read(text);
    } catch (const app::InputError&) {
    }
  }
};

TEST_P(HostileInput, IsReadOrRefused) {
  const std::vector<std::string> texts = textsOf(GetParam().name);
  ASSERT_FALSE(texts.empty());
  read("");
  for (const std::string& text : texts) {
    EXPECT_NO_THROW(read(text));
    for (std::size_t length = 0; length < text.size(); ++length) EXPECT_NO_THROW(read(text.substr(0, length)));
  }
}

TEST_P(HostileInput, SurvivesDamage) {
  constexpr int kDamaged = 1500;
  const std::string bytes = std::string("0123456789.-+eE{}[]\",:/ \n\t#fvgo") + '\0' + '\x80' + '\xff';
  std::uint64_t state = 1;
  const auto below = [&](std::size_t end) {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    return static_cast<std::size_t>(state >> 33) % end;
  };
  const std::vector<std::string> texts = textsOf(GetParam().name);
  ASSERT_FALSE(texts.empty());
  for (std::string text : texts) {
    const std::string sound = text;
    for (int n = 0; n < kDamaged; ++n) {
      if (n % 8 == 0) text = sound;
      const std::size_t at = below(text.size() + 1), span = below(24);
      switch (below(4)) {
        case 0:
          text.insert(at, 1 + below(3), bytes[below(bytes.size())]);
          break;
        case 1:
          if (at < text.size()) text[at] = bytes[below(bytes.size())];
          break;
        case 2:
          text.erase(std::min(at, text.size()), span);
          break;
        default:
          text.insert(below(text.size() + 1), text.substr(std::min(at, text.size()), span));
      }
      EXPECT_NO_THROW(read(text)) << text;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Readers, HostileInput, testing::ValuesIn(tests::readers().begin(), tests::readers().end()),
                         [](const auto& reader) { return std::string(reader.param.name); });

}  // namespace hostile_input_test

// A cursor over a text file that knows its line: what the readers of BVH and .mot share.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace app {

// Lines end at LF, CRLF or a lone CR; blanks are spaces, tabs and other control characters. Nothing is copied.
struct TextScanner {
  std::string_view text;
  std::string file;  // names the text in messages
  std::size_t at = 0;
  int line = 1;  // 1-based line of `at`

  // Moves to the next character that is not blank; false at the end of the text.
  bool skipBlanks();
  // The same without leaving the line; false at its end.
  bool skipBlanksInLine();
  // Next run of characters without blanks, crossing lines; a brace is a word of its own. Empty at the end.
  std::string_view word();
  // What is left of the line up to an opening brace, trimmed of blanks: a joint's name.
  std::string_view lineUpToBrace();
  // Next number, finite and at most `largest` in magnitude; `what` names it in the message. Throws InputError.
  double number(const char* what, double largest);
  // The same, a whole number of at least 0.
  long long count(const char* what, long long largest);
  std::size_t left() const { return text.size() - at; }

  [[noreturn]] void fail(const std::string& fault, const std::string& mend) const;
  [[noreturn]] void failAt(int fault_line, const std::string& fault, const std::string& mend) const;
};

// Throws InputError for text in UTF-16, which editors of some systems save without a word. Bytes of other files are
// none.
void refuseUtf16(std::string_view bytes, const std::string& file);

// A piece of the text fit for a message: quoted, printable, at most 32 characters.
std::string quoted(std::string_view piece);
// Whether two words are the same but for the case of ASCII letters.
bool sameWord(std::string_view a, std::string_view b);

}  // namespace app

#include "app/files/text_scanner.h"

#include <charconv>
#include <cmath>

#include "app/files/errors.h"

namespace app {

namespace {
bool isLineEnd(char c) {
  return c == '\n' || c == '\r';
}
// Control characters count as blanks, so that a stray NUL cannot glue two words together; bytes above 127 are letters.
bool isBlank(char c) {
  return static_cast<unsigned char>(c) <= ' ' && !isLineEnd(c);
}
bool isBrace(char c) {
  return c == '{' || c == '}';
}
char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}
}  // namespace

bool TextScanner::skipBlanks() {
  while (at < text.size()) {
    const char c = text[at];
    if (isLineEnd(c)) {
      const bool crlf = c == '\r' && at + 1 < text.size() && text[at + 1] == '\n';
      at += crlf ? 2 : 1;
      ++line;
    } else if (isBlank(c)) {
      ++at;
    } else {
      return true;
    }
  }
  return false;
}

bool TextScanner::skipBlanksInLine() {
  while (at < text.size() && isBlank(text[at])) ++at;
  return at < text.size() && !isLineEnd(text[at]);
}

std::string_view TextScanner::word() {
  if (!skipBlanks()) return {};
  const std::size_t begin = at++;
  if (isBrace(text[begin])) return text.substr(begin, 1);
  while (at < text.size() && !isBlank(text[at]) && !isLineEnd(text[at]) && !isBrace(text[at])) ++at;
  return text.substr(begin, at - begin);
}

std::string_view TextScanner::lineUpToBrace() {
  skipBlanksInLine();
  const std::size_t begin = at;
  while (at < text.size() && !isLineEnd(text[at]) && !isBrace(text[at])) ++at;
  std::size_t end = at;
  while (end > begin && isBlank(text[end - 1])) --end;
  return text.substr(begin, end - begin);
}

double TextScanner::number(const char* what, double largest) {
  std::string_view piece = word();
  if (piece.empty()) fail(std::string("the text ends where ") + what + " should stand", "complete the file");
  const std::string_view whole = piece;
  if (piece.front() == '+') piece.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(piece.data(), piece.data() + piece.size(), value);
  if (error == std::errc::invalid_argument || end != piece.data() + piece.size()) {
    const bool comma = piece.find(',') != std::string_view::npos;
    fail(quoted(whole) + " is not a number (" + what + ")",
         comma ? "write decimals with a point" : "write a plain decimal number");
  }
  if (error == std::errc::result_out_of_range) {
    // from_chars does not tell overflow from underflow; a number below the smallest double is zero for every purpose
    // here.
    const bool underflow = piece.find("e-") != std::string_view::npos || piece.find("E-") != std::string_view::npos;
    value = underflow ? 0 : HUGE_VAL;
  }
  if (!std::isfinite(value)) fail(quoted(whole) + " is not a finite number (" + what + ")", "write a finite number");
  if (std::abs(value) > largest) {
    fail(quoted(whole) + " is too large for " + what, "check the file: it may be damaged or in another format");
  }
  return value;
}

long long TextScanner::count(const char* what, long long largest) {
  std::string_view piece = word();
  if (piece.empty()) fail(std::string("the text ends where ") + what + " should stand", "complete the file");
  long long value = 0;
  const auto [end, error] = std::from_chars(piece.data(), piece.data() + piece.size(), value);
  if (error == std::errc::invalid_argument || end != piece.data() + piece.size() || value < 0) {
    fail(quoted(piece) + " is not a whole number of at least 0 (" + what + ")", "write a plain whole number");
  }
  if (error == std::errc::result_out_of_range || value > largest) {
    fail(quoted(piece) + " is too large for " + what + " (at most " + std::to_string(largest) + " here)",
         "correct the number or complete the file");
  }
  return value;
}

void TextScanner::fail(const std::string& fault, const std::string& mend) const {
  failAt(line, fault, mend);
}

void TextScanner::failAt(int fault_line, const std::string& fault, const std::string& mend) const {
  throw InputError(file, "line " + std::to_string(fault_line), fault, mend);
}

std::string quoted(std::string_view piece) {
  constexpr std::size_t kLongest = 32;
  std::string result = "'";
  for (const char c : piece.substr(0, kLongest)) result += (c >= ' ' && c <= '~') ? c : '?';
  return result + (piece.size() > kLongest ? "...'" : "'");
}

bool sameWord(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (lower(a[i]) != lower(b[i])) return false;
  }
  return true;
}

void refuseUtf16(std::string_view bytes, const std::string& file) {
  if (bytes.size() < 4) return;
  const bool marked = bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff");
  const auto letter = [&](std::size_t k) { return bytes[k] >= '\t' && bytes[k] < 127; };
  const bool low = letter(0) && bytes[1] == 0 && letter(2) && bytes[3] == 0;
  const bool high = bytes[0] == 0 && letter(1) && bytes[2] == 0 && letter(3);
  if (marked || low || high)
    throw InputError(file, "", "is text in UTF-16", "save it as UTF-8 or plain ASCII");
}

}  // namespace app

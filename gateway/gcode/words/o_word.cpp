#include "gateway/gcode/words/o_word.hpp"

#include <array>
#include <cstdlib>

#include "gateway/gcode/letters.hpp"

namespace kinebus::gcode {
namespace {

struct Keyword {
  std::string_view text;
  OKind kind;
};
// Longer words before their beginnings.
constexpr std::array<Keyword, 15> kKeywords = {{{"sub", OKind::kSub},
                                                {"endsub", OKind::kEndsub},
                                                {"return", OKind::kReturn},
                                                {"call", OKind::kCall},
                                                {"if", OKind::kIf},
                                                {"elseif", OKind::kElseif},
                                                {"else", OKind::kElse},
                                                {"endif", OKind::kEndif},
                                                {"while", OKind::kWhile},
                                                {"endwhile", OKind::kEndwhile},
                                                {"do", OKind::kDo},
                                                {"repeat", OKind::kRepeat},
                                                {"endrepeat", OKind::kEndrepeat},
                                                {"break", OKind::kBreak},
                                                {"continue", OKind::kContinue}}};

bool is_number(char c) {
  return c >= '0' && c <= '9';
}
/// How much of `text` the word takes, with blanks within it as LinuxCNC has them (end sub); 0: it is another.
std::size_t taken_by(std::string_view text, std::string_view word) {
  std::size_t at = 0;
  for (const char c : word) {
    while (at < text.size() && at > 0 && (text[at] == ' ' || text[at] == '\t')) ++at;
    if (at == text.size() || in_lower_case(text[at]) != c) return 0;
    ++at;
  }
  return at;
}

class OReader {
 public:
  OReader(std::string_view line, OWord& word, SyntaxError& error) : line_(line), word_(word), error_(error) {}

  bool read() {
    word_ = {};
    skip();
    if (peek() == '/') {
      word_.deleted = true;
      ++at_;
      skip();
    }
    if (in_lower_case(peek()) == 'n') {
      ++at_;
      skip();
      while (is_number(peek()) || peek() == '.') ++at_;
      skip();
    }
    if (in_lower_case(peek()) != 'o') return true;
    word_.column = static_cast<std::uint32_t>(at_) + 1;
    ++at_;
    skip();
    // A bare O belongs to G28, and a name of letters is no O word.
    const char c = peek();
    if (!is_number(c) && c != '<' && c != '[' && c != '#') return true;
    if (!read_label()) return false;
    return read_keyword();
  }

 private:
  char peek() const { return at_ < line_.size() ? line_[at_] : '\0'; }
  void skip() {
    while (peek() == ' ' || peek() == '\t' || peek() == '\r') ++at_;
  }
  bool fail(std::size_t at, Sentence message) {
    error_ = {static_cast<std::uint32_t>(at) + 1, std::move(message)};
    return false;
  }

  bool read_label() {
    word_.label_at = at_;
    if (is_number(peek())) {
      const std::size_t first = at_;
      while (is_number(peek())) ++at_;
      std::string_view digits = line_.substr(first, at_ - first);
      while (digits.size() > 1 && digits.front() == '0') digits.remove_prefix(1);
      if (digits.size() > 9) return fail(first, say("an O number has 9 digits at most"));
      word_.label = digits;
      return true;
    }
    if (peek() == '<') return read_name(&word_.label);
    if (peek() == '[') return skip_brackets();
    while (peek() == '#') ++at_;
    if (peek() == '<') return read_name(nullptr);
    if (peek() == '[') return skip_brackets();
    while (is_number(peek())) ++at_;
    return true;
  }
  bool read_name(std::string* label) {
    const std::size_t first = at_++;
    std::string name = "<";
    while (at_ < line_.size() && peek() != '>') {
      const char c = in_lower_case(line_[at_++]);
      if (c != ' ' && c != '\t') name += c;
    }
    if (peek() != '>') return fail(first, say("the name of an O word needs a closing >"));
    ++at_;
    if (name.size() == 1) return fail(first, say("the name of an O word is empty"));
    if (name.size() > 65) return fail(first, say("the name of an O word is too long (64 letters at most)"));
    if (label != nullptr) *label = name + ">";
    return true;
  }
  bool skip_brackets() {
    const std::size_t first = at_;
    int depth = 0;
    for (; at_ < line_.size(); ++at_) {
      if (peek() == '[') ++depth;
      if (peek() == ']' && --depth == 0) {
        ++at_;
        return true;
      }
    }
    return fail(first, say("expected ]"));
  }

  bool read_keyword() {
    skip();
    const std::size_t first = at_;
    const std::string_view text = line_.substr(at_);
    for (const Keyword& keyword : kKeywords) {
      const std::size_t taken = taken_by(text, keyword.text);
      if (taken == 0) continue;
      const char after = text.size() > taken ? in_lower_case(text[taken]) : '\0';
      if ((after >= 'a' && after <= 'z') || after == '_') continue;
      word_.kind = keyword.kind;
      at_ += taken;
      word_.rest_at = at_;
      if (word_.label.empty() && word_.kind != OKind::kCall)
        return fail(word_.label_at, say("only a call may compute its O number"));
      return true;
    }
    const char c = peek();
    const bool alone = c == '\0' || c == ';' || c == '(';
    if (!alone || word_.label.empty() || word_.label.front() == '<')
      return fail(first,
                  say("expected sub, call, if, while, do, repeat or another word of O after the label"));
    word_.kind = OKind::kProgram;
    word_.rest_at = at_;
    return true;
  }

  std::string_view line_;
  OWord& word_;
  SyntaxError& error_;
  std::size_t at_ = 0;
};

}  // namespace

bool read_o_word(std::string_view line, OWord& word, SyntaxError& error) {
  return OReader(line, word, error).read();
}

std::string_view o_keyword(OKind kind) {
  if (kind == OKind::kDoWhile) return "while";
  for (const Keyword& keyword : kKeywords)
    if (keyword.kind == kind) return keyword.text;
  return {};
}

std::string o_name(std::string_view label) {
  std::string name("o");
  name += label;
  return name;
}

}  // namespace kinebus::gcode

#pragma once
// What a user is told: English words that still know how they were made, so that a program in another
// language can make the same sentence of its own.
//
//   say("%1 stands twice in the line (first at column %2)", letter, column)
//
// The pattern, a literal, is the sentence's name for translators: tools/check/sentences finds them all. What
// stands in for %1, %2 ... is a number, a name, or a sentence itself.

#include <cstdio>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace kinebus {

/// Is its English words; nothing but say() and verbatim() makes one.
class Sentence : public std::string {
 public:
  Sentence() = default;
  /// Text that is nobody's to translate: names, numbers, words of a job or of the system.
  static Sentence verbatim(std::string text) {
    Sentence made;
    made.assign(std::move(text));
    return made;
  }
  /// `pattern` must live as long as the program.
  static Sentence of(const char* pattern, std::vector<Sentence> parts) {
    Sentence made;
    made.pattern_ = pattern;
    made.parts_ = std::move(parts);
    const std::string_view text = pattern;
    for (std::size_t i = 0; i < text.size(); ++i) {
      const bool place = text[i] == '%' && i + 1 < text.size() && text[i + 1] >= '1' && text[i + 1] <= '9';
      const auto part = place ? static_cast<std::size_t>(text[i + 1] - '1') : made.parts_.size();
      if (part < made.parts_.size()) {
        made.append(made.parts_[part]);
        ++i;
      } else {
        made.push_back(text[i]);
      }
    }
    return made;
  }

  /// The words alone, for those who store or print them.
  const std::string& english() const { return *this; }
  /// nullptr: verbatim.
  const char* pattern() const { return pattern_; }
  const std::vector<Sentence>& parts() const { return parts_; }

 private:
  const char* pattern_ = nullptr;
  std::vector<Sentence> parts_;
};

/// Marks a pattern that stands in a table and is said later.
constexpr const char* phrase(const char* pattern) {
  return pattern;
}

namespace sentence_part {
inline Sentence of(Sentence sentence) {
  return sentence;
}
inline Sentence of(std::string text) {
  return Sentence::verbatim(std::move(text));
}
inline Sentence of(std::string_view text) {
  return Sentence::verbatim(std::string(text));
}
inline Sentence of(const char* text) {
  return Sentence::verbatim(text);
}
inline Sentence of(char letter) {
  return Sentence::verbatim(std::string(1, letter));
}
template <typename Number, typename = std::enable_if_t<std::is_integral_v<Number>>>
Sentence of(Number number) {
  return Sentence::verbatim(std::to_string(number));
}
}  // namespace sentence_part

/// Numbers as printf() writes them, to stand in a sentence.
template <typename... Values>
std::string printed(const char* format, Values... values) {
  char text[160];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

template <typename... Parts>
Sentence say(const char* pattern, Parts&&... parts) {
  std::vector<Sentence> made;
  made.reserve(sizeof...(Parts));
  (made.push_back(sentence_part::of(std::forward<Parts>(parts))), ...);
  return Sentence::of(pattern, std::move(made));
}

}  // namespace kinebus

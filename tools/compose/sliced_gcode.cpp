#include "tools/compose/sliced_gcode.hpp"

#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <cmath>
#include <set>
#include <stdexcept>

namespace kinebus::compose {
namespace {

struct Word {
  char letter = 0;
  double value = 0;
  std::string text;
};

class Reader {
 public:
  explicit Reader(const std::string& name) : name_(name) {}

  void line(std::string_view text) {
    ++number_;
    const std::size_t semicolon = text.find(';');
    const std::string_view code = text.substr(0, semicolon);
    const std::vector<Word> words = split(code);
    if (words.empty()) {
      if (semicolon != std::string_view::npos && is_mark(text.substr(semicolon)))
        out_.items.emplace_back(std::string(text.substr(semicolon)));
      return;
    }
    command(words, std::string(code));
  }

  SlicedGcode finish() {
    out_.layers = static_cast<int>(heights_.size());
    return std::move(out_);
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw std::runtime_error(fmt::format("{}:{}: {}", name_, number_, why));
  }

  /// Comments that tell what is printed are kept; the slicer's settings are not.
  static bool is_mark(std::string_view comment) {
    return comment.starts_with(";TYPE:") || comment.starts_with(";LAYER_CHANGE") ||
           comment.starts_with(";Z:");
  }

  std::vector<Word> split(std::string_view text) const {
    std::vector<Word> out;
    std::size_t at = 0;
    while (at < text.size()) {
      if (std::isspace(static_cast<unsigned char>(text[at])) != 0) {
        ++at;
        continue;
      }
      Word word;
      word.letter = static_cast<char>(std::toupper(static_cast<unsigned char>(text[at])));
      if (word.letter < 'A' || word.letter > 'Z')
        refuse(fmt::format("expected a word such as X10.5, found '{}'", text.substr(at, 12)));
      const std::size_t begin = ++at;
      while (at < text.size() && std::isspace(static_cast<unsigned char>(text[at])) == 0 &&
             std::isalpha(static_cast<unsigned char>(text[at])) == 0)
        ++at;
      word.text = std::string(text.substr(begin, at - begin));
      const char* first = word.text.data();
      if (*first == '+') ++first;
      if (word.letter == 'M' && !out.empty() && out.front().letter == 'M') return out;  // a message's text
      const auto [end, error] = std::from_chars(first, word.text.data() + word.text.size(), word.value);
      if (!word.text.empty() && (error != std::errc{} || end != word.text.data() + word.text.size())) {
        if (!out.empty() && out.front().letter == 'M') return out;
        refuse(
            fmt::format("'{}{}' is not a word: a number belongs after the letter", word.letter, word.text));
      }
      out.push_back(word);
    }
    return out;
  }

  void command(const std::vector<Word>& words, const std::string& text) {
    const Word& head = words.front();
    const std::string name = head.letter + head.text;
    const int number = static_cast<int>(std::lround(head.value));
    const bool whole = head.value == number;
    if (head.letter == 'G' && whole && number >= 0 && number <= 3) return move(number, words);
    if (name == "G92") return set_position(words);
    if (name == "M82") return void(e_relative_ = false);
    if (name == "M83") return void(e_relative_ = true);
    if (name == "G21" || name == "G17" || name == "G90" || name == "T0") return;
    if (name == "G4" || name == "M106" || name == "M107") {
      out_.items.emplace_back(text);
      return;
    }
    if (name == "M104" || name == "M109") note(out_.hotend_celsius, words);
    if (name == "M140" || name == "M190") note(out_.bed_celsius, words);
    if (name == "G20") refuse("G20: a piece's G-code has to be in millimetres (G21)");
    if (name == "G91") refuse("G91: a piece's coordinates have to be absolute (G90); M83 is allowed");
    if (head.letter == 'T') refuse(name + ": the machine has one extruder, T0");
    if (head.letter == 'G' && number >= 53 && number <= 69 && number != 60 && number != 61 && number != 64)
      refuse(name + ": frames are set by the composer; export the piece in its own coordinates");
    if (head.letter != 'G' && head.letter != 'M') refuse(name + ": expected a G or M command");
    ++out_.left_out[name];
  }

  void move(int code, const std::vector<Word>& words) {
    SlicedMove move;
    move.code = code;
    bool fed = false;
    for (std::size_t i = 1; i < words.size(); ++i) {
      const Word& word = words[i];
      if (word.text.empty()) refuse(fmt::format("{} has no number", word.letter));
      switch (word.letter) {
        case 'X':
        case 'Y':
        case 'Z': {
          const auto axis = static_cast<std::size_t>(word.letter - 'X');
          move.to_mm[axis] = word.value;
          if (axis == 2) z_ = word.value;
          break;
        }
        case 'E':
          move.e_mm = e_relative_ ? word.value : word.value - e_;
          e_ = e_relative_ ? e_ + word.value : word.value;
          fed = move.e_mm > 0;
          break;
        case 'F':
          move.feed_mm_per_min = word.value;
          break;
        case 'I':
        case 'J':
        case 'K':
        case 'R':
          move.arc += fmt::format(" {}{}", word.letter, word.text);
          break;
        case 'S':
          break;  // laser power in some dialects
        default:
          refuse(fmt::format("{} means nothing in G{}", word.letter, code));
      }
    }
    out_.filament_mm += move.e_mm;
    if (fed && (move.to_mm[0] || move.to_mm[1])) heights_.insert(std::lround(z_ * 1000));
    out_.items.emplace_back(move);
  }

  void set_position(const std::vector<Word>& words) {
    for (std::size_t i = 1; i < words.size(); ++i) {
      if (words[i].letter != 'E')
        refuse("G92 may set only E in a piece: its coordinates have to stay as sliced");
      e_ = words[i].value;
    }
  }

  static void note(std::optional<double>& celsius, const std::vector<Word>& words) {
    for (const Word& word : words)
      if ((word.letter == 'S' || word.letter == 'R') && word.value > 0 && !celsius) celsius = word.value;
  }

  std::string name_;
  int number_ = 0;
  double e_ = 0, z_ = 0;
  bool e_relative_ = false;
  std::set<long> heights_;
  SlicedGcode out_;
};

}  // namespace

SlicedGcode read_sliced(std::string_view text, const std::string& name) {
  Reader reader(name);
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    reader.line(line);
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
  }
  return reader.finish();
}

}  // namespace kinebus::compose

#include "gateway/gcode/words/block.hpp"

#include <cmath>
#include <string>

#include "gateway/gcode/number.hpp"

namespace kinebus::gcode {
namespace {

constexpr double kLargestWord = 1e9;
constexpr int kRadiusMode = 80;           // G8
constexpr double kWholeTolerance = 1e-4;  // RS274/NGC: how near a computed number must be to the code's

bool is_letter(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}
bool is_name(char c) {
  return is_letter(c) || c == '_';
}
char upper(char c) {
  return c >= 'a' ? static_cast<char>(c - ('a' - 'A')) : c;
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r'))
    text.remove_suffix(1);
  return text;
}

class BlockReader {
 public:
  BlockReader(std::string_view line, const State& state, Block& block, SyntaxError& error)
      : cursor_{line.data(), line.data(), line.data() + line.size()},
        state_(state),
        block_(block),
        error_(error) {}

  bool read() {
    block_.clear();
    cursor_.skip_blanks();
    if (cursor_.at_end() || *cursor_.p == ';') return true;
    first_ = cursor_.p;
    if (*cursor_.p == '/') {
      block_.deleted = true;
      block_.plain = false;
      ++cursor_.p;
      cursor_.skip_blanks();
    }
    if (!cursor_.at_end() && *cursor_.p == '%') return read_percent();
    if (!cursor_.at_end() && upper(*cursor_.p) == 'N' && cursor_.p + 1 != cursor_.end &&
        !is_name(cursor_.p[1]) && !read_line_number())
      return false;
    cursor_.skip_blanks();
    if (cursor_.end - cursor_.p > 1 && (is_name(cursor_.p[1]) || is_question()) && read_command())
      return true;
    for (;;) {
      cursor_.skip_blanks();
      if (cursor_.at_end()) return true;
      const char c = *cursor_.p;
      if (is_letter(c)) {
        if (!read_word(upper(c))) return false;
      } else if (c == ';') {
        return true;
      } else if (!read_other(c)) {
        return false;
      }
    }
  }

 private:
  bool fail(std::uint32_t column, Sentence message) {
    error_.column = column;
    error_.message = std::move(message);
    return false;
  }
  bool fail_here(Sentence message) { return fail(cursor_.column(), std::move(message)); }

  /// T? of filament units: the operator chooses.
  bool is_question() const { return upper(*cursor_.p) == 'T' && cursor_.p[1] == '?'; }

  /// A word of several letters that begins the line, and its text. False: it is none.
  bool read_command() {
    if (!is_letter(*cursor_.p) && *cursor_.p != '_') return false;
    // Xsin[30] is a word and its value.
    Cursor value{cursor_.begin, cursor_.p + 1, cursor_.end};
    if (ValueReader(state_, value, error_).starts_value()) return false;
    const char* const start = cursor_.p;
    if (is_question()) cursor_.p += 2;
    while (!cursor_.at_end() && (is_name(*cursor_.p) || is_digit(*cursor_.p))) ++cursor_.p;
    block_.command = {start, static_cast<std::size_t>(cursor_.p - start)};
    block_.command_column = cursor_.column_of(start);
    return take_text();
  }

  bool read_percent() {
    block_.percent = true;
    block_.plain = false;
    ++cursor_.p;
    cursor_.skip_blanks();
    if (cursor_.at_end() || *cursor_.p == ';') return true;
    return fail_here(say("% stands alone in its line"));
  }

  bool read_line_number() {
    const std::uint32_t column = cursor_.column();
    ++cursor_.p;
    cursor_.skip_blanks();
    double number = 0;
    const char* const after = parse_decimal(cursor_.p, cursor_.end, number);
    if (after == nullptr || number < 0 || number > 4294967295.0 ||
        (number != std::floor(number) && state_.modal.dialect != Dialect::kLinuxCnc))
      return fail(column, say("N needs a whole number from 0 to 4294967295"));
    cursor_.p = after;
    block_.has_line_number = true;
    block_.line_number = static_cast<std::int64_t>(number);
    return true;
  }

  bool read_other(char c) {
    block_.plain = false;
    if (c == '(') return read_comment();
    if (c == '#') return read_assignment();
    if (c == '*') return read_checksum();
    if (c == '@' || c == '^') return read_polar(c);
    if (c == '/') return fail_here(say("/ (block delete) must be the first character of the line"));
    if (c == '%') return fail_here(say("% stands alone in its line"));
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7F)
      return fail_here(say("byte %1 is not G-code", static_cast<unsigned char>(c)));
    return fail_here(say("expected a letter before '%1'", c));
  }

  bool read_polar(char c) {
    block_.polar_column = cursor_.column();
    ++cursor_.p;
    std::optional<double>& place = c == '@' ? block_.polar_radius : block_.polar_angle;
    if (place) return fail(block_.polar_column, say("%1 stands twice in the line", std::string(1, c)));
    double value = 0;
    if (const char* after = parse_decimal(cursor_.p, cursor_.end, value)) {
      cursor_.p = after;
    } else if (ValueReader values(state_, cursor_, error_); !values.read_value(value)) {
      return false;
    }
    if (!(std::abs(value) <= kLargestWord))
      return fail(block_.polar_column, say("%1 is too large (10^9 at most)", std::string(1, c)));
    place = value;
    return true;
  }

  bool read_comment() {
    const std::uint32_t column = cursor_.column();
    const char* const start = ++cursor_.p;
    while (!cursor_.at_end() && *cursor_.p != ')') {
      if (*cursor_.p == '(') return fail_here(say("comments in ( ) cannot hold another ("));
      ++cursor_.p;
    }
    if (cursor_.at_end()) return fail(column, say("the comment needs a closing )"));
    const std::string_view text = trim({start, static_cast<std::size_t>(cursor_.p - start)});
    ++cursor_.p;
    if (text.size() > 3 && upper(text[0]) == 'M' && upper(text[1]) == 'S' && upper(text[2]) == 'G') {
      const std::string_view rest = trim(text.substr(3));
      if (!rest.empty() && rest.front() == ',') block_.messages.push_back(trim(rest.substr(1)));
    }
    return true;
  }

  bool read_assignment() {
    Assignment assignment;
    assignment.column = cursor_.column();
    ++cursor_.p;
    ValueReader values(state_, cursor_, error_);
    if (!values.read_parameter_ref(assignment.target)) return false;
    if (!cursor_.accept('=')) return fail_here(say("expected = after the parameter"));
    if (!values.read_value(assignment.value)) return false;
    if (block_.assignments.size() >= Block::kMaxAssignments)
      return fail(assignment.column, say("too many assignments in one line (32 at most)"));
    block_.assignments.push_back(std::move(assignment));
    return true;
  }

  /// *NN after the line's words: XOR of all bytes before the *.
  bool read_checksum() {
    const char* const star = cursor_.p;
    const std::uint32_t column = cursor_.column();
    if (!block_.has_line_number)
      return fail(column, say("a checksum needs a line number (N) at the line's beginning"));
    ++cursor_.p;
    int wanted = 0;
    const char* const digits = cursor_.p;
    while (!cursor_.at_end() && is_digit(*cursor_.p) && cursor_.p - digits < 4)
      wanted = wanted * 10 + (*cursor_.p++ - '0');
    if (cursor_.p == digits || wanted > 255) return fail(column, say("a checksum is a number from 0 to 255"));
    cursor_.skip_blanks();
    if (!cursor_.at_end() && *cursor_.p != ';') return fail_here(say("nothing can follow the checksum"));
    unsigned sum = 0;
    for (const char* p = first_; p != star; ++p) sum ^= static_cast<unsigned char>(*p);
    if (sum != static_cast<unsigned>(wanted))
      return fail(column, say("the checksum is %1, not %2", sum, wanted));
    block_.has_checksum = true;
    return true;
  }

  bool read_word(char letter) {
    const std::uint32_t column = cursor_.column();
    ++cursor_.p;
    double value = 0;
    bool has_value = true;
    if (const char* after = parse_decimal(cursor_.p, cursor_.end, value)) [[likely]] {
      cursor_.p = after;
    } else {
      ValueReader values(state_, cursor_, error_);
      has_value = values.starts_value();
      if (has_value && !values.read_value(value)) return false;
    }
    if (letter == 'A' && state_.modal.a_extrudes) {
      letter = 'E';
      block_.a_taken = true;
    }
    if (letter == 'G') return has_value ? add_g(value, column) : fail(column, say("G needs a number"));
    if (letter == 'M') return has_value ? add_m(value, column) : fail(column, say("M needs a number"));
    // A bare O belongs to G28 (home where it is needed).
    if (letter == 'O' && (has_value || (!cursor_.at_end() && *cursor_.p == '<')))
      return fail(column, say("an O word stands at the beginning of its line"));
    if (!(std::abs(value) <= kLargestWord))
      return fail(column, say("%1 is too large (10^9 at most)", std::string(1, letter)));
    const std::uint32_t bit = Block::bit(letter);
    if ((block_.present & bit) != 0)
      return fail(column, say("%1 stands twice in the line (first at column %2)", std::string(1, letter),
                              block_.column_of(letter)));
    block_.present |= bit;
    block_.value[Block::index(letter)] = value;
    block_.column[Block::index(letter)] = column;
    if (!has_value) {
      block_.bare |= bit;
      block_.plain = false;
    }
    return true;
  }

  bool add_g(double value, std::uint32_t column) {
    const double tenths = std::round(value * 10);
    if (!(tenths >= 0 && tenths < 10000) || std::abs(value * 10 - tenths) > kWholeTolerance)
      return fail(column, say("G codes are 0 to 999.9 with one decimal place at most"));
    const int number = static_cast<int>(tenths);
    GGroup group = g_group(number);
    if (number == kThread || number == kRigidTap || number == kThreadingCycle) [[unlikely]]
      group = state_.modal.threads ? GGroup::kMotion
              : number == kThread  ? GGroup::kHarmless
                                   : GGroup::kUnknown;
    if (group >= GGroup::kUnknown) {
      if (group == GGroup::kUnknown) return fail(column, unknown_g(number));
      block_.harmless_g = number;
      block_.plain = false;
      // A mode of lathes, not a code with words of its own.
      return number == kRadiusMode || take_text();
    }
    if (block_.has(group)) {
      const Code other = block_.code(group);
      return fail(column, say("%1 and %2 (column %3) are of one modal group: only one can stand in a line",
                              g_name(number), g_name(other.number), other.column));
    }
    if (group != GGroup::kMotion) block_.plain = false;
    block_.groups |= 1U << static_cast<unsigned>(group);
    block_.g[static_cast<std::size_t>(group)] = {number, column};
    // G29 S1 P"name" J: no words of which every one has a value.
    return number != 290 || take_text();
  }

  bool add_m(double value, std::uint32_t column) {
    block_.plain = false;
    double number = std::round(value);
    // M862.3 and its like are harmless with all their decimals.
    if (std::floor(value + kWholeTolerance) == 862) number = 862;
    if (!(number >= 0 && number < 10000) || (std::abs(value - number) > kWholeTolerance && number != 862))
      return fail(column, say("M codes are whole numbers"));
    const Code code{static_cast<int>(number), column};
    const MGroup group = m_group(code.number);
    if (group == MGroup::kUnknown) return fail(column, unknown_m(code.number));
    for (int i = 0; i < block_.m_count; ++i) {
      const Code other = block_.m[static_cast<std::size_t>(i)];
      if (other.number == code.number ||
          (group != MGroup::kOther && group != MGroup::kHarmless && m_group(other.number) == group))
        return fail(column, say("%1 and M%2 (column %3) exclude one another: only one can stand in a line",
                                m_name(code.number), other.number, other.column));
    }
    if (block_.m_count == Block::kMaxMCodes)
      return fail(column, say("too many M codes in one line (8 at most)"));
    block_.m[static_cast<std::size_t>(block_.m_count++)] = code;
    if (code.number <= 1) {
      // M0 Press the button
      cursor_.skip_blanks();
      if (cursor_.end - cursor_.p > 1 && is_letter(*cursor_.p) && is_letter(cursor_.p[1]))
        return take_text(code.number);
    }
    if (code.number == 115) {
      // U3.9.0, the firmware that the slicer expects, is no number.
      cursor_.skip_blanks();
      if (!cursor_.at_end() && upper(*cursor_.p) == 'U') return take_text(code.number);
    }
    if (code.number == 98) {
      // P"name" is a text, P1234 a word.
      cursor_.skip_blanks();
      if (cursor_.end - cursor_.p > 1 && upper(*cursor_.p) == 'P' && cursor_.p[1] == '"')
        return take_text(code.number);
    }
    return takes_text(code.number) ? take_text(code.number) : true;
  }

  /// The rest of the line, up to ; or the checksum, is text (of this M code).
  bool take_text(int m_number = -1) {
    block_.plain = false;
    cursor_.skip_blanks();
    const char* const start = cursor_.p;
    const char* stop = start;
    while (stop != cursor_.end && *stop != ';') ++stop;
    if (block_.has_line_number) {
      for (const char* p = stop; p != start; --p) {
        if (is_digit(p[-1]) || p[-1] == ' ' || p[-1] == '\r') continue;
        if (p[-1] == '*') stop = p - 1;
        break;
      }
    }
    block_.text_of_m = m_number;
    block_.text_column = cursor_.column();
    block_.text = trim({start, static_cast<std::size_t>(stop - start)});
    cursor_.p = stop;
    return true;
  }

  Cursor cursor_;
  const char* first_ = nullptr;
  const State& state_;
  Block& block_;
  SyntaxError& error_;
};

}  // namespace

bool Block::has_m(int number) const {
  for (int i = 0; i < m_count; ++i)
    if (m[static_cast<std::size_t>(i)].number == number) return true;
  return false;
}

void Block::clear() {
  present = bare = groups = 0;
  m_count = 0;
  harmless_g = -1;
  if (!plain) polar_radius.reset(), polar_angle.reset();
  command = {};
  has_line_number = has_checksum = a_taken = deleted = percent = false;
  text_of_m = -1;
  plain = true;
  if (!messages.empty()) messages.clear();
  if (!assignments.empty()) assignments.clear();
}

bool read_block(std::string_view line, const State& state, Block& block, SyntaxError& error) {
  return BlockReader(line, state, block, error).read();
}

}  // namespace kinebus::gcode

#include "protocol/can/candump.hpp"

namespace kinebus {
namespace {

constexpr std::string_view kDigits = "0123456789ABCDEF";
constexpr std::string_view kBlanks = " \t\r\n";

int hex_value(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

/// substr() without its exception: the caller has checked the bounds.
std::string_view slice(std::string_view text, std::size_t from, std::size_t to) {
  return {text.data() + from, to - from};
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return slice(text, first, text.find_last_not_of(kBlanks) + 1);
}

/// Takes the first word off `text`.
std::string_view take_word(std::string_view& text) {
  text = trimmed(text);
  const auto end = std::min(text.find_first_of(kBlanks), text.size());
  const std::string_view word = slice(text, 0, end);
  text.remove_prefix(end);
  return word;
}

std::optional<std::int64_t> parse_number(std::string_view digits) {
  if (digits.empty() || digits.size() > 12) return std::nullopt;
  std::int64_t value = 0;
  for (const char c : digits) {
    if (c < '0' || c > '9') return std::nullopt;
    value = value * 10 + (c - '0');
  }
  return value;
}

std::optional<std::chrono::microseconds> parse_time(std::string_view word) {
  if (word.size() < 3 || word.front() != '(' || word.back() != ')') return std::nullopt;
  word = slice(word, 1, word.size() - 1);
  const auto dot = word.find('.');
  if (dot == std::string_view::npos || word.size() - dot - 1 != 6) return std::nullopt;
  const auto seconds = parse_number(slice(word, 0, dot));
  const auto micros = parse_number(slice(word, dot + 1, word.size()));
  if (!seconds || !micros) return std::nullopt;
  return std::chrono::microseconds{*seconds * 1'000'000 + *micros};
}

template <typename Text>
void add_hex(Text& text, std::uint32_t value, int digits) {
  for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4) text.add(kDigits[(value >> shift) & 0xF]);
}

template <typename Text>
void add_decimal(Text& text, std::int64_t value, int least_digits) {
  std::array<char, 20> reversed{};
  std::size_t size = 0;
  do {
    reversed[size++] = static_cast<char>('0' + value % 10);
    value /= 10;
  } while (value > 0);
  for (int i = static_cast<int>(size); i < least_digits; ++i) text.add('0');
  while (size > 0) text.add(reversed[--size]);
}

}  // namespace

FrameText to_text(const CanFrame& frame) {
  FrameText text;
  add_hex(text, frame.id, frame.extended ? 8 : 3);
  text.add('#');
  if (frame.remote) {
    text.add('R');
    if (frame.length > 0) text.add(kDigits[frame.length & 0xF]);
    return text;
  }
  for (const std::uint8_t byte : frame.bytes()) add_hex(text, byte, 2);
  return text;
}

CandumpText to_candump(const CandumpLine& line) {
  CandumpText text;
  if (line.time) {
    const std::int64_t us = std::max<std::int64_t>(line.time->count(), 0);
    text.add('(');
    add_decimal(text, us / 1'000'000, 10);
    text.add('.');
    add_decimal(text, us % 1'000'000, 6);
    text.add(") ");
  }
  if (!line.interface.empty()) {
    text.add(slice(line.interface, 0, std::min<std::size_t>(line.interface.size(), 16)));
    text.add(' ');
  }
  text.add(to_text(line.frame).view());
  return text;
}

std::optional<CanFrame> parse_frame(std::string_view text) {
  text = trimmed(text);
  const auto hash = text.find('#');
  if (hash != 3 && hash != 8) return std::nullopt;
  CanFrame frame;
  frame.extended = hash == 8;
  for (const char c : slice(text, 0, hash)) {
    const int digit = hex_value(c);
    if (digit < 0) return std::nullopt;
    frame.id = (frame.id << 4) | static_cast<std::uint32_t>(digit);
  }
  if (frame.id > (frame.extended ? 0x1FFF'FFFFu : 0x7FFu)) return std::nullopt;
  text.remove_prefix(hash + 1);

  if (!text.empty() && (text.front() == 'R' || text.front() == 'r')) {
    frame.remote = true;
    text.remove_prefix(1);
    if (text.empty()) return frame;
    const int length = hex_value(text.front());
    if (text.size() != 1 || length < 0 || length > 8) return std::nullopt;
    frame.length = static_cast<std::uint8_t>(length);
    return frame;
  }
  while (!text.empty()) {
    if (frame.length > 0 && text.front() == '.') text.remove_prefix(1);
    if (text.size() < 2 || frame.length == 8) return std::nullopt;
    const int high = hex_value(text[0]), low = hex_value(text[1]);
    if (high < 0 || low < 0) return std::nullopt;
    frame.data[frame.length++] = static_cast<std::uint8_t>(high * 16 + low);
    text.remove_prefix(2);
  }
  return frame;
}

std::optional<CandumpLine> parse_candump(std::string_view line) {
  CandumpLine result;
  std::string_view rest = line;
  std::string_view word = take_word(rest);
  if (!word.empty() && word.front() == '(') {
    result.time = parse_time(word);
    if (!result.time) return std::nullopt;
    word = take_word(rest);
  }
  if (word.find('#') == std::string_view::npos) {
    result.interface = word;
    word = take_word(rest);
  }
  // can-utils may add the direction (T or R) behind the frame.
  const std::string_view direction = take_word(rest);
  if (!direction.empty() && direction != "T" && direction != "R") return std::nullopt;
  if (!trimmed(rest).empty()) return std::nullopt;
  const auto frame = parse_frame(word);
  if (!frame) return std::nullopt;
  result.frame = *frame;
  return result;
}

}  // namespace kinebus

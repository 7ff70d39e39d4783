#include "gateway/sessions/serial/line_reader.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <iterator>

namespace kinebus::serial {
namespace {

/// Lines that a host may send once more after it was asked for one before them: as many as are under way.
constexpr std::size_t kRemembered = 64;
constexpr std::size_t kMostDigits = 9;

bool blank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Takes a whole number off the front.
std::optional<long> take_number(std::string_view& text) {
  const bool negative = !text.empty() && text.front() == '-';
  std::string_view digits = text.substr(negative ? 1 : 0);
  const std::size_t count = std::min(digits.find_first_not_of("0123456789"), digits.size());
  if (count == 0 || count > kMostDigits) return std::nullopt;
  long value = 0;
  std::from_chars(digits.data(), digits.data() + count, value);
  text = digits.substr(count);
  return negative ? -value : value;
}

/// A terminal that a host has just opened sends back what it hears until the host has switched that off.
bool own_words_come_back(std::string_view text) {
  constexpr std::string_view kAnswers[] = {"ok ", "echo:", "Error:", "Resend:", "T:", "Cap:", "//"};
  return text == "ok" || text == "start" ||
         std::any_of(std::begin(kAnswers), std::end(kAnswers),
                     [text](std::string_view answer) { return text.substr(0, answer.size()) == answer; });
}

std::uint64_t hash_of(std::string_view text) {
  std::uint64_t hash = 14695981039346656037u;  // FNV-1a
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return hash;
}

char upper(char c) {
  return static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
}

}  // namespace

Code code_of(std::string_view text) {
  text = trimmed(text);
  if (text.empty()) return {};
  Code code;
  code.letter = upper(text.front());
  text.remove_prefix(1);
  const std::size_t count = std::min(text.find_first_not_of("0123456789"), text.size());
  if (count > 0 && count <= 5) {
    int value = 0;
    std::from_chars(text.data(), text.data() + count, value);
    code.number = value;
  }
  return code;
}

std::string_view argument(std::string_view text) {
  text = trimmed(text);
  std::size_t at = 1;
  while (at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])) != 0) ++at;
  return trimmed(text.substr(std::min(at, text.size())));
}

std::optional<double> word(std::string_view text, char letter) {
  const std::string_view rest = argument(text);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    if (upper(rest[i]) != letter) continue;
    const std::string number(rest.substr(i + 1, 24));
    char* end = nullptr;
    const double value = std::strtod(number.c_str(), &end);
    if (end != number.c_str() && std::isfinite(value)) return value;
  }
  return std::nullopt;
}

Urgent urgent(std::string_view text) {
  const Code code = code_of(text);
  if (code.is('M', 112)) return Urgent::kEmergencyStop;
  if (code.is('M', 108)) return Urgent::kGoOn;
  if (code.is('M', 410)) return Urgent::kQuickStop;
  const bool heats = code.is('M', 104) || code.is('M', 140) || code.is('M', 141);
  if (heats && word(text, 'S') == 0.0) return Urgent::kHeaterOff;
  return Urgent::kNone;
}

void LineReader::on_bytes(LocalTime now, std::span<const std::uint8_t> bytes) {
  last_byte_ = now;
  for (const std::uint8_t byte : bytes) {
    const char c = static_cast<char>(byte);
    if (c == '\n' || c == '\r') {
      if (!partial_.empty() || too_long_) finish(partial_);
      partial_.clear();
      too_long_ = false;
    } else if (partial_.size() < kMaxLine) {
      partial_ += c;
    } else {
      too_long_ = true;
    }
  }
}

void LineReader::on_time(LocalTime now) {
  if (now < next_deadline()) return;
  // Its line end was damaged: host and gateway would wait for each other forever.
  Line line;
  if (damaged(line, "No line end")) lines_.push_back(std::move(line));
  partial_.clear();
  too_long_ = false;
}

LocalTime LineReader::next_deadline() const {
  const std::string_view begun = trimmed(partial_);
  const bool numbered = begun.size() > 1 && begun[0] == 'N' &&
                        (begun[1] == '-' || std::isdigit(static_cast<unsigned char>(begun[1])) != 0);
  return numbered ? last_byte_ + kUnfinished : LocalTime::max();
}

std::optional<Line> LineReader::next() {
  if (lines_.empty()) return std::nullopt;
  Line line = std::move(lines_.front());
  lines_.pop_front();
  return line;
}

bool LineReader::damaged(Line& line, std::string why) {
  line.error = std::move(why) + ", Last Line: " + std::to_string(last_number_);
  line.resend = last_number_ + 1;
  return true;
}

void LineReader::remember(long number, std::string_view text) {
  last_number_ = number;
  accepted_.push_back({number, hash_of(text)});
  if (accepted_.size() > kRemembered) accepted_.pop_front();
}

bool LineReader::known(long number, std::string_view text) const {
  return std::any_of(accepted_.begin(), accepted_.end(), [&](const Accepted& line) {
    return line.number == number && line.hash == hash_of(text);
  });
}

void LineReader::finish(std::string_view raw) {
  Line line;
  std::string_view text = trimmed(raw);
  const auto keep = [&] { lines_.push_back(std::move(line)); };
  if ((text.empty() || own_words_come_back(text)) && !too_long_) return;
  if (too_long_ || text.find('\0') != std::string_view::npos) {
    // Hosts go on after "Format error"; words that they do not know make them give up.
    damaged(line, too_long_ ? "Format error: line too long" : "Format error: unreadable line");
    return keep();
  }
  std::optional<long> number;
  std::string_view rest = text;
  if (rest.front() == 'N') {
    rest.remove_prefix(1);
    number = take_number(rest);
    if (!number) rest = text;
  }
  const std::size_t star = rest.rfind('*');
  if (number || star != std::string_view::npos) {
    // Semicolons cut comments off only in lines that carry no checksum: the checksum covers all before it.
    std::string_view sum =
        star == std::string_view::npos ? std::string_view() : trimmed(rest.substr(star + 1));
    const auto stated = take_number(sum);
    if (star == std::string_view::npos || !stated || !sum.empty()) {
      damaged(line, "No Checksum with line number");
      return keep();
    }
    const std::size_t covered = text.rfind('*');
    unsigned computed = 0;
    for (const char c : text.substr(0, covered)) computed ^= static_cast<unsigned char>(c);
    if (static_cast<long>(computed) != *stated) {
      damaged(line, "checksum mismatch");
      return keep();
    }
    rest = trimmed(rest.substr(0, star));
  }
  const Code code = code_of(rest);
  if (code.is('M', 110)) {
    const auto stated = word(rest, 'N');
    last_number_ = stated && std::abs(*stated) < 1e9 ? static_cast<long>(*stated) : number.value_or(0);
    accepted_.clear();
  } else if (number) {
    if (*number <= last_number_ && known(*number, rest)) {
      line.repeated = true;
      return keep();
    }
    if (*number != last_number_ + 1) {
      damaged(line, "Line Number is not Last Line Number+1");
      return keep();
    }
    remember(*number, rest);
  }
  line.number = number;
  // A parenthesis may hold a semicolon, a text code's text not.
  line.text = std::string(trimmed(rest.substr(0, rest.find(';'))));
  keep();
}

}  // namespace kinebus::serial

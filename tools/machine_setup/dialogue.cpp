#include "tools/machine_setup/dialogue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <vector>

#include "gateway/near_word.hpp"
#include "protocol/joblink/shown_text.hpp"

namespace kinebus {
namespace {

std::string lower(std::string_view text) {
  std::string out;
  for (const char c : text) out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

/// What is shown again of a wrong answer at most.
constexpr std::size_t kMostShown = 60;

std::optional<int> whole(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

void Dialogue::say(std::string_view line) {
  io_.print(fmt::format("{}\n", line));
}

std::string Dialogue::answer(std::string_view prompt) {
  io_.print(prompt);
  const auto line = io_.read_line();
  if (!line) throw SetupInterrupted("interrupted");
  std::string text = lower(*line);
  const auto blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  text.erase(text.begin(), std::find_if_not(text.begin(), text.end(), blank));
  text.erase(std::find_if_not(text.rbegin(), text.rend(), blank).base(), text.end());
  return text;
}

std::size_t Dialogue::choose(std::string_view place, std::string_view question,
                             std::span<const SetupChoice> choices, std::optional<std::size_t> usual) {
  say(question);
  std::string words;
  std::vector<std::string_view> known;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    say(choices[i].description.empty()
            ? fmt::format("  {}  {}", i + 1, choices[i].word)
            : fmt::format("  {}  {:<12} {}", i + 1, choices[i].word, choices[i].description));
    words += (i == 0 ? "" : ", ") + std::string(choices[i].word);
    known.push_back(choices[i].word);
  }
  const std::string prompt = usual ? fmt::format("[{}] > ", choices[*usual].word) : "> ";
  for (;;) {
    const std::string text = answer(prompt);
    if (text.empty() && usual) return *usual;
    if (const auto word = std::find_if(known.begin(), known.end(),
                                       [&](std::string_view each) { return lower(each) == text; });
        word != known.end())
      return static_cast<std::size_t>(word - known.begin());
    if (const auto n = whole(text); n && *n >= 1 && *n <= static_cast<int>(choices.size()))
      return static_cast<std::size_t>(*n - 1);
    const std::string_view near = near_word(known, text);
    say(fmt::format("{}: found '{}'; expected 1 .. {} or one of {}{}", place, cut_text(text, kMostShown),
                    choices.size(), words, near.empty() ? "" : fmt::format(" (did you mean {}?)", near)));
  }
}

bool Dialogue::yes(std::string_view place, std::string_view question, bool usual) {
  for (;;) {
    const std::string text = answer(fmt::format("{} [{}] > ", question, usual ? "Y/n" : "y/N"));
    if (text.empty()) return usual;
    if (text == "y" || text == "yes") return true;
    if (text == "n" || text == "no") return false;
    say(fmt::format("{}: found '{}'; expected y or n", place, cut_text(text, kMostShown)));
  }
}

int Dialogue::number(std::string_view place, std::string_view question, int least, int most, int usual) {
  for (;;) {
    const std::string text = answer(fmt::format("{} [{}] > ", question, usual));
    if (text.empty()) return usual;
    if (const auto n = whole(text); n && *n >= least && *n <= most) return *n;
    say(fmt::format("{}: found '{}'; expected a whole number in {} .. {}", place, cut_text(text, kMostShown),
                    least, most));
  }
}

std::string Dialogue::line(std::string_view question) {
  io_.print(fmt::format("{} > ", question));
  const auto text = io_.read_line();
  if (!text) throw SetupInterrupted("interrupted");
  return *text;
}

}  // namespace kinebus

#pragma once
// Questions and answers in lines of text, for a person or for a pipe. What is no answer is said with its
// place and what is expected, and asked again.

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "tools/machine_setup/board_set.hpp"

namespace kinebus {

/// The person has interrupted it, or the input has ended.
struct SetupInterrupted : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Dialogue {
 public:
  struct Io {
    /// The next line without its end; nullopt: there is none any more, or Ctrl-C.
    std::function<std::optional<std::string>()> read_line;
    std::function<void(std::string_view)> print;
  };
  explicit Dialogue(Io io) : io_(std::move(io)) {}

  void say(std::string_view line);
  /// Place in `choices`, answered by number or word; an empty line takes `usual`. `place`: what is asked for,
  /// in the words of what is wrong with an answer. All may throw SetupInterrupted.
  std::size_t choose(std::string_view place, std::string_view question, std::span<const SetupChoice> choices,
                     std::optional<std::size_t> usual = std::nullopt);
  bool yes(std::string_view place, std::string_view question, bool usual);
  /// A whole number in `least` .. `most`.
  int number(std::string_view place, std::string_view question, int least, int most, int usual);
  /// Any line; empty: "".
  std::string line(std::string_view question);

 private:
  std::string answer(std::string_view prompt);

  Io io_;
};

}  // namespace kinebus

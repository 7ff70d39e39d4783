#pragma once
// One card for a program that speaks lines: commands in, one a line, and what becomes of them out, one line
// of JSON each. Twice a second, and while a motor moves, the card's state.
//
//   current A|B RUN_MA HOLD_MA    on A|B    off A|B    jog A|B COUNTS COUNTS_PER_S    stop    tune A|B store
//   {"state": ...}    {"done": "jog A", ...}    {"refused": "words"}    {"silent": "words"}: the node does
//   not answer

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/card/card.hpp"

namespace kinebus {

class CardSession {
 public:
  struct Lines {
    /// The next line until `until`, as now() tells it.
    std::function<std::optional<std::string>(LocalTime until)> next;
    /// Nobody is there any more: what moves stops by its ramp, and run() returns.
    std::function<bool()> ended;
    std::function<void(const std::string&)> tell;
    std::function<LocalTime()> now;
  };

  CardSession(Card& card, Lines lines) : card_(card), lines_(std::move(lines)) {}
  void run();

 private:
  void tell_state();
  void carry_out(const std::string& line);
  /// What is to be told with "done" beside the command; throws CardError.
  std::string act(const std::vector<std::string>& words);
  std::string jog(int axis, std::int64_t counts, double counts_per_s);
  bool stop_wanted();

  Card& card_;
  Lines lines_;
  std::deque<std::string> waiting_;  ///< lines that came while a motor moved
  LocalTime told_{0};
  bool stopping_ = false;
};

}  // namespace kinebus

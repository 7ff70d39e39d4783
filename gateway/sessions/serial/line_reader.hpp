#pragma once
// The lines of a print host, as Marlin and its hosts agreed on them: "N12 G1 X10*97". Numbers and checksums
// are checked; a damaged or missing line is asked for again.

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "protocol/time.hpp"

namespace kinebus::serial {

/// A line as it came, good or not. Each gets exactly one "ok" in the end.
struct Line {
  std::string text;            ///< without number, checksum and comment
  std::optional<long> number;  ///< of N
  std::string error;           ///< not empty: damaged or out of order; `resend` is asked for again
  long resend = 0;
  bool repeated = false;  ///< was accepted before: the host sent it once more, nothing is to be done
};

/// Codes that must not wait behind other lines; seen as soon as their own line is whole.
enum class Urgent : std::uint8_t { kNone, kEmergencyStop, kGoOn, kQuickStop, kHeaterOff };
Urgent urgent(std::string_view text);

class LineReader {
 public:
  /// A numbered line whose end does not come within this time has lost it: it is asked for again.
  static constexpr LocalTime kUnfinished = std::chrono::milliseconds{800};
  static constexpr std::size_t kMaxLine = 1024;

  void on_bytes(LocalTime now, std::span<const std::uint8_t> bytes);
  void on_time(LocalTime now);
  LocalTime next_deadline() const;

  /// The next whole line; M110 has set its number already.
  std::optional<Line> next();
  long last_number() const { return last_number_; }

 private:
  struct Accepted {
    long number = 0;
    std::uint64_t hash = 0;
  };
  void finish(std::string_view raw);
  bool damaged(Line& line, std::string why);
  void remember(long number, std::string_view text);
  bool known(long number, std::string_view text) const;

  std::string partial_;
  bool too_long_ = false;
  LocalTime last_byte_{0};
  std::deque<Line> lines_;
  long last_number_ = 0;
  std::deque<Accepted> accepted_;  ///< the newest of them
};

/// "M104", letter and number of the line's first word; letter 0: none.
struct Code {
  char letter = 0;
  int number = -1;
  bool is(char wanted, int value) const { return letter == wanted && number == value; }
};
Code code_of(std::string_view text);
/// Value of a word such as S205.5.
std::optional<double> word(std::string_view text, char letter);
/// What follows the code, without blanks around it.
std::string_view argument(std::string_view text);

}  // namespace kinebus::serial

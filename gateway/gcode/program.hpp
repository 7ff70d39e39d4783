#pragma once
// The order in which lines are carried out: O words (subroutines, conditions, loops), numbered programs with
// M98 and M99, and the machine's macros.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "gateway/gcode/error.hpp"
#include "gateway/gcode/interpreter.hpp"
#include "gateway/gcode/o_word.hpp"
#include "gateway/result.hpp"

namespace kinebus::gcode {

/// Takes a text's lines one after the other. A line outside of every subroutine and loop goes to the
/// interpreter at once; what may be needed again is recorded: a subroutine until the text's end, a loop or
/// condition until it is done, and from an M98 whose program has not come yet all that follows it. While
/// busy(), recorded lines are due: step() carries out one of them, and line() must wait. Errors name the line
/// where the text stands. Bounded in memory, depth and steps, so that a loop without end is an error and not
/// a program that hangs.
class Program {
 public:
  static constexpr std::size_t kMaxText = 16U << 20;      ///< bytes recorded
  static constexpr std::size_t kMaxLines = 1'000'000;     ///< lines recorded
  static constexpr std::size_t kMaxDepth = 32;            ///< calls within calls
  static constexpr std::uint32_t kMaxLiveSteps = 10'000;  ///< of one line of Use::kLines

  enum class Use : std::uint8_t {
    kText,   ///< a whole text
    kLines,  ///< lines of a host or an operator: macros may be called, nothing is recorded
  };
  explicit Program(Interpreter& interpreter, Use use = Use::kText) : interpreter_(interpreter), use_(use) {}

  /// One line of the text; not while busy().
  Result<void, ParseError> line(std::string_view text, std::uint32_t number, CommandBuffer& out);
  bool busy() const { return !frames_.empty(); }
  /// Carries out one recorded line. After an error it goes on with the text behind what was called.
  Result<void, ParseError> step(CommandBuffer& out);
  /// The text is at its end: what is still open is an error (once), what waited for it becomes due.
  Result<void, ParseError> finish();

  /// Recorded lines carried out so far.
  std::uint64_t steps() const { return steps_; }

 private:
  static constexpr std::uint32_t kNowhere = 0xFFFFFFFF;
  static constexpr std::size_t kLocals = 30;

  struct Recorded {
    std::uint32_t line = 0;
    std::uint32_t begin = 0, size = 0;  ///< in text_
    OKind kind = OKind::kNone;
    std::uint32_t rest_at = 0;  ///< of the line: behind the keyword
    std::uint32_t next =
        kNowhere;                  ///< if, elseif: the next branch. while, do, repeat: their end. Ends: begin
    std::uint32_t end = kNowhere;  ///< branches: endif. break, continue: the loop's begin
    std::string label;             ///< of lines with an O word
  };
  struct Range {
    std::uint32_t begin = 0, end = 0;
    std::uint32_t line = 0;  ///< where it is defined
  };
  struct Open {
    OKind kind{};
    std::uint32_t index = 0;
    std::uint32_t last_branch = 0;
    bool has_else = false;
  };
  struct Counter {
    std::uint32_t loop = 0;
    double left = 0;
  };
  enum class FrameKind : std::uint8_t { kBlock, kSub, kProgram, kMacro, kRest };
  struct Frame {
    FrameKind kind{};
    std::uint32_t at = 0, begin = 0, end = 0;
    std::uint32_t called_from = 0;  ///< line of the call; 0: of the text itself
    int repeats = 0;                ///< M98 L: times to go again
    std::uint32_t as_line = 0;      ///< macros: the line that called stands for theirs
    std::string name;               ///< what was called
    std::vector<Counter> counters;
    bool own_locals = false;
    Locals locals;  ///< the caller's
  };

  Result<void, ParseError> fail(std::uint32_t line, std::uint32_t column, Sentence message);
  /// As fail(), of a recorded line at work: leaves everything that was called.
  Result<void, ParseError> abandon(ParseError error);

  Result<void, ParseError> record(std::string_view text, std::uint32_t number, OWord& word);
  Result<void, ParseError> nest(const OWord& word, std::uint32_t number, std::uint32_t index);
  Result<void, ParseError> wrong_end(const OWord& word, std::uint32_t number);
  Result<void, ParseError> begin_rest(std::uint32_t number);
  bool has_rest_program(int number, Range& range) const;
  void leave_all();

  Result<double, ParseError> value_of(const Recorded& line);
  Result<bool, ParseError> condition(const Recorded& line);
  Result<void, ParseError> run(std::uint32_t index, CommandBuffer& out);
  Result<void, ParseError> run_plain(std::string_view text, std::uint32_t number, CommandBuffer& out);
  Result<void, ParseError> call_o(std::string_view text, const OWord& word, std::uint32_t number);
  Result<void, ParseError> follow_call(std::uint32_t number);
  Result<void, ParseError> call_program(const ProgramCall& call, std::uint32_t number);
  Result<void, ParseError> call_macro(const ProgramCall& call, std::uint32_t number);
  Result<void, ParseError> push(Frame frame, std::uint32_t column);
  Result<void, ParseError> give_back(const Recorded& line);
  Result<void, ParseError> choose_branch(std::uint32_t index);
  Result<void, ParseError> repeat(std::uint32_t index);
  void leave_frame();
  void leave_loops(std::uint32_t from);
  std::uint32_t shown_line(std::uint32_t number) const;
  std::string_view text_of(const Recorded& line) const {
    return std::string_view(text_).substr(line.begin, line.size);
  }

  Interpreter& interpreter_;
  Use use_;
  std::string text_;
  std::vector<Recorded> lines_;
  std::vector<Open> open_;                         ///< of what is being recorded
  std::unordered_map<std::string, Range> subs_;    ///< by label
  std::unordered_map<std::string, Range> macros_;  ///< by name
  std::vector<Frame> frames_;
  std::size_t kept_lines_ = 0, kept_text_ = 0;  ///< of definitions: what stays when a loop is done
  bool passes_over_ = false;                    ///< a block is wrong: the text's rest has no meaning
  bool named_ = false;                          ///< the main program's O number came
  bool rest_ = false;                           ///< all that comes is recorded: a program is looked for
  ProgramCall waiting_;                         ///< for that program
  std::uint32_t waiting_line_ = 0;
  std::size_t rest_begin_ = 0;
  std::uint64_t steps_ = 0;
};

}  // namespace kinebus::gcode

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
#include "gateway/gcode/programs/recording.hpp"
#include "gateway/gcode/words/meta_word.hpp"
#include "gateway/gcode/words/o_word.hpp"
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
  static constexpr std::size_t kLocals = 30;

  struct Counter {
    std::uint32_t loop = 0;
    double left = 0;  ///< repetitions; of a meta while: how often it was done
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

  /// An error of a recorded line at work: leaves everything that was called.
  Result<void, ParseError> abandon(ParseError error);

  // program_meta.cpp: RepRapFirmware's meta commands
  Result<void, ParseError> meta_line(std::string_view text, std::uint32_t number, CommandBuffer& out);
  void tell_iterations();
  MetaLine meta_of(std::string_view text, std::uint32_t number, std::size_t rest_at) const;
  Result<bool, ParseError> meta_condition(const Recording::Line& line);
  Result<void, ParseError> run_meta(const Recording::Line& line, CommandBuffer& out);
  Result<void, ParseError> add_ends(const std::vector<OWord>& ends, std::uint32_t number);
  void begin_block();

  Result<void, ParseError> record(std::string_view text, std::uint32_t number, const OWord& word);
  /// An error in what is recorded: the text's rest has no meaning.
  Result<void, ParseError> give_up(ParseError error);
  Result<void, ParseError> begin_rest(std::uint32_t number);
  Result<void, ParseError> call_waiting_o();
  void leave_all();

  Result<double, ParseError> value_of(const Recording::Line& line);
  Result<bool, ParseError> condition(const Recording::Line& line);
  Result<void, ParseError> run(std::uint32_t index, CommandBuffer& out);
  Result<void, ParseError> run_plain(std::string_view text, std::uint32_t number, CommandBuffer& out);
  Result<void, ParseError> call_o(std::string_view text, const OWord& word, std::uint32_t number);
  Result<void, ParseError> follow_call(std::uint32_t number);
  Result<void, ParseError> call_program(const ProgramCall& call, std::uint32_t number);
  Result<void, ParseError> call_profile(const ProgramCall& call, std::uint32_t number);
  Result<void, ParseError> cut_profile(CommandBuffer& out);
  Result<void, ParseError> call_macro(const ProgramCall& call, std::uint32_t number);
  Result<void, ParseError> push(Frame frame, std::uint32_t column);
  Result<void, ParseError> give_back(const Recording::Line& line);
  Result<void, ParseError> choose_branch(std::uint32_t index);
  Result<void, ParseError> repeat(std::uint32_t index);
  void leave_frame();
  void leave_loops(std::uint32_t from);
  std::uint32_t shown_line(std::uint32_t number) const;

  Interpreter& interpreter_;
  Use use_;
  Recording recording_;
  MetaBlocks blocks_;                                         ///< of the text
  std::unordered_map<std::string, Recording::Range> macros_;  ///< by name
  std::vector<Frame> frames_;
  std::size_t profile_depth_ = 0;  ///< of frames with the profile of G71 at work; 0: none is
  bool passes_over_ = false;       ///< a block is wrong: the text's rest has no meaning
  bool named_ = false;             ///< the main program's O number came
  bool rest_ = false;              ///< all that comes is recorded: a program is looked for
  ProgramCall waiting_;            ///< for that program
  std::string waiting_o_;          ///< the line that calls it, when an O word does
  std::uint32_t waiting_line_ = 0;
  std::uint32_t rest_begin_ = 0;
  std::uint64_t steps_ = 0;
};

}  // namespace kinebus::gcode

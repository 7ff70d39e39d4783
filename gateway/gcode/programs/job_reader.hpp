#pragma once
// A job's text in chunks of bytes, as it comes from a file or a connection, to canonical commands.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/gcode/error.hpp"
#include "gateway/gcode/interpreter.hpp"
#include "gateway/gcode/programs/program.hpp"
#include "gateway/result.hpp"

namespace kinebus::gcode {

/// Splits chunks into lines, counts them from 1 and hands them to the interpreter. Lines end with LF or CRLF;
/// in a text whose first line ends with CR alone, with CR, LF or CRLF. The last line may lack its end, a byte
/// order mark of UTF-8 is passed over. Refused: what is no text (named where it is known: binary G-code, ZIP,
/// gzip, UTF-16), NUL bytes, lines of more than kMaxLine bytes that are not comments. Memory: one line, and
/// what Program keeps of subroutines and loops.
class JobReader {
 public:
  static constexpr std::size_t kMaxLine = 4096;

  static constexpr std::uint32_t kWithoutEnd = 0xFFFFFFFF;

  /// `steps_a_call`: recorded lines (of loops, subroutines, macros) that one call carries out at most, so
  /// that a short text cannot fill the memory with commands: then busy() says that more of them are due.
  explicit JobReader(Interpreter& interpreter, std::uint32_t steps_a_call = kWithoutEnd)
      : interpreter_(interpreter), program_(interpreter), steps_a_call_(steps_a_call) {}

  /// Carries out all whole lines of the text so far. After an error the reader stays at it: every further
  /// call returns the same error. Text after the program's end is passed over.
  Result<void, ParseError> read(std::string_view chunk, CommandBuffer& out);
  /// Bytes of the last chunk that are done with: fewer than it had only when a line was refused, or when
  /// busy(): call read() again with the rest of the chunk, which may be empty.
  std::size_t taken() const { return taken_; }
  bool busy() const { return program_.busy(); }

  /// The text is complete: carries out an unfinished last line and appends End if the job did not. When
  /// busy() afterwards, it is to be called again.
  Result<void, ParseError> finish(CommandBuffer& out);

  /// Goes on behind a refused line, so that a check finds all errors of a job: read() the rest of the chunk,
  /// from taken(). From here on a line that is refused in the words of an earlier one is passed over: one
  /// code that is not known, or the mode that it would have set, is told once and not for a thousand lines.
  void skip_refused() {
    failed_ = {};
    skips_ = true;
  }
  std::uint32_t refused() const { return refused_; }  ///< lines refused so far
  std::uint32_t untold() const { return untold_; }    ///< of them: passed over, in words told before

  std::uint32_t lines() const { return line_; }  ///< lines seen so far
  /// Recorded lines carried out so far, beside those seen.
  std::uint64_t steps() const { return program_.steps(); }
  std::uint64_t bytes() const { return bytes_; }  ///< bytes handed to read()
  /// What lines end with: LF until a CR was found to end the first.
  char line_end() const { return ending_ == Ending::kReturn ? '\r' : '\n'; }

 private:
  enum class Ending : std::uint8_t { kUnknown, kFeed, kReturn };
  // Different reasons kept to compare with: as many as a list of problems shows.
  static constexpr std::size_t kReasons = 300;

  Result<void, ParseError> line(std::string_view text, CommandBuffer& out);
  Result<void, ParseError> refuse(ParseError error);
  Result<void, ParseError> run_recorded(std::uint32_t steps, CommandBuffer& out);
  Result<void, ParseError> end_carried_line(CommandBuffer& out);
  void find_ending(std::string_view chunk);

  Interpreter& interpreter_;
  Program program_;
  std::uint32_t steps_a_call_;
  std::string carry_;          ///< the beginning of a line whose end has not come yet
  bool long_comment_ = false;  ///< carry_ stands for a comment line that is passed over to its end
  bool rest_of_line_ = false;  ///< of one that was refused for its length
  bool in_header_ = true;
  bool no_text_ = false;  ///< refused as a whole
  Ending ending_ = Ending::kUnknown;
  bool after_return_ = false;  ///< kReturn: an LF now belongs to the CR before it
  std::uint32_t line_ = 0, refused_ = 0, untold_ = 0;
  std::uint64_t bytes_ = 0;
  std::size_t taken_ = 0;
  Result<void, ParseError> failed_;
  bool skips_ = false;
  std::vector<std::string> reasons_;  ///< told so far
};

}  // namespace kinebus::gcode

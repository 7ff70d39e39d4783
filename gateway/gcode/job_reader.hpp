#pragma once
// A job's text in chunks of bytes, as it comes from a file or a connection, to canonical commands.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "gateway/gcode/error.hpp"
#include "gateway/gcode/interpreter.hpp"
#include "gateway/result.hpp"

namespace kinebus::gcode {

/// Splits chunks into lines (LF, CRLF or CR LF across chunks; the last line may lack its end), counts them
/// from 1 and hands them to the interpreter. Refused: NUL bytes outside comments' reach, lines of more than
/// kMaxLine bytes that are not comments. Memory: one line.
class JobReader {
 public:
  static constexpr std::size_t kMaxLine = 4096;

  explicit JobReader(Interpreter& interpreter) : interpreter_(interpreter) {}

  /// Carries out all whole lines of the text so far. After an error the reader stays at it: every further
  /// call returns the same error. Text after the program's end is passed over.
  Result<void, ParseError> read(std::string_view chunk, CommandBuffer& out);

  /// The text is complete: carries out an unfinished last line and appends End if the job did not.
  Result<void, ParseError> finish(CommandBuffer& out);

  /// Goes on behind a refused line, so that a check finds all errors of a job. What is left of the chunk that
  /// held it is lost: give one line at a time.
  void skip_refused() {
    failed_ = {};
    carry_.clear();
    long_comment_ = false;
  }

  std::uint32_t lines() const { return line_; }   ///< lines seen so far
  std::uint64_t bytes() const { return bytes_; }  ///< bytes handed to read()

 private:
  Result<void, ParseError> line(std::string_view text, CommandBuffer& out);

  Interpreter& interpreter_;
  std::string carry_;          ///< the beginning of a line whose end has not come yet
  bool long_comment_ = false;  ///< carry_ stands for a comment line that is passed over to its end
  std::uint32_t line_ = 0;
  std::uint64_t bytes_ = 0;
  Result<void, ParseError> failed_;
};

}  // namespace kinebus::gcode

#include "gateway/gcode/job_reader.hpp"

#include "gateway/gcode/tests/test_support.hpp"

namespace kinebus::gcode {
namespace {

struct Reading {
  std::vector<std::string> texts;
  std::string error;
  std::uint32_t lines = 0;
};

Reading read_in_chunks(std::string_view text, std::size_t chunk) {
  Interpreter interpreter;
  JobReader reader(interpreter);
  CommandBuffer out;
  Reading outcome;
  Result<void, ParseError> result;
  for (std::size_t at = 0; at < text.size() && result; at += chunk)
    result = reader.read(text.substr(at, chunk), out);
  if (result) result = reader.finish(out);
  if (!result) outcome.error = to_string(result.error());
  for (const canonical::Line& line : out) outcome.texts.push_back(canonical::to_text(line));
  outcome.lines = reader.lines();
  return outcome;
}

TEST(JobReader, ChunksDoNotChangeTheOutcome) {
  const std::string text =
      "G21\r\nG1 X1.25 F600 ; out\r\n\r\n;TYPE:Perimeter\nG1 X-1 Y2 E.5\nM117 hello\nG2 X1 Y4 I2\nG4 P100";
  const std::string wrong = text + "\nG1 X1 Y\nG1 X5\n";
  const Reading whole = read_in_chunks(text, text.size());
  EXPECT_EQ(whole.error, "");
  EXPECT_EQ(whole.texts.size(), 7U);
  const Reading whole_wrong = read_in_chunks(wrong, wrong.size());
  for (std::size_t chunk = 1; chunk < wrong.size(); ++chunk) {
    const Reading parts = read_in_chunks(text, chunk), parts_wrong = read_in_chunks(wrong, chunk);
    EXPECT_EQ(parts.texts, whole.texts);
    EXPECT_EQ(parts.error, whole.error);
    EXPECT_EQ(parts_wrong.texts, whole_wrong.texts);
    EXPECT_EQ(parts_wrong.error, whole_wrong.error);
  }
}

TEST(JobReader, TheLastLineMayLackItsEnd) {
  const Reading outcome = read_in_chunks("G0 X1\nG0 X2", 4);
  EXPECT_EQ(outcome.lines, 2U);
  EXPECT_EQ(outcome.texts.back(), "2 end");
  EXPECT_EQ(outcome.texts[2], "2 traverse machine x2 y0 z0 a0 c0 e0");
}

TEST(JobReader, LongCommentsArePassedOverAndOtherLongLinesRefused) {
  const std::string padding(3 * JobReader::kMaxLine, 'x');
  for (const std::size_t chunk : {std::size_t{1000}, std::size_t{100000}}) {
    EXPECT_EQ(read_in_chunks("G0 X1\n ; config = " + padding + "\nG0 X2\n", chunk).error, "");
    EXPECT_EQ(read_in_chunks("G0 X1\n ; config = " + padding + "\nG0 X2\n", chunk).lines, 3U);
    EXPECT_EQ(read_in_chunks("G0 X1\nM117 " + padding + "\nG0 X2\n", chunk).error,
              "2:4097: the line is longer than 4096 bytes");
  }
}

TEST(JobReader, NulBytesAreRefusedAnywhere) {
  const std::string text("G0 X1 ; a\0b\n", 12);
  EXPECT_EQ(read_in_chunks(text, 5).error, "1:10: the text holds a NUL byte: this is not a G-code file");
}

TEST(JobReader, WhatFollowsTheProgramIsNotRead) {
  const Reading outcome = read_in_chunks("G0 X1\nM2\nthis is no G-code\n", 7);
  EXPECT_EQ(outcome.error, "");
  EXPECT_EQ(outcome.texts.back(), "2 end");
}

TEST(JobReader, AnErrorStays) {
  Interpreter interpreter;
  JobReader reader(interpreter);
  CommandBuffer out;
  EXPECT_FALSE(reader.read("G1 X1\n", out));
  EXPECT_FALSE(reader.read("G0 X1\n", out));
  const auto result = reader.finish(out);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().line, 1U);
}

}  // namespace
}  // namespace kinebus::gcode

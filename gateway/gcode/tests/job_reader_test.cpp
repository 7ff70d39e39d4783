#include "gateway/gcode/programs/job_reader.hpp"

#include <algorithm>
#include <random>

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

TEST(JobReader, LinesMayEndAsTheyLike) {
  const std::vector<std::string> ends = {"\n", "\r\n", "\r", "\r\r\n"};
  for (const std::string& end : ends) {
    const std::string text = "G21" + end + "G1 X1 F600 ; out" + end + end + "G1 X2" + end + "G1 X3";
    for (std::size_t chunk = 1; chunk <= text.size(); ++chunk) {
      const Reading outcome = read_in_chunks(text, chunk);
      EXPECT_EQ(outcome.error, "") << chunk;
      ASSERT_EQ(outcome.texts.size(), 5U) << chunk;
      EXPECT_EQ(outcome.lines, 5U) << chunk;
      EXPECT_EQ(outcome.texts[3], "5 feed machine x3 y0 z0 a0 c0 e0 f10") << chunk;
    }
  }
  // The first line tells; what follows it may be mixed.
  EXPECT_EQ(read_in_chunks("G0 X1\rG0 X2\nG0 X3\r\nG0 X4\r\rG0 X5", 4).texts.back(), "6 end");
  // A CR within a line is a blank where lines end with LF.
  EXPECT_EQ(read_in_chunks("G21\nG0\rX1\nG0 X2", 3).texts.back(), "3 end");
}

/// Everything that a reading that goes on behind refused lines gives.
std::string read_all(std::string_view text, std::size_t chunk) {
  Options options;
  options.default_feed_mm_per_s = 10;
  Interpreter interpreter(options);
  JobReader reader(interpreter);
  CommandBuffer out;
  std::string all;
  const auto told = [&](const Result<void, ParseError>& result) {
    if (result) return false;
    all += to_string(result.error()) + "\n";
    reader.skip_refused();
    return true;
  };
  for (std::size_t at = 0; at < text.size(); at += chunk) {
    std::string_view part = text.substr(at, chunk);
    while (told(reader.read(part, out))) part.remove_prefix(reader.taken());
    EXPECT_EQ(reader.taken(), part.size());
  }
  while (told(reader.finish(out))) {
  }
  for (const canonical::Line& line : out) all += canonical::to_text(line) + "\n";
  EXPECT_EQ(reader.bytes(), text.size());
  return all + std::to_string(reader.lines()) + " lines, " + std::to_string(reader.refused()) + " refused";
}

TEST(JobReader, AnyTextInAnyChunksReadsTheSame) {
  constexpr unsigned kSeed = 5;
  std::mt19937 random(kSeed);
  const std::vector<std::string> parts = {"\r",   "\n",     "\r\n", "\r\r\n", "G1 X1", "G0 Y2",
                                          "X3 Y", "M99999", "; c",  ";\r",    " ",     "\xEF\xBB\xBF"};
  for (int run = 0; run < 3000; ++run) {
    std::string text;
    for (auto i = 1 + random() % 14; i > 0; --i) text += parts[random() % parts.size()];
    if (run % 100 == 0) text += std::string(JobReader::kMaxLine + 1000, 'x') + "\nG1 X9\n";
    const std::string whole = read_all(text, text.size());
    for (std::size_t chunk = 1; chunk < std::min<std::size_t>(text.size(), 20); ++chunk)
      ASSERT_EQ(read_all(text, chunk), whole) << "seed " << kSeed << " run " << run << " chunk " << chunk;
  }
}

TEST(JobReader, AByteOrderMarkIsPassedOver) {
  for (const std::size_t chunk : {1U, 2U, 100U}) {
    const Reading outcome = read_in_chunks("\xEF\xBB\xBFG0 X1\nG0 X2\n", chunk);
    EXPECT_EQ(outcome.error, "");
    EXPECT_EQ(outcome.texts.size(), 4U);
  }
}

TEST(JobReader, FilesThatAreNoTextAreNamedOnce) {
  for (const auto& [begin, words] : {std::pair<std::string, std::string>{"GCDE\1\0\0\0", "binary G-code"},
                                     {"PK\x03\x04\x0A\n", "ZIP"},
                                     {"\x1F\x8B\x08", "gzip"},
                                     {"\xFF\xFEG\0001\n", "UTF-16"}}) {
    std::string text = begin;
    for (int i = 0; i < 20000; ++i) text += static_cast<char>(i * 7 + i / 256);
    Interpreter interpreter;
    JobReader reader(interpreter);
    CommandBuffer out;
    const auto result = reader.read(text, out);
    ASSERT_FALSE(result) << words;
    EXPECT_NE(result.error().message.find(words), std::string::npos) << result.error().message;
    reader.skip_refused();
    EXPECT_TRUE(reader.read(std::string_view(text).substr(reader.taken()), out));
    EXPECT_EQ(reader.refused(), 1U) << words;
  }
}

TEST(JobReader, OneUnknownCodeIsToldOnceAndWhatComesOfItToo) {
  std::string text = "G17 G21 G90 G95 X1 Y1 Z-2 F100\n";
  for (int i = 0; i < 1192; ++i) text += "X" + std::to_string(i) + " Y2\n";
  for (int i = 0; i < 500; ++i) text += "M1234 P1\n";
  text += "G1 X1 Y\nG0 X7\n";
  for (const std::size_t chunk : {std::size_t{1}, std::size_t{64}, text.size()}) {
    Interpreter interpreter;
    JobReader reader(interpreter);
    CommandBuffer out;
    std::vector<std::string> told;
    for (std::size_t at = 0; at < text.size(); at += chunk) {
      std::string_view part = std::string_view(text).substr(at, chunk);
      for (;;) {
        const auto result = reader.read(part, out);
        part.remove_prefix(reader.taken());
        if (result) break;
        told.push_back(to_string(result.error()));
        reader.skip_refused();
      }
    }
    ASSERT_TRUE(reader.finish(out));
    const std::vector<std::string> expected = {
        "1:13: feed for each turn (G95) needs a spindle, which this machine does not have",
        "2:1: X has no use in this line: no motion code is given or active", "1194:1: M1234 is unknown",
        "1694:7: Y needs a number"};
    EXPECT_EQ(told, expected);
    EXPECT_EQ(reader.refused(), 1U + 1192U + 500U + 1U);
    EXPECT_EQ(reader.untold(), 1191U + 499U);
    EXPECT_EQ(reader.bytes(), text.size());
    EXPECT_EQ(canonical::to_text(out[out.size() - 2]), "1695 traverse machine x7 y0 z0 a0 c0 e0");
  }
}

TEST(JobReader, LoopsReadTheSameInAnyChunksAndSteps) {
  const std::string text =
      "#1=3\no1 while [#1 GT 0]\nG0 X#1\n#1=[#1-1]\no1 endwhile\nM98 P7 L2\nG0 Y9\nM30\nO7\nG0 Z1\nG0 "
      "Z2\nM99\n";
  std::vector<std::string> whole;
  for (std::size_t chunk = 1; chunk <= text.size(); ++chunk)
    for (const std::uint32_t steps : {1U, 2U, JobReader::kWithoutEnd}) {
      Interpreter interpreter;
      JobReader reader(interpreter, steps);
      CommandBuffer out;
      for (std::size_t at = 0; at < text.size(); at += chunk) {
        std::string_view part = std::string_view(text).substr(at, chunk);
        do {
          ASSERT_TRUE(reader.read(part, out));
          part.remove_prefix(reader.taken());
        } while (!part.empty() || reader.busy());
      }
      do ASSERT_TRUE(reader.finish(out));
      while (reader.busy());
      std::vector<std::string> texts;
      for (const canonical::Line& line : out) texts.push_back(canonical::to_text(line));
      if (whole.empty()) whole = texts;
      EXPECT_EQ(texts, whole) << chunk << " " << steps;
      EXPECT_EQ(reader.bytes(), text.size());
    }
  EXPECT_EQ(whole.size(), 10U);
  EXPECT_EQ(whole.back(), "8 end");
}

TEST(JobReader, ALoopWithoutEndIsAnErrorWithItsLine) {
  Options options;
  options.most_recorded_steps = 1000;
  Interpreter interpreter(options);
  JobReader reader(interpreter);
  CommandBuffer out;
  const auto result = reader.read("G0 X1\no1 while [1]\no1 endwhile\nG0 X2\n", out);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().line, 2U);
  EXPECT_NE(result.error().message.find("does not end"), std::string::npos);
}

TEST(JobReader, WhatFollowsAnOverlongLineIsRead) {
  const std::string text = "G0 X1\nM117 " + std::string(3 * JobReader::kMaxLine, 'x') + "\nG0 X2\n";
  for (const std::size_t chunk : {std::size_t{1000}, text.size()}) {
    Interpreter interpreter;
    JobReader reader(interpreter);
    CommandBuffer out;
    for (std::size_t at = 0; at < text.size(); at += chunk)
      for (std::string_view part = std::string_view(text).substr(at, chunk); !part.empty();
           part.remove_prefix(reader.taken()))
        if (!reader.read(part, out)) reader.skip_refused();
    EXPECT_EQ(reader.refused(), 1U);
    EXPECT_EQ(canonical::to_text(out.back()), "3 traverse machine x2 y0 z0 a0 c0 e0");
  }
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

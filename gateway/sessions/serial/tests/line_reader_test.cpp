#include "gateway/sessions/serial/line_reader.hpp"

#include <gtest/gtest.h>

namespace kinebus::serial {
namespace {

using namespace std::chrono_literals;

class Reader : public ::testing::Test {
 protected:
  void give(std::string_view text) {
    reader.on_bytes(now, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  /// With number and right checksum.
  void give_numbered(long number, const std::string& text) {
    const std::string line = "N" + std::to_string(number) + " " + text;
    unsigned sum = 0;
    for (const char c : line) sum ^= static_cast<unsigned char>(c);
    give(line + "*" + std::to_string(sum) + "\n");
  }
  /// "text", "!resend: error" or "=" for a line sent once more; "-" for none.
  std::string next() {
    const auto line = reader.next();
    if (!line) return "-";
    if (!line->error.empty()) return "!" + std::to_string(line->resend) + ": " + line->error;
    return line->repeated ? "=" : line->text;
  }
  LineReader reader;
  LocalTime now{1s};
};

TEST_F(Reader, LinesEndWithLfOrCrAndEmptyOnesAreNothing) {
  give("M105\r\n\n  G1 X1 ; comment\rM1");
  EXPECT_EQ(next(), "M105");
  EXPECT_EQ(next(), "G1 X1");
  EXPECT_EQ(next(), "-");
  give("14\n");
  EXPECT_EQ(next(), "M114");
}

TEST_F(Reader, WhatATerminalSendsBackOfTheAnswersIsNoCommand) {
  give("start\nok\nok T:20.0 /0.0\necho:busy: processing\nError:x\nResend: 3\nT:21.0 /0.0\nT0\nO100\n");
  EXPECT_EQ(next(), "T0");
  EXPECT_EQ(next(), "O100");
  EXPECT_EQ(next(), "-");
}

TEST_F(Reader, NumbersFollowEachOtherAndM110SetsThem) {
  give("N-1 M110*15\n");
  EXPECT_EQ(next(), "M110");
  give_numbered(0, "G28");
  give_numbered(1, "G1 X1");
  EXPECT_EQ(next(), "G28");
  EXPECT_EQ(next(), "G1 X1");
  give_numbered(3, "G1 X3");
  EXPECT_EQ(next(), "!2: Line Number is not Last Line Number+1, Last Line: 1");
  give("M110 N100\n");
  EXPECT_EQ(next(), "M110 N100");
  give_numbered(101, "G1 X2");
  EXPECT_EQ(next(), "G1 X2");
}

TEST_F(Reader, DamagedLineIsAskedForAgain) {
  give("N1 G1 X10*1\n");
  EXPECT_EQ(next(), "!1: checksum mismatch, Last Line: 0");
  give("N1 G1 X10\n");
  EXPECT_EQ(next(), "!1: No Checksum with line number, Last Line: 0");
  give("N1 G1 X10*9z\n");
  EXPECT_EQ(next(), "!1: No Checksum with line number, Last Line: 0");
  give_numbered(1, "G1 X10");
  EXPECT_EQ(next(), "G1 X10");
}

TEST_F(Reader, LineSentOnceMoreIsNotTakenTwice) {
  give_numbered(1, "G1 X1");
  give_numbered(2, "G1 X2");
  give_numbered(2, "G1 X2");
  EXPECT_EQ(next(), "G1 X1");
  EXPECT_EQ(next(), "G1 X2");
  EXPECT_EQ(next(), "=");
  give_numbered(1, "G1 X7");
  EXPECT_EQ(next(), "!3: Line Number is not Last Line Number+1, Last Line: 2")
      << "another print, same number";
}

TEST_F(Reader, NumberedLineThatLostItsEndIsAskedForAgain) {
  give("N1 G1 X10*90");
  EXPECT_LT(reader.next_deadline(), now + 1s);
  now += 1s;
  reader.on_time(now);
  EXPECT_EQ(next(), "!1: No line end, Last Line: 0");
  give("typed by ha");
  EXPECT_EQ(reader.next_deadline(), LocalTime::max()) << "a human may type slowly";
}

TEST_F(Reader, LongOrUnreadableLinesAreDamaged) {
  give(std::string(5000, 'G') + "\n");
  EXPECT_EQ(next(), "!1: Format error: line too long, Last Line: 0");
  give(std::string("G1\0X\n", 5));
  EXPECT_EQ(next(), "!1: Format error: unreadable line, Last Line: 0");
}

TEST(SerialCode, WordsAndArguments) {
  EXPECT_EQ(code_of(" m104 S200").number, 104);
  EXPECT_EQ(code_of("m104").letter, 'M');
  EXPECT_EQ(word("M104 S205.5 T0", 'S'), 205.5);
  EXPECT_EQ(word("M104 T0", 'S'), std::nullopt);
  EXPECT_EQ(argument("M23 part one.gcode "), "part one.gcode");
  EXPECT_EQ(urgent("M112"), Urgent::kEmergencyStop);
  EXPECT_EQ(urgent("M1120"), Urgent::kNone);
}

}  // namespace
}  // namespace kinebus::serial

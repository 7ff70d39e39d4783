#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <numbers>
#include <random>

#include "gateway/gcode/programs/job_reader.hpp"
#include "gateway/gcode/tests/test_support.hpp"
#include "gateway/gcode/words/codes.hpp"

namespace {
std::size_t allocations = 0;
}  // namespace

// Counts every allocation of the test program.
void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace kinebus::gcode {
namespace {

TEST(Interpreter, ARefusedLineChangesNothing) {
  Session session;
  session.must("G1 X1 F600");
  const auto before = session.texts();
  const std::string codes = session.interpreter.modal_codes();
  for (const char* line : {"G20 G91 G18 F100 G55 G1 X5 Y", "G92 X7 D1", "G10 L2 P1 X5 Q1", "G68.2 J10 X",
                           "G43.4 G0 X1 D9", "M220 S50 D4", "G10 D4", "G28 D4", "M3", "X2 F0", "M2 D1"}) {
    EXPECT_NE(session.run(line), "") << line;
    EXPECT_EQ(session.texts(), before) << line;
    EXPECT_EQ(session.interpreter.modal_codes(), codes) << line;
    EXPECT_EQ(session.interpreter.program_position()[kAxisX], 1) << line;
  }
  session.must("X2");
  EXPECT_EQ(session.texts().back(), "13 feed machine x2 y0 z0 a0 c0 e0 f10");
}

TEST(Interpreter, ASpindleTurnsAsItsLastSSays) {
  Options options;
  options.spindle = true;
  Session session(options);
  EXPECT_NE(session.run("M3"), "") << "no speed was ever stated";
  session.must("S8000\nM3\nG1 X1 F600 S9000\nM4\nM5\nS5000\nG4 S1\nM3 S12000\nM2\nG1 X2 F600\n");
  std::vector<std::string> spindle;
  for (const std::string& text : session.texts())
    if (text.find(" spindle ") != std::string::npos || text.find(" feed ") != std::string::npos)
      spindle.push_back(text.substr(text.find(' ') + 1, 13));
  const std::vector<std::string> expected{"spindle 8000", "spindle 9000",  "feed machine ", "spindle -9000",
                                          "spindle 0",    "spindle 12000", "feed machine "};
  EXPECT_EQ(spindle, expected);
}

TEST(Interpreter, ASavedStateGoesOnExactlyWhereItWas) {
  const std::string first =
      "G10 L2 P2 X5 Y6\nG55 M83 G1 F1200 X1 Y1 E1\nM220 S80\nM221 S95\nG92 X3\n#7=2.5\nG43.4\nG10\n";
  const std::string second = "G1 X#7 E.5\nG11\nG2 X4 I.75 E1\nG92.1\nG91\nG1 X1\nG49\nY2 A3\n";
  Session whole;
  whole.must(first);
  const std::size_t split = whole.commands.size();
  const State saved = whole.interpreter.state();
  const std::uint32_t line = whole.number;
  whole.must(second);
  Session resumed;
  resumed.interpreter.restore(saved);
  resumed.number = line;
  resumed.must(second);
  auto expected = whole.texts(split), actual = resumed.texts();
  ASSERT_FALSE(actual.empty());
  EXPECT_EQ(actual.front().find(" position part"), actual.front().find(' '));
  actual.erase(actual.begin());
  EXPECT_EQ(actual, expected);
}

TEST(Interpreter, G10L20GivesTheCurrentPointItsNumbersInEverySystem) {
  struct Case {
    const char* job;
    double x, y;  ///< machine, after the last line
  };
  for (const Case& c : {Case{"G10 L2 P1 X5\nG0 X10\nG10 L20 P1 X0\nG0 X0", 15, 0},
                        Case{"G10 L2 P1 X5 Y-3\nG0 X10 Y1\nG10 L20 P0 X0 Y0\nG0 X1 Y1", 16, -1},
                        Case{"G10 L2 P1 X5\nG92 X1\nG0 X10\nG10 L20 P1 X2\nG0 X3", 10, 0},
                        Case{"G10 L2 P1 X5\nG0 X10\nG10 L20 P2 X1\nG55\nG0 X1", 15, 0},
                        Case{"G20\nG10 L2 P1 X1\nG0 X2\nG10 L20 P1 X0\nG0 X1", 4 * 25.4, 0}}) {
    Session session;
    session.must(c.job);
    EXPECT_NEAR(session.interpreter.state().modal.position[kAxisX], c.x, 1e-9) << c.job;
    EXPECT_NEAR(session.interpreter.state().modal.position[kAxisY], c.y, 1e-9) << c.job;
  }
}

TEST(Interpreter, TheCurrentPointIsReadInTheUnitsInForce) {
  Session session;
  session.must("G20\nG0 X2 Z1 A30\n#1=#5420\n#2=#5422\n#3=#5423\nG0 X[#5420 + 1]\nG21\n#4=#5420");
  const auto& numbered = session.interpreter.state().parameters.numbered;
  EXPECT_NEAR(numbered[1], 2, 1e-12);
  EXPECT_NEAR(numbered[2], 1, 1e-12);
  EXPECT_NEAR(numbered[3], 30, 1e-12);
  EXPECT_NEAR(numbered[4], 76.2, 1e-12);
}

TEST(Interpreter, AnFWithG0LimitsTravelWhereTheDialectSaysSo) {
  Options options;
  options.traverse_uses_feed = true;
  Session session(options);
  // As Cura writes: the F of travel stands with G0; without one, the F in force is meant.
  session.must("G1 X1 F600\nG0 X2\nG0 X3 F6000\nG0 X4\nG1 X5 F1200\nG0 X6\nG0 A90\nM2\nG0 X7");
  std::vector<double> speeds;
  for (const auto& move : session.all<canonical::Traverse>()) speeds.push_back(move.speed_per_s);
  ASSERT_EQ(speeds.size(), 6U);
  EXPECT_EQ(speeds[0], 0) << "an F of feed moves alone says nothing about travel";
  EXPECT_NEAR(speeds[1], 100, 1e-12);
  EXPECT_NEAR(speeds[2], 100, 1e-12);
  EXPECT_NEAR(speeds[3], 20, 1e-12);
  EXPECT_NEAR(speeds[4], 20 * std::numbers::pi / 180, 1e-12) << "1200 deg/min";
  EXPECT_EQ(speeds[5], 0) << "a new program";
  Session mill;
  mill.must("G0 X3 F6000");
  EXPECT_EQ(mill.all<canonical::Traverse>().at(0).speed_per_s, 0);
}

TEST(Interpreter, HomingWhereNeededIsHoming) {
  Session session;
  session.must("G28 O\nG28 X O W");
  EXPECT_EQ(session.all<canonical::Home>().size(), 2U);
  EXPECT_NE(session.run("O100 sub"), "");
  EXPECT_NE(session.run("o<part> call"), "");
  EXPECT_NE(session.run("G1 O X1 F600"), "");
}

TEST(Interpreter, FilamentIsContinuousThroughG92RetractionAndFlow) {
  constexpr unsigned kSeed = 11;
  std::mt19937 random(kSeed);
  Session session;
  session.must("G1 F600\nM207 S1.5");
  double program = 0, sum = 0, flow = 1;
  bool relative = false, retracted = false;
  const auto uniform = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto decimal = [](double value) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "%.5f", value);
    return std::string(text.data());
  };
  for (int i = 0; i < 3000; ++i) {
    switch (random() % 8) {
      case 0: {
        const std::string e = decimal(uniform(-5, 5));
        session.must("G92 E" + e);
        program = std::strtod(e.c_str(), nullptr);
        break;
      }
      case 1:
        relative = !relative;
        session.must(relative ? "M83" : "M82");
        break;
      case 2: {
        const int percent = static_cast<int>(uniform(50, 150));
        session.must("M221 S" + std::to_string(percent));
        flow = percent / 100.0;
        break;
      }
      case 3:
        session.must(retracted ? "G11" : "G10");
        retracted = !retracted;
        break;
      default: {
        const double step = std::strtod(decimal(uniform(-1, 3)).c_str(), nullptr);
        const std::string e = decimal(relative ? step : program + step);
        const double next = relative ? program + step : std::strtod(e.c_str(), nullptr);
        session.must("G1 X" + std::to_string(i) + " E" + e);
        sum += flow * (next - program);
        program = next;
      }
    }
    ASSERT_NEAR(session.interpreter.state().modal.position[kAxisE], sum - (retracted ? 1.5 : 0), 1e-8)
        << "seed " << kSeed << " step " << i;
  }
}

TEST(Interpreter, NothingIsAllocatedForALine) {
  Interpreter interpreter;
  CommandBuffer out;
  out.reserve(100);
  ASSERT_TRUE(interpreter.execute("G1 X1 Y1 F600", 1, out));
  const std::size_t before = allocations;
  int accepted = 0;
  for (std::uint32_t line = 2; line < 50; ++line) {
    for (const char* text :
         {"G1 X10.5 Y-3.25 E.01234 F1800", "N7 G1 X[1+2] Y#1 (computed)", ";TYPE:Perimeter", "G92 E0",
          "M106 S100", "G3 X10.5 Y-3.25 R50", "G0 X1 Y1", "G2 X1 Y1 I5 J0", "G4 P5", "G91 G1 X1", "G90"})
      if (interpreter.execute(text, line, out)) ++accepted;
    if (out.size() > 80) out.clear();
  }
  const std::size_t after = allocations;
  EXPECT_EQ(accepted, 48 * 11);
  EXPECT_EQ(after, before);
}

TEST(Interpreter, WhatTheMachineFileSaysIsNamedByItsKeyWithAndWithoutWords) {
  for (const char* words : {"", " P1", " ; a remark"}) {
    Session session;
    for (const auto& [code, key] :
         std::vector<std::pair<std::string, std::string>>{{"M302", "min_extrude_c of [thermal]"},
                                                          {"M143", "max_c of [heater.NAME]"},
                                                          {"M301", "[heater.NAME]"},
                                                          {"M304", "[heater.NAME]"},
                                                          {"M305", "sensor of [heater.NAME]"},
                                                          {"M307", "kinebus tune NAME"}}) {
      session.interpreter.clear_notes();
      session.must(code + words);
      ASSERT_EQ(session.interpreter.notes().size(), 1U) << code << words;
      EXPECT_NE(session.interpreter.notes()[0].text.find(key), std::string::npos) << code << words;
    }
  }
}

TEST(Interpreter, KnownButUselessCodesAreNotedOnce) {
  Session session;
  session.must("M73 P1\nM73 P2\nG29\nM302 P1\nG29 P1");
  ASSERT_EQ(session.interpreter.notes().size(), 3U);
  EXPECT_EQ(session.interpreter.notes()[0].line, 1U);
  EXPECT_EQ(session.interpreter.notes()[1].text, "G29 has no effect: the machine file has no [probe]");
  session.interpreter.clear_notes();
  session.must("M73 P3");
  EXPECT_TRUE(session.interpreter.notes().empty());
}

TEST(Interpreter, TellsModalCodesAndPosition) {
  Session session;
  EXPECT_EQ(session.interpreter.modal_codes(), "G80 G17 G21 G90 G91.1 G94 G54 G49 G64 G69 G92.1 M82");
  session.must("G20 G91 G18 G90.1 G55 G61 M83 G1 X1 A90 F60\nG43.4\nG92 Y0");
  EXPECT_EQ(session.interpreter.modal_codes(), "G1 G18 G20 G91 G90.1 G94 G55 G43.4 G61 G69 G92 M83");
  const Pose position = session.interpreter.program_position();
  EXPECT_NEAR(position[kAxisX], 25.4, 1e-12);
  EXPECT_NEAR(position[kAxisA], 90, 1e-12);
}

TEST(Interpreter, AMoveFromOutsideIsAnnounced) {
  Session session;
  session.must("G10 L2 P1 X5\nG1 X1 E2 F600");
  session.interpreter.set_position({20, 30, 40, 0, 0, 99}, Frame::kMachine);
  EXPECT_EQ(session.interpreter.program_position()[kAxisX], 15);
  session.must("G1 X16 E3");
  const auto texts = session.texts(session.commands.size() - 2);
  EXPECT_EQ(texts[0], "3 position machine x20 y30 z40 a0 c0 e2");
  EXPECT_EQ(texts[1], "3 feed machine x21 y30 z40 a0 c0 e3 f10");
}

TEST(Interpreter, AProgramAfterTheEndBeginsWithDefaults) {
  Session session;
  session.must("G91 G55 G18 G1 X1 F600\nM2");
  EXPECT_TRUE(session.interpreter.ended());
  session.interpreter.finish(3, session.commands);
  EXPECT_EQ(session.all<canonical::End>().size(), 1U);
  session.must("G0 Y1");
  EXPECT_FALSE(session.interpreter.ended());
  EXPECT_EQ(session.interpreter.modal_codes(), "G0 G17 G21 G90 G91.1 G94 G54 G49 G64 G69 G92.1 M82");
  EXPECT_EQ(session.texts().back(), "3 traverse machine x1 y1 z0 a0 c0 e0");
}

TEST(Reference, TellsWhereDialectsDiffer) {
  EXPECT_EQ(reference_entry("m203"),
            "M203 X Y Z A C E: speeds of axes, mm/s or deg/s\n"
            "  auto, marlin, klipper, repetier, smoothie, mach3, machinekit, linuxcnc: mm/s\n"
            "  reprapfirmware: mm/min");
  EXPECT_EQ(reference_entry("G04").substr(0, 3), "G4 ");
  EXPECT_NE(reference_entry("repetier").find("M201: acceleration of printing moves"), std::string::npos);
  EXPECT_EQ(reference_entry("M117").find('\n'), std::string::npos);
  EXPECT_EQ(reference_entry("G999"), "");
}

TEST(Reference, TellsWhyACodeIsRefused) {
  for (const char* code : {"G33.1", "G76", "G87"}) EXPECT_GT(reference_entry(code).size(), 30U) << code;
  EXPECT_NE(reference_entry("G33").find("a thread"), std::string::npos);
}

TEST(Interpreter, BlankAndCommentLinesDoNothing) {
  Session session;
  session.must("G0 X1");
  const std::size_t before = session.commands.size();
  for (const char* line : {"", " ", "\t", ";", " ; text", "()", "(a) (b) ; c", "N5", "G1 F1200", "\r"})
    session.must(line);
  EXPECT_EQ(session.commands.size(), before);
}

}  // namespace
}  // namespace kinebus::gcode

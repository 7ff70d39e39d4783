// What print hosts rely on: how soon the machine rests when they stop, what a refusal looks like to them, and
// that they understand every line of a session.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <regex>
#include <string>
#include <vector>

#include "gateway/sessions/serial/tests/serial_rig.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

template <typename... Values>
std::string print(const char* format, Values... values) {
  char text[256];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

/// A host that sends the next line when the one before has its ok, until it is told to end.
class Streamer {
 public:
  Streamer(SerialRig& rig, std::vector<std::string> lines) : rig_(rig), lines_(std::move(lines)) {}
  /// True: all lines have their ok.
  bool turn() {
    if (next_ > 0 && rig_.oks() == before_) return false;
    if (next_ == lines_.size()) return true;
    before_ = rig_.oks();
    rig_.write(lines_[next_++] + "\n");
    return false;
  }
  std::size_t sent() const { return next_; }

 private:
  SerialRig& rig_;
  std::vector<std::string> lines_;
  std::size_t next_ = 0, before_ = 0;
};

double rests_after_s(SerialRig& rig) {
  const BusTime from = rig.machine.now;
  const auto moves = [&] {
    return rig.machine.gateway->status().rate > 0 && !rig.machine.gateway->lines_idle();
  };
  EXPECT_TRUE(rig.until([&] { return !moves(); }, 60s)) << rig.log();
  return to_seconds(rig.machine.now - from);
}

std::vector<std::string> circle(int turns, double radius_mm, double feed_mm_per_s) {
  std::vector<std::string> lines{"G90", print("G1 X%.3f Y0 F%.0f", radius_mm, 60 * feed_mm_per_s)};
  for (int i = 1; i <= turns * 120; ++i) {
    const double angle = 2 * 3.14159265358979 * i / 120;
    lines.push_back(print("G1 X%.3f Y%.3f", radius_mm * std::cos(angle), radius_mm * std::sin(angle)));
  }
  return lines;
}

/// 0.8 mm to and fro: each move is all acceleration, and takes six times as long as its feed says.
std::vector<std::string> saw(int teeth) {
  std::vector<std::string> lines{"G90", "G61"};
  for (int i = 1; i <= teeth; ++i) lines.push_back(print("G1 X%.2f Y%.2f F9000", 0.05 * i, i % 2 * 0.8));
  return lines;
}

TEST(PrintHost, WhenItStopsSendingTheMachineRestsWithinTheLead) {
  for (const auto& lines : {circle(40, 20, 60), saw(900)}) {
    SerialRig rig;
    ASSERT_TRUE(rig.machine.make_ready());
    Streamer host(rig, lines);
    ASSERT_TRUE(rig.until([&] { return host.turn(), host.sent() > 500; }, 200s)) << rig.log();
    EXPECT_LT(rests_after_s(rig), rig.machine.machine.serial.lead_s) << rig.log();
    EXPECT_EQ(rig.machine.gateway->status().counters.starvation_holds, 0u);
    EXPECT_FALSE(rig.machine.told(MachineEvent::Kind::kAlarm)) << rig.log();
  }
}

TEST(PrintHost, TheLeadSlowsNoPrint) {
  SerialRig rig;
  ASSERT_TRUE(rig.machine.make_ready());
  const auto lines = circle(8, 20, 60);
  Streamer host(rig, lines);
  const BusTime from = rig.machine.now;
  ASSERT_TRUE(rig.until([&] { return host.turn(); }, 200s)) << rig.log();
  rests_after_s(rig);
  const double nominal_s = (20 + 8 * 2 * 3.14159265358979 * 20) / 60;
  EXPECT_NEAR(to_seconds(rig.machine.now - from), nominal_s, 0.6);
}

TEST(PrintHost, ALineLongerThanTheLeadEndsOnThePathWhenThePortIsClosed) {
  SerialRig rig;
  ASSERT_TRUE(rig.machine.make_ready());
  rig.write("G91\nG1 X60 F300\n");
  ASSERT_TRUE(rig.until([&] { return rig.machine.gateway->status().machine_pose[kX] > 1; }, 10s));
  const BusTime closed = rig.machine.now;
  rig.session.on_closed(closed, "cable pulled");
  ASSERT_TRUE(rig.machine.run_until([&] { return rig.machine.gateway->status().rate == 0; }, 30s));
  EXPECT_LE(to_seconds(rig.machine.now - closed), rig.machine.machine.serial.lead_s + 0.01);
  ASSERT_TRUE(rig.machine.reach(MachineState::kReady, 10s)) << rig.log();
  const MachineStatus status = rig.machine.gateway->status();
  EXPECT_GT(status.machine_pose[kX], 8);
  EXPECT_LT(status.machine_pose[kX], 14);
  EXPECT_NEAR(status.machine_pose[kY], 0, 2e-3) << "on the path";
  EXPECT_FALSE(rig.machine.told(MachineEvent::Kind::kAlarm)) << rig.log();
}

TEST(PrintHost, HeatersFollowItsCancelScriptAtOnce) {
  SerialRig rig;
  ASSERT_TRUE(rig.machine.make_ready());
  rig.ask("M104 S60");
  rig.ask("M140 S40");
  rig.ask("G91");
  rig.ask("G1 X60 F300");
  ASSERT_TRUE(rig.until([&] { return rig.machine.gateway->status().rate > 0.9; }, 10s));
  rig.write("M84\nM104 T0 S0\nM140 S0\n");
  rig.turn();
  const MachineStatus status = rig.machine.gateway->status();
  EXPECT_EQ(status.heater(kFirstHotend).target_celsius, 0);
  EXPECT_EQ(status.heater(kFirstBed).target_celsius, 0);
  EXPECT_GT(status.rate, 0.9) << "the motion goes on";
}

TEST(PrintHost, M108EndsTheWaitForAHeaterInAPrint) {
  SerialRig rig;
  ASSERT_TRUE(rig.machine.make_ready());
  rig.ask("G1 X1 F600");
  rig.write("M109 S230\nM104 S100\n");
  const std::size_t before = rig.oks();
  rig.until([] { return false; }, 2s);
  EXPECT_EQ(rig.oks(), before);
  rig.write("M108\n");
  ASSERT_TRUE(rig.until([&] { return rig.oks() == before + 3; }, 1s)) << rig.log();
  EXPECT_EQ(rig.machine.gateway->status().heater(kFirstHotend).target_celsius, 100);
}

// Switched off is at once, whatever is waited for; of two heaters the other is still waited for.
TEST(PrintHost, AHeaterIsSwitchedOffWhileATemperatureIsWaitedFor) {
  for (const bool printing : {false, true}) {
    SerialRig rig;
    if (printing) {
      ASSERT_TRUE(rig.machine.make_ready());
      rig.ask("G1 X1 F600");
    }
    rig.ask("M140 S60");
    rig.write("M109 S230\n");
    rig.until([] { return false; }, 2s);
    const std::size_t before = rig.oks();
    rig.write("M140 S0\n");
    rig.turn();
    EXPECT_EQ(rig.machine.gateway->status().heater(kFirstBed).target_celsius, 0) << rig.log();
    EXPECT_EQ(rig.machine.gateway->status().heater(kFirstHotend).target_celsius, 230);
    EXPECT_EQ(rig.oks(), before);
    rig.write("M104 T0 S0\n");
    rig.turn();
    EXPECT_EQ(rig.machine.gateway->status().heater(kFirstHotend).target_celsius, 0) << rig.log();
    EXPECT_TRUE(rig.until([&] { return rig.oks() == before + 3; }, 1s)) << rig.log();
  }
}

// Of a program that was sent ahead it stands where it stands.
TEST(PrintHost, AProgramSentAheadSwitchesItsHeaterOffBehindItsMoves) {
  SerialRig rig;
  ASSERT_TRUE(rig.machine.make_ready());
  const std::size_t before = rig.oks();
  rig.write("M109 S200\nG1 X10 F600\nM104 S0\n");
  rig.until([] { return false; }, 2s);
  EXPECT_EQ(rig.machine.gateway->status().heater(kFirstHotend).target_celsius, 200) << rig.log();
  ASSERT_TRUE(rig.until([&] { return rig.oks() == before + 3; }, 300s)) << rig.log();
  EXPECT_EQ(rig.machine.gateway->status().heater(kFirstHotend).target_celsius, 0);
}

TEST(PrintHost, M105TellsThePowerOfHotEndAndBed) {
  SerialRig rig;
  EXPECT_NE(rig.ask("M105").find("@:0 B@:0"), std::string::npos);
  rig.ask("M104 S200");
  rig.until([] { return false; }, 1s);
  const std::string full = rig.ask("M105");
  EXPECT_NE(full.find("@:127 B@:0"), std::string::npos) << full;
  rig.until([] { return false; }, 300s);
  const std::string holds = rig.ask("M105");
  const std::size_t at = holds.find("@:");
  ASSERT_NE(at, std::string::npos) << holds;
  const int power = std::stoi(holds.substr(at + 2));
  EXPECT_GT(power, 5) << holds;
  EXPECT_LT(power, 126) << holds;
}

TEST(PrintHost, M112SwitchesTheHeatersOffAndSaysWhy) {
  SerialRig rig;
  rig.ask("M104 S200");
  rig.ask("M140 S60");
  rig.write("M112\n");
  rig.until([] { return false; }, 1s);
  const MachineStatus status = rig.machine.gateway->status();
  EXPECT_EQ(status.heater(kFirstHotend).target_celsius, 0);
  EXPECT_EQ(status.heater(kFirstBed).target_celsius, 0);
  EXPECT_TRUE(rig.said("echo:the heaters are off: M112 of the print host")) << rig.log();
  EXPECT_EQ(status.state, MachineState::kOff) << "nothing was moving: no alarm";
  EXPECT_FALSE(rig.machine.told(MachineEvent::Kind::kAlarm)) << rig.log();
}

TEST(PrintHost, ARefusalIsNoErrorAndPausesThePrintWithItsReason) {
  SerialRig rig;
  ASSERT_TRUE(rig.machine.make_ready());
  for (const char* jog : {"G1 X400 F3000", "G5.9 X1", "M104 S900", "T7"}) {
    const std::string answer = rig.ask(jog);
    EXPECT_EQ(answer.rfind("echo:", 0), 0u) << jog << ": " << answer;
    EXPECT_EQ(answer.find("//action"), std::string::npos) << "no print: " << answer;
  }
  const auto numbered = [](int number, const std::string& line) {
    const std::string text = print("N%d %s", number, line.c_str());
    unsigned sum = 0;
    for (const char c : text) sum ^= static_cast<unsigned char>(c);
    return text + "*" + std::to_string(sum);
  };
  rig.ask(numbered(0, "M110"));
  const std::string answer = rig.ask(numbered(1, "G1 X400 F3000"));
  const std::regex expected("echo:(.+)\n//action:notification (.+)\n//action:pause\n");
  std::smatch found;
  ASSERT_TRUE(std::regex_match(answer, found, expected)) << answer;
  EXPECT_EQ(found[1], found[2]);
  EXPECT_EQ(rig.ask(numbered(2, "G1 X4 F3000")), "") << "the next line is taken";
}

TEST(PrintHost, PositionIsTheJobsWithItsOffsetsAndFilament) {
  SerialRig rig;
  EXPECT_NE(rig.ask("M114").find("(not homed)"), std::string::npos);
  ASSERT_TRUE(rig.machine.make_ready());
  rig.ask("G1 X10 Y-5 F3000");
  EXPECT_EQ(rig.ask("M114").rfind("X:10.000 Y:-5.000 Z:20.000 E:0.0000 Count ", 0), 0u) << rig.ask("M114");
  rig.ask("G92 X100 E7.5");
  EXPECT_EQ(rig.ask("M114").rfind("X:100.000 Y:-5.000 Z:20.000 E:7.5000 Count ", 0), 0u) << rig.ask("M114");
  rig.ask("G92 X10");
  rig.ask("G10 L2 P2 X1 Y2 Z3");
  rig.ask("G55");
  rig.ask("M400");
  EXPECT_EQ(rig.ask("M114").rfind("X:9.000 Y:-7.000 Z:17.000 E:7.5000 Count ", 0), 0u) << rig.ask("M114");
  ASSERT_TRUE(rig.until([&] { return rig.machine.gateway->state() == MachineState::kReady; }, 10s));
  EXPECT_EQ(rig.ask("M114").rfind("X:9.000 Y:-7.000 Z:17.000 E:7.5000 Count ", 0), 0u)
      << "the same when the lines are closed: " << rig.ask("M114");
}

TEST(PrintHost, BareM220AndM221TellTheRatios) {
  SerialRig rig;
  EXPECT_EQ(rig.ask("M220"), "FR:100%\n");
  rig.ask("M220 S80");
  rig.ask("M221 S95");
  EXPECT_EQ(rig.ask("M220"), "FR:80%\n");
  EXPECT_EQ(rig.ask("M221"), "echo:E0 Flow: 95%\n");
}

TEST(PrintHost, M118SaysTextAsTheHostIsToTakeIt) {
  SerialRig rig;
  EXPECT_EQ(rig.ask("M118 E1 hello"), "echo:hello\n");
  EXPECT_EQ(rig.ask("M118 A1 action:pause"), "//action:pause\n");
  EXPECT_EQ(rig.ask("M118 ok"), "echo:ok\n") << "no host counts it";
}

/// The forms of lines that hosts tell apart, from what OctoPrint, Pronterface and Repetier-Host look for.
struct Form {
  const char* name;
  std::regex pattern;
};
std::vector<Form> forms() {
  const std::string number = "[-+]?[0-9]+(\\.[0-9]+)?";
  std::vector<Form> all;
  const auto add = [&](const char* name, const std::string& pattern) {
    all.push_back({name, std::regex(pattern)});
  };
  add("greeting", "start");
  add("ok", "ok( N-?[0-9]+)?( P[0-9]+)?( B[0-9]+)?");
  add("temperature", "(ok)?( (T|B|C|[TBC][0-9]+|@|B@|W):" + number + "( ?/" + number + ")?)+.*");
  add("position", "X:" + number + " Y:" + number + " Z:" + number + " E:" + number + " Count .*");
  add("firmware", "FIRMWARE_NAME:[^:]+ PROTOCOL_VERSION:[^:]+ MACHINE_TYPE:[^:]+ EXTRUDER_COUNT:[0-9]+");
  add("capability", "Cap:[A-Z0-9_]+:[01]");
  add("busy", "echo:busy: (processing|paused for user)");
  add("echo", "echo:.*");
  add("action", "//action:(pause|paused|resumed|cancel|notification .*)");
  add("switches", "Reporting endstop status|[A-Za-z0-9_]+: (TRIGGERED|open)");
  add("feed", "FR:[0-9]+%");
  add("files",
      "Begin file list|End file list|File opened: .* Size: [0-9]+|File selected|SD card ok|Not SD printing|"
      "SD printing byte [0-9]+/[0-9]+|[A-Za-z0-9_.]+ [0-9]+|Done printing file");
  add("resend", "Resend: [0-9]+");
  // Hosts that read another "Error:" give up and stop the machine.
  add("error", "Error:.*([Cc]hecksum|Line Number|Format error).*");
  return all;
}

TEST(PrintHost, EveryLineOfASessionHasAFormThatHostsKnow) {
  SerialRig rig(0.1, 3);
  for (const char* line :
       {"M110 N0", "M115",     "M155 S2",   "M105",       "M114",         "G28",        "M119",    "M503",
        "M220",    "M221 S98", "M20",       "M27",        "M117 layer 1", "M118 hello", "M302 S0", "G29",
        "G1 X400", "M999",     "M106 S128", "M106 P3 S9", "M84",          "M73 P10",    "M114"})
    rig.ask(line);
  std::string text = "G90\nM82\nG92 E0\nM190 S30\n";
  for (int i = 1; i <= 40; ++i) text += print("G1 X%d Y%.1f F6000\n", i % 2 * 10, i * 0.2);
  text += "G4 P300\nM107\nM140 S0\nM84\n";
  ASSERT_TRUE(rig.print(text, 300s)) << rig.log();
  rig.write(std::string(1500, 'G') + "\n");
  rig.until([] { return false; }, 1s);
  const auto known = forms();
  for (const std::string& answer : rig.answers) {
    bool matches = false;
    for (const Form& form : known) matches = matches || std::regex_match(answer, form.pattern);
    EXPECT_TRUE(matches) << answer;
  }
  EXPECT_GT(rig.damaged, 0u);
}

}  // namespace
}  // namespace kinebus

#include "gateway/sessions/serial/marlin_session.hpp"

#include <gtest/gtest.h>

#include "gateway/machine/tests/heat_printer.hpp"
#include "gateway/sessions/serial/tests/serial_rig.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

TEST(MarlinSession, GreetsAndAnswersTemperatureWithinOk) {
  SerialRig rig;
  EXPECT_TRUE(rig.said("start"));
  EXPECT_NE(rig.ask("M105").find("ok T:"), std::string::npos) << rig.log();
  const std::string about = rig.ask("M115");
  EXPECT_NE(about.find("FIRMWARE_NAME:Kinebus"), std::string::npos);
  EXPECT_NE(about.find("Cap:EMERGENCY_PARSER:1"), std::string::npos);
}

TEST(MarlinSession, G28FromSwitchedOffBringsUpHomesAndStandsAtTheReference) {
  SerialRig rig;
  EXPECT_EQ(rig.ask("G1 X10"), "echo:home the machine first (G28)\n");
  rig.ask("G28");
  EXPECT_TRUE(rig.said("echo:busy: processing")) << rig.log();
  const MachineStatus status = rig.machine.gateway->status();
  EXPECT_TRUE(status.positions_known) << rig.log();
  EXPECT_NEAR(status.machine_pose[kZ], 20, 1e-3) << rig.log();
  rig.ask("G91");
  rig.ask("G1 X10 F3000");
  rig.ask("M400");
  EXPECT_NEAR(rig.machine.gateway->status().machine_pose[kX], 10, 2e-3);
  ASSERT_TRUE(rig.until([&] { return rig.machine.gateway->state() == MachineState::kReady; }, 10s))
      << "the machine is given back to others";
  rig.ask("G1 X-4");
  rig.ask("M400");
  EXPECT_NEAR(rig.machine.gateway->status().machine_pose[kX], 6, 2e-3) << "G91 is kept";
}

TEST(MarlinSession, LineOutOfReachIsRefusedAndNothingMoves) {
  SerialRig rig;
  ASSERT_TRUE(rig.machine.make_ready());
  const std::string answer = rig.ask("G1 X400 F3000");
  EXPECT_EQ(answer.rfind("echo:", 0), 0u) << answer;
  rig.ask("M400");
  EXPECT_NEAR(rig.machine.gateway->status().machine_pose[kX], 0, 1e-3);
  EXPECT_EQ(rig.ask("G1 X5 F3000"), "");
  rig.ask("M400");
  EXPECT_NEAR(rig.machine.gateway->status().machine_pose[kX], 5, 2e-3);
}

TEST(MarlinSession, UnknownCodesAreEchoedAndTheNextLineIsTaken) {
  SerialRig rig;
  EXPECT_EQ(rig.ask("M876 P0"), "echo:Unknown command: \"M876 P0\"\n");
  EXPECT_EQ(rig.ask("M118 hello"), "echo:hello\n");
  EXPECT_EQ(rig.ask(""), "no ok") << "an empty line is nothing";
}

TEST(MarlinSession, M112StopsAtOnceThoughLinesWait) {
  SerialRig rig;
  ASSERT_TRUE(rig.machine.make_ready());
  std::string text = "G91\n";
  for (int i = 0; i < 60; ++i) text += i % 2 ? "G1 X20 F1200\n" : "G1 X-20 F1200\n";
  rig.write(text);
  ASSERT_TRUE(rig.until([&] { return rig.machine.gateway->status().rate > 0.9; }, 10s)) << rig.log();
  rig.write("M112\n");
  const BusTime asked = rig.machine.now;
  ASSERT_TRUE(rig.until([&] { return rig.machine.gateway->state() == MachineState::kStopped; }, 5s));
  EXPECT_LT(rig.machine.now - asked, 500ms);
  EXPECT_EQ(rig.ask("G1 X1"), "echo:the machine is stopped: M999 lifts the stop\n");
  rig.ask("M999");
  EXPECT_EQ(rig.machine.gateway->state(), MachineState::kReady) << rig.log();
  EXPECT_EQ(rig.ask("G1 X1 F600"), "");
}

TEST(MarlinSession, M303IsAnsweredWhenTheHeaterIsMeasured) {
  SerialRig rig(0, 1, printer_on_the_bus());
  ASSERT_TRUE(rig.machine.make_ready());
  rig.ask("G91");
  rig.ask("G1 X5 F3000");  // its lines are open
  const std::string answer = rig.ask("M303 E0 S210 C8", 400s);
  for (const char* words : {"full power for half of the way", "T:1", "busy: processing", "dead time of"})
    EXPECT_NE((answer + rig.log()).find(words), std::string::npos) << words << "\n" << answer << rig.log();
  bool done = false;
  for (const NamedHeaterStatus& heater : rig.machine.gateway->status().heaters)
    done = done || heater.tuning.stage == TuningStage::kDone;
  EXPECT_TRUE(done) << rig.log();
  EXPECT_EQ(rig.ask("G1 X5 F3000"), "");
  SerialRig simulated;
  ASSERT_TRUE(simulated.machine.make_ready());
  EXPECT_EQ(simulated.ask("M303 E0 S210"),
            "echo:heater.hotend: it is simulated: only a heater on a heat node can be measured\n");
}

TEST(MarlinSession, MotionOfTheLeadHoldsTheOkBack) {
  SerialRig rig;
  ASSERT_TRUE(rig.machine.make_ready());
  rig.ask("G91");
  std::string text;
  for (int i = 0; i < 200; ++i) text += i % 2 ? "G1 X30 F600\n" : "G1 X-30 F600\n";
  rig.write(text);
  rig.turn();
  std::size_t oks = 0;
  for (const std::string& answer : rig.answers) oks += answer.rfind("ok", 0) == 0 ? 1 : 0;
  EXPECT_EQ(oks, 2u) << "G91, and a move that alone takes longer than the lead";
}

TEST(MarlinSession, HeatersAreReportedWhileALineWaitsForThem) {
  SerialRig rig;
  rig.ask("M140 S40");
  rig.ask("M190 S40");
  EXPECT_TRUE(rig.said(" T:")) << rig.log();
  EXPECT_GT(rig.machine.gateway->status().heater(kFirstBed).actual_celsius, 37);
  EXPECT_EQ(rig.ask("M104 S900").rfind("echo:", 0), 0u);
}

TEST(MarlinSession, TemperatureIsReportedByItselfAfterM155) {
  SerialRig rig;
  rig.ask("M155 S1");
  rig.answers.clear();
  rig.until([] { return false; }, 5s);
  EXPECT_GE(rig.answers.size(), 4u);
  EXPECT_LE(rig.answers.size(), 6u);
}

TEST(MarlinSession, CancelByAnotherClientEndsThePrintUntilANewOneBegins) {
  SerialRig rig;
  ASSERT_TRUE(rig.machine.make_ready());
  std::string text = "G91\n";
  for (int i = 0; i < 20; ++i) text += i % 2 ? "G1 X20 F1200\n" : "G1 X-20 F1200\n";
  rig.write(text);
  ASSERT_TRUE(rig.until([&] { return rig.machine.gateway->status().rate > 0.9; }, 10s)) << rig.log();
  ASSERT_TRUE(rig.machine.gateway->carry_out(command::Cancel{}));
  ASSERT_TRUE(rig.until([&] { return rig.machine.gateway->state() == MachineState::kReady; }, 10s))
      << rig.log();
  EXPECT_TRUE(rig.said("//action:cancel"));
  EXPECT_EQ(rig.ask("G1 X1 F600").rfind("echo:", 0), 0u);
  rig.ask("M110 N0");
  EXPECT_EQ(rig.ask("G1 X1 F600"), "");
}

TEST(MarlinSession, HoldByAnotherClientIsToldAndResumeGoesOn) {
  SerialRig rig;
  ASSERT_TRUE(rig.machine.make_ready());
  rig.ask("G91");
  rig.write("G1 X30 F600\nM400\n");
  ASSERT_TRUE(rig.until([&] { return rig.machine.gateway->status().machine_pose[kX] > 5; }, 10s));
  ASSERT_TRUE(rig.machine.gateway->carry_out(command::Hold{}));
  rig.until([] { return false; }, 5s);
  EXPECT_TRUE(rig.said("//action:paused"));
  EXPECT_TRUE(rig.said("echo:busy: paused for user"));
  ASSERT_TRUE(rig.machine.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.until([&] { return rig.machine.gateway->state() == MachineState::kReady; }, 20s));
  EXPECT_TRUE(rig.said("//action:resumed"));
  EXPECT_NEAR(rig.machine.gateway->status().machine_pose[kX], 30, 2e-3);
}

TEST(MarlinSession, StoredJobsAreListedWrittenRunAndDeleted) {
  SerialRig rig;
  ASSERT_TRUE(rig.machine.make_ready());
  EXPECT_EQ(rig.ask("M28 part.gco"), "Writing to file: part.gco\n");
  rig.ask("G1 X10 F3000");
  rig.ask("M105 ; a line of the file");
  EXPECT_EQ(rig.ask("M29"), "Done saving file.\n");
  EXPECT_NEAR(rig.machine.gateway->status().machine_pose[kX], 0, 1e-3) << "lines of the file do not move";
  EXPECT_EQ(rig.files.texts["part.gco"], "G1 X10 F3000\nM105\n");
  EXPECT_EQ(rig.ask("M20"), "Begin file list\npart.gco 18\nEnd file list\n");
  EXPECT_EQ(rig.ask("M27"), "Not SD printing\n");
  EXPECT_EQ(rig.ask("M23 part.gco"), "File opened: part.gco Size: 18\nFile selected\n");
  EXPECT_EQ(rig.ask("M24"), "");
  ASSERT_TRUE(rig.until([&] { return rig.said("Done printing file"); }, 20s)) << rig.log();
  EXPECT_NEAR(rig.machine.gateway->status().machine_pose[kX], 10, 2e-3);
  EXPECT_EQ(rig.ask("M30 part.gco"), "File deleted:part.gco\n");
  EXPECT_EQ(rig.ask("M32 part.gco").rfind("open failed", 0), 0u);
}

TEST(MarlinSession, HostThatVanishesLeavesTheMachineAtRestOnThePath) {
  SerialRig rig;
  ASSERT_TRUE(rig.machine.make_ready());
  rig.write("G91\nG1 X14 F1200\nG1 Y14\n");
  ASSERT_TRUE(rig.until([&] { return rig.machine.gateway->status().rate > 0.9; }, 10s));
  rig.session.on_closed(rig.machine.now, "cable pulled");
  ASSERT_TRUE(rig.machine.reach(MachineState::kReady, 10s)) << rig.log();
  EXPECT_NEAR(rig.machine.gateway->status().machine_pose[kX], 14, 2e-3);
  EXPECT_NEAR(rig.machine.gateway->status().machine_pose[kY], 14, 2e-3);
  EXPECT_FALSE(rig.machine.told(MachineEvent::Kind::kAlarm)) << rig.log();
}

TEST(MarlinSession, SlowHostsMotionStopsAndGoesOnOnThePathWithoutStarvingTheNodes) {
  SerialRig rig(0.05, 7);
  ASSERT_TRUE(rig.machine.make_ready());
  std::string text = "G21\nG90\n";
  for (int i = 1; i <= 60; ++i)
    text += "G1 X" + std::to_string(i % 2 ? 15 : -15) + " Y" + std::to_string(i * 0.5) + " F9000\n";
  ASSERT_TRUE(rig.print(text, 200s, 900ms)) << rig.log();
  const MachineStatus status = rig.machine.gateway->status();
  EXPECT_NEAR(status.machine_pose[kX], -15, 2e-3);
  EXPECT_NEAR(status.machine_pose[kY], 30, 2e-3);
  EXPECT_EQ(status.counters.starvation_holds, 0u) << "every stop was planned";
  EXPECT_EQ(status.counters.underruns, 0u);
  EXPECT_GT(rig.damaged, 0u);
  EXPECT_FALSE(rig.machine.told(MachineEvent::Kind::kAlarm)) << rig.log();
}

TEST(MarlinSession, AHostHasControlWhileItsLinesMoveAndGivesItBackWhenItOnlyAsks) {
  SerialRig rig;
  ASSERT_TRUE(rig.machine.make_ready());
  EXPECT_TRUE(rig.control.clients().empty());
  rig.ask("M105");
  ASSERT_EQ(rig.control.clients().size(), 1u);
  EXPECT_EQ(rig.control.clients()[0].name, "print host on serial");
  EXPECT_EQ(rig.control.holder(), 0u) << "who only asks has no control";
  rig.ask("G1 X5 F3000");
  EXPECT_EQ(rig.control.holder(), rig.control.clients()[0].id);
  rig.ask("M400");
  BusTime next_poll = rig.machine.now;
  ASSERT_TRUE(rig.until(
      [&] {
        if (rig.machine.now >= next_poll) rig.write("M105\n");
        if (rig.machine.now >= next_poll) next_poll += 1s;
        return rig.control.holder() == 0;
      },
      20s))
      << "its temperature polls keep no control";
  EXPECT_EQ(rig.control.clients().size(), 1u);
  ASSERT_TRUE(rig.until([&] { return rig.control.clients().empty(); }, 30s)) << "a silent host has gone";
}

TEST(MarlinSession, WhileAnotherClientHasControlAHostMayAskAndStopButNotMove) {
  SerialRig rig;
  ASSERT_TRUE(rig.machine.make_ready());
  const ClientId desk = rig.control.attach("desktop", "usb");
  ASSERT_TRUE(rig.control.take(desk, false));
  for (const char* line : {"G1 X5 F3000", "M104 S200", "G28", "M24", "M17"})
    EXPECT_EQ(rig.ask(line), "echo:desktop has control of the machine\n") << line;
  EXPECT_NE(rig.ask("M105").find("ok T:"), std::string::npos);
  EXPECT_NEAR(rig.machine.gateway->status().machine_pose[kX], 0, 1e-3);
  rig.control.release(desk);
  EXPECT_EQ(rig.ask("G1 X5 F3000"), "");
  // Taken by force in the middle: what was taken is moved, nothing more is.
  ASSERT_TRUE(rig.control.take(desk, true));
  EXPECT_EQ(rig.ask("G1 X9"), "echo:desktop has control of the machine\n");
  ASSERT_TRUE(rig.until([&] { return rig.machine.gateway->state() == MachineState::kReady; }, 20s))
      << rig.log();
  EXPECT_NEAR(rig.machine.gateway->status().machine_pose[kX], 5, 2e-3);
  rig.write("M112\n");
  ASSERT_TRUE(rig.until([&] { return rig.machine.gateway->state() == MachineState::kStopped; }, 5s));
}

TEST(MarlinSession, ASlowDiskKeepsALineWaitingAndNothingElse) {
  SerialRig rig;
  rig.files.texts["part.gco"] = "G1 X1 F600\n";
  rig.files.slow = true;
  const std::size_t before = rig.answers.size();
  rig.write("M20\n");
  rig.until([] { return false; }, std::chrono::milliseconds{100});
  EXPECT_EQ(rig.answers.size(), before);
  rig.files.answer_late();
  ASSERT_TRUE(rig.until([&] { return rig.answers.size() > before && rig.answers.back().rfind("ok", 0) == 0; },
                        std::chrono::seconds{1}));
  EXPECT_EQ(rig.answers[before], "Begin file list");
  // An emergency stop is not behind it.
  rig.write("M20\nM112\n");
  rig.turn();
  EXPECT_EQ(rig.answers[rig.answers.size() - 2], "Error:Printer halted. kill() called!");
}

}  // namespace
}  // namespace kinebus

// The job link with the machine moving: statuses, jobs, history, console.

#include "gateway/sessions/console.hpp"
#include "gateway/sessions/tests/link_rig.hpp"

namespace kinebus {
namespace {

using joblink::ClientMessage;
using namespace std::chrono_literals;

const char* const kJob = "G21 G90\nG0 X0 Y0 Z5\nG1 X20 Y0 F3000\nG1 X20 Y20\nG1 X0 Y20\nG1 X0 Y0\nM2\n";

ClientMessage start_job(const std::string& name) {
  ClientMessage message;
  message.mutable_start_job()->set_name(name);
  return message;
}

/// A machine that is homed, and one client with the job stored.
class LinkMachineTest : public ::testing::Test {
 protected:
  LinkRig rig_;
  LinkedClient* anna_ = nullptr;
  void SetUp() override {
    ASSERT_TRUE(rig_.machine.make_ready()) << rig_.machine.story();
    anna_ = &rig_.connect("anna", 20);
    rig_.upload(*anna_, "square.gcode", kJob);
    rig_.pump();
  }
  bool ready() const { return rig_.machine.gateway->state() == MachineState::kReady; }
  std::vector<joblink::JobRun> history() {
    const auto reply = rig_.ask(*anna_, plain(&ClientMessage::mutable_get_history));
    return {reply.history().runs().begin(), reply.history().runs().end()};
  }
};

/// A request without anything in it, by its number.
ClientMessage empty_request(int number) {
  std::string bytes;
  for (unsigned tag = static_cast<unsigned>(number) << 3 | 2; tag != 0; tag >>= 7)
    bytes += static_cast<char>((tag & 0x7F) | (tag > 0x7F ? 0x80U : 0U));
  bytes += '\0';
  ClientMessage message;
  EXPECT_TRUE(message.ParseFromString(bytes));
  EXPECT_EQ(static_cast<int>(message.request_case()), number);
  return message;
}

TEST_F(LinkMachineTest, EveryCommandThatTheStatusListsIsKnown) {
  const auto status = rig_.ask(*anna_, plain(&ClientMessage::mutable_get_status)).status();
  ASSERT_GT(status.commands_size(), 15);
  for (const auto& command : status.commands()) {
    const auto reply = rig_.ask(*anna_, empty_request(static_cast<int>(command.command())));
    EXPECT_NE(reply.error().code(), joblink::ERROR_NOT_UNDERSTOOD) << command.command();
  }
}

TEST_F(LinkMachineTest, AJobIsWatchedToItsEndAndKeptInTheHistory) {
  LinkedClient& bert = rig_.connect("bert", 20);
  ASSERT_FALSE(rig_.ask(*anna_, start_job("square.gcode")).has_error());
  const BusTime begun = rig_.machine.now;
  bert.news.clear();
  ASSERT_TRUE(rig_.run_until([&] { return ready(); }, 60s)) << rig_.machine.story();
  const double took_s = to_seconds(rig_.machine.now - begun);
  rig_.pump();
  const auto statuses = bert.all<joblink::Status>();
  EXPECT_GE(static_cast<double>(statuses.size()), 18 * took_s);
  bool ran = false;
  for (const auto& status : statuses)
    ran = ran || (status.state() == joblink::STATE_RUNNING && status.job() == "square.gcode" &&
                  status.line() > 2 && status.joints_size() > 0 && status.nodes_size() == 3);
  EXPECT_TRUE(ran);
  EXPECT_TRUE(bert.saw_event(joblink::EVENT_FINISHED));
  const auto runs = history();
  ASSERT_EQ(runs.size(), 1U);
  EXPECT_EQ(runs[0].result(), joblink::JOB_COMPLETE);
  EXPECT_NEAR(runs[0].duration_s(), took_s, 1);
  EXPECT_GT(runs[0].estimate_s(), 0);
}

TEST_F(LinkMachineTest, AKilledClientDoesNotHarmTheJob) {
  ASSERT_FALSE(rig_.ask(*anna_, start_job("square.gcode")).has_error());
  ASSERT_TRUE(rig_.run_until([&] { return rig_.machine.gateway->status().line > 2; }, 30s));
  rig_.unplug(*anna_);
  ASSERT_TRUE(rig_.run_until([&] { return ready(); }, 60s));
  rig_.plug(*anna_);
  ASSERT_EQ(history().size(), 1U);
  EXPECT_EQ(history()[0].result(), joblink::JOB_COMPLETE);
}

TEST_F(LinkMachineTest, ACancelledJobIsToldSo) {
  ASSERT_FALSE(rig_.ask(*anna_, start_job("square.gcode")).has_error());
  ASSERT_TRUE(rig_.run_until([&] { return rig_.machine.gateway->status().line > 2; }, 30s));
  ASSERT_FALSE(rig_.ask(*anna_, plain(&ClientMessage::mutable_cancel)).has_error());
  ASSERT_TRUE(rig_.run_until([&] { return ready(); }, 30s));
  ASSERT_EQ(history().size(), 1U);
  EXPECT_EQ(history()[0].result(), joblink::JOB_CANCELLED);
}

TEST_F(LinkMachineTest, AJobWithErrorsIsRefusedWithTheFirstOfThem) {
  rig_.upload(*anna_, "bad.gcode", "G0 X0 Y0 Z5\nG1 X5000 F100\n");
  rig_.pump();
  ASSERT_FALSE(rig_.ask(*anna_, start_job("bad.gcode")).has_error());
  ASSERT_TRUE(rig_.run_until([&] { return ready(); }, 10s));
  EXPECT_TRUE(anna_->saw_event(joblink::EVENT_PROBLEM));
  ASSERT_EQ(history().size(), 1U);
  EXPECT_EQ(history()[0].result(), joblink::JOB_REFUSED);
  EXPECT_NE(history()[0].first_error().find("line 2"), std::string::npos) << history()[0].first_error();
}

TEST_F(LinkMachineTest, ACheckFindsTheLineAndIsRemembered) {
  rig_.upload(*anna_, "bad.gcode", "G0 X0 Y0 Z5\nG1 X5000 F100\n");
  rig_.pump();
  ClientMessage check;
  check.mutable_check_job()->set_name("bad.gcode");
  const auto found = rig_.ask(*anna_, check).preflight();
  ASSERT_GT(found.problems_size(), 0);
  EXPECT_EQ(found.problems(0).line(), 2U);
  check.mutable_check_job()->set_name("square.gcode");
  EXPECT_EQ(rig_.ask(*anna_, check).preflight().summary().errors(), 0U);
  const auto jobs = rig_.ask(*anna_, plain(&ClientMessage::mutable_list_jobs)).jobs();
  ASSERT_EQ(jobs.jobs_size(), 2);
  EXPECT_GT(jobs.jobs(0).preflight().errors(), 0U);
  EXPECT_GT(jobs.jobs(1).preflight().motion_s(), 1);
  EXPECT_TRUE(ready());
}

TEST_F(LinkMachineTest, ARunningJobIsNotDeleted) {
  ASSERT_FALSE(rig_.ask(*anna_, start_job("square.gcode")).has_error());
  ClientMessage remove;
  remove.mutable_delete_job()->set_name("square.gcode");
  EXPECT_EQ(rig_.ask(*anna_, remove).error().code(), joblink::ERROR_JOB_IN_USE);
  ASSERT_TRUE(rig_.run_until([&] { return ready(); }, 60s));
  EXPECT_FALSE(rig_.ask(*anna_, remove).has_error());
}

TEST_F(LinkMachineTest, AConsoleLineReallyMovesAndIsCheckedBefore) {
  const auto console = [&](const std::string& line) {
    ClientMessage message;
    message.mutable_console()->set_line(line);
    return rig_.ask(*anna_, message);
  };
  EXPECT_FALSE(console("G90").has_error());
  const auto moved = console("G1 X12 Y-3 F3000");
  ASSERT_FALSE(moved.has_error()) << moved.error().rule();
  ASSERT_TRUE(rig_.run_until([&] { return ready(); }, 20s));
  EXPECT_NEAR(rig_.machine.gateway->status().pose[kX], 12, 0.01);
  EXPECT_NEAR(rig_.machine.gateway->status().pose[kY], -3, 0.01);
  EXPECT_FALSE(console("G91").has_error());
  ASSERT_FALSE(console("G0 X1").has_error());
  ASSERT_TRUE(rig_.run_until([&] { return ready(); }, 20s));
  EXPECT_NEAR(rig_.machine.gateway->status().pose[kX], 13, 0.01);
  EXPECT_FALSE(console("G90").has_error());
  EXPECT_TRUE(console("G1 X5000").has_error());
  ASSERT_TRUE(rig_.run_until([&] { return ready(); }, 20s));
  EXPECT_NEAR(rig_.machine.gateway->status().pose[kX], 13, 0.01);
  const std::string told = console("M114").console().text();
  ASSERT_EQ(told.substr(0, 2), "X:") << told;
  EXPECT_NEAR(std::stod(told.substr(2)), 13, 0.01) << told;
}

TEST_F(LinkMachineTest, AWorkOffsetShiftsWhatTheConsoleSays) {
  ClientMessage offset;
  offset.mutable_set_work_offset()->set_system(1);
  offset.mutable_set_work_offset()->mutable_offset()->set_x_mm(7);
  ASSERT_FALSE(rig_.ask(*anna_, offset).has_error());
  ClientMessage move;
  move.mutable_console()->set_line("G1 X2 F3000");
  ASSERT_FALSE(rig_.ask(*anna_, move).has_error());
  ASSERT_TRUE(rig_.run_until([&] { return ready(); }, 20s));
  EXPECT_NEAR(rig_.machine.gateway->status().pose[kX], 9, 0.01);
  const auto status = rig_.ask(*anna_, plain(&ClientMessage::mutable_get_status)).status();
  EXPECT_EQ(status.work_system(), 1u);
  EXPECT_NEAR(status.work_offset().x_mm(), 7, 1e-9);
  move.mutable_console()->set_line("G56");
  ASSERT_FALSE(rig_.ask(*anna_, move).has_error());
  EXPECT_EQ(rig_.ask(*anna_, plain(&ClientMessage::mutable_get_status)).status().work_system(), 3u);
}

TEST_F(LinkMachineTest, AMotorsCurrentsAreSetAndOneMotorIsJogged) {
  const auto tower1 = [&] {
    return rig_.ask(*anna_, plain(&ClientMessage::mutable_get_status)).status().nodes(0).axes(0);
  };
  const double run_a = tower1().run_current_a();
  ClientMessage set;
  set.mutable_set_motor_currents()->set_joint(0);
  set.mutable_set_motor_currents()->set_run_a(run_a / 2);
  ASSERT_FALSE(rig_.ask(*anna_, set).has_error());
  ASSERT_TRUE(rig_.run_until([&] { return tower1().run_current_a() == run_a / 2; }, 5s));
  set.mutable_set_motor_currents()->set_run_a(run_a * 2);
  EXPECT_NE(rig_.ask(*anna_, set).error().rule().find("max_current_ma"), std::string::npos);
  const double before = rig_.machine.gateway->status().joints[0];
  ClientMessage jog;
  jog.mutable_jog_motor()->set_distance(1);
  ASSERT_FALSE(rig_.ask(*anna_, jog).has_error());
  ASSERT_TRUE(rig_.run_until([&] { return ready(); }, 20s));
  EXPECT_NEAR(rig_.machine.gateway->status().joints[0], before + 1, 0.01);
  ClientMessage tune;
  tune.mutable_tune_motor()->set_joint(17);
  EXPECT_TRUE(rig_.ask(*anna_, tune).has_error());
  ClientMessage heater;
  heater.mutable_tune_heater()->set_kind(joblink::HEATER_HOTEND);
  EXPECT_NE(rig_.ask(*anna_, heater).error().rule().find("only a heater on a heat node can be measured"),
            std::string::npos);
}

TEST_F(LinkMachineTest, TheStatusTellsWhichCommandsMayBeGivenAndWhyNotTheOthers) {
  const auto of = [&](joblink::Command wanted) {
    const auto status = rig_.ask(*anna_, plain(&ClientMessage::mutable_get_status)).status();
    for (const joblink::CommandStatus& command : status.commands())
      if (command.command() == wanted) return command;
    ADD_FAILURE() << joblink::Command_Name(wanted);
    return joblink::CommandStatus{};
  };
  // All of them, and none but requests.
  const auto& values = *joblink::Command_descriptor();
  for (int i = 1; i < values.value_count(); ++i) {
    const auto* field = ClientMessage::descriptor()->FindFieldByNumber(values.value(i)->number());
    ASSERT_NE(field, nullptr) << values.value(i)->name();
    std::string name = "COMMAND_" + field->name();
    for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    EXPECT_EQ(values.value(i)->name(), name);
    of(static_cast<joblink::Command>(values.value(i)->number()));
  }
  EXPECT_TRUE(of(joblink::COMMAND_JOG).allowed());
  EXPECT_FALSE(of(joblink::COMMAND_JOG).has_why_not());
  EXPECT_FALSE(of(joblink::COMMAND_HOLD).allowed());
  ASSERT_FALSE(rig_.ask(*anna_, start_job("square.gcode")).has_error());
  ASSERT_TRUE(rig_.run_until([&] { return rig_.machine.gateway->status().line > 2; }, 30s));
  EXPECT_TRUE(of(joblink::COMMAND_HOLD).allowed());
  const joblink::CommandStatus jog = of(joblink::COMMAND_JOG);
  EXPECT_FALSE(jog.allowed());
  EXPECT_EQ(jog.why_not().text(), "cannot %1 while the machine is %2");
  EXPECT_EQ(jog.why_not().parts(1).text(), "running");
}

TEST_F(LinkMachineTest, AStoredJobIsCheckedAndRunWithTheMachinesWorkOffsets) {
  const auto offset_x = [&](double x_mm) {
    ClientMessage offset;
    offset.mutable_set_work_offset()->set_system(1);
    offset.mutable_set_work_offset()->mutable_offset()->set_x_mm(x_mm);
    ASSERT_FALSE(rig_.ask(*anna_, offset).has_error());
  };
  rig_.upload(*anna_, "shifted.gcode", "G90\nG1 X10 Y0 F6000\nG4 P300\nG10 L2 P2 X1\nG55\nG1 X5\n");
  rig_.pump();
  ClientMessage check;
  check.mutable_check_job()->set_name("shifted.gcode");
  offset_x(7);
  EXPECT_EQ(rig_.ask(*anna_, check).preflight().summary().errors(), 0u);
  ASSERT_FALSE(rig_.ask(*anna_, start_job("shifted.gcode")).has_error());
  ASSERT_TRUE(rig_.run_until([&] { return rig_.machine.gateway->state() == MachineState::kRunning; }, 20s));
  double farthest_mm = 0;
  ASSERT_TRUE(rig_.run_until(
      [&] {
        farthest_mm = std::max(farthest_mm, rig_.machine.gateway->status().pose[kX]);
        return ready();
      },
      40s));
  EXPECT_NEAR(farthest_mm, 17, 0.05) << "X10 in G54";
  EXPECT_NEAR(rig_.machine.gateway->status().pose[kX], 6, 0.01) << "X5 in the G55 that the job has set";
  EXPECT_EQ(rig_.machine.gateway->work_offsets()[1][kX], 0) << "what a job sets is its own";
  // Out of reach with this offset only: nothing moves.
  offset_x(5000);
  EXPECT_GT(rig_.ask(*anna_, check).preflight().summary().errors(), 0u);
  ASSERT_FALSE(rig_.ask(*anna_, start_job("shifted.gcode")).has_error());
  ASSERT_TRUE(rig_.run_until([&] { return ready(); }, 20s));
  EXPECT_NEAR(rig_.machine.gateway->status().pose[kX], 6, 0.01);
}

TEST_F(LinkMachineTest, AWatcherMayAskButNotMoveByTheConsole) {
  LinkedClient& bert = rig_.connect("bert");
  ClientMessage take;
  take.mutable_take_control();
  rig_.ask(*anna_, take);
  ClientMessage line;
  line.mutable_console()->set_line("M105");
  EXPECT_FALSE(rig_.ask(bert, line).has_error());
  line.mutable_console()->set_line("G1 X1");
  EXPECT_EQ(rig_.ask(bert, line).error().code(), joblink::ERROR_NO_CONTROL);
}

TEST_F(LinkMachineTest, MachineInfoDescribesWhatTheEyeNeeds) {
  const auto info = rig_.ask(*anna_, plain(&ClientMessage::mutable_get_machine)).machine();
  EXPECT_EQ(info.kinematics(), "m1");
  EXPECT_EQ(info.legs().legs_size(), 4);
  EXPECT_EQ(info.joints_size(), 6);
  EXPECT_EQ(info.bus(), LinkRig::bus) << "the one it runs on";
  EXPECT_EQ(info.nodes_size(), 3);
  EXPECT_EQ(info.bodies().table_radius_mm(), 100);
}

}  // namespace
}  // namespace kinebus

#include "gateway/description/machine_file.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cstring>
#include <fstream>
#include <sstream>

#include "gateway/bodies/collision_model.hpp"
#include "gateway/bodies/tests/legs_below.hpp"

namespace kinebus {
namespace {

const std::filesystem::path kMachines = KINEBUS_MACHINES;

std::string file_text(const std::string& name) {
  std::ifstream in(kMachines / name);
  EXPECT_TRUE(in) << name;
  std::ostringstream out;
  out << in.rdbuf();
  return std::move(out).str();
}

/// The default machine file with one piece of text replaced, and the line where that piece begins.
struct Edited {
  std::string text;
  std::uint32_t line = 0;
};
Edited edited(std::string_view from, std::string_view to, const std::string& file = "m1.toml") {
  std::string text = file_text(file);
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  const auto line =
      static_cast<std::uint32_t>(1 + std::count(text.begin(), text.begin() + static_cast<long>(at), '\n'));
  text.replace(at, from.size(), to);
  return {text, line};
}

TEST(MachineFile, TheDefaultFileIsTheDefaultMachine) {
  const auto machine = load_machine(kMachines / "m1.toml");
  ASSERT_TRUE(machine) << to_string(machine.error());
  EXPECT_EQ(write_machine(*machine), write_machine(default_m1()));
  EXPECT_TRUE(*machine == default_m1());
}

TEST(MachineFile, EveryMachineOfTheRepositoryLoadsAndHasKinematicsWithItsJoints) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kMachines)) {
    if (entry.path().extension() != ".toml") continue;
    ++files;
    const auto machine = load_machine(entry.path());
    ASSERT_TRUE(machine) << to_string(machine.error());
    const auto kinematics = make_kinematics(*machine);
    ASSERT_TRUE(kinematics) << kinematics.error().what;
    ASSERT_EQ((*kinematics)->joint_count(), static_cast<int>(machine->joints.size()));
    for (std::size_t j = 0; j < machine->joints.size(); ++j) {
      const JointInfo info = (*kinematics)->joint_info(static_cast<int>(j));
      EXPECT_EQ(info.name, machine->joints[j].name);
      EXPECT_EQ(info.rotary, machine->joints[j].rotary);
      EXPECT_EQ(info.min, machine->joints[j].travel.min) << info.name;
      EXPECT_EQ(info.max, machine->joints[j].travel.max) << info.name;
    }
    const auto ok = (*kinematics)->check(Frame::kPart, (*kinematics)->bed_reference());
    EXPECT_TRUE(ok) << entry.path() << ": " << to_string(ok.error(), **kinematics);
    // What is written reads back as the same machine.
    const auto again = parse_machine(write_machine(*machine), "written");
    ASSERT_TRUE(again) << to_string(again.error());
    EXPECT_TRUE(*again == *machine) << entry.path();
  }
  EXPECT_GE(files, 8);
}

struct Wrong {
  const char* from;
  const char* to;
  const char* message;  ///< after "m1.toml:LINE: "
};

TEST(MachineFile, AWrongKeyIsRefusedWithItsLineWhatWasFoundAndWhatIsAllowed) {
  const Wrong table[] = {
      {"speed_mm_per_s = 450 ", "speed_mm_per_s = -3 ",
       "joint.tower1.speed_mm_per_s: found -3; expected a number in 0.001 .. 100000"},
      {"speed_mm_per_s = 450 ", "speed_mm_per_s = \"fast\" ",
       "joint.tower1.speed_mm_per_s: found 'fast'; expected a number in 0.001 .. 100000"},
      {"speed_mm_per_s = 450 ", "speed_mm_per_s = nan ",
       "joint.tower1.speed_mm_per_s: found nan; expected a number in 0.001 .. 100000"},
      {"max_condition = 8 ", "max_condition = inf ",
       "kinematics.max_condition: found inf; expected a number in 1 .. 1000"},
      {"microsteps = 256 ", "microstep = 256 ",
       "joint.tower1.microstep: found a key that does not exist; expected perhaps microsteps"},
      {"microsteps = 256 ", "microsteps = 100 ",
       "joint.tower1.microsteps: found 100; expected a power of two"},
      {"node = 1 ", "node = 1.5 ", "joint.tower1.node: found 1.5; expected a whole number in 1 .. 126"},
      {"axis = \"A\" ", "axis = \"C\" ", "joint.tower1.axis: found 'C'; expected one of \"A\" \"B\""},
      {"nozzle_mm = [0, 0, 1340]", "nozzle_mm = [0, 300]",
       "kinematics.nozzle_mm: found an array of 2; expected three numbers, each in -10000 .. 10000"},
      {"nozzle_mm = [0, 0, 1340]", "nozzle_mm = 300",
       "kinematics.nozzle_mm: found 300; expected three numbers, each in -10000 .. 10000"},
      {"travel_mm = [40, 540]", "travel_mm = [540, 40]",
       "joint.tower1.travel_mm: found an array of 2; expected [least, most], least below most, in -100000 .. "
       "100000"},
      {"inverted = false ", "inverted = 0 ", "joint.tower1.inverted: found 0; expected true or false"},
      {"name = \"M1\"", "name = 1", "name: found 1; expected a text"},
      {"type = \"m1\"", "type = \"hexapod\"",
       "kinematics.type: found 'hexapod'; expected one of \"m1\" \"cartesian\" \"corexy\" \"linear_delta\" "
       "\"m4\" \"m5\""},
      {"budget = 0.6", "budget = 60", "bus.budget: found 60; expected a number in 0.05 .. 0.95"},
      {"budget = 0.6", "bitrate = 500000",
       "bus.bitrate: found 500000; expected this line taken out: every node speaks 1 Mbit/s, which is set on "
       "the interface (ip link set can0 type can bitrate 1000000)"},
      {"retract_mm = 0.8", "dwell_p_unit = \"min\"",
       "gcode.dwell_p_unit: found 'min'; expected one of \"ms\" \"s\""},
      {"ramp_ms = 100", "ramp_ms = 101",
       "stop.ramp_ms: found 101; expected an even number: ramps travel in 2 ms"},
      {"stop_accel_mm_per_s2 = 10000", "stop_accel_mm_per_s2 = 9000",
       "joint.tower1.stop_accel_mm_per_s2: found 9000; expected at least acceleration + speed / stop ramp = "
       "9500, or a "
       "longer stop.ramp_ms"},
      {"switch_input = 1 ", "switch_input = 3 ",
       "joint.tower1.homing.switch_input: found 3; expected an input of node 1 that has the home function "
       "for axis A"},
      {"switch_position_mm = 40 ", "switch_position_mm = 39 ",
       "joint.tower1.homing.switch_position_mm: found 39; expected within the joint's travel, 40 .. 540"},
      {"method = 22 ", "method = 20 ",
       "joint.tower1.homing.method: found 20, which homes towards the nozzle; expected homing away from the "
       "nozzle: method 22, with the switch at the rail's other end"},
      {"slow_mm_per_s = 4 ", "slow_mm_per_s = 41 ",
       "joint.tower1.homing.slow_mm_per_s: found 41; expected at most the fast speed, 40"},
      {"hold_current_ma = 1500 ", "hold_current_ma = 2500 ",
       "joint.tower1.hold_current_ma: found 2500; expected at most run_current_ma, 2000"},
      {"sync_timeout_ms = 175", "sync_timeout_ms = 60",
       "bus.sync_timeout_ms: found 60; expected at least two SYNC periods, 100"},
      {"traverse_mm_per_s = 300", "traverse_mm_per_s = 301",
       "gcode.traverse_mm_per_s: found 301; expected at most the tool's speed, 300"},
  };
  for (const Wrong& w : table) {
    const Edited e = edited(w.from, w.to);
    const auto machine = parse_machine(e.text, "m1.toml");
    ASSERT_FALSE(machine) << w.to;
    EXPECT_EQ(to_string(machine.error().front()), "m1.toml:" + std::to_string(e.line) + ": " + w.message);
    EXPECT_EQ(machine.error().size(), 1u) << to_string(machine.error());
  }
}

TEST(MachineFile, AMissingKeyIsReportedAtItsTable) {
  const Edited key = edited("node = 1 ", "#");
  const Edited header = edited("[joint.tower1]", "[joint.tower1]");
  const auto machine = parse_machine(key.text, "m1.toml");
  ASSERT_FALSE(machine);
  EXPECT_EQ(to_string(machine.error()),
            "m1.toml:" + std::to_string(header.line) +
                ": joint.tower1.node: missing; expected a whole number in 1 .. 126\n");
}

TEST(MachineFile, AMissingTableIsOneError) {
  std::string renamed = edited("[joint.C]", "[joint.Q]").text;
  renamed.replace(renamed.find("[joint.C."), 9, "[joint.Q.");
  const auto machine = parse_machine(renamed, "m1.toml");
  ASSERT_FALSE(machine);
  const std::string text = to_string(machine.error());
  EXPECT_NE(text.find("joint.C: missing; expected a table, [joint.C]"), std::string::npos) << text;
  EXPECT_NE(text.find("joint.Q: found a key that does not exist"), std::string::npos) << text;
  EXPECT_EQ(machine.error().size(), 2u) << text;
}

TEST(MachineFile, AllMistakesAreReportedTogetherInTheOrderOfTheFile) {
  std::string text = edited("nozzle_mm = [0, 0, 1340]", "nozle_mm = [0, 0, 1340]").text;
  const auto replace = [&](std::string_view from, std::string_view to) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  };
  replace("budget = 0.6", "budget = 1.6");
  replace("sync_timeout_ms = 175", "sync_timeout_ms = 60");
  replace("max_c = 120", "max_c = true");
  const auto machine = parse_machine(text, "m1.toml");
  ASSERT_FALSE(machine);
  std::vector<std::string> keys;
  for (const MachineFileError& e : machine.error()) keys.push_back(e.key);
  EXPECT_EQ(keys, (std::vector<std::string>{"kinematics.nozzle_mm", "kinematics.nozle_mm", "bus.budget",
                                            "bus.sync_timeout_ms", "heater.bed.max_c"}));
  for (std::size_t i = 1; i < machine.error().size(); ++i)
    EXPECT_LE(machine.error()[i - 1].line, machine.error()[i].line);
}

/// m1.toml with a node 4 that carries `functions`, and the bed there.
std::string with_node_4(std::string_view functions, std::string_view bed_place) {
  std::string text = edited("[thermal]", "[node.4]\n" + std::string(functions) + "\n[thermal]").text;
  const std::size_t bed = text.find("[heater.bed]"), where = text.find("where = \"simulated\"", bed);
  text.replace(where, 19, bed_place);
  return text;
}

TEST(MachineFile, ADeviceLivesOnAChannelThatItsNodeHas) {
  const auto machine = parse_machine(
      with_node_4("axis_pairs = 0\ninputs = 0\nheaters = 2", "where = \"node\"\nnode = 4\nchannel = 2"), "m");
  ASSERT_TRUE(machine) << to_string(machine.error());
  const HeaterDescription* bed = machine->heater(kFirstBed);
  ASSERT_NE(bed, nullptr);
  EXPECT_EQ(bed->place, (DevicePlace{DevicePlace::Where::kNode, 4, 2}));
  EXPECT_FALSE(machine->node(4)->functions.has_axes());
  EXPECT_TRUE(machine->node(1)->functions.has_axes()) << "a node is a pair of axes unless it says otherwise";
  const auto again = parse_machine(write_machine(*machine), "written");
  ASSERT_TRUE(again) << to_string(again.error());
  EXPECT_TRUE(*again == *machine);
}

TEST(MachineFile, ADeviceWhereNoneCanBeIsRefused) {
  struct Case {
    std::string functions, place, message;
  };
  const Case table[] = {
      {"axis_pairs = 0", "where = \"node\"\nnode = 5\nchannel = 1",
       "heater.bed.node: found 5; expected a node that has its table, [node.5]"},
      {"axis_pairs = 0", "where = \"node\"\nnode = 4\nchannel = 1",
       "heater.bed.channel: found 1; expected a node that has such channels: node.4.heaters is 0"},
      {"heaters = 2", "where = \"node\"\nnode = 4\nchannel = 3",
       "heater.bed.channel: found 3; expected a channel in 1 .. 2, as node.4.heaters says"},
      {"heaters = 2", "where = \"node\"\nnode = 4",
       "heater.bed.channel: missing; expected a whole number in 1 .. 16"},
      {"heaters = 2", "where = \"node\"\nnode = 4\nchannel = 99",
       "heater.bed.channel: found 99; expected a whole number in 1 .. 16"},
      {"heaters = 9", "where = \"simulated\"", "node.4.heaters: found 9; expected a whole number in 0 .. 8"},
      {"axis_pairs = 2", "where = \"simulated\"",
       "node.4.axis_pairs: found 2; expected a whole number in 0 .. 1"},
      {"", "where = \"there\"", "heater.bed.where: found 'there'; expected one of \"simulated\" \"node\""},
      {"", "", "heater.bed.where: missing; expected one of \"simulated\" \"node\""},
      {"", "where = \"simulated\"\nnode = 4", "heater.bed.node: found a key that does not exist"},
      {"axis_pairs = 0\n[node.4.input1]\nfunction = \"home\"", "where = \"simulated\"",
       "node.4.input1.function: found a switch of an axis; expected none, emergency_stop or probe: this node "
       "has no axes"},
      {"inputs = 1\n[node.4.input2]\nfunction = \"probe\"", "where = \"simulated\"",
       "node.4.input2: found a function; expected an input that the node has: node.4.inputs is 1"},
      {"", "where = \"simulated\"\n[spindle]\nwhere = \"simulated\"\npresent = true",
       "spindle.present: found true; expected no such key: a machine without spindle has no table [spindle]"},
      {"", "where = \"simulated\"\n[heater.second]\nkind = \"bed\"\nwhere = \"simulated\"",
       "heater.second.index: found 0; expected an index that no other heater of the kind has: [heater.bed] "
       "has it"},
      {"", "where = \"simulated\"\n[fan.rear]\nwhere = \"simulated\"",
       "fan.rear.index: found 0; expected an index that no other has: [fan.part] has it"},
      {"heaters = 2",
       "where = \"node\"\nnode = 4\nchannel = 1\n[heater.oven]\nkind = \"chamber\"\nwhere = \"node\"\nnode = "
       "4\nchannel = 1",
       "heater.oven.channel: found node 4 channel 1; expected a channel that no other device has: "
       "[heater.bed] "
       "has it"},
      {"", "where = \"simulated\"\n[probe]\nwhere = \"node\"\nnode = 3\nchannel = 1",
       "probe.channel: found 1; expected an input of node 3 that has the probe function"},
      {"", "where = \"simulated\"\n[fan.\"two words\"]\nwhere = \"simulated\"",
       "fan.two words: found a key that does not exist; expected at most 32 tables with names of 1 .. 32 "
       "letters, "
       "digits, - and _"},
  };
  for (const Case& c : table) {
    const auto machine = parse_machine(with_node_4(c.functions, c.place), "m");
    ASSERT_FALSE(machine) << c.message;
    EXPECT_NE(to_string(machine.error()).find(": " + c.message), std::string::npos)
        << c.message << "\n"
        << to_string(machine.error());
    EXPECT_EQ(machine.error().size(), 1u) << to_string(machine.error());
  }
}

TEST(MachineFile, AnAxisNeedsANodeThatHasAxes) {
  const auto machine = parse_machine(edited("[node.3] ", "[node.3]\naxis_pairs = 0 ").text, "m");
  ASSERT_FALSE(machine);
  EXPECT_NE(to_string(machine.error())
                .find("joint.C.node: found 3; expected a node that has axes: node.3.axis_pairs is 0"),
            std::string::npos)
      << to_string(machine.error());
}

TEST(MachineFile, HeatersOfEarlierFilesAreRefusedWithWhatStandsForThemNow) {
  const Edited e = edited("[heater.hotend]", "[thermal.hotend]\npresent = true\n\n[heater.hotend]");
  const auto machine = parse_machine(e.text, "m");
  ASSERT_FALSE(machine);
  EXPECT_EQ(to_string(machine.error()),
            "m:" + std::to_string(e.line) +
                ": thermal.hotend: found a table; expected [heater.hotend] with kind = \"hotend\", where = "
                "\"simulated\" and the same keys; a machine without hot end has no such table\n");
}

TEST(MachineFile, TwoJointsOnOneDriveAreRefused) {
  const auto machine =
      parse_machine(edited("axis = \"B\"\nmm_per_turn = 40", "axis = \"A\"\nmm_per_turn = 40").text, "m");
  ASSERT_FALSE(machine);
  EXPECT_NE(to_string(machine.error())
                .find("joint.tower2.axis: found node 1 axis A; expected a node's axis that no "
                      "other joint has"),
            std::string::npos)
      << to_string(machine.error());
}

TEST(MachineFile, AJointWithTravelMustHaveHoming) {
  std::string text = file_text("delta.toml");
  const std::size_t from = text.find("[joint.tower2.homing]"), to = text.find("[joint.tower2.calibration]");
  text.erase(from, to - from);
  const auto machine = parse_machine(text, "delta.toml");
  ASSERT_FALSE(machine);
  EXPECT_EQ(machine.error().front().key, "joint.tower2.homing");
}

TEST(MachineFile, AMirroredMechanismIsRefusedWithTheReason) {
  std::string text = file_text("m1.toml");
  for (const auto& [from, to] : {std::pair{"foot_mm = [-273, -252, 0]", "foot_mm = [-273, -63, 0]"},
                                 {"foot_mm = [-273, 252, 0]", "foot_mm = [-273, 63, 0]"},
                                 {"attachment_mm = [-124, -69, -5]", "attachment_mm = [-124, -128, -5]"},
                                 {"attachment_mm = [-124, 69, -5]", "attachment_mm = [-124, 128, -5]"}})
    text.replace(text.find(from), std::strlen(from), to);
  const auto machine = parse_machine(text, "m1.toml");
  ASSERT_FALSE(machine);
  EXPECT_EQ(machine.error().front().key, "kinematics");
  EXPECT_NE(machine.error().front().expected.find("singular"), std::string::npos)
      << to_string(machine.error());
}

TEST(MachineFile, HomingThatDrivesThePlatformIntoTheNozzleIsRefused) {
  // Whatever way the rail counts: it is the platform's motion that is judged.
  MachineDescription d = default_m1();
  auto& g = std::get<M1Geometry>(d.kinematics);
  g.legs[2].rail = {0, 0, -1};
  g.legs[2].foot_mm[2] = 580;
  g.legs[2].connector_mm = -15;
  g.legs[2].carriage_above = true;
  d.joints[2].homing->switch_position = 540;
  auto machine = parse_machine(write_machine(d), "x");
  ASSERT_FALSE(machine);
  ASSERT_EQ(machine.error().size(), 1u) << to_string(machine.error());
  EXPECT_EQ(machine.error().front().key, "joint.tower3.homing.method");
  EXPECT_NE(machine.error().front().expected.find("method 20, "), std::string::npos)
      << to_string(machine.error());
  d.joints[2].homing->method = 20;
  machine = parse_machine(write_machine(d), "x");
  EXPECT_TRUE(machine) << to_string(machine.error());
  // Limit switches, and M5's rails, are judged alike.
  std::string mill = file_text("m5.toml");
  for (std::size_t at; (at = mill.find("method = 22")) != std::string::npos;)
    mill.replace(at, 11, "method = 20");
  const auto refused = parse_machine(mill, "m5.toml");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().size(), 4u) << to_string(refused.error());
}

TEST(MachineFile, CalibrationBendsTheGeometryAndNotTheStatedOne) {
  std::string text = write_machine(default_m1());
  text += "\n[calibration.leg2]\nfoot_mm = [0.5, 0, 0]\nlength_mm = -0.25\n";
  const auto machine = parse_machine(text, "calibrated");
  ASSERT_TRUE(machine) << to_string(machine.error());
  EXPECT_EQ(std::get<M1Geometry>(machine->kinematics).legs[1].length_mm, 991);
  JointVector nominal{}, measured{};
  const Pose pose{10, 20, 30, 0.1, 0, 0};
  ASSERT_TRUE((*make_kinematics(default_m1()))->inverse(Frame::kPart, pose, nominal));
  ASSERT_TRUE((*make_kinematics(*machine))->inverse(Frame::kPart, pose, measured));
  EXPECT_EQ(nominal[0], measured[0]);
  EXPECT_GT(std::abs(nominal[1] - measured[1]), 0.1);
  EXPECT_EQ(nominal[2], measured[2]);
  const auto refused =
      parse_machine("[calibration.leg5]\nlength_mm = 1\n" + write_machine(default_m1()), "x");
  EXPECT_FALSE(refused);
}

TEST(MachineFile, ACorrectionThatNoJointCanFollowIsRefused) {
  MachineDescription d = default_m1();
  d.joints[0].calibration.pitch = 2;
  d.joints[0].calibration.periodic_sine = 0.1;
  const auto refused = parse_machine(write_machine(d), "steep");
  ASSERT_FALSE(refused);
  EXPECT_NE(to_string(refused.error()).find("slope of 0.314159; expected at most 0.05"), std::string::npos)
      << to_string(refused.error());
}

TEST(MachineFile, TextThatIsNoTomlIsRefusedWithTheLine) {
  const auto machine = parse_machine("name = \"M1\"\n[kinematics\n", "m1.toml");
  ASSERT_FALSE(machine);
  EXPECT_EQ(machine.error().front().line, 2u);
  EXPECT_TRUE(machine.error().front().found.starts_with("no valid TOML: "));
  EXPECT_FALSE(machine.error().front().expected.empty());
}

TEST(MachineFile, CharactersBeyondAsciiAreForCommentsAndStrings) {
  EXPECT_TRUE(parse_machine(edited("name = \"M1\"", "name = \"Drucker Nº 1\" # größer").text, "m1.toml"));
  EXPECT_TRUE(
      parse_machine(edited("name = \"M1\"", "name = \"\"\"a \"\"ü\"\" \\\" b\"\"\"").text, "m1.toml"));
  EXPECT_TRUE(parse_machine(edited("name = \"M1\"", "name = 'é\\'").text, "m1.toml"));
  for (const std::string misplaced : {"0.6\u00BD", "0\"/\u0449x = 2", "0.6\u0449 = 1", "\u2001 0.6\u3001"}) {
    const Edited e = edited("budget = 0.6", "budget = " + misplaced);
    const auto machine = parse_machine(e.text, "m1.toml");
    ASSERT_FALSE(machine) << misplaced;
    EXPECT_EQ(machine.error().front().line, e.line) << misplaced;
    EXPECT_TRUE(machine.error().front().found.starts_with("no valid TOML: ")) << misplaced;
  }
}

TEST(MachineFile, AnEmptyFileListsTheTablesThatItNeeds) {
  const auto machine = parse_machine("", "m1.toml");
  ASSERT_FALSE(machine);
  std::vector<std::string> keys;
  for (const MachineFileError& e : machine.error()) keys.push_back(e.key);
  EXPECT_EQ(keys, (std::vector<std::string>{"name", "kinematics", "path", "joint", "node"}));
}

TEST(MachineFile, AFileThatIsNotThereIsAnErrorWithItsName) {
  const auto machine = load_machine(kMachines / "none.toml");
  ASSERT_FALSE(machine);
  EXPECT_NE(to_string(machine.error()).find("none.toml: found no file there; expected a readable TOML file"),
            std::string::npos);
}

TEST(MachineFile, ACartesianMachineWithRotaryTableHasSixJoints) {
  std::string text = file_text("cartesian.toml");
  const std::string marker = "[path]";
  text.insert(text.find(marker), "[kinematics.rotary_table]\npivot_mm = [0, 0, -30]\n\n");
  text += R"(
[joint.A]
node = 3
axis = "A"
deg_per_turn = 36
travel_deg = [-90, 90]
speed_deg_per_s = 90
accel_deg_per_s2 = 900
stop_accel_deg_per_s2 = 1800
run_current_ma = 1500
hold_current_ma = 1000
[joint.A.homing]
method = 21
fast_deg_per_s = 20
slow_deg_per_s = 2
accel_deg_per_s2 = 200
back_off_deg = 3
switch_position_deg = -90
max_search_deg = 200
[joint.C]
node = 3
axis = "B"
deg_per_turn = 120
speed_deg_per_s = 360
accel_deg_per_s2 = 3600
stop_accel_deg_per_s2 = 7200
run_current_ma = 1200
hold_current_ma = 800
[node.3.input1]
function = "home"
)";
  const auto machine = parse_machine(text, "five_axes.toml");
  ASSERT_TRUE(machine) << to_string(machine.error());
  const auto& geometry = std::get<CartesianGeometry>(machine->kinematics);
  EXPECT_TRUE(geometry.has_table);
  EXPECT_EQ(geometry.table.pivot_mm[2], -30);
  EXPECT_DOUBLE_EQ(geometry.table.a_rad.max, 90 * kRadPerDeg);
  EXPECT_FALSE(geometry.table.c_rad.limited());
  ASSERT_EQ(machine->joints.size(), 6u);
  EXPECT_EQ(machine->joints[3].name, "A");
  const auto again = parse_machine(write_machine(*machine), "written");
  ASSERT_TRUE(again) << to_string(again.error());
  EXPECT_TRUE(*again == *machine);
}

TEST(MachineFile, WhatIsWrittenReadsBackToTheLastBit) {
  // Degrees in the file need not give every radian, so the machine is taken from a first reading.
  EXPECT_TRUE(rc::check([] {
    MachineDescription d = default_m1();
    const auto in = [](double low, double high) {
      return low +
             (high - low) * static_cast<double>(*rc::gen::inRange<std::uint64_t>(0, 1ull << 53)) * 0x1p-53;
    };
    auto& g = std::get<M1Geometry>(d.kinematics);
    for (M1Leg& leg : g.legs) {
      for (std::size_t k = 0; k < 3; ++k) {
        leg.foot_mm[k] += in(-5, 5);
        leg.attachment_mm[k] += in(-2, 2);
        leg.rail[k] += in(-0.02, 0.02);
      }
      leg.length_mm = in(986, 996);
    }
    g.max_condition = in(20, 1000);
    g.max_leg_angle_rad = in(30, 89) * kRadPerDeg;
    g.limits.a_rad = {-in(1, 45) * kRadPerDeg, in(1, 45) * kRadPerDeg};
    for (JointDescription& j : d.joints) {
      j.drive.travel_per_turn = in(1, 500) * (j.rotary ? kRadPerDeg : 1);
      j.drive.inverted = *rc::gen::arbitrary<bool>();
      j.speed_per_s = in(100, 1000) * (j.rotary ? kRadPerDeg : 1);
      j.accel_per_s2 = in(1000, 9000) * (j.rotary ? kRadPerDeg : 1);
      j.stop_accel_per_s2 = (j.accel_per_s2 + 10 * j.speed_per_s) * in(1.001, 2);
      j.calibration = {in(-0.01, 0.01), in(-1, 1) * (j.rotary ? kRadPerDeg : 1)};
      const double unit = j.rotary ? kRadPerDeg : 1;
      if (*rc::gen::arbitrary<bool>()) {
        j.calibration.backlash = in(0, 0.1) * unit;
        j.calibration.pitch = in(10, 40) * unit;
        j.calibration.periodic_sine = in(-0.002, 0.002) * unit;
        j.calibration.table_step = 50 * unit;
        j.calibration.table = {in(-0.01, 0.01) * unit, in(-0.01, 0.01) * unit, in(-0.01, 0.01) * unit};
      }
    }
    if (*rc::gen::arbitrary<bool>()) {
      d.geometry_calibration.emplace();
      d.geometry_calibration->legs[1].foot_mm = {in(-1, 1), in(-1, 1), 0};
      d.geometry_calibration->legs[3].length_mm = in(-1, 1);
      d.geometry_calibration->legs[3].rail = {in(-0.01, 0.01), in(-0.01, 0.01), 0};
    }
    d.path.axis_speed_per_s[kA] = in(0, 400) * kRadPerDeg;
    d.tolerances.blend_mm = in(0, 1);
    d.name = *rc::gen::nonEmpty(rc::gen::container<std::string>(rc::gen::inRange<char>(1, 127)));
    d.nodes[0].serial = *rc::gen::arbitrary<std::uint32_t>();
    const auto first = parse_machine(write_machine(d), "first");
    if (!first) RC_FAIL(to_string(first.error()));
    RC_ASSERT(std::abs(first->joints[4].speed_per_s - d.joints[4].speed_per_s) < 1e-12);
    const auto again = parse_machine(write_machine(*first), "again");
    if (!again) RC_FAIL(to_string(again.error()));
    RC_ASSERT(write_machine(*again) == write_machine(*first));
    RC_ASSERT(*again == *first);
  }));
}

/// A machine that has room for its bodies, and `lines` in its [bodies].
std::string with_bodies(std::string_view lines) {
  return write_machine(legs_below()).substr(0, write_machine(legs_below()).find("\n[bodies]")) +
         "\n[bodies]\n" + std::string(lines);
}

TEST(MachineFile, BodiesReadBackAsTheyWereWritten) {
  MachineDescription d = legs_below();
  d.bodies->clearance_mm = 3.5;
  d.bodies->rail_offset_mm = 61;
  d.bodies->part_radius_mm = 40;
  d.bodies->part_height_mm = 90;
  d.bodies->fixed = {{"camera", {300, -20, 1400}, {340, 20, 1440}},
                     {"lamp", {-340, -20, 1400}, {-300, 20, 1440}}};
  const auto machine = parse_machine(write_machine(d), "written");
  ASSERT_TRUE(machine) << to_string(machine.error());
  EXPECT_TRUE(*machine == d);
  const auto defaults = parse_machine(with_bodies(""), "written");
  ASSERT_TRUE(defaults) << to_string(defaults.error());
  EXPECT_TRUE(defaults->bodies == BodiesDescription{});
  EXPECT_NE(make_collision_model(*defaults), nullptr);
  EXPECT_EQ(make_collision_model(default_m1()), nullptr) << "no table, no bodies";
}

TEST(MachineFile, WrongBodiesAreRefusedWithTheirKeyAndRule) {
  const std::pair<const char*, const char*> table[] = {
      {"clearance_mm = -1", "bodies.clearance_mm: found -1; expected a number in 0.1 .. 100"},
      {"clearance_mm = 0", "bodies.clearance_mm: found 0; expected a number in 0.1 .. 100"},
      {"rod_radius_mm = 0", "bodies.rod_radius_mm: found 0; expected a number in 0.1 .. 10000"},
      {"rod_radiu_mm = 5",
       "bodies.rod_radiu_mm: found a key that does not exist; expected perhaps rod_radius_mm"},
      {"tool_length_mm = 3",
       "bodies.tool_length_mm: found 3; expected above tool_radius_mm, 4: the tool's end is round"},
      {"part_radius_mm = 30",
       "bodies.part_radius_mm: found 30; expected part_radius_mm and part_height_mm both above 0, or neither "
       "of "
       "them"},
      {"[bodies.fixed.lamp]\nfrom_mm = [1, 2, 3]",
       "bodies.fixed.lamp.to_mm: missing; expected three numbers, each in -10000 .. 10000"},
      {"[bodies.fixed.lamp]\nfrom_mm = [1, 2, 3]\nto_mm = [4, 5, 3]",
       "bodies.fixed.lamp.to_mm: found a box turned inside out; expected each of its three numbers above "
       "that of "
       "from_mm"},
      // A beam through the nozzle's axis that the table comes up against, at the bed reference as well.
      {"[bodies.fixed.beam]\nfrom_mm = [-10, -10, 1260]\nto_mm = [10, 10, 1290]",
       "bodies: found bodies that touch: at X 0 Y 0 Z 20 A 0, platform and beam would touch; expected room "
       "at "
       "the bed "
       "reference, where the machine waits before a job"},
      {"rod_radius_mm = 100", "expected a machine that has room somewhere: this is its best pose"},
  };
  for (const auto& [lines, message] : table) {
    const auto machine = parse_machine(with_bodies(lines), "m");
    ASSERT_FALSE(machine) << lines;
    EXPECT_NE(to_string(machine.error()).find(message), std::string::npos) << to_string(machine.error());
    EXPECT_EQ(machine.error().size(), 1u) << to_string(machine.error());
  }
}

TEST(MachineFile, EachKindHasTheKeysOfItsBodies) {
  for (const char* file : {"cartesian.toml", "corexy.toml"}) {
    const std::string text = file_text(file);
    EXPECT_TRUE(parse_machine(text + "\n[bodies]\nholder_radius_mm = 30\n", file));
    const auto machine = parse_machine(text + "\n[bodies]\nrod_radius_mm = 5\n", file);
    ASSERT_FALSE(machine) << file;
    EXPECT_NE(to_string(machine.error()).find("bodies.rod_radius_mm: found a key that does not exist"),
              std::string::npos);
  }
  EXPECT_TRUE(parse_machine(file_text("delta.toml") + "\n[bodies]\nrod_spacing_mm = 40\n", "delta"));
  EXPECT_TRUE(parse_machine(file_text("m4.toml") + "\n[bodies]\nrod_radius_mm = 12\n", "m4"));
  EXPECT_FALSE(parse_machine(file_text("m4.toml") + "\n[bodies]\nrod_spacing_mm = 40\n", "m4"))
      << "M4's legs are single rods";
}

TEST(MachineDescription, AnInvertedDriveHomesWithTheMirroredMethod) {
  HomingDescription homing{.method = 19};
  DriveTrain drive;
  EXPECT_EQ(homing.node_method(drive), 19);
  EXPECT_GT(drive.counts_per_unit(), 0);
  drive.inverted = true;
  EXPECT_EQ(homing.node_method(drive), 21);
  EXPECT_EQ(drive.counts_per_unit(), -51200 / 40.0);
}

}  // namespace
}  // namespace kinebus

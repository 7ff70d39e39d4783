#include "gateway/description/machine_file.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cstring>
#include "gateway/description/tests/machine_text.hpp"

namespace kinebus {
namespace {

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
      {"bed_reference_mm = 20", "tool = \"table\"",
       "kinematics.tool: found 'table'; expected one of \"frame\" \"platform\""},
      {"bed_reference_mm = 20", "tool = 1",
       "kinematics.tool: found 1; expected one of \"frame\" \"platform\""},
      {"bed_reference_mm = 20", "table_mm = [0, 0, 0]",
       "kinematics.table_mm: found an array of 3; expected no such key with the tool in the frame: the "
       "table's "
       "centre is the platform's zero"},
      {"nozzle_mm = [0, 0, 1340]", "nozzle_mm = 300",
       "kinematics.nozzle_mm: found 300; expected three numbers, each in -10000 .. 10000"},
      {"travel_mm = [10, 540]", "travel_mm = [540, 10]",
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
       "gcode.dwell_p_unit: found 'min'; expected one of \"dialect\" \"ms\" \"s\""},
      {"dialect = \"auto\"", "dialect = \"grbl\"",
       "gcode.dialect: found 'grbl'; expected one of \"auto\" \"marlin\" \"reprapfirmware\" \"klipper\" "
       "\"repetier\" \"smoothie\" \"mach3\" \"machinekit\" \"linuxcnc\""},
      {"ramp_ms = 100", "ramp_ms = 101",
       "stop.ramp_ms: found 101; expected an even number: ramps travel in 2 ms"},
      {"stop_accel_mm_per_s2 = 10000", "stop_accel_mm_per_s2 = 9000",
       "joint.tower1.stop_accel_mm_per_s2: found 9000; expected at least acceleration + speed / stop ramp = "
       "9500, or a "
       "longer stop.ramp_ms"},
      {"switch_input = 1 ", "switch_input = 3 ",
       "joint.tower1.homing.switch_input: found 3; expected an input of node 1 that has the home function "
       "for axis A"},
      {"switch_position_mm = 10 ", "switch_position_mm = 9 ",
       "joint.tower1.homing.switch_position_mm: found 9; expected within the joint's travel, 10 .. 540"},
      {"method = 22 ", "method = 20 ",
       "joint.tower1.homing.method: found 20, which homes towards the nozzle; expected homing away from the "
       "nozzle: method 22, with the switch at the rail's other end"},
      {"slow_mm_per_s = 4 ", "slow_mm_per_s = 41 ",
       "joint.tower1.homing.slow_mm_per_s: found 41; expected at most the fast speed, 40"},
      {"hold_current_ma = 1500 ", "hold_current_ma = 2500 ",
       "joint.tower1.hold_current_ma: found 2500; expected at most run_current_ma, 2000"},
      {"sync_timeout_ms = 175", "sync_timeout_ms = 60",
       "bus.sync_timeout_ms: found 60; expected at least two SYNC periods, 100"},
      {"traverse_mm_per_s = 300", "tool_orientation = [2, 2.5]\ntraverse_mm_per_s = 300",
       "gcode.tool_orientation: found 2.5; expected a whole number in 0 .. 9"},
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
    // Bodies are those of the machine as it is: one that is bent homes into them now and then, and is
    // refused.
    const bool bent = *rc::gen::arbitrary<bool>();
    if (bent) {
      d.bodies.reset();
      d.homing.spared_part_mm = 0;
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
    }
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
    if (bent && *rc::gen::arbitrary<bool>()) {
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

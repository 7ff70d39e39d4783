// What the parts of a machine file demand of each other.

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <utility>

#include "gateway/description/machine_file.hpp"
#include "gateway/description/tests/machine_text.hpp"

namespace kinebus {
namespace {

/// m1.toml with a node 4 that carries `functions`, and the bed there.
std::string with_node_4(std::string_view functions, std::string_view bed_place) {
  std::string text = edited("[thermal]", "[node.4]\n" + std::string(functions) + "\n[thermal]").text;
  const std::size_t bed = text.find("[heater.bed]"), where = text.find("where = \"simulated\"", bed);
  text.replace(where, 19, bed_place);
  return text;
}

TEST(MachineFile, ADeviceLivesOnAChannelThatItsNodeHas) {
  const auto machine = parse_machine(
      with_node_4(
          "axis_pairs = 0\ninputs = 0\nheaters = 2",
          "where = \"node\"\nnode = 4\nchannel = 2\nsensor = \"pt1000\"\nlimit_c = 140\nfan_channel = 0"),
      "m");
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

TEST(MachineFile, AThermistorOfItsOwnIsThreePointsOfItsDataSheet) {
  const auto machine = parse_machine(
      with_node_4("axis_pairs = 0\ninputs = 0\nheaters = 2",
                  "where = \"node\"\nnode = 4\nchannel = 2\nsensor = \"points\"\nsensor_points_c = [20, 100, "
                  "200]\nsensor_points_ohm = [126000, 5500, 500]\nsensor_highest_c = 220"),
      "m");
  ASSERT_TRUE(machine) << to_string(machine.error());
  const SensorWiring& sensor = machine->heater(kFirstBed)->wiring.sensor;
  EXPECT_EQ(sensor.points_c, (std::array<double, 3>{20, 100, 200}));
  EXPECT_EQ(sensor.points_ohm, (std::array<double, 3>{126'000, 5500, 500}));
  EXPECT_EQ(sensor.highest_c(), 220);
  const auto again = parse_machine(write_machine(*machine), "written");
  ASSERT_TRUE(again) << to_string(again.error());
  EXPECT_TRUE(*again == *machine);
}

TEST(MachineFile, AScaleSaysItsPulsesAndIsOnARailThatHomes) {
  const auto with = [](const std::string& table) {
    return parse_machine(edited("[joint.tower2]", table + "\n[joint.tower2]").text, "m");
  };
  const auto machine = with("[joint.tower1.scale]\npulses_per_mm = 100\ninverted = true");
  ASSERT_TRUE(machine) << to_string(machine.error());
  EXPECT_EQ(machine->joints[0].scale, (ScaleDescription{100, true}));
  EXPECT_FALSE(machine->joints[1].scale);
  const auto absolute =
      with("[joint.tower1.scale]\npulses_per_mm = 1000\nabsolute_bits = 26\ngray_code = true");
  ASSERT_TRUE(absolute) << to_string(absolute.error());
  EXPECT_EQ(absolute->joints[0].scale,
            (ScaleDescription{.pulses_per_mm = 1000, .absolute_bits = 26, .gray_code = true}));
  const auto read_again = parse_machine(write_machine(*absolute), "written");
  ASSERT_TRUE(read_again) << to_string(read_again.error());
  EXPECT_TRUE(*read_again == *absolute);
  const auto again = parse_machine(write_machine(*machine), "written");
  ASSERT_TRUE(again) << to_string(again.error());
  EXPECT_TRUE(*again == *machine);

  const std::pair<const char*, const char*> refused[] = {
      {"[joint.tower1.scale]", "joint.tower1.scale.pulses_per_mm: missing; expected a number in 1 .. 100000"},
      {"[joint.tower1.scale]\npulses_per_mm = 0",
       "joint.tower1.scale.pulses_per_mm: found 0; expected a number in 1 .. 100000"},
      {"[joint.C.scale]\npulses_per_mm = 100",
       "joint.C.scale.pulses_per_mm: found a scale on a joint that turns; expected a joint that moves along "
       "a "
       "rail"},
      {"[joint.E.scale]\npulses_per_mm = 100",
       "joint.E.scale.pulses_per_mm: found a scale on a joint that does not home at a switch; expected "
       "[joint.E.homing] with a method of 17..22: the switch's edge is where the scale begins"},
      {"[joint.tower1.scale]\npulses_per_mm = 100\ngray_code = true",
       "joint.tower1.scale.gray_code: found a code of a scale that tells no place; expected absolute_bits, "
       "or "
       "no gray_code"},
      {"[joint.tower1.scale]\npulses_per_mm = 1000\nabsolute_bits = 31",
       "joint.tower1.scale.absolute_bits: found 31; expected 8 to 30 bits"},
      {"[joint.tower1.scale]\npulses_per_mm = 1000\nabsolute_bits = 12",
       "joint.tower1.scale.absolute_bits: found a scale that begins anew every 4.096 mm; expected one that "
       "is at "
       "least 45 mm long at this speed"},
      {"[joint.tower1.motor]\nencoder = \"watch\"\n[joint.tower1.scale]\npulses_per_mm = 1000\nabsolute_bits "
       "= 26",
       "joint.tower1.motor.encoder: found an encoder and an absolute scale on one port; expected encoder = "
       "\"none\", or a scale of pulses"},
  };
  for (const auto& [table, message] : refused) {
    const auto bad = with(table);
    ASSERT_FALSE(bad) << table;
    EXPECT_NE(to_string(bad.error()).find(message), std::string::npos) << to_string(bad.error());
  }
}

TEST(MachineFile, ADeviceWhereNoneCanBeIsRefused) {
  struct Case {
    std::string functions, place, message;
  };
  const Case table[] = {
      {"axis_pairs = 0", "where = \"node\"\nnode = 5\nchannel = 1\nsensor = \"pt1000\"",
       "heater.bed.node: found 5; expected a node that has its table, [node.5]"},
      {"axis_pairs = 0", "where = \"node\"\nnode = 4\nchannel = 1\nsensor = \"pt1000\"",
       "heater.bed.channel: found 1; expected a node that has such channels: node.4.heaters is 0"},
      {"axis_pairs = 0\nheaters = 2", "where = \"node\"\nnode = 4\nchannel = 3\nsensor = \"pt1000\"",
       "heater.bed.channel: found 3; expected a channel in 1 .. 2, as node.4.heaters says"},
      {"axis_pairs = 0\nheaters = 2", "where = \"node\"\nnode = 4\nsensor = \"pt1000\"",
       "heater.bed.channel: missing; expected a whole number in 1 .. 16"},
      {"axis_pairs = 0\nheaters = 2", "where = \"node\"\nnode = 4\nchannel = 99\nsensor = \"pt1000\"",
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
      {"axis_pairs = 0\nheaters = 2",
       "where = \"node\"\nnode = 4\nchannel = 1\nsensor = \"pt100\"\n[heater.oven]\nkind = "
       "\"chamber\"\nwhere = \"node\"\nnode = 4\nchannel = 1\nsensor = \"pt100\"",
       "heater.oven.channel: found node 4 channel 1; expected a channel that no other device has: "
       "[heater.bed] "
       "has it"},
      {"axis_pairs = 0\nheaters = 2", "where = \"node\"\nnode = 4\nchannel = 1",
       "heater.bed.sensor: missing; expected one of \"pt100\" \"pt1000\" \"epcos_100k\" \"semitec_104gt2\" "
       "\"semitec_104nt4\" \"generic_3950\" \"slice_450\" \"ntc100k_mgb18\" \"honeywell_100k\" "
       "\"tdk_ntcg104\" \"beta\" \"points\""},
      {"axis_pairs = 0\nheaters = 2", "where = \"node\"\nnode = 4\nchannel = 1\nsensor = \"ntc\"",
       "heater.bed.sensor: found 'ntc'; expected one of \"pt100\""},
      {"axis_pairs = 0\nheaters = 2",
       "where = \"node\"\nnode = 4\nchannel = 1\nsensor = \"points\"\nsensor_points_c = [25, 150, 250]\n"
       "sensor_points_ohm = [100000, 230, 1770]",
       "heater.bed.sensor_points_ohm: found [100000, 230, 1770] at [25, 150, 250] C; expected a resistance "
       "that falls all the way as it gets hotter"},
      {"axis_pairs = 0\nheaters = 2",
       "where = \"node\"\nnode = 4\nchannel = 1\nsensor = \"points\"\nsensor_points_c = [25, 26, 250]\n"
       "sensor_points_ohm = [100000, 1770, 230]",
       "heater.bed.sensor_points_ohm: found [100000, 1770, 230] at [25, 26, 250] C; expected a resistance "
       "that falls all the way"},
      {"axis_pairs = 0\nheaters = 2",
       "where = \"node\"\nnode = 4\nchannel = 1\nsensor = \"points\"\nsensor_points_c = [25, 150, 250]",
       "heater.bed.sensor_points_ohm: missing; expected three numbers, each in 0.001 .. 2e+06"},
      {"axis_pairs = 0\nheaters = 2",
       "where = \"node\"\nnode = 4\nchannel = 1\nsensor = \"tdk_ntcg104\"\nlimit_c = 140",
       "heater.bed.limit_c: found 140; expected at most 125, which its sensor is made for"},
      {"axis_pairs = 0\nheaters = 2", "where = \"node\"\nnode = 4\nchannel = 1\nsensor = \"tdk_ntcg104\"",
       "heater.bed.max_c: found 120; expected at most 110: with limit_c, 15 above it, its sensor is made for "
       "no more"},
      {"axis_pairs = 0\nheaters = 2",
       "where = \"node\"\nnode = 4\nchannel = 1\nsensor = \"beta\"\nsensor_highest_c = 130",
       "heater.bed.max_c: found 120; expected at most 115: with limit_c"},
      {"axis_pairs = 0\nheaters = 2",
       "where = \"node\"\nnode = 4\nchannel = 1\nsensor = \"beta\"\nsensor_max31865 = true\n"
       "sensor_reference_ohm = 430",
       "heater.bed.sensor_max31865: found true; expected false: that converter measures pt100 and pt1000"},
      {"axis_pairs = 0\nheaters = 2",
       "where = \"node\"\nnode = 4\nchannel = 1\nsensor = \"pt100\"\nsensor_max31865 = true",
       "heater.bed.sensor_reference_ohm: missing; expected a number in 10 .. 2e+06"},
      {"axis_pairs = 0\nheaters = 2",
       "where = \"node\"\nnode = 4\nchannel = 1\nsensor = \"pt100\"\nsensor_max31865 = true\n"
       "sensor_reference_ohm = 430\nsensor_wires = 5",
       "heater.bed.sensor_wires: found 5; expected a whole number in 2 .. 4"},
      {"axis_pairs = 0\nheaters = 2",
       "where = \"node\"\nnode = 4\nchannel = 1\nsensor = \"pt100\"\nsensor_wires = 3",
       "heater.bed.sensor_wires"},
      {"axis_pairs = 0\nsensors = 1",
       "where = \"simulated\"\n[sensor.x]\nwhere = \"node\"\nnode = 4\nchannel = 1\nsensor = \"points\"\n"
       "sensor_points_c = [25, 25, 250]\nsensor_points_ohm = [100000, 1770, 230]",
       "sensor.x.sensor_points_ohm: found [100000, 1770, 230] at [25, 25, 250] C; expected a resistance"},
      {"axis_pairs = 0\noutputs = 1",
       "where = \"simulated\"\n[fan.rear]\nindex = 1\nwhere = \"node\"\nnode = 4\nchannel = 1\nkick_ms = "
       "9000",
       "fan.rear.kick_ms: found 9000; expected a whole number in 0 .. 5000"},
      {"heaters = 2", "where = \"node\"\nnode = 4\nchannel = 1\nsensor = \"pt100\"",
       "node.4.axis_pairs: found 1; expected 0 of a node that carries heat"},
      {"axis_pairs = 0\nheaters = 5", "where = \"node\"\nnode = 4\nchannel = 1\nsensor = \"pt100\"",
       "node.4.heaters: found 5; expected at most 4 on a heat node"},
      {"axis_pairs = 0\nheaters = 2",
       "where = \"node\"\nnode = 4\nchannel = 1\nsensor = \"pt100\"\nlimit_c = 125",
       "heater.bed.max_c: found 120; expected at least 10 below limit_c, which is at most 550"},
      {"axis_pairs = 0\nheaters = 2",
       "where = \"node\"\nnode = 4\nchannel = 1\nsensor = \"pt100\"\nsafe_c = 130",
       "heater.bed.safe_c: found 130; expected at most max_c"},
      {"axis_pairs = 0\nheaters = 2\noutputs = 1",
       "where = \"node\"\nnode = 4\nchannel = 1\nsensor = \"pt100\"\nfan_channel = 2",
       "heater.bed.fan_channel: found 2; expected a channel in 1 .. 1, as node.4.outputs says"},
      {"axis_pairs = 0\nfilament_sensors = 1",
       "where = \"simulated\"\n[filament_sensor.x]\nkind = \"switch\"\nwhere = \"node\"\nnode = 4\nchannel = "
       "2",
       "filament_sensor.x.channel: found 2; expected a channel in 1 .. 1, as node.4.filament_sensors says"},
      {"axis_pairs = 0\nheaters = 2", "where = \"simulated\"\n[material.x]\nbed_c = 130",
       "material.x.bed_c: found 130; expected at most max_c of [heater.bed], 120"},
      {"axis_pairs = 0\nheaters = 2", "where = \"simulated\"\n[material.x]\nchamber_c = 50",
       "material.x.chamber_c: found 50; expected 0, or a heater of this kind"},
      {"", "where = \"simulated\"\n[camera.x]\nstream = \"/dev/video0\"",
       "camera.x.stream: found '/dev/video0'; expected an address http://HOST/PATH, https://HOST/PATH or, on "
       "this "
       "computer, :PORT/PATH"},
      {"axis_pairs = 0\nfilament_sensors = 3",
       "where = \"simulated\"\n[filament_sensor.x]\nkind = \"switch\"\nwhere = \"node\"\nnode = 4\nchannel = "
       "1",
       "node.4.filament_sensors: found 3; expected at most 2 on a heat node"},
      {"axis_pairs = 0\nfilament_sensors = 1",
       "where = \"simulated\"\n[filament_sensor.x]\nkind = \"motion\"\nwhere = \"node\"\nnode = 4\nchannel = "
       "1\n"
       "stands_mm = 5",
       "filament_sensor.x.stands_mm: found 5; expected at least 5.76, 2 edges"},
      {"axis_pairs = 0\nfilament_sensors = 1",
       "where = \"simulated\"\n[filament_sensor.x]\nkind = \"wheel\"\nwhere = \"node\"\nnode = 4\nchannel = "
       "1",
       "filament_sensor.x.kind: found 'wheel'; expected one of \"switch\" \"motion\""},
      {"axis_pairs = 0\nfilament_sensors = 1",
       "where = \"simulated\"\n[filament_sensor.x]\nkind = \"switch\"\nwhere = \"node\"\nnode = 4\nchannel = "
       "1\n"
       "stands_mm = 7",
       "filament_sensor.x.stands_mm: found a key that does not exist"},
      {"", "where = \"simulated\"\n[probe]\nwhere = \"node\"\nnode = 3\nchannel = 1",
       "probe.channel: found 1; expected an input of node 3 that has the probe function"},
      {"", "where = \"simulated\"\n[input.x]\nwhere = \"node\"\nnode = 1\nchannel = 1",
       "input.x.channel: found 1; expected an input of node 1 whose function is none"},
      {"axis_pairs = 0\ninputs = 2",
       "where = \"simulated\"\n[input.x]\nwhere = \"node\"\nnode = 4\nchannel = 1",
       "input.x.node: found 4; expected a node that has axes"},
      {"", "where = \"simulated\"\n[input.x]\nwhere = \"node\"\nnode = 3\nchannel = 9",
       "input.x.channel: found 9; expected a channel in 1 .. 7"},
      {"",
       "where = \"simulated\"\n[input.x]\nwhere = \"node\"\nnode = 3\nchannel = 5\n[input.y]\nindex = "
       "1\nwhere = "
       "\"node\"\nnode = 3\nchannel = 5",
       "input.y.channel: found node 3 channel 5; expected a channel that no other device has: [input.x] has "
       "it"},
      {"", "where = \"simulated\"\n[input.x]\nwhere = \"simulated\"\n[input.y]\nwhere = \"simulated\"",
       "input.y.index: found 0; expected an index that no other has: [input.x] has it"},
      {"axis_pairs = 0\ninputs = 0", "where = \"simulated\"\n[bltouch]\nnode = 4",
       "bltouch: found a pin; expected a probe on an input of a node, [probe] with where = "
       "\"node\": its line"},
      {"inputs = 1\n[node.4.input1]\nfunction = \"probe\"",
       "where = \"simulated\"\n[probe]\nwhere = \"node\"\nnode = 4\nchannel = 1\n[bltouch]\nnode = 3",
       "node.3.axis_pairs: found 1; expected 0 of a node that carries heat"},
      {"inputs = 1\n[node.4.input1]\nfunction = \"probe\"",
       "where = \"simulated\"\n[probe]\nwhere = \"node\"\nnode = 4\nchannel = 1\n[bltouch]\nnode = 9",
       "bltouch.node: found 9; expected a heat node that has its table, [node.9], with axis_pairs = 0"},
      {"", "where = \"simulated\"\n[accelerometer]\nnode = 9",
       "accelerometer.node: found 9; expected a heat node that has its table, [node.9], with axis_pairs = 0"},
      {"", "where = \"simulated\"\n[accelerometer]\nnode = 3",
       "node.3.axis_pairs: found 1; expected 0 of a node that carries heat"},
      {"axis_pairs = 0\nheaters = 1", "where = \"simulated\"\n[accelerometer]\nnode = 4\naxes = \"xxy\"",
       "accelerometer.axes: found 'xxy'; expected one of"},
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

TEST(MachineFile, MainsHave50Or60Hz) {
  EXPECT_TRUE(parse_machine(edited("[thermal]", "[thermal]\nmains_hz = 60").text, "m"));
  const Edited e = edited("[thermal]", "[thermal]\nmains_hz = 55");
  const auto machine = parse_machine(e.text, "m");
  ASSERT_FALSE(machine);
  EXPECT_EQ(to_string(machine.error()),
            "m:" + std::to_string(e.line + 1) + ": thermal.mains_hz: found 55; expected 50 or 60\n");
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

}  // namespace
}  // namespace kinebus

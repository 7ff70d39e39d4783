#include "gateway/bus_nodes/node_configuration.hpp"

#include <gtest/gtest.h>

#include <map>

#include "gateway/status/alarm.hpp"
#include "protocol/canopen/node_objects.hpp"

namespace kinebus {
namespace {

std::optional<std::int64_t> written(const NodeConfiguration& configuration, ObjectAddress address) {
  for (const ParameterWrite& write : configuration.writes)
    if (write.address == address) return write.value;
  return std::nullopt;
}
ObjectAddress second(ObjectAddress base) {
  return {static_cast<std::uint16_t>(base.index + kAxisOffset), base.subindex};
}

TEST(NodeConfiguration, TowersHaveTheirHomeSwitchAndItsPositionInCounts) {
  const NodeConfiguration c = configure_node(default_m1(), 1);
  EXPECT_EQ(written(c, object::kHomingMethod), 22);
  EXPECT_EQ(written(c, object::kHomeOffset), -10 * 1280);
  EXPECT_EQ(written(c, object::kInterpolationSubMode), -1);
  EXPECT_EQ(written(c, object::kSyncCounterOverflow), 240);
  EXPECT_EQ(written(c, object::kSyncPeriod), 0);
  EXPECT_EQ(written(c, object::kHomingFastSpeed), 40 * 1280);
  EXPECT_EQ(written(c, object::kSwitchFunction), static_cast<int>(SwitchFunction::kHomeA));
  EXPECT_EQ(written(c, {object::kSwitchFunction.index, 2}), static_cast<int>(SwitchFunction::kHomeB));
  EXPECT_EQ(written(c, object::kConsumerHeartbeat), (127 << 16) + 1500);
}

TEST(NodeConfiguration, JointsWithoutSwitchTakeThePresentPosition) {
  const NodeConfiguration c = configure_node(default_m1(), 3);
  EXPECT_EQ(written(c, object::kHomingMethod), 37);
  EXPECT_EQ(written(c, second(object::kHomingMethod)), 37);
}

TEST(NodeConfiguration, FingerprintTellsEveryChange) {
  const MachineDescription m1 = default_m1();
  MachineDescription other = m1;
  other.joints[1].run_current_ma += 1;
  EXPECT_EQ(configure_node(m1, 1).fingerprint, configure_node(m1, 1).fingerprint);
  EXPECT_NE(configure_node(m1, 1).fingerprint, configure_node(other, 1).fingerprint);
  EXPECT_EQ(configure_node(m1, 2).fingerprint, configure_node(other, 2).fingerprint);
}

TEST(NodeConfiguration, AScaleIsToldAtEveryStartAndChangesNoFingerprint) {
  MachineDescription m1 = default_m1();
  EXPECT_TRUE(configure_node(m1, 1).settings.empty()) << "without scales nothing more is said on the bus";
  const auto fingerprint = configure_node(m1, 1).fingerprint;
  m1.joints[1].scale = ScaleDescription{.pulses_per_mm = 100, .inverted = true};
  const NodeConfiguration c = configure_node(m1, 1);
  EXPECT_EQ(c.fingerprint, fingerprint);
  EXPECT_FALSE(written(c, object::kScaleFitted));
  std::map<std::uint32_t, std::int64_t> told;
  for (const ParameterWrite& write : c.settings) told[write.address.key()] = write.value;
  EXPECT_EQ(told[second(object::kScaleFitted).key()], 1);
  EXPECT_EQ(told[second(object::kScaleInverted).key()], 1);
  EXPECT_EQ(told[second(object::kScaleCountsPerUnit).key()], 100'000);
  ASSERT_TRUE(told.contains(object::kScaleFitted.key()));
  EXPECT_EQ(told[object::kScaleFitted.key()], 0);
  EXPECT_TRUE(configure_node(m1, 2).settings.empty());
}

TEST(NodeConfiguration, AnAbsoluteScaleSaysItsCodeAndBits) {
  for (const bool gray : {false, true}) {
    MachineDescription m1 = default_m1();
    m1.joints[0].scale = ScaleDescription{.pulses_per_mm = 1000, .absolute_bits = 26, .gray_code = gray};
    const NodeConfiguration c = configure_node(m1, 1);
    const auto place = [&](ObjectAddress address) {
      return std::find_if(c.settings.begin(), c.settings.end(),
                          [&](const ParameterWrite& write) { return write.address == address; });
    };
    ASSERT_NE(place(object::kScaleFitted), c.settings.end());
    EXPECT_LT(place(object::kScaleCountsPerUnit), place(object::kScaleFitted));
    EXPECT_EQ(place(object::kScaleFitted)->value, gray ? 58 : 26);
  }
}

TEST(NodeConfiguration, AMotorsDataAndItsEncoderReachTheNode) {
  constexpr ObjectAddress kTpdo4{0x1803, 1}, kTpdo4Timer{0x1803, 5};
  MachineDescription m1 = default_m1();
  const NodeConfiguration plain = configure_node(m1, 1);
  EXPECT_EQ(written(plain, object::kPhaseResistance), 0);
  EXPECT_EQ(written(plain, object::kEncoderMode), 0);
  EXPECT_EQ(written(plain, kTpdo4), 0xC000'0481) << "not sent";
  m1.joints[1].motor = MotorDescription{.resistance_ohm = 1.2,
                                        .inductance_mh = 2.5,
                                        .torque_nm_per_a = 0.127,
                                        .encoder = MotorDescription::Encoder::kClosedLoop,
                                        .encoder_reversed = true,
                                        .encoder_offset_counts = 300};
  const NodeConfiguration c = configure_node(m1, 1);
  EXPECT_EQ(written(c, second(object::kPhaseResistance)), 1200);
  EXPECT_EQ(written(c, second(object::kPhaseInductance)), 2500);
  EXPECT_EQ(written(c, second(object::kFluxLinkage)), 2540) << "uVs: 0.127 / 50 pole pairs";
  EXPECT_EQ(written(c, second(object::kEncoderMode)), 6);
  EXPECT_EQ(written(c, second(object::kEncoderOffset)), 300);
  EXPECT_EQ(written(c, object::kEncoderMode), 0);
  EXPECT_EQ(written(c, kTpdo4), 0x4000'0481);
  EXPECT_EQ(written(c, kTpdo4Timer), 60);
  EXPECT_NE(c.fingerprint, plain.fingerprint);
}

TEST(NodeConfiguration, InvertedDriveHomesTheMirroredWay) {
  MachineDescription m1 = default_m1();
  m1.joints[0].drive.inverted = true;
  const NodeConfiguration c = configure_node(m1, 1);
  EXPECT_EQ(written(c, object::kHomingMethod), 20);
  EXPECT_EQ(written(c, object::kHomeOffset), 10 * 1280);
  EXPECT_LT(*written(c, object::kMinPositionLimit), *written(c, object::kMaxPositionLimit));
}

TEST(NodeConfiguration, ValuesBeyondAnObjectsRangeAreHeldAtItsBorder) {
  MachineDescription m1 = default_m1();
  m1.stop.ramp = std::chrono::milliseconds{100'000};
  EXPECT_EQ(written(configure_node(m1, 1), object::kStopRamp), 510);
}

TEST(Alarms, EmergenciesAreToldInWords) {
  const AlarmText current = describe_emergency({2, 0x2310, 3, {9, 0, 0, 0, 0}});
  EXPECT_EQ(current.words, "node 2: over-current in a motor phase; fault of a drive (EMCY 2310h)");
  EXPECT_FALSE(current.advice.empty());
  const AlarmText starved = describe_emergency({1, 0xFF01, 0x81, {1, 0, 0, 0, 0}});
  EXPECT_EQ(starved.words, "node 1: its queue ran low (EMCY FF01h)");
  const AlarmText open = describe_emergency({3, 0x3130, 5, {0x89, 0, 0, 0, 0}});
  EXPECT_EQ(open.words, "node 3: a motor phase carries no current; fault of a drive, axis B (EMCY 3130h)");
  EXPECT_EQ(open.advice, "check the motor's plug and cable for a break, then clear");
  const AlarmText unknown = describe_emergency({1, 0x5999, 1, {0x7F, 0, 0, 0, 0}});
  EXPECT_EQ(unknown.words, "node 1: hardware fault (EMCY 5999h)");
}

TEST(NodeConfiguration, AStepperDriverIsToldWhatTheFileSaysOfItsModule) {
  MachineDescription m1 = default_m1();
  const NodeConfiguration usual = configure_node(m1, 1);
  EXPECT_EQ(written(usual, object::kDriverKind), 1);
  EXPECT_EQ(written(usual, object::kSenseResistor), 0);
  EXPECT_EQ(written(usual, object::kSpreadCycleAbove), 0);
  m1.joints[0].driver = DriverDescription{.sense_resistor_mohm = 150, .stealthchop_below_per_s = 25};
  m1.joints[1].driver = DriverDescription{.stands_alone = true};
  const NodeConfiguration c = configure_node(m1, 1);
  EXPECT_EQ(written(c, object::kDriverKind), 1);
  EXPECT_EQ(written(c, object::kSenseResistor), 150);
  EXPECT_EQ(written(c, object::kSpreadCycleAbove), 25 * 1280);
  EXPECT_EQ(written(c, second(object::kDriverKind)), 0);
  EXPECT_NE(c.fingerprint, usual.fingerprint) << "kept by the node as all of its parameters";
}

TEST(NodeConfiguration, AJointThatHomesByLoadTellsItsDriverWhenAndIsAskedWhetherItCan) {
  MachineDescription m1 = default_m1();
  EXPECT_TRUE(configure_node(m1, 1).load_sensors.empty());
  HomingDescription& h = *m1.joints[1].homing;
  h.method = HomingDescription::kNegativeStop;
  h.back_off = 5;
  h.stall_threshold = 70;
  h.stall_above_per_s = 30;
  NodeConfiguration c = configure_node(m1, 1);
  EXPECT_EQ(written(c, second(object::kHomingMethod)), -4);
  EXPECT_EQ(written(c, second(object::kStallThreshold)), 70);
  EXPECT_EQ(written(c, second(object::kStallAbove)), 30 * 1280);
  EXPECT_EQ(written(c, second(object::kHomingBackOff)), 5 * 1280) << "no more than it is free to go";
  EXPECT_EQ(written(c, object::kStallThreshold), 0);
  EXPECT_EQ(c.load_sensors, std::vector{second(object::kDriverState)});
  EXPECT_NE(c.fingerprint, configure_node(default_m1(), 1).fingerprint);
  m1.joints[1].drive.inverted = true;
  EXPECT_EQ(written(configure_node(m1, 1), second(object::kHomingMethod)), -3);
  for (const int can : {1, 2, 3}) EXPECT_FALSE(load_sensor_missing(m1, 1, c.load_sensors[0], can));
  const auto none = load_sensor_missing(m1, 1, c.load_sensors[0], 0);
  ASSERT_TRUE(none);
  EXPECT_NE(none->english().find("node 1 has no driver there"), std::string::npos) << none->english();
  EXPECT_NE(load_sensor_missing(m1, 1, c.load_sensors[0], 4)->english().find("does not answer"),
            std::string::npos);
}

}  // namespace
}  // namespace kinebus

// The heat node from outside: frames in, frames and heat out.
#include <gtest/gtest.h>

#include <cmath>

#include "node_firmware/heat/tests/heat_node_bench.hpp"

namespace kinebus::heat {
namespace {

constexpr std::uint32_t kTooHigh = 0x0609'0031, kTooLow = 0x0609'0032, kInvalid = 0x0609'0030,
                        kState = 0x0800'0022;

TEST(HeatNode, IsTheDeviceOfItsTable) {
  HeatNodeBench bench;
  ASSERT_FALSE(bench.seen.empty());
  EXPECT_EQ(bench.seen[0].id, 0x700u + HeatNodeBench::kId);
  EXPECT_EQ(bench.seen[0].data[0], 0) << "boot-up";
  EXPECT_EQ(bench.read({0x1000, 0}), 0x194u);
  EXPECT_EQ(bench.read({0x1018, 2}), 0x404u);
  EXPECT_EQ(bench.read({0x1018, 4}), 4711u);
  EXPECT_EQ(bench.read({0x6040, 0}), std::nullopt) << "no axis";
  // Whatever the table says can be read is answered, with its length.
  for (const ObjectEntry& entry : kHeatObjects) {
    if (!entry.readable() || entry.type == DataType::kString || entry.address.index == 0x1003) continue;
    EXPECT_TRUE(bench.read(entry.address).has_value()) << std::hex << entry.address.index;
  }
  const auto heartbeats = [&] {
    return std::count_if(bench.seen.begin(), bench.seen.end(), [](const CanFrame& frame) {
      return frame.id == 0x700u + HeatNodeBench::kId && frame.data[0] == 127;
    });
  };
  const auto before = heartbeats();
  bench.run(5);
  EXPECT_EQ(heartbeats() - before, 10);
}

/// Tells it again as a gateway does: the same flow from now on, W.
void tell_flow(HeatNodeBench& bench, double watts, double seconds) {
  CanFrame flow{.id = 0x500u + HeatNodeBench::kId, .length = 8};
  for (std::size_t i = 0; i < 4; ++i)
    put_u16_le(std::span(flow.data).subspan(2 * i), static_cast<std::uint16_t>(100 * watts));
  for (double t = 0; t < seconds; t += 0.1) {
    bench.send(flow);
    bench.run(0.1);
  }
}

TEST(HeatNode, FlowThatIsToldIsHeatedAheadForAndForgottenWithoutNews) {
  HeatNodeBench bench;
  bench.set_up();
  ASSERT_EQ(bench.write_set_point(1, 2100), 0u);
  bench.run(200);
  const double before = bench.node.heater_output(0);
  tell_flow(bench, 10, 0.3);
  EXPECT_EQ(bench.read({0x2227, 1}), 1000u);
  // Of 40 W nominal.
  EXPECT_NEAR((bench.node.heater_output(0) - before) / kFullPower, 0.25, 0.03);
  // The plant takes what was told: nothing is noticed of it.
  ASSERT_EQ(bench.plant.command("flow 23"), "");
  tell_flow(bench, 10, 30);
  EXPECT_NEAR(bench.plant.hot_end().block(), 210, 1);
  ASSERT_EQ(bench.plant.command("flow 0"), "");
  bench.run(1.7);
  EXPECT_NEAR((bench.node.heater_output(0) - before) / kFullPower, 0, 0.05) << "over after its steps";
  EXPECT_EQ(bench.write({0x2229, 0}, 200, 2), kState) << "no job changes it";
  EXPECT_EQ(bench.write({0x2228, 0}, 5, 1), kTooHigh);
}

TEST(HeatNode, FlowThatIsToldAndDoesNotComeIsNoFaultAndAStuckSwitchIsOneAllTheSame) {
  HeatNodeBench bench;
  bench.set_up();
  ASSERT_EQ(bench.write_set_point(1, 2100), 0u);
  bench.run(200);
  tell_flow(bench, 18, 60);
  EXPECT_EQ(bench.node.fault(0), HeaterFault::kNone) << "no filament";
  EXPECT_LT(bench.plant.hot_end().hottest(), 225);
  tell_flow(bench, 0, 60);
  ASSERT_EQ(bench.plant.command("flow 20"), "");
  tell_flow(bench, 9, 60);
  ASSERT_EQ(bench.plant.command("heater 1 stuck"), "");
  bench.plant.hot_end().forget_hottest();
  tell_flow(bench, 9, 20);
  EXPECT_EQ(bench.node.fault(0), HeaterFault::kHeatUnasked);
  EXPECT_FALSE(bench.node.contactor());
  EXPECT_LT(bench.plant.hot_end().hottest(), 285);
}

TEST(HeatNode, HeatsHoldsAndTellsIt) {
  HeatNodeBench bench;
  bench.set_up();
  ASSERT_EQ(bench.write_set_point(1, 2100), 0u);
  EXPECT_EQ(bench.read({0x2221, 1}), 1u) << "heating";
  ASSERT_TRUE(bench.run_until(150, [&] { return bench.read({0x2221, 1}) == 2u; }));
  bench.run(60);
  EXPECT_NEAR(bench.plant.hot_end().block(), 210, 1);
  bench.forget();
  bench.run(1);
  int told = 0;
  for (const CanFrame& frame : bench.seen) {
    if (frame.id != 0x280u + HeatNodeBench::kId) continue;
    ++told;
    EXPECT_NEAR(get_u16_le(frame.data), 2100, 10) << "TPDO2: temperatures";
  }
  EXPECT_EQ(told, 4);
  // A set point by PDO: all four heaters.
  CanFrame set_points{.id = 0x200u + HeatNodeBench::kId, .length = 8};
  put_u16_le(set_points.data, 0);
  put_u16_le(std::span(set_points.data).subspan(2), 600);
  bench.send(set_points);
  EXPECT_EQ(bench.read({0x7402, 1}), 0u);
  EXPECT_EQ(bench.read({0x7402, 2}), 600u);
  bench.run(0.2);
  EXPECT_EQ(bench.node.heater_output(0), 0u);
  EXPECT_NE(bench.node.heater_output(1), 0u);
  EXPECT_EQ(bench.write({0x6422, 2}, 0, 1), 0u);
  bench.run(0.2);
  EXPECT_EQ(bench.node.heater_output(1), 0u) << "switched off, its set point kept";
}

TEST(HeatNode, HeatsNothingBeforeTheMasterHasNamedItBySerialNumber) {
  HeatNodeBench bench;
  bench.set_up();
  EXPECT_EQ(bench.read({0x2243, 0}), HeatNodeBench::kSerial);
  ASSERT_EQ(bench.write_set_point(1, 600), 0u);
  bench.run(2);
  EXPECT_GT(bench.node.heater_output(0), 0u);
  // Another one is meant: what heats goes off.
  EXPECT_EQ(bench.write({0x2243, 0}, HeatNodeBench::kSerial + 1, 4), kInvalid);
  EXPECT_EQ(bench.node.heater_output(0), 0u);
  EXPECT_EQ(bench.read({0x2243, 0}), 0u);
  EXPECT_EQ(bench.write_set_point(1, 600), kState);
  EXPECT_EQ(bench.write({0x2224, 1}, 2000, 2), kState) << "nor is it measured";
  EXPECT_EQ(bench.write_set_point(1, 0), 0u) << "off is always taken";
  bench.send({.id = 0x200u + HeatNodeBench::kId, .length = 8, .data = {0x58, 2}});
  bench.run(1);
  EXPECT_EQ(bench.node.heater_output(0), 0u) << "nor by PDO";
  bench.confirm();
  EXPECT_EQ(bench.write_set_point(1, 600), 0u);
  bench.nmt(NmtCommand::kResetCommunication);
  EXPECT_EQ(bench.read({0x2243, 0}), HeatNodeBench::kSerial)
      << "communication begins anew, the node is the same";
  bench.nmt(NmtCommand::kResetNode);
  EXPECT_EQ(bench.read({0x2243, 0}), 0u);
  bench.confirm();
}

TEST(HeatNode, LimitsAreItsOwn) {
  HeatNodeBench bench;
  EXPECT_EQ(bench.write_set_point(1, 500), kState) << "a heater without a sensor";
  bench.set_up();
  EXPECT_EQ(bench.write_set_point(1, 2651), kTooHigh);
  EXPECT_EQ(bench.write_set_point(2, 1201), kTooHigh) << "10 K below the limit of 130 C";
  EXPECT_EQ(bench.write_set_point(1, 0x8000), kTooLow);
  EXPECT_EQ(bench.write({0x2224, 1}, 2651, 2), kTooHigh) << "tuning, too";
  EXPECT_EQ(bench.write({0x2224, 1}, 300, 2), kTooLow) << "no way to measure anything on";
  EXPECT_EQ(bench.write({0x2211, 1}, 3000, 2), kState) << "not in operational: a job cannot";
  EXPECT_EQ(bench.write({0x2242, 0}, 60'000, 2), kState);
  CanFrame set_points{.id = 0x200u + HeatNodeBench::kId, .length = 8};
  put_u16_le(set_points.data, 3000);
  bench.send(set_points);
  EXPECT_EQ(bench.read({0x7402, 1}), 0u) << "nor by PDO";
  ASSERT_EQ(bench.write_set_point(1, 2000), 0u);
  bench.nmt(NmtCommand::kEnterPreOperational);
  EXPECT_EQ(bench.write({0x2211, 1}, 3000, 2), kState) << "nor while it heats";
  ASSERT_EQ(bench.write_set_point(1, 0), 0u);
  EXPECT_EQ(bench.write({0x2211, 1}, 5501, 2), kTooHigh);
  EXPECT_EQ(bench.write({0x2211, 1}, 3501, 2), kTooHigh) << "above the sensor's plausible range";
  EXPECT_EQ(bench.write({0x220B, 1}, 2799, 2), kInvalid) << "the range below the limit";
  EXPECT_EQ(bench.write({0x2210, 2}, 1, 1), kInvalid) << "two heaters on one sensor";
  EXPECT_EQ(bench.write({0x6110, 1}, 7, 2), kInvalid) << "no such sensor";
  EXPECT_EQ(bench.write({0x2201, 1}, 10'000, 4), kInvalid) << "100 kOhm on 10 Ohm";
  EXPECT_EQ(bench.write({0x2211, 1}, 3400, 2), 0u);
  EXPECT_EQ(bench.write({0x2212, 1}, 3000, 2), 0u);
  EXPECT_EQ(bench.write_set_point(1, 3000), 0u);
}

TEST(HeatNode, AnOpenedSensorIsAnAlarmAndTakesThePower) {
  HeatNodeBench bench;
  bench.set_up();
  ASSERT_EQ(bench.write_set_point(1, 2100), 0u);
  bench.run(30);
  ASSERT_NE(bench.node.heater_output(0), 0u);
  bench.forget();
  ASSERT_EQ(bench.plant.command("sensor 1 open"), "");
  bench.run(0.02);
  EXPECT_EQ(bench.node.heater_output(0), 0u) << "at once";
  bench.run(0.3);
  const auto told = bench.emergencies(0x5001);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].data[2], 0x01) << "error register: generic";
  EXPECT_EQ(told[0].data[3], 0) << "asks for no stop";
  EXPECT_EQ(told[0].data[4], 1) << "heater 1";
  EXPECT_EQ(told[0].data[5], 1) << "sensor 1";
  EXPECT_EQ(bench.read({0x1003, 1}), 0x0100'5001u) << "history: code, then bytes 3 and 4";
  EXPECT_EQ(bench.read({0x2221, 1}), 4u);
  EXPECT_EQ(bench.read({0x7402, 1}), 0u);
  EXPECT_EQ(bench.read({0x6150, 1}), 5u) << "not valid, below what can be measured";
  EXPECT_EQ(bench.write_set_point(1, 2100), kState);
  ASSERT_EQ(bench.plant.command("sensor 1 ok"), "");
  bench.run(5);
  EXPECT_EQ(bench.node.heater_output(0), 0u) << "a fault stays";
  EXPECT_EQ(bench.write({0x2226, 1}, 1, 1), 0u);
  bench.run(0.3);
  EXPECT_EQ(bench.emergencies(0x0000).size(), 1u);
  EXPECT_EQ(bench.read({0x1001, 0}), 0u);
  EXPECT_EQ(bench.write_set_point(1, 2100), 0u);
}

TEST(HeatNode, EveryFaultHasItsCode) {
  struct Case {
    const char* breaks;
    double seconds;
    std::uint16_t code;
    std::array<std::uint8_t, 3> places;
  };
  for (const Case& each :
       {Case{"sensor 1 short", 1, 0x5002, {1, 1, 0}}, Case{"sensor 1 loose", 15, 0x5005, {1, 0, 0}},
        Case{"sensor 1 silent", 1, 0x5004, {1, 1, 0}}, Case{"sensor 3 open", 1, 0x5001, {0, 4, 0}},
        Case{"heater 1 loose", 20, 0x5005, {1, 0, 0}}, Case{"heater 1 open", 20, 0x5005, {1, 0, 0}},
        Case{"heater 2 stuck", 60, 0x5006, {2, 0, 0}}, Case{"heater 1 stuck", 15, 0x5006, {1, 0, 0}}}) {
    HeatNodeBench bench;
    bench.set_up();
    ASSERT_EQ(bench.write_set_point(1, 2100), 0u);
    ASSERT_EQ(bench.write_set_point(2, 600), 0u);
    bench.run(150);
    ASSERT_EQ(bench.read({0x1001, 0}), 0u) << each.breaks;
    ASSERT_EQ(bench.plant.command(each.breaks), "");
    bench.run(each.seconds);
    const auto told = bench.emergencies(each.code);
    ASSERT_EQ(told.size(), 1u) << each.breaks;
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(told[0].data[4 + i], each.places[i]) << each.breaks;
    EXPECT_EQ(bench.node.contactor(), each.code != 0x5006) << each.breaks;
    EXPECT_LE(bench.plant.hot_end().hottest(), 232) << each.breaks;
  }
}

TEST(HeatNode, ASwitchThatDoesNotOpenKeepsTheContactorOpen) {
  HeatNodeBench bench;
  bench.set_up();
  ASSERT_EQ(bench.write_set_point(1, 2100), 0u);
  bench.run(100);
  ASSERT_EQ(bench.plant.command("heater 1 stuck"), "");
  bench.run(15);
  EXPECT_EQ(bench.read({0x2240, 0}), 0u);
  bench.nmt(NmtCommand::kResetNode);
  bench.run(1);
  EXPECT_FALSE(bench.node.contactor()) << "a reset is routine";
  bench.set_up();
  EXPECT_EQ(bench.write({0x2226, 1}, 1, 1), kState) << "hot";
  ASSERT_TRUE(bench.run_until(1500, [&] { return bench.plant.hot_end().block() < 45; }));
  EXPECT_EQ(bench.write_set_point(2, 600), kState) << "no heater at all";
  EXPECT_EQ(bench.write({0x2226, 1}, 1, 1), 0u);
  EXPECT_TRUE(bench.node.contactor());
  bench.run(20);
  EXPECT_FALSE(bench.node.contactor()) << "it still does not open";
  EXPECT_LE(bench.plant.hot_end().hottest(), 232);
}

TEST(HeatNode, AHotEndWithoutItsFanIsSwitchedOff) {
  HeatNodeBench bench;
  ASSERT_EQ(bench.write({0x2230, 1}, 1, 1), 0u);
  ASSERT_EQ(bench.write({0x2234, 1}, 2, 1), 0u);
  bench.set_up();
  ASSERT_EQ(bench.write_set_point(1, 2100), 0u);
  bench.run(60);
  EXPECT_EQ(bench.node.fan_output(0), kFullFan);
  EXPECT_NEAR(bench.read({0x2235, 1}).value_or(0), 5400, 200);
  ASSERT_EQ(bench.plant.command("fan 1 stalled"), "");
  bench.run(6);
  const auto told = bench.emergencies(0x5007);
  ASSERT_FALSE(told.empty());
  EXPECT_EQ(told[0].data[6], 1) << "fan 1";
  EXPECT_EQ(bench.read({0x2222, 1}), static_cast<std::uint32_t>(HeaterFault::kFan));
  EXPECT_EQ(bench.node.heater_output(0), 0u);
  ASSERT_EQ(bench.plant.command("fan 1 ok"), "");
  bench.run(2);
  EXPECT_EQ(bench.write({0x2226, 1}, 1, 1), 0u);
  EXPECT_EQ(bench.write_set_point(1, 2100), 0u);
}

TEST(HeatNode, WithoutAMasterSetPointsFallToTheSafeOnes) {
  HeatNodeBench bench;
  ASSERT_EQ(bench.write({0x221F, 2}, 800, 2), 0u);
  ASSERT_EQ(bench.write({0x2220, 2}, 60, 2), 0u);
  bench.set_up();
  ASSERT_EQ(bench.write_set_point(1, 2100), 0u);
  ASSERT_EQ(bench.write_set_point(2, 1000), 0u);
  bench.forget();
  bench.run(4.8, false);
  EXPECT_NE(bench.node.heater_output(0), 0u);
  EXPECT_TRUE(bench.emergencies(0x8130).empty());
  bench.run(0.4, false);
  EXPECT_EQ(bench.node.heater_output(0), 0u) << "5 s";
  EXPECT_NE(bench.node.heater_output(1), 0u) << "the bed keeps its safe set point";
  EXPECT_EQ(bench.emergencies(0x8130).size(), 1u);
  bench.run(59, false);
  EXPECT_NE(bench.node.heater_output(1), 0u);
  bench.run(1.5, false);
  EXPECT_EQ(bench.node.heater_output(1), 0u) << "and that for its time only";
  EXPECT_EQ(bench.read({0x7402, 1}), 0u) << "nothing comes back by itself";
  bench.run(1);
  EXPECT_EQ(bench.node.heater_output(0), 0u);
  EXPECT_EQ(bench.emergencies(0x0000).size(), 1u);
  EXPECT_EQ(bench.write_set_point(1, 2100), 0u);
}

TEST(HeatNode, AMasterWithAHeartbeatLivesByItAlone) {
  HeatNodeBench bench;
  ASSERT_EQ(bench.write({0x1016, 1}, 0x0001'05DC, 4), 0u) << "node 1, 1500 ms";
  bench.set_up();
  const CanFrame beat = heartbeat_frame(NmtState::kOperational, 1);
  bench.send(beat);
  ASSERT_EQ(bench.write_set_point(1, 2100), 0u);
  for (int i = 0; i < 10; ++i) {
    bench.run(1);
    bench.send(beat);
  }
  EXPECT_NE(bench.node.heater_output(0), 0u);
  bench.run(2);  // somebody goes on reading
  EXPECT_EQ(bench.emergencies(0x8130).size(), 1u) << "after the time of 1016h";
  EXPECT_NE(bench.node.heater_output(0), 0u);
  bench.run(3.2);
  EXPECT_EQ(bench.node.heater_output(0), 0u) << "after that of 2242h";
  EXPECT_EQ(bench.write_set_point(1, 2100), kState);
  bench.send(beat);
  EXPECT_EQ(bench.write_set_point(1, 2100), 0u);
  // Settings that have nothing to do with it forget neither the master nor a temperature.
  EXPECT_EQ(bench.write({0x1017, 0}, 250, 2), 0u);
  bench.run(0.2);
  EXPECT_NE(bench.node.heater_output(0), 0u);
}

TEST(HeatNode, IsMeasuredByOneWriteAndKeepsWhatIsFound) {
  HeatNodeBench bench;
  bench.set_up(false);
  const auto fingerprint = bench.read({0x2116, 0});
  ASSERT_EQ(bench.write({0x2224, 1}, 2100, 2), 0u);
  EXPECT_EQ(bench.read({0x2221, 1}), 3u);
  EXPECT_EQ(bench.write_set_point(1, 2000), kState) << "not meanwhile";
  EXPECT_EQ(bench.write({0x2224, 2}, 1000, 2), kState) << "one at a time";
  EXPECT_EQ(bench.write({0x1010, 1}, 0x6576'6173, 4), kState);
  ASSERT_TRUE(bench.run_until(400, [&] { return bench.read({0x2225, 1}) == 4u; }));
  const auto rate = bench.read({0x2218, 1}), dead = bench.read({0x221B, 1});
  // 44 W on 14.6 J/K; 1.6 s of transport and what the cartridge adds.
  EXPECT_NEAR(rate.value_or(0), 3000, 300);
  EXPECT_NEAR(dead.value_or(0), 2000, 700);
  EXPECT_NE(bench.read({0x2116, 0}), fingerprint);
  ASSERT_EQ(bench.write({0x1010, 1}, 0x6576'6173, 4), 0u);
  ASSERT_FALSE(bench.stored.empty());
  HeatNodeBench again(bench.stored);
  EXPECT_EQ(again.read({0x2218, 1}), rate);
  EXPECT_EQ(again.read({0x6110, 1}), 10'100u);
  again.run(0.5);
  EXPECT_NEAR(static_cast<double>(again.read({0x7130, 1}).value_or(0)), 220, 10);
  ASSERT_EQ(again.write({0x1011, 1}, 0x6461'6F6C, 4), 0u);
  HeatNodeBench bare(again.stored);
  EXPECT_EQ(bare.read({0x2218, 1}), 0u);
  bench.stored[20] ^= 1;
  HeatNodeBench damaged(bench.stored);
  EXPECT_EQ(damaged.emergencies(0x5530).size(), 1u);
  EXPECT_EQ(damaged.read({0x2218, 1}), 0u);
}

}  // namespace
}  // namespace kinebus::heat

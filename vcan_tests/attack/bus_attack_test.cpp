// What a device on the bus can do to a machine in the midst of a job, with and without a session: a table of
// what happened, who was named, how far the carriages were from the path, and how the operator goes on.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "gateway/machine/tests/heat_printer.hpp"
#include "protocol/canopen/emcy.hpp"
#include "vcan_tests/attack/attacked_machine.hpp"

namespace kinebus {
namespace {

CanFrame forged_rate(const Attacked& rig, RateCommand::Kind kind, std::uint16_t q15) {
  return encode(RateCommand{.kind = kind,
                            .counter = 11,
                            .rate_q15 = q15,
                            .full_ramp_2ms = 5,
                            .start = BusTime{(rig.now + 5ms).count() / 1000 * 1000}});
}
CanFrame forged_stop_request(const Attacked& rig, std::uint8_t node) {
  CanFrame forged = encode(Emergency{.node = node, .code = 0x1000, .error_register = 1});
  const auto stop = encode(StopRequest{StopReason::kCommand, 0, rig.now});
  std::copy(stop.begin(), stop.end(), forged.data.begin() + 3);
  return forged;
}

/// Identifiers, lengths and bytes by chance: what a program that has gone wrong may send.
void random_frames(Attacked& rig) {
  std::mt19937 random(19);
  for (int i = 0; i < 3000; ++i) {
    CanFrame frame{.id = static_cast<std::uint32_t>(random() & 0x7FF),
                   .length = static_cast<std::uint8_t>(random() % 9)};
    for (std::size_t k = 0; k < frame.length; ++k) frame.data[k] = static_cast<std::uint8_t>(random());
    rig.stranger_sends(frame);
    if (i % 2 == 1) rig.watch(1ms);
  }
}

const std::vector<Attack>& attacks() {
  static const std::vector<Attack> all{
      {"record out of its order", [](Attacked& rig) { rig.sends("402#4001000000000000"); }},
      {"the record that node 2 waits for, before the gateway's",
       [](Attacked& rig) { rig.stranger_sends(rig.next_record()); }, kForgedRecord_um},
      {"SYNC", [](Attacked& rig) { rig.sends("080#C8"); }},
      {"SYNC's stamp, 300 us off",
       [](Attacked& rig) {
         rig.stranger_sends(encode(SyncStamp{.counter = 7, .epoch = 1, .time = rig.now + 300us}));
       }},
      {"rate 3 %",
       [](Attacked& rig) { rig.stranger_sends(forged_rate(rig, RateCommand::Kind::kRate, 1000)); }},
      {"rate, a recorded one with its voucher",
       [](Attacked& rig) {
         if (rig.voucher) rig.stranger_sends(*rig.voucher);
         rig.stranger_sends(rig.rate);
       }},
      {"stop on the rate's COB-ID",
       [](Attacked& rig) { rig.stranger_sends(forged_rate(rig, RateCommand::Kind::kStop, 0)); }},
      {"RPDO1: drive of axis 1 off", [](Attacked& rig) { rig.sends("202#00000F000707"); }, kDriveOff_um,
       true},
      {"SDO: direction, current and switches of node 2, NMT",
       [](Attacked& rig) {
         for (const char* order :
              {"602#2F40210401000000", "602#2B40210200000000", "602#2F30210107000000", "000#8002"}) {
           rig.sends(order);
           rig.run_for(5ms);
         }
       },
       kOnThePath_um, true},
      {"NMT stop of all", [](Attacked& rig) { rig.sends("000#0200"); }, kOnThePath_um, true},
      {"NMT reset of node 3", [](Attacked& rig) { rig.sends("000#8103"); }, kOnThePath_um, true},
      {"EMCY: stop, of node 2", [](Attacked& rig) { rig.stranger_sends(forged_stop_request(rig, 2)); }},
      {"EMCY: stop, of a node that is not there",
       [](Attacked& rig) { rig.stranger_sends(forged_stop_request(rig, 44)); }},
      {"TPDO1 of node 2: switched off", [](Attacked& rig) { rig.sends("182#50025002070700"); }},
      {"TPDO2 of node 2: another record", [](Attacked& rig) { rig.sends("282#2278410100000000"); }},
      {"RTR on 77Fh, 1FFh, 080h",
       [](Attacked& rig) {
         for (const char* poll : {"77F#R", "1FF#R8", "080#R"}) rig.sends(poll);
       },
       kOnThePath_um, true},
      {"flood of 2000 frames 001h",
       [](Attacked& rig) {
         for (int i = 0; i < 2000; ++i) rig.sends("001#FFFFFFFFFFFFFFFF");
       }},
      {"flood of 2000 frames 7FFh, one each ms",
       [](Attacked& rig) {
         for (int i = 0; i < 2000; ++i) {
           rig.sends("7FF#5555555555555555");
           rig.run_for(1ms);
         }
       },
       kOnThePath_um, true},
      {"3000 random frames, two each ms", &random_frames, kDriveOff_um},
      {"SDO: stop ramp 2 ms", [](Attacked& rig) { rig.sends("602#2B13210002000000"); }, kOnThePath_um, true},
      {"SDO: direction of axis 1", [](Attacked& rig) { rig.sends("602#2F40210401000000"); }, kOnThePath_um,
       true},
      {"SDO: drive of axis 1 off", [](Attacked& rig) { rig.sends("602#2B40600000000000"); }, kDriveOff_um,
       true},
      {"SDO: mode of axis 1", [](Attacked& rig) { rig.sends("602#2F60600001000000"); }, kOnThePath_um, true},
      {"SDO: program stop (1F51h)", [](Attacked& rig) { rig.sends("602#2F511F0100000000"); }, kOnThePath_um,
       true},
      {"SDO: another key (2117h)", [](Attacked& rig) { rig.sends("602#2F17210500000000"); }, kOnThePath_um,
       true},
  };
  return all;
}

class BusAttack : public testing::TestWithParam<BusTrust> {};

TEST_P(BusAttack, NothingMovesApartSomebodyIsNamedAndTheJobIsFinished) {
  expect_together(attacks(), GetParam());
}

// Another device and the heat node of a printer whose hot end is at 200 C and whose bed warms up.
struct HeatAttack {
  const char* name;
  const char* frame;
};
constexpr HeatAttack kHeatAttacks[] = {
    {"RPDO1: set point 290 C", "214#540B580200000000"},
    {"SDO: set point 290 C (7402h)", "614#2B027401540B0000"},
    {"SDO: limit 300 C (2211h)", "614#2B112201B80B0000"},
    {"SDO: heater's switch off (6422h)", "614#2F22640100000000"},
    {"SDO: another serial number (2243h)", "614#2343220001000000"},
    {"SDO: RPDO1 off (1400h)", "614#2300140114020080"},
    {"SDO: another key (2117h)", "614#2F17210500000000"},
    {"NMT stop of the heat node", "000#0214"},
    {"NMT reset of the heat node", "000#8114"},
};

MachineDescription printer_in_a_session() {
  MachineDescription machine = printer_on_the_bus();
  machine.bus.trust = BusTrust::kSession;
  return machine;
}

TEST(BusAttackOnHeat, WithASessionTheHeatNodeKeepsItsTargetAndTheJobGoesOn) {
  std::printf("\n| attack on heat, trust = \"session\" | hot end | named | then |\n|---|---|---|---|\n");
  for (const HeatAttack& attack : kHeatAttacks) {
    SCOPED_TRACE(attack.name);
    StrangerOf<VirtualMachine> rig(printer_in_a_session());
    ASSERT_TRUE(rig.make_ready()) << rig.story();
    ASSERT_TRUE(rig.gateway->carry_out(
        command::Run{std::make_unique<StringSource>("M109 S200\nG4 P9000\nG1 X20 F1200\nG1 X0\n"), "heat"}));
    const auto hot = [&] { return rig.gateway->status().heater(kFirstHotend).actual_celsius > 195; };
    ASSERT_TRUE(rig.run_until(hot, 300s)) << rig.story();
    rig.run_for(5s);
    rig.events.clear();
    rig.stranger_sends(text_frame(attack.frame));
    rig.run_for(2500ms);
    const double celsius = rig.gateway->status().heater(kFirstHotend).actual_celsius;
    std::printf("| %s | %.0f C | %s |", attack.name, celsius, rig.story().c_str());
    EXPECT_TRUE(rig.says("check value was refused")) << rig.story();
    EXPECT_NEAR(celsius, 200, 6);
    EXPECT_EQ(rig.nodes.heat_node(kHeat).fault(0), heat::HeaterFault::kNone);
    const bool ends = rig.reach(MachineState::kReady, 120s);
    std::printf(" %s |\n", ends ? "nothing to do" : "does not end");
    EXPECT_TRUE(ends) << rig.story();
  }
}

// The gateway's own bring-up while the hot end stays hot: it gives the node another key.
TEST(BusAttackOnHeat, ABringUpWithAHotBlockGivesTheNodeAnotherKey) {
  StrangerOf<VirtualMachine> rig(printer_in_a_session());
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstBed, 60}));
  rig.run_for(20s);
  const auto& node = rig.nodes.heat_node(kHeat);
  ASSERT_TRUE(node.heats());
  for (int i = 0; i < 3; ++i) {
    rig.stranger_sends(text_frame("000#8102"));  // at rest everybody may
    ASSERT_TRUE(rig.reach(MachineState::kAlarm, 5s)) << rig.story();
    ASSERT_TRUE(rig.gateway->carry_out(command::Clear{})) << rig.story();
    ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstBed, 60})) << rig.story();
    rig.run_for(1s);
    ASSERT_TRUE(node.heats()) << rig.story();
    ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{})) << rig.story();
    ASSERT_TRUE(rig.run_until([&] { return rig.gateway->state() == MachineState::kUnhomed; }, 30s))
        << rig.story();
    ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstBed, 60.0 + i})) << rig.story();
    rig.run_for(5s);
    EXPECT_TRUE(node.heats());
    // The key is the gateway's, and nobody else's.
    rig.stranger_sends(text_frame("614#2F17210500000000"));
    rig.run_for(1s);
    EXPECT_FALSE(rig.says("08000022h")) << rig.story();
    EXPECT_TRUE(rig.says("2117h that does not carry")) << rig.story();
    rig.events.clear();
  }
}

// A gateway that did not run, or a bus that was full: the node is closed again by the next voucher, without
// another bring-up.
TEST(BusAttackOnHeat, ASilenceOfSyncOpensTheNodeForNoLongerThanItLastsAndWhatWasObeyedIsTold) {
  StrangerOf<VirtualMachine> rig(printer_in_a_session());
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstBed, 60}));
  rig.run_for(20s);
  const auto& node = rig.nodes.heat_node(kHeat);
  ASSERT_TRUE(node.heats());
  const auto is_refused = [&](const char* write, const char* object) {
    rig.events.clear();
    rig.stranger_sends(text_frame(write));
    rig.run_for(200ms);
    return rig.says(object + std::string(" that does not carry"));
  };
  rig.stall(600ms);
  rig.run_for(200ms);
  EXPECT_TRUE(is_refused("614#2F17210500000000", "2117h")) << rig.story();
  EXPECT_FALSE(rig.says("while SYNC was silent")) << rig.story();

  rig.lose_from_gateway = [](const CanFrame& frame) {
    return frame.id == cob_id::kSync || frame.id == kSyncStampCobId;
  };
  rig.run_for(600ms);
  rig.stranger_sends(text_frame("614#2B02740258020000"));  // the bed, 60 C
  rig.run_for(50ms);
  rig.lose_from_gateway = {};
  rig.events.clear();
  rig.run_for(300ms);
  EXPECT_TRUE(
      rig.says("while SYNC was silent its session was open, and a frame that nobody vouched for was "
               "obeyed (COB-ID 614h)"))
      << rig.story();
  // An order is told once while it heats: another one.
  EXPECT_TRUE(is_refused("614#2343220001000000", "2243h")) << rig.story();
  EXPECT_TRUE(node.heats());
}

INSTANTIATE_TEST_SUITE_P(Trust, BusAttack, testing::Values(BusTrust::kOpen, BusTrust::kSession));

}  // namespace
}  // namespace kinebus

// Orders to one node alone, and services of CANopen that are meant for a machine at rest, in the midst of a
// job: what happened, who was named, how the operator goes on.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include "protocol/canopen/emcy.hpp"
#include "protocol/canopen/sdo.hpp"
#include "vcan_tests/attack/attacked_machine.hpp"

namespace kinebus {
namespace {

constexpr std::uint8_t kNode = 2;
constexpr std::uint32_t kToNode = cob_id::kSdoRequest + kNode;

/// By SDO, up to four bytes.
void writes(Attacked& rig, ObjectAddress address, int bytes, std::uint32_t value) {
  rig.stranger_sends(sdo::frame_of(kToNode, 0x23u | static_cast<unsigned>(4 - bytes) << 2, address, value));
  rig.run_for(2ms);
}
/// Eight bytes, in two segments.
void writes_frame(Attacked& rig, ObjectAddress address, const CanFrame& value) {
  rig.stranger_sends(sdo::frame_of(kToNode, 0x21, address, 8));
  rig.run_for(2ms);
  CanFrame first = sdo::frame_of(kToNode, 0x00), last = sdo::frame_of(kToNode, 0x1D);
  std::copy_n(value.data.begin(), 7, first.data.begin() + 1);
  last.data[1] = value.data[7];
  rig.stranger_sends(first);
  rig.run_for(2ms);
  rig.stranger_sends(last);
}
CanFrame rate_in_5ms(const Attacked& rig, RateCommand::Kind kind, std::uint16_t q15) {
  return encode(RateCommand{.kind = kind,
                            .counter = 11,
                            .rate_q15 = q15,
                            .full_ramp_2ms = 5,
                            .start = BusTime{(rig.now + 9ms).count() / 1000 * 1000}});
}
CanFrame stop_request(BusTime start, StopReason reason) {
  CanFrame forged = encode(Emergency{.node = kNode, .code = 0x1000, .error_register = 1});
  const auto stop = encode(StopRequest{reason, 0, start});
  std::copy(stop.begin(), stop.end(), forged.data.begin() + 3);
  return forged;
}
void sends_all(Attacked& rig, std::initializer_list<const char*> frames) {
  for (const char* frame : frames) {
    rig.sends(frame);
    rig.run_for(2ms);
  }
}

const std::vector<Attack>& orders() {
  static const std::vector<Attack> all{
      {"SDO: rate 3 % for node 2 alone (2110h)",
       [](Attacked& rig) {
         writes_frame(rig, {0x2110, 0}, rate_in_5ms(rig, RateCommand::Kind::kRate, 1000));
       },
       kOnThePath_um, true},
      {"SDO: stop for node 2 alone (2110h)",
       [](Attacked& rig) {
         writes_frame(rig, {0x2110, 0}, rate_in_5ms(rig, RateCommand::Kind::kStop, 0));
       },
       kOnThePath_um, true},
      {"SDO: stamp for node 2 alone, 300 us off (2111h)",
       [](Attacked& rig) {
         writes_frame(rig, {0x2111, 0}, encode(SyncStamp{.counter = 7, .epoch = 1, .time = rig.now + 300us}));
       },
       kOnThePath_um, true},
      {"SDO: the record that node 2 waits for (2100h)",
       [](Attacked& rig) {
         writes_frame(rig, {0x2100, 0}, rig.next_record());
       },
       kForgedRecord_um, true},
      {"SDO: path time (2112h), buffer cleared (60C4h:6)",
       [](Attacked& rig) {
         writes_frame(rig, {0x2112, 0}, CanFrame{.length = 8});
         rig.run_for(2ms);
         writes(rig, {0x60C4, 6}, 1, 0);
       },
       kOnThePath_um, true},
      {"SDO: TPDO1 and TPDO2 off (1800h, 1801h)",
       [](Attacked& rig) {
         writes(rig, {0x1800, 1}, 4, 0xC0000182);
         writes(rig, {0x1801, 1}, 4, 0xC0000282);
       },
       kOnThePath_um, true},
      {"SDO: TPDO2 once in 6.5 s (1801h:3)",
       [](Attacked& rig) {
         writes(rig, {0x1801, 1}, 4, 0xC0000282);
         writes(rig, {0x1801, 3}, 2, 0xFFFF);
         writes(rig, {0x1801, 1}, 4, 0x40000282);
       },
       kOnThePath_um, true},
      {"SDO: another object in TPDO2 (1A01h)",
       [](Attacked& rig) {
         writes(rig, {0x1801, 1}, 4, 0xC0000282);
         writes(rig, {0x1A01, 0}, 1, 0);
         writes(rig, {0x1A01, 1}, 4, 0x60640020);
         writes(rig, {0x1A01, 0}, 1, 1);
         writes(rig, {0x1801, 1}, 4, 0x40000282);
       },
       kOnThePath_um, true},
      {"SDO: RPDO3 off, RPDO1 with another object (1402h, 1600h)",
       [](Attacked& rig) {
         writes(rig, {0x1402, 1}, 4, 0x80000402);
         writes(rig, {0x1600, 0}, 1, 0);
       },
       kOnThePath_um, true},
      {"SDO: store, restore (1010h, 1011h)",
       [](Attacked& rig) {
         writes(rig, {0x1010, 1}, 4, 0x65766173);
         writes(rig, {0x1011, 1}, 4, 0x64616F6C);
       },
       kOnThePath_um, true},
      {"SDO: heartbeats made and watched (1017h, 1016h)",
       [](Attacked& rig) {
         writes(rig, {0x1017, 0}, 2, 0);
         writes(rig, {0x1016, 1}, 4, 0x0055000A);
         writes(rig, {0x1029, 1}, 1, 2);
       },
       kOnThePath_um, true},
      {"SDO: EMCY off, SYNC's counter (1014h, 1019h)",
       [](Attacked& rig) {
         writes(rig, {0x1014, 0}, 4, 0x80000082);
         writes(rig, {0x1019, 0}, 1, 0);
       },
       kOnThePath_um, true},
      {"SDO: halt, quick stop (6040h)",
       [](Attacked& rig) {
         writes(rig, {0x6040, 0}, 2, 0x010F);
         rig.run_for(50ms);
         writes(rig, {0x6840, 0}, 2, 0x000B);
       },
       kOnThePath_um, true},
      {"RPDO1: halt of both axes", [](Attacked& rig) { rig.sends("202#0F010F010707"); }, kOnThePath_um, true},
      {"RPDO1: quick stop of both axes", [](Attacked& rig) { rig.sends("202#0B000B000707"); }, kOnThePath_um,
       true},
      {"RPDO1 with three bytes", [](Attacked& rig) { rig.sends("202#0F000F"); }, kOnThePath_um, true},
      {"RPDO2: target positions of csp", [](Attacked& rig) { rig.sends("302#A086010060790000"); },
       kOnThePath_um, true},
      {"RPDO4: a wrong checkpoint", [](Attacked& rig) { rig.stranger_sends(rig.wrong_checkpoint()); }},
      {"SDO: a wrong checkpoint (2101h)",
       [](Attacked& rig) {
         writes_frame(rig, {0x2101, 0}, rig.wrong_checkpoint());
       },
       kOnThePath_um, true},
      {"SDO: block download of a program half done (1F50h)",
       [](Attacked& rig) {
         sends_all(rig, {"602#C6501F0100100000", "602#01DEADBEEFDEADBE", "602#02DEADBEEFDEADBE"});
       },
       kOnThePath_um, true},
      {"SDO: block upload begun and left (1008h)",
       [](Attacked& rig) {
         sends_all(rig, {"602#A00810007F000000", "602#A300000000000000"});
       },
       kOnThePath_um, true},
      {"SDO: program cleared, started, stopped (1F51h)",
       [](Attacked& rig) {
         for (std::uint32_t order : {3u, 1u, 0u, 2u}) writes(rig, {0x1F51, 1}, 1, order);
       },
       kOnThePath_um, true},
      {"SDO: auto-tune, touch probe, homing method (2146h, 60B8h, 6098h)",
       [](Attacked& rig) {
         writes(rig, {0x2146, 0}, 1, 1);
         writes(rig, {0x60B8, 0}, 2, 0x33);
         writes(rig, {0x6098, 0}, 1, 35);
       },
       kOnThePath_um, true},
      {"LSS: all configure, node id 9, store, back",
       [](Attacked& rig) {
         sends_all(rig, {"7E5#0401000000000000", "7E5#1109000000000000", "7E5#1700000000000000",
                         "7E5#0400000000000000"});
       },
       kOnThePath_um, true},
      {"LSS: bit timing, activate",
       [](Attacked& rig) {
         sends_all(rig, {"7E5#0401000000000000", "7E5#1300040000000000", "7E5#150A000000000000"});
       },
       kOnThePath_um, true},
      {"TIME", [](Attacked& rig) { rig.sends("100#112233445566"); }, kOnThePath_um, true},
      {"a second node 2: its boot-up", [](Attacked& rig) { rig.sends("702#00"); }},
      {"a second node 2: its heartbeat, stopped", [](Attacked& rig) { rig.sends("702#04"); }},
      {"a second node 2: its heartbeat, operational", [](Attacked& rig) { rig.sends("702#05"); },
       kOnThePath_um, true},
      {"a second node 2: its status, at rest", [](Attacked& rig) { rig.sends("282#0064420000000000"); }},
      {"a second node 2: its positions (TPDO3)", [](Attacked& rig) { rig.sends("382#0000000000000000"); },
       kOnThePath_um, true},
      {"a second node 2: answers to SDO",
       [](Attacked& rig) {
         sends_all(rig, {"582#6000000000000000", "582#8000000000000008"});
       },
       kOnThePath_um, true},
      {"EMCY: stop, an hour ago",
       [](Attacked& rig) { rig.stranger_sends(stop_request(rig.now - 3600s, StopReason::kCommand)); }},
      {"EMCY: stop, 7 s ahead",
       [](Attacked& rig) { rig.stranger_sends(stop_request(rig.now + 7s, StopReason::kCommand)); }},
      {"EMCY: stop, 900 ms ahead",
       [](Attacked& rig) { rig.stranger_sends(stop_request(rig.now + 900ms, StopReason::kCommand)); }},
      {"EMCY: stop, 900 ms ago",
       [](Attacked& rig) { rig.stranger_sends(stop_request(rig.now - 900ms, StopReason::kCommand)); }},
      {"EMCY: stop, 50 ms ago",
       [](Attacked& rig) { rig.stranger_sends(stop_request(rig.now - 50ms, StopReason::kCommand)); }},
      {"EMCY: stop for an unknown reason",
       [](Attacked& rig) { rig.stranger_sends(stop_request(rig.now + 2ms, static_cast<StopReason>(77))); }},
      {"EMCY: emergency stop input",
       [](Attacked& rig) {
         rig.stranger_sends(stop_request(rig.now + 2ms, StopReason::kEmergencyStopInput));
       }},
      {"EMCY without a stop", [](Attacked& rig) { rig.sends("082#1023010000000000"); }, kOnThePath_um, true},
      {"rate that begins 100 ms ago",
       [](Attacked& rig) {
         rig.stranger_sends(encode(RateCommand{.kind = RateCommand::Kind::kRate,
                                               .counter = 9,
                                               .rate_q15 = 1000,
                                               .full_ramp_2ms = 1,
                                               .start = BusTime{(rig.now - 100ms).count() / 1000 * 1000}}));
       }},
      {"clear on the rate's COB-ID",
       [](Attacked& rig) { rig.stranger_sends(rate_in_5ms(rig, RateCommand::Kind::kClear, 0)); }},
      {"stamp of another epoch",
       [](Attacked& rig) {
         rig.stranger_sends(encode(SyncStamp{.counter = 7, .epoch = 9, .time = rig.now + 5s}));
       }},
      {"SYNC without counter, of 8 bytes",
       [](Attacked& rig) {
         sends_all(rig, {"080#", "080#0102030405060708"});
       }},
      {"gateway's heartbeat: stopped", [](Attacked& rig) { rig.sends("77F#04"); }},
      {"a voucher with a number far ahead", [](Attacked& rig) { rig.sends("3FF#FFFF000000000000"); }},
      {"frames with 29 bits: 00000402h, 00000000h, 000001FFh",
       [](Attacked& rig) {
         sends_all(rig, {"00000402#4001000000000000", "00000000#0200", "000001FF#2000000532000000"});
       },
       kOnThePath_um, true},
      {"NMT of one byte, of three, an unknown command",
       [](Attacked& rig) {
         sends_all(rig, {"000#02", "000#020000", "000#7700"});
       },
       kOnThePath_um, true},
      {"a record of three bytes", [](Attacked& rig) { rig.sends("402#400100"); }},
      {"node guarding of all (RTR 701h to 703h)",
       [](Attacked& rig) {
         sends_all(rig, {"701#R", "702#R", "703#R1"});
       },
       kOnThePath_um, true},
      {"flood of 2000 frames 000h that are no NMT",
       [](Attacked& rig) {
         for (int i = 0; i < 2000; ++i) rig.sends("000#0000000000000000");
       }},
      {"flood of 2000 EMCY without a stop, one each ms",
       [](Attacked& rig) {
         for (int i = 0; i < 2000; ++i) {
           rig.sends("082#0000000000000000");
           rig.run_for(1ms);
         }
       },
       kOnThePath_um, true},
      {"flood of 1000 SDO reads of node 2",
       [](Attacked& rig) {
         for (int i = 0; i < 1000; ++i) {
           rig.sends("602#4000100000000000");
           rig.run_for(1ms);
         }
       },
       kOnThePath_um, true},
  };
  return all;
}

class BusOrderAttack : public testing::TestWithParam<BusTrust> {};

TEST_P(BusOrderAttack, NothingMovesApartSomebodyIsNamedAndTheJobIsFinished) {
  expect_together(orders(), GetParam());
}

/// While motion waits, and before a job.
std::vector<Attack> orders_at_rest() {
  std::vector<Attack> all;
  const auto add = [&](const char* name, const std::function<void(Attacked&)>& make,
                       double most_um = kOnThePath_um) {
    for (const Moment moment : {Moment::kHeld, Moment::kReady})
      all.push_back({name, make, most_um, false, moment});
  };
  add("SDO: full rate for node 2 alone (2110h)", [](Attacked& rig) {
    writes_frame(rig, {0x2110, 0}, rate_in_5ms(rig, RateCommand::Kind::kRate, kFullRateQ15));
  });
  add("rate 100 %",
      [](Attacked& rig) { rig.stranger_sends(rate_in_5ms(rig, RateCommand::Kind::kRate, kFullRateQ15)); });
  add("SDO: the record that node 2 waits for (2100h)", [](Attacked& rig) {
    writes_frame(rig, {0x2100, 0}, rig.next_record());
  });
  add("the record that node 2 waits for", [](Attacked& rig) { rig.stranger_sends(rig.next_record()); });
  add("SDO: path time of node 2 (2112h)", [](Attacked& rig) {
    writes_frame(rig, {0x2112, 0}, text_frame("000#0000100000000000"));
  });
  add("SDO: buffer cleared (60C4h:6)", [](Attacked& rig) { writes(rig, {0x60C4, 6}, 1, 0); });
  add("SDO: profile position, a target, go", [](Attacked& rig) {
    writes(rig, {0x6060, 0}, 1, 1);
    writes(rig, {0x607A, 0}, 4, 5000);
    writes(rig, {0x6040, 0}, 2, 0x1F);
    rig.run_for(100ms);
  });
  add("SDO: profile velocity, a velocity", [](Attacked& rig) {
    writes(rig, {0x6060, 0}, 1, 3);
    writes(rig, {0x60FF, 0}, 4, 5000);
    rig.run_for(100ms);
  });
  add("RPDO1: drives off and on again", [](Attacked& rig) {
    sends_all(rig, {"202#000000000707", "202#060006000707", "202#070007000707", "202#0F000F000707"});
  });
  add("SDO: direction (2140h:4)", [](Attacked& rig) { writes(rig, {0x2140, 4}, 1, 1); });
  add("SDO: home offset (607Ch), polarity of switches (2131h)", [](Attacked& rig) {
    writes(rig, {0x607C, 0}, 4, 77777);
    writes(rig, {0x2131, 1}, 1, 1);
  });
  add("SDO: stop ramp 2 ms (2113h)", [](Attacked& rig) { writes(rig, {0x2113, 0}, 2, 2); });
  add("SDO: homing (6060h 6, 6040h)", [](Attacked& rig) {
    writes(rig, {0x6060, 0}, 1, 6);
    writes(rig, {0x6040, 0}, 2, 0x1F);
    rig.run_for(100ms);
  });
  add("SDO: RPDO3 off (1402h)", [](Attacked& rig) { writes(rig, {0x1402, 1}, 4, 0x80000402); });
  add("SDO: TPDO2 off (1801h)", [](Attacked& rig) { writes(rig, {0x1801, 1}, 4, 0xC0000282); });
  add("NMT pre-operational of node 2", [](Attacked& rig) { rig.sends("000#8002"); });
  add("NMT stop and start of node 2", [](Attacked& rig) { sends_all(rig, {"000#0202", "000#0102"}); });
  add("NMT reset communication of node 2", [](Attacked& rig) { rig.sends("000#8202"); });
  add("LSS: node id 9 for all, stored", [](Attacked& rig) {
    sends_all(rig, {"7E5#0401000000000000", "7E5#1109000000000000", "7E5#1700000000000000",
                    "7E5#0400000000000000"});
  });
  return all;
}

TEST(BusOrderAttackAtRest, NoJobGoesOnApartFromItsPath) {
  expect_together(orders_at_rest(), BusTrust::kOpen);
}

INSTANTIATE_TEST_SUITE_P(Trust, BusOrderAttack, testing::Values(BusTrust::kOpen, BusTrust::kSession));

}  // namespace
}  // namespace kinebus

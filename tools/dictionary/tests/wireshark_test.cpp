// What tshark says with the dissector, against the codecs that made the frames. Without tshark it fails.
#include <cmath>
#include <random>
#include <set>

#include "protocol/canopen/emcy.hpp"
#include "protocol/canopen/lss.hpp"
#include "protocol/canopen/nmt.hpp"
#include "protocol/motion/broadcast.hpp"
#include "protocol/motion/segment.hpp"
#include "protocol/motion/voucher.hpp"
#include "tools/dictionary/tests/tshark.hpp"
#include "tools/dictionary/tests/wireshark_frames.hpp"

namespace kinebus {
namespace {

TEST(Wireshark, LeavesNothingOfAPrintOpaque) {
  std::vector<CanFrame> frames = print_frames();
  const std::vector<CanFrame> heat = heat_frames();
  frames.insert(frames.end(), heat.begin(), heat.end());
  const Tshark tshark;
  const auto told = tshark.read(tshark.capture(frames), {"kinebus.service", "kinebus.wrong_check", "data"});
  ASSERT_EQ(told.size(), frames.size());
  std::map<std::string, int> services;
  for (std::size_t i = 0; i < told.size(); ++i) {
    DissectedFrame frame = told[i];
    const std::string& notes = frame["_ws.expert.message"];
    // The only notes are what the bus has to tell of: emergencies and refused accesses.
    const bool tells = frames[i].id < 0x100 || (frames[i].id >> 7 == 0x580 >> 7 && frames[i].data[0] == 0x80);
    EXPECT_TRUE(notes.empty() || tells) << to_text(frames[i]).view() << ": " << notes;
    EXPECT_TRUE(frame["kinebus.rest"].empty() && frame["data"].empty()) << to_text(frames[i]).view();
    EXPECT_NE(frame["frame.protocols"].find("kinebus"), std::string::npos) << to_text(frames[i]).view();
    ++services[frame["kinebus.service"]];
  }
  for (const char* service : {"NMT",
                              "SYNC",
                              "EMCY",
                              "Heartbeat",
                              "SDO request",
                              "SDO reply",
                              "RPDO1 Control",
                              "RPDO3 Segment",
                              "RPDO4 Checkpoint",
                              "Rate",
                              "SyncStamp",
                              "TPDO1 Status",
                              "TPDO2 Stream",
                              "TPDO3 Positions",
                              "RPDO1 SetPoints",
                              "RPDO2 Fans",
                              "RPDO3 Filament",
                              "RPDO4 FlowAhead",
                              "TPDO1 State",
                              "TPDO2 Temperatures",
                              "TPDO3 Outputs",
                              "TPDO4 MoreTemperatures"})
    EXPECT_GT(services[service], 0) << service;
}

TEST(Wireshark, LeavesNothingOfASessionOpaque) {
  const std::vector<CanFrame> frames = print_with(BusTrust::kSession);
  const Tshark tshark;
  const auto told =
      tshark.read(tshark.capture(frames), {"kinebus.service", "kinebus.voucher.number", "data"});
  ASSERT_EQ(told.size(), frames.size());
  int vouchers = 0, keys = 0;
  for (std::size_t i = 0; i < told.size(); ++i) {
    DissectedFrame frame = told[i];
    EXPECT_TRUE(frame["_ws.expert.message"].empty() || frames[i].id < 0x100 || frames[i].data[0] == 0x80)
        << to_text(frames[i]).view() << ": " << frame["_ws.expert.message"];
    EXPECT_TRUE(frame["kinebus.rest"].empty() && frame["data"].empty()) << to_text(frames[i]).view();
    keys += frame["_ws.col.Info"].find("write 2117h") != std::string::npos ? 1 : 0;
    if (frames[i].id != kVoucherCobId) continue;
    EXPECT_EQ(frame["kinebus.voucher.number"], std::to_string(get_u16_le(frames[i].data)));
    ++vouchers;
  }
  EXPECT_GT(vouchers, 100);
  EXPECT_EQ(keys, 5 * 3);
}

TEST(Wireshark, ReadsEveryRecordOfAPrintAsTheCodec) {
  const Tshark tshark;
  const auto told =
      tshark.read(tshark.candump(print_frames()),
                  {"kinebus.segment.sequence", "kinebus.segment.duration", "kinebus.segment.acceleration_a",
                   "kinebus.segment.acceleration_b", "kinebus.segment.control", "kinebus.segment.start",
                   "kinebus.checkpoint.position", "kinebus.stream.pathtime", "kinebus.stream.pathtimelow",
                   "kinebus.stream.tailcheck", "kinebus.stream.freerecords", "kinebus.rate.rate",
                   "kinebus.rate.start", "kinebus.stamp.microseconds"});
  ASSERT_EQ(told.size(), print_frames().size());
  int starts = 0, ends = 0, motions = 0, checked = 0;
  for (std::size_t i = 0; i < told.size(); ++i) {
    const CanFrame& frame = print_frames()[i];
    DissectedFrame fields = told[i];
    const auto number = [&](const char* name) {
      const std::string& text = fields["kinebus." + std::string(name)];
      return text.empty() ? std::nan("") : std::stod(text);
    };
    const std::uint64_t raw = get_u64_le(frame.data);
    if (frame.id > 0x400 && frame.id < 0x480) {
      const Segment s = decode_segment(raw).value_or(Segment{});
      EXPECT_EQ(number("segment.sequence"), s.sequence);
      EXPECT_EQ(number("segment.duration"), 16.0 * s.duration);
      if (s.control == SegmentControl::kNone) {
        ++motions;
        const double unit = 8 / 4294967296.0 / (16e-6 * 16e-6);
        EXPECT_NEAR(number("segment.acceleration_a"), s.acceleration[0] * unit, 1e-6);
        EXPECT_NEAR(number("segment.acceleration_b"), s.acceleration[1] * unit, 1e-6);
      } else {
        EXPECT_EQ(number("segment.control"), static_cast<int>(s.control));
        ++(s.control == SegmentControl::kStart ? starts : ends);
      }
      if (s.control == SegmentControl::kStart) {
        EXPECT_EQ(number("segment.start"), 16.0 * static_cast<double>(s.start_units));
      }
    } else if (frame.id > 0x500 && frame.id < 0x580) {
      EXPECT_NEAR(number("checkpoint.position"),
                  static_cast<double>(decode_checkpoint(raw).position) / 4294967296.0, 1e-7);
    } else if (frame.id > 0x280 && frame.id < 0x2FF) {
      const StreamStatus status = decode_stream_status(raw);
      EXPECT_EQ(number(status.tail_check ? "stream.pathtimelow" : "stream.pathtime"),
                16.0 * status.path_units);
      if (status.tail_check) {
        EXPECT_EQ(number("stream.tailcheck"), *status.tail_check);
        ++checked;
      }
      EXPECT_EQ(number("stream.freerecords"), status.free_records);
    } else if (frame.id == kRateCobId) {
      const auto rate = decode_rate_command(frame, BusTime{0}).value_or(RateCommand{});
      EXPECT_EQ(number("rate.rate"), rate.rate_q15 / 32768.0);
      EXPECT_EQ(number("rate.start"),
                static_cast<double>(get_u32_le(std::span(frame.data).subspan(4)) & 0xFFFFFF));
    } else if (frame.id == kSyncStampCobId) {
      EXPECT_EQ(number("stamp.microseconds"), get_u32_le(std::span(frame.data).subspan(4)));
    }
  }
  EXPECT_GT(starts, 2);
  EXPECT_GT(ends, 2);
  EXPECT_GT(motions, 50);
  EXPECT_GT(checked, 20);
}

TEST(Wireshark, NamesEveryKindOfFrame) {
  const auto stop = encode(StopRequest{StopReason::kLimitSwitch, 1, BusTime{10'000'000}});
  const std::vector<std::pair<CanFrame, std::string>> table{
      {nmt_frame(NmtCommand::kStart, 2), "Gateway: NMT Command start, Node 2"},
      {heartbeat_frame(NmtState::kInitialising, 3), "Node 3: Heartbeat Nmt state boot-up"},
      {heartbeat_frame(NmtState::kPreOperational, 127), "Gateway: Heartbeat Nmt state pre-operational"},
      {frame_of("3FF#0201123456789ABC"), "Gateway: Voucher for the next frame, number ..0102h"},
      {frame_of("601#2F17210501000000"),
       "Gateway to Node 1: SDO request write 2117h:5 Session key: Session in force = 1"},
      {frame_of("080#F0"), "Gateway: SYNC 240"},
      {frame_of("080#"), "Gateway: SYNC without counter"},
      {frame_of("100#01000000.0500"), "Gateway: TIME 1 ms, day 5"},
      {encode(Emergency{2, node_emcy::kLimitSwitch, 0x81, stop}),
       "Node 2: EMCY FF07h a limit switch (generic, manufacturer): all stop, a limit switch"},
      {encode(Emergency{2, 0x8611, 0x21, {}}),
       "Node 2: EMCY 8611h following error: the motor did not follow (generic, device profile)"},
      {encode(Emergency{2, 0x2399, 0x03, {}}), "Node 2: EMCY 2399h current fault (generic, current)"},
      {encode(Emergency{2, 0, 0, {}}), "Node 2: EMCY 0000h no error"},
      {record_frame(0x401,
                    encode(Segment{.sequence = 9, .control = SegmentControl::kStart, .start_units = 1000})),
       "Gateway to Node 1: RPDO3 Segment Sequence 9, Duration 0 us, Control start, Start 16000 us, Record "
       "check " +
           std::to_string(
               encode(Segment{.sequence = 9, .control = SegmentControl::kStart, .start_units = 1000}) >> 61)},
      {record_frame(0x501, encode(Checkpoint{9, 1, -(std::int64_t{3} << 31)})),
       "Gateway to Node 1: RPDO4 Checkpoint Sequence 9, Axis B, Position -1.5 counts"},
      {frame_of("601#4041600000000000"), "Gateway to Node 1: SDO request read 6041h:0 Statusword A"},
      {frame_of("581#4B41600037060000"),
       "Node 1: SDO reply 6041h:0 Statusword A = 0637h operation enabled, remote, target reached"},
      {frame_of("601#2F60600008000000"),
       "Gateway to Node 1: SDO request write 6060h:0 Modes of operation A = cyclic synchronous position (8)"},
      {frame_of("581#80606000.22000008"),
       "Node 1: SDO reply abort 6060h:0 Modes of operation A: 08000022h data cannot be transferred because "
       "of the "
       "present device state"},
      {frame_of("7E5#0401000000000000"), "Gateway: LSS request Command switch state global, Value 1"},
      {frame_of("7E5#1105000000000000"), "Gateway: LSS request Command configure node id, Value 5"},
      {frame_of("7E5#51.454E494B.1F.00.00"), "Gateway: LSS request Command fastscan, Value 1263095365"},
      {frame_of("7E4#4F00000000000000"), "Node: LSS reply Command identified, Value 0"},
      {frame_of("601#C2501F0100010000"),
       "Gateway to Node 1: SDO request block download 1F50h:1 Program data: Program 1"},
      {frame_of("581#A4501F0102000000"),
       "Node 1: SDO reply block download accepted 1F50h:1 Program data: Program 1"},
      {frame_of("601#0111223344556677"),
       "Gateway to Node 1: SDO request block download segment 1 1F50h:1 Program data: Program 1"},
      {frame_of("601#8211223344556677"),
       "Gateway to Node 1: SDO request block download segment 2, last 1F50h:1 Program data: Program 1"},
      {frame_of("581#A202020000000000"),
       "Node 1: SDO reply block download segments received 1F50h:1 Program data: Program 1"},
      {frame_of("601#D534120000000000"),
       "Gateway to Node 1: SDO request block download ends 1F50h:1 Program data: Program 1"},
      {frame_of("581#A100000000000000"),
       "Node 1: SDO reply block download has ended 1F50h:1 Program data: Program 1"},
      {frame_of("601#4008100000000000"),
       "Gateway to Node 1: SDO request read 1008h:0 Manufacturer device name"},
      {frame_of("581#410810000C000000"), "Node 1: SDO reply 1008h:0 Manufacturer device name"},
      {frame_of("601#6000000000000000"),
       "Gateway to Node 1: SDO request next segment, please 1008h:0 Manufacturer device name"},
      {frame_of("581#004B696E65627573"), "Node 1: SDO reply read segment 1008h:0 Manufacturer device name"},
      {frame_of("601#7000000000000000"),
       "Gateway to Node 1: SDO request next segment, please 1008h:0 Manufacturer device name"},
      {frame_of("581#15206E6F64650000"),
       "Node 1: SDO reply read segment, last 1008h:0 Manufacturer device name = Kinebus node"},
  };
  std::vector<CanFrame> frames;
  for (const auto& row : table) frames.push_back(row.first);
  const Tshark tshark;
  const auto told = tshark.read(tshark.capture(frames));
  ASSERT_EQ(told.size(), frames.size());
  for (std::size_t i = 0; i < told.size(); ++i) {
    EXPECT_EQ(told[i].at("_ws.col.Info"), table[i].second) << to_text(frames[i]).view();
    EXPECT_TRUE(told[i].at("kinebus.rest").empty()) << to_text(frames[i]).view();
  }
}

TEST(Wireshark, FollowsMappingsIdentitiesAndShiftsThatTheBusTells) {
  const std::vector<CanFrame> frames{
      // TPDO1 of node 5 becomes one object of 4 bytes on identifier 1A0h; a heat node is told by its
      // identity.
      frame_of("605#23001A0120006460"),
      frame_of("585#60001A0100000000"),
      frame_of("605#2F001A0001000000"),
      frame_of("585#60001A0000000000"),
      frame_of("605#23001801A0010040"),
      frame_of("585#6000180100000000"),
      frame_of("1A0#FEFFFFFF"),
      frame_of("60C#4018100200000000"),
      frame_of("58C#4318100204040000"),
      frame_of("28C#C800FFFF00000000"),
      // Refused, a shift is not taken for set.
      frame_of("605#2F40210106000000"),
      frame_of("585#8040210131000906"),
      record_frame(0x405, encode(Segment{.sequence = 1, .duration = 1, .acceleration = {1000, 1000}})),
      frame_of("605#2F40210103000000"),
      frame_of("585#6040210100000000"),
      record_frame(0x405, encode(Segment{.sequence = 1, .duration = 1, .acceleration = {1000, 1000}})),
      // An unknown node whose TPDO4 has the length of one board only.
      frame_of("48D#C800FFFF6009"),
  };
  const Tshark tshark;
  const auto told = tshark.read(tshark.capture(frames),
                                {"kinebus.segment.acceleration_a", "kinebus.segment.acceleration_b"});
  ASSERT_EQ(told.size(), frames.size());
  const auto info = [&](std::size_t i) { return told[i].at("_ws.col.Info"); };
  EXPECT_EQ(info(6), "Node 5: TPDO1 Status Position actual value A -2 counts");
  EXPECT_NE(info(9).find("TPDO2 Temperatures AI input PV: Sensor 1 20 C; AI input PV: Sensor 2 -0.1 C"),
            std::string::npos)
      << info(9);
  const double unit = 1000 * 8 / 4294967296.0 / (16e-6 * 16e-6);
  EXPECT_NEAR(std::stod(told[12].at("kinebus.segment.acceleration_a")), unit, 1e-6);
  EXPECT_NEAR(std::stod(told[15].at("kinebus.segment.acceleration_a")), 2 * unit, 1e-6);
  EXPECT_NEAR(std::stod(told[15].at("kinebus.segment.acceleration_b")), unit, 1e-6);
  EXPECT_NE(info(16).find("TPDO4 MoreTemperatures AI input PV: Sensor 5 20 C; AI input PV: Sensor 6 -0.1 C"),
            std::string::npos)
      << info(16);
  // Frames that are looked at again are still what they were when they came.
  const auto again = tshark.read(tshark.capture(frames), {}, "-2 -d can.subdissector,kinebus");
  ASSERT_EQ(again.size(), told.size());
  for (std::size_t i = 0; i < told.size(); ++i) {
    EXPECT_TRUE(told[i].at("kinebus.rest").empty()) << info(i);
    EXPECT_EQ(again[i].at("_ws.col.Info"), info(i));
  }
}

TEST(Wireshark, NotesWhatIsWrongWithAFrame) {
  CanFrame rate = encode(RateCommand{RateCommand::Kind::kStop, 7, 16384, 50, BusTime{123'456'000}});
  rate.data[1] ^= 4;
  CanFrame unknown =
      encode(RateCommand{static_cast<RateCommand::Kind>(5), 7, 16384, 50, BusTime{123'456'000}});
  CanFrame stamp = encode(SyncStamp{240, 3, BusTime{5'000'789}});
  stamp.data[5] ^= 1;
  auto stop = encode(StopRequest{StopReason::kLimitSwitch, 1, BusTime{10'000'000}});
  stop[2] ^= 1;
  const std::uint64_t start =
      encode(Segment{.sequence = 9, .control = SegmentControl::kStart, .start_units = 1000});
  CanFrame extended = frame_of("181#11");
  extended.id = 0x12345678;
  extended.extended = true;
  CanFrame remote{.id = 0x701, .remote = true};
  const std::vector<std::pair<CanFrame, std::string>> table{
      {rate, "Check bits are wrong"},
      {unknown, "Kind, rate or ramp is out of its range"},
      {stamp, "Check bits are wrong"},
      {encode(Emergency{2, node_emcy::kLimitSwitch, 0x81, stop}), "Check bits are wrong"},
      {record_frame(0x401, start ^ (1u << 25)), "Check bits are wrong"},
      {record_frame(0x401, 3u << 20), "neither start nor end"},
      {frame_of("000#01"), "NMT has 1 bytes, not 2"},
      {frame_of("000#"), "NMT has 0 bytes, not 2"},
      {frame_of("000#0701"), "No such command"},
      {frame_of("080#0102"), "SYNC has a counter or nothing"},
      {frame_of("082#0102"), "EMCY has 2 bytes, not 8"},
      {frame_of("701#"), "Heartbeat has 0 bytes"},
      {frame_of("701#33"), "No such NMT state"},
      {frame_of("601#40"), "SDO request has 1 bytes"},
      {frame_of("581#E000000000000000"), "no command specifier"},
      {frame_of("601#2B60600008000000"), "2 bytes where the object has 1"},
      {frame_of("181#0102"), "Shorter than its mapping"},
      {frame_of("381#"), "Shorter than its mapping"},
      {frame_of("401#01020304050607"), "Longer than its mapping"},
      {frame_of("3FF#00"), "Voucher has 1 bytes, not 8"},
      {frame_of("1FF#00"), "Shorter than its mapping"},
      {frame_of("7E5#0000000000000000"), "No such service of LSS"},
      {frame_of("050#"), "No identifier of Kinebus"},
      {frame_of("6A0#0102"), "No identifier of Kinebus"},
      {extended, "no extended identifiers"},
      {remote, "remote requests"},
  };
  std::vector<CanFrame> frames;
  for (const auto& row : table) frames.push_back(row.first);
  const Tshark tshark;
  const auto told = tshark.read(tshark.capture(frames));
  ASSERT_EQ(told.size(), frames.size());
  for (std::size_t i = 0; i < told.size(); ++i)
    EXPECT_NE(told[i].at("_ws.expert.message").find(table[i].second), std::string::npos)
        << to_text(frames[i]).view() << ": " << told[i].at("_ws.expert.message");
}

TEST(Wireshark, SurvivesAnyFrame) {
  std::mt19937_64 random(19);
  std::vector<CanFrame> frames;
  for (int i = 0; i < 30'000; ++i) {
    CanFrame frame{.id = static_cast<std::uint32_t>(random() % 0x800),
                   .length = static_cast<std::uint8_t>(random() % 9)};
    // Half of them SDO of one node with whole frames, so that transfers begin, are cut short and mixed up.
    if (i % 2 == 0) frame = {.id = random() % 2 == 0 ? 0x601u : 0x581u, .length = 8};
    const std::uint64_t bits = random();
    for (std::size_t k = 0; k < frame.length; ++k) frame.data[k] = static_cast<std::uint8_t>(bits >> (8 * k));
    if (i % 4 == 0) {  // an object that there is
      constexpr std::array<std::uint16_t, 8> kIndices{0x1A00, 0x1800, 0x1601, 0x2140,
                                                      0x6041, 0x1008, 0x1018, 0x2102};
      put_u16_le(std::span(frame.data).subspan(1), kIndices[bits >> 60 & 7]);
      frame.data[3] %= 9;
    }
    frame.remote = random() % 50 == 0;
    if (frame.remote) frame.data = {};
    frame.extended = random() % 50 == 0;
    frames.push_back(frame);
  }
  const Tshark tshark;
  const auto told = tshark.read(tshark.capture(frames));  // which looks for errors of Lua
  ASSERT_EQ(told.size(), frames.size());
  for (std::size_t i = 0; i < told.size(); ++i)
    EXPECT_NE(told[i].at("frame.protocols").find("kinebus"), std::string::npos) << to_text(frames[i]).view();
}

TEST(Wireshark, ReadsABusWithoutBeingToldWhenItsPreferenceSaysSo) {
  const Tshark tshark;
  const std::string capture = tshark.capture({frame_of("080#05"), frame_of("60C#2F12220101000000")});
  const auto told = tshark.read(capture, {}, "-o kinebus.always:TRUE -o kinebus.heat:12");
  ASSERT_EQ(told.size(), 2u);
  EXPECT_EQ(told[0].at("_ws.col.Info"), "Gateway: SYNC 5");
  EXPECT_NE(told[1].at("_ws.col.Info").find("2212h:1 Heater highest set point: Heater 1"), std::string::npos)
      << told[1].at("_ws.col.Info");
  EXPECT_EQ(tshark.read(capture, {}, "").at(1).at("frame.protocols").find("kinebus"), std::string::npos);
}

}  // namespace
}  // namespace kinebus

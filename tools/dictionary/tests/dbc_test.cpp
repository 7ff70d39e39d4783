// The file is read back by a reader of its own and compared with the object table and the codecs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "protocol/canopen/cob_id.hpp"
#include "protocol/canopen/emcy.hpp"
#include "protocol/canopen/node_objects.hpp"
#include "protocol/motion/broadcast.hpp"
#include "protocol/motion/segment.hpp"
#include "protocol/motion/voucher.hpp"
#include "tools/dictionary/dbc.hpp"
#include "tools/dictionary/frame_fields.hpp"

namespace kinebus {
namespace {

struct Signal {
  int start = 0, bits = 0;
  bool is_signed = false;
  double factor = 0;
  bool selects = false;              // other signals are there by its raw value ...
  std::string selector;              // ... and this one by that of `selector`
  std::pair<long, long> when{0, 0};  // from, to
};
struct Message {
  std::string name, sender;
  int length = 0;
  std::vector<std::string> order;
  std::map<std::string, Signal> signals;
};

/// Readers of DBC files take no other name.
bool is_c_identifier(const std::string& name) {
  const auto fits = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  return !name.empty() && std::isdigit(static_cast<unsigned char>(name.front())) == 0 &&
         std::all_of(name.begin(), name.end(), fits);
}

std::map<unsigned, Message> read_dbc(const std::string& text) {
  std::map<unsigned, Message> messages;
  std::istringstream in(text);
  std::string line;
  Message* current = nullptr;
  while (std::getline(in, line)) {
    char name[64], sender[64], unit[64], sign = 0;
    unsigned id = 0;
    Message m;
    Signal s;
    if (std::sscanf(line.c_str(), "BO_ %u %63[^:]: %d %63s", &id, name, &m.length, sender) == 4) {
      EXPECT_EQ(messages.count(id), 0u) << line;
      m.name = name;
      m.sender = sender;
      current = &(messages[id] = m);
    } else if (line.rfind(" SG_ ", 0) == 0) {
      std::istringstream words(line.substr(5));
      std::string signal, mark, rest;
      words >> signal >> mark;
      if (mark != ":") {
        s.selects = mark.back() == 'M';
        if (mark != "M") {
          EXPECT_EQ(mark.front(), 'm') << line;
          s.when.first = s.when.second = std::stol(mark.substr(1));
          s.selector = "?";
        }
        words >> mark;
      }
      EXPECT_EQ(mark, ":") << line;
      std::getline(words, rest);
      EXPECT_EQ(std::sscanf(rest.c_str(), " %d|%d@1%c (%lf,0) [0|0] \"%63[^\n]", &s.start, &s.bits, &sign,
                            &s.factor, unit),
                5)
          << line;
      EXPECT_NE(current, nullptr);
      EXPECT_TRUE(is_c_identifier(signal)) << line;
      s.is_signed = sign == '-';
      EXPECT_TRUE(!s.selects || s.factor == 1) << line;
      EXPECT_TRUE(current->signals.emplace(signal, s).second) << line;
      EXPECT_LE(s.start + s.bits, 8 * current->length) << line;
      current->order.emplace_back(signal);
    } else if (line.rfind("SG_MUL_VAL_ ", 0) == 0) {
      char selector[64];
      long low = 0, high = 0;
      EXPECT_EQ(
          std::sscanf(line.c_str(), "SG_MUL_VAL_ %u %63s %63s %ld-%ld;", &id, name, selector, &low, &high), 5)
          << line;
      Message& of = messages.at(id);
      Signal& signal = of.signals.at(name);
      EXPECT_EQ(signal.selector, "?") << line;
      EXPECT_EQ(signal.when.first, low) << line;
      EXPECT_TRUE(of.signals.at(selector).selects) << line;
      signal.selector = selector;
      signal.when = {low, high};
    } else {
      EXPECT_EQ(line.find("SG_ "), line.rfind("CM_ SG_ ", 0) == 0 ? 4u : std::string::npos)
          << "not read: " << line;
    }
  }
  return messages;
}

std::int64_t raw_value(const Signal& s, const CanFrame& frame) {
  std::uint64_t raw = get_u64_le(frame.data) >> s.start;
  if (s.bits < 64) raw &= (std::uint64_t{1} << s.bits) - 1;
  auto value = static_cast<std::int64_t>(raw);
  if (s.is_signed && s.bits < 64 && ((raw >> (s.bits - 1)) & 1) != 0) value -= std::int64_t{1} << s.bits;
  return value;
}
/// By its selector and the selector's own, is the signal in this frame?
bool is_there(const Message& message, const std::string& signal, const CanFrame& frame) {
  const Signal& s = message.signals.at(signal);
  if (s.selector.empty()) return true;
  const std::int64_t value = raw_value(message.signals.at(s.selector), frame);
  return is_there(message, s.selector, frame) && value >= s.when.first && value <= s.when.second;
}
double decode(const Message& message, const std::string& signal, const CanFrame& frame) {
  EXPECT_TRUE(is_there(message, signal, frame)) << signal;
  const Signal& s = message.signals.at(signal);
  return static_cast<double>(raw_value(s, frame)) * s.factor;
}
CanFrame frame_of(std::uint64_t record) {
  CanFrame frame{.length = 8};
  put_u64_le(frame.data, record);
  return frame;
}

TEST(Dbc, PdosAreThoseOfTheTable) {
  using namespace object_table;
  const auto messages = read_dbc(dbc_text(nodes_of(kBoards[0])));
  const auto check = [&](const PdoDefault& pdo, unsigned id) {
    ASSERT_EQ(messages.count(id), 1u) << pdo.name;
    const Message& m = messages.at(id);
    int bits = 0;
    std::vector<std::pair<int, int>> expected, got;
    for (const auto mapping : pdo.map) {
      const int size = static_cast<int>(mapping & 0xFF);
      if (size != 0 && size != 64) expected.emplace_back(bits, size);
      bits += size;
    }
    EXPECT_EQ(m.length * 8, bits) << pdo.name;
    if (expected.empty()) return;  // a packed record: see below
    for (const auto& name : m.order) got.emplace_back(m.signals.at(name).start, m.signals.at(name).bits);
    EXPECT_EQ(got, expected) << pdo.name;
  };
  for (unsigned node = 1; node <= 3; ++node) {
    for (const auto& pdo : kAxisPairTpdos)
      if ((pdo.cob_id & kPdoOff) == 0) check(pdo, (pdo.cob_id & 0x7FF) + node);
    for (const auto& pdo : kAxisPairRpdos) check(pdo, (pdo.cob_id & 0x7FF) + (pdo.plus_node_id ? node : 0));
  }
  const Message& status = messages.at(0x181);
  EXPECT_EQ(status.sender, "NODE1");
  EXPECT_TRUE(status.signals.at("ModesOfOperationDisplay_B").is_signed);
  EXPECT_EQ(messages.at(0x201).sender, "GATEWAY");
}

TEST(Dbc, PackedRecordsDecodeAsTheCodecPacks) {
  const auto messages = read_dbc(dbc_text(nodes_of(kBoards[0])));
  const CanFrame segment =
      frame_of(encode(Segment{.sequence = 101, .duration = 5000, .acceleration = {-2000000, 77}}));
  const Message& m = messages.at(0x402);
  EXPECT_EQ(decode(m, "Sequence", segment), 101);
  EXPECT_EQ(decode(m, "Duration", segment), 80000 / 16) << "in units of 16 us, by which readers choose";
  const double unit = 8 / 4294967296.0 / (16e-6 * 16e-6);  // of the default shift, counts/s2
  EXPECT_NEAR(decode(m, "Acceleration_A", segment), -2000000 * unit, 1e-6);
  EXPECT_NEAR(decode(m, "Acceleration_B", segment), 77 * unit, 1e-6);
  EXPECT_FALSE(is_there(m, "Control", segment) || is_there(m, "Start", segment));

  const CanFrame checkpoint = frame_of(encode(Checkpoint{9, 1, -(std::int64_t{3} << 31)}));
  EXPECT_EQ(decode(messages.at(0x501), "Sequence", checkpoint), 9);
  EXPECT_EQ(decode(messages.at(0x501), "Axis", checkpoint), 1);
  EXPECT_EQ(decode(messages.at(0x501), "Position", checkpoint), -1.5);

  const CanFrame status =
      frame_of(encode(StreamStatus{77, 120, StreamStatus::kStopped | StreamStatus::kSynchronised, 3, 1000}));
  const Message& stream = messages.at(0x283);
  EXPECT_EQ(decode(stream, "NextSequence", status), 77);
  EXPECT_EQ(decode(stream, "FreeRecords", status), 120);
  EXPECT_EQ(decode(stream, "Stopped", status), 1);
  EXPECT_EQ(decode(stream, "Synchronised", status), 1);
  EXPECT_EQ(decode(stream, "Running", status), 0);
  EXPECT_EQ(decode(stream, "SyncError", status), 3);
  EXPECT_EQ(decode(stream, "PathTime", status), 16000);
  EXPECT_FALSE(is_there(stream, "PathTimeLow", status) || is_there(stream, "TailCheck", status));
  const CanFrame checked = frame_of(encode(StreamStatus{77, 120, 0, 3, 0x1234'5678, 0x9A}));
  EXPECT_EQ(decode(stream, "NextSequence", checked), 77);
  EXPECT_EQ(decode(stream, "FreeRecords", checked), 120);
  EXPECT_EQ(decode(stream, "PathTimeLow", checked), 16.0 * 0x34'5678);
  EXPECT_EQ(decode(stream, "TailCheck", checked), 0x9A);
  EXPECT_FALSE(is_there(stream, "PathTime", checked));

  const CanFrame rate = encode(RateCommand{RateCommand::Kind::kStop, 7, 16384, 50, BusTime{123'456'000}});
  EXPECT_EQ(decode(messages.at(rate.id), "Counter", rate), 7);
  EXPECT_EQ(decode(messages.at(rate.id), "Kind", rate), 2);
  EXPECT_EQ(decode(messages.at(rate.id), "Rate", rate), 0.5);
  EXPECT_EQ(decode(messages.at(rate.id), "FullRamp", rate), 100);
  EXPECT_EQ(decode(messages.at(rate.id), "Start", rate), 123'456'000 / 1000 % 0x1000000);
  const CanFrame smooth = encode(RateCommand{RateCommand::Kind::kSmooth, 7, 16384, 255, BusTime{0}});
  EXPECT_EQ(decode(messages.at(smooth.id), "Kind", smooth), 4);
  EXPECT_EQ(decode(messages.at(smooth.id), "FullRamp", smooth), 510);

  const CanFrame stamp = encode(SyncStamp{240, 3, BusTime{5'000'789}});
  EXPECT_EQ(decode(messages.at(stamp.id), "Counter", stamp), 240);
  EXPECT_EQ(decode(messages.at(stamp.id), "Epoch", stamp), 3);
  EXPECT_EQ(decode(messages.at(stamp.id), "Nanoseconds", stamp), 789);
  EXPECT_EQ(decode(messages.at(stamp.id), "Microseconds", stamp), 5000);

  const CanFrame emergency = encode(Emergency{2, emcy::kFollowingError, 0x21, {0x83, 0x10, 0x27, 0, 0}});
  EXPECT_EQ(decode(messages.at(0x082), "ErrorCode", emergency), 0x8611);
  EXPECT_EQ(decode(messages.at(0x082), "ErrorRegister", emergency), 0x21);
  EXPECT_EQ(decode(messages.at(0x082), "StopReason", emergency), 3);
  EXPECT_EQ(decode(messages.at(0x082), "StopAxis", emergency), 1);
  EXPECT_EQ(decode(messages.at(0x082), "StopStart", emergency), 10000);
}

TEST(Dbc, StartAndEndRecordsDecodeByTheirMultiplexor) {
  const auto messages = read_dbc(dbc_text(nodes_of(kBoards[0])));
  const Message& m = messages.at(0x402);
  const std::uint64_t start_record =
      encode(Segment{.sequence = 5, .control = SegmentControl::kStart, .start_units = 0x12'3456'789A});
  const CanFrame start = frame_of(start_record);
  EXPECT_EQ(decode(m, "Sequence", start), 5);
  EXPECT_EQ(decode(m, "Duration", start), 0);
  EXPECT_EQ(decode(m, "Control", start), 1);
  EXPECT_EQ(decode(m, "Start", start), 16.0 * 0x12'3456'789A);
  EXPECT_EQ(decode(m, "RecordCheck", start), static_cast<double>(start_record >> 61));
  EXPECT_FALSE(is_there(m, "Acceleration_A", start) || is_there(m, "Acceleration_B", start));

  const CanFrame end = frame_of(encode(Segment{.sequence = 6, .control = SegmentControl::kEnd}));
  EXPECT_EQ(decode(m, "Sequence", end), 6);
  EXPECT_EQ(decode(m, "Control", end), 2);
  EXPECT_FALSE(is_there(m, "Start", end));
}

TEST(Dbc, HasTheNodesThatAreNamed) {
  const NodeList list = read_nodes("2,40-41,20:heat", kBoards[0]);
  ASSERT_EQ(list.error, "");
  const auto messages = read_dbc(dbc_text(list.nodes));
  for (const unsigned node : {2u, 40u, 41u}) EXPECT_EQ(messages.at(0x180 + node).length, 7) << node;
  const Message& temperatures = messages.at(0x294);
  EXPECT_EQ(temperatures.name, "NODE20_Temperatures");
  CanFrame frame{.length = 8};
  put_u16_le(frame.data, 2005);
  EXPECT_NEAR(decode(temperatures, "Sensor1", frame), 200.5, 1e-9);
  EXPECT_EQ(messages.count(0x181), 0u);
  EXPECT_EQ(messages.count(kRateCobId), 1u);
  const Message& voucher = messages.at(kVoucherCobId);
  EXPECT_EQ(voucher.name, "GATEWAY_Voucher");
  EXPECT_EQ(decode(voucher, "Number", CanFrame::make(kVoucherCobId, {2, 1, 0, 0, 0, 0, 0, 0})), 0x102);

  for (const char* wrong : {"", "0", "127", "1-", "3-1", "1,,2", "a", "1,1", "1-3,2:heat", "4:oven", "1:"})
    EXPECT_FALSE(read_nodes(wrong, kBoards[0]).error.empty()) << wrong;
}

TEST(Dbc, EverySignalOfAMessageHasItsOwnBits) {
  for (const auto& [id, message] : read_dbc(dbc_text(nodes_of(kBoards[0]))))
    for (const auto& [name, s] : message.signals)
      for (const auto& [other_name, other] : message.signals) {
        // Signals that are never there together may share bits.
        const bool apart = s.start + s.bits <= other.start || other.start + other.bits <= s.start;
        const bool either = s.selector != other.selector || s.when.second < other.when.first ||
                            other.when.second < s.when.first;
        const bool by_selector = !s.selector.empty() && !other.selector.empty() && either;
        EXPECT_TRUE(name == other_name || apart || by_selector)
            << message.name << " " << name << " " << other_name;
      }
}

}  // namespace
}  // namespace kinebus

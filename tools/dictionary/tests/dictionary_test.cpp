// Both files are read back by readers of their own and compared with the object table and the codecs.
#include <gtest/gtest.h>

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
#include "tools/dictionary/dbc.hpp"
#include "tools/dictionary/eds.hpp"
#include "tools/dictionary/frame_fields.hpp"

namespace kinebus {
namespace {

constexpr const BoardDescription& kBoard = kBoards[0];  // the one that kNodeObjects is of

using Section = std::map<std::string, std::string>;

std::map<std::string, Section> read_ini(const std::string& text) {
  std::map<std::string, Section> sections;
  std::istringstream in(text);
  std::string line, current;
  while (std::getline(in, line)) {
    EXPECT_TRUE(!line.empty() && line.back() == '\r');
    line.pop_back();
    if (line.empty()) continue;
    if (line.front() == '[') {
      current = line.substr(1, line.size() - 2);
      EXPECT_EQ(sections.count(current), 0u) << current;
      sections[current];
      continue;
    }
    const auto equals = line.find('=');
    EXPECT_NE(equals, std::string::npos) << line;
    sections[current][line.substr(0, equals)] = line.substr(equals + 1);
  }
  return sections;
}

std::string section_name(ObjectAddress address, bool sub) {
  char text[32];
  std::snprintf(text, sizeof text, sub ? "%04Xsub%X" : "%04X", address.index, address.subindex);
  return text;
}
std::int64_t number(const std::string& text) {
  return text.rfind("0x", 0) == 0 ? static_cast<std::int64_t>(std::stoull(text, nullptr, 16))
                                  : std::stoll(text);
}

TEST(Eds, SaysOfEveryObjectWhatTheTableSays) {
  auto sections = read_ini(eds_text(kBoard));
  std::size_t values = 0;
  for (const ObjectEntry& entry : kNodeObjects) {
    const bool var = entry.code == ObjectCode::kVar;
    const std::string name = section_name(entry.address, !var);
    ASSERT_EQ(sections.count(name), 1u) << name;
    Section& s = sections[name];
    ++values;
    const std::string second = entry.axis == 1 ? " B" : "";
    EXPECT_EQ(s["ParameterName"], std::string(names_of(entry).name) + (var ? second : "")) << name;
    EXPECT_EQ(number(s["ObjectType"]), 7) << name;
    EXPECT_EQ(number(s["DataType"]), static_cast<std::int64_t>(entry.type)) << name;
    const std::map<std::string, Access> accesses{{"const", Access::kConst},   {"ro", Access::kReadOnly},
                                                 {"wo", Access::kWriteOnly},  {"rw", Access::kReadWrite},
                                                 {"rww", Access::kReadWrite}, {"rwr", Access::kReadWrite}};
    EXPECT_EQ(accesses.at(s["AccessType"]), entry.access) << name;
    if (entry.access == Access::kReadWrite) {
      EXPECT_EQ(s["AccessType"] == "rww", entry.mapping == Mapping::kRpdo) << name;
    }
    EXPECT_EQ(s["PDOMapping"] == "1", entry.mapping != Mapping::kNone) << name;
    std::string initial = s["DefaultValue"];
    if (entry.type == DataType::kString) {
      EXPECT_EQ(initial, entry.text);
    } else {
      const bool relative = initial.rfind("$NODEID+", 0) == 0;
      EXPECT_EQ(relative, entry.node_id_relative) << name;
      if (relative) initial = initial.substr(8);
      EXPECT_EQ(initial.empty() ? 0 : number(initial), entry.initial) << name;
    }
    EXPECT_EQ(s.count("LowLimit") == 1, entry.limited) << name;
    if (entry.limited) {
      EXPECT_EQ(number(s["LowLimit"]), entry.low) << name;
      EXPECT_EQ(number(s["HighLimit"]), entry.high) << name;
    }
    if (!var && entry.address.subindex == 0) {
      Section& whole = sections[section_name(entry.address, false)];
      EXPECT_EQ(whole["ParameterName"], std::string(names_of(entry).object) + second);
      EXPECT_EQ(number(whole["ObjectType"]), static_cast<std::int64_t>(entry.code));
      std::int64_t entries = 0;
      for (const ObjectEntry& other : kNodeObjects)
        entries += other.address.index == entry.address.index ? 1 : 0;
      EXPECT_EQ(number(whole["SubNumber"]), entries);
    }
  }
  EXPECT_EQ(values, kNodeObjectCount);
}

TEST(Eds, NamesAreUnique) {
  for (const BoardDescription& board : kBoards) {
    std::set<std::string> names;
    for (const auto& [section, keys] : read_ini(eds_text(board))) {
      const bool object = section.size() == 4 || section.find("sub") == 4;
      if (!object || !keys.contains("ParameterName")) continue;
      const std::string whole = section.size() > 4 ? section.substr(0, 4) + "/" : "";
      EXPECT_TRUE(names.insert(whole + keys.at("ParameterName")).second)
          << board.facts.name << " " << section;
    }
  }
}

TEST(Eds, IsOfTheBoardThatIsNamed) {
  EXPECT_EQ(find_board("stm32f405"), &kBoards[0]);
  EXPECT_EQ(find_board("stm32"), nullptr);
  for (const BoardDescription& board : kBoards) {
    auto sections = read_ini(eds_text(board));
    EXPECT_EQ(sections["DeviceInfo"]["ProductName"], board.facts.device_name);
    EXPECT_EQ(number(sections["DeviceInfo"]["ProductNumber"]), board.facts.product_code);
    EXPECT_EQ(sections["FileInfo"]["FileName"], std::string(board.facts.order_code) + ".eds");
    EXPECT_EQ(sections["1009"]["DefaultValue"], board.facts.hardware_version);
  }
}

TEST(Eds, OfEveryBoardHasEveryObjectWithItsTypeAndLimits) {
  for (const BoardDescription& board : kBoards) {
    auto sections = read_ini(eds_text(board));
    std::set<std::uint16_t> indices;
    for (const ObjectEntry& entry : board.objects.entries) {
      indices.insert(entry.address.index);
      const std::string name = section_name(entry.address, entry.code != ObjectCode::kVar);
      ASSERT_EQ(sections.count(name), 1u) << board.facts.name << " " << name;
      Section& s = sections[name];
      EXPECT_FALSE(s["ParameterName"].empty()) << name;
      EXPECT_EQ(number(s["DataType"]), static_cast<std::int64_t>(entry.type)) << name;
      EXPECT_EQ(s.count("LowLimit") == 1, entry.limited) << name;
      if (entry.limited) {
        EXPECT_EQ(number(s["HighLimit"]), entry.high) << name;
      }
    }
    std::int64_t listed = 0;
    for (const char* part : {"MandatoryObjects", "OptionalObjects", "ManufacturerObjects"})
      listed += number(sections[part]["SupportedObjects"]);
    EXPECT_EQ(static_cast<std::size_t>(listed), indices.size()) << board.facts.name;
    EXPECT_EQ(number(sections["DeviceInfo"]["NrOfTXPDO"]),
              static_cast<std::int64_t>(board.pdos.tpdos.size()));
  }
}

TEST(Eds, ListsEveryObjectOnceInItsPart) {
  auto sections = read_ini(eds_text(kBoard));
  std::set<std::int64_t> listed;
  for (const auto& [part, low, high] :
       {std::tuple{"MandatoryObjects", 0x1000, 0x1018}, std::tuple{"OptionalObjects", 0x1000, 0x9FFF},
        std::tuple{"ManufacturerObjects", 0x2000, 0x5FFF}}) {
    Section& s = sections[part];
    const std::int64_t count = number(s["SupportedObjects"]);
    EXPECT_EQ(static_cast<std::size_t>(count) + 1, s.size()) << part;
    for (std::int64_t i = 1; i <= count; ++i) {
      const std::int64_t index = number(s[std::to_string(i)]);
      EXPECT_TRUE(index >= low && index <= high) << part << " " << index;
      EXPECT_TRUE(listed.insert(index).second) << index;
    }
  }
  std::set<std::int64_t> indices;
  for (const ObjectEntry& entry : kNodeObjects) indices.insert(entry.address.index);
  EXPECT_EQ(listed, indices);
  EXPECT_EQ(number(sections["DeviceInfo"]["NrOfRXPDO"]), kRpdoCount);
  EXPECT_EQ(number(sections["DeviceInfo"]["VendorNumber"]), kVendorId);
}

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
      s.is_signed = sign == '-';
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
  const auto messages = read_dbc(dbc_text(nodes_of(kBoard)));
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
  const auto messages = read_dbc(dbc_text(nodes_of(kBoard)));
  const CanFrame segment =
      frame_of(encode(Segment{.sequence = 101, .duration = 5000, .acceleration = {-2000000, 77}}));
  const Message& m = messages.at(0x402);
  EXPECT_EQ(decode(m, "Sequence", segment), 101);
  EXPECT_EQ(decode(m, "Duration", segment), 80000);
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

  const CanFrame rate = encode(RateCommand{RateCommand::Kind::kStop, 7, 16384, 50, BusTime{123'456'000}});
  EXPECT_EQ(decode(messages.at(rate.id), "Counter", rate), 7);
  EXPECT_EQ(decode(messages.at(rate.id), "Kind", rate), 2);
  EXPECT_EQ(decode(messages.at(rate.id), "Rate", rate), 0.5);
  EXPECT_EQ(decode(messages.at(rate.id), "FullRamp", rate), 100);
  EXPECT_EQ(decode(messages.at(rate.id), "Start", rate), 123'456'000 / 1000 % 0x1000000);

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
  const auto messages = read_dbc(dbc_text(nodes_of(kBoard)));
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
  const NodeList list = read_nodes("2,40-41,20:heat", kBoard);
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

  for (const char* wrong : {"", "0", "127", "1-", "3-1", "1,,2", "a", "1,1", "1-3,2:heat", "4:oven", "1:"})
    EXPECT_FALSE(read_nodes(wrong, kBoard).error.empty()) << wrong;
}

TEST(Dictionaries, ScaleEveryUnitThatHasANumber) {
  for (const BoardDescription& board : kBoards)
    for (const ObjectNames& names : board.names) {
      const ScaledUnit unit = scaled_unit(names.unit);
      const bool number = !unit.unit.empty() && unit.unit.front() >= '0' && unit.unit.front() <= '9';
      EXPECT_TRUE(!number || unit.unit == "1/min" || unit.unit == "1/s") << names.unit;
    }
}

TEST(Dbc, EverySignalOfAMessageHasItsOwnBits) {
  for (const auto& [id, message] : read_dbc(dbc_text(nodes_of(kBoard))))
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

// The file is read back by a reader of its own and compared with the object table.
#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "protocol/canopen/node_objects.hpp"
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
      EXPECT_EQ(initial, entry.text());
    } else {
      const bool relative = initial.rfind("$NODEID+", 0) == 0;
      EXPECT_EQ(relative, entry.node_id_relative) << name;
      if (relative) initial = initial.substr(8);
      EXPECT_EQ(initial.empty() ? 0 : number(initial), entry.initial()) << name;
    }
    EXPECT_EQ(s.count("LowLimit") == 1, entry.limited) << name;
    if (entry.limited) {
      EXPECT_EQ(number(s["LowLimit"]), entry.low()) << name;
      EXPECT_EQ(number(s["HighLimit"]), entry.high()) << name;
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
        EXPECT_EQ(number(s["HighLimit"]), entry.high()) << name;
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

TEST(Dictionaries, ScaleEveryUnitThatHasANumber) {
  for (const BoardDescription& board : kBoards)
    for (const ObjectNames& names : board.names) {
      const ScaledUnit unit = scaled_unit(names.unit);
      const bool number = !unit.unit.empty() && unit.unit.front() >= '0' && unit.unit.front() <= '9';
      EXPECT_TRUE(!number || unit.unit == "1/min" || unit.unit == "1/s") << names.unit;
    }
}

}  // namespace
}  // namespace kinebus

#include "tools/dictionary/eds.hpp"

#include <cstdio>
#include <vector>

#include "protocol/canopen/object_addresses.hpp"

namespace kinebus {
namespace {

class Ini {
 public:
  void section(const std::string& name) { text_ += (text_.empty() ? "[" : "\r\n[") + name + "]\r\n"; }
  void set(std::string_view key, std::string_view value) {
    text_ += std::string(key) + "=" + std::string(value) + "\r\n";
  }
  void set(std::string_view key, long long value) { set(key, std::to_string(value)); }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

std::string hex(unsigned long long value, int digits, const char* prefix = "0x") {
  char text[32];
  std::snprintf(text, sizeof text, "%s%0*llX", prefix, digits, value);
  return text;
}

std::string number(const ObjectEntry& entry, std::int64_t value) {
  if (is_signed(entry.type)) return std::to_string(value);
  return hex(static_cast<unsigned long long>(value), 2 * size_of(entry.type));
}

/// As CiA 306: what may be read and written says by which kind of PDO it may be reached.
const char* access_name(const ObjectEntry& entry) {
  switch (entry.access) {
    case Access::kConst:
      return "const";
    case Access::kReadOnly:
      return "ro";
    case Access::kWriteOnly:
      return "wo";
    case Access::kReadWrite:
      return entry.mapping == Mapping::kNone ? "rw" : entry.maps_to(Mapping::kTpdo) ? "rwr" : "rww";
  }
  return "ro";
}

/// A master's program finds objects by their names: those of the second axis have one of their own.
std::string object_name(const ObjectEntry& entry, const ObjectNames& names) {
  return std::string(names.object) + (entry.axis == 1 ? " B" : "");
}

void add_value(Ini& ini, const ObjectEntry& entry) {
  ini.set("DataType", hex(static_cast<unsigned>(entry.type), 4));
  ini.set("AccessType", access_name(entry));
  if (entry.type == DataType::kString)
    ini.set("DefaultValue", entry.text());
  else if (entry.binding != Binding::kLive || entry.initial() != 0)
    ini.set("DefaultValue", (entry.node_id_relative ? "$NODEID+" : "") + number(entry, entry.initial()));
  if (entry.limited) {
    ini.set("LowLimit", number(entry, entry.low()));
    ini.set("HighLimit", number(entry, entry.high()));
  }
  ini.set("PDOMapping", entry.mapping == Mapping::kNone ? "0" : "1");
}

void add_list(Ini& ini, const std::string& name, const std::vector<std::uint16_t>& indices) {
  ini.section(name);
  ini.set("SupportedObjects", static_cast<long long>(indices.size()));
  for (std::size_t i = 0; i < indices.size(); ++i) ini.set(std::to_string(i + 1), hex(indices[i], 4));
}

void add_device(Ini& ini, const BoardDescription& board) {
  const BoardFacts& facts = board.facts;
  ini.section("FileInfo");
  ini.set("FileName", std::string(facts.order_code) + ".eds");
  ini.set("FileVersion", "1");
  ini.set("FileRevision", "0");
  ini.set("EDSVersion", "4.0");
  ini.set("Description", facts.description);
  ini.set("CreationTime", "12:00PM");
  ini.set("CreationDate", "01-01-2026");
  ini.set("CreatedBy", "kinebus-dictionary");
  ini.set("ModificationTime", "12:00PM");
  ini.set("ModificationDate", "01-01-2026");
  ini.set("ModifiedBy", "kinebus-dictionary");

  ini.section("DeviceInfo");
  ini.set("VendorName", "Kinebus");
  ini.set("VendorNumber", hex(kVendorId, 8));
  ini.set("ProductName", facts.device_name);
  ini.set("ProductNumber", hex(facts.product_code, 8));
  ini.set("RevisionNumber", hex(facts.revision, 8));
  ini.set("OrderCode", facts.order_code);
  for (const int rate : {10, 20, 50, 125, 250, 500, 800, 1000})
    ini.set("BaudRate_" + std::to_string(rate), rate == 1000 ? 1 : 0);
  ini.set("SimpleBootUpMaster", "0");
  ini.set("SimpleBootUpSlave", "1");
  ini.set("Granularity", "8");
  ini.set("DynamicChannelsSupported", "0");
  ini.set("GroupMessaging", "0");
  ini.set("NrOfRXPDO", static_cast<long long>(board.pdos.rpdos.size()));
  ini.set("NrOfTXPDO", static_cast<long long>(board.pdos.tpdos.size()));
  ini.set("LSS_Supported", "1");

  ini.section("DummyUsage");
  for (int type = 1; type <= 7; ++type) ini.set("Dummy000" + std::to_string(type), type == 1 ? 0 : 1);
  ini.section("Comments");
  ini.set("Lines", "2");
  ini.set("Line1",
          "Printed by kinebus-dictionary from the node's object table. Packed 64-bit records (2100h ff.):");
  ini.set("Line2", "see protocol/motion/segment.hpp and broadcast.hpp, or the signals of the DBC file.");
}

}  // namespace

std::string eds_text(const BoardDescription& board) {
  Ini ini;
  add_device(ini, board);
  const std::span<const ObjectEntry> objects = board.objects.entries;

  std::vector<std::uint16_t> mandatory, optional, manufacturer;
  for (const ObjectEntry& entry : objects) {
    if (entry.address.subindex != 0) continue;
    const std::uint16_t index = entry.address.index;
    const bool is_mandatory = index == 0x1000 || index == 0x1001 || index == 0x1018;
    (is_mandatory ? mandatory : index >= 0x2000 && index < 0x6000 ? manufacturer : optional).push_back(index);
  }
  add_list(ini, "MandatoryObjects", mandatory);
  add_list(ini, "OptionalObjects", optional);
  add_list(ini, "ManufacturerObjects", manufacturer);

  for (std::size_t i = 0; i < objects.size(); ++i) {
    const ObjectEntry& entry = objects[i];
    const ObjectNames& names = board.names[i];
    const std::string section = hex(entry.address.index, 4, "");
    if (entry.code == ObjectCode::kVar) {
      ini.section(section);
      ini.set("ParameterName", object_name(entry, names));
      ini.set("ObjectType", "0x7");
      add_value(ini, entry);
      continue;
    }
    if (entry.address.subindex == 0) {
      long long entries = 0;
      for (std::size_t k = i; k < objects.size() && objects[k].address.index == entry.address.index; ++k)
        ++entries;
      ini.section(section);
      ini.set("ParameterName", object_name(entry, names));
      ini.set("ObjectType", entry.code == ObjectCode::kArray ? "0x8" : "0x9");
      ini.set("SubNumber", entries);
    }
    ini.section(section + "sub" + hex(entry.address.subindex, 1, ""));
    ini.set("ParameterName", names.name);
    ini.set("ObjectType", "0x7");
    add_value(ini, entry);
  }
  return ini.take();
}

}  // namespace kinebus

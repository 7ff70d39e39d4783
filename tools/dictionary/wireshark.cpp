#include "tools/dictionary/wireshark.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <span>
#include <vector>

#include "protocol/canopen/abort_code.hpp"
#include "protocol/canopen/alarm_table.hpp"
#include "protocol/canopen/boards/all.hpp"
#include "protocol/canopen/cia402.hpp"
#include "protocol/canopen/object_addresses.hpp"
#include "protocol/motion/voucher.hpp"
#include "tools/dictionary/frame_fields.hpp"
#include "tools/dictionary/wireshark/dissector_text.hpp"

namespace kinebus {
namespace {

std::string hex_number(std::uint64_t value) {
  std::array<char, 24> text{};
  std::snprintf(text.data(), text.size(), "0x%llX", static_cast<unsigned long long>(value));
  return text.data();
}
std::string quoted(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + "\"";
}

/// "FreeRecords" -> "Free records", "Acceleration_A" -> "Acceleration A".
std::string in_words(std::string_view name) {
  std::string result;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool capital = std::isupper(static_cast<unsigned char>(name[i])) != 0;
    if (name[i] == '_') {
      result += ' ';
    } else if (capital && i > 0 && name[i - 1] != '_') {
      result += ' ';
      result += static_cast<char>(std::tolower(static_cast<unsigned char>(name[i])));
    } else {
      result += name[i];
    }
  }
  return result;
}
std::string key_of(std::string_view name) {
  std::string result(name);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

std::string value_names(const ValueNames& names) {
  std::string text = "{";
  for (const auto& [value, name] : names)
    text += (text.size() > 1 ? ", " : "") + ("[" + std::to_string(value) + "] = ") + quoted(name);
  return text + "}";
}

std::string field_rows(const std::vector<FrameField>& fields, const std::string& indent) {
  std::string text = "{\n";
  for (const FrameField& f : fields) {
    text += indent + "  {key = " + quoted(key_of(f.name)) + ", name = " + quoted(in_words(f.name)) +
            ", start = " + std::to_string(f.start) + ", bits = " + std::to_string(f.bits) +
            ", signed = " + (f.is_signed ? "true" : "false") + ", factor = " + decimal(f.factor) +
            ", unit = " + quoted(f.unit);
    if (!f.values.empty()) text += ", values = " + value_names(f.values);
    if (f.when.selector != nullptr)
      text += ", selector = " + quoted(key_of(f.when.selector)) + ", low = " + std::to_string(f.when.low) +
              ", high = " + std::to_string(f.when.high);
    if (f.shifted_axis >= 0) text += ", shifted = " + std::to_string(f.shifted_axis);
    text += "},\n";
  }
  return text + indent + "}";
}

const char* type_name(DataType type) {
  switch (type) {
    case DataType::kBoolean:
      return "bool";
    case DataType::kI8:
      return "i8";
    case DataType::kI16:
      return "i16";
    case DataType::kI32:
      return "i32";
    case DataType::kI64:
      return "i64";
    case DataType::kU8:
      return "u8";
    case DataType::kU16:
      return "u16";
    case DataType::kU32:
      return "u32";
    case DataType::kU64:
      return "u64";
    case DataType::kString:
      return "text";
  }
  return "text";
}

std::string pdo_row(const object_table::PdoDefault& pdo) {
  std::string map;
  std::uint32_t bits = 0;
  for (const std::uint32_t mapping : pdo.map) {
    if (mapping == 0) break;
    map += (map.empty() ? "" : ", ") + hex_number(mapping);
    bits += mapping & 0xFF;
  }
  return "{name = " + quoted(pdo.name) + ", bits = " + std::to_string(bits) + ", map = {" + map + "}}";
}

std::string pdo_rows(std::span<const object_table::PdoDefault> pdos) {
  std::string text = "{\n";
  for (const auto& pdo : pdos) text += "      " + pdo_row(pdo) + ",\n";
  return text + "    }";
}

std::string board_row(const BoardDescription& board) {
  std::string text = "  {\n    name = " + quoted(board.facts.name) +
                     ", product = " + hex_number(board.facts.product_code) +
                     ", profile = " + std::to_string(board.facts.device_type & 0xFFFF) +
                     ",\n    rpdos = " + pdo_rows(board.pdos.rpdos) +
                     ",\n    tpdos = " + pdo_rows(board.pdos.tpdos) + ",\n    objects = {\n";
  for (std::size_t i = 0; i < board.objects.entries.size(); ++i) {
    const ObjectEntry& entry = board.objects.entries[i];
    const ObjectNames& names = board.names[i];
    const ScaledUnit unit = scaled_unit(names.unit);
    text += "      [" + hex_number(entry.address.key()) + "] = {" + quoted(names.object) + ", " +
            quoted(names.name) + ", " + quoted(type_name(entry.type)) + ", " + quoted(unit.unit) + ", " +
            decimal(unit.factor) + ", " + std::to_string(entry.axis) + "},\n";
  }
  return text + "    },\n  },\n";
}

std::string record_rows() {
  const struct {
    ObjectAddress address;
    const char *key, *name;
  } records[] = {{object::kSegmentRecord, "segment", "Motion record"},
                 {object::kCheckpoint, "checkpoint", "Checkpoint"},
                 {object::kStreamStatus, "stream", "Stream status"},
                 {object::kRateCommand, "rate", "Rate command"},
                 {object::kSyncStamp, "stamp", "SYNC stamp"}};
  std::string text = "local records = {\n";
  for (const auto& record : records)
    text += "  [" + hex_number(record.address.key()) + "] = {key = " + quoted(record.key) +
            ", name = " + quoted(record.name) +
            ", fields = " + field_rows(record_fields(record.address), "  ") + "},\n";
  return text + "}\n";
}

/// PDOs that all nodes hear, by identifier.
std::string broadcast_rows() {
  std::string text = "local broadcasts = {\n";
  std::vector<std::uint32_t> told;
  for (const BoardDescription& board : kBoards)
    for (const auto& pdo : board.pdos.rpdos) {
      const std::uint32_t id = pdo.cob_id & 0x7FF;
      if (pdo.plus_node_id || std::find(told.begin(), told.end(), id) != told.end()) continue;
      told.push_back(id);
      text += "  [" + hex_number(id) + "] = " + pdo_row(pdo) + ",\n";
    }
  return text + "}\n";
}

std::string abort_rows() {
  // CiA 301 numbers abort codes in classes from 05000000h on; the protocol library knows which have words.
  constexpr std::uint32_t first = 0x0500, last = 0x08FF;
  const std::string_view none = kinebus::text(static_cast<AbortCode>(0xFFFF'FFFF));
  std::string rows = "local abort_codes = {\n";
  for (std::uint32_t high = first; high <= last; ++high)
    for (std::uint32_t low = 0; low <= 0xFF; ++low) {
      const std::uint32_t code = high << 16 | low;
      const std::string_view words = kinebus::text(static_cast<AbortCode>(code));
      if (words != none) rows += "  [" + hex_number(code) + "] = " + quoted(words) + ",\n";
    }
  return rows + "}\n";
}

std::string alarm_rows() {
  std::string text = "local alarms = {\n";
  for (const AlarmRow& row : kAlarms)
    if (row.words != nullptr) text += "  [" + hex_number(row.code) + "] = " + quoted(row.words) + ",\n";
  text += "}\nlocal alarm_classes = {\n";
  for (const AlarmRow& row : kAlarmClasses)
    text += "  [" + std::to_string(row.code >> 12) + "] = " + quoted(row.words) + ",\n";
  text += "}\nlocal stop_reasons = {\n";
  for (std::size_t i = 0; i < kStopWords.size(); ++i)
    if (kStopWords[i].words != nullptr)
      text += "  [" + std::to_string(i) + "] = " + quoted(kStopWords[i].words) + ",\n";
  return text + "}\n";
}

const char* state_name(cia402::State state) {
  using cia402::State;
  switch (state) {
    case State::kNotReadyToSwitchOn:
      return "not ready to switch on";
    case State::kSwitchOnDisabled:
      return "switch on disabled";
    case State::kReadyToSwitchOn:
      return "ready to switch on";
    case State::kSwitchedOn:
      return "switched on";
    case State::kOperationEnabled:
      return "operation enabled";
    case State::kQuickStopActive:
      return "quick stop active";
    case State::kFaultReactionActive:
      return "fault reaction active";
    case State::kFault:
      return "fault";
  }
  return "";
}

/// By the statusword's low 7 bits.
std::string state_rows() {
  std::string text = "local status_states = {\n";
  for (unsigned low = 0; low < 0x80; ++low)
    text += "  [" + std::to_string(low) +
            "] = " + quoted(state_name(cia402::state_of(static_cast<std::uint16_t>(low)))) + ",\n";
  return text + "}\n";
}

}  // namespace

std::string wireshark_text() {
  std::string text =
      "-- Kinebus for Wireshark and tshark, printed by kinebus-dictionary from the nodes' object tables and\n"
      "-- record definitions. It belongs in the folder \"Global Lua Plugins\" or \"Personal Lua Plugins\" "
      "of\n"
      "-- Help > About Wireshark > Folders.\n\nlocal boards = {\n";
  for (const BoardDescription& board : kBoards) text += board_row(board);
  text +=
      "}\n-- Of the boot loader, which answers on the same node id.\nlocal other_objects = {\n"
      "  [0x1F5001] = {name = \"Program data: Program 1\", type = \"text\", unit = \"\", factor = 1, bits = "
      "0,\n"
      "    signed = false, axis = -1, base = 0x1F5001},\n}\n";
  text += record_rows() + broadcast_rows();
  text += "local emcy_fields = " + field_rows(emcy_fields(), "") + "\n";
  text += "local nmt_fields = " + field_rows(nmt_fields(), "") + "\n";
  text += "local heartbeat_fields = " + field_rows(heartbeat_fields(), "") + "\n";
  text += "local voucher_id = " + hex_number(kVoucherCobId) + "\n";
  text += "local voucher_fields = " + field_rows(voucher_fields(), "") + "\n";
  text += "local lss_fields = " + field_rows(lss_fields(), "") + "\n";
  text += "local mode_names = " + value_names(mode_names()) + "\n";
  text += "local mode_objects = {[" + hex_number(object::kModeOfOperation.key()) + "] = true, [" +
          hex_number(object::kModeDisplay.key()) + "] = true}\n";
  return text + abort_rows() + alarm_rows() + state_rows() + "\n" + kDissectorText;
}

}  // namespace kinebus

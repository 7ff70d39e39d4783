#include "tools/dictionary/dbc.hpp"

#include <cstdio>
#include <limits>
#include <vector>

#include "protocol/canopen/cob_id.hpp"
#include "protocol/canopen/object_addresses.hpp"

namespace kinebus {
namespace {

struct Signal {
  std::string name;
  int start = 0, bits = 0;
  bool is_signed = false;
  std::string factor = "1";
  std::string unit;
  std::string values;  // VAL_ list
  std::string comment;
};

struct Message {
  std::uint32_t id = 0;
  std::string name;
  int length = 8;
  std::string sender;
  std::string receiver;
  std::vector<Signal> signals;
};

const char* const kNmtStates = "0 \"boot-up\" 4 \"stopped\" 5 \"operational\" 127 \"pre-operational\"";
const char* const kModes =
    "0 \"none\" 1 \"profile position\" 6 \"homing\" 7 \"interpolated position\" 8 \"cyclic synchronous "
    "position\"";

/// Fields of the records that are one u64 object each (protocol/motion/segment.hpp, broadcast.hpp). The test
/// packs records with the codec and reads them back by these signals.
std::vector<Signal> fields_of(ObjectAddress address) {
  switch (address.key()) {
    case object::kSegmentRecord.key():
      return {{"Sequence", 0, 7, false, "1", "", "", ""},
              {"Duration", 7, 13, false, "16", "us", "",
               "0: control record; then bits 20-21 are 1 start or 2 end, and bits 22-63 the start in 16 us"},
              {"Acceleration_A", 20, 22, true, "1", "", "",
               "unit: 2^(acceleration shift + 1 - 32) counts per (16 us)^2"},
              {"Acceleration_B", 42, 22, true, "1", "", "", ""}};
    case object::kCheckpoint.key():
      return {{"Sequence", 0, 7, false, "1", "", "", ""},
              {"Axis", 7, 1, false, "1", "", "0 \"A\" 1 \"B\"", ""},
              {"Position", 8, 56, true, "5.9604644775390625e-08", "counts", "", ""}};
    case object::kStreamStatus.key():
      return {{"NextSequence", 0, 7, false, "1", "", "", ""},
              {"FreeRecords", 8, 8, false, "1", "", "", ""},
              {"Running", 16, 1, false, "1", "", "", ""},
              {"AtRest", 17, 1, false, "1", "", "", ""},
              {"Stopped", 18, 1, false, "1", "", "", ""},
              {"SequenceError", 19, 1, false, "1", "", "", ""},
              {"Underrun", 20, 1, false, "1", "", "", ""},
              {"CheckpointError", 21, 1, false, "1", "", "", ""},
              {"Synchronised", 22, 1, false, "1", "", "", ""},
              {"SyncError", 24, 8, false, "1", "us", "", "bound; 255: that or more"},
              {"PathTime", 32, 32, false, "16", "us", "", ""}};
    case object::kRateCommand.key():
      return {{"Counter", 0, 4, false, "1", "", "", ""},
              {"Kind", 4, 4, false, "1", "", "1 \"rate\" 2 \"stop\" 3 \"clear\"", ""},
              {"Rate", 8, 16, false, "3.0517578125e-05", "", "", ""},
              {"FullRamp", 24, 8, false, "2", "ms", "", "for a change of the rate by 1.0"},
              {"Start", 32, 24, false, "1", "us", "", "bus time, low 24 bits"},
              {"Check", 56, 8, false, "1", "", "", "check_bits() in protocol/motion/broadcast.hpp"}};
    case object::kSyncStamp.key():
      return {{"Counter", 0, 8, false, "1", "", "", "of the SYNC that is stamped"},
              {"Epoch", 8, 8, false, "1", "", "", ""},
              {"Nanoseconds", 16, 10, false, "1", "ns", "", ""},
              {"Check", 26, 6, false, "1", "", "", "check_bits() in protocol/motion/broadcast.hpp"},
              {"Microseconds", 32, 32, false, "1", "us", "", "bus time, low 32 bits"}};
    default:
      return {};
  }
}

/// "Modes of operation display" -> "ModesOfOperationDisplay".
std::string identifier(std::string_view name) {
  std::string result;
  bool capital = true;
  for (const char c : name) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (!letter && !(c >= '0' && c <= '9')) {
      capital = true;
      continue;
    }
    result += capital && c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    capital = false;
  }
  return result;
}

Message pdo_message(const BoardDescription& board, const object_table::PdoDefault& pdo, std::uint32_t id,
                    std::string name, std::string sender, std::string receiver) {
  Message message{id, std::move(name), 0, std::move(sender), std::move(receiver), {}};
  int at = 0;
  for (const std::uint32_t mapping : pdo.map) {
    if (mapping == 0) break;
    const ObjectAddress address{static_cast<std::uint16_t>(mapping >> 16),
                                static_cast<std::uint8_t>(mapping >> 8)};
    const auto place = static_cast<std::size_t>(board.objects.find(address));
    const ObjectEntry& entry = board.objects.entries[place];
    const ObjectNames& names = board.names[place];
    const int bits = static_cast<int>(mapping & 0xFF);
    if (auto fields = fields_of(address); !fields.empty()) {
      for (Signal& field : fields) {
        field.start += at;
        message.signals.push_back(std::move(field));
      }
    } else {
      const std::string axis = entry.axis < 0 ? "" : entry.axis == 0 ? "_A" : "_B";
      const bool mode = entry.base() == object::kModeOfOperation || entry.base() == object::kModeDisplay;
      message.signals.push_back({identifier(names.name) + axis, at, bits, is_signed(entry.type), "1",
                                 std::string(names.unit), mode ? kModes : "", ""});
    }
    at += bits;
  }
  message.length = at / 8;
  return message;
}

void add_node(std::vector<Message>& messages, const BoardDescription& board, std::uint8_t id) {
  const std::string node = "NODE" + std::to_string(id);
  messages.push_back({cob_id::kEmcy + id,
                      node + "_EMCY",
                      8,
                      node,
                      "GATEWAY",
                      {{"ErrorCode", 0, 16, false, "1", "", "", ""},
                       {"ErrorRegister", 16, 8, false, "1", "", "", ""},
                       {"StopReason", 24, 7, false, "1", "", "", "0: no stop asked for"},
                       {"StopAxis", 31, 1, false, "1", "", "0 \"A\" 1 \"B\"", ""},
                       {"StopStart", 32, 24, false, "1", "us", "", "bus time, low 24 bits"},
                       {"StopCheck", 56, 8, false, "1", "", "", "of the stop asked for"}}});
  for (const auto& pdo : board.pdos.tpdos)
    if ((pdo.cob_id & object_table::kPdoOff) == 0)
      messages.push_back(pdo_message(board, pdo, (pdo.cob_id & 0x7FF) + id,
                                     node + "_" + std::string(pdo.name), node, "GATEWAY"));
  for (const auto& pdo : board.pdos.rpdos)
    if (pdo.plus_node_id)
      messages.push_back(pdo_message(board, pdo, (pdo.cob_id & 0x7FF) + id,
                                     "GATEWAY_" + std::string(pdo.name) + std::to_string(id), "GATEWAY",
                                     node));
  const std::vector<Signal> sdo = {{"Command", 0, 8, false, "1", "", "", ""},
                                   {"ObjectIndex", 8, 16, false, "1", "", "", ""},
                                   {"Subindex", 24, 8, false, "1", "", "", ""},
                                   {"Data", 32, 32, false, "1", "", "", ""}};
  messages.push_back({cob_id::kSdoReply + id, node + "_SdoReply", 8, node, "GATEWAY", sdo});
  messages.push_back(
      {cob_id::kSdoRequest + id, "GATEWAY_SdoRequest" + std::to_string(id), 8, "GATEWAY", node, sdo});
  messages.push_back({cob_id::kHeartbeat + id,
                      node + "_Heartbeat",
                      1,
                      node,
                      "GATEWAY",
                      {{"NmtState", 0, 8, false, "1", "", kNmtStates, ""}}});
}

void print(std::string& text, const Message& message) {
  text += "BO_ " + std::to_string(message.id) + " " + message.name + ": " + std::to_string(message.length) +
          " " + message.sender + "\n";
  for (const Signal& s : message.signals) {
    // Ranges are left open (0|0): a 56-bit range has no exact decimal in common readers.
    text += " SG_ " + s.name + " : " + std::to_string(s.start) + "|" + std::to_string(s.bits) + "@1" +
            (s.is_signed ? "-" : "+") + " (" + s.factor + ",0) [0|0] \"" + s.unit + "\" " + message.receiver +
            "\n";
  }
  text += "\n";
}

}  // namespace

std::string dbc_text(const BoardDescription& board) {
  std::string all_nodes;
  std::vector<Message> messages;
  for (std::uint8_t id = 1; id <= kDbcNodes; ++id)
    all_nodes += (id == 1 ? "NODE" : ",NODE") + std::to_string(id);
  messages.push_back({cob_id::kNmt,
                      "GATEWAY_NMT",
                      2,
                      "GATEWAY",
                      all_nodes,
                      {{"Command", 0, 8, false, "1", "",
                        "1 \"start\" 2 \"stop\" 128 \"enter pre-operational\" 129 \"reset node\" 130 \"reset "
                        "communication\"",
                        ""},
                       {"Node", 8, 8, false, "1", "", "", "0: all"}}});
  messages.push_back({cob_id::kSync,
                      "GATEWAY_SYNC",
                      1,
                      "GATEWAY",
                      all_nodes,
                      {{"SyncCounter", 0, 8, false, "1", "", "", ""}}});
  for (const auto& pdo : board.pdos.rpdos)
    if (!pdo.plus_node_id)
      messages.push_back(pdo_message(board, pdo, pdo.cob_id & 0x7FF, "GATEWAY_" + std::string(pdo.name),
                                     "GATEWAY", all_nodes));
  for (std::uint8_t id = 1; id <= kDbcNodes; ++id) add_node(messages, board, id);
  messages.push_back({cob_id::kHeartbeat + kGatewayNodeId,
                      "GATEWAY_Heartbeat",
                      1,
                      "GATEWAY",
                      all_nodes,
                      {{"NmtState", 0, 8, false, "1", "", kNmtStates, ""}}});

  std::string text = "VERSION \"\"\n\nNS_ :\n\nBS_:\n\nBU_: GATEWAY";
  for (int id = 1; id <= kDbcNodes; ++id) text += " NODE" + std::to_string(id);
  text += "\n\n";
  for (const Message& message : messages) print(text, message);
  text += "CM_ \"Kinebus, printed by kinebus-dictionary from the node's object table.\";\n";
  for (const Message& message : messages)
    for (const Signal& s : message.signals)
      if (!s.comment.empty())
        text += "CM_ SG_ " + std::to_string(message.id) + " " + s.name + " \"" + s.comment + "\";\n";
  for (const Message& message : messages)
    for (const Signal& s : message.signals)
      if (!s.values.empty())
        text += "VAL_ " + std::to_string(message.id) + " " + s.name + " " + s.values + " ;\n";
  return text;
}

}  // namespace kinebus

#include "tools/dictionary/dbc.hpp"

#include <algorithm>
#include <charconv>

#include "protocol/canopen/cob_id.hpp"
#include "protocol/canopen/object_addresses.hpp"
#include "protocol/motion/broadcast.hpp"
#include "protocol/motion/voucher.hpp"
#include "tools/dictionary/frame_fields.hpp"

namespace kinebus {
namespace {

struct Message {
  std::uint32_t id = 0;
  std::string name;
  int length = 8;
  std::string sender;
  std::string receiver;
  std::vector<FrameField> signals;
};

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
    if (auto fields = record_fields(address); !fields.empty()) {
      for (FrameField& field : fields) {
        field.start += at;
        message.signals.push_back(std::move(field));
      }
    } else {
      const std::string axis = entry.axis < 0 ? "" : entry.axis == 0 ? "_A" : "_B";
      const bool mode = entry.base() == object::kModeOfOperation || entry.base() == object::kModeDisplay;
      ScaledUnit unit = scaled_unit(names.unit);
      message.signals.push_back({.name = identifier(names.name) + axis,
                                 .start = at,
                                 .bits = bits,
                                 .is_signed = is_signed(entry.type),
                                 .factor = unit.factor,
                                 .unit = std::move(unit.unit),
                                 .values = mode ? mode_names() : ValueNames{}});
    }
    at += bits;
  }
  message.length = at / 8;
  return message;
}

void add_node(std::vector<Message>& messages, const DbcNode& of) {
  const BoardDescription& board = *of.board;
  const std::uint8_t id = of.id;
  const std::string node = "NODE" + std::to_string(id);
  messages.push_back({cob_id::kEmcy + id, node + "_EMCY", 8, node, "GATEWAY", emcy_fields()});
  for (const auto& pdo : board.pdos.tpdos)
    if ((pdo.cob_id & object_table::kPdoOff) == 0)
      messages.push_back(pdo_message(board, pdo, (pdo.cob_id & 0x7FF) + id,
                                     node + "_" + std::string(pdo.name), node, "GATEWAY"));
  for (const auto& pdo : board.pdos.rpdos)
    if (pdo.plus_node_id)
      messages.push_back(pdo_message(board, pdo, (pdo.cob_id & 0x7FF) + id,
                                     "GATEWAY_" + std::string(pdo.name) + std::to_string(id), "GATEWAY",
                                     node));
  const std::vector<FrameField> sdo = {
      {"Command", 0, 8}, {"ObjectIndex", 8, 16}, {"Subindex", 24, 8}, {"Data", 32, 32}};
  messages.push_back({cob_id::kSdoReply + id, node + "_SdoReply", 8, node, "GATEWAY", sdo});
  messages.push_back(
      {cob_id::kSdoRequest + id, "GATEWAY_SdoRequest" + std::to_string(id), 8, "GATEWAY", node, sdo});
  messages.push_back({cob_id::kHeartbeat + id, node + "_Heartbeat", 1, node, "GATEWAY", heartbeat_fields()});
}

/// "M" of a selector, "m0" of what is there where the selector is 0, "m0M" of one that is both.
std::string multiplexing(const Message& message, const FrameField& signal) {
  std::string text;
  if (signal.when.selector != nullptr) text = " m" + std::to_string(signal.when.low);
  for (const FrameField& other : message.signals) {
    if (other.when.selector == nullptr || signal.name != other.when.selector) continue;
    text += text.empty() ? " M" : "M";
    break;
  }
  return text;
}

void print(std::string& text, const Message& message) {
  text += "BO_ " + std::to_string(message.id) + " " + message.name + ": " + std::to_string(message.length) +
          " " + message.sender + "\n";
  for (const FrameField& s : message.signals) {
    const std::string multiplex = multiplexing(message, s);
    // Some readers choose by the scaled value, others by the raw one: of a selector they are the same.
    const bool selects = multiplex.ends_with('M') && s.factor != 1;
    std::string unit = s.unit;
    if (selects) unit.insert(0, " ").insert(0, decimal(s.factor));
    // Ranges are left open (0|0): a 56-bit range has no exact decimal in common readers.
    text.append(" SG_ ").append(s.name).append(multiplex).append(" : ").append(std::to_string(s.start));
    text.append("|").append(std::to_string(s.bits)).append(s.is_signed ? "@1- (" : "@1+ (");
    text.append(decimal(selects ? 1 : s.factor)).append(",0) [0|0] \"").append(unit).append("\" ");
    text.append(message.receiver).append("\n");
  }
  text += "\n";
}

/// What stands after the messages: comments, names of values, which values of a selector mean which signal.
void print_notes(std::string& text, const std::vector<Message>& messages) {
  const auto each = [&](auto&& note) {
    for (const Message& message : messages)
      for (const FrameField& s : message.signals)
        note(" " + std::to_string(message.id) + " " + s.name + " ", s);
  };
  each([&](const std::string& place, const FrameField& s) {
    if (!s.comment.empty()) text += "CM_ SG_" + place + "\"" + s.comment + "\";\n";
  });
  each([&](const std::string& place, const FrameField& s) {
    if (s.values.empty()) return;
    text += "VAL_" + place;
    for (const auto& [value, name] : s.values) text += std::to_string(value) + " \"" + name + "\" ";
    text += ";\n";
  });
  each([&](const std::string& place, const FrameField& s) {
    if (s.when.selector != nullptr)
      text += "SG_MUL_VAL_" + place + s.when.selector + " " + std::to_string(s.when.low) + "-" +
              std::to_string(s.when.high) + ";\n";
  });
}

}  // namespace

std::string dbc_text(std::span<const DbcNode> nodes) {
  std::string all_nodes, node_list = "GATEWAY";
  for (const DbcNode& node : nodes) {
    const std::string name = "NODE" + std::to_string(node.id);
    all_nodes += (all_nodes.empty() ? "" : ",") + name;
    node_list += " " + name;
  }
  std::vector<Message> messages{
      {cob_id::kNmt, "GATEWAY_NMT", 2, "GATEWAY", all_nodes, nmt_fields()},
      {cob_id::kSync, "GATEWAY_SYNC", 1, "GATEWAY", all_nodes, {{"SyncCounter", 0, 8}}}};
  for (const DbcNode& node : nodes)
    for (const auto& pdo : node.board->pdos.rpdos) {
      const std::uint32_t id = pdo.cob_id & 0x7FF;
      const auto same = [&](const Message& message) { return message.id == id; };
      if (pdo.plus_node_id || std::any_of(messages.begin(), messages.end(), same)) continue;
      messages.push_back(
          pdo_message(*node.board, pdo, id, "GATEWAY_" + std::string(pdo.name), "GATEWAY", all_nodes));
    }
  for (const DbcNode& node : nodes) add_node(messages, node);
  messages.push_back({cob_id::kHeartbeat + kGatewayNodeId, "GATEWAY_Heartbeat", 1, "GATEWAY", all_nodes,
                      heartbeat_fields()});
  messages.push_back({kVoucherCobId, "GATEWAY_Voucher", 8, "GATEWAY", all_nodes, voucher_fields()});
  messages.push_back({cob_id::kLssReply, "NODE_LssReply", 8, "Vector__XXX", "GATEWAY", lss_fields()});
  messages.push_back({cob_id::kLssRequest, "GATEWAY_LssRequest", 8, "GATEWAY", all_nodes, lss_fields()});

  std::string text = "VERSION \"\"\n\nNS_ :\n\nBS_:\n\nBU_: " + node_list + "\n\n";
  for (const Message& message : messages) print(text, message);
  text += "CM_ \"Kinebus, printed by kinebus-dictionary from the nodes' object tables.\";\n";
  print_notes(text, messages);
  return text;
}

std::vector<DbcNode> nodes_of(const BoardDescription& board, std::uint8_t last) {
  std::vector<DbcNode> nodes;
  for (std::uint8_t id = 1; id <= last; ++id) nodes.push_back({id, &board});
  return nodes;
}

NodeList read_nodes(std::string_view list, const BoardDescription& board) {
  constexpr int kLast = kGatewayNodeId - 1;
  NodeList result;
  const auto wrong = [](std::string_view part, const std::string& why) {
    return NodeList{{}, "\"" + std::string(part) + "\": " + why};
  };
  for (bool more = true; more;) {
    const std::size_t comma = list.find(',');
    const std::string_view part = list.substr(0, comma);
    more = comma != std::string_view::npos;
    list.remove_prefix(more ? comma + 1 : list.size());

    DbcNode node{0, &board};
    const std::size_t colon = part.find(':');
    if (colon != std::string_view::npos) node.board = find_board(part.substr(colon + 1));
    if (node.board == nullptr) return wrong(part, "there is no such board; one of: " + names_of_boards());
    const std::string_view ids = part.substr(0, colon);
    int first = 0, last = 0;
    auto read = std::from_chars(ids.begin(), ids.end(), first);
    last = first;
    if (read.ec == std::errc{} && read.ptr != ids.end() && *read.ptr == '-')
      read = std::from_chars(read.ptr + 1, ids.end(), last);
    if (read.ec != std::errc{} || read.ptr != ids.end() || first < 1 || last > kLast || first > last)
      return wrong(part, "expected a node id from 1 to 126, or a range of them as in 1-3");
    for (int id = first; id <= last; ++id) {
      node.id = static_cast<std::uint8_t>(id);
      for (const DbcNode& other : result.nodes)
        if (other.id == node.id) return wrong(part, "node " + std::to_string(id) + " is there twice");
      result.nodes.push_back(node);
    }
  }
  return result;
}

std::string names_of_boards() {
  std::string names;
  for (const BoardDescription& board : kBoards)
    names += (names.empty() ? "" : ", ") + std::string(board.facts.name);
  return names;
}

}  // namespace kinebus

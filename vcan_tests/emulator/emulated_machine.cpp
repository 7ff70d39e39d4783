#include "vcan_tests/emulator/emulated_machine.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <stdexcept>

#include "protocol/bytes.hpp"
#include "protocol/canopen/crc.hpp"
#include "protocol/canopen/object_addresses.hpp"

namespace kinebus::emulator {
namespace {

using namespace std::chrono_literals;

// Shorter than the shortest frame (47 us): nothing that begins in a quantum ends in it.
constexpr BusTime kQuantum = 40us;
// ISO 11898-1: receivers have a frame at the last but one bit of its end, its sender a bit later.
constexpr BusTime kSenderLater = 1us;
constexpr BusTime kErrorFrame = 20us;  // flags and delimiter, about

std::uint32_t serial_of(const std::array<std::uint32_t, 3>& unique_id) {
  Crc32 crc;
  for (const std::uint32_t word : unique_id) {
    std::array<std::uint8_t, 4> bytes{};
    put_u32_le(bytes, word);
    crc.add(bytes);
  }
  return crc.value();
}

}  // namespace

std::vector<EmulatedNodeOptions> boards_like(const std::vector<VirtualNodeOptions>& nodes) {
  std::vector<EmulatedNodeOptions> boards;
  for (const VirtualNodeOptions& node : nodes) {
    EmulatedNodeOptions board;
    std::ranges::copy(node.axes, board.board.axes.begin());
    board.board.unique_id = {0x00330045, 0x31365108, 0x36373800u + node.node.node_id};
    board.node_id = node.node.node_id;
    board.powered_before = node.clock_offset;
    board.clock_drift_ppm = node.clock_drift_ppm;
    boards.push_back(board);
  }
  return boards;
}

Cycle EmulatedMachine::Node::cycle_at(BusTime at) const {
  if (at <= powered) return 0;
  const double since = static_cast<double>((at - powered).count());
  return static_cast<Cycle>(since * 0.168 * (1 + drift_ppm * 1e-6));
}

BusTime EmulatedMachine::Node::time_of(Cycle cycle) const {
  return powered +
         BusTime{static_cast<std::int64_t>(static_cast<double>(cycle) / (0.168 * (1 + drift_ppm * 1e-6)))};
}

EmulatedMachine::EmulatedMachine(const ElfImage& image, const std::vector<EmulatedNodeOptions>& nodes,
                                 int gateway_mailboxes)
    : gateway_(bus_.add_port(gateway_mailboxes)) {
  BusTime longest{0};
  for (const EmulatedNodeOptions& options : nodes) longest = std::max(longest, options.powered_before);
  for (const EmulatedNodeOptions& options : nodes) {
    auto node = std::make_unique<Node>();
    node->board = options.make(options.image != nullptr ? *options.image : image, options.board);
    node->port = bus_.add_port(CanController::kMailboxes);
    node->powered = longest - options.powered_before;
    node->drift_ppm = options.clock_drift_ppm;
    nodes_.push_back(std::move(node));
  }
  BusTime boot{0};
  for (const auto& node : nodes_) boot = std::max(boot, node->board->boot_time());
  while (!advance_to(longest + boot)) {
  }
  commission(nodes);
  epoch_ = time_;
  received_.clear();
  next_received_ = 0;
}

EmulatedMachine::~EmulatedMachine() = default;

void EmulatedMachine::commission(const std::vector<EmulatedNodeOptions>& options) {
  LssMaster master;
  const auto finish = [&](const char* what, std::uint8_t node_id) {
    while (master.status() == LssMaster::Status::kBusy) {
      while (can_send()) {
        const auto frame = master.next_frame();
        if (!frame) break;
        bus_.send(gateway_, time_, *frame);
      }
      advance_to(std::min(time_ + 1ms, std::max(time_, master.next_deadline())));
      while (const auto got = receive())
        if (!got->own) master.on_frame(got->frame);
      master.on_time(time_);
    }
    if (master.status() != LssMaster::Status::kDone)
      throw std::runtime_error("emulated board for node " + std::to_string(node_id) + ": no answer to LSS (" +
                               what + ")");
  };
  for (std::size_t i = 0; i < options.size(); ++i) {
    const EmulatedNodeOptions& o = options[i];
    if (o.node_id == 0) continue;
    const std::uint32_t product = nodes_[i]->board->product_code();
    master.select(time_, {kVendorId, product, kRevisionNumber, serial_of(o.board.unique_id)});
    finish("select", o.node_id);
    master.configure_node_id(time_, o.node_id);
    finish("node id", o.node_id);
    if (o.keeps_node_id) {
      master.store(time_);
      finish("store", o.node_id);
    }
    master.switch_all(time_, false);
    finish("wait", o.node_id);
    // Its receive filters follow the new id within 10 ms.
    for (const BusTime ready = time_ + 20ms; !advance_to(ready);) {
    }
  }
}

void EmulatedMachine::power_cycle(int node) {
  Node& off = *nodes_[static_cast<std::size_t>(node)];
  off.board->can().take_requests();
  for (std::size_t i = 0; i < off.waiting.size(); ++i)
    if (off.waiting[i]) bus_.withdraw(off.port, off.in_mailbox[i]);
  off.waiting = {};
  off.board->power_cycle();
}

std::optional<NodeMachine::Received> EmulatedMachine::receive() {
  if (next_received_ == received_.size()) {
    received_.clear();
    next_received_ = 0;
    return std::nullopt;
  }
  return received_[next_received_++];
}

bool EmulatedMachine::advance(BusTime now) {
  return advance_to(now + epoch_);
}

bool EmulatedMachine::advance_to(BusTime until) {
  while (time_ < until || bus_.next_event() <= time_) {
    const BusTime end = std::max(time_, std::min({until, time_ + kQuantum, bus_.next_event()}));
    for (const auto& node : nodes_) node->board->run(node->cycle_at(end));
    time_ = end;
    collect(end);
    if (const auto delivery = bus_.advance(end)) {
      deliver(*delivery);
      return time_ >= until && bus_.next_event() > time_ && received_.empty();
    }
  }
  return true;
}

// What the programs asked of their controllers during the quantum, in order of time.
void EmulatedMachine::collect(BusTime now) {
  struct Asked {
    BusTime at{0};
    Node* node = nullptr;
    CanController::Request request;
  };
  std::vector<Asked> asked;
  for (const auto& node : nodes_)
    for (const CanController::Request& request : node->board->can().take_requests())
      asked.push_back({std::min(node->time_of(request.at), now), node.get(), request});
  std::stable_sort(asked.begin(), asked.end(), [](const Asked& a, const Asked& b) { return a.at < b.at; });
  for (const Asked& a : asked) {
    const auto mailbox = static_cast<std::size_t>(a.request.mailbox);
    if (a.request.abort) {
      if (!a.node->waiting[mailbox]) continue;
      if (!bus_.withdraw(a.node->port, a.node->in_mailbox[mailbox])) {
        a.node->abort_asked[mailbox] = true;  // it is on the wire: in force if it fails there
        continue;
      }
      a.node->waiting[mailbox] = false;
      a.node->board->can().on_aborted(a.request.mailbox);
    } else {
      assert(!a.node->waiting[mailbox] && bus_.has_room(a.node->port));
      a.node->in_mailbox[mailbox] = a.request.frame;
      a.node->waiting[mailbox] = true;
      a.node->abort_asked[mailbox] = false;
      bus_.send(a.node->port, std::max(a.at, BusTime{0}), a.request.frame);
    }
  }
}

bool EmulatedMachine::acknowledged(const Node* sender) const {
  if (sender == nullptr) return true;
  return gateway_there_ || std::ranges::any_of(nodes_, [&](const auto& node) {
           return node.get() != sender && node->board->can().listening();
         });
}

// What was destroyed, or not acknowledged, is sent again, unless the program has called it back.
void EmulatedMachine::repeat(Node& sender, const BusModel::Delivery& delivery) {
  for (std::size_t m = 0; m < sender.waiting.size(); ++m) {
    if (!sender.waiting[m] || sender.in_mailbox[m] != delivery.frame || !sender.abort_asked[m]) continue;
    sender.waiting[m] = sender.abort_asked[m] = false;
    return sender.board->can().on_aborted(static_cast<int>(m));
  }
  bus_.send(sender.port, delivery.end + kErrorFrame, delivery.frame);
}

void EmulatedMachine::deliver(const BusModel::Delivery& delivery) {
  Node* sender = nullptr;
  for (const auto& node : nodes_)
    if (node->port == delivery.from) sender = node.get();
  if (sender != nullptr && sender->disturbed > 0) {
    --sender->disturbed;
    for (const auto& node : nodes_)
      node->board->can().on_error(node.get() == sender, node->cycle_at(delivery.end));
    if (sender->board->can().bus_off()) {
      sender->waiting = {};  // its controller leaves the bus with all it wanted to say
      for (const CanFrame& frame : sender->in_mailbox) bus_.withdraw(sender->port, frame);
    } else {
      repeat(*sender, delivery);
    }
    return;
  }
  if (!acknowledged(sender)) {
    sender->board->can().on_no_acknowledge(sender->cycle_at(delivery.end));
    return repeat(*sender, delivery);
  }
  received_.push_back({delivery.end - epoch_, delivery.from == gateway_, delivery.frame});
  for (const auto& node : nodes_) {
    if (node.get() != sender) {
      if (delivery.end >= node->powered) node->board->deliver(node->cycle_at(delivery.end), delivery.frame);
      continue;
    }
    for (int mailbox = 0; mailbox < CanController::kMailboxes; ++mailbox) {
      const auto m = static_cast<std::size_t>(mailbox);
      if (!node->waiting[m] || node->in_mailbox[m] != delivery.frame) continue;
      node->waiting[m] = false;
      node->abort_asked[m] = false;
      node->board->sent(node->cycle_at(delivery.end + kSenderLater), mailbox);
      break;
    }
  }
}

double EmulatedMachine::true_counts(int node, int axis, BusTime) {
  return chip(node).true_counts(axis);
}

PathTime EmulatedMachine::path_time(int node, BusTime at) {
  Node& n = *nodes_[static_cast<std::size_t>(node)];
  const auto function = n.board->image().symbol("debug_path_time");
  if (!function) return n.last_path;
  // Local time as the program counts it: 4 MHz from its own start on; asked for by cycles, which the
  // program's own clock translates.
  const auto counts = static_cast<std::uint32_t>(n.board->local_counts(n.cycle_at(at + epoch_)));
  if (const auto ticks = n.board->cpu().call(*function, counts))
    n.last_path = PathTime{static_cast<std::int64_t>(*ticks)};
  return n.last_path;
}

std::optional<std::int64_t> EmulatedMachine::commanded(int node, int axis) {
  const auto function = chip(node).image().symbol("debug_position");
  if (!function) return std::nullopt;
  const auto position = chip(node).cpu().call(*function, static_cast<std::uint64_t>(axis));
  if (!position) return std::nullopt;
  return static_cast<std::int64_t>(*position);
}

void EmulatedMachine::set_input(int node, BusTime, int input, bool level) {
  chip(node).set_input(input - 1, level);
}

}  // namespace kinebus::emulator

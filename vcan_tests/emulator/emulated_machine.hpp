#pragma once
// Emulated boards on one modelled bus, in one thread and one virtual time: the same firmware image in each,
// the place of VirtualMachine in a simulation. Time goes on in quanta shorter than the shortest frame, so
// that arbitration is exact.

#include <array>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "protocol/canopen/lss.hpp"
#include "tools/simulation/bus/node_machine.hpp"
#include "vcan_tests/emulator/board.hpp"
#include "vcan_tests/emulator/chip.hpp"

namespace kinebus::emulator {

/// A board with the image in its flash.
using BoardMaker = std::unique_ptr<Chip> (*)(const ElfImage& image, const BoardOptions& options);
template <typename Made>
std::unique_ptr<Chip> make_board(const ElfImage& image, const BoardOptions& options) {
  return std::make_unique<Made>(image, options);
}

struct EmulatedNodeOptions {
  BoardOptions board;
  /// Given by LSS before time zero, as a commissioning tool does; 0: none, as a new board comes.
  std::uint8_t node_id = 1;
  bool keeps_node_id = false;  ///< it has stored that id and has it again after a loss of power
  BusTime powered_before{0};   ///< how long before the others' commissioning it was switched on
  double clock_drift_ppm = 0;
  BoardMaker make = &make_board<Board>;
  const ElfImage* image = nullptr;  ///< the board's own, which lives as long; none: that of all
};

/// The boards that stand for these virtual nodes: same places, switches, crystals, power-up times.
std::vector<EmulatedNodeOptions> boards_like(const std::vector<VirtualNodeOptions>& nodes);

class EmulatedMachine : public NodeMachine {
 public:
  /// Powers the boards up and gives them their node ids. Throws std::runtime_error when one does not answer.
  EmulatedMachine(const ElfImage& image, const std::vector<EmulatedNodeOptions>& nodes,
                  int gateway_mailboxes = 1);
  ~EmulatedMachine() override;

  bool can_send() const override { return bus_.has_room(gateway_); }
  void send(BusTime now, const CanFrame& frame) override { bus_.send(gateway_, now + epoch_, frame); }
  std::optional<Received> receive() override;
  BusTime next_event() const override {
    return bus_.next_event() == BusTime::max() ? bus_.next_event() : bus_.next_event() - epoch_;
  }
  bool advance(BusTime now) override;
  double true_counts(int node, int axis, BusTime at) override;
  PathTime path_time(int node, BusTime at) override;
  int node_count() const override { return static_cast<int>(nodes_.size()); }
  const BusModel& bus() const override { return bus_; }
  void set_input(int node, BusTime at, int input, bool level) override;

  Chip& chip(int node) { return *nodes_[static_cast<std::size_t>(node)]->board; }
  /// Of nodes that were made so.
  template <typename Made = Board>
  Made& board(int node) {
    return dynamic_cast<Made&>(chip(node));
  }
  BusTime now() const { return time_ - epoch_; }
  /// Where a carriage stood at power-up, counts.
  double start_counts(int node, int axis) { return chip(node).start_counts(axis); }
  /// The processor is asleep: what the main loop keeps is consistent.
  bool idle(int node) { return chip(node).cpu().asleep(); }
  /// What the program's motion asks of a motor now: counts with 32 fractional bits, 0 at power-up.
  std::optional<std::int64_t> commanded(int node, int axis);

  /// Power off and on again: what waits for the bus is gone, flash is kept.
  void power_cycle(int node);
  /// The next frames of this node are destroyed on the wire: error frames, counters, repeats.
  void disturb(int node, int frames) { nodes_[static_cast<std::size_t>(node)]->disturbed = frames; }
  /// Whether the gateway is on the wire and acknowledges. What is said there is received in any case.
  void set_gateway_on_wire(bool there) { gateway_there_ = there; }

 private:
  struct Node {
    std::unique_ptr<Chip> board;
    BusModel::Port port = 0;
    BusTime powered{0};
    double drift_ppm = 0;
    std::array<CanFrame, CanController::kMailboxes> in_mailbox{};
    std::array<bool, CanController::kMailboxes> waiting{};
    std::array<bool, CanController::kMailboxes> abort_asked{};
    int disturbed = 0;
    PathTime last_path{0};

    Cycle cycle_at(BusTime at) const;
    BusTime time_of(Cycle cycle) const;
  };
  bool advance_to(BusTime until);
  bool acknowledged(const Node* sender) const;
  void repeat(Node& sender, const BusModel::Delivery& delivery);
  void collect(BusTime now);
  void deliver(const BusModel::Delivery& delivery);
  void commission(const std::vector<EmulatedNodeOptions>& options);

  BusModel bus_;
  BusModel::Port gateway_;
  bool gateway_there_ = true;
  std::vector<std::unique_ptr<Node>> nodes_;
  std::vector<Received> received_;
  std::size_t next_received_ = 0;
  BusTime time_{0};   // since the first power-up
  BusTime epoch_{0};  // what callers call zero
};

}  // namespace kinebus::emulator

#pragma once
// M1's nodes as boards that people own: one Octopus with the frame's motors, switches and heat, one EBB with
// the extruder at its CAN connector, and a USB cable to a computer that speaks as Linux's gs_usb driver does.
// It takes the virtual nodes' place in a simulation.

#include <array>
#include <cassert>
#include <numbers>
#include <utility>
#include <vector>

#include "node_firmware/port/host/heat_plant.hpp"
#include "vcan_tests/emulator/ebb_board.hpp"
#include "vcan_tests/emulator/emulated_machine.hpp"
#include "vcan_tests/emulator/octopus_board.hpp"
#include "vcan_tests/emulator/tests/gs_usb_host.hpp"

namespace kinebus::emulator {

class OneCableMachine final : public NodeMachine {
 public:
  /// `nodes`: those of the machine file in its order: the Octopus' ids are in a row from the first on, the
  /// last is the EBB's. `start_c`: the hot end, as a print a moment ago has left it. Time stamps are the
  /// device's, or those of the kernel when a frame has come out of the cable.
  OneCableMachine(const ElfImage& octopus, std::vector<VirtualNodeOptions> nodes,
                  double filament_mm_per_count, double start_c, bool by_device_clock)
      : nodes_(std::move(nodes)),
        filament_mm3_per_count_(filament_mm_per_count * std::numbers::pi * kFilament_mm * kFilament_mm / 4),
        boards_(octopus, boards(nodes_)),
        host_(boards_, this->octopus()) {
    host_.by_device_clock = by_device_clock;
    this->octopus().heated().hot_end().begin_at(start_c);
    for (const VirtualNodeOptions& node : nodes_)
      for (int input = 0; node.heat && input < 2; ++input)
        this->octopus().heated().plant().plug(input, node.sensors[static_cast<std::size_t>(input)]);
    host_.plug();
    EXPECT_TRUE(host_.probe());
    EXPECT_TRUE(host_.up());
    for (const VirtualNodeOptions& node : nodes_)
      if (node.heat) give_model(node.node.node_id);
    epoch_ = boards_.now();
  }

  OctopusBoard& octopus() { return boards_.board<OctopusBoard>(kOctopus); }
  EbbBoard& ebb() { return boards_.board<EbbBoard>(kEbb); }
  const GsUsbHost& host() const { return host_; }

  // NodeMachine.
  bool can_send() const override { return host_.can_send(); }
  void send(BusTime now, const CanFrame& frame) override { host_.send(now + epoch_, frame); }
  std::optional<Received> receive() override {
    auto got = host_.receive();
    if (got) got->when -= epoch_;
    return got;
  }
  BusTime next_event() const override {
    const BusTime next = host_.next_event();
    return next == BusTime::max() ? next : next - epoch_;
  }
  bool advance(BusTime now) override {
    const bool done = host_.advance(now + epoch_);
    feed();
    return done;
  }
  double true_counts(int node, int axis, BusTime at) override {
    const auto [board, first] = place(node);
    return boards_.true_counts(board, first + axis, at + epoch_);
  }
  PathTime path_time(int node, BusTime at) override {
    return boards_.path_time(place(node).board, at + epoch_);
  }
  int node_count() const override { return static_cast<int>(nodes_.size()); }
  const BusModel& bus() const override { return boards_.bus(); }
  void set_input(int node, BusTime at, int input, bool level) override {
    const auto [board, first] = place(node);
    assert(input <= kAxesPerNode);  // those beside its drivers
    boards_.set_input(board, at + epoch_, first + input, level);
  }
  heat::HeatPlant* heated(int node) override {
    return nodes_[static_cast<std::size_t>(node)].heat ? &octopus().heated().plant() : nullptr;
  }

 private:
  static constexpr int kOctopus = 0, kEbb = 1;
  static constexpr double kFilament_mm = 1.75;
  static constexpr BusTime kFeedPeriod = std::chrono::milliseconds{20};

  struct Place {
    int board = 0, first_axis = 0;
  };
  Place place(int node) const { return place_of(nodes_, static_cast<std::size_t>(node)); }
  static Place place_of(const std::vector<VirtualNodeOptions>& nodes, std::size_t node) {
    if (node + 1 == nodes.size()) return {kEbb, 0};
    return {kOctopus, nodes[node].heat ? 0 : 2 * (nodes[node].node.node_id - nodes[0].node.node_id)};
  }
  static std::vector<EmulatedNodeOptions> boards(const std::vector<VirtualNodeOptions>& nodes) {
    std::vector<EmulatedNodeOptions> all(2);
    all[kOctopus].make = &make_board<OctopusBoard>;
    all[kEbb].make = [](const ElfImage&, const BoardOptions& options) -> std::unique_ptr<Chip> {
      static const ElfImage image = load_elf(KINEBUS_EBB_IMAGE);
      return std::make_unique<EbbBoard>(image, options);
    };
    for (std::size_t n = nodes.size(); n-- > 0;) {
      const VirtualNodeOptions& node = nodes[n];
      const auto [board, first] = place_of(nodes, n);
      EmulatedNodeOptions& options = all[static_cast<std::size_t>(board)];
      options.node_id = node.node.node_id;  // of several the first one's
      options.board.unique_id = {0x00330045, 0x31365108, 0x36373800u + node.node.node_id};
      options.powered_before = node.clock_offset;
      options.clock_drift_ppm = node.clock_drift_ppm;
      for (std::size_t axis = 0; axis < node.axes.size() && !node.heat; ++axis) {
        VirtualAxis& mine = options.board.axes[static_cast<std::size_t>(first) + axis];
        mine = node.axes[axis];
        if (mine.switch_input != 0) mine.switch_input += first;
      }
    }
    return all;
  }
  // What a tuning of this hot end finds, as 1010h would have kept it.
  void give_model(std::uint8_t node_id) {
    constexpr std::array<std::uint32_t, 4> kModel{3006, 5340, 1423, 1998};
    for (std::uint16_t i = 0; i < kModel.size(); ++i) {
      CanFrame write{.id = cob_id::kSdoRequest + node_id, .length = 8};
      write.data[0] = 0x23;
      put_u16_le(std::span(write.data).subspan(1), static_cast<std::uint16_t>(0x2218 + i));
      write.data[3] = 1;
      put_u32_le(std::span(write.data).subspan(4), kModel[i]);
      host_.send(boards_.now(), write);
      bool taken = false;
      const BusTime until = boards_.now() + std::chrono::milliseconds{50};
      while (boards_.now() < until) {
        host_.advance(until);
        while (const auto got = host_.receive())
          taken = taken || (got->frame.id == cob_id::kSdoReply + node_id && got->frame.data[0] == 0x60);
      }
      EXPECT_TRUE(taken) << "the hot end's model, " << i;
    }
  }
  // What the extruder pushes takes heat along.
  void feed() {
    if (boards_.now() < fed_at_ + kFeedPeriod) return;
    const double counts = ebb().true_counts(0);
    const double seconds = 1e-9 * static_cast<double>((boards_.now() - fed_at_).count());
    octopus().heated().hot_end().flow_mm3_per_s =
        std::max(0.0, (counts - fed_counts_) * filament_mm3_per_count_ / seconds);
    fed_counts_ = counts;
    fed_at_ = boards_.now();
  }

  std::vector<VirtualNodeOptions> nodes_;
  double filament_mm3_per_count_;
  EmulatedMachine boards_;
  GsUsbHost host_;
  BusTime epoch_{0}, fed_at_{0};
  double fed_counts_ = 0;
};

}  // namespace kinebus::emulator

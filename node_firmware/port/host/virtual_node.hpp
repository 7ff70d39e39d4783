#pragma once
// The node core as a Linux process on SocketCAN, with simulated motors and switches. SIGUSR1 is the E-stop
// button.

#include <algorithm>
#include <array>
#include <optional>

#include "node_firmware/core/node.hpp"
#include "node_firmware/port/host/axis_plant.hpp"
#include "node_firmware/port/host/bus_process.hpp"
#include "node_firmware/port/host/position_trace.hpp"

namespace kinebus {

struct VirtualNodeProcessOptions {
  std::string interface;
  NodeOptions node;
  std::array<AxisPlantOptions, 2> plant{};
  int emergency_input = 7;  ///< 1..7: SIGUSR1 turns its level
  std::string image_path;
  std::string trace_path;  ///< see PositionTrace; empty: none
};

class VirtualNodeProcess final : public BusProcess {
 public:
  explicit VirtualNodeProcess(const VirtualNodeProcessOptions& options);

 private:
  std::string start(LocalTime now, std::span<const std::uint8_t> stored) override;
  void on_frame(LocalTime at, const CanFrame& frame) override;
  void on_time(LocalTime now) override;
  std::optional<CanFrame> next_frame() override { return node_->next_frame(); }
  LocalTime next_deadline() override { return std::min(node_->next_deadline(), next_look_); }
  std::span<const std::uint8_t> image_to_store() override { return node_->image_to_store(); }
  void on_image_stored(bool good) override { node_->on_image_stored(good); }
  bool take_reset_request() override { return node_->take_reset_request(); }
  Wanted wanted() override { return wanted_of(*node_); }
  void on_user_signal() override;

  void look_at_switches(LocalTime now);

  VirtualNodeProcessOptions options_;
  std::optional<LoneNode> node_;
  std::array<AxisPlant, 2> plant_;
  PositionTrace trace_;
  LocalTime next_look_{0};
  bool emergency_ = false;
};

}  // namespace kinebus

#pragma once
// The heat node as a Linux process on SocketCAN, with a simulated hot end, bed and fans. Lines of standard
// input break and mend them (HeatPlant::command).

#include <algorithm>
#include <optional>

#include "node_firmware/heat/heat_node.hpp"
#include "node_firmware/port/host/bus_process.hpp"
#include "node_firmware/port/host/heat_plant.hpp"
#include "node_firmware/port/host/heat_trace.hpp"

namespace kinebus {

struct VirtualHeatNodeOptions {
  std::string interface;
  heat::HeatNodeOptions node;
  std::string image_path;
  std::string trace_path;
};

class VirtualHeatNodeProcess final : public BusProcess {
 public:
  explicit VirtualHeatNodeProcess(const VirtualHeatNodeOptions& options);

 private:
  std::string start(LocalTime now, std::span<const std::uint8_t> stored) override;
  void on_frame(LocalTime at, const CanFrame& frame) override;
  void on_time(LocalTime now) override;
  std::optional<CanFrame> next_frame() override { return node_->next_frame(); }
  LocalTime next_deadline() override { return std::min(node_->next_deadline(), next_sample_); }
  std::span<const std::uint8_t> image_to_store() override { return node_->image_to_store(); }
  void on_image_stored(bool good) override { node_->on_image_stored(good); }
  bool take_reset_request() override { return node_->take_reset_request(); }
  Wanted wanted() override { return wanted_of(*node_); }
  void on_line(std::string_view line) override;
  void sample_until(LocalTime now);

  VirtualHeatNodeOptions options_;
  std::optional<heat::HeatNode> node_;
  heat::HeatPlant plant_;
  HeatTrace trace_;
  LocalTime next_sample_{0};
};

}  // namespace kinebus

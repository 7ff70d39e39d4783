#include "node_firmware/port/host/virtual_heat_node.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace kinebus {
VirtualHeatNodeProcess::VirtualHeatNodeProcess(const VirtualHeatNodeOptions& options)
    : BusProcess(options.interface, options.image_path), options_(options) {}

std::string VirtualHeatNodeProcess::start(LocalTime now, std::span<const std::uint8_t> stored) {
  if (!trace_.open(options_.trace_path)) return "trace " + options_.trace_path + ": " + std::strerror(errno);
  node_.emplace(options_.node, now, stored);
  next_sample_ = now;
  listen();
  return {};
}

// A converter does not wait for a process that was held up: samples come in their time, before what came
// later.
void VirtualHeatNodeProcess::sample_until(LocalTime now) {
  for (; next_sample_ <= now; next_sample_ += heat::HeatPlant::kPeriod) {
    node_->on_time(next_sample_);
    plant_.step(*node_, next_sample_);
    trace_.sample(plant_, next_sample_);
  }
}

void VirtualHeatNodeProcess::on_frame(LocalTime at, const CanFrame& frame) {
  sample_until(at);
  node_->on_frame(at, frame);
}

void VirtualHeatNodeProcess::on_time(LocalTime now) {
  sample_until(now);
  node_->on_time(now);
}

void VirtualHeatNodeProcess::on_line(std::string_view line) {
  const std::string error = plant_.command(line);
  std::fprintf(stderr, "%s\n", error.empty() ? std::string(line).c_str() : error.c_str());
}

}  // namespace kinebus

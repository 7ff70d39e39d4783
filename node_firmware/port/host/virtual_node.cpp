#include "node_firmware/port/host/virtual_node.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace kinebus {
namespace {

// Motors are looked at so often while one moves: the switch's edge is interpolated in between.
constexpr LocalTime kLook = std::chrono::milliseconds{1};
constexpr LocalTime kLookAtRest = std::chrono::milliseconds{20};

}  // namespace

VirtualNodeProcess::VirtualNodeProcess(const VirtualNodeProcessOptions& options)
    : BusProcess(options.interface, options.image_path),
      options_(options),
      plant_{AxisPlant(options.plant[0]), AxisPlant(options.plant[1])} {
  options_.node.may_fit_scale = &Node::may_fit_scale;
  for (std::size_t axis = 0; axis < plant_.size(); ++axis)
    if (plant_[axis].has_scale())
      options_.node.scale_inputs[axis] = ScaleInput::kQuadrature + ScaleInput::kAbsolute;
}

std::string VirtualNodeProcess::start(LocalTime now, std::span<const std::uint8_t> stored) {
  if (!trace_.open(options_.trace_path)) return "trace " + options_.trace_path + ": " + std::strerror(errno);
  node_.emplace(options_.node, now, stored);
  return {};
}

void VirtualNodeProcess::on_frame(LocalTime at, const CanFrame& frame) {
  trace_.sample(*node_, at);
  node_->on_frame(at, frame);
}

void VirtualNodeProcess::on_time(LocalTime now) {
  trace_.sample(*node_, now);
  if (now >= node_->next_deadline()) node_->on_time(now);
  if (now >= next_look_) look_at_switches(now);
}

void VirtualNodeProcess::look_at_switches(LocalTime now) {
  for (int axis = 0; axis < 2; ++axis) {
    AxisPlant& plant = plant_[static_cast<std::size_t>(axis)];
    const auto edge = plant.on_position(now, node_->position(now, axis));
    node_->set_scale(axis, plant.scale_counts());
    if (edge) node_->on_switch(edge->at, edge->input, edge->level);
  }
  next_look_ = now + (node_->moving(now) ? kLook : kLookAtRest);
}

void VirtualNodeProcess::on_user_signal() {
  emergency_ = !emergency_;
  std::fprintf(stderr, "E-stop button %s\n", emergency_ ? "pressed" : "released");
  node_->on_switch(monotonic_now(), options_.emergency_input - 1, emergency_);
}

}  // namespace kinebus

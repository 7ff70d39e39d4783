#include "gateway/bus_nodes/clearing.hpp"

#include "gateway/bus_nodes/rest.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr BusTime kClearTimeout = 3s;
constexpr BusTime kRepeatAfter = 200ms;

}  // namespace

void Clearing::begin(BusTime now) {
  rate_.clear(now);
  busy_ = true;
  since_ = next_repeat_ = now;
  repeats_ = 0;
}

Clearing::Outcome Clearing::on_time(BusTime now) {
  bool lifted = !rate_.stop_latched() && now - since_ >= Rest::kSettle;
  bool enabled = true;
  together_ = true;
  const std::int64_t units = rate_.tau(now).count() / kPathTicksPerUnit;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    NodeLink& link = links_[i];
    if (link.stream() && (link.stream()->flags & StreamStatus::kStopped) != 0) lifted = false;
    together_ = together_ && link.stream() && link.stream()->path_near(units) == units;
    for (std::size_t axis = 0; axis < kAxesPerNode; ++axis) {
      if (axes_[i].axes[axis].joint < 0) continue;
      const cia402::State drive = link.drive_state(axis);
      const bool follows = drive == cia402::State::kOperationEnabled;
      enabled = enabled && follows;
      constexpr auto kMode = static_cast<std::int8_t>(cia402::Mode::kInterpolatedPosition);
      if (follows)
        link.set_control(axis, cia402::control::kOperation | cia402::control::kInterpolationEnable, kMode);
      else if (drive != cia402::State::kFault || (repeats_ & 1) != 0)
        link.set_control(axis, cia402::next_controlword(drive), kMode);
      else
        link.set_control(axis, 0, kMode);
    }
  }
  if (now >= next_repeat_) {
    next_repeat_ = now + kRepeatAfter;
    ++repeats_;
    for (NodeLink& link : links_) link.repeat_control();
  }
  if (!(lifted && enabled) && now - since_ < kClearTimeout) return Outcome::kBusy;
  busy_ = false;
  if (lifted && enabled) return Outcome::kLifted;
  failure_ = {enabled ? AlarmCode::kStopTimeout : AlarmCode::kEnableFailed, 0,
              enabled
                  ? say("a node keeps its stop latched: is an emergency stop or a limit switch still active?")
                  : say("a drive does not enable again: its fault is still there")};
  return Outcome::kFailed;
}

}  // namespace kinebus

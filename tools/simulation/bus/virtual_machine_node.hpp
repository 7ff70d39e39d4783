#pragma once
// One node of the virtual machine with its clock: the core, what moves or heats behind it, and what is on its
// way to it.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "tools/simulation/bus/virtual_machine.hpp"

namespace kinebus {

struct VirtualMachine::VirtualNode {
  VirtualNode(const VirtualNodeOptions& o, BusModel::Port p, int i) : options(o), port(p), index(i) {
    switch_on(BusTime{0});
  }
  void switch_on(BusTime now) {
    const LocalTime local = to_local(now);
    if (!options.heat) {
      core.emplace(options.node, local);
      return;
    }
    if (!plant) {
      plant = std::make_unique<heat::HeatPlant>(static_cast<std::uint32_t>(index) + 1);
      for (int i = 0; i < heat::HeatPlant::kSensors; ++i)
        plant->plug(i, options.sensors[static_cast<std::size_t>(i)]);
    }
    heat.emplace(heat::HeatNodeOptions{options.node.node_id, options.node.identity.serial}, local, stored);
    // Blocks have cooled meanwhile, without their node.
    for (; next_sample != LocalTime{0} && next_sample < local; next_sample += heat::HeatPlant::kPeriod)
      plant->rest();
    next_sample = local;
  }
  bool powered() const { return core || heat; }

  void count_scales(BusTime now) {
    if (!core) return;
    for (int axis = 0; axis < 2; ++axis)
      if (const auto& scale = options.axes[static_cast<std::size_t>(axis)].scale)
        core->set_scale(axis, scale(counts(axis, now)));
  }

  LocalTime to_local(BusTime t) const {
    return t + options.clock_offset +
           LocalTime{std::llround(static_cast<double>(t.count()) * options.clock_drift_ppm * 1e-6)};
  }
  BusTime to_true(LocalTime t) const {
    if (t == LocalTime::max()) return BusTime::max();
    const double since = static_cast<double>((t - options.clock_offset).count());
    // Rounded up, so that a deadline is never served a nanosecond early.
    return BusTime{static_cast<std::int64_t>(std::ceil(since / (1 + options.clock_drift_ppm * 1e-6))) + 1};
  }
  double counts(int axis, BusTime at) {
    const double start = options.axes[static_cast<std::size_t>(axis)].start_counts;
    return core ? start + static_cast<double>(core->position(to_local(at), axis)) / 4294967296.0 : start;
  }
  /// Samples come in their time, before what came later.
  void sample_until(LocalTime now) {
    for (; heat && next_sample <= now; next_sample += heat::HeatPlant::kPeriod) {
      heat->on_time(next_sample);
      if (extruder) plant->turn_extruder(extruder(next_sample));
      plant->step(*heat, next_sample);
    }
  }
  void on_frame(LocalTime at, const CanFrame& frame) {
    sample_until(at);
    if (core)
      core->on_frame(at, frame);
    else if (heat)
      heat->on_frame(at, frame);
  }
  void on_time(LocalTime now) {
    sample_until(now);
    if (core)
      core->on_time(now);
    else if (heat)
      heat->on_time(now);
  }
  template <typename Core>
  BusTime put_out(Core& of, BusModel& bus, BusTime now) {
    // Parameters are stored at once; a node with axes powers up with its defaults all the same.
    if (const auto image = of.image_to_store(); !image.empty()) {
      if (heat) stored.assign(image.begin(), image.end());
      of.on_image_stored(true);
    }
    while (bus.has_room(port)) {
      const auto frame = of.next_frame();
      if (!frame) break;
      bus.send(port, now, *frame);
    }
    return to_true(of.next_deadline());
  }
  BusTime next_due() const {
    return std::min(next_besides_checks(), options.heat ? BusTime::max() : next_check);
  }
  BusTime next_besides_checks() const {
    if (options.heat)
      return !heat ? BusTime::max()
                   : std::min({deadline, to_true(next_sample),
                               pending.empty() ? BusTime::max() : pending.front().at});
    if (!core || stalled) return BusTime::max();
    return std::min({deadline, pending.empty() ? BusTime::max() : pending.front().at,
                     edges.empty() ? BusTime::max() : edges.front().at});
  }

  VirtualNodeOptions options;
  BusModel::Port port;
  int index;
  std::optional<LoneNode> core;        // none: without power, or a heat node
  std::optional<heat::HeatNode> heat;  // none: without power, or a node with axes
  std::unique_ptr<heat::HeatPlant> plant;
  std::vector<std::uint8_t> stored;  // parameters of a heat node
  LocalTime next_sample{0};
  std::function<double(LocalTime)> extruder;  // mm of filament, by this node's clock
  bool stalled = false;
  std::uint32_t lost_while_stalled = 0;  // frames that its full queue refused: it finds out when it goes on
  std::vector<Pending> pending;
  struct RawEdge {
    BusTime at{0};
    int input = 0;
    bool level = false;
  };
  std::vector<RawEdge> edges;  // raw levels to come, by time
  BusTime deadline{0};
  BusTime next_check{0};
  std::array<int, 2> switch_level{-1, -1};
};

}  // namespace kinebus

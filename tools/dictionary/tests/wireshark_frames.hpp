#pragma once
// Frames for the dissector to read: of a whole print, of a heat node, and single ones.

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "node_firmware/heat/tests/heat_node_bench.hpp"
#include "protocol/can/candump.hpp"
#include "protocol/can/frame.hpp"
#include "tools/dictionary/tests/tshark.hpp"
#include "tools/simulation/tests/simulated_job.hpp"

namespace kinebus {

inline CanFrame frame_of(const std::string& text) {
  const auto frame = parse_frame(text);
  EXPECT_TRUE(frame) << text;
  return frame.value_or(CanFrame{});
}
inline CanFrame record_frame(std::uint32_t id, std::uint64_t record) {
  CanFrame frame{.id = id, .length = 8};
  put_u64_le(frame.data, record);
  return frame;
}

/// Bring-up, homing and a short print of the simulated machine.
inline std::vector<CanFrame> print_with(BusTrust trust) {
  std::vector<CanFrame> all;
  MachineDescription machine = default_m1();
  machine.bus.trust = trust;
  SimulateOptions options;
  options.on_frame = [&all](BusTime, const CanFrame& frame) { all.push_back(frame); };
  const SimulationReport report = simulate_on(
      machine,
      "G21 G90 M83\nM104 S200\nG1 Z10 F6000\nG1 X20 Y0 E0.5 F3000\nG1 X20 Y20 E0.5\nG2 X0 Y20 I-10 J0 E1\n"
      "G1 X0 Y0 E1\nM106 S100\nG1 X5 Y5 Z12 F9000\nG4 P200\nG1 X0 Y0\n",
      1, options);
  EXPECT_TRUE(report.finished) << report.outcome;
  return all;
}

inline const std::vector<CanFrame>& print_frames() {
  static const std::vector<CanFrame> frames = print_with(BusTrust::kOpen);
  return frames;
}

/// A heat node that boots, is asked who it is, heats, and loses a sensor.
inline std::vector<CanFrame> heat_frames() {
  heat::HeatNodeBench bench;
  bench.set_up();
  for (std::uint8_t part = 1; part <= 4; ++part) static_cast<void>(bench.read({0x1018, part}));
  const CanFrame set_points = CanFrame::make(0x200 + bench.kId, {0xD0, 0x07, 0x58, 0x02, 0, 0, 0, 0});
  const CanFrame fans = CanFrame::make(0x300 + bench.kId, {0xFF, 0x7F, 0, 0, 0, 0, 0, 0});
  bench.send(set_points);
  bench.send(fans);
  bench.write({0x6422, 1}, 1, 1);
  bench.run(3);
  bench.plant.command("sensor 1 open");
  bench.run(3);
  std::vector<CanFrame> frames = bench.seen;
  frames.push_back(set_points);
  frames.push_back(fans);
  frames.push_back(CanFrame::make(0x400 + bench.kId, {10, 0, 0, 0, 0, 0, 0, 0}));
  frames.push_back(CanFrame::make(0x500 + bench.kId, {10, 0, 0, 0, 0, 0, 0, 0}));
  return frames;
}

}  // namespace kinebus

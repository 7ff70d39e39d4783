#pragma once
// A node whose axes are driven by SDO, one at a time.

#include "node_firmware/core/tests/node_bench.hpp"

namespace kinebus::testing_bench {

inline constexpr std::uint8_t kId = 1;

struct DriveTest : testing::Test {
  DriveTest() : bench({{.id = kId, .plant = {plant(), plant(2)}}}) {}
  static AxisPlantOptions plant(int input = 1) {
    return {.start_counts = 0, .switch_input = input, .switch_counts = 100'000};
  }
  double counts(int axis = 0) { return std::ldexp(static_cast<double>(bench.position(0, axis)), -32); }
  void control(int word, int axis = 0) {
    bench.write(kId, static_cast<std::uint16_t>(0x6040 + axis * 0x800), 0, 2, word);
  }
  std::uint16_t status(int axis = 0) { return bench.statusword(kId, axis); }
  void target(std::int64_t to) {
    bench.write(kId, 0x607A, 0, 4, to);
    control(0x0F);
    control(0x1F);
  }
  /// Runs and checks speed and acceleration as the motor sees them.
  void watch(BusTime span, double max_speed, double max_acceleration) {
    double last = counts(), last_speed = 0;
    bool first = true;
    bench.run(span, 1ms, [&] {
      const double here = counts();
      const double speed = (here - last) * 1000;
      EXPECT_LE(std::abs(speed), max_speed * 1.001 + 20);
      const double change = first ? 0 : std::abs(speed - last_speed);
      EXPECT_LE(change * 1000, max_acceleration * 1.01 + 20'000);
      last = here;
      last_speed = speed;
      first = false;
    });
  }
  Bench bench;
};

}  // namespace kinebus::testing_bench

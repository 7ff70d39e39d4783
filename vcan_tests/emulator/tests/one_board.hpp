#pragma once
// One emulated board with motors, seen from the gateway's side and from outside.

#include <algorithm>
#include <array>
#include <cmath>

#include "vcan_tests/emulator/emulated_machine.hpp"
#include "vcan_tests/emulator/tests/gateway_bench.hpp"

namespace kinebus::emulator {

inline const ElfImage& firmware_image() {
  static const ElfImage loaded = load_elf(KINEBUS_FIRMWARE_IMAGE);
  return loaded;
}

struct OneBoard {
  static constexpr std::uint8_t kId = 5;

  explicit OneBoard(const BoardOptions& options = {}, int gateway_mailboxes = 1,
                    const ElfImage& image = firmware_image())
      : machine(image, {EmulatedNodeOptions{.board = options, .node_id = kId}}, gateway_mailboxes),
        bench(machine),
        board(machine.board(0)) {
    bench.send(nmt_frame(NmtCommand::kStart, kId));
    bench.run(20ms);
  }
  /// The motors' data as auto-tune or a data sheet gives them, and currents.
  void configure(std::int64_t run_ma, std::int64_t encoder_mode) {
    for (int axis = 0; axis < 2; ++axis) {
      const StepperParameters& p = board.motor(axis).parameters();
      write(axis, 0x2150, 2, 2, std::lround(p.resistance_ohm * 1e3));
      write(axis, 0x2150, 3, 2, std::lround(p.inductance_h * 1e6));
      write(axis, 0x2150, 4, 2, std::lround(p.torque_nm_per_a / p.pole_pairs * 1e6));
      write(axis, 0x2150, 6, 1, encoder_mode);
      write(axis, 0x2140, 2, 2, run_ma);
      write(axis, 0x2140, 3, 2, run_ma);
      write(axis, 0x607F, 0, 4, 1'000'000);
    }
    bench.run(20ms);
  }
  void write(int axis, int index, std::uint8_t sub, int size, std::int64_t value) {
    bench.write(kId, static_cast<std::uint16_t>(index + 0x800 * axis), sub, size, value);
  }
  /// Counts by which the rotor is away from its command now.
  double error(int axis) {
    const auto command = machine.commanded(0, axis);
    EXPECT_TRUE(command.has_value());
    return board.true_counts(axis) - static_cast<double>(command.value_or(0)) / 4294967296.0;
  }
  void enable(int mode) {
    for (int axis = 0; axis < 2; ++axis) bench.enable(kId, axis, mode);
    bench.run(300ms);
  }
  bool told(std::uint16_t code, std::size_t from = 0) const {
    const auto codes = bench.emergencies(kId, from);
    return std::find(codes.begin(), codes.end(), code) != codes.end();
  }

  EmulatedMachine machine;
  GatewayBench bench;
  Board& board;
};

}  // namespace kinebus::emulator

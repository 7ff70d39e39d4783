#pragma once
// A master of an emulated board's heat node, by CANopen alone.

#include <algorithm>
#include <array>
#include <functional>

#include "vcan_tests/emulator/tests/gateway_bench.hpp"

namespace kinebus::emulator {

class HeatMaster {
 public:
  static constexpr std::uint32_t kDeviceState = 0x0800'0022;

  HeatMaster(GatewayBench& bench, std::uint8_t id) : bench_(bench), id_(id) {}

  void write(std::uint16_t index, std::uint8_t sub, int size, std::int64_t value) {
    bench_.write(id_, index, sub, size, value);
  }
  std::uint32_t try_write(std::uint16_t index, std::uint8_t sub, int size, std::int64_t value) {
    return bench_.try_write(id_, index, sub, size, value);
  }
  std::uint32_t raw(std::uint16_t index, std::uint8_t sub = 0) {
    return get_u32_le(bench_.upload(id_, index, sub).bytes().subspan(4));
  }
  double measured_c(std::uint8_t sensor = 1) { return static_cast<std::int16_t>(raw(0x7130, sensor)) / 10.0; }

  void enter_pre_operational() {
    bench_.send(nmt_frame(NmtCommand::kEnterPreOperational, id_));
    bench_.run(5ms);
  }
  /// So many of its sensors, the plant's, and for heater 1 the model that a tuning of the plant finds.
  void describe(std::uint8_t sensors) {
    enter_pre_operational();
    for (std::uint8_t n = 1; n <= sensors; ++n) {
      write(0x220A, n, 2, -50);
      write(0x6110, n, 2, 10'100);
    }
    const std::array<std::uint32_t, 4> model{3006, 5340, 1423, 1998};
    for (std::size_t i = 0; i < model.size(); ++i)
      write(static_cast<std::uint16_t>(0x2218 + i), 1, 4, model[i]);
  }
  /// This node is meant, and no other.
  void start() {
    write(0x2243, 0, 4, raw(0x1018, 4));
    bench_.run(300ms);
    bench_.send(nmt_frame(NmtCommand::kStart, id_));
    bench_.run(5ms);
  }
  /// A master that lives: it asks once a second.
  double heat_for(BusTime span) {
    double c = 0;
    for (BusTime t{0}; t < span; t += 1s) {
      bench_.run(std::min<BusTime>(1s, span - t));
      c = measured_c();
    }
    return c;
  }
  /// How long `has_power` still is after `what`, looked at for a second.
  double power_after_s(const std::function<bool()>& has_power, const std::function<void()>& what) {
    const BusTime from = bench_.now;
    BusTime last = from;
    what();
    bench_.run(1s, 500us, [&] {
      if (has_power()) last = bench_.now;
    });
    return 1e-9 * static_cast<double>((last - from).count());
  }
  std::vector<std::uint16_t> emergencies() const { return bench_.emergencies(id_); }

 private:
  GatewayBench& bench_;
  std::uint8_t id_;
};

}  // namespace kinebus::emulator

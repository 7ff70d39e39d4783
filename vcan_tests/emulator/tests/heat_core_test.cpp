// The heat core on a Cortex-M0+ of 64 MHz, without floating point: four heaters, six sensors and six fans, a
// master that asks all the time, one heater measured. What each of its works takes there.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <optional>
#include <vector>

#include "node_firmware/heat/heater.hpp"
#include "node_firmware/port/heat_m0plus/mailbox.hpp"
#include "node_firmware/port/host/thermal_plant.hpp"
#include "protocol/bytes.hpp"
#include "protocol/can/frame.hpp"
#include "protocol/canopen/nmt.hpp"
#include "vcan_tests/emulator/cpu/cortex_m4.hpp"

namespace kinebus::emulator {
namespace {

using heat_m0plus::Work;

constexpr std::uint8_t kId = 20;
constexpr double kClocksPerMs = 64e3;

/// The two registers of its mailbox.
class WorkRegisters final : public Devices {
 public:
  std::uint32_t read(std::uint32_t, int, Cycle) override { return static_cast<std::uint32_t>(work); }
  void write(std::uint32_t, std::uint32_t, int, Cycle) override {
    work = Work::kNone;
    cpu->stop();
  }
  bool write_flash(std::uint32_t, std::uint32_t, int, Cycle) override { return false; }
  Cycle next_event() const override { return kNever; }
  void advance(Cycle) override {}
  Work work = Work::kNone;
  CortexM4* cpu = nullptr;
};

struct Cost {
  std::uint64_t calls = 0;
  Cycle all = 0, worst = 0;
  void add(Cycle clocks) {
    ++calls;
    all += clocks;
    worst = std::max(worst, clocks);
  }
};

class HeatCore {
 public:
  HeatCore()
      : image_(load_elf(KINEBUS_HEAT_IMAGE)),
        cpu_(registers_, {.core_coupled_memory = false, .small = true, .system_memory = 0x1FFF'7400}),
        mailbox_(image_.symbol("mailbox").value()) {
    registers_.cpu = &cpu_;
    cpu_.load(image_);
    cpu_.reset();
    for (std::uint32_t i = 0; i < 4; ++i)
      plants_.emplace_back(heat::PlantParameters{.power_w = 44.0 + i, .block_j_per_k = 12}, i + 1);
    run(0.2);
  }

  std::uint32_t write(int index, int sub, std::uint32_t value, int bytes) {
    std::array<std::uint8_t, 8> data{static_cast<std::uint8_t>(0x23 | (4 - bytes) << 2)};
    put_u16_le(std::span(data).subspan(1), static_cast<std::uint16_t>(index));
    data[3] = static_cast<std::uint8_t>(sub);
    put_u32_le(std::span(data).subspan(4), value);
    const auto reply = ask(data);
    return reply[0] == 0x60 ? 0 : get_u32_le(std::span(reply).subspan(4));
  }
  std::uint32_t read(int index, int sub = 0) {
    std::array<std::uint8_t, 8> data{0x40};
    put_u16_le(std::span(data).subspan(1), static_cast<std::uint16_t>(index));
    data[3] = static_cast<std::uint8_t>(sub);
    const auto reply = ask(data);
    const auto bytes = static_cast<std::size_t>(4 - (reply[0] >> 2 & 3));
    return static_cast<std::uint32_t>(get_le(std::span(reply).subspan(4), bytes));
  }
  void start() { hear(nmt_frame(NmtCommand::kStart, kId)); }
  void run(double seconds) {
    for (double t = 0; t < seconds; t += heat::ThermalPlant::kStep) step();
  }
  /// Since the last call, clocks of the core a second.
  double load() {
    const double share =
        static_cast<double>(busy_) / (1e6 * 64 * static_cast<double>(now_us_ - since_us_) * 1e-6);
    busy_ = 0;
    since_us_ = now_us_;
    return share;
  }
  double block(std::size_t heater) const { return plants_[heater].block(); }
  Cost samples, control, sdo_request, other_time;

 private:
  static constexpr std::uint32_t kStep_us = 10'000;

  Cycle work(Work what) {
    registers_.work = what;
    const Cycle began = cpu_.now();
    while (registers_.work != Work::kNone) cpu_.run(cpu_.now() + 100'000'000);
    const Cycle took = cpu_.now() - began;
    busy_ += took;
    return took;
  }
  std::uint32_t at(std::size_t offset) const { return mailbox_ + static_cast<std::uint32_t>(offset); }
  void step() {
    using heat_m0plus::Mailbox;
    now_us_ += kStep_us;
    cpu_.poke(at(offsetof(Mailbox, now_us)), now_us_);
    const Cycle time = work(Work::kTime);
    // Control comes every tenth time.
    (++steps_ % 10 == 0 ? control : other_time).add(time);
    for (std::size_t i = 0; i < plants_.size(); ++i) {
      const std::uint32_t power = cpu_.peek(at(offsetof(Mailbox, power)) + 4 * static_cast<std::uint32_t>(i));
      plants_[i].step(power / static_cast<double>(heat::kFullPower));
    }
    for (std::uint32_t i = 0; i < kHeatSensors; ++i)
      cpu_.poke(at(offsetof(Mailbox, ratios)) + 4 * i, plants_[i % 4].ratio());
    samples.add(work(Work::kSamples));
    send_all();
    if (steps_ % 50 == 0) static_cast<void>(read(0x1001));
  }
  void hear(const CanFrame& frame) {
    using heat_m0plus::Mailbox;
    cpu_.poke(at(offsetof(Mailbox, frame_id)), frame.id);
    cpu_.poke(at(offsetof(Mailbox, frame_length)), frame.length);
    for (std::size_t i = 0; i < 2; ++i)
      cpu_.poke(at(offsetof(Mailbox, frame_data) + 4 * i), get_u32_le(std::span(frame.data).subspan(4 * i)));
    sdo_request.add(work(Work::kFrame));
  }
  std::array<std::uint8_t, 8> ask(const std::array<std::uint8_t, 8>& data) {
    CanFrame request{.id = 0x600u + kId, .length = 8};
    request.data = data;
    hear(request);
    return send_all().value_or(std::array<std::uint8_t, 8>{0x80});
  }
  /// The SDO answer among them.
  std::optional<std::array<std::uint8_t, 8>> send_all() {
    using heat_m0plus::Mailbox;
    std::optional<std::array<std::uint8_t, 8>> answer;
    for (;;) {
      work(Work::kAnswer);
      const std::uint32_t id = cpu_.peek(at(offsetof(Mailbox, frame_id)));
      if (id == 0) return answer;
      if (id != 0x580u + kId) continue;
      answer.emplace();
      for (std::size_t i = 0; i < 2; ++i)
        put_u32_le(std::span(*answer).subspan(4 * i), cpu_.peek(at(offsetof(Mailbox, frame_data) + 4 * i)));
    }
  }

  WorkRegisters registers_;
  ElfImage image_;
  CortexM4 cpu_;
  std::uint32_t mailbox_;
  std::vector<heat::ThermalPlant> plants_;
  std::uint32_t now_us_ = 0, since_us_ = 0;
  std::uint64_t steps_ = 0;
  Cycle busy_ = 0;
};

TEST(HeatCoreOfCortexM0Plus, HeatsMeasuresAndLeavesTheProcessorToOthers) {
  HeatCore core;
  Cycle longest_table = 0;
  for (int sensor = 1; sensor <= kHeatSensors; ++sensor) {
    ASSERT_EQ(core.write(0x220A, sensor, static_cast<std::uint32_t>(-50), 2), 0u);
    core.other_time = core.control = {};
    ASSERT_EQ(core.write(0x6110, sensor, 10'100, 2), 0u);
    core.run(0.1);
    longest_table = std::max({longest_table, core.other_time.worst, core.control.worst});
  }
  constexpr std::array<std::uint32_t, 4> kModel{3100, 5300, 1500, 1300};
  for (int heater = 1; heater <= kHeaters; ++heater)
    for (int i = 0; heater > 1 && i < 4; ++i)
      ASSERT_EQ(core.write(0x2218 + i, heater, kModel[static_cast<std::size_t>(i)], 4), 0u);
  ASSERT_EQ(core.write(0x2243, 0, 1, 4), 0u);
  core.run(0.3);
  core.start();
  for (int heater = 2; heater <= kHeaters; ++heater)
    ASSERT_EQ(core.write(0x7402, heater, static_cast<std::uint32_t>(1000 + 100 * heater), 2), 0u);
  core.samples = core.control = core.other_time = core.sdo_request = {};
  static_cast<void>(core.load());
  core.run(80);
  for (int heater = 2; heater <= kHeaters; ++heater)
    EXPECT_NEAR(core.block(static_cast<std::size_t>(heater - 1)), 100 + 10 * heater, 1.5) << heater;
  const double load = core.load();
  const Cost samples = core.samples, control = core.control, sdo = core.sdo_request;

  ASSERT_EQ(core.write(0x2224, 1, 1200, 2), 0u);
  core.control = core.other_time = {};
  for (int s = 0; s < 200 && core.read(0x2225, 1) != 4; ++s) core.run(1);
  EXPECT_EQ(core.read(0x2225, 1), 4u) << "measured";
  const Cycle longest_fit = std::max(core.control.worst, core.other_time.worst);
  const std::uint32_t rate = core.read(0x2218, 1);
  EXPECT_NEAR(rate, 3000, 500) << "mK/s, of 44 W into 14.5 J/K";

  const auto ms = [](Cycle clocks) { return static_cast<double>(clocks) / kClocksPerMs; };
  std::printf(
      "heat core, Cortex-M0+ of 64 MHz: %.2f %% of it while 3 of 4 heaters hold; at most, ms (clocks):\n",
      100 * load);
  const auto row = [&](const char* what, Cycle clocks) {
    std::printf("  %-38s %8.3f (%llu)\n", what, ms(clocks), static_cast<unsigned long long>(clocks));
  };
  row("samples of six sensors, every 10 ms", samples.worst);
  row("control of all heaters, every 100 ms", control.worst);
  row("SDO request", sdo.worst);
  row("a sensor's table, once at set-up", longest_table);
  row("fitting a model, once when measured", longest_fit);
  EXPECT_LT(load, 0.10);
  EXPECT_LT(ms(samples.worst), 1.0);
  EXPECT_LT(ms(control.worst), 3.0);
  EXPECT_LT(ms(sdo.worst), 1.0);
  EXPECT_LT(ms(longest_table), 40) << "the watchdog waits for 50 ms";
  EXPECT_LT(ms(longest_fit), 40);
}

}  // namespace
}  // namespace kinebus::emulator

#pragma once
// One TMC2209 behind its wire: finds the driver, writes its settings and checks by IFCNT that each arrived,
// then asks round and round how it is.

#include <cstdint>
#include <optional>
#include <span>

#include "node_firmware/step/stepper_driver.hpp"
#include "node_firmware/step/tmc2209_datagram.hpp"
#include "node_firmware/step/tmc2209_settings.hpp"

namespace kinebus::tmc2209 {

class Driver final : public step::StepperDriver {
 public:
  /// Goes on with the settings until they have arrived.
  void set(const step::DriverSettings& settings) override;
  std::optional<step::Exchange> next(LocalTime now) override;
  void on_heard(std::span<const std::uint8_t> bytes) override;
  bool busy() const override { return state_ != step::DriverState::kSilent && phase_ < kAsk; }
  std::uint16_t found() const override { return found_ ? std::uint16_t{2209} : std::uint16_t{0}; }

 private:
  enum Phase : std::uint8_t { kIdentify, kCount, kWriteNext, kVerify, kAsk, kAskStatus, kAskLoad };

  std::optional<Datagram> datagram(LocalTime now);
  void on_said();
  void on_answer(std::uint32_t value);
  /// No echo, no answer, or a garbled one.
  void on_failure();
  void on_gstat(std::uint32_t value);
  void begin(Phase phase) { phase_ = phase; }
  void write_all();

  std::uint32_t pending_ = (1u << kRegisters) - 1;  ///< by place in registers_of()
  std::uint32_t written_ = 0;                       ///< of those, since the last count
  Phase phase_ = kIdentify;
  Phase asked_ = kIdentify;  ///< by the datagram that is under way
  Datagram under_way_{};
  std::uint8_t count_ = 0, writes_ = 0;
  std::size_t place_ = 0;   ///< that is being written
  std::uint32_t said_ = 0;  ///< into it
  bool found_ = false, error_seen_ = false;
};

}  // namespace kinebus::tmc2209

#pragma once
// A TMC5160 or TMC2130 behind SPI: found by its version, told its settings, each checked by what the next
// datagram brings back, then asked round and round how it is. There is no CRC: a look counts only when two
// readings of its status say the same, the chopper is as it was set, and the version is its own.

#include <cstdint>
#include <optional>
#include <span>

#include "node_firmware/step/stepper_driver.hpp"
#include "node_firmware/step/tmc_spi_datagram.hpp"
#include "node_firmware/step/tmc_spi_settings.hpp"

namespace kinebus::tmc_spi {

class Driver final : public step::StepperDriver {
 public:
  void set(const step::DriverSettings& settings) override;
  std::optional<step::Exchange> next(LocalTime now) override;
  void on_heard(std::span<const std::uint8_t> bytes) override;
  bool busy() const override { return state_ != step::DriverState::kSilent && phase_ < kAsk; }
  std::uint16_t found() const override { return chip_ != nullptr ? chip_->number : std::uint16_t{0}; }

 private:
  /// What a datagram is for. Its answer comes with the one that follows.
  enum Phase : std::uint8_t {
    kNothing,
    kFind,
    kFindAgain,
    kClear,
    kWriteNext,
    kAsk,
    kAskStatus,
    kAskStatusAgain,
    kAskChopper,
    kAskVersion,
    kEnd,
  };
  // Bits of DRV_STATUS that do not change by themselves from one datagram to the next.
  static constexpr std::uint32_t kSteady =
      drv_status::kShortToSupply | drv_status::kTooHot | drv_status::kPreWarning | drv_status::kShortToGround;

  Registers wanted() const { return chip_->registers_of(settings_); }
  Datagram datagram();
  void write_all();
  bool take(const Answer& answer);
  bool take_version(std::uint32_t ioin);
  void go_on();
  void end_look();
  void on_failure();
  void configured_now();
  Phase after_clear() const { return (pending_ & ~written_) != 0 ? kWriteNext : kAsk; }

  const Chip* chip_ = nullptr;
  std::uint32_t pending_ = 0;  ///< by place in wanted()
  std::uint32_t written_ = 0;  ///< of those: it is not known yet whether they arrived
  Phase phase_ = kFind;
  Phase asked_ = kNothing, before_ = kNothing;  ///< by the datagram under way, and by the one before it
  std::uint8_t place_ = 0, place_before_ = 0;   ///< that is written
  std::uint32_t said_ = 0, said_before_ = 0;    ///< into it
  std::uint32_t gstat_ = 0, seen_ = 0;
  bool reset_seen_ = false, chopper_lost_ = false;
};

}  // namespace kinebus::tmc_spi

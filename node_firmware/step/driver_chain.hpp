#pragma once
// The drivers of a board, each with a wire of its own, and SPI's for all; one of them is spoken to at a time.

#include <array>
#include <concepts>
#include <cstdint>
#include <optional>
#include <span>

#include "node_firmware/step/driver_socket.hpp"

namespace kinebus::step {

/// Puts bytes out and takes in all that is heard, echo and answer.
template <typename T>
concept DriverWire = requires(T& wire, std::size_t driver, const Exchange& exchange,
                              std::span<std::uint8_t> heard) {
  wire.begin(driver, exchange);
  { wire.done() } -> std::same_as<bool>;
  // Ends it. How many bytes came whole.
  { wire.take(heard) } -> std::same_as<std::size_t>;
};

/// `Socket`: what is at the end of each wire.
template <DriverWire Wire, std::size_t kCount, typename Socket = DriverSocket>
class DriverChain {
 public:
  static constexpr std::size_t kDrivers = kCount;

  explicit constexpr DriverChain(Wire& wire) : wire_(wire) {}

  Socket& driver(std::size_t i) { return drivers_[i]; }
  const Socket& driver(std::size_t i) const { return drivers_[i]; }

  /// Main loop, each pass.
  void serve(LocalTime now) {
    if (said_) {
      // No exchange takes half as long.
      if (!wire_.done() && now - begun_ < kLongest) return;
      finish();
    }
    // Settings before questions.
    if (!begin_next(now, true)) begin_next(now, false);
  }
  /// Each has its settings, or does not answer.
  bool settled() const {
    for (const Socket& d : drivers_)
      if (d.state() == DriverState::kUnasked) return false;
    return true;
  }

 private:
  static constexpr LocalTime kLongest = std::chrono::milliseconds{10};

  bool begin_next(LocalTime now, bool busy_ones) {
    for (std::size_t n = 1; n <= kCount; ++n) {
      const std::size_t i = (at_ + n) % kCount;
      if (drivers_[i].busy() != busy_ones) continue;
      said_ = drivers_[i].next(now);
      if (!said_) continue;
      // One that is being configured is so to the end.
      at_ = busy_ones ? (i + kCount - 1) % kCount : i;
      talks_to_ = i;
      begun_ = now;
      wire_.begin(i, *said_);
      return true;
    }
    return false;
  }
  void finish() {
    std::array<std::uint8_t, kMostHeard> heard{};
    const Exchange said = *said_;
    said_.reset();
    const std::size_t came = wire_.take(std::span(heard).first(said.hears));
    drivers_[talks_to_].on_heard(said, std::span(heard).first(came));
  }

  Wire& wire_;
  std::array<Socket, kCount> drivers_{};
  std::optional<Exchange> said_;
  std::size_t at_ = kCount - 1, talks_to_ = 0;
  LocalTime begun_{0};
};

}  // namespace kinebus::step
